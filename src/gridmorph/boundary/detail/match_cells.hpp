// Face cells of a mesh, and open ones that coincide after a rigid transform. Internal to topology.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gridmorph::topology {

/// One of the six faces of a zone.
struct ZoneFace {
  int zone, axis, side;
  int u, v;           ///< tangential axes, ascending
  Index first;        ///< number of cell (0, 0)
  int nu, nv;         ///< cells along u and v
  bool thick = true;  ///< the zone has more than one cell across
};

/// Corners of a face cell in the order (0,0), (1,0), (1,1), (0,1) of (u, v).
inline constexpr std::array<std::array<int, 2>, 4> corner_offset{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// One of the 8 ways to lay a face cell on another: corner c on corner image(c).
struct Turn {
  int number = 0;  ///< 0..7; 4 and above mirror
  [[nodiscard]] int image(int c) const { return (number < 4 ? number + c : number - c + 8) % 4; }
  [[nodiscard]] Turn inverse() const { return {number < 4 ? (4 - number) % 4 : number}; }
};

struct CellShape {
  std::array<Vec3, 4> corner;
  Vec3 centre, inward;  ///< inward: towards the zone's inside, any length
  double edge = 0;      ///< smallest edge that has a length; 0 when the cell is collapsed to a line or point
  double noise = 0;     ///< round-off of its coordinates
};

/// The face cells of a mesh: their corners, sizes and which of them nothing claims.
class SurfaceCells {
 public:
  explicit SurfaceCells(Mesh const& mesh);

  [[nodiscard]] Index size() const { return Index(open_.size()); }
  [[nodiscard]] std::vector<ZoneFace> const& faces() const { return faces_; }
  [[nodiscard]] int face_of(Index cell) const;
  [[nodiscard]] CellShape shape(Index cell) const;
  [[nodiscard]] Mesh const& mesh() const { return *mesh_; }

  [[nodiscard]] bool is_open(Index cell) const { return open_[cell] != 0; }
  /// Whether cell (a, b) of a face is on it and open.
  [[nodiscard]] bool is_open(ZoneFace const& face, int a, int b) const {
    return a >= 0 && a < face.nu && b >= 0 && b < face.nv && open_[face.first + a + Index(face.nu) * b] != 0;
  }
  /// Whether a cell is on one of the two planes of a mesh all of whose zones have one cell layer, as 2-D meshes have.
  [[nodiscard]] bool on_plane_of_layer(Index cell) const { return one_layer_ && !faces_[face_of(cell)].thick; }
  /// Whether two cells are on the two sides of a zone of one cell layer, or on the planes of a mesh of them.
  [[nodiscard]] bool across_one_layer(Index a, Index b) const {
    if (on_plane_of_layer(a) && on_plane_of_layer(b)) return true;
    ZoneFace const& f = faces_[face_of(a)];
    ZoneFace const& g = faces_[face_of(b)];
    return f.zone == g.zone && f.axis == g.axis && !f.thick;
  }
  void claim(Index cell) { open_[cell] = 0; }
  void release(Index cell) { open_[cell] = 1; }

  /// Node (p, q) of a face, p along u.
  [[nodiscard]] Index node(ZoneFace const& face, int p, int q) const;
  [[nodiscard]] Index3 node_index(ZoneFace const& face, int p, int q) const;

 private:
  void claim(int zone, IndexRange const& range);

  Mesh const* mesh_;
  std::vector<CoordinatePrecision> precision_;  ///< by zone
  std::vector<ZoneFace> faces_;
  std::vector<std::uint8_t> open_;
  bool one_layer_ = true;  ///< every zone is one cell thick along an axis
};

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
