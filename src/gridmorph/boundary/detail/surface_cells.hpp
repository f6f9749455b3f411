// The face cells of a mesh: their corners, sizes and which of them nothing claims. Internal to topology.
#pragma once

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

}  // namespace gridmorph::topology
