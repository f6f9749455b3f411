#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/point_numbers.hpp>
#include <gridmorph/mapping/detail/point_clouds.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace gridmorph::mapping {

namespace {

constexpr double conflict = 1e-6;  // of the largest displacement

/// The first node at the position of each node.
std::vector<std::size_t> first_at_position(std::vector<Vec3> const& p) {
  PointNumbers numbers(0);
  std::vector<std::size_t> first;
  for (std::size_t n = 0; n < p.size(); ++n) first.push_back(std::size_t(numbers.find_or_add(p[n], int(n))));
  return first;
}

void renumber(StructuralFacet& facet, std::vector<std::int32_t> const& number) {
  std::array<std::int32_t, 4> kept{-1, -1, -1, -1};
  int n = 0;
  int const corners = facet.corners();
  for (int c = 0; c < corners; ++c) {
    std::int32_t const node = number[facet.node[c]], next = number[facet.node[(c + 1) % corners]];
    if (node != next) kept[n++] = node;
  }
  if (n >= 3)
    facet.node = kept;
  else  // a line: whoever measures its area says so
    for (int c = 0; c < corners; ++c) facet.node[c] = number[facet.node[c]];
}

}  // namespace

void merge_nodes(StructuralModel& model, std::vector<std::vector<Vec3>>& fields) {
  PointCloud& nodes = model.nodes;
  auto const first = first_at_position(nodes.position);
  for (auto const& field : fields) {
    double const limit = conflict * largest_norm(field);
    for (std::size_t b = 0; b < first.size(); ++b) {
      std::size_t const a = first[b];
      if (a != b && distance(field[a], field[b]) > limit)
        throw ConfigError(fmt::format(
            "{}: the point {} moves by {}, but by {} in line {}; give each point one displacement", nodes.where(b),
            to_text(nodes.position[b], 9), to_text(field[b], 6), to_text(field[a], 6), nodes.line[a]));
    }
  }
  std::vector<std::int32_t> number(first.size());
  std::int32_t kept = 0;
  for (std::size_t n = 0; n < first.size(); ++n) {
    if (first[n] != n) {
      number[n] = number[first[n]];
      continue;
    }
    number[n] = kept;
    nodes.position[kept] = nodes.position[n];
    nodes.line[kept] = nodes.line[n];
    if (!nodes.id.empty()) nodes.id[kept] = nodes.id[n];
    for (auto& field : fields) field[kept] = field[n];
    ++kept;
  }
  nodes.position.resize(kept);
  nodes.line.resize(kept);
  if (!nodes.id.empty()) nodes.id.resize(kept);
  for (auto& field : fields) field.resize(kept);
  for (StructuralFacet& facet : model.facets) renumber(facet, number);
}

}  // namespace gridmorph::mapping
