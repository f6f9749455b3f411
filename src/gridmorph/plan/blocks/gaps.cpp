#include <gridmorph/plan/blocks/edge_star.hpp>
#include <gridmorph/plan/blocks/gaps.hpp>
#include <gridmorph/plan/blocks/line_walk.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace gridmorph {
namespace {

/// Longest lines over the root of the area.
constexpr double narrow = 0.5;

/// Patches that hold a node on the side of the zone where a line leaves it.
std::vector<int> patches_at(Mesh const& mesh, LinePlace const& place) {
  std::vector<int> found;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    Patch const& patch = mesh.patches[p];
    if (patch.zone == place.zone && patch.kind != PatchKind::region && patch.range.extent(place.axis) == 1 &&
        patch.range.contains(place.at))
      found.push_back(p);
  }
  return found;
}

/// Lines off a patch, evenly spread over it.
struct LinesOff {
  double mean_length = 0;
  bool to_slip = true;  ///< all of them end on walls that slip
};

LinesOff lines_off(Mesh const& mesh, Links const& links, int patch, std::vector<char> const& slips) {
  constexpr int most = 9;  // along either direction
  IndexRange const& r = mesh.patches[patch].range;
  int const axis = normal_axis(r);
  int const step = r.begin[axis] == 0 ? 1 : -1;
  Index3 n{};
  for (int d = 0; d < 3; ++d) n[d] = std::min(most, r.extent(d));
  LinesOff lines;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        Index3 const number{i, j, k};
        Index3 at{};
        for (int d = 0; d < 3; ++d)
          at[d] = r.begin[d] + (n[d] > 1 ? int(Index(number[d]) * (r.extent(d) - 1) / (n[d] - 1)) : 0);
        LinePlace place{mesh.patches[patch].zone, at, axis, step};
        Index nodes = 0;
        while (nodes++ < mesh.n_nodes() && advance(mesh, links, place, lines.mean_length)) {
        }
        auto const ends = patches_at(mesh, place);
        lines.to_slip = lines.to_slip && std::any_of(ends.begin(), ends.end(), [&](int p) { return slips[p] != 0; });
        if (!lines.to_slip) return lines;
      }
  lines.mean_length /= double(n[0]) * n[1] * n[2];
  return lines;
}

double area_of(Mesh const& mesh, Patch const& patch) {
  IndexRange const& r = patch.range;
  int const axis = normal_axis(r), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  Zone const& zone = mesh.zones[patch.zone];
  double area = 0;
  for (int q = r.begin[v]; q < r.end[v] - 1; ++q)
    for (int p = r.begin[u]; p < r.end[u] - 1; ++p) {
      auto const at = [&](int du, int dv) {
        Index3 node = r.begin;
        node[u] = p + du;
        node[v] = q + dv;
        return mesh.coordinates[zone.node(node)];
      };
      area += 0.5 * norm(cross(at(1, 1) - at(0, 0), at(0, 1) - at(1, 0)));
    }
  return area;
}

/// The edge classes around a face class.
std::set<int> edges_of(Lattice const& lattice, int face_class) {
  std::set<int> edges;
  for_closure(lattice, lattice.copies(face_class).front().entity, [&](int entity) {
    if (lattice.dimension(entity) == 1) edges.insert(lattice.class_of(entity));
  });
  return edges;
}

/// Faces that continue these ones across edges, as far as they go, where `takes` lets them.
template <class Takes>
std::vector<char> continued(Lattice const& lattice, std::vector<int> faces, Takes const& takes) {
  std::vector<char> reached(lattice.n_classes(), 0);
  for (int const f : faces) reached[f] = 1;
  for (std::size_t n = 0; n < faces.size(); ++n)
    for (int const edge : edges_of(lattice, faces[n])) {
      int const next = straight_on(star_of(lattice, edge), faces[n]);
      if (next < 0 || reached[next] != 0 || !takes(next)) continue;
      reached[next] = 1;
      faces.push_back(next);
    }
  return reached;
}

int face_at_end(Topology const& topology, Chain const& chain) {
  return topology.lattice.class_of(
      topology.blocks.face_entities(topology.lattice, end_face(chain.steps.back(), 1)).front());
}

}  // namespace

std::vector<char> gap_walls(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                            std::vector<PatchKind> const& kinds) {
  ResolvedMotion const& motion = surface.motion();
  std::size_t const n = mesh.patches.size();
  std::vector<char> slips(n, 0), found(n, 0);
  for (std::size_t p = 0; p < n; ++p)
    slips[p] = kinds[p] == PatchKind::wall && surface.slip_surface_of(int(p)) >= 0 ? 1 : 0;
  if (std::none_of(slips.begin(), slips.end(), [](char s) { return s != 0; })) return found;
  std::map<int, double> area_of_rule;
  std::map<std::size_t, double> length_of;
  for (std::size_t p = 0; p < n; ++p) {
    int const rule = motion.patch[p].rule;
    if (kinds[p] != PatchKind::wall || is_box(mesh.patches[p]) || rule < 0 || !surface.is_explicit(rule) ||
        std::holds_alternative<FixedRule>(motion.rules[rule].rule))
      continue;
    LinesOff const lines = lines_off(mesh, links, int(p), slips);
    if (!lines.to_slip) continue;
    area_of_rule[rule] += area_of(mesh, mesh.patches[p]);
    length_of[p] = lines.mean_length;
  }
  for (auto const& [p, length] : length_of)
    found[p] = length <= narrow * std::sqrt(area_of_rule.at(motion.patch[p].rule)) ? 1 : 0;
  return found;
}

Gaps::Gaps(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion, std::vector<char> const& walls) {
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  std::vector<int> tips;
  for (int c = 0; c < lattice.n_classes(); ++c)
    if (int const patch = blocks.patch_of_face()[c]; patch >= 0 && walls[patch] != 0) tips.push_back(c);
  if (tips.empty()) return;
  std::vector<char> const plane = continued(lattice, tips, [](int) { return true; });

  // The sliding walls across the gaps, and as far as they go on beside them.
  Known const nothing(lattice.n_classes());
  std::vector<int> across;
  for (int const tip : tips) {
    auto const chain =
        walk_from(mesh, topology, nothing, blocks.face_of(lattice.face_sides(tip).front()),
                  [&](Chain const& so_far) { return blocks.patch_of_face()[face_at_end(topology, so_far)] >= 0; });
    if (chain) across.push_back(face_at_end(topology, *chain));
  }
  std::set<int> rules;
  for (int const face : across) rules.insert(motion.patch[blocks.patch_of_face()[face]].rule);
  std::vector<char> const slides = continued(lattice, across, [&](int face) {
    int const patch = blocks.patch_of_face()[face];
    return patch >= 0 && rules.contains(motion.patch[patch].rule);
  });

  // From there back to the plane of the tips.
  axis_of_block_.assign(blocks.size(), -1);
  std::set<BlockFace> done;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    if (slides[c] == 0) continue;
    BlockFace const start = blocks.face_of(lattice.face_sides(c).front());
    if (!done.insert(start).second) continue;
    auto const chain = walk_from(mesh, topology, nothing, start,
                                 [&](Chain const& so_far) { return plane[face_at_end(topology, so_far)] != 0; });
    if (!chain) continue;
    for (ChainStep const& step : chain->steps) axis_of_block_[step.block] = step.to_chain.inverse().axis[0];
  }
}

bool Gaps::runs_across(Chain const& chain) const {
  return any() &&
         std::all_of(chain.steps.begin(), chain.steps.end(), [&](ChainStep const& step) { return runs_across(step); });
}

bool Gaps::is_crossed_by(Chain const& chain) const {
  return any() && std::any_of(chain.steps.begin(), chain.steps.end(),
                              [&](ChainStep const& step) { return holds(step.block) && !runs_across(step); });
}

}  // namespace gridmorph
