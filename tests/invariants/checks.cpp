#include "invariants/checks.hpp"

#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace gridmorph::test {
namespace {

using kernels::FacetFoot;

template <class Visit>
void each_node(Zone const& zone, IndexRange const& r, Visit&& visit) {
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) visit(Index3{i, j, k}, zone.node({i, j, k}));
}

}  // namespace

std::string interface_nodes_that_differ(Outcome const& run) {
  Index count = 0;
  std::string first;
  for (Interface1to1 const& face : run.mesh.interfaces) {
    if (face.periodic) continue;
    each_node(run.mesh.zones[face.zone], face.range, [&](Index3 const& p, Index n) {
      Index const donor = run.mesh.zones[face.donor_zone].node(face.to_donor(p));
      if (same_bits(run.u(n), run.u(donor))) return;
      if (count++ == 0)
        first = describe_node(run.mesh, n) + " and " + describe_node(run.mesh, donor) + " of interface " + face.name;
    });
  }
  if (count > 0) first += ", " + std::to_string(count) + " nodes in all";
  return first;
}

double periodic_mismatch(Outcome const& run) {
  double worst = 0;
  for (Interface1to1 const& face : run.mesh.interfaces) {
    if (!face.periodic) continue;
    std::vector<Vec3> own, donor;
    std::vector<std::pair<Index, Index>> nodes;
    each_node(run.mesh.zones[face.zone], face.range, [&](Index3 const& p, Index n) {
      Index const d = run.mesh.zones[face.donor_zone].node(face.to_donor(p));
      nodes.emplace_back(n, d);
      own.push_back(run.mesh.coordinates[n]);
      donor.push_back(run.mesh.coordinates[d]);
    });
    bool const turns = norm(face.periodic->rotation_angle_rad) > 0;
    RigidTransform const t = turns ? fit_rigid_transform(own, donor) : face.periodic->declared;
    for (auto const& [n, d] : nodes) {
      worst = std::max(worst, distance(t.rotation * run.u(n), run.u(d)));
      double const before = distance(t(run.mesh.coordinates[n]), run.mesh.coordinates[d]);
      double const after = distance(t(run.morphed.position[n]), run.morphed.position[d]);
      worst = std::max(worst, after - before);
    }
  }
  return worst;
}

double off_slip_surface(Outcome const& run) {
  double worst = 0;
  for (int p = 0; p < int(run.mesh.patches.size()); ++p) {
    auto const surface = run.prepared.surface.slip_surface(p);
    if (!surface) continue;
    Patch const& patch = run.mesh.patches[p];
    auto const offset = [&](Vec3 const& x) {
      if (surface->kind == SlipSurface::Kind::facets) {
        FacetFoot const foot = surface->facets.closest_point(x);
        return dot(x - foot.point, foot.normal);
      }
      if (surface->kind == SlipSurface::Kind::axial) return dot(x - surface->origin, surface->direction);
      Vec3 const d = x - surface->origin;
      double const a = dot(d, surface->direction);
      if (surface->kind == SlipSurface::Kind::plane) return a;
      double const r = norm(d - a * surface->direction);
      if (surface->kind == SlipSurface::Kind::meridional) return surface->view().foot(a, r).away;
      return r - surface->profile(a);
    };
    each_node(run.mesh.zones[patch.zone], patch.range, [&](Index3 const&, Index n) {
      double const change = offset(run.morphed.position[n]) - offset(run.mesh.coordinates[n]);
      worst = std::max(worst, std::abs(change) / surface->size);
    });
  }
  return worst;
}

double known_displacement_error(Outcome const& run) {
  double worst = 0;
  for (int p = 0; p < int(run.mesh.patches.size()); ++p) {
    int const rule = run.prepared.surface.motion().patch[p].rule;
    if (!run.prepared.surface.is_explicit(rule)) continue;
    Patch const& patch = run.mesh.patches[p];
    each_node(run.mesh.zones[patch.zone], patch.range, [&](Index3 const&, Index n) {
      Vec3 const x = run.mesh.coordinates[n];
      Vec3 wanted;
      run.prepared.surface.displacement(rule, {&x, 1}, {&wanted, 1});
      worst = std::max(worst, distance(wanted, run.u(n)));
    });
  }
  return worst;
}

Index boundary_values_changed(Outcome const& run) {
  std::set<Index> on_axis;
  for (auto const& copy : run.plan().boundary_projections)
    for (Index q = 0; q < copy.n_q; ++q)
      for (Index p = 0; p < copy.n_p; ++p)
        on_axis.insert(copy.source + p * copy.source_stride_p + q * copy.source_stride_q);
  Index count = 0;
  for (std::size_t n = 0; n < run.boundary.size(); ++n) {
    Index const node = run.plan().boundary_nodes[n];
    double const allowed = on_axis.contains(run.plan().boundary_slots[n]) ? 1e-15 * norm(run.boundary[n]) : 0;
    count += distance(run.u(node), run.boundary[n]) <= allowed ? 0 : 1;
  }
  return count;
}

Index not_finite(Outcome const& run) {
  Index count = 0;
  for (Index n = 0; n < run.mesh.n_nodes(); ++n) count += std::isfinite(norm(run.u(n))) ? 0 : 1;
  return count;
}

}  // namespace gridmorph::test
