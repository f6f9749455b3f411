// The section of a cascade of cambered blades in a plane, one passage: along a straight line, or bent around an axis.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <functional>

namespace gridmorph::test {

/// Where the straight section goes: x from -1.4 to 2.4, the blade from 0 to 1; t along the pitch, the sides
/// plane_cascade_pitch apart. Into the plane z = 0.
using PlaneMap = std::function<Vec3(double x, double t)>;
constexpr double plane_cascade_pitch = 0.8;

/// As it is.
PlaneMap straight_section();
/// Around the z axis at a radius, lengths kept there: r = radius + x.
PlaneMap bent_section(double radius);
/// Around the z axis in a wheel of so many blades, all angles kept: r = exp(2 pi x / (blades pitch)).
PlaneMap section_of_wheel(int blades);

/// Patches of families inlet, outlet and blade; `sides` takes the lower periodic side onto the upper one.
Mesh plane_cascade(PlaneMap const& map, Periodic const& sides);
/// The same section at so many stations between two planes, one block; with hub and case.
Mesh cascade_between_planes(PlaneMap const& map, Periodic const& sides, double height, int stations = 3,
                            PatchKind ends = PatchKind::wall);
/// The same as a 2-D mesh of one block, as readers give it a second plane.
Mesh plane_cascade_block(PlaneMap const& map, Periodic const& sides);

/// Sides of the bent sections: a turn about z.
Periodic turned_sides(double angle_rad);

}  // namespace gridmorph::test
