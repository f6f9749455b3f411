// The background mesh: a structured multi-block mesh between the wrap and an outer box, which carries the displacement
// of the wrap out to the far field.
//
// It is planned and morphed by the structured engine as any other mesh:
//
//   Background background = make_background(wrap);
//   PreparedMorph prepared = prepare_background(background);
//   WrapNodes nodes = wrap_nodes(background, prepared);   // whose displacements are needed, and where they go
//   auto const morpher = MorpherAccess::of(exec, prepared.plan(), x_of_background);
//   ... every time: gather displacements at nodes.position into the View `boundary`, zero elsewhere
//   morpher.displacements(exec, boundary, u_of_background);
//
// and its displacements come to the nodes of the far field by the rows of lattice_rows().
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/elements/wrap.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// The tensor grid that a background made of lattice cells is cut from: where the cell that holds a point is found by
/// bisection.
struct FineLattice {
  Chart chart;                                ///< planes are in its coordinates
  std::array<std::vector<double>, 3> planes;  ///< of nodes
  std::array<std::vector<int>, 3> cut;        ///< node planes where zones end, first and last included, ascending
  std::array<std::vector<int>, 3> slab;       ///< per cell: which interval between cuts
  std::vector<int> zone;                      ///< per box of slabs, i fastest; -1: in the wrap

  [[nodiscard]] int slabs(int axis) const { return int(cut[axis].size()) - 1; }
  [[nodiscard]] int box(Index3 const& s) const { return s[0] + slabs(0) * (s[1] + slabs(1) * s[2]); }
};

struct Background {
  Mesh mesh;                           ///< patches of families "wrap", "outer" and, in 2-D, "sides"
  int dimension = 3;                   ///< 2: one layer of cells in z
  std::optional<FineLattice> lattice;  ///< of backgrounds made from lattice cells
  /// Sides on which nodes slide, or that go along: a family of patches, and its rule. All others are `outer`.
  struct Side {
    std::string family;
    Rule rule;
  };
  std::vector<Side> sides;
  /// Selectors of the patches that move, and of those that stay. (No braced lists: see standard_priority().)
  std::vector<std::string> wrap = std::vector<std::string>(1, "wrap"), outer = std::vector<std::string>(1, "outer");
};

/// Around a tube: an O-type mesh, four blocks around the tube and nine beyond each of its ends (a butterfly in front of
/// the flat end); throws MeshError where this would turn cells inside out. Else the cells of the wrap's lattice outside
/// the wrap, each `cells` cells wide where there are walls; from there cells grow by `growth` each out to the outer
/// box. Slabs of coarse cells that look alike are joined, so a wrap that is a box gives 26 zones. Nodes are where the
/// chart of the wrap has them, and the sides that end with the mesh are what ChartedDomain::side says: slip surfaces
/// are planes, surfaces of revolution, or the side itself. Cost: linear in nodes.
Background make_background(Wrap const& wrap, int cells = 4, double growth = 1.4);

/// A mesh of the user's (or of any other generator); all of its patches that no selector names slip, stay or move as
/// the structured engine's defaults say. Throws MotionError for selectors that name nothing.
Background make_background(Mesh mesh, std::vector<std::string> wrap, std::vector<std::string> outer);

/// The plan of a background: displacements given on the wrap, zero on the outer patches, 2-D sides free,
/// Background::sides as they say.
PreparedMorph prepare_background(HostInstance const& host, Background const& background,
                                 VolumeOptions const& volume = {});

/// The nodes of the wrap, each point once.
struct WrapNodes {
  std::vector<Vec3> position;          ///< z = 0 in 2-D
  std::vector<Index32> boundary_node;  ///< where in Plan::boundary_nodes; all others are to be zero
};
WrapNodes wrap_nodes(Background const& background, PreparedMorph const& prepared);

/// Displacements of points from those of background nodes (numbered as in Background::mesh).
struct FarRows {
  InterpolationOperator rows;   ///< one for each point
  Index n_outside = 0;          ///< points inside the wrap or outside the outer box: the nearest place counts
  double largest_distance = 0;  ///< of theirs
};

/// Trilinear weights in chart coordinates, in the lattice cell that holds each point (bilinear in 2-D, where z is not
/// looked at); nodes of weight zero are left out. Row n is for nodes[n], which is its target. Linear cost, but for
/// points in the wrap, each of which looks at all zones.
FarRows lattice_rows(HostInstance const& host, Background const& background, Coordinates const& coordinates,
                     std::span<Index32 const> nodes);

/// Rows for points in any background: those of lattice_rows() where it can make them, else in the cell that
/// ElementLocator finds.
FarRows background_rows(HostInstance const& host, Background const& background, Coordinates const& coordinates,
                        std::span<Index32 const> nodes);

}  // namespace gridmorph

namespace gridmorph::detail {

/// Blocks between a tube and a box: four around it from end to end; at both ends four more that go on to the box's end
/// face, and within these the core and the four blocks around it (a butterfly) in front of the tube's flat end.
/// `box`: planes of the outer box. Throws MeshError when a cell would be inside out.
Mesh o_type_mesh(Tube const& tube, std::array<std::vector<double>, 3> const& box, double growth);

/// Places from 0 to `length` whose spacing is about `first` at the beginning and grows by `growth` a step.
std::vector<double> growing(double length, double first, double growth);

}  // namespace gridmorph::detail
