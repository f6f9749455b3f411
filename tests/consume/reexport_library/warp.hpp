#pragma once

#include <gridmorph/mesh/mesh.hpp>

/// A mesh of one zone with all its nodes at the origin.
gridmorph::Mesh collapsed_box(gridmorph::Index3 extent);
