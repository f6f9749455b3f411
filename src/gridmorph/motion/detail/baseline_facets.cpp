#include <gridmorph/motion/detail/baseline_facets.hpp>

#include <gridmorph/boundary/joined_sides.hpp>
#include <gridmorph/boundary/patch_facets.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/geometry/facet_topology.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace gridmorph {
namespace {

bool overlap(IndexRange const& a, IndexRange const& b) {
  for (int d = 0; d < 3; ++d)
    if (a.begin[d] >= b.end[d] || b.begin[d] >= a.end[d]) return false;
  return true;
}

FacetList moved(FacetList list, RigidTransform const& transform) {
  for (Vec3& p : list.points) p = transform(p);
  return list;
}

}  // namespace

std::vector<std::vector<int>> smoothly_joined(Mesh const& mesh, std::vector<int> const& patches,
                                              FacetOptions const& options) {
  FacetList const list = facets_of_patches(mesh, patches);
  std::vector<int> patch_of;  // per facet of the list, as a place in `patches`
  for (std::size_t m = 0; m < patches.size(); ++m)
    patch_of.resize(patch_of.size() + facets_of_patches(mesh, {&patches[m], 1}).facets.size(), int(m));

  std::map<std::pair<int, int>, int> balance;  // smooth edges less creases between two patches
  if (!list.facets.empty()) {
    FacetTopology const topology(list, options);
    for (FacetEdge const& edge : topology.edges) {
      if (edge.facet[1] < 0) continue;
      int const a = patch_of[topology.source[edge.facet[0]]], b = patch_of[topology.source[edge.facet[1]]];
      if (a != b) balance[{std::min(a, b), std::max(a, b)}] += edge.crease ? -1 : 1;
    }
  }
  DisjointSets<int> groups(patches.size());
  for (auto const& [pair, smooth] : balance)
    if (smooth > 0) groups.join(pair.first, pair.second);
  std::map<int, std::vector<int>> members;
  for (std::size_t m = 0; m < patches.size(); ++m) members[groups.root(int(m))].push_back(patches[m]);
  std::vector<std::vector<int>> out;
  for (auto& [number, list_of] : members) out.push_back(std::move(list_of));
  return out;
}

FacetList with_periodic_copies(Mesh const& mesh, std::vector<int> const& patches) {
  FacetList const own = facets_of_patches(mesh, patches);
  double const tolerance = 1e-6 * mesh.size();
  std::vector<RigidTransform> copies;
  auto const add = [&](RigidTransform const& transform) {
    bool const known = std::any_of(copies.begin(), copies.end(), [&](RigidTransform const& other) {
      return std::all_of(own.points.begin(), own.points.end(),
                         [&](Vec3 const& p) { return distance(transform(p), other(p)) <= tolerance; });
    });
    if (!known) copies.push_back(transform);
  };
  for (Interface1to1 const& interface : mesh.interfaces) {
    if (!interface.periodic) continue;
    IndexRange const donor = interface.to_donor(interface.range);
    bool const touched = std::any_of(patches.begin(), patches.end(), [&](int p) {
      Patch const& patch = mesh.patches[p];
      return (patch.zone == interface.zone && overlap(patch.range, interface.range)) ||
             (patch.zone == interface.donor_zone && overlap(patch.range, donor));
    });
    if (!touched) continue;
    RigidTransform const transform = fitted_transform(mesh, interface);
    add(transform);
    add(transform.inverse());
  }
  FacetList all = own;
  for (RigidTransform const& transform : copies) all.add(moved(own, transform));
  return all;
}

}  // namespace gridmorph
