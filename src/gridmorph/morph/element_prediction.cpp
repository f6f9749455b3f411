#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/morph/element_prediction.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <array>

namespace gridmorph {
namespace {

constexpr std::array<char const*, 4> region_names{"columns on walls", "near field", "partially wrapped", "far field"};

/// Where elements lie and which of them are looked at.
class SampledElements {
 public:
  SampledElements(Mesh const& mesh, PreparedUnstructured const& prepared, std::span<signed char const> signs)
      : mesh_(mesh), prepared_(prepared), signs_(signs), looked_at_(std::size_t(mesh.n_elements()), 0) {
    std::vector<char> carried(mesh.n_nodes(), 0);
    for (Index32 const n : prepared.plan.driving) carried[n] = 1;
    for (Index32 const n : prepared.plan.columns.node) carried[n] = 1;
    carried_.reserve(carried.size());
    for (Index32 const owner : prepared.graph.representative) carried_.push_back(carried[owner]);
  }

  /// Corners of an element that move with a column: 0 none, 1 some, 2 all.
  [[nodiscard]] int in_columns(Index e) const {
    auto const corners = mesh_.elements.corners(e);
    auto const carried =
        std::count_if(corners.begin(), corners.end(), [&](Index32 node) { return carried_[node] != 0; });
    auto const n = std::ptrdiff_t(corners.size());
    return carried == 0 ? 0 : carried < n ? 1 : 2;
  }
  [[nodiscard]] int region(Index e) const {
    if (in_columns(e) == 2) return 0;
    switch (prepared_.report.regions.element[e]) {
      case Region::near: return 1;
      case Region::partial: return 2;
      case Region::far: break;
    }
    return 3;
  }
  [[nodiscard]] bool has_shape(Index e) const { return signs_[e] != 0; }

  void add(Index e) { looked_at_[e] = has_shape(e) ? 1 : 0; }
  [[nodiscard]] std::vector<Index> elements() const {
    std::vector<Index> out;
    for (Index e = 0; e < Index(looked_at_.size()); ++e)
      if (looked_at_[e] != 0) out.push_back(e);
    return out;
  }

 private:
  Mesh const& mesh_;
  PreparedUnstructured const& prepared_;
  std::span<signed char const> signs_;
  std::vector<char> carried_, looked_at_;
};

struct BeforeAndAfter {
  kernels::CellMeasures before, after;
  kernels::FlatCell flat;  ///< of elements that are inverted and were not

  [[nodiscard]] bool lost() const { return after.smallest_corner_jacobian < 0 && before.smallest_corner_jacobian >= 0; }
};

void take(Index e, BeforeAndAfter const& m, double relative, PredictedElements& to) {
  auto const smaller = [&](ElementValue& a, double value) {
    if (a.element >= 0 && !(value < a.value)) return false;
    a = {value, e};
    return true;
  };
  ++to.elements;
  if (m.lost() && !m.flat.stays_flat()) ++to.inverted;
  if (smaller(to.determinant, m.after.determinant_3x3x3)) to.determinant_before = m.before.determinant_3x3x3;
  if (m.before.determinant_3x3x3 > 0)
    smaller(to.kept, std::min(1.0, m.after.determinant_3x3x3 / m.before.determinant_3x3x3));
  smaller(to.angle_deg, m.after.minimum_angle_deg);
  if (to.relative_displacement.element < 0 || relative > to.relative_displacement.value)
    to.relative_displacement = {relative, e};
}

}  // namespace

ElementPrediction predict(HostInstance const& host, Mesh const& mesh, PreparedUnstructured const& prepared,
                          Coordinates const& displaced, std::span<signed char const> signs,
                          ElementPredictionOptions const& options) {
  constexpr Index enough = 20'000;
  Index const n = mesh.n_elements();
  ElementPrediction out;
  out.n_elements = n;
  out.every = std::max(1, options.every);
  if (options.every == 0)
    while (n / out.every > enough) out.every *= 2;

  SampledElements sample(mesh, prepared, signs);
  std::vector<double> relative(n, 0);
  std::vector<char> at_end(n, 0);
  std::vector<BeforeAndAfter> measures;
  std::vector<Index> looked_at;
  host.visit([&](auto const& exec) {
    auto const tables = detail::element_tables(exec, mesh);
    auto const x = views(mesh.coordinates), y = views(displaced);
    detail::for_all(exec, "gridmorph::predict::relative_displacement", n, [&](Index e) {
      if (!sample.has_shape(e)) return;
      relative[e] = tables.relative_displacement(x, y, e);
      at_end[e] = sample.in_columns(e) == 1 ? 1 : 0;
    });
    for (Index e = 0; e < n; e += out.every) sample.add(e);
    for (Index e = 0; e < n; ++e)
      if (at_end[e] != 0) sample.add(e);
    std::vector<Index> strained(static_cast<std::size_t>(n));
    for (Index e = 0; e < n; ++e) strained[e] = e;
    auto const most = strained.begin() + std::min(n, options.most_strained);
    std::nth_element(strained.begin(), most, strained.end(), [&](Index a, Index b) {
      double const p = relative[a], q = relative[b];
      return p != q ? p > q : a < b;
    });
    std::for_each(strained.begin(), most, [&](Index e) { sample.add(e); });
    looked_at = sample.elements();
    measures.resize(looked_at.size());
    detail::for_all(exec, "gridmorph::predict::measures", Index(looked_at.size()), [&](Index k) {
      Index const e = looked_at[k];
      double const sign = signs[e];
      auto const of = [&](auto const& at) { return tables.measures(at, e, sign); };
      BeforeAndAfter m{of(x), of(y), {}};
      if (m.lost()) m.flat = tables.flat_element(x, y, e, sign);
      measures[k] = m;
    });
  });

  std::array<PredictedElements, region_names.size()> regions;
  for (std::size_t k = 0; k < looked_at.size(); ++k) {
    Index const e = looked_at[k];
    take(e, measures[k], relative[e], out.all);
    take(e, measures[k], relative[e], regions[sample.region(e)]);
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].elements > 0) out.regions.push_back({region_names[r], regions[r]});
  std::stable_sort(out.regions.begin(), out.regions.end(), [](PredictedRegion const& a, PredictedRegion const& b) {
    return a.elements.kept.value < b.elements.kept.value;
  });
  return out;
}

ElementPrediction predict(HostInstance const& host, Mesh const& mesh, MorphPlan const& plan,
                          Coordinates const& displaced, std::span<signed char const> signs,
                          ElementPredictionOptions const& options) {
  return predict(host, mesh, *PlanAccess::elements(plan), displaced, signs, options);
}

}  // namespace gridmorph
