// The steps from an unstructured mesh to its plan, one file per step: make_unstructured_plan.cpp, then
// plan_columns.cpp, plan_turns.cpp, share_turns.cpp, plan_domain.cpp, plan_regions.cpp, plan_layers.cpp,
// plan_background.cpp and plan_residual.cpp of this folder. Internal to unstructured.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/elements/body_stretch.hpp>
#include <gridmorph/plan/elements/columns.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>
#include <gridmorph/plan/elements/wall_distance.hpp>
#include <gridmorph/plan/plane_axes.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// The number of the part (n_nodes) that a node belongs to, -1 where no element has it. Elements that share a node hang
/// together, and so do nodes at one place and those that a connection pairs, periodic ones too. `cuts`: (n_nodes) nodes
/// at one place, by the one that carries them, that do not join the zones on their two sides; empty: none. Parts are
/// counted in the order of their first nodes. Cost O(corners of all elements).
std::vector<Index32> parts_of_nodes(Mesh const& mesh, NodeGraph const& graph, std::vector<std::uint8_t> const& cuts);

/// Some nodes of a mesh, with all elements that have them, as a mesh of its own: zones and patches keep their numbers,
/// nodes and elements their order.
struct MeshPart {
  Mesh mesh;
  std::vector<Index32> nodes, elements;  ///< of the part -> of the mesh, ascending
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
  NodeGraph graph;
  BoundaryConditions boundary;  ///< rules and patches are those of the mesh
  std::vector<Index32> slots;   ///< of the part's known nodes -> of the mesh's
};

/// The nodes with of_part[n] != 0: whole parts of parts_of_nodes(). Cost O(mesh).
MeshPart mesh_part(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                   BoundaryConditions const& boundary, std::vector<std::uint8_t> const& of_part);

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr Index most_lattice_nodes = 100'000;  ///< of the smooth part of the near field

/// Plans a mesh of elements in steps, which share what is here; run() calls them in their order.
class UnstructuredPlanner {
 public:
  UnstructuredPlanner(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                      BoundaryFacePatches const& face_patches, NodeGraph graph, BoundaryConditions boundary,
                      PlanOptions const& options, std::optional<std::vector<Vec3>> displacement,
                      std::array<int, 3> const& axes)
      : host_(host), mesh_(mesh), topology_(topology), face_patches_(face_patches), options_(options) {
    out_.plan.axes = axes;
    out_.graph = std::move(graph);
    out_.boundary = std::move(boundary);
    out_.displacement = std::move(displacement);
  }
  PreparedUnstructured run();

 private:
  using Mask = std::vector<std::uint8_t>;

  template <class Step>
  static void timed(double& seconds, Step&& step) {
    Stopwatch watch;
    step();
    seconds = watch.lap();
  }

  [[nodiscard]] Mask mask() const { return Mask(std::size_t(mesh_.n_nodes()), 0); }
  [[nodiscard]] Index32 owner(Index32 n) const { return out_.graph.representative[n]; }

  // make_unstructured_plan.cpp
  void take_boundary();
  /// Plans a mesh, or a part of it, as a whole.
  void plan_whole();
  void measure_distances();

  // plan_parts.cpp
  /// Nodes whose motion has nothing to do with that of the others, or that have a motion in common.
  struct Part {
    Mask nodes;
    std::optional<CommonMotion> common;
  };
  /// The parts of the mesh; none where it is one part without a motion in common.
  [[nodiscard]] std::vector<Part> find_parts() const;
  /// The motion in common of the nodes with the number `of` in a list, where their boundaries have one.
  [[nodiscard]] std::optional<CommonMotion> motion_in_common(std::vector<Index32> const& number, Index32 of,
                                                             std::vector<Index32> const& slots) const;
  [[nodiscard]] CommonLimits common_limits(std::vector<Index32> const& number, Index32 of) const;
  void plan_parts(std::vector<Part> parts);
  void plan_part(Part part);
  /// Takes over the columns, residual nodes and report of a part, in numbers of the mesh.
  void take_part(PartPlan const& part, std::vector<Index32> const& elements, PreparedUnstructured const& planned);

  // plan_columns.cpp
  /// Finds the faces of moving walls with the boundary layer that a user gave their patch.
  void find_driving_faces();
  void find_columns();
  /// The heights that columns may have: as long as a user says; otherwise they leave room in gaps.
  [[nodiscard]] std::vector<double> most_heights() const;
  /// How long columns on bodies may be where the walls below them turn differently (n_nodes): their arms are strained
  /// by 0.03 of what the body moves by beyond its turn, in sizes of it, at most, but for what lattices are too coarse
  /// to show, a few of their cells. Alike whatever the size of the motion. What bodies stretch by as wholes does not
  /// count. Empty where no shape of the motion is known, or the case file says how far columns go.
  [[nodiscard]] std::vector<double> longest_where_walls_bend() const;
  /// How long columns may be below least squares (n_nodes): half the shortest edge of the wall there, unless the case
  /// file says how far they go.
  [[nodiscard]] std::vector<double> longest_by_edges() const;
  /// About the spacing of the lattice of the near field around a body.
  [[nodiscard]] double lattice_spacing(WallBody const& body) const;
  /// Finds the directions of the columns on driving nodes, before columns are cut.
  void find_wall_lines();
  void plan_columns();
  /// Finds the columns of walls that stand: they are held in place, as far as moving walls leave room. Then those of
  /// walls that slip: they go along.
  void find_held_columns();
  /// Measures distances from the ends of the held columns, and from boundaries beyond the moving walls.
  void measure_others();
  /// Columns on walls, no higher than leaves room where moving walls come nearer by `motion`.
  [[nodiscard]] Columns columns_on(std::vector<int> const& patches, Mask const& taken, double motion) const;
  /// Without the parts of columns whose periodic copies are in none.
  [[nodiscard]] Columns with_copies(Columns const& columns) const;
  [[nodiscard]] Index n_held() const { return standing_.size() + sliding_.size(); }
  /// The extent that a user gave the boundary layer on a face's patch, or the default one.
  [[nodiscard]] ColumnExtent extent_of_face(Index32 face) const;

  /// How the columns on driving nodes follow them.
  [[nodiscard]] std::vector<BoundaryLayer::Mode> modes_of_walls() const;
  /// Plans how moving walls turn at their nodes.
  void plan_one_rings();

  // plan_turns.cpp
  /// Finds the bodies that turn; needs the faces of the walls. What motion the offset and columns reckon with is then
  /// what turns leave of it.
  void find_turning_bodies();
  /// Whether each moving wall is of a body that turns as a whole.
  [[nodiscard]] bool all_walls_turn() const;
  /// Whether least squares carry the walls' motion; notes where they were asked for and cannot.
  [[nodiscard]] bool goes_by_least_squares();
  void add_turning_body(WallBody const& body);
  /// Adds all boundary nodes whose displacement is known but for those of the bodies: what shifts are measured against.
  void add_other_boundaries();
  /// The displacement in whose shape walls bend and stretch; null: not known.
  [[nodiscard]] std::vector<Vec3> const* shape() const;
  /// How walls turn at their nodes by a displacement (UnstructuredPlan::driving).
  [[nodiscard]] std::vector<kernels::Quaternion<Vec3>> turns_of_walls(std::vector<Vec3> const& displacement) const;
  /// How bodies stretch as wholes; and what displacement is left beyond turns and stretches, and beyond shifts too.
  void plan_stretches();
  /// That of one body, whose wall nodes are those from first to end in TurningBodies::wall, with their levers; adds its
  /// shift.
  [[nodiscard]] BodyStretch stretch_of(std::size_t body, std::size_t first, std::size_t end,
                                       std::vector<Vec3> const& given,
                                       std::vector<kernels::Quaternion<Vec3>> const& turn, Vec3& shift);
  /// From the centre of a body to its wall node k of TurningBodies::wall.
  [[nodiscard]] Vec3 arm_in_body(std::size_t body, std::size_t k) const;
  /// h of kernels/body_stretch.hpp, of each node of a column.
  [[nodiscard]] std::vector<Vec3> stretched_arms() const;
  /// Plans the turns of bodies; needs the columns.
  void plan_turns();
  /// What nodes have their shares whatever their distances are: those of turns, or all.
  enum Given : std::uint8_t { nothing, turns, all };
  // share_turns.cpp
  /// Finds the shares in turns and shifts of all nodes that are not given.
  void share_turns(Mask const& given);

  // plan_passage.cpp
  /// Finds sides that follow a blade, and plans what nodes do with them; nothing where the sides differ or end at the
  /// blade, where a method is asked for that has no use for it, or what the sides do is not known.
  void find_passage();
  /// Their places in `known` and the frame of their row; none where there are several frames, or other boundaries move.
  [[nodiscard]] std::vector<Index32> slots_of_following_sides(std::vector<Vec3> const& given,
                                                              kernels::RowFrame& frame) const;
  /// Plans what walls and columns do with the sides, and how the rest fades; needs the columns and the fit.
  void plan_passage();

  // plan_domain.cpp
  /// The chart of wrap and background, and what nodes do on the sides that the mesh ends on.
  [[nodiscard]] ChartedDomain find_domain() const;

  // plan_regions.cpp
  double offset();
  void find_regions();
  void classify_by_wrap();
  /// Least squares have no wrap: near is what lies within the offset that it would have.
  void classify_by_distance();
  /// Classifies elements by the user's background mesh, which says where the wrap is; the moving walls must be in it.
  void classify_by_background();
  void take_background(Background background);

  // plan_layers.cpp
  std::function<double(Index32, Index32)> layer_weight();
  void plan_layers();
  /// Plans what carries the walls' motion through near elements, from layer to layer of them at least.
  void plan_near(Mask const& seeds);
  /// Plans the smooth part of the walls' motion: it covers the wrap; what it misses fades over a few of its cells.
  void plan_smooth_walls();
  enum class Beside { near, anywhere };
  /// Places in `known` of nodes, near ones or any, on boundaries that do not drive but move all the same, such as the
  /// sides of a passage that follow its blade: were the near field to learn of them from the residual alone, it would
  /// be torn where they meet the wall.
  [[nodiscard]] std::vector<Index32> slots_beside_walls(Beside which) const;
  /// Plans the walls' motion by least squares, for all nodes; what that misses at the ends of columns fades over three
  /// times their height.
  void plan_fit();
  /// Plans how turns are passed on by layers: they fade from the ends of the columns on.
  void plan_layer_turns();
  /// Finds how far from each wall node what stands on walls reaches; at sharp edges columns lean, and rise by little.
  void measure_columns();
  /// The distance of a node from the end of the column on the nearest wall node.
  [[nodiscard]] double beyond_column(std::size_t n) const;

  // plan_background.cpp
  void plan_background();
  /// Plans the outer box, which moves as the prescribed boundary nearest to it: a mesh that is shifted as a whole is
  /// shifted exactly.
  void plan_outer_box();
  void plan_projections();
  /// Finds wrap nodes in the elements that hold them; rows name representatives, so that layers reach their nodes.
  void project_wrap();

  // plan_residual.cpp
  void plan_residual();
  /// Share of each node in the area of the boundary; nodes that are on no boundary face have a mean one.
  [[nodiscard]] std::vector<double> areas(std::vector<Index32> const& nodes) const;
  /// The share d / (d + distance from `from`) of the residual that a node takes, d being the distance from the end of
  /// the moving wall's column.
  [[nodiscard]] double fade(std::size_t n, NearestSource const& from) const;
  std::function<double(Index32, Index32)> inverse_distance() const;
  void plan_other_nodes();
  /// Plans what boundaries ask of further nodes of second-order elements.
  void plan_middle_nodes();
  /// Plans what nodes that move as one are held on.
  void plan_joint_nodes();
  /// Groups entries of BoundaryConditions::images by their owners, of further nodes or of all others.
  void group_images(bool middle, std::vector<Index32>& owners, CsrGraph& images_of_owner) const;
  /// Plans what boundaries with a rule ask for, at nodes that slide or have images.
  void plan_start();

  HostInstance host_;
  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  BoundaryFacePatches const& face_patches_;
  PlanOptions const& options_;
  bool is_part_ = false;
  PreparedUnstructured out_;
  std::vector<int> layer_of_patch_;
  std::vector<Index32> driving_faces_;
  std::vector<double> column_reach_;  ///< (n_nodes) by nearest wall nodes
  WallBodies wall_bodies_;            ///< those that turn, and what does not turn with them
  std::vector<double> body_sizes_;
  std::vector<double> body_shifts_;    ///< how far bodies shift; 0: not known
  std::vector<double> body_rests_;     ///< what turn and shift leave of a body's displacement, at most
  std::vector<RigidTransform> moves_;  ///< to the images of bodies, see periodic_moves()
  Columns columns_, standing_, sliding_;
  Mask is_known_, drives_, is_other_, near_;
  Mask is_middle_;  ///< further nodes of second-order elements, which have no part in what follows
  NearestSource from_wall_, from_other_;
  NearestSource from_given_;  ///< boundaries beyond the moving walls that a rule displaces, and their columns
  bool fitted_ = false;       ///< whether least squares carry the walls' motion
  double gap_ = infinity;     ///< smallest one between moving walls and other boundaries
  double reach_ = 0;          ///< largest displacement that columns reckon with
  double rest_reach_ = 0;     ///< largest one that the wrap carries
};

}  // namespace gridmorph::detail
