#include <gridmorph/boundary/face_grids.hpp>
#include <gridmorph/boundary/patch_surface.hpp>

#include <gridmorph/kernels/box_tree.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

/// Whether direction 0 x direction 1 of a patch points away from the first layer of cells, for most of its facets.
bool points_out_of_mesh(Boundary const& boundary, int p) {
  Patch const& patch = boundary.patches()[p];
  Coordinates const& coordinates = boundary.coordinates();
  Zone const& zone = boundary.zones()[patch.zone];
  std::array<int, 3> axes{0, 1, 2};
  for (int axis = 0; axis < 3; ++axis)
    if (patch.range.extent(axis) == 1) std::swap(axes[axis], axes[2]);
  std::sort(axes.begin(), axes.begin() + 2);
  auto const stride = zone.strides();
  Index const inside = patch.range.begin[axes[2]] == 0 ? stride[axes[2]] : -stride[axes[2]];
  double volume = 0;
  for (int b = 0; b + 1 < patch.range.extent(axes[1]); ++b)
    for (int a = 0; a + 1 < patch.range.extent(axes[0]); ++a) {
      Index const n = zone.node(patch.range.begin) + a * stride[axes[0]] + b * stride[axes[1]];
      Vec3 const x = coordinates[n];
      Vec3 const normal = cross(coordinates[n + stride[axes[0]]] - x, coordinates[n + stride[axes[1]]] - x);
      double const height = dot(normal, coordinates[n + inside] - x);
      volume += height > 0 ? 1 : (height < 0 ? -1 : 0);
    }
  return volume < 0;
}

}  // namespace

Vec3 facet_normal(std::vector<Vec3> const& points, GridFacet const& f) {
  if (f[3] < 0) return cross(points[f[1]] - points[f[0]], points[f[2]] - points[f[0]]);
  return cross(points[f[2]] - points[f[0]], points[f[3]] - points[f[1]]);
}

double box_diagonal(std::vector<Vec3> const& points) {
  Box box;
  for (Vec3 const& p : points) box.include(p);
  return points.empty() ? 0 : distance(box.low, box.high);
}

double largest_component(std::vector<Vec3> const& points) {
  double most = 0;
  for (Vec3 const& p : points) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return most;
}

PatchSurface::PatchSurface(Boundary const& boundary, std::vector<int> const& patches) : lines(boundary.is_plane()) {
  std::vector<Vec3> all;
  for (int const p : patches) {
    for (Index const n : boundary.surface(p).nodes) all.push_back(boundary.coordinates()[n]);
    gridded = gridded && boundary.surface(p).grid.has_value();
  }
  size = box_diagonal(all);
  tolerance = place_tolerance(1e-9, size, boundary.precision().at(std::max(size, largest_component(all))));
  numbers = PointNumbers(tolerance);
  for (int const p : patches) {
    BoundarySurface const& own = boundary.surface(p);
    PatchGrid grid;
    grid.patch = p;
    grid.nodes = own.nodes;
    grid.extent = own.grid.value_or(std::array<int, 2>{int(own.nodes.size()), 1});
    for (Index const n : own.nodes) {
      Vec3 const x = boundary.coordinates()[n];
      grid.vertex.push_back(numbers.find_or_add(x, int(points.size())));
      if (grid.vertex.back() == int(points.size())) points.push_back(x);
    }
    if (own.grid) {
      grid.inward = points_out_of_mesh(boundary, p);
    } else {
      grid.listed = own.in_file_order;
      for (GridFacet facet : own.faces) {
        for (int& corner : facet)
          if (corner >= 0) corner = grid.vertex[corner];
        grid.faces.push_back(facet);
      }
    }
    grids.push_back(std::move(grid));
  }
}

std::vector<GridFacet> PatchSurface::facets() const {
  std::vector<GridFacet> out;
  auto const add = [&](GridFacet const& all, int corners, bool reverse) {
    GridFacet facet{-1, -1, -1, -1};
    int n = 0;
    for (int c = 0; c < corners; ++c)
      if (all[c] != all[(c + 1) % corners]) facet[n++] = all[c];
    if (reverse) std::reverse(facet.begin(), facet.begin() + n);
    if (n >= 3 && facet[0] != facet[2] && (n == 3 || facet[1] != facet[3])) out.push_back(facet);
  };
  for (PatchGrid const& grid : grids) {
    for (GridFacet const& face : grid.faces)
      if (face[2] >= 0) add(face, face[3] < 0 ? 3 : 4, false);
    for (int b = 0; b + 1 < grid.extent[1]; ++b)
      for (int a = 0; a + 1 < grid.extent[0]; ++a)
        add({grid.at(a, b), grid.at(a + 1, b), grid.at(a + 1, b + 1), grid.at(a, b + 1)}, 4, grid.inward);
  }
  return out;
}

std::optional<PatchSurface> PatchSurface::in_grids(Boundary const& boundary) const {
  PatchSurface out = *this;
  out.grids.clear();
  out.gridded = true;
  for (PatchGrid const& own : grids) {
    if (own.faces.empty()) {
      out.grids.push_back(own);
      continue;
    }
    std::vector<Vec3> at;
    for (int const v : own.vertex) at.push_back(points[v]);
    FaceGrids const found = find_face_grids(boundary.surface(own.patch).faces, at);
    if (found.left_over > 0 || lines) return std::nullopt;
    for (FaceGrid const& grid : found.grids) {
      PatchGrid piece;
      piece.patch = own.patch;
      piece.extent = grid.extent;
      for (int const n : grid.point) {
        piece.vertex.push_back(own.vertex[n]);
        piece.nodes.push_back(own.nodes[n]);
      }
      out.grids.push_back(std::move(piece));
    }
  }
  return out;
}

std::vector<std::vector<int>> PatchSurface::neighbours() const {
  std::vector<std::vector<int>> out(points.size());
  auto const join = [&](int a, int b) {
    if (a == b) return;
    out[a].push_back(b);
    out[b].push_back(a);
  };
  for (PatchGrid const& grid : grids) {
    for (GridFacet const& face : grid.faces) {
      int const corners = int(std::count_if(face.begin(), face.end(), [](int v) { return v >= 0; }));
      for (int c = 0; c < corners; ++c) join(face[c], face[(c + 1) % corners]);
    }
    for (int b = 0; gridded && b < grid.extent[1]; ++b)
      for (int a = 0; a < grid.extent[0]; ++a) {
        if (a + 1 < grid.extent[0]) join(grid.at(a, b), grid.at(a + 1, b));
        if (b + 1 < grid.extent[1]) join(grid.at(a, b), grid.at(a, b + 1));
      }
  }
  for (auto& list : out) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return out;
}

}  // namespace gridmorph
