#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph {

namespace {

class Relaxation {
 public:
  Relaxation(Mesh const& mesh, UnstructuredTopology const& topology, PreparedUnstructured const& prepared,
             Coordinates& morphed, RelaxOptions const& options)
      : mesh_(mesh),
        topology_(topology),
        prepared_(prepared),
        x_(morphed),
        options_(options),
        signs_(detail::signs_of({}, mesh, topology.sides, options.signs)) {}

  RelaxReport run() {
    RelaxReport report;
    std::vector<Index32> bad = find_bad();
    report.before = report.after = Index(bad.size());
    if (bad.empty()) return report;
    find_held();
    int sweeps = options_.sweeps;
    for (; report.rounds < options_.rounds && !bad.empty(); ++report.rounds) {
      std::vector<Index32> const nodes = nodes_around(bad);
      std::vector<Vec3> before;
      for (Index32 const n : nodes) before.push_back(x_[n]);
      smooth(nodes, sweeps);
      std::vector<Index32> now = touched(nodes, bad);
      std::erase_if(now, [this](Index32 e) { return !is_bad(e); });
      if (now.size() > bad.size()) {
        for (std::size_t k = 0; k < nodes.size(); ++k) x_.set(nodes[k], before[k]);
        copy_coincident();
        if ((sweeps /= 2) == 0) break;
        continue;
      }
      bad = std::move(now);
      report.after = Index(bad.size());
    }
    return report;
  }

 private:
  [[nodiscard]] double determinant(Index32 e, double sign, Coordinates const& x) const {
    kernels::ElementCorners c;
    auto const nodes = mesh_.elements.corners(e);
    for (std::size_t k = 0; k < nodes.size(); ++k) c.at[k] = x[nodes[k]];
    return element_determinant(mesh_.elements.type[std::size_t(e)], c, sign, prepared_.plan.plane_normal);
  }

  [[nodiscard]] bool is_bad(Index32 e) const {
    if (mesh_.elements.type[std::size_t(e)] == ElementType::polyhedron) return false;
    double const sign = signs_[std::size_t(e)], now = determinant(e, sign, x_);
    if (now > options_.share) return false;  // no determinant is above 1
    double const before = determinant(e, sign, mesh_.coordinates);
    return before > 0 ? !(now > options_.share * before) : before == 0 && now < 0;
  }

  [[nodiscard]] std::vector<Index32> find_bad() const {
    std::vector<std::uint8_t> mark(std::size_t(mesh_.n_elements()), 0);
    detail::for_all({}, "gridmorph::find_bad_elements", mesh_.n_elements(),
                    [&](Index e) { mark[std::size_t(e)] = is_bad(Index32(e)) ? 1 : 0; });
    std::vector<Index32> bad;
    for (std::size_t e = 0; e < mark.size(); ++e)
      if (mark[e] != 0) bad.push_back(Index32(e));
    return bad;
  }

  /// Elements that change when `nodes` move, and those that were bad; ascending.
  [[nodiscard]] std::vector<Index32> touched(std::vector<Index32> const& nodes, std::vector<Index32> const& bad) const {
    std::vector<Index32> found = bad;
    auto const add = [&](Index32 n) {
      auto const around = topology_.elements_of_nodes[n];
      found.insert(found.end(), around.begin(), around.end());
    };
    for (Index32 const n : nodes) add(n);
    UnstructuredPlan const& plan = prepared_.plan;
    for (std::size_t k = 0; k < plan.copies.size(); ++k)
      if (std::binary_search(nodes.begin(), nodes.end(), plan.copied[k])) add(plan.copies[k]);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  void find_held() {
    UnstructuredPlan const& plan = prepared_.plan;
    held_.assign(std::size_t(mesh_.n_nodes()), 0);
    for (auto const* list : {&plan.known, &plan.residual_nodes, &plan.columns.node})
      for (Index32 const n : *list) held_[std::size_t(n)] = 1;
    for (Index32 const n : plan.middle.target) held_[std::size_t(n)] = 1;
  }

  std::vector<Index32> nodes_around(std::vector<Index32> const& bad) const {
    std::vector<std::uint8_t> seen(std::size_t(mesh_.n_nodes()), 0);
    std::vector<Index32> found;
    auto const add = [&](Index32 n) {
      if (seen[std::size_t(n)]) return;
      seen[std::size_t(n)] = 1;
      found.push_back(n);
    };
    for (Index32 const e : bad)
      for (Index32 const c : mesh_.elements.corners(e)) add(prepared_.graph.representative[std::size_t(c)]);
    for (std::size_t begin = 0, ring = 0; ring < std::size_t(options_.rings); ++ring) {
      std::size_t const end = found.size();
      for (; begin < end; ++begin)
        for (Index32 const m : prepared_.graph.neighbours[found[begin]]) add(m);
    }
    std::erase_if(found, [&](Index32 n) { return held_[std::size_t(n)] != 0; });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Displacement at a node by the affine function that fits those of its neighbours best.
  [[nodiscard]] Vec3 affine_mean(Index32 n) const {
    Coordinates const& x = mesh_.coordinates;
    auto const neighbours = prepared_.graph.neighbours[n];
    double weights = 0;
    Vec3 centre, mean;
    auto const weight = [&](Index32 m) { return 1 / std::max(distance(x[n], x[m]), 1e-300); };
    for (Index32 const m : neighbours) {
      double const w = weight(m);
      weights += w;
      centre += w * x[m];
      mean += w * (x_[m] - x[m]);
    }
    if (!(weights > 0)) return x_[n] - x[n];
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
    UnstructuredPlan const& plan = prepared_.plan;
    Coordinates const& x = mesh_.coordinates;
    for (std::size_t k = 0; k < plan.copies.size(); ++k)
      x_.set(plan.copies[k], x[plan.copies[k]] + (x_[plan.copied[k]] - x[plan.copied[k]]));
  }

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  PreparedUnstructured const& prepared_;
  Coordinates& x_;
  RelaxOptions const& options_;
  std::vector<signed char> signs_;
  std::vector<std::uint8_t> held_;
};

}  // namespace

RelaxReport relax_bad_elements(Mesh const& mesh, UnstructuredTopology const& topology,
                               PreparedUnstructured const& prepared, Coordinates& morphed,
                               RelaxOptions const& options) {
  return Relaxation(mesh, topology, prepared, morphed, options).run();
}

}  // namespace gridmorph
