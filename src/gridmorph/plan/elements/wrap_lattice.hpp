// The lattice of a wrap.
#pragma once

#include <gridmorph/plan/elements/wrap.hpp>

#include <array>
#include <span>
#include <vector>

namespace gridmorph::detail {

/// How far the offset goes in chart coordinates, for each wall face in turn: the offset times the length of each
/// coordinate's gradient there. So a point of space that is closer than the offset is so in the chart.
using Reaches = std::vector<std::array<double, 3>>;
Reaches reaches_of(Coordinates const& places, Chart const& chart, std::span<CsrGraph const> walls, double offset);

/// Planes of the lattice and a cell flag for each of its cells, all of them 0. `coordinates`: of all nodes, in the
/// chart.
Wrap make_lattice(Mesh const& mesh, Coordinates const& coordinates, std::span<CsrGraph const> walls,
                  Reaches const& reach, LatticeBox const& domain, WrapOptions const& options);

}  // namespace gridmorph::detail
