// The walls whose near fields turn, node by node: who stands beside whom, and which end walls are near
// (kernels/root_turn.hpp).
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/blocks/chain_tables.hpp>

#include <unordered_map>

namespace gridmorph {

/// A face of a piece with its border: which slot each node has.
struct RootFace {
  struct Node {
    Index slot = -1;
    EntityCopy const* copy = nullptr;
  };
  int zone = -1, piece = -1, patch = -1;
  int axis = 0, side = 0;  ///< of the piece, across the face
  int along[2] = {};       ///< the other axes
  IndexRange nodes;
  std::vector<Node> of_node;  ///< along[0] fastest

  RootFace(PlanContext const& context, FaceSide const& face);
  [[nodiscard]] Index3 at(int p, int q) const {
    Index3 node = nodes.begin;
    node[along[0]] += p;
    node[along[1]] += q;
    return node;
  }
  [[nodiscard]] Node const& operator()(int p, int q) const {
    return of_node[std::size_t(p) + std::size_t(nodes.extent(along[0])) * q];
  }
};

/// A node of a wall and those beside it in its faces.
struct RootNode {
  Index slot = -1;
  Index centre = -1;  ///< slot whose neighbours these are
  std::vector<kernels::RootNeighbour> around = {};
  double thickness = 0;  ///< of the near field there
  double turn = 0;       ///< share of the turn that the outer edge makes
  Vec3 line{};           ///< unit, from it along the line of the near field; zero where several stand on it
  int n_lines = 0;       ///< directions in which lines leave it
};

/// Adds to each corner of each cell of a face its neighbours there; `number(slot)` is its place in `nodes`, -1: not
/// wanted.
template <class Number>
void add_neighbours(PlanContext const& context, RootFace const& face, Number const& number,
                    std::vector<RootNode>& nodes);

/// Sum of the cross products of a node's neighbours, frame of its slot.
Vec3 fan_normal(std::vector<kernels::RootNeighbour> const& around);

class WallRoots {
 public:
  /// A node of a wall as it stands in a zone.
  struct Place {
    std::int32_t root = -1;
    EntityCopy const* copy = nullptr;
  };

  explicit WallRoots(PlanContext const& context) : context_(context), is_wall_(context.mesh.patches.size(), 0) {}

  /// Adds the walls of one near field; `turn`: share of their turn that the outer edge makes.
  void add_walls(std::vector<int> const& patches, double turn);
  /// Nodes at one place turn alike: those of edges that have no length. Call after all walls.
  void join_coincident();
  /// Nodes beside which others are nearer than `roundings` times what coordinates resolve on the walls turn as the
  /// nearest node along the walls that has none so near: what is between them is no direction. Call after
  /// find_bodies(). Cost O(n), and O(n log n) in such nodes.
  void turn_as_resolved(CoordinatePrecision const& precision, double roundings);
  /// How long an edge has to be to have a direction, since turn_as_resolved() was called; 0 before.
  [[nodiscard]] double resolved_arm() const { return resolved_arm_; }
  /// Finds the bodies: walls that touch. Call after all walls.
  void find_bodies();
  /// Finds the centres and sizes of bodies. Call after find_bodies(), where all zones share one frame.
  void find_centres();
  /// Marks what is on the walls as coming with a rotation.
  void mark(Known& known) const;

  /// The body of a root; -1: none.
  [[nodiscard]] int body(std::size_t root) const { return body_.empty() ? no_body : body_[root]; }
  /// The nodes of bodies whose zones share one frame: rotations in several have no mean.
  [[nodiscard]] TurningRoots turning_roots() const;

  /// Places on the walls of one body, and of which patch each is.
  struct BodySample {
    std::vector<Vec3> places;
    std::vector<int> patches;
  };
  /// Some places of every body, about `most` of all in all; they depend on the numbering of nodes.
  [[nodiscard]] std::vector<BodySample> sample_bodies(Index most) const;
  /// The centre of a body: the mean of its walls over their area.
  [[nodiscard]] Vec3 const& centre_of_body(int body) const { return centre_[body]; }
  /// The diagonal of the box around the largest body, 0 where none has been found.
  [[nodiscard]] double body_size() const { return body_size_; }

  [[nodiscard]] std::vector<RootNode> const& nodes() const { return nodes_; }
  [[nodiscard]] std::vector<RootFace> const& faces() const { return faces_; }
  [[nodiscard]] bool is_wall(int patch) const { return is_wall_[patch] != 0; }
  /// The root of a slot; -1: none.
  [[nodiscard]] std::int32_t of_slot(Index slot) const { return of_slot_.empty() ? -1 : of_slot_[slot]; }
  [[nodiscard]] Place at(Index node) const;
  void set_thickness(std::int32_t root, double thickness) { nodes_[root].thickness = thickness; }
  /// A line of the near field that stands on a root leaves it along this unit vector, in the frame of its slot.
  void add_line(std::int32_t root, Vec3 const& line);
  void scale_turn(double turn) {
    for (RootNode& n : nodes_) n.turn *= turn;
  }

 private:
  /// visit(face, its record there, node of the mesh) for all nodes of all walls, those on borders of faces once for
  /// each.
  template <class Visit>
  void for_nodes(Visit const& visit) const;
  /// The largest coordinate of the nodes of all walls.
  [[nodiscard]] double largest_coordinate() const;

  PlanContext const& context_;
  std::vector<char> is_wall_;  ///< per patch
  std::vector<RootFace> faces_;
  std::vector<RootNode> nodes_;
  std::vector<std::int32_t> of_slot_;       ///< of the skeleton; empty before there are walls
  std::unordered_map<Index, Place> place_;  ///< per node of the mesh
  std::vector<int> body_;                   ///< per root, empty before they are found
  int n_bodies_ = 0;
  std::vector<Vec3> centre_;  ///< per body, empty before they are found
  double body_size_ = 0;
  double resolved_arm_ = 0;
};

/// What bounds a wall's grid lines: slip surface per patch (-1: none), and patches that a rule moves.
struct EndWalls {
  std::vector<int> surface_of_patch;
  std::vector<char> is_given;
};

/// The tables of all roots, with the end walls near them.
TurnTables turn_tables(PlanContext const& context, Links const& links, WallRoots const& walls,
                       EndWalls const& end_walls);

// --- implementation of the template ---

/// One corner of a cell of a wall, and what it sees: frames of slots.
kernels::RootNeighbour neighbour(PlanContext const& context, RootFace const& face, Index3 const& corner,
                                 RootFace::Node const& root, Index3 const& other_corner, RootFace::Node const& other);
/// Whether (1, 0) x (0, 1) of a cell points away from the piece.
bool points_out(Mesh const& mesh, RootFace const& face, int p, int q);

template <class Number>
void add_neighbours(PlanContext const& context, RootFace const& face, Number const& number,
                    std::vector<RootNode>& nodes) {
  constexpr int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int q = 0; q + 1 < face.nodes.extent(face.along[1]); ++q)
    for (int p = 0; p + 1 < face.nodes.extent(face.along[0]); ++p) {
      int const forward = points_out(context.mesh, face, p, q) ? 1 : 3;
      for (int c = 0; c < 4; ++c) {
        auto const place = [&](int k) { return std::pair{p + corner[k % 4][0], q + corner[k % 4][1]}; };
        auto const [rp, rq] = place(c);
        RootFace::Node const& root = face(rp, rq);
        std::int32_t const n = number(root.slot);
        if (n < 0) continue;
        for (int const k : {c + forward, c + 4 - forward}) {
          auto const [op, oq] = place(k);
          nodes[n].around.push_back(neighbour(context, face, face.at(rp, rq), root, face.at(op, oq), face(op, oq)));
        }
      }
    }
}

}  // namespace gridmorph
