// Plane meshes across x or y, seen as ones across z.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/row_frame.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// Which components of a mesh come first, second and third: those in the plane of a 2-D mesh, then the one across it,
/// in cyclic order, which makes a turn of it and no mirror image. 0, 1, 2 of others.
std::array<int, 3> plane_axes(Mesh const& mesh);

/// A vector's components in that order, and back.
Vec3 along_axes(std::array<int, 3> const& axes, Vec3 const& v);
Vec3 back_from_axes(std::array<int, 3> const& axes, Vec3 const& v);
Mat3 along_axes(std::array<int, 3> const& axes, Mat3 const& m);
kernels::RowFrame along_axes(std::array<int, 3> const& axes, kernels::RowFrame const& row);
std::vector<SlipSurface> along_axes(std::array<int, 3> const& axes, std::vector<SlipSurface> surfaces);
/// Coordinates whose components are those of the mesh in this order. They share its arrays.
Coordinates along_axes(std::array<int, 3> const& axes, Coordinates const& x);
/// A copy of its components in the order of the mesh.
Coordinates back_from_axes(std::array<int, 3> const& axes, Coordinates const& x);

}  // namespace gridmorph
