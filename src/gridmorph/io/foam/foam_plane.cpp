#include <gridmorph/io/foam/foam_plane.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph::foam {

namespace {

constexpr double opposite = 1e-6;  // of the mesh size

double component(Vec3 const& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The axis that planes of type `empty` lie across: that of the largest component of their first face's normal.
int axis_across(std::vector<BoundaryEntry> const& boundary, CsrGraph const& faces, Coordinates const& coordinates) {
  for (BoundaryEntry const& entry : boundary) {
    if (entry["type"] != "empty" || entry.size == 0) continue;
    Vec3 const normal = face_normal(faces[entry.start], coordinates);
    double const x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    return z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  }
  return 2;
}

enum Side : char { none, upper, lower };

}  // namespace

Vec3 face_normal(std::span<Index32 const> nodes, Coordinates const& coordinates) {
  auto const arm = [&](std::size_t k) { return coordinates[nodes[k]] - coordinates[nodes[0]]; };
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) sum += cross(arm(k), arm(k + 1));
  return sum;
}

std::optional<PlanePairs> plane_pairs(std::vector<BoundaryEntry> const& boundary, CsrGraph const& faces,
                                      Coordinates const& coordinates, double size, std::string& why_not) {
  // The files may be others than those that were read and checked.
  for (Index32 const n : faces.item)
    if (n < 0 || n >= coordinates.size()) {
      why_not = "faces with nodes that there are not";
      return std::nullopt;
    }
  std::vector<char> side(std::size_t(coordinates.size()), none);
  bool any = false;
  int const axis = axis_across(boundary, faces, coordinates);
  for (BoundaryEntry const& entry : boundary) {
    if (entry["type"] != "empty") continue;
    for (Index f = entry.start; f < entry.start + entry.size; ++f) {
      any = true;
      char const own = component(face_normal(faces[f], coordinates), axis) > 0 ? upper : lower;
      if (own == upper && faces[f].size() > 4) {
        why_not = "cells with more than four corners";
        return std::nullopt;
      }
      for (Index32 const n : faces[f]) {
        if (side[std::size_t(n)] != none && side[std::size_t(n)] != own) {
          why_not = "planes of type empty that do not lie across x, y or z";
          return std::nullopt;
        }
        side[std::size_t(n)] = own;
      }
    }
  }
  if (!any) return std::nullopt;
  PlanePairs pairs;
  for (Index f = 0; f < faces.size(); ++f) {
    auto const nodes = faces[f];
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      Index32 const a = nodes[v], b = nodes[(v + 1) % nodes.size()];
      if (side[std::size_t(a)] == upper && side[std::size_t(b)] == lower) pairs.push_back({a, b});
      if (side[std::size_t(a)] == lower && side[std::size_t(b)] == upper) pairs.push_back({b, a});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  bool one_to_one = 2 * Index(pairs.size()) == coordinates.size();
  for (std::size_t n = 1; n < pairs.size(); ++n) one_to_one = one_to_one && pairs[n][0] != pairs[n - 1][0];
  for (auto const& [a, b] : pairs) {
    Vec3 const across = coordinates[a] - coordinates[b];
    one_to_one = one_to_one && norm(across) > 0 &&
                 std::sqrt(std::max(0.0, dot(across, across) - component(across, axis) * component(across, axis))) <=
                     opposite * size;
  }
  if (one_to_one) return pairs;
  why_not = "nodes of its planes of type empty that are not opposite one another along x, y or z";
  return std::nullopt;
}

Mesh upper_plane(Mesh const& mesh, PlanePairs const& pairs, CsrGraph const& faces, std::vector<Index32> const& owner) {
  std::vector<Index32> number(std::size_t(mesh.n_nodes()), -1);
  for (std::size_t n = 0; n < pairs.size(); ++n) number[std::size_t(pairs[n][0])] = Index32(n);
  auto const on_plane = [&](std::span<Index32 const> nodes) {
    std::vector<Index32> out;
    for (Index32 const n : nodes)
      if (number[std::size_t(n)] >= 0) out.push_back(number[std::size_t(n)]);
    return out;
  };
  Mesh out;
  out.dimension = 2;
  out.source = mesh.source;
  out.first_number = mesh.first_number;
  out.notes = mesh.notes;
  out.add_zone(mesh.zones.front().name, Index(pairs.size()));
  out.zones.back().single_precision = mesh.zones.front().single_precision;
  std::vector<std::pair<Index32, Index>> cells;  // by number
  for (Index f = 0; f < faces.size(); ++f)
    if (on_plane(faces[f]).size() == faces[f].size()) cells.emplace_back(owner[std::size_t(f)], f);
  std::sort(cells.begin(), cells.end());
  for (auto const& [cell, f] : cells) {
    auto const nodes = on_plane(faces[f]);
    out.add_element(nodes.size() == 3 ? ElementType::triangle : ElementType::quadrilateral, nodes);
    out.elements.number.push_back(cell);
  }
  out.coordinates = Coordinates(Index(pairs.size()));
  for (std::size_t n = 0; n < pairs.size(); ++n) out.coordinates.set(Index(n), mesh.coordinates[pairs[n][0]]);
  for (Patch const& patch : mesh.patches) {
    if (patch.bc_type == "empty") continue;
    Patch edges = patch;
    edges.faces = {};
    for (Index f = 0; f < patch.faces.size(); ++f)
      if (auto const nodes = on_plane(patch.faces[f]); nodes.size() == 2) edges.faces.add(nodes);
    out.patches.push_back(std::move(edges));
  }
  std::vector<Index32> element(std::size_t(mesh.n_elements()), -1);  // of a cell
  for (std::size_t e = 0; e < out.elements.number.size(); ++e)
    element[std::size_t(out.elements.number[e])] = Index32(e);
  for (Subset const& subset : mesh.subsets) {
    Subset own{subset.name, {}};
    for (Index32 const c : subset.elements)
      if (element[std::size_t(c)] >= 0) own.elements.push_back(element[std::size_t(c)]);
    for (Index f = 0; f < subset.faces.size(); ++f)
      if (auto const nodes = on_plane(subset.faces[f]); nodes.size() == 2) own.faces.add(nodes);
    out.subsets.push_back(std::move(own));
  }
  for (Connection const& connection : mesh.connections) {
    Connection own = connection;
    own.nodes.clear();
    own.donor_nodes.clear();
    for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
      Index32 const a = number[std::size_t(connection.nodes[n])], b = number[std::size_t(connection.donor_nodes[n])];
      if (a < 0 || b < 0) continue;
      own.nodes.push_back(a);
      own.donor_nodes.push_back(b);
    }
    if (!own.nodes.empty()) out.connections.push_back(std::move(own));
  }
  return out;
}

Coordinates both_planes(Coordinates const& all, PlanePairs const& pairs, Coordinates const& morphed) {
  Coordinates out(all.size());
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    Vec3 const to = morphed[Index(n)], from = all[pairs[n][0]], below = all[pairs[n][1]];
    Vec3 const across = from - below;
    double const x = std::abs(across.x), y = std::abs(across.y), z = std::abs(across.z);
    int const axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
    // Equal numbers stay equal, and those that do not change their bits.
    auto const moved = [](double below, double from, double to) {
      return to == from ? below : below == from ? to : below + (to - from);
    };
    auto const stays = [axis](int k, double before, double after) { return k == axis ? before : after; };
    out.set(pairs[n][0], {stays(0, from.x, to.x), stays(1, from.y, to.y), stays(2, from.z, to.z)});
    out.set(pairs[n][1],
            {stays(0, below.x, moved(below.x, from.x, to.x)), stays(1, below.y, moved(below.y, from.y, to.y)),
             stays(2, below.z, moved(below.z, from.z, to.z))});
  }
  return out;
}

}  // namespace gridmorph::foam
