#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/element_shapes.hpp>
#include <gridmorph/guard/detail/middle_nodes.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Elements whose determinant is above this are not asked for their certificate: of 27 points one would be negative
/// long before.
constexpr double doubtful_determinant = 0.5;

class Relaxation {
 public:
  Relaxation(Mesh const& mesh, UnstructuredTopology const& topology, GuardedElements const& plan, Coordinates& morphed,
             RelaxOptions const& options)
      : mesh_(mesh),
        topology_(topology),
        plan_(plan),
        x_(morphed),
        now_(views(morphed)),
        baseline_(views(mesh.coordinates)),
        options_(options),
        signs_(detail::signs_of({}, mesh, topology.sides, options.signs)),
        tables_(detail::element_tables(Kokkos::DefaultHostExecutionSpace(), mesh)) {}

  GuardReport run() {
    GuardReport report;
    Judged now = judge(all_elements());
    report.before = report.after = Index(now.bad.size());
    report.inverted_before = report.inverted_after = now.inverted;
    if (now.bad.empty()) return report;
    find_held();
    pull_middles(now);
    int sweeps = options_.sweeps, rings = options_.rings;
    bool shapes = by_shape();
    for (; report.rounds < options_.rounds && !now.bad.empty(); ++report.rounds) {
      std::vector<Index32> const nodes = nodes_around(now.bad, rings);
      std::vector<Index> const middles = middles_of(nodes);
      std::vector<Vec3> before;
      for (Index32 const n : nodes) before.push_back(x_[n]);
      for (Index const row : middles) before.push_back(x_[plan_.middle.target[row]]);
      if (shapes)
        smooth_shapes(nodes, sweeps);
      else
        smooth(nodes, sweeps);
      follow(middles);
      Judged after = judge(touched(nodes, middles, now.bad));
      if (after.worse_than(now)) {
        for (std::size_t k = 0; k < nodes.size(); ++k) x_.set(nodes[k], before[k]);
        for (std::size_t m = 0; m < middles.size(); ++m)
          x_.set(plan_.middle.target[middles[m]], before[nodes.size() + m]);
        copy_coincident();
        if (std::exchange(shapes, false)) continue;
        if ((sweeps /= 2) == 0) break;
        continue;
      }
      now = std::move(after);
      report.after = Index(now.bad.size());
      report.inverted_after = now.inverted;
      if (shapes && now.inverted > 0) {  // what is tangled needs room
        rings *= 2;
        sweeps *= 2;
      }
    }
    pull_middles(now);
    report.after = Index(now.bad.size());
    report.inverted_after = now.inverted;
    report.middles = std::count(pulled_.begin(), pulled_.end(), 1);
    return report;
  }

 private:
  /// Inside out somewhere, by the certificate.
  [[nodiscard]] bool negative(Index32 e, double sign, CoordinateViews<Kokkos::HostSpace> const& x) const {
    return tables_.jacobian_sign(x, e, sign) >= kernels::JacobianSign::negative;
  }

  enum class State : std::uint8_t { sound, bad, inverted };
  struct Judged {
    std::vector<Index32> bad;  ///< inverted ones too; ascending
    Index inverted = 0;

    [[nodiscard]] bool worse_than(Judged const& other) const {
      return inverted != other.inverted ? inverted > other.inverted : bad.size() > other.bad.size();
    }
  };

  [[nodiscard]] State state(Index32 e) const {
    double const sign = signs_[e], now = tables_.determinant(now_, e, sign);
    if (now > doubtful_determinant) return State::sound;  // no determinant is above 1
    if (negative(e, sign, now_) && !negative(e, sign, baseline_))
      return tables_.flat_element(baseline_, now_, e, sign).stays_flat() ? State::sound : State::inverted;
    if (now > options_.share) return State::sound;
    double const before = tables_.determinant(baseline_, e, sign);
    bool const is_bad = before > 0 ? !(now > options_.share * before) : before == 0 && now < 0;
    return is_bad ? State::bad : State::sound;
  }

  [[nodiscard]] std::vector<Index32> all_elements() const {
    std::vector<Index32> all(mesh_.n_elements());
    std::iota(all.begin(), all.end(), Index32(0));
    return all;
  }
  [[nodiscard]] Judged judge(std::vector<Index32> const& elements) const {
    std::vector<State> states(elements.size());
    detail::for_all({}, "gridmorph::find_bad_elements", Index(elements.size()),
                    [&](Index n) { states[n] = state(elements[n]); });
    Judged out;
    for (std::size_t n = 0; n < elements.size(); ++n) {
      if (states[n] != State::sound) out.bad.push_back(elements[n]);
      out.inverted += states[n] == State::inverted ? 1 : 0;
    }
    return out;
  }

  /// Elements that change when `nodes` move, and those that were bad; ascending.
  [[nodiscard]] std::vector<Index32> touched(std::vector<Index32> const& nodes, std::vector<Index> const& middles,
                                             std::vector<Index32> const& bad) const {
    std::vector<std::uint8_t> seen(mesh_.n_elements(), 0);
    std::vector<Index32> found;
    auto const add_all = [&](std::span<Index32 const> elements) {
      for (Index32 const e : elements)
        if (std::exchange(seen[e], std::uint8_t(1)) == 0) found.push_back(e);
    };
    auto const add = [&](Index32 n) { add_all(topology_.elements_of_nodes[n]); };
    add_all(bad);
    for (Index const row : middles) add_all(elements_of_middle_[row]);
    for (Index32 const n : nodes) add(n);
    for (std::size_t k = 0; k < plan_.copies.size(); ++k)
      if (std::binary_search(nodes.begin(), nodes.end(), plan_.copied[k])) add(plan_.copies[k]);
    std::sort(found.begin(), found.end());
    return found;
  }

  void find_held() {
    held_.assign(mesh_.n_nodes(), 0);
    for (auto const* list : {&plan_.known, &plan_.beside_known, &plan_.in_columns})
      for (Index32 const n : *list) held_[n] = 1;
    for (Index32 const n : plan_.middle.target) held_[n] = 1;
    find_middles();
  }

  /// Rows of further nodes that are not on a boundary, by the corners that they follow; the elements around each row's
  /// node.
  void find_middles() {
    if (plan_.middle.size() == 0) return;
    std::vector<std::uint8_t> on_boundary(mesh_.n_nodes(), 0);
    for (Index32 const n : plan_.middle_on_boundary) on_boundary[n] = 1;
    for (PeriodicImage const& image : plan_.images) on_boundary[image.node] = on_boundary[image.owner] = 1;
    std::vector<std::pair<Index32, Index32>> followed, holders;  // corner, row; row, element
    std::vector<Index32> row_of(mesh_.n_nodes(), -1);
    for (Index r = 0; r < plan_.middle.size(); ++r) {
      row_of[plan_.middle.target[r]] = Index32(r);
      if (on_boundary[plan_.middle.target[r]] != 0) continue;
      for (Index k = plan_.middle.first[r]; k < plan_.middle.first[r + 1]; ++k)
        followed.emplace_back(plan_.middle.item[k], Index32(r));
    }
    for (Index e = 0; e < mesh_.n_elements(); ++e)
      for (Index32 const n : mesh_.elements.nodes[e].subspan(mesh_.elements.corners(e).size()))
        if (Index32 const r = row_of[plan_.graph.representative[n]]; r >= 0) holders.emplace_back(r, Index32(e));
    middles_of_node_ = lists(followed, mesh_.n_nodes());
    elements_of_middle_ = lists(holders, plan_.middle.size());
  }

  static CsrGraph lists(std::vector<std::pair<Index32, Index32>>& pairs, Index count) {
    std::sort(pairs.begin(), pairs.end());
    CsrGraph out;
    std::vector<Index32> row;
    std::size_t at = 0;
    for (Index n = 0; n < count; ++n) {
      row.clear();
      for (; at < pairs.size() && pairs[at].first == n; ++at) row.push_back(pairs[at].second);
      out.add(row);
    }
    return out;
  }

  /// Rows of further nodes that follow any of `nodes`; ascending.
  [[nodiscard]] std::vector<Index> middles_of(std::vector<Index32> const& nodes) const {
    std::vector<Index> out;
    if (middles_of_node_.size() == 0) return out;
    for (Index32 const n : nodes)
      for (Index32 const row : middles_of_node_[n]) out.push_back(row);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// Pulls nodes between corners where elements are broken by them alone; from here on they keep what that added when
  /// they follow their corners.
  void pull_middles(Judged& now) {
    InterpolationOperator const& rows = plan_.middle;
    if (rows.size() == 0 || now.bad.empty()) return;
    if (!middle_nodes_) middle_nodes_.emplace(mesh_, plan_, tables_, signs_);
    Coordinates before(mesh_.n_nodes());
    Kokkos::deep_copy(before.x, x_.x);
    Kokkos::deep_copy(before.y, x_.y);
    Kokkos::deep_copy(before.z, x_.z);
    std::vector<Index> const moved = middle_nodes_->pull(now.bad, options_.share, x_);
    if (moved.empty()) return;
    Judged after = judge(touched({}, moved, now.bad));
    if (after.worse_than(now)) {
      Kokkos::deep_copy(x_.x, before.x);
      Kokkos::deep_copy(x_.y, before.y);
      Kokkos::deep_copy(x_.z, before.z);
      return;
    }
    now = std::move(after);
    pull_.resize(rows.size());
    pulled_.resize(rows.size(), 0);
    for (Index const r : moved) {
      Index32 const n = rows.target[r];
      pulled_[r] = 1;
      pull_[r] += x_[n] - before[n];
    }
  }

  /// Further nodes follow their corners as in the morph.
  void follow(std::vector<Index> const& middles) {
    InterpolationOperator const& rows = plan_.middle;
    Coordinates const& x = mesh_.coordinates;
    auto const displacement = [&](Index32 n) { return x_[n] - x[n]; };
    for (Index const r : middles) {
      Index const first = rows.first[r];
      Vec3 const base = displacement(rows.item[first]);
      Vec3 sum;
      for (Index k = first + 1; k < rows.first[r + 1]; ++k)
        sum += double(rows.weight[k]) * (displacement(rows.item[k]) - base);
      Index32 const n = rows.target[r];
      x_.set(n, x[n] + (base + sum));
      if (!pull_.empty()) x_.set(n, x_[n] + pull_[r]);
    }
    if (!middles.empty()) copy_coincident();
  }

  std::vector<Index32> nodes_around(std::vector<Index32> const& bad, int rings) const {
    std::vector<std::uint8_t> seen(mesh_.n_nodes(), 0);
    std::vector<Index32> found;
    auto const add = [&](Index32 n) {
      if (seen[n]) return;
      seen[n] = 1;
      found.push_back(n);
    };
    for (Index32 const e : bad)
      for (Index32 const c : mesh_.elements.corners(e)) add(plan_.graph.representative[c]);
    for (std::size_t begin = 0, ring = 0; ring < std::size_t(rings); ++ring) {
      std::size_t const end = found.size();
      for (; begin < end; ++begin)
        for (Index32 const m : plan_.graph.neighbours[found[begin]]) add(m);
    }
    std::erase_if(found, [&](Index32 n) { return held_[n] != 0; });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// In space.
  [[nodiscard]] bool by_shape() const { return mesh_.dimension == 3; }

  void smooth_shapes(std::vector<Index32> const& nodes, int sweeps) {
    std::vector<std::pair<Index32, Index32>> copies;
    for (std::size_t k = 0; k < plan_.copies.size(); ++k)
      if (std::binary_search(nodes.begin(), nodes.end(), plan_.copied[k]))
        copies.emplace_back(plan_.copied[k], plan_.copies[k]);
    std::sort(copies.begin(), copies.end());
    detail::ElementShapes(mesh_, topology_, nodes, copies).smooth(sweeps, 1, x_);
  }

  /// Displacement at a node by the affine function that fits those of its neighbours best.
  [[nodiscard]] Vec3 affine_mean(Index32 n) const {
    Coordinates const& x = mesh_.coordinates;
    auto const neighbours = plan_.graph.neighbours[n];
    double longest = 0, weights = 0;
    for (Index32 const m : neighbours) longest = std::max(longest, distance(x[n], x[m]));
    if (!(longest > 0)) return x_[n] - x[n];
    Vec3 centre, mean;
    // Edges shorter than a ten-millionth of the longest are round-off between nodes at one place.
    auto const weight = [&](Index32 m) { return 1 / std::max(distance(x[n], x[m]), 1e-7 * longest); };
    for (Index32 const m : neighbours) {
      double const w = weight(m);
      weights += w;
      centre += w * x[m];
      mean += w * (x_[m] - x[m]);
    }
    centre = (1 / weights) * centre;
    mean = (1 / weights) * mean;
    // Moments of the neighbours' places, and of displacements with places.
    double c[3][3] = {}, b[3][3] = {};
    for (Index32 const m : neighbours) {
      double const w = weight(m);
      Vec3 const d = x[m] - centre, u = (x_[m] - x[m]) - mean;
      double const dx[3] = {d.x, d.y, d.z}, du[3] = {u.x, u.y, u.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          c[i][j] += w * dx[i] * dx[j];
          b[i][j] += w * du[i] * dx[j];
        }
    }
    // Directions in which the neighbours do not reach (flat meshes) get no gradient.
    double const least = 1e-9 * (c[0][0] + c[1][1] + c[2][2]);
    for (int i = 0; i < 3; ++i) c[i][i] += least;
    Vec3 const r0{c[0][0], c[0][1], c[0][2]}, r1{c[1][0], c[1][1], c[1][2]}, r2{c[2][0], c[2][1], c[2][2]};
    double const determinant = dot(r0, cross(r1, r2));
    if (!(determinant > 0)) return mean;
    // C is symmetric: its inverse times d, by Cramer's rule.
    Vec3 const d = x[n] - centre;
    Vec3 const s = (1 / determinant) * Vec3{dot(d, cross(r1, r2)), dot(d, cross(r2, r0)), dot(d, cross(r0, r1))};
    return mean + Vec3{b[0][0] * s.x + b[0][1] * s.y + b[0][2] * s.z, b[1][0] * s.x + b[1][1] * s.y + b[1][2] * s.z,
                       b[2][0] * s.x + b[2][1] * s.y + b[2][2] * s.z};
  }

  void smooth(std::vector<Index32> const& nodes, int sweeps) {
    Coordinates const& x = mesh_.coordinates;
    std::vector<Vec3> next(nodes.size());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        next[k] = x[nodes[k]] + affine_mean(nodes[k]);
      }
      for (std::size_t k = 0; k < nodes.size(); ++k) x_.set(nodes[k], next[k]);
    }
    copy_coincident();
  }

  void copy_coincident() {
    Coordinates const& x = mesh_.coordinates;
    for (std::size_t k = 0; k < plan_.copies.size(); ++k)
      x_.set(plan_.copies[k], x[plan_.copies[k]] + (x_[plan_.copied[k]] - x[plan_.copied[k]]));
  }

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  GuardedElements const& plan_;
  Coordinates& x_;
  CoordinateViews<Kokkos::HostSpace> now_,
      baseline_;  ///< x_ and the mesh's: counting who shares them costs more than a determinant
  RelaxOptions const& options_;
  std::vector<signed char> signs_;
  detail::ElementTables<Kokkos::HostSpace> tables_;
  std::vector<std::uint8_t> held_;
  CsrGraph middles_of_node_;     ///< rows of GuardedElements::middle that follow each node
  CsrGraph elements_of_middle_;  ///< per row
  std::optional<detail::MiddleNodes> middle_nodes_;
  std::vector<Vec3> pull_;            ///< per row, what pulling added; empty where nothing was
  std::vector<std::uint8_t> pulled_;  ///< per row
};

}  // namespace

GuardReport relax_bad_elements(Mesh const& mesh, UnstructuredTopology const& topology, GuardedElements const& plan,
                               Coordinates& morphed, RelaxOptions const& options) {
  return Relaxation(mesh, topology, plan, morphed, options).run();
}

}  // namespace gridmorph
