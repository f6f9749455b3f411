// The facets of structured patches.
#pragma once

#include <gridmorph/geometry/facet_surface.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <span>

namespace gridmorph {

/// The quadrilaterals of structured patches, in their order.
FacetList facets_of_patches(Mesh const& mesh, std::span<int const> patches);

}  // namespace gridmorph
