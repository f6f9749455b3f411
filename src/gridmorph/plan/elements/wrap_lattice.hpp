// The lattice of a wrap.
#pragma once

#include <gridmorph/plan/elements/wrap.hpp>

#include <span>

namespace gridmorph::detail {

/// Planes of the lattice and a cell flag for each of its cells, all of them 0.
Wrap make_lattice(Mesh const& mesh, std::span<CsrGraph const> walls, LatticeBox const& domain,
                  WrapOptions const& options);

}  // namespace gridmorph::detail
