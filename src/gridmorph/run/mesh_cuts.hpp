// Where meshes are cut for pictures: those of report pages, and those of the command `view`.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/page/section.hpp>
#include <gridmorph/page/surface_picture.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// The plane that a mesh is, seen along the coordinate in which these nodes extend least. Cost O(nodes).
page::Cut flat_cut(std::span<Vec3 const> nodes);
/// A plane of nodes of every block that has it: axis 0 to 2, index from 0. Throws ConfigError where no block has it.
/// Cost: nodes of the plane.
page::Cut index_cut(page::PictureMesh const& mesh, Coordinates const& at, int axis, int index);
/// Where coordinate 0 to 2 has a value [length].
page::Cut plane_cut(int coordinate, double value);
/// At shares of the way from the inner to the outer radius, rolled out about the middle of `about`: axial position and
/// radius x angle. Empty where the nodes fill no annulus along the axis, as in radial machines, and without nodes
/// `about`. Cost: a pass over the nodes.
std::vector<page::Cut> span_cuts(Coordinates const& at, Axis const& axis, std::span<double const> shares,
                                 std::span<Vec3 const> about);
/// Across each coordinate, through the middle of what of a surface is in focus, weighted by how far it moves.
std::vector<page::Cut> plane_cuts(page::Surface const& surface, std::vector<Vec3> const& displacement);

/// The nodes of a surface that are in focus.
std::vector<Vec3> nodes_in_focus(page::Surface const& surface);
/// Which way is up in a picture of a surface: away from the axis of a machine; otherwise what the body is thinnest
/// along, and z where it is as thick all round.
Vec3 upwards(std::optional<Axis> const& axis, page::Surface const& surface);

}  // namespace gridmorph::cli
