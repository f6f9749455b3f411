#include <gridmorph/plan/blocks/line_walk.hpp>
#include <gridmorph/plan/blocks/wall_roots.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {
namespace {

/// Where a wall's grid lines begin at an end wall, and what they pass.
class EndFinder {
 public:
  EndFinder(PlanContext const& context, Links const& links, WallRoots const& walls, EndWalls const& end_walls)
      : context_(context), links_(links), walls_(walls), end_walls_(end_walls), passed_(walls.nodes().size()) {}

  void find() {
    for (RootFace const& face : walls_.faces())
      for_sides(face, [&](auto const&... side) { add_end_wall(face, side...); });
    for (RootFace const& face : walls_.faces()) for_sides(face, [&](auto const&... side) { walk_off(face, side...); });
  }
  /// Nodes of end walls that rules move, after the roots that lines stand on.
  [[nodiscard]] std::vector<RootNode> const& end_nodes() const { return end_nodes_; }
  [[nodiscard]] std::vector<kernels::EndWall> const& found() const { return found_; }

  [[nodiscard]] kernels::RootEnds ends(std::int32_t root) const {
    std::vector<Passed> list = passed_[root];
    std::stable_sort(list.begin(), list.end(),
                     [](Passed const& a, Passed const& b) { return a.distance < b.distance; });
    kernels::RootEnds ends;
    ends.fraction = -1;
    if (list.empty()) return ends;
    Passed const& first = list.front();
    auto second = std::find_if(list.begin(), list.end(), [&](Passed const& p) { return root_of(p) == first.last; });
    bool const one_line = second != list.end() && second != list.begin();
    if (!one_line)
      second = std::find_if(list.begin(), list.end(), [&](Passed const& p) { return root_of(p) != root_of(first); });
    double const length = one_line ? first.distance + second->distance : 0;
    ends.end[0] = with_share(first, length);
    if (second != list.end()) ends.end[1] = with_share(*second, length);
    if (one_line && length > 0) ends.fraction = first.distance / length;
    return ends;
  }

 private:
  /// A line from an end wall that passes a root.
  struct Passed {
    kernels::RootEnd end;
    double distance = 0;
    std::int32_t last = -1;  ///< root where it leaves the wall
  };
  [[nodiscard]] std::int32_t root_of(Passed const& passed) const { return found_[passed.end.end].root; }

  /// Calls visit(axis along the wall, side, face class) for the sides of a wall's face that lie on end walls.
  template <class Visit>
  void for_sides(RootFace const& face, Visit const& visit) const {
    Lattice const& lattice = context_.topology.lattice;
    for (int const axis : face.along)
      for (int side = 0; side < 2; ++side) {
        Index3 which{1, 1, 1};
        which[axis] = 2 * side;
        int const c = lattice.class_of(lattice.entity_of_piece(face.piece, which));
        int const patch = context_.topology.blocks.patch_of_face()[c];
        if (patch < 0 || walls_.is_wall(patch)) continue;
        if (end_walls_.surface_of_patch[patch] >= 0 || end_walls_.is_given[patch] != 0) visit(axis, side, c);
      }
  }
  [[nodiscard]] int surface_of(int face_class) const {
    return end_walls_.surface_of_patch[context_.topology.blocks.patch_of_face()[face_class]];
  }

  void add_end_wall(RootFace const&, int, int, int face_class) {
    if (surface_of(face_class) >= 0) return;
    RootFace const end_wall(context_, context_.topology.lattice.face_sides(face_class).front());
    add_neighbours(
        context_, end_wall,
        [&](Index slot) {
          if (walls_.of_slot(slot) < 0) return std::int32_t(-1);
          auto const [found, fresh] = end_node_.try_emplace(slot, std::int32_t(end_nodes_.size()));
          if (fresh) end_nodes_.push_back({.slot = slot, .centre = slot});
          return found->second;
        },
        end_nodes_);
  }

  void walk_off(RootFace const& face, int axis, int side, int face_class) {
    int const across = axis == face.along[0] ? face.along[1] : face.along[0];
    for (int k = face.nodes.begin[across]; k < face.nodes.end[across]; ++k) {
      Index3 node = face.nodes.begin;
      node[across] = k;
      node[axis] = side == 0 ? face.nodes.begin[axis] : face.nodes.end[axis] - 1;
      walk({face.zone, node, axis, side == 0 ? 1 : -1}, face_class);
    }
  }

  /// Walks one line off an end wall, as far as the wall goes in this frame.
  void walk(LinePlace place, int face_class) {
    WallRoots::Place const start = at(place);
    kernels::EndWall end;
    end.root = start.root;
    end.surface = surface_of(face_class);
    if (end.surface < 0) {
      end.wall = std::int32_t(walls_.nodes().size()) + end_node_.at(walls_.nodes()[start.root].slot);
    } else {
      end.to_zone = start.copy->moved ? context_.rotations.number(start.copy->transform.rotation) : -1;
      end.position = position(place);
    }
    std::vector<std::pair<WallRoots::Place, double>> line{{start, 0}};
    double length = 0;
    for (Vec3 before = position(place); line.size() <= walls_.nodes().size(); before = position(place)) {
      double const so_far = length;
      if (!advance(context_.mesh, links_, place, length)) break;
      WallRoots::Place const here = at(place);
      double const step = length - so_far;
      bool const same_frame = std::abs(distance(before, position(place)) - step) <= 1e-6 * step;
      if (here.root < 0 || !same_frame) break;
      line.emplace_back(here, length);
    }
    auto const number = std::int32_t(found_.size());
    found_.push_back(end);
    for (auto const& [here, distance] : line) {
      auto& list = passed_[here.root];
      auto const again = [&](Passed const& p) { return root_of(p) == end.root; };
      if (std::find_if(list.begin(), list.end(), again) != list.end()) continue;
      list.push_back({{number, frame(*start.copy, *here.copy), 0}, distance, line.back().first.root});
    }
  }
  [[nodiscard]] WallRoots::Place at(LinePlace const& place) const {
    return walls_.at(context_.mesh.zones[place.zone].node(place.at));
  }
  [[nodiscard]] Vec3 position(LinePlace const& place) const {
    return context_.mesh.coordinates[context_.mesh.zones[place.zone].node(place.at)];
  }
  /// The rotation from the frame of the slot of one copy to that of the slot of another, in one zone; -1: none.
  [[nodiscard]] std::int32_t frame(EntityCopy const& from, EntityCopy const& to) const {
    if ((!from.moved && !to.moved) || same_rotation(from.transform.rotation, to.transform.rotation)) return -1;
    return context_.rotations.number(transpose(to.transform.rotation) * from.transform.rotation);
  }

  /// The correction reaches two thicknesses of the near field, and not beyond the middle between two end walls.
  [[nodiscard]] kernels::RootEnd with_share(Passed const& passed, double length) const {
    double reach = 2 * walls_.nodes()[root_of(passed)].thickness;
    if (length > 0) reach = std::min(reach, length / 2);
    double const s = reach > 0 ? std::min(1.0, passed.distance / reach) : (passed.distance > 0 ? 1.0 : 0.0);
    kernels::RootEnd end = passed.end;
    end.share = 1 - s * s * (3 - 2 * s);
    return end;
  }

  PlanContext const& context_;
  Links const& links_;
  WallRoots const& walls_;
  EndWalls const& end_walls_;
  std::vector<kernels::EndWall> found_;
  std::vector<std::vector<Passed>> passed_;  ///< per root
  std::vector<RootNode> end_nodes_;
  std::unordered_map<Index, std::int32_t> end_node_;  ///< per slot
};

/// Whether the faces around a node look more than 30 degrees away from what they look along together.
bool is_edge(RootNode const& node) {
  Vec3 const normal = fan_normal(node.around);
  double const size = norm(normal);
  for (std::size_t k = 0; k + 1 < node.around.size(); k += 2) {
    Vec3 const face = cross(node.around[k].arm, node.around[k + 1].arm);
    if (dot(face, normal) < std::sqrt(0.75) * norm(face) * size) return true;
  }
  return false;
}

/// The line on the side of the wall's faces to which their normals look.
Vec3 along_normals(RootNode const& node) {
  return dot(fan_normal(node.around), node.line) < 0 ? -node.line : node.line;
}

void append(std::vector<RootNode> const& nodes, bool stand, TurnTables& tables) {
  for (RootNode const& n : nodes) {
    tables.roots.push_back({n.slot, n.centre, Index(tables.neighbours.size()), std::int32_t(n.around.size()),
                            stand ? 1 : 0, n.turn, is_edge(n) ? along_normals(n) : Vec3{}});
    tables.neighbours.insert(tables.neighbours.end(), n.around.begin(), n.around.end());
  }
}

}  // namespace

TurnTables turn_tables(PlanContext const& context, Links const& links, WallRoots const& walls,
                       EndWalls const& end_walls) {
  TurnTables tables;
  EndFinder finder(context, links, walls, end_walls);
  finder.find();
  append(walls.nodes(), true, tables);
  append(finder.end_nodes(), false, tables);
  tables.end_walls = finder.found();
  tables.bodies = walls.turning_roots();
  for (std::size_t r = 0; r < walls.nodes().size(); ++r) tables.roots[r].body = walls.body(r);
  tables.ends.resize(tables.roots.size());
  for (std::size_t r = 0; r < walls.nodes().size(); ++r) tables.ends[r] = finder.ends(std::int32_t(r));
  return tables;
}

}  // namespace gridmorph
