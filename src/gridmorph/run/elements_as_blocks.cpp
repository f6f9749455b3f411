#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/found_blocks.hpp>
#include <gridmorph/run/elements_as_blocks.hpp>

#include <fmt/format.h>

#include <utility>

namespace gridmorph::cli {

ElementsAsBlocks::ElementsAsBlocks(Mesh elements) : elements_(std::move(elements)) {
  HostInstance const host;
  UnstructuredTopology const topology = make_topology(host, elements_);
  FoundBlocks found = find_blocks(host, elements_, topology, find_face_patches(elements_, topology));
  if (found.n_left > 0)
    throw MeshError(fmt::format(
        "{}: {} of {} elements lie in no block of grid lines, so that it is no mesh of blocks; the first: {}. Remove "
        "blocks = \"find\" from [mesh], and it is morphed as elements",
        elements_.source, found.n_left, elements_.n_elements(), found.why_left));
  blocks_ = std::move(found.mesh);
  blocks_.notes.push_back(fmt::format("{}: {} block{} found in {} hexahedra", elements_.source, blocks_.zones.size(),
                                      blocks_.zones.size() == 1 ? "" : "s", elements_.n_elements()));
  element_ = std::move(found.element);
  std::vector<Index32> of_representative(std::size_t(elements_.n_nodes()), -1);
  for (std::size_t n = found.node.size(); n-- > 0;) of_representative[std::size_t(found.node[n])] = Index32(n);
  representative_ = coincident_nodes(elements_);
  block_node_ = representative_;
  for (Index32& n : block_node_) n = of_representative[std::size_t(n)];
}

Coordinates ElementsAsBlocks::coordinates(Coordinates const& of_blocks) const {
  Coordinates const& x = elements_.coordinates;
  Coordinates out(x.size());
  for (Index n = 0; n < x.size(); ++n) {
    Index32 const b = block_node_[std::size_t(n)], r = representative_[std::size_t(n)];
    // Nodes that are one may be apart by a rounding: they move alike.
    out.set(n, b < 0 ? x[n] : r == n ? of_blocks[b] : x[n] + (of_blocks[b] - x[r]));
  }
  return out;
}

OutputFields ElementsAsBlocks::fields(OutputFields const& of_blocks) const {
  OutputFields out;
  out.displacement = of_blocks.displacement;
  for (CellField const& field : of_blocks.cells) {
    CellField& own = out.cells.emplace_back(field);
    for (std::size_t c = 0; c < element_.size(); ++c) own.values[std::size_t(element_[c])] = field.values[c];
  }
  for (NodeField const& field : of_blocks.nodes) {
    NodeField& own = out.nodes.emplace_back(field);
    own.values.assign(block_node_.size(), 0);
    for (std::size_t n = 0; n < block_node_.size(); ++n)
      if (block_node_[n] >= 0) own.values[n] = field.values[std::size_t(block_node_[n])];
  }
  return out;
}

}  // namespace gridmorph::cli
