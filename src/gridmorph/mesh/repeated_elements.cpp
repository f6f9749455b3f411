#include <gridmorph/mesh/repeated_elements.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

using Partners = std::unordered_map<Index32, Index32>;

/// What two transforms make of some points differs by at most `tolerance`.
bool same(RigidTransform const& a, RigidTransform const& b, double size, double tolerance) {
  for (Vec3 const& p : {Vec3{}, Vec3{size, 0, 0}, Vec3{0, size, 0}, Vec3{0, 0, size}})
    if (distance(a(p), b(p)) > tolerance) return false;
  return true;
}

/// Nodes and those a pitch ahead, by each of the pitches of the mesh.
std::vector<Partners> partners_of(Mesh const& mesh) {
  double const size = mesh.size(), tolerance = 1e-5 * size;
  std::vector<RigidTransform> pitches;
  std::vector<Partners> out;
  for (Connection const& c : mesh.connections) {
    if (!c.periodic) continue;
    RigidTransform const& ahead = c.periodic->declared;
    std::size_t at = 0;
    bool back = false;
    for (; at < pitches.size(); ++at) {
      back = same(ahead.inverse(), pitches[at], size, tolerance);
      if (back || same(ahead, pitches[at], size, tolerance)) break;
    }
    if (at == pitches.size()) {
      pitches.push_back(ahead);
      out.emplace_back();
    }
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      out[at].emplace(back ? c.donor_nodes[n] : c.nodes[n], back ? c.nodes[n] : c.donor_nodes[n]);
  }
  return out;
}

std::vector<Index32> sorted(std::vector<Index32> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Elements, and those they are a pitch ahead.
std::vector<std::pair<Index, Index>> pairs_of_elements(Mesh const& mesh, Partners const& ahead) {
  std::set<Index32> behind;
  for (auto const& [node, partner] : ahead) behind.insert(partner);
  std::map<std::vector<Index32>, Index> copies;
  std::vector<std::pair<std::vector<Index32>, Index>> images;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    if (std::all_of(corners.begin(), corners.end(), [&](Index32 n) { return behind.contains(n); }))
      copies.emplace(sorted({corners.begin(), corners.end()}), e);
    if (!std::all_of(corners.begin(), corners.end(), [&](Index32 n) { return ahead.contains(n); })) continue;
    std::vector<Index32> image;
    for (Index32 const n : corners) image.push_back(ahead.at(n));
    images.emplace_back(sorted(std::move(image)), e);
  }
  std::vector<std::pair<Index, Index>> out;
  for (auto const& [nodes, e] : images)
    if (auto const copy = copies.find(nodes); copy != copies.end() && copy->second != e)
      out.emplace_back(e, copy->second);
  return out;
}

/// Nodes that some element has, but none of those that stay.
std::vector<char> lost_nodes(Mesh const& mesh, std::vector<char> const& left_out) {
  std::vector<char> out(mesh.n_nodes(), 0);
  for (char const leaving : {1, 0})
    for (Index e = 0; e < mesh.n_elements(); ++e)
      if (left_out[e] == leaving)
        for (Index32 const n : mesh.elements.nodes[e]) out[n] = leaving;
  return out;
}

template <class Nodes>
bool any_lost(Nodes const& nodes, std::vector<char> const& lost) {
  return std::any_of(nodes.begin(), nodes.end(), [&](Index32 n) { return lost[n] != 0; });
}

Index lost_faces(Mesh const& mesh, std::vector<char> const& lost) {
  Index out = 0;
  for (Patch const& patch : mesh.patches)
    for (Index f = 0; f < patch.faces.size(); ++f) out += any_lost(patch.faces[f], lost) ? 1 : 0;
  return out;
}

/// New numbers of those that stay, -1 for the others.
std::vector<Index32> renumbered(std::vector<char> const& gone) {
  std::vector<Index32> out(gone.size(), -1);
  Index32 next = 0;
  for (std::size_t n = 0; n < gone.size(); ++n)
    if (gone[n] == 0) out[n] = next++;
  return out;
}

void leave_out(Mesh& mesh, std::vector<char> const& elements, std::vector<char> const& nodes) {
  auto const node = renumbered(nodes), element = renumbered(elements);
  auto const renumber = [&](std::span<Index32 const> old) {
    std::vector<Index32> out;
    for (Index32 const n : old)
      if (node[n] >= 0) out.push_back(node[n]);
    return out;
  };
  Elements const old = std::exchange(mesh.elements, {});
  Coordinates const x = mesh.coordinates;
  std::vector<Zone> const zones = std::exchange(mesh.zones, {});
  for (Zone const& zone : zones) {
    auto const staying = [](std::vector<char> const& gone, Index first, Index n) {
      return Index(std::count(gone.begin() + first, gone.begin() + first + n, char(0)));
    };
    mesh.add_zone(zone.name, staying(nodes, zone.first_node, zone.size()));
    mesh.zones.back().single_precision = zone.single_precision;
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
      if (elements[e] != 0) continue;
      mesh.add_element(old.type[e], renumber(old.nodes[e]));
      mesh.elements.number.push_back(old.number.empty() ? Index32(mesh.first_number + e - zone.first_element)
                                                        : old.number[e]);
    }
  }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < x.size(); ++n)
    if (node[n] >= 0) mesh.coordinates.set(node[n], x[n]);
  for (Patch& patch : mesh.patches) {
    CsrGraph const faces = std::exchange(patch.faces, {});
    for (Index f = 0; f < faces.size(); ++f)
      if (!any_lost(faces[f], nodes)) patch.faces.add(renumber(faces[f]));
    patch.nodes = renumber(patch.nodes);
  }
  for (Connection& c : mesh.connections) {
    Connection const all = c;
    c.nodes.clear();
    c.donor_nodes.clear();
    for (std::size_t n = 0; n < all.nodes.size(); ++n) {
      Index32 const own = node[all.nodes[n]], donor = node[all.donor_nodes[n]];
      if (own < 0 || donor < 0) continue;
      c.nodes.push_back(own);
      c.donor_nodes.push_back(donor);
    }
  }
  std::erase_if(mesh.connections, [](Connection const& c) { return c.nodes.empty(); });
  for (Subset& subset : mesh.subsets) {
    std::vector<Index32> const all = std::exchange(subset.elements, {});
    for (Index32 const e : all)
      if (element[e] >= 0) subset.elements.push_back(element[e]);
    CsrGraph const faces = std::exchange(subset.faces, {});
    for (Index f = 0; f < faces.size(); ++f)
      if (!any_lost(faces[f], nodes)) subset.faces.add(renumber(faces[f]));
  }
}

}  // namespace

Index leave_out_repeated_elements(Mesh& mesh) {
  bool const blocks = std::any_of(mesh.zones.begin(), mesh.zones.end(), [](Zone const& z) { return z.is_block(); });
  if (blocks || !mesh.polyhedra.element.empty()) return 0;
  Index count = 0;
  for (std::size_t pitch = 0;; ++pitch) {
    auto const partners = partners_of(mesh);  // of the mesh as it is by now
    if (pitch >= partners.size()) break;
    auto const pairs = pairs_of_elements(mesh, partners[pitch]);
    if (pairs.empty()) continue;
    std::vector<char> first(mesh.n_elements(), 0), second = first;
    for (auto const& [e, image] : pairs) {
      first[e] = 1;
      second[image] = 1;
    }
    auto const lost_first = lost_nodes(mesh, first), lost_second = lost_nodes(mesh, second);
    if (lost_faces(mesh, lost_first) <= lost_faces(mesh, lost_second))
      leave_out(mesh, first, lost_first);
    else
      leave_out(mesh, second, lost_second);
    count += Index(pairs.size());
  }
  if (count > 0)
    mesh.notes.push_back(mesh.source + ": " + std::to_string(count) +
                         " elements repeat others a pitch away; they are left out");
  return count;
}

}  // namespace gridmorph
