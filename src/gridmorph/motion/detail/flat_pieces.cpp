#include <gridmorph/motion/detail/facet_groups.hpp>

#include <gridmorph/core/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

/// Cosine of the angle between neighbouring faces up to which they are of one piece: facets of curved surfaces have
/// less, creases between planes more.
constexpr double same_plane = 0.866;  // 30 degrees

/// Unit, zero of a collapsed face; of a line across the plane of the mesh and the line.
Vec3 normal_of(Boundary const& boundary, BoundarySurface const& surface, GridFacet const& face) {
  auto const x = [&](int corner) { return boundary.coordinates()[surface.nodes[face[corner]]]; };
  Vec3 const normal = face[2] < 0   ? cross(boundary.across(), x(1) - x(0))
                      : face[3] < 0 ? cross(x(1) - x(0), x(2) - x(0))
                                    : cross(x(2) - x(0), x(3) - x(1));
  double const length = norm(normal);
  return length > 0 ? (1 / length) * normal : Vec3{};
}

}  // namespace

std::vector<std::vector<Index>> flat_pieces(Boundary const& boundary, int patch) {
  BoundarySurface const& surface = boundary.surface(patch);
  auto const n_corners = [](GridFacet const& face) { return face[2] < 0 ? 2 : face[3] < 0 ? 3 : 4; };
  // What faces can have in common, and whose it is: edges, or the ends of lines.
  std::vector<std::pair<std::array<int, 2>, int>> sides;
  std::vector<Vec3> normal;
  for (int f = 0; f < int(surface.faces.size()); ++f) {
    GridFacet const& face = surface.faces[f];
    normal.push_back(normal_of(boundary, surface, face));
    int const corners = n_corners(face);
    for (int c = 0; c < corners; ++c) {
      int const a = face[c], b = corners == 2 ? a : face[(c + 1) % corners];
      sides.push_back({{std::min(a, b), std::max(a, b)}, f});
    }
  }
  std::sort(sides.begin(), sides.end());
  DisjointSets<int> sets(surface.faces.size());
  for (std::size_t n = 1; n < sides.size(); ++n) {
    if (sides[n].first != sides[n - 1].first) continue;
    int const f = sides[n - 1].second, g = sides[n].second;
    if (std::abs(dot(normal[f], normal[g])) >= same_plane) sets.join(f, g);
  }
  std::vector<std::vector<Index>> out;
  auto const piece_of = sets.set_numbers();
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    auto const piece = std::size_t(piece_of[f]);
    out.resize(std::max(out.size(), piece + 1));
    for (int c = 0; c < n_corners(surface.faces[f]); ++c) out[piece].push_back(surface.nodes[surface.faces[f][c]]);
  }
  for (auto& nodes : out) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return out;
}

}  // namespace gridmorph
