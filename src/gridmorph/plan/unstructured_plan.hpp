// The plan of an unstructured morph: every stage as rows of weighted means, ready to be applied many times.
//
//   boundary -> columns -> layers -> wrap -> background mesh -> far field -> what other boundaries ask for
//
// docs/unstructured.md has the method with its formulas. Everything here is plain host data; Morpher puts it on an
// execution space. Node numbers are those of representatives (NodeGraph) unless said otherwise.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/passage_motion.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/common_motion.hpp>
#include <gridmorph/plan/elements/columns.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/layers.hpp>
#include <gridmorph/plan/least_squares_field.hpp>
#include <gridmorph/plan/options.hpp>
#include <gridmorph/plan/planned_elements.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// How the nodes of a column follow their wall node.
struct ColumnPlan {
  std::vector<Index32> node;
  std::vector<Index32> root;  ///< number in UnstructuredPlan::driving
  std::vector<float> turn;  ///< share of the wall's rotation that the node makes: 0 translate, 1 rotate, between: blend
};

/// Bodies: walls that touch, that move and may turn, stretch and shift as a whole. kernels/body_turn.hpp has what
/// becomes of them.
struct TurningBodies {
  std::vector<Vec3> centre;   ///< per body: mean place of its walls
  std::vector<Vec3> axis;     ///< per body: the one axis about which it may turn, unit; zero: any
  std::vector<Index32> wall;  ///< wall nodes, numbers in UnstructuredPlan::driving, body after body
  /// Slots in UnstructuredPlan::known: of the wall nodes, then of all others, and their shares in the area of their
  /// body, or of the others.
  std::vector<Index32> slot;
  std::vector<double> weight;
  /// Per wall node and body: what the stretch of bodies is summed by (kernels/body_stretch.hpp); empty where none
  /// stretches.
  std::vector<Vec3> lever;
  std::vector<kernels::StretchLimits> limits;
  std::vector<Vec3> column_arm;    ///< (UnstructuredPlan::columns) h of kernels/body_stretch.hpp, where bodies stretch
  std::vector<Index> first;        ///< first of `slot` in each chunk, and the end
  std::vector<Index> first_chunk;  ///< of each body, of the others, and the end
  std::vector<Index32> body_of_driving;  ///< (UnstructuredPlan::driving) -1: none
  std::vector<Index32> rigid;            ///< nodes of the bodies' walls and of the columns on them
  std::vector<kernels::BodyImage>
      images;  ///< first the bodies themselves, then as they come again behind free periodic connections
  std::vector<double>
      share;  ///< (images, n_nodes) of the image's turn that a node makes, plan/elements/turning_bodies.hpp
  std::vector<double> shift_share;  ///< (bodies, n_nodes) of the body's shift

  [[nodiscard]] Index size() const { return Index(centre.size()); }
};

/// What sides of a passage do that follow its blade, done by all nodes (kernels/passage_motion.hpp). What the walls do
/// besides fades from them to the boundaries that rules displace.
struct MotionOfSides {
  kernels::RowFrame frame;
  std::vector<Index32> slots;    ///< of nodes of the sides, in UnstructuredPlan::known
  InterpolationOperator nodes;   ///< numbers in `slots` -> nodes
  InterpolationOperator rigid;   ///< those of walls and columns among them
  InterpolationOperator places;  ///< -> kernels::passage_places for each driving node
  std::vector<double> step;      ///< kernels::PassageSlopes::step

  [[nodiscard]] bool empty() const { return slots.empty(); }
};

struct UnstructuredPlan;

/// A part of a mesh that nothing connects with the others, or whose boundaries have a motion in common; it has a plan
/// of its own.
struct PartPlan {
  std::vector<Index32> nodes;          ///< of the part -> of the mesh, ascending
  std::vector<Index32> slots;          ///< of its known nodes -> of the mesh's
  std::optional<CommonMotion> common;  ///< taken off before its stages, added after those that are linear
  std::shared_ptr<UnstructuredPlan const> plan;
};

struct UnstructuredPlan {
  /// The parts of the mesh. Where there are any they make the morph, and of what follows only the lists of boundary
  /// nodes, walls, columns, copies and further nodes are filled, for guards and reports. Nodes of no part stay.
  std::vector<PartPlan> parts;

  Index n_nodes = 0;
  Vec3 plane_normal{0, 0, 1};  ///< of a 2-D mesh
  int dimension = 3;
  /// Components of the mesh that are x, y and z here: plane meshes across x or y are planned, and moved, as ones across
  /// z. Everything in this plan has those; what goes in and out of a Morpher has those of the mesh.
  std::array<int, 3> axes{0, 1, 2};

  std::vector<Index32> known;  ///< as in BoundaryConditions: the order of boundary displacements
  /// What puts given displacements back on slip surfaces before all else, of slots in `known`, and how far off it
  /// leaves them alone.
  JointSlip given_slip;
  std::vector<double> given_tolerance;
  std::vector<Index32> driving;        ///< nodes of moving walls, ascending
  std::vector<Index32> driving_slots;  ///< where they are in `known`
  std::vector<std::uint8_t> turns;     ///< (driving) whether the rotation of the wall there is followed
  CsrGraph one_rings;  ///< per driving node: pairs (a, b) of the nodes beside it in each wall face, see one_rings.hpp
  /// The first edges of the columns on each driving node, unit, on the side to which the wall's normals look: those of
  /// node r from first_line[r] on.
  std::vector<Index> first_line;
  std::vector<Vec3> lines;
  ColumnPlan columns;
  TurningBodies turns_of_bodies;
  MotionOfSides passage;
  /// What carries the motion of the walls to what is between them: the smooth part of their displacement, and over all
  /// nodes of near and partially wrapped elements what it misses. By NearFieldMethod::layers there is none, and layers
  /// carry all of it.
  InverseDistanceField walls;
  /// By least squares instead (NearFieldMethod), for all nodes: the first rows are those of the ends of columns, where
  /// layers begin.
  LeastSquaresField fit;
  Index n_fitted_ends = 0;
  /// What the smooth part is spread from besides the driving nodes, after these: nodes of other boundaries among near
  /// elements that rules move, by their places in `known`.
  std::vector<Index32> beside_slots;
  /// The driving nodes, then those of beside_slots.
  [[nodiscard]] std::vector<Index32> smooth_sources() const {
    std::vector<Index32> out = driving;
    for (Index32 const s : beside_slots) out.push_back(known[s]);
    return out;
  }
  LayerRows near;
  std::vector<float> near_fade;  ///< per row of near, or of fit.nodes: share of what the smooth part misses
  std::vector<float> near_turn;  ///< per row of near, by layers: share of its sources' turns that the node makes

  std::optional<Background> background;  ///< absent where the near field is the whole mesh
  std::optional<PreparedMorph> background_morph;
  InterpolationOperator wrap;   ///< nodes -> Plan::boundary_nodes of the background
  InterpolationOperator outer;  ///< `known` slots -> Plan::boundary_nodes of the background: what the outer box does
  InterpolationOperator far;    ///< background nodes -> nodes outside the wrap

  /// Boundary nodes beyond the moving walls: their residual (what is asked for minus the field so far) spreads over all
  /// nodes. After them the nodes of columns on walls that stand, which ask for what their wall does.
  std::vector<Index32> residual_nodes;
  std::vector<Index32> residual_slot;  ///< in `known`, or -1
  /// Nodes of columns on walls that slip, the last of `residual_nodes`: they ask for what their wall node does.
  std::vector<Index32> sliding, sliding_root;
  CsrGraph residual_surfaces;  ///< slip surfaces, where not known
  /// Nodes of `residual_nodes` that slide or have images begin with the field so far and what the residual of those
  /// with a slot adds there: beside a wall that stands they stand.
  struct Start {
    std::vector<Index32> given;       ///< nodes with a slot, boundary nodes first
    std::vector<Index32> given_slot;  ///< in `known`
    InverseDistanceField residual;    ///< of the boundary nodes among them
    LayerRows detail;                 ///< what the lattice misses, out along the nodes that begin
    std::vector<Index32> node;        ///< the nodes that begin
    std::vector<float> fade, detail_fade;
  } start;
  std::vector<SlipSurface> surfaces;  ///< BoundaryConditions::surfaces()
  /// Nodes that move as one, held on the surfaces of all of them once they have their mean.
  struct JointNodes {
    JointSlip slip;   ///< of nodes: owners of images, or nodes of their own
    CsrGraph images;  ///< entries of `images`, per entry
  };
  JointNodes joint;                   ///< but for those with
  JointNodes joint_sliding;           ///< nodes of `sliding`, once these have gone along
  std::vector<PeriodicImage> images;  ///< their owners and they are in `residual_nodes`
  std::vector<Index32> image_owners;  ///< ascending; known ones have no mean
  CsrGraph images_of_owner;           ///< entries of `images`
  std::vector<Mat3> rotations;
  InverseDistanceField residual;
  std::vector<float> fade;  ///< (n_nodes) share of the residual: d / (d + d_other), d from the end of the wall's column
  /// What the lattice misses at boundaries, out over one of its cells.
  LayerRows residual_detail;
  std::vector<float> detail_fade;  ///< per row of residual_detail, share of the residual included

  std::vector<Index32> copies, copied;  ///< nodes that coincide with a representative, and that
  InterpolationOperator middle;         ///< further nodes of second-order elements: by the corners around them
  /// The further nodes on boundaries, once `middle` has moved them: `known` slots or -1, slip surfaces where not known,
  /// and who moves as one.
  struct MiddleBoundary {
    std::vector<Index32> node, slot;
    CsrGraph surfaces;
    std::vector<Index32> image_owners;
    CsrGraph images_of_owner;  ///< entries of `images`
    JointNodes joint;
  } middle_boundary;
};

struct PreparedUnstructured {
  NodeGraph graph;
  BoundaryConditions boundary;
  UnstructuredPlan plan;
  UnstructuredReport report;
  std::vector<UnstructuredReport> part_reports;  ///< of UnstructuredPlan::parts; `report` adds them up
  std::vector<std::string> notes;
  /// The displacement of UnstructuredPlan::known that planning reckoned with: by the rules as they stand, or given to
  /// prepare(). None where ElementOptions::motion was given.
  std::optional<std::vector<Vec3>> displacement;

  /// The displacement of UnstructuredPlan::known, evaluated where planning did not; throws MotionError.
  [[nodiscard]] std::vector<Vec3> boundary_displacement() const {
    return displacement ? *displacement : evaluate(boundary);
  }
};

/// Resolves the rules and plans every stage. Throws MeshError for open boundary faces, MotionError, PlanError. Cost:
/// linear in nodes and elements (n log n in those of boundaries and partially wrapped ones); about 1 kB of working
/// memory per node.
PreparedUnstructured prepare(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryFacePatches const& face_patches, Motion const& motion, PlanOptions const& options);
inline PreparedUnstructured prepare(Mesh const& mesh, UnstructuredTopology const& topology,
                                    BoundaryFacePatches const& face_patches, Motion const& motion,
                                    PlanOptions const& options) {
  return prepare(HostInstance(), mesh, topology, face_patches, motion, options);
}
/// Plans every stage for rules that are resolved already, with make_node_graph() and boundary_conditions() of the mesh:
/// for several plans of one mesh. displacement: that of BoundaryConditions::known, to reckon with instead of what the
/// rules give now and of ElementOptions::motion.
PreparedUnstructured prepare(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryFacePatches const& face_patches, NodeGraph graph, BoundaryConditions boundary,
                             PlanOptions const& options, std::optional<std::vector<Vec3>> displacement = {});

}  // namespace gridmorph
