// A mesh of either kind as pictures see it: facets of its boundary, cells with their faces, their names and measures.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::page {

/// Three nodes (the last is -1) or four, in order around it, right-handed about a normal that points into the mesh.
struct Facet {
  std::array<Index32, 4> node{-1, -1, -1, -1};
  int patch = -1;

  [[nodiscard]] std::size_t size() const { return node[3] < 0 ? 3 : 4; }
};

/// A side of a mesh in the plane.
struct Edge {
  std::array<Index32, 2> node{-1, -1};
  int patch = -1;
};

/// Corners of the faces of one cell, each in order around it.
struct CellFaces {
  std::vector<Index32> node;
  std::vector<std::size_t> first;  ///< (faces + 1)

  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
  [[nodiscard]] std::span<Index32 const> operator[](std::size_t f) const {
    return {node.data() + first[f], first[f + 1] - first[f]};
  }
};

/// A cell as its file names it: 1-based i, j, k of blocks; of elements the number alone.
struct CellName {
  std::string zone;
  std::vector<Index> index;
};

/// Cells are numbered zone after zone, i fastest, or as elements. The mesh must outlive it.
class PictureMesh {
 public:
  explicit PictureMesh(Mesh const& mesh) : mesh_(mesh) {}
  virtual ~PictureMesh() = default;
  PictureMesh(PictureMesh const&) = delete;
  PictureMesh& operator=(PictureMesh const&) = delete;

  [[nodiscard]] Mesh const& mesh() const { return mesh_; }
  /// Whether it is a plane: 2-D, or one cell thick along k in all of its zones.
  [[nodiscard]] virtual bool is_plane() const = 0;
  [[nodiscard]] virtual Index n_cells() const = 0;

  /// Faces on patches; none of a plane mesh of elements.
  [[nodiscard]] virtual std::vector<Facet> boundary() const = 0;
  /// The cells of a plane as facets, cell by cell (one of more than four corners as several: `cell` says whose each
  /// is), and its sides.
  struct Plane {
    std::vector<Facet> facets;
    std::vector<Index> cell;
    std::vector<Edge> sides;
  };
  [[nodiscard]] virtual Plane plane() const = 0;
  /// The same of the plane of nodes `index` (from 0) across an axis of blocks; zones without it are left out. Empty of
  /// elements.
  [[nodiscard]] virtual Plane index_plane(int axis, int index) const = 0;

  /// Cells with a node where level is below 0 and one where it is not, ascending. (n_nodes). Cost O(cells).
  [[nodiscard]] virtual std::vector<Index> crossed(std::span<double const> level) const = 0;
  virtual void faces(Index cell, CellFaces& out) const = 0;
  /// Cells that have a corner in common with this one, without it; in blocks those of its zone.
  [[nodiscard]] virtual std::vector<Index> around(Index cell) const = 0;

  [[nodiscard]] virtual kernels::CellMeasures measures(Index cell, Coordinates const& at) const = 0;
  [[nodiscard]] virtual CellName name(Index cell) const = 0;
  /// The cell of a report: number of the zone and MeasureStatistics::worst_cell; -1 where there is none.
  [[nodiscard]] virtual Index number_of(int zone, Index3 const& cell) const = 0;

  /// The nodes of a cell, each once, ascending.
  [[nodiscard]] std::vector<Index32> nodes(Index cell) const;
  [[nodiscard]] Vec3 centre(Index cell, Coordinates const& at) const;

 private:
  Mesh const& mesh_;
};

/// A mesh of blocks for pictures. handedness: zone_handedness().
std::unique_ptr<PictureMesh> picture_mesh(Mesh const& mesh, std::span<int const> handedness);
/// A mesh of elements for pictures. signs: numbering_signs().
std::unique_ptr<PictureMesh> picture_mesh(Mesh const& mesh, UnstructuredTopology const& topology,
                                          BoundaryFacePatches const& face_patches, std::span<signed char const> signs);

/// "zone 'A' cell (i 3, j 1, k 7)" or "zone 'A' element 17".
std::string to_string(CellName const& name);

}  // namespace gridmorph::page
