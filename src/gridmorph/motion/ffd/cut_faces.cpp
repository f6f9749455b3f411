#include <gridmorph/motion/ffd/cut_faces.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

namespace gridmorph {

namespace {

/// Calls visit(a, b) for the sides of the facets of a patch, as places in its nodes.
template <class Visit>
void for_each_side(BoundarySurface const& surface, Visit visit) {
  if (surface.grid) {
    auto const [across, along] = *surface.grid;
    for (int b = 0; b < along; ++b)
      for (int a = 0; a < across; ++a) {
        if (a + 1 < across) visit(b * across + a, b * across + a + 1);
        if (b + 1 < along) visit(b * across + a, (b + 1) * across + a);
      }
    return;
  }
  for (GridFacet const& facet : surface.faces) {
    auto const corners = std::count_if(facet.begin(), facet.end(), [](int c) { return c >= 0; });
    for (int c = 0; c < corners; ++c) visit(facet[std::size_t(c)], facet[std::size_t((c + 1) % corners)]);
  }
}

/// The face through which the way from a place inside to a point outside leaves.
std::size_t exit_of(FfdLattice const& lattice, Vec3 from, Vec3 place, Vec3 to) {
  // In bent lattices the way is followed to near where it ends.
  for (int n = 0; n < 6 && !lattice.is_box(); ++n) {
    Vec3 const middle = 0.5 * (from + to);
    if (auto const inside = lattice.place(middle)) {
      from = middle;
      place = *inside;
    } else {
      to = middle;
    }
  }
  Vec3 const way = lattice.step(place, to - from);
  std::array<double, 3> const at{place.x, place.y, place.z}, by{way.x, way.y, way.z};
  std::array<double, 6> to_face{}, beyond{};  // along the face's own coordinate
  for (std::size_t f = 0; f < 6; ++f) {
    to_face[f] = f % 2 == 0 ? -at[f / 2] : 1 - at[f / 2];
    beyond[f] = f % 2 == 0 ? to_face[f] - by[f / 2] : by[f / 2] - to_face[f];
  }
  double const farthest = *std::max_element(beyond.begin(), beyond.end());
  std::size_t out = 0;
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < 6; ++f) {
    // What runs along a face, and leaves it by round-off alone, does not leave there.
    if (beyond[f] <= 1e-6 * farthest || by[f / 2] == 0 || to_face[f] / by[f / 2] >= first) continue;
    first = to_face[f] / by[f / 2];
    out = f;
  }
  return out;
}

}  // namespace

std::array<bool, 6> cut_faces(Boundary const& boundary, std::vector<int> const& patches, FfdLattice const& lattice) {
  std::array<bool, 6> cut{};
  for (int const p : patches) {
    BoundarySurface const& surface = boundary.surface(p);
    auto const point = [&](int n) { return boundary.coordinates()[surface.nodes[std::size_t(n)]]; };
    std::vector<std::optional<Vec3>> places;
    for (std::size_t n = 0; n < surface.nodes.size(); ++n) places.push_back(lattice.place(point(int(n))));
    for_each_side(surface, [&](int a, int b) {
      auto const &one = places[std::size_t(a)], &other = places[std::size_t(b)];
      if (one.has_value() == other.has_value()) return;
      cut[one ? exit_of(lattice, point(a), *one, point(b)) : exit_of(lattice, point(b), *other, point(a))] = true;
    });
  }
  return cut;
}

}  // namespace gridmorph
