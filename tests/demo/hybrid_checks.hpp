// What every hybrid mesh of the demos must be, checked from its lists alone.
#pragma once

#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace hybrid_checks {

using namespace gridmorph;

using Key = std::array<Index32, 4>;

inline Key key_of(std::span<Index32 const> corners) {
  Key key{-1, -1, -1, -1};
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

/// Sides of all elements by their corner nodes: how many elements have them, and of which patches they are faces.
struct Side {
  int elements = 0;
  int claims = 0;
};

inline std::map<Key, Side> sides_of(Mesh const& mesh) {
  std::map<Key, Side> sides;
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) ++sides[key_of(side_nodes(mesh, e, s, room))].elements;
  for (auto const& patch : mesh.patches)
    for (Index f = 0; f < patch.faces.size(); ++f) ++sides[key_of(patch.faces[f])].claims;
  return sides;
}

inline void expect_conforming_and_covered(Mesh const& mesh) {
  check_mesh(mesh);
  Index inside = 0, boundary = 0;
  for (auto const& [key, side] : sides_of(mesh)) {
    ASSERT_TRUE((side.elements == 2 && side.claims == 0) || (side.elements == 1 && side.claims == 1))
        << side.elements << " elements and " << side.claims << " faces of patches share the nodes " << key[0] << ' '
        << key[1] << ' ' << key[2] << ' ' << key[3];
    ++(side.elements == 2 ? inside : boundary);
  }
  EXPECT_GT(inside, boundary);
}

inline kernels::ElementCorners corners(Mesh const& mesh, Index e) {
  kernels::ElementCorners c;
  auto const list = mesh.elements.corners(e);
  for (std::size_t n = 0; n < list.size(); ++n) c.at[n] = mesh.coordinates[list[n]];
  return c;
}

struct Soundness {
  double smallest_volume = kernels::unbounded, smallest_determinant = kernels::unbounded, largest_aspect_ratio = 0,
         volume = 0;
};

inline Soundness soundness(Mesh const& mesh) {
  Soundness x;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const m = element_measures(mesh.elements.type[e], corners(mesh, e), 1, {0, 0, 1});
    x.smallest_volume = std::min(x.smallest_volume, m.volume);
    x.smallest_determinant = std::min(x.smallest_determinant, m.determinant_2x2x2);
    x.largest_aspect_ratio = std::max(x.largest_aspect_ratio, m.aspect_ratio);
    x.volume += m.volume;
  }
  return x;
}

inline Patch const& patch(Mesh const& mesh, std::string const& name) {
  auto const found =
      std::find_if(mesh.patches.begin(), mesh.patches.end(), [&](Patch const& p) { return p.name == name; });
  if (found == mesh.patches.end()) throw std::runtime_error("no patch " + name);
  return *found;
}

/// Volume that the faces of all patches enclose; exact where they are plane, and if they close.
inline double enclosed_volume(Mesh const& mesh) {
  double sum = 0;
  std::map<Key, std::vector<Index32>> outward;
  std::array<Index32, max_face_corners> room{};
  for (auto const& p : mesh.patches)
    for (Index f = 0; f < p.faces.size(); ++f) outward[key_of(p.faces[f])];
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const nodes = side_nodes(mesh, e, s, room);
      if (auto const found = outward.find(key_of(nodes)); found != outward.end())
        found->second.assign(nodes.begin(), nodes.end());
    }
  for (auto const& [key, nodes] : outward) {
    auto const x = [&](std::size_t n) { return mesh.coordinates[nodes[n]]; };
    auto const cone = [](Vec3 const& a, Vec3 const& b, Vec3 const& c) { return dot(a, cross(b, c)) / 6; };
    if (nodes.size() == 3)
      sum += cone(x(0), x(1), x(2));
    else  // the mean of both ways to cut it: the bilinear surface
      sum += (cone(x(0), x(1), x(2)) + cone(x(0), x(2), x(3)) + cone(x(1), x(2), x(3)) + cone(x(1), x(3), x(0))) / 2;
  }
  return sum;
}

inline bool same_lists(CsrGraph const& a, CsrGraph const& b) { return a.first == b.first && a.item == b.item; }

inline bool same_coordinates(Mesh const& a, Mesh const& b) {
  if (a.n_nodes() != b.n_nodes()) return false;
  for (Index n = 0; n < a.n_nodes(); ++n)
    if (!(a.coordinates[n] == b.coordinates[n])) return false;
  return true;
}

}  // namespace hybrid_checks
