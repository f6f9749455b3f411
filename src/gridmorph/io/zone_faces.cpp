#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_zones.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>

namespace gridmorph::io {

namespace {

std::vector<Index32> ascending(std::span<Index32 const> nodes) {
  std::vector<Index32> out(nodes.begin(), nodes.end());
  std::sort(out.begin(), out.end());
  return out;
}

/// A key that is the same for the same nodes in any order; others may share it.
std::uint64_t key_of(std::span<Index32 const> nodes) {
  std::uint64_t sum = 0, product = 1;
  for (Index32 const n : nodes) {
    std::uint64_t const mixed = (std::uint64_t(n) + 1) * 0x9e3779b97f4a7c15u;
    sum += mixed ^ (mixed >> 29);
    product *= mixed | 1;
  }
  return sum ^ product;
}

/// A face as one of its elements has it.
struct Seen {
  std::uint64_t key;
  Index32 element;  ///< of the zone
  Index32 side;     ///< of all sides, in the order of elements
};

}  // namespace

ZoneFaces::ZoneFaces(Mesh const& mesh, Zone const& zone) {
  CsrGraph sides;
  std::vector<Seen> seen;
  std::vector<int> n_sides_of(zone.n_elements, 0);
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < zone.n_elements; ++e)
    for (int s = 0; s < n_sides(mesh, zone.first_element + e); ++s) {
      auto const nodes = side_nodes(mesh, zone.first_element + e, s, room);
      if (nodes.size() < 3) continue;  // collapsed
      seen.push_back({key_of(nodes), Index32(e), Index32(sides.size())});
      sides.add(nodes);
      ++n_sides_of[e];
    }
  std::sort(seen.begin(), seen.end(),
            [](Seen const& a, Seen const& b) { return a.key != b.key ? a.key < b.key : a.side < b.side; });

  // Side -> the first one with its nodes.
  std::vector<Index32> first(seen.size());
  std::vector<std::pair<std::vector<Index32>, Seen>> group;
  for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
    while (end < seen.size() && seen[end].key == seen[begin].key) ++end;
    group.clear();
    for (std::size_t n = begin; n < end; ++n) group.emplace_back(ascending(sides[seen[n].side]), seen[n]);
    std::stable_sort(group.begin(), group.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    for (std::size_t n = 0, from = 0; n < group.size(); ++n) {
      if (group[n].first != group[from].first) from = n;
      if (n - from > 1)
        throw MeshError(mesh.source + ": " + describe_element(mesh, zone.first_element + group[n].second.element) +
                        " shares a face with two others");
      first[group[n].second.side] = group[from].second.side;
    }
  }

  std::vector<Index32> number(seen.size());
  Index32 side = 0;
  for (Index e = 0; e < zone.n_elements; ++e) {
    std::vector<Index32> row;
    for (int s = 0; s < n_sides_of[e]; ++s, ++side) {
      auto const own = std::size_t(side), other = std::size_t(first[own]);
      if (other == own) {
        by_key_.emplace_back(key_of(sides[side]), Index32(faces_.size()));
        faces_.add(sides[side]);
        number[own] = Index32(faces_.size());
      }
      row.push_back(other == own ? number[own] : -number[other]);
    }
    elements_.add(row);
  }
  std::sort(by_key_.begin(), by_key_.end());
}

Index ZoneFaces::find(std::span<Index32 const> nodes) const {
  std::uint64_t const key = key_of(nodes);
  auto const wanted = ascending(nodes);
  for (auto at = std::lower_bound(by_key_.begin(), by_key_.end(), std::pair{key, Index32(0)});
       at != by_key_.end() && at->first == key; ++at)
    if (ascending(faces_[at->second]) == wanted) return at->second;
  return -1;
}

}  // namespace gridmorph::io
