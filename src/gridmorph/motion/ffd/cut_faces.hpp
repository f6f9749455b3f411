// Through which of its faces a surface runs out of a lattice.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// i-min, i-max, j-min, j-max, k-min, k-max: whether a side of a facet of the patches has one end inside the lattice
/// and leaves it there. Cost O(nodes of the patches).
std::array<bool, 6> cut_faces(Boundary const& boundary, std::vector<int> const& patches, FfdLattice const& lattice);

}  // namespace gridmorph
