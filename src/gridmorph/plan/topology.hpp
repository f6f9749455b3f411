// The topology of a mesh: links between zones, the cut lattice with its coincident entities, and the blocks.
#pragma once

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/plan/blocks/blocks.hpp>
#include <gridmorph/plan/blocks/cuts.hpp>
#include <gridmorph/plan/blocks/lattice.hpp>
#include <gridmorph/plan/options.hpp>

namespace gridmorph {

struct Topology {
  Links links;
  Lattice lattice;
  Blocks blocks;
};

/// Cuts, identifies and merges. `links` come from connect(); coverage must have been checked. `limits.kept_planes` are
/// cut as well. Cost: O(blocks), plus what connect() costs; coordinates are not read.
inline Topology build_topology(Mesh const& mesh, Links links, MergeLimits const& limits) {
  Lattice lattice(mesh, links, cut_zones(mesh, links, limits.kept_planes));
  Blocks blocks(mesh, links, lattice, limits);
  return {std::move(links), std::move(lattice), std::move(blocks)};
}

}  // namespace gridmorph
