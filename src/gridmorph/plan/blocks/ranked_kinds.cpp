#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/blocks/boundary_facts.hpp>
#include <gridmorph/plan/blocks/line_walk.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {
namespace {

constexpr double thin = 0.2;    // first edge off a viscous wall, of the root of the face's area
constexpr double growth = 1.5;  // of the edges after it, at least
constexpr int most_cells = 8;   // that are looked at

/// The grid line off one node of a patch.
struct LineOffWall {
  double first = 0;  ///< length of its first edge
  bool grows = false;
};

LineOffWall line_off_wall(Mesh const& mesh, Links const& links, LinePlace place) {
  LineOffWall line;
  for (int cell = 0; cell < most_cells && !line.grows; ++cell) {
    double length = 0;
    if (!advance(mesh, links, place, length)) break;
    if (cell == 0) line.first = length;
    line.grows = length > growth * line.first;
  }
  return line;
}

/// Corners of a patch's faces that look like a viscous wall, and all of them.
struct Votes {
  Index viscous = 0, all = 0;
};

void count(Mesh const& mesh, Links const& links, Patch const& patch, Votes& votes) {
  Zone const& zone = mesh.zones[patch.zone];
  int const axis = normal_axis(patch.range), u = (axis + 1) % 3, v = (axis + 2) % 3;
  int const nu = patch.range.extent(u), nv = patch.range.extent(v);
  int const inward = patch.range.begin[axis] == 0 ? 1 : -1;
  auto const node = [&](int a, int b) {
    Index3 at = patch.range.begin;
    at[u] += a;
    at[v] += b;
    return at;
  };
  std::vector<LineOffWall> lines;
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) lines.push_back(line_off_wall(mesh, links, {patch.zone, node(a, b), axis, inward}));
  for (int b = 0; b + 1 < nv; ++b)
    for (int a = 0; a + 1 < nu; ++a) {
      auto const x = [&](int p, int q) { return mesh.coordinates[zone.node(node(a + p, b + q))]; };
      double const side = std::sqrt(0.5 * norm(cross(x(1, 1) - x(0, 0), x(0, 1) - x(1, 0))));
      for (int const corner : {0, 1, 2, 3}) {
        LineOffWall const& line = lines[std::size_t(a + corner % 2) + std::size_t(nu) * std::size_t(b + corner / 2)];
        ++votes.all;
        votes.viscous += line.grows && line.first <= thin * side ? 1 : 0;
      }
    }
}

/// The patches of `fixed` ones without a type whose cells are those of a viscous wall.
std::set<int> viscous_patches(Mesh const& mesh, Links const& links, ResolvedMotion const& motion,
                              std::vector<int> const& patches) {
  auto const group = [&](int p) {
    Patch const& patch = mesh.patches[p];
    return std::pair(patch.families.empty() ? patch.name : patch.families.front(), motion.patch[p].rule);
  };
  std::map<std::pair<std::string, int>, Votes> votes;
  for (int const p : patches) count(mesh, links, mesh.patches[p], votes[group(p)]);
  std::set<int> out;
  for (int const p : patches)
    if (Votes const& v = votes[group(p)]; 2 * v.viscous > v.all) out.insert(p);
  return out;
}

}  // namespace

std::vector<PatchKind> ranked_kinds(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                                    std::vector<BoundaryLayer> const& layers, std::vector<std::string>& notes) {
  ResolvedMotion const& motion = surface.motion();
  std::set<int> named;
  for (BoundaryLayer const& layer : layers)
    if (!layer.walls.empty())
      for (int const p : select_patches(mesh, layer.walls)) named.insert(p);
  std::vector<PatchKind> kinds;
  std::vector<int> doubtful;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    PatchKind kind = mesh.patches[p].kind;
    int const r = motion.patch[p].rule;
    if (kind == PatchKind::other && r >= 0 && surface.is_explicit(r)) {
      Rule const& rule = motion.rules[r].rule;
      if (std::holds_alternative<CircumferentialSlideRule>(rule)) {
        Vec3 const x = mesh.coordinates[mesh.zones[mesh.patches[p].zone].node(mesh.patches[p].range.begin)];
        kind = surface.slides_upstream(r, x) ? PatchKind::inflow : PatchKind::outflow;
      } else if (std::holds_alternative<FollowRule>(rule)) {
        kind = PatchKind::periodic;
      } else if (!std::holds_alternative<FixedRule>(rule) || named.contains(p)) {
        kind = PatchKind::wall;
      } else {
        doubtful.push_back(p);
      }
    }
    kinds.push_back(kind);
  }
  std::set<std::string> names;
  for (int const p : viscous_patches(mesh, links, motion, doubtful)) {
    kinds[p] = PatchKind::wall;
    names.insert(mesh.patches[p].families.empty() ? mesh.patches[p].name : mesh.patches[p].families.front());
  }
  if (!names.empty())
    notes.push_back(
        "patches " + quote_list({names.begin(), names.end()}) +
        ": the file gives them no type; they rank as walls, because their cells are thin and grow off them");
  return kinds;
}

}  // namespace gridmorph
