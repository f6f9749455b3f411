#include <gridmorph/page/picture_mesh.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>

namespace gridmorph::page {

namespace {

class ElementPictures final : public PictureMesh {
 public:
  ElementPictures(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                  std::span<signed char const> signs)
      : PictureMesh(mesh),
        topology_(topology),
        face_patches_(face_patches),
        signs_(signs.begin(), signs.end()),
        tables_(detail::element_tables(Kokkos::DefaultHostExecutionSpace(), mesh)) {}

  bool is_plane() const override { return mesh().dimension == 2; }
  Index n_cells() const override { return mesh().n_elements(); }

  std::vector<Facet> boundary() const override {
    std::vector<Facet> out;
    if (is_plane()) return out;
    for (Index f = 0; f < topology_.boundary.size(); ++f) {
      auto const face = topology_.boundary.nodes[f];
      std::vector<Index32> const inwards(face.rbegin(), face.rend());
      add(inwards, face_patches_.patch[f], out);
    }
    return out;
  }

  Plane plane() const override {
    Plane out;
    for (Index e = 0; e < n_cells(); ++e) {
      add(mesh().elements.corners(e), -1, out.facets);
      out.cell.resize(out.facets.size(), e);
    }
    for (Index f = 0; f < topology_.boundary.size(); ++f)
      if (auto const side = topology_.boundary.nodes[f]; side.size() == 2)
        out.sides.push_back({{side[0], side[1]}, face_patches_.patch[f]});
    return out;
  }

  Plane index_plane(int /*axis*/, int /*index*/) const override { return {}; }

  std::vector<Index> crossed(std::span<double const> level) const override {
    std::vector<Index> out;
    for (Index e = 0; e < n_cells(); ++e) {
      auto const corners = mesh().elements.corners(e);
      auto const below = std::count_if(corners.begin(), corners.end(), [&](Index32 n) { return level[n] < 0; });
      if (below != 0 && below != std::ptrdiff_t(corners.size())) out.push_back(e);
    }
    return out;
  }

  void faces(Index cell, CellFaces& out) const override {
    out.node.clear();
    out.first.assign(1, 0);
    std::array<Index32, max_face_corners> room{};
    for (int side = 0; side < n_sides(mesh(), cell); ++side) {
      auto const nodes = side_nodes(mesh(), cell, side, room);
      out.node.insert(out.node.end(), nodes.begin(), nodes.end());
      out.first.push_back(out.node.size());
    }
  }

  std::vector<Index> around(Index cell) const override {
    std::vector<Index> out;
    for (Index32 const n : mesh().elements.corners(cell))
      for (Index32 const e : topology_.elements_of_nodes[n])
        if (e != cell) out.push_back(e);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  kernels::CellMeasures measures(Index cell, Coordinates const& at) const override {
    CoordinateViews<Kokkos::HostSpace> const points{at.x, at.y, at.z};
    return tables_.measures(points, cell, signs_[cell]);
  }

  CellName name(Index cell) const override {
    int const zone = mesh().zone_of_element(cell);
    return {mesh().zones[zone].name, {number_in_file(mesh(), cell)}};
  }

  Index number_of(int zone, Index3 const& cell) const override {
    Zone const& z = mesh().zones[zone];
    for (Index e = z.first_element; e < z.first_element + z.n_elements; ++e)
      if (number_in_file(mesh(), e) == cell[0] + 1) return e;
    return -1;
  }

 private:
  static void add(std::span<Index32 const> nodes, int patch, std::vector<Facet>& out) {
    if (nodes.size() == 4) {
      out.push_back({{nodes[0], nodes[1], nodes[2], nodes[3]}, patch});
      return;
    }
    for (std::size_t n = 2; n < nodes.size(); ++n) out.push_back({{nodes[0], nodes[n - 1], nodes[n], -1}, patch});
  }

  UnstructuredTopology const& topology_;
  BoundaryFacePatches const& face_patches_;
  std::vector<signed char> signs_;
  detail::ElementTables<Kokkos::HostSpace> tables_;
};

}  // namespace

std::unique_ptr<PictureMesh> picture_mesh(Mesh const& mesh, UnstructuredTopology const& topology,
                                          BoundaryFacePatches const& face_patches, std::span<signed char const> signs) {
  return std::make_unique<ElementPictures>(mesh, topology, face_patches, signs);
}

}  // namespace gridmorph::page
