#include <gridmorph/plan/blocks/edge_star.hpp>

#include <algorithm>

namespace gridmorph {

EdgeStar star_of(Lattice const& lattice, int edge_class) {
  EdgeStar star;
  for (EntityCopy const& copy : lattice.copies(edge_class)) {
    int const zone = lattice.zone_of(copy.entity);
    Index3 const p = lattice.position(copy.entity);
    Index3 extent;
    for (int a = 0; a < 3; ++a) extent[a] = 2 * int(lattice.cuts()[zone][a].size()) - 1;
    // Positions on cut planes are even, those between them odd: an edge is even along the two axes across it.
    int normals[2], found = 0;
    for (int a = 0; a < 3; ++a)
      if (p[a] % 2 == 0) normals[found++] = a;
    for (int su = -1; su <= 1; su += 2)
      for (int sv = -1; sv <= 1; sv += 2) {
        Index3 volume = p, face_u = p, face_v = p;
        volume[normals[0]] += su;
        volume[normals[1]] += sv;
        face_u[normals[0]] += su;
        face_v[normals[1]] += sv;
        // Beyond the end of the zone: another copy of the edge has the pieces there.
        if (volume[normals[0]] < 0 || volume[normals[0]] >= extent[normals[0]] || volume[normals[1]] < 0 ||
            volume[normals[1]] >= extent[normals[1]])
          continue;
        int const fu = lattice.class_of(lattice.entity(zone, face_u));
        int const fv = lattice.class_of(lattice.entity(zone, face_v));
        star.pieces.push_back(lattice.piece_of_volume(lattice.entity(zone, volume)));
        star.corner_faces.emplace_back(fu, fv);
        star.faces.push_back(fu);
        star.faces.push_back(fv);
      }
  }
  std::sort(star.faces.begin(), star.faces.end());
  star.faces.erase(std::unique(star.faces.begin(), star.faces.end()), star.faces.end());
  return star;
}

int straight_on(EdgeStar const& star, int face_class) {
  auto const other = [](std::pair<int, int> const& corner, int face) {
    return corner.first == face ? corner.second : corner.second == face ? corner.first : -1;
  };
  int found = -1;
  for (std::size_t first = 0; first < star.corner_faces.size(); ++first) {
    int const between = other(star.corner_faces[first], face_class);
    if (between < 0) continue;
    for (std::size_t second = 0; second < star.corner_faces.size(); ++second) {
      int const beyond = second == first ? -1 : other(star.corner_faces[second], between);
      if (beyond < 0 || beyond == face_class) continue;
      if (found >= 0 && found != beyond) return -1;
      found = beyond;
    }
  }
  return found;
}

}  // namespace gridmorph
