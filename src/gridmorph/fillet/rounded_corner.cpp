#include <gridmorph/fillet/corners.hpp>

#include <gridmorph/core/for_all.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// A tree of nodes, as triangles without area.
TargetTree tree_of(Mesh const& mesh, std::vector<Index32> const& nodes) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> each;
  for (Index32 const n : nodes) {
    int const k = int(points.size());
    points.push_back(mesh.coordinates[n]);
    each.push_back({k, k, k});
  }
  return {std::move(points), std::move(each)};
}

/// The move of a node.
struct Move {
  Vec3 shift;        ///< by its section
  Vec3 mended;       ///< from there onto the new wall; zero off the walls
  double still = 1;  ///< CornerMove
  double bend = 0;
  int wall = 0;
  bool near = false;    ///< the line
  bool on_arc = false;  ///< of a node on a wall

  [[nodiscard]] bool stays() const { return !near || (still == 1 && shift == Vec3{}); }
};

class CornerRounding {
 public:
  CornerRounding(JoinedElements const& elements, WallEdges const& edges, RootSections const& sections,
                 std::array<FacetSurface const*, 2> const& walls)
      : elements_(elements),
        edges_(edges),
        sections_(sections),
        walls_(walls),
        within_(1.5 * sections.largest_reach()) {}

  [[nodiscard]] Move move_of(Index32 place) const {
    Move out;
    Vec3 const p = elements_.position(place);
    auto const nearest = sections_.find(p, {}, within_);
    if (!nearest || out_of_reach(p, *nearest)) return out;
    bool const on_blade = edges_.on(0, place), on_end_wall = edges_.on(1, place);
    // On the blade's surface but off its nodes there is no direction off it.
    kernels::FacetFoot const blade_foot = walls_[0]->closest_point(p);
    Vec3 const off_foot = p - blade_foot.point;
    Vec3 const off_blade = on_blade ? edges_.normal(0, place) : off_foot == Vec3{} ? off_foot : unit(off_foot);
    auto const found = sections_.find(p, off_blade, within_);
    if (!found || out_of_reach(p, *found)) return out;
    out.near = true;
    std::array<double, 2> const off{on_blade ? 0 : off_wall(blade_foot, p),
                                    on_end_wall ? 0 : off_wall(walls_[1]->closest_point(p), p)};
    BetweenSections const section = sections_.between(*found);
    CornerMove const move = corner_move(place, section, off);
    out.shift = move.shift;
    out.still = move.still;
    out.bend = move.bend;
    out.wall = move.wall;
    if ((!on_blade && !on_end_wall) || !(section.radius() > 0) || out.stays()) return out;
    Vec3 const to = p + move.shift;
    out.on_arc = move.on_arc || (on_blade && on_end_wall);
    if (on_blade && on_end_wall) {
      out.mended = section.middle() - to;
    } else if (move.on_arc) {
      out.mended = section.on_arc(to, move.wall, move.arc_share) - to;
    } else {
      FacetSurface const& wall = *walls_[on_blade ? 0 : 1];
      out.mended = wall.view().slide(wall.closest_point(to), to) - to;
    }
    return out;
  }

 private:
  /// Whether a point is too far off to move, told cheaply: what moves is within the reach along a wall, and not much
  /// more than a radius off it.
  [[nodiscard]] bool out_of_reach(Vec3 const& p, SectionPlace const& at) const {
    BetweenSections const section = sections_.between(at);
    return distance(p, section.root()) > 1.1 * std::hypot(section.reach(), 1.5 * section.radius());
  }

  /// Lines lean along the corner; the nearer to it a node comes, the less.
  [[nodiscard]] CornerMove corner_move(Index32 place, BetweenSections const& section,
                                       std::array<double, 2> const& off) const {
    Vec3 const p = elements_.position(place);
    CornerPoint const point = section.point(off);
    KnownPlace const* const known = sections_.known(place);
    bool const in_mitre = known != nullptr && known->in_mitre;
    CornerMove out = section.move(p, point, in_mitre);
    auto const [near, far] = std::minmax(off[0], off[1]);
    double const lean = known == nullptr ? 1 : in_mitre ? std::min(1.0, 1.4 * near / far) : out.start;
    if (lean < 1) {
      BetweenSections const line = sections_.between(known->section);
      Vec3 const beside = dot(p - line.root(), line.across()) * line.across();
      CornerMove const there = line.move(p, line.point(off), in_mitre);
      Vec3 const straight = there.shift - ((1 - there.still) * (1 - there.bend)) * beside;  // the rest is in the move
      out.shift = lean * out.shift + (1 - lean) * straight;
    }
    return out;
  }

  JoinedElements const& elements_;
  WallEdges const& edges_;
  RootSections const& sections_;
  std::array<FacetSurface const*, 2> const& walls_;
  double within_;
};

}  // namespace

Coordinates round_corners(JoinedElements const& elements, WallEdges const& edges, RootSections const& sections,
                          std::array<FacetSurface const*, 2> const& walls, std::vector<std::uint8_t>& on_arc) {
  constexpr Index share = 256;  // few nodes are near the lines, so shares are small
  Mesh const& mesh = elements.mesh();
  HostInstance const host;
  CornerRounding const rounding(elements, edges, sections, walls);
  std::vector<Move> moves(mesh.n_nodes());
  detail::for_all_parts(host, "gridmorph::round_corners", (mesh.n_nodes() + share - 1) / share, [&](Index part) {
    for (Index n = share * part; n < std::min(mesh.n_nodes(), share * (part + 1)); ++n)
      if (elements.place(Index32(n)) == Index32(n)) moves[n] = rounding.move_of(Index32(n));
  });

  std::array<std::vector<Index32>, 2> on_walls;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (std::size_t w = 0; w < 2; ++w)
      if (moves[n].near && edges.on(int(w), Index32(n))) on_walls[w].push_back(Index32(n));
  std::array<TargetTree, 2> const trees{tree_of(mesh, on_walls[0]), tree_of(mesh, on_walls[1])};
  Coordinates out(mesh.n_nodes());
  on_arc.assign(mesh.n_nodes(), 0);
  detail::for_all(host, "gridmorph::round_corners (places)", mesh.n_nodes(), [&](Index n) {
    Index32 const place = elements.place(Index32(n));
    Move const& move = moves[place];
    on_arc[n] = move.on_arc ? 1 : 0;
    Vec3 const p = mesh.coordinates[n];
    if (move.stays()) return out.set(n, p);
    Vec3 mended = move.mended;
    if (!edges.on(0, place) && !edges.on(1, place)) {
      auto const w = std::size_t(move.wall);
      if (int const k = trees[w].closest(p).triangle; k >= 0)
        mended = ((1 - move.still) * (1 - move.bend)) * moves[on_walls[w][k]].mended;
    }
    out.set(n, p + move.shift + mended);
  });
  return out;
}

}  // namespace gridmorph
