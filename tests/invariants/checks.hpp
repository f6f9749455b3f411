// Checks on a finished run, each against the mesh itself.
#pragma once

#include "support/morph_run.hpp"

#include <string>

namespace gridmorph::test {

/// The first nodes that a plain interface joins and whose displacements differ in any bit, and how many there are;
/// empty when there are none.
std::string interface_nodes_that_differ(Outcome const& run);
/// Largest |R u_own - u_donor| over periodic interfaces, R from the nodes; and the largest gap of the moved copies.
double periodic_mismatch(Outcome const& run);
/// Largest distance of moved nodes on slip patches from where the baseline mesh has them relative to their surface,
/// divided by the size of the surface.
double off_slip_surface(Outcome const& run);
/// Largest difference between what the explicit rules ask of a patch node and what it gets.
double known_displacement_error(Outcome const& run);
/// Owner nodes of the plan's boundary whose displacement is not the given one bit for bit (to round-off on the axis of
/// a sector, where only the part along the axis counts).
Index boundary_values_changed(Outcome const& run);
/// Nodes whose displacement is not a finite number.
Index not_finite(Outcome const& run);

}  // namespace gridmorph::test
