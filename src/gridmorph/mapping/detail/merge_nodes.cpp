#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/detail/merge_nodes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace gridmorph::casefile {

namespace {

constexpr double conflict = 1e-6;  // of the largest displacement

double largest(std::vector<Vec3> const& field) {
  double out = 0;
  for (Vec3 const& u : field) out = std::max(out, norm(u));
  return out;
}

/// For every node the first one at its position.
std::vector<std::size_t> first_at_position(std::vector<Vec3> const& p) {
  std::vector<std::size_t> order(p.size()), first(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (p[a].x != p[b].x) return p[a].x < p[b].x;
    if (p[a].y != p[b].y) return p[a].y < p[b].y;
    if (p[a].z != p[b].z) return p[a].z < p[b].z;
    return a < b;
  });
  for (std::size_t n = 0, group = 0; n < order.size(); ++n) {
    if (!(p[order[group]] == p[order[n]])) group = n;
    first[order[n]] = order[group];
  }
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
    double const limit = conflict * largest(field);
    for (std::size_t b = 0; b < first.size(); ++b) {
      std::size_t const a = first[b];
      Vec3 const ua = field[a], ub = field[b], p = nodes.position[b];
      if (a != b && distance(ua, ub) > limit)
        throw ConfigError(
            fmt::format("{}: the point ({:.9g}, {:.9g}, {:.9g}) moves by ({:.6g}, {:.6g}, {:.6g}), but by ({:.6g}, "
                        "{:.6g}, {:.6g}) in line {}; give each point one displacement",
                        nodes.where(b), p.x, p.y, p.z, ub.x, ub.y, ub.z, ua.x, ua.y, ua.z, nodes.line[a]));
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

}  // namespace gridmorph::casefile
