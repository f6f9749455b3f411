#include <gridmorph/boundary/periodic_copies.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/disjoint_sets.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

/// Transforms and their inverses, those that carry points alike once.
std::vector<RigidTransform> both_ways(Boundary const& boundary, std::vector<Vec3> const& points,
                                      std::vector<RigidTransform> const& transforms) {
  double const tolerance = place_tolerance(1e-6, boundary.size(), boundary.precision().resolution());
  std::vector<RigidTransform> copies;
  auto const add = [&](RigidTransform const& transform) {
    bool const known = std::any_of(copies.begin(), copies.end(), [&](RigidTransform const& other) {
      return std::all_of(points.begin(), points.end(),
                         [&](Vec3 const& p) { return distance(transform(p), other(p)) <= tolerance; });
    });
    if (!known) copies.push_back(transform);
  };
  for (RigidTransform const& transform : transforms) {
    add(transform);
    add(transform.inverse());
  }
  return copies;
}

}  // namespace

std::vector<RigidTransform> periodic_copies(Boundary const& boundary, std::vector<int> const& patches) {
  return both_ways(boundary, boundary.points(patches), boundary.periodic_transforms(patches));
}

std::vector<PatchesOfRow> patches_by_row(Boundary const& boundary, std::vector<int> const& patches) {
  auto const connections = boundary.connections();
  DisjointSets<int> rows(boundary.zones().size());
  for (AnyConnection const& c : connections) rows.join(c.zone, c.donor_zone);
  std::map<int, PatchesOfRow> found;
  for (int const p : patches) found[rows.root(boundary.patches()[p].zone)].patches.push_back(p);
  std::vector<PatchesOfRow> out;
  for (auto& [root, row] : found) {
    std::vector<RigidTransform> transforms;
    for (AnyConnection const& c : connections)
      if (c.periodic && rows.root(c.zone) == root) transforms.push_back(boundary.transform(c.number));
    row.copies = both_ways(boundary, boundary.points(row.patches), transforms);
    out.push_back(std::move(row));
  }
  return out;
}

FacetList with_copies(FacetList const& own, std::vector<RigidTransform> const& copies) {
  FacetList all = own;
  for (RigidTransform const& transform : copies) {
    FacetList copy = own;
    for (Vec3& p : copy.points) p = transform(p);
    all.add(copy);
  }
  return all;
}

}  // namespace gridmorph
