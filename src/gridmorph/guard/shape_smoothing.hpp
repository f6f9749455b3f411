// After a morph of blocks: nodes moved where corners of cells lost their shape.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/guard/guard.hpp>

#include <vector>

namespace gridmorph {

struct ShapeSmoothingOptions {
  /// A corner has lost its shape when its scaled Jacobian (volume of its edges' box / product of their lengths) is
  /// below `least_sine` and below `share` of what it was; so has a cell that the certificate finds broken between
  /// corners.
  double least_sine = 0.2, share = 0.5;
  /// One pass over the points of a region per sweep. Where cells are inverted after one round, the next follows.
  struct Round {
    int rings;          ///< of cells around those that lost their shape
    int sweeps;         ///< Gauss-Seidel, coloured
    double relaxation;  ///< first length tried of each step, in Newton steps
  };
  std::vector<Round> rounds{{8, 32, 1}, {24, 100, 1.7}};
  /// Numbers of the zones whose cells are looked at; empty: all. What is smoothed around them follows from them alone
  /// where no interface joins them to others.
  std::vector<int> zones{};
};

/// What is smoothed whatever a morph looks like, so that meshes of a sequence do not jump where the first cell loses
/// its shape.
struct FrozenSmoothing {
  std::vector<Index> cells;  ///< that lost their shape in some of the meshes; ascending
  bool inverted = false;     ///< some of them were inside out: the last round of the options is made, else the first

  /// Adds what another mesh lost.
  void join(FrozenSmoothing const& other);
};

struct ShapeSmoothingReport {
  Index triggered_before = 0, triggered_after = 0;  ///< cells with a corner that lost its shape
  Index inverted_before = 0,
        inverted_after = 0;  ///< cells with a corner inverted that was not in the baseline, or broken
  double smallest_before = 1, smallest_after = 1;  ///< scaled Jacobian, over the corners that could change
  int rounds = 0;                                  ///< that were kept
};

/// The same as guard() reports it.
GuardReport report_of(ShapeSmoothingReport const& report);

/// What a morph lost of shapes: what smooth_shapes() starts from. Cost: one look at all cells.
FrozenSmoothing lost_shapes(HostInstance const& host, IndexedMesh const& mesh, Coordinates const& morphed,
                            ShapeSmoothingOptions const& options = {});

/// Smooths around the given cells, with the same points and sweeps for every displacement, delta growing with what is
/// lost, and takes nothing back: the result follows the displacement without jumps. Otherwise as smooth_shapes().
ShapeSmoothingReport smooth_frozen(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                   Coordinates& morphed, FrozenSmoothing const& frozen,
                                   ShapeSmoothingOptions const& options = {});

/// Moves nodes so that the sum of the relative shapes f (kernels/relative_shape.hpp) of all corners around becomes
/// smaller: each point in turn by a step that does not let the sum over its corners grow, with delta > 0 as long as a
/// corner of the region has lost 98 % of its volume. Nodes that coincide, and periodic copies of them, are one point.
/// Points of the near field, with a given displacement (but for periodic interfaces that follow a blade), on axes,
/// poles and boundaries without a slip surface stay; points on slip surfaces slide on them.
///
/// A round is kept in every part of the region, of those that have no cell in common, in which fewer cells are inverted
/// after it, or as many and the smallest scaled Jacobian is larger, or the same and fewer cells have lost their shape;
/// nodes of the other parts are put back bit for bit. Nothing happens where no cell lost its shape. Explicit, the same
/// bits for any number of threads. mesh: what the plan was made for.
///
/// Cost: one look at all cells; where some lost their shape, two bytes and two numbers per node of the mesh, and in the
/// region about 1 kB per node and a few microseconds per node and sweep.
ShapeSmoothingReport smooth_shapes(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                   Coordinates& morphed, ShapeSmoothingOptions const& options = {});

}  // namespace gridmorph
