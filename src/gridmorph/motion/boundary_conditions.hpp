// What the motion rules ask of each boundary node of an unstructured mesh.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/motion/boundary_requests.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

/// A node that is the image of another one behind a periodic boundary: u(node) = rotation * u(owner).
struct PeriodicImage {
  Index32 node = -1;
  Index32 owner = -1;
  std::int32_t rotation = -1;  ///< number in BoundaryConditions::rotations; -1: none
};

/// The surfaces that nodes are held on which move as one: of each entry those of its node, then those of its periodic
/// images.
struct JointSlip {
  std::vector<Index32> of;       ///< per entry: the node, or its slot in BoundaryConditions::known
  std::vector<Index> first{0};   ///< (entries + 1)
  std::vector<Index32> surface;  ///< numbers in BoundaryConditions::surfaces()
  std::vector<Index32> place;    ///< the node that is on it
  std::vector<std::int32_t>
      turned;  ///< displacement of the entry -> that of `place`, a number in BoundaryConditions::rotations; -1: none

  [[nodiscard]] bool empty() const { return of.empty(); }
};

/// What the rules make of the boundary nodes of a mesh of elements. All node numbers are those of representatives
/// (NodeGraph).
struct BoundaryConditions {
  std::shared_ptr<BoundaryMotion const> motion;  ///< the rules, on the boundary of the mesh

  /// Nodes whose displacement the rules give, ascending: the order in which a morph expects their values.
  std::vector<Index32> known;
  std::vector<std::uint8_t>
      drives;  ///< (known) whether the node belongs to a wall that moves: a source of the near field
  BoundaryRequests requests;

  /// Nodes that slide and are not known.
  std::vector<Index32> slip_nodes;
  CsrGraph slip_surfaces;  ///< numbers in BoundaryMotion::slip_surfaces(), per slip node

  std::vector<PeriodicImage> images;  ///< by node
  std::vector<Mat3> rotations;

  /// A known node that lies on a patch that slips.
  struct OnSlipPatch {
    Index32 slot = -1;  ///< in `known`
    Index32 node = -1;  ///< of the patch
    int patch = -1;
    int surface = -1;  ///< in BoundaryMotion::slip_surfaces()
  };
  std::vector<OnSlipPatch> given_on_slip;
  JointSlip given_slip;  ///< what puts these back, of slots
  JointSlip joint_slip;  ///< what the mean of periodic images is held on, of their owners and of nodes where periodic
                         ///< sides meet
  /// Directions in which nodes do not move where periodic sides meet in their axis; of kind axial.
  std::vector<SlipSurface> across_axes;

  std::vector<int> driving_patches;   ///< numbers of the patches that move walls, ascending
  std::vector<int> sliding_patches;   ///< of walls, and patches of no kind, whose nodes slip, ascending
  std::vector<int> standing_patches;  ///< of walls, and patches of no kind, that their rule holds in place, ascending
  std::vector<std::string> notes;

  [[nodiscard]] std::vector<Index> const& nodes_of(int patch) const { return motion->boundary().surface(patch).nodes; }
  /// All surfaces that nodes are held on: those of the rules, then `across_axes`.
  [[nodiscard]] std::vector<SlipSurface> surfaces() const;
};

/// Which displacements a plan reckons with.
enum class Displacements {
  of_the_rules,  ///< what the rules give now: a wall that they displace by zero stands, whichever rule says so
  any            ///< others to come: every rule but `fixed` moves its walls
};

/// The row of every node: 0, or the number of the blade row with which a circumferential-slide rule lets it slide: both
/// sides of a mixing plane between rows may have the same nodes and move apart (nodes_at_one_place()). Empty where no
/// rule slides.
std::vector<int> row_of_nodes(Mesh const& mesh, Motion const& motion);

/// Resolves the rules and finds what each boundary node is. `walls`: selectors of the walls that drive the near field;
/// empty: every patch that moves and is no inflow, outflow, farfield or symmetry. Where no rule displaces anything now,
/// all that could do. Regions are patches behind those of the mesh (regions_of_elements()): all of their nodes are
/// known, and none drives. Throws MotionError when no wall moves, and the errors of resolve() and BoundaryMotion.
BoundaryConditions boundary_conditions(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                                       BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                                       Motion const& motion, std::vector<std::string> const& walls,
                                       Displacements displacements = Displacements::of_the_rules);
inline BoundaryConditions boundary_conditions(Mesh const& mesh, UnstructuredTopology const& topology,
                                              BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                                              Motion const& motion, std::vector<std::string> const& walls,
                                              Displacements displacements = Displacements::of_the_rules) {
  return boundary_conditions(HostInstance(), mesh, topology, face_patches, graph, motion, walls, displacements);
}

/// Another motion with the same rules for the same patches, on the same boundary. Throws the errors of resolve() and
/// BoundaryMotion.
std::shared_ptr<BoundaryMotion const> boundary_motion(BoundaryConditions const& boundary, Motion const& motion);

/// Displacement of every known node. Throws MotionError as evaluate() of BoundaryRequests does.
std::vector<Vec3> evaluate(BoundaryConditions const& boundary);
/// Displacement of every known node by another motion, one with the same rules for the same patches, whose
/// displacements alone differ.
std::vector<Vec3> evaluate(BoundaryConditions const& boundary, Motion const& motion);
/// The length of the longest displacement; 0 where there are none.
double largest_norm(std::vector<Vec3> const& displacement);

}  // namespace gridmorph
