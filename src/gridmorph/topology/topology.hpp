// The topology of a mesh: links between zones, the cut lattice with its coincident entities, and the blocks.
#pragma once

#include <gridmorph/plan/options.hpp>
#include <gridmorph/topology/blocks.hpp>
#include <gridmorph/topology/coverage.hpp>
#include <gridmorph/topology/cuts.hpp>
#include <gridmorph/topology/lattice.hpp>
#include <gridmorph/topology/links.hpp>

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
