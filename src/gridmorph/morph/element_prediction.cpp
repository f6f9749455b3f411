#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <array>
#include <numeric>

namespace gridmorph {
namespace {

constexpr std::array<char const*, 4> region_names{"columns on walls", "near field", "partially wrapped", "far field"};

/// Where elements lie.
class ElementPlaces {
 public:
  ElementPlaces(Mesh const& mesh, PreparedUnstructured const& prepared) : mesh_(mesh), prepared_(prepared) {
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
  /// Number in region_names.
  [[nodiscard]] int region(Index e) const {
    if (in_columns(e) == 2) return 0;
    switch (prepared_.report.regions.element[e]) {
      case Region::near: return 1;
      case Region::partial: return 2;
      case Region::far: break;
    }
    return 3;
  }

 private:
  Mesh const& mesh_;
  PreparedUnstructured const& prepared_;
  std::vector<char> carried_;
};

struct BeforeAndAfter {
  kernels::CellMeasures before, after;
  kernels::FlatCell flat;  ///< of elements that are inverted and were not

  [[nodiscard]] bool lost() const { return after.smallest_corner_jacobian < 0 && before.smallest_corner_jacobian >= 0; }
};

PredictedCells one_element(Mesh const& mesh, Index e, BeforeAndAfter const& m, double relative) {
  int const zone = mesh.zone_of_element(e);
  auto const value = [&](double v) { return CellValue{v, zone, {int(e - mesh.zones[zone].first_element), 0, 0}}; };
  double const before = m.before.determinant_3x3x3, after = m.after.determinant_3x3x3;
  PredictedCells one;
  one.cells = 1;
  one.inverted = m.lost() && !m.flat.stays_flat() ? 1 : 0;
  one.determinant = value(after);
  one.determinant_before = before;
  if (before > 0) one.kept = value(std::min(1.0, after / before));
  one.angle_deg = value(m.after.minimum_angle_deg);
  one.relative_displacement[0] = value(relative);
  return one;
}

Prediction compare(HostInstance const& host, IndexedMesh const& indexed, PreparedUnstructured const& prepared,
                   Coordinates const& displaced, PredictionOptions const& options) {
  constexpr Index enough = 20'000;
  Mesh const& mesh = indexed.mesh();
  std::vector<signed char> const& signs = indexed.signs();
  Index const n = mesh.n_elements();
  Prediction out;
  out.n_cells = n;
  out.every = std::max(1, options.every);
  if (options.every == 0)
    while (n / out.every > enough) out.every *= 2;

  ElementPlaces const places(mesh, prepared);
  std::vector<double> relative(n, 0);
  std::vector<char> wanted(n, 0);
  std::vector<BeforeAndAfter> measures;
  std::vector<Index> looked_at;
  host.visit([&](auto const& exec) {
    auto const tables = detail::element_tables(exec, mesh);
    auto const x = views(mesh.coordinates), y = views(displaced);
    detail::for_all(exec, "gridmorph::predict::relative_displacement", n, [&](Index e) {
      if (signs[e] == 0) return;
      relative[e] = tables.relative_displacement(x, y, e);
      wanted[e] = places.in_columns(e) == 1 ? 1 : 0;
    });
    for (Index e = 0; e < n; e += out.every) wanted[e] = 1;
    std::vector<Index> strained(n);
    std::iota(strained.begin(), strained.end(), Index(0));
    auto const most = strained.begin() + std::min(n, options.most_strained);
    std::nth_element(strained.begin(), most, strained.end(), [&](Index a, Index b) {
      double const p = relative[a], q = relative[b];
      return p != q ? p > q : a < b;
    });
    std::for_each(strained.begin(), most, [&](Index e) { wanted[e] = 1; });
    for (Index e = 0; e < n; ++e)
      if (wanted[e] != 0 && signs[e] != 0) looked_at.push_back(e);
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

  std::array<PredictedCells, region_names.size()> regions;
  for (std::size_t k = 0; k < looked_at.size(); ++k) {
    Index const e = looked_at[k];
    PredictedCells const one = one_element(mesh, e, measures[k], relative[e]);
    join(out.all, one);
    join(regions[places.region(e)], one);
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].cells > 0) out.groups.push_back({{}, region_names[r], regions[r]});
  sort_worst_first(out.groups);
  return out;
}

}  // namespace

PredictionOf predictions_of_elements(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                     PredictionOptions const& options) {
  return host.visit([&]<class Exec>(Exec const& exec) -> PredictionOf {
    Morpher<Exec> const morpher(exec, plan, mesh.mesh().coordinates);
    return [=, displaced = Coordinates(mesh.n_nodes())](std::span<Vec3 const> boundary) {
      morpher.positions(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(boundary.data(), boundary.size()),
                        displaced);
      compat::fence(exec, "gridmorph::predict (read by the host)");
      return compare(exec, mesh, *PlanAccess::elements(plan), displaced, options);
    };
  });
}

}  // namespace gridmorph
