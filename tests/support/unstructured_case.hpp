// An unstructured mesh with what follows from it, ready to be morphed and measured.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {

/// Where the lattice carries the walls' motion there are wraps and backgrounds, and bodies stretch as wholes.
inline PlanOptions by_lattice() {
  PlanOptions options;
  options.elements.method = NearFieldMethod::lattice;
  return options;
}

struct UnstructuredMorphed {
  PreparedUnstructured prepared;
  std::vector<Vec3> boundary;
  Coordinates x;
};

struct UnstructuredCase {
  using Host = Kokkos::DefaultHostExecutionSpace;

  Mesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;

  explicit UnstructuredCase(Mesh m)
      : mesh(std::move(m)), topology(make_topology(mesh)), face_patches(find_face_patches(mesh, topology)) {}

  [[nodiscard]] UnstructuredMorphed morph(Motion const& motion, PlanOptions const& options = {}) const {
    UnstructuredMorphed out{prepare(mesh, topology, face_patches, motion, options), {}, Coordinates(mesh.n_nodes())};
    out.boundary = out.prepared.boundary_displacement();
    apply_on_host(MorpherAccess::of(Host(), out.prepared.plan, mesh.coordinates), out.boundary, out.x);
    return out;
  }

  /// The same with displacements smoothed around bad elements, as the command line does.
  [[nodiscard]] UnstructuredMorphed guarded_morph(Motion const& motion, PlanOptions const& options = {}) const {
    UnstructuredMorphed out = morph(motion, options);
    (void)relax_bad_elements(mesh, topology, out.prepared, out.x);
    return out;
  }

  /// Near and far field as one.
  [[nodiscard]] QualityRegion quality(Coordinates const& x) const {
    UnstructuredQualityInput<Kokkos::HostSpace> input;
    input.baseline = views(mesh.coordinates);
    input.coordinates = views(x);
    return measure_quality(Host(), mesh, topology, face_patches, input).far_field;
  }
  [[nodiscard]] Index inverted(Coordinates const& x) const { return quality(x).newly_inverted; }

  [[nodiscard]] int patch(std::string const& name) const {
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      if (mesh.patches[p].name == name) return int(p);
    return -1;
  }
  /// Nodes of a patch, those of its faces where it lists faces.
  [[nodiscard]] std::vector<Index32> nodes_of(std::string const& name) const {
    int const p = patch(name);
    return p < 0 ? std::vector<Index32>() : patch_nodes(mesh.patches[p]);
  }
  /// Largest deviation of known nodes from what their rules ask for: 0 bit for bit.
  [[nodiscard]] double largest_miss(UnstructuredMorphed const& m) const {
    double largest = 0;
    auto const& known = m.prepared.plan.known;
    for (std::size_t k = 0; k < known.size(); ++k)
      largest = std::max(largest, distance(m.x[known[k]], mesh.coordinates[known[k]] + m.boundary[k]));
    return largest;
  }
};

/// Positions of all nodes, planned and morphed on an execution space of the host.
template <class Exec>
Coordinates positions_on(Exec const& exec, UnstructuredCase const& c, Motion const& motion,
                         PlanOptions const& options) {
  auto const prepared = prepare(exec, c.mesh, c.topology, c.face_patches, motion, options);
  auto const boundary = prepared.boundary_displacement();
  Coordinates x(c.mesh.n_nodes());
  auto const morpher = MorpherAccess::of(exec, prepared.plan, c.mesh.coordinates);
  morpher.positions(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(boundary.data(), boundary.size()), x);
  exec.fence();
  return x;
}

/// How the velocities of a plan differ from centred differences of its displacements, at most; boundary(t):
/// displacements of its known nodes at time t. The time is 0.
struct RateError {
  double error = 0, largest = 0;  ///< largest difference, largest velocity
};
template <class Boundary>
RateError rate_error(UnstructuredCase const& c, UnstructuredPlan const& plan, Boundary const& boundary) {
  using Host = UnstructuredCase::Host;
  auto const morpher = MorpherAccess::of(Host(), plan, c.mesh.coordinates, {1, true});
  auto const view = [](std::vector<Vec3> const& v) {
    return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(v.data(), v.size());
  };
  auto const displacements = [&](std::vector<Vec3> const& at) {
    Coordinates u(c.mesh.n_nodes());
    morpher.displacements(Host(), view(at), u);
    Host().fence();
    return u;
  };
  double const h = 1e-5;
  std::vector<Vec3> const before = boundary(-h), after = boundary(h), now = boundary(0.0);
  std::vector<Vec3> rate;
  for (std::size_t k = 0; k < now.size(); ++k) rate.push_back((0.5 / h) * (after[k] - before[k]));
  Coordinates const u0 = displacements(before), u1 = displacements(after), v(c.mesh.n_nodes());
  morpher.velocities(Host(), view(now), view(rate), v);
  Host().fence();
  RateError out;
  for (Index n = 0; n < v.size(); ++n) {
    out.error = std::max(out.error, norm(v[n] - (0.5 / h) * (u1[n] - u0[n])));
    out.largest = std::max(out.largest, norm(v[n]));
  }
  return out;
}

inline MotionRule rule_for(std::vector<std::string> patches, Rule rule) {
  return {std::move(patches), std::move(rule), 0, "test"};
}
inline Motion motion_of(std::vector<MotionRule> rules) {
  Motion motion;
  motion.rules = std::move(rules);
  return motion;
}
inline Rule translation(Vec3 const& t) { return RigidRule{{}, t}; }
inline Rule rotation(Vec3 const& centre, Vec3 const& axis, double angle, Vec3 const& shift = {}) {
  RigidTransform const r = rotation_about(centre, axis, angle);
  return RigidRule{r.rotation, r.translation + shift};
}

}  // namespace gridmorph::test
