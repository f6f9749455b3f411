#include <gridmorph/boundary/patch_surface.hpp>

#include <gridmorph/boundary/patch_points.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

/// Whether direction 0 x direction 1 of a patch points away from the first layer of cells, for most of its facets.
bool points_out_of_mesh(Mesh const& mesh, Patch const& patch) {
  Zone const& zone = mesh.zones[patch.zone];
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
      Vec3 const x = mesh.coordinates[n];
      Vec3 const normal = cross(mesh.coordinates[n + stride[axes[0]]] - x, mesh.coordinates[n + stride[axes[1]]] - x);
      double const height = dot(normal, mesh.coordinates[n + inside] - x);
      volume += height > 0 ? 1 : (height < 0 ? -1 : 0);
    }
  return volume < 0;
}

}  // namespace

std::size_t PointNumbers::Hash::operator()(Key const& key) const {
  std::uint64_t h = 0;
  for (std::int64_t const v : key) h = ((h ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15ull) ^ (h >> 29);
  return std::size_t(h);
}

std::int64_t PointNumbers::cell(double v) const {
  double const c = tolerance_ > 0 ? std::floor(v / (4 * tolerance_)) : 0;
  // Beyond this cells are wider than they say, which costs time only.
  constexpr double most = 9e18;
  return std::int64_t(std::clamp(c, -most, most));
}

int PointNumbers::find(Vec3 const& p) const {
  int best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  // A sphere of the tolerance touches at most two cells along each axis.
  Key const lo{cell(p.x - tolerance_), cell(p.y - tolerance_), cell(p.z - tolerance_)};
  Key const hi{cell(p.x + tolerance_), cell(p.y + tolerance_), cell(p.z + tolerance_)};
  for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
    for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
      for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
        if (auto const found = cells_.find({i, j, k}); found != cells_.end())
          for (Entry const& e : found->second)
            if (double const d = distance(p, e.point); d <= tolerance_ && d < nearest) {
              nearest = d;
              best = e.number;
            }
  return best;
}

void PointNumbers::add(Vec3 const& p, int number) { cells_[{cell(p.x), cell(p.y), cell(p.z)}].push_back({p, number}); }

double box_diagonal(std::vector<Vec3> const& points) {
  if (points.empty()) return 0;
  Vec3 lo = points.front(), hi = lo;
  for (Vec3 const& p : points) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  return distance(lo, hi);
}

PatchSurface::PatchSurface(Mesh const& mesh, std::vector<int> const& patches, PatchFaces const* faces)
    : gridded(faces == nullptr), lines(faces != nullptr && faces->lines) {
  auto const range_of = [&](Patch const& patch) {
    IndexRange range = patch.range;
    if (!gridded) range.end[1] = range.begin[1] + 1;
    return range;
  };
  if (gridded) {
    size = box_diagonal(patch_points(mesh, patches));
  } else {
    std::vector<Vec3> all;
    for (int const p : patches)
      for_each_node(mesh.zones[mesh.patches[p].zone], range_of(mesh.patches[p]),
                    [&](Index n) { all.push_back(mesh.coordinates[n]); });
    size = box_diagonal(all);
  }
  bool single = false;
  for (int const p : patches) single = single || mesh.zones[mesh.patches[p].zone].single_precision;
  tolerance = (single ? 1e-6 : 1e-9) * size;
  numbers = PointNumbers(tolerance);
  for (int const p : patches) {
    Patch const& patch = mesh.patches[p];
    PatchGrid grid;
    grid.patch = p;
    grid.extent = {1, 1};
    IndexRange const range = range_of(patch);
    for (int axis = 0, d = 0; axis < 3 && d < 2; ++axis)
      if (range.extent(axis) > 1) grid.extent[d++] = range.extent(axis);
    for_each_node(mesh.zones[patch.zone], range, [&](Index n) {
      Vec3 const x = mesh.coordinates[n];
      int number = numbers.find(x);
      if (number < 0) {
        number = int(points.size());
        points.push_back(x);
        numbers.add(x, number);
      }
      grid.vertex.push_back(number);
    });
    if (gridded) {
      grid.inward = points_out_of_mesh(mesh, patch);
    } else {
      grid.listed = faces->of_patch[std::size_t(p)].listed;
      for (GridFacet facet : faces->of_patch[std::size_t(p)].corners) {
        for (int& corner : facet)
          if (corner >= 0) corner = grid.vertex[std::size_t(corner)];
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
