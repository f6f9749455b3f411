#include <gridmorph/plan/plane_axes.hpp>

#include <cmath>

namespace gridmorph {

std::array<int, 3> plane_axes(Mesh const& mesh) {
  if (mesh.dimension == 3) return {0, 1, 2};
  Vec3 const normal = plane_normal(mesh);
  if (std::abs(normal.x) == 1) return {1, 2, 0};
  if (std::abs(normal.y) == 1) return {2, 0, 1};
  return {0, 1, 2};
}

Vec3 along_axes(std::array<int, 3> const& axes, Vec3 const& v) {
  std::array<double, 3> const of_mesh{v.x, v.y, v.z};
  return {of_mesh[axes[0]], of_mesh[axes[1]], of_mesh[axes[2]]};
}

Vec3 back_from_axes(std::array<int, 3> const& axes, Vec3 const& v) {
  std::array<double, 3> out{};
  std::array<double, 3> const seen{v.x, v.y, v.z};
  for (std::size_t k = 0; k < 3; ++k) out[axes[k]] = seen[k];
  return {out[0], out[1], out[2]};
}

Mat3 along_axes(std::array<int, 3> const& axes, Mat3 const& m) {
  Mat3 out = m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out.m[i][j] = m.m[axes[i]][axes[j]];
  return out;
}

kernels::RowFrame along_axes(std::array<int, 3> const& axes, kernels::RowFrame const& row) {
  auto const turned = [&](Vec3 const& v) { return along_axes(axes, v); };
  return {turned(row.origin), turned(row.direction), turned(row.span), turned(row.pitch), row.is_linear};
}

std::vector<SlipSurface> along_axes(std::array<int, 3> const& axes, std::vector<SlipSurface> surfaces) {
  // Lines have planes, circles and axial positions to slide on, and no facets.
  for (SlipSurface& s : surfaces) {
    s.origin = along_axes(axes, s.origin);
    s.direction = along_axes(axes, s.direction);
  }
  return surfaces;
}

Coordinates along_axes(std::array<int, 3> const& axes, Coordinates const& x) {
  std::array<Coordinates::View, 3> const of_mesh{x.x, x.y, x.z};
  Coordinates out;
  out.x = of_mesh[axes[0]];
  out.y = of_mesh[axes[1]];
  out.z = of_mesh[axes[2]];
  return out;
}

Coordinates back_from_axes(std::array<int, 3> const& axes, Coordinates const& x) {
  Coordinates out(x.size());
  for (Index n = 0; n < x.size(); ++n) out.set(n, back_from_axes(axes, x[n]));
  return out;
}

}  // namespace gridmorph
