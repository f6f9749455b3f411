#include <gridmorph/plan/topology.hpp>
#include <gridmorph/run/block_summary.hpp>

#include <set>

namespace gridmorph::cli {

namespace {

Index3 block_extent(Lattice const& lattice, Block const& block) {
  Index3 extent{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis)
    for (int p = 0; p < block.n_pieces[axis]; ++p) {
      Index3 at{0, 0, 0};
      at[axis] = p;
      PlacedPiece const& placed = block.at(at[0], at[1], at[2]);
      extent[axis] += lattice.pieces()[placed.piece].nodes.extent(placed.to_block.inverse().axis[axis]) - 1;
    }
  return extent;
}

std::string face_text(Mesh const& mesh, Topology const& topology, BlockFace const& face) {
  std::set<std::string> names;
  for (int const entity : topology.blocks.face_entities(topology.lattice, face)) {
    int const c = topology.lattice.class_of(entity);
    int const patch = topology.blocks.patch_of_face()[c];
    int const interface = topology.blocks.interface_of_face()[c];
    if (patch >= 0) {
      Patch const& p = mesh.patches[patch];
      names.insert(p.families.empty() ? p.name : p.families.front());
    } else if (interface >= 0 && mesh.interfaces[interface].periodic) {
      names.insert("periodic " + mesh.interfaces[interface].name);
    } else {
      for (FaceSide const& side : topology.lattice.face_sides(c))
        if (side.entity != entity || topology.blocks.block_of(side.piece) != face.block)
          names.insert("block " + std::to_string(topology.blocks.block_of(side.piece) + 1));
    }
  }
  std::string text;
  for (auto const& name : names) text += (text.empty() ? "" : " + ") + name;
  return text;
}

}  // namespace

BlocksSummary summarize_blocks(Mesh const& mesh, Links const& links, std::vector<int> const& label_of_patch) {
  MergeLimits limits;
  limits.patch_label = label_of_patch;
  limits.interface_label.assign(mesh.interfaces.size(), 0);
  Topology const topology = build_topology(mesh, links, limits);
  BlocksSummary summary;
  summary.pieces = int(topology.lattice.pieces().size());
  for (int b = 0; b < topology.blocks.size(); ++b) {
    Block const& block = topology.blocks[b];
    Piece const& first = topology.lattice.pieces()[block.pieces.front().piece];
    BlockSummary line;
    line.extent = block_extent(topology.lattice, block);
    line.where = "zone '" + mesh.zones[first.zone].name + "' " + to_string(first.nodes);
    line.pieces = int(block.pieces.size());
    for (int f = 0; f < 6; ++f) line.faces[f] = face_text(mesh, topology, {b, f / 2, f % 2});
    summary.blocks.push_back(std::move(line));
  }
  return summary;
}

}  // namespace gridmorph::cli
