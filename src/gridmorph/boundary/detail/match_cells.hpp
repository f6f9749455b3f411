// Open face cells that coincide after a rigid transform. Internal to topology.
#pragma once

#include <gridmorph/boundary/detail/surface_cells.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <cstdint>
#include <vector>

namespace gridmorph::topology {

/// transform(cell) lies on `other`, corner c on corner turn.image(c).
struct CellPair {
  Index cell = -1, other = -1;
  Turn turn;
  double mismatch = 0;
};

/// Largest distance of matched corners that counts as none.
double corner_tolerance(CellShape const& a, CellShape const& b, double relative);

/// The way in which `moved` lies on `other`, if it does. True when found; fills turn and mismatch.
bool lies_on(CellShape const& moved, CellShape const& other, double relative, Turn& turn, double& mismatch);

/// Whether the zones of two coincident cells are on opposite sides of them.
bool on_opposite_sides(CellShape const& moved, CellShape const& other);

CellShape transformed(CellShape const& shape, RigidTransform const& t);

/// Cells in bins of their own size: a search looks at the cells whose centres are nearby and whose smallest edges are
/// as long.
class CellBins {
 public:
  /// Takes in the cells that are open now and have an area.
  CellBins(SurfaceCells const& cells, double relative);

  /// The open cell that an open cell lies on under a transform, the nearest where there are several (`hits` of them).
  /// Unless it is the identity, the two sides of one cell layer are no partners.
  [[nodiscard]] CellPair partner(Index cell, RigidTransform const& t, bool identity, int& hits) const;

  /// All pairs of open cells under a transform, each cell in one pair at most, ordered by cell. Identity: each pair
  /// once, from the cell with the lower number. Cells that lie on several others go to the nearest; `ambiguous` counts
  /// them.
  [[nodiscard]] std::vector<CellPair> match(RigidTransform const& t, bool identity, Index& ambiguous) const;

 private:
  [[nodiscard]] int level(double size) const;
  [[nodiscard]] std::uint64_t key(int level, std::int64_t i, std::int64_t j, std::int64_t k) const;

  SurfaceCells const* cells_;
  double relative_;
  std::uint64_t mask_;
  std::vector<Index> head_, number_, next_;  ///< chains of entries per bin
  std::vector<std::uint64_t> key_;
};

}  // namespace gridmorph::topology
