// What a user can choose about topology, plan and volume morph. Plain values with their defaults.
#pragma once

#include <gridmorph/boundary/topology_options.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

struct Background;

/// What carries the motion of the walls between the ends of their columns and the wrap.
enum class NearFieldMethod {
  /// Least squares where all moving walls are bodies that turn freely amid other boundaries, between periodic sides
  /// where nothing else moves; otherwise the lattice.
  automatic,
  lattice,  ///< its average on an even lattice, and from layer to layer what that misses at the columns
  layers,   ///< from layer to layer the motion itself: displacement and turn
  /// The affine motion that fits the walls around best, at the scale of their distance, for all nodes of the mesh; amid
  /// a background mesh of the user's as `lattice`.
  least_squares
};

/// How much each node of the layers before counts when displacements pass on.
enum class LayerWeight {
  uniform,           ///< 1
  inverse_distance,  ///< 1 / length of the edge
  quality,           ///< inverse distance times the mean quality of the elements around the edge's two ends
  curvature          ///< inverse distance / (1 + d k)^2: d distance from the wall, k curvature of the wall there
};

struct ElementOptions {
  /// Selectors of the walls that drive the near field; empty: every patch with an explicit rule other than `fixed` that
  /// is no inflow, outflow, farfield or symmetry.
  std::vector<std::string> walls;
  NearFieldMethod method = NearFieldMethod::automatic;
  LayerWeight weight = LayerWeight::inverse_distance;
  double offset = 0;  ///< of the wrap from the moving walls [length]; 0: suggest_offset()
  double motion =
      -1;  ///< size of the displacements to come [length], for suggest_offset(); negative: what the rules give now
  /// A displacement of the boundary nodes (BoundaryConditions::known) like which those to come bend and stretch walls,
  /// by another factor; empty: not known. Not looked at where the displacement is.
  std::vector<Vec3> shape;
  /// Whether all of a passage may go with sides that follow its blade: not where the two sides differ in displacements
  /// to come (passages of a wheel). Where they do in the one that the plan knows, it does not.
  bool with_sides = true;
  /// Cells of the wrap's lattice along the longest extent of the walls; few are best (WrapOptions::resolution).
  int resolution = 4;
  /// A tube with an O-type background mesh around it instead, where one fits (WrapOptions::tube); not by least squares.
  bool tube = false;
  int cells = 4;  ///< of the background mesh along each cell of the wrap's lattice
  /// A background mesh of the user's instead of one around a wrap made here, which `offset`, `resolution`, `tube` and
  /// `cells` are for; its hole is the wrap.
  std::shared_ptr<Background const> background;
};

/// Near field of moving walls (design: stage 0). Several may be given, for different walls.
struct BoundaryLayer {
  enum class Extent {
    block,      ///< up to the first opposite block face
    layers,     ///< so many cells; runs through block and zone limits
    thickness,  ///< so far
    automatic   ///< blocks: `block` where another block follows, else a third of the cells to the boundary; elements:
                ///< `block`
  };
  enum class Mode {
    translate,  ///< every node of a grid line or column takes the displacement of its wall node
    rotate,     ///< and the rotation of the wall there
    blend       ///< the rotation fades to none at the end of the column
  };

  std::vector<std::string> walls;  ///< selectors; empty: every wall patch whose rule moves it
  Extent extent = Extent::automatic;
  int layers = 0;        ///< cells, for Extent::layers
  double thickness = 0;  ///< length, for Extent::thickness
  Mode mode = Mode::rotate;
};

/// How a displacement varies along a grid line, as a function of the fraction s of its baseline arc length.
enum class Law {
  linear,   ///< s
  c1,       ///< 3 s^2 - 2 s^3: zero slope at both ends
  c2,       ///< 10 s^3 - 15 s^4 + 6 s^5: zero slope and curvature at both ends
  mixed,    ///< blocks: a s + (1 - a) c1(s), a: VolumeOptions::linear_share
  matched,  ///< blocks: cubic, with the slope of the near field (zero) at ends on its edge, without curvature at others
  own       ///< the OwnLaw beside it
};

/// A law of the user's own: w(s), the weight of a line's far end, for s = 0 ... 1, with w(0) = 0 and w(1) = 1 to 1e-12
/// and finite between; PlanError otherwise. Plans call it a few hundred times, from one thread, and keep a table of
/// cubics through its values (tabulate() in plan/law_table.hpp says how near they come); kernels read that, so that all
/// execution spaces get the same bits.
struct OwnLaw {
  std::function<double(double)> weight;
  std::string name;  ///< in what plans print
};

/// The law of chains between two kinds of ends ("wall", "periodic", ...) or patches and periodic interfaces (any
/// selector that is no kind), in either order. A face that a chain made known counts as the better of that chain's
/// ends, as both where they rank alike.
struct LawOfEnds {
  std::array<std::string, 2> between;
  Law law = Law::linear;
  OwnLaw own{};         ///< of Law::own
  std::string where{};  ///< "case.toml:14", for messages
};

/// Kinds of boundaries from first to last, as chains rank by them.
inline std::vector<std::string> standard_order() { return {"wall", "periodic", "inflow", "outflow"}; }

/// One group of the chain priority; a later group breaks the ties of the one before.
struct PriorityRule {
  enum class Kind { boundary, quality, aspect_ratio };
  Kind kind = Kind::boundary;
  /// boundary: kinds from first to last; a chain ranks by its better end, then by its other end.
  std::vector<std::string> order = standard_order();
  std::vector<std::string> patches{};  ///< boundary: selectors of patches that come before all kinds, first to last
};

/// Boundary types, then quality, then aspect ratio. A function, not a braced list beside the member: g++ 12 ends with
/// an internal error where such a member's struct is value-initialised inside a template.
inline std::vector<PriorityRule> standard_priority() {
  return {{PriorityRule::Kind::boundary, standard_order()},
          {PriorityRule::Kind::quality, {}},
          {PriorityRule::Kind::aspect_ratio, {}}};
}

/// What decides which chain of blocks comes first.
enum class OrderBy {
  priority,    ///< VolumeOptions::priority
  prediction,  ///< the order of which predict() says the best, never worse than that by priority; needs the rules'
               ///< displacements
  automatic  ///< priority; where predict() finds inverted cells and `law` is linear for all chains, what a quick search
             ///< for order and law finds
};

/// A plane of nodes of a zone where blocks end: chains go on through it, and those beside one another on its two sides
/// have ranks and orders of their own.
struct BlockCut {
  std::string zone;     ///< the name of the zone
  int axis = 0;         ///< 0, 1, 2: the plane has one i, j or k
  int node = 0;         ///< that one, counted from 0, inside the zone
  std::string where{};  ///< "case.toml:14", for messages
};

struct VolumeOptions {
  Law law = Law::linear;
  OwnLaw own_law;               ///< of Law::own
  double linear_share = 0.85;   ///< of Law::mixed
  std::vector<LawOfEnds> laws;  ///< blocks: of some chains; the first that fits, else `law`
  bool laws_by_prediction =
      false;  ///< blocks: other laws for single chains where predict() says that cells come out better
  OrderBy order = OrderBy::automatic;  ///< blocks
  /// Blocks: how much of the turn of their walls near fields that rotate hand on at their outer edge, 0 to 1. Nothing:
  /// where all lines from there end on boundaries at rest that are no walls and the walls move rigidly, 1; elsewhere 0.
  std::optional<double> turn;
  std::vector<PriorityRule> priority = standard_priority();
  std::vector<BlockCut> cuts;  ///< blocks

  /// Whether displacements are looked at to plan.
  [[nodiscard]] bool by_prediction() const { return order == OrderBy::prediction || laws_by_prediction; }
  /// Whether they may be, where cells would come out inverted.
  [[nodiscard]] bool are_automatic() const {
    return order == OrderBy::automatic && law == Law::linear && laws.empty() && !laws_by_prediction;
  }
};

struct PlanOptions {
  TopologyOptions topology;                    ///< blocks
  std::vector<BoundaryLayer> boundary_layers;  ///< how far the near field of which walls goes, and how it turns
  /// Blocks: whether, where that list is empty, every wall patch whose rule moves it has the near field of
  /// BoundaryLayer{}.
  bool default_boundary_layer = true;
  VolumeOptions volume;  ///< of elements: `law`, along the grid lines of the background mesh
  ElementOptions elements;
};

}  // namespace gridmorph
