#include <gridmorph/plan/block_graph.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>
#include <gridmorph/plan/first_stages.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace gridmorph {

namespace {

Index cells_of(IndexRange const& nodes) {
  Index cells = 1;
  for (int a = 0; a < 3; ++a) cells *= nodes.extent(a) - 1;
  return cells;
}

/// The number of cell faces of a face, along one direction of which there is a single node.
Index cell_faces_of(IndexRange const& nodes) {
  Index faces = 1;
  for (int a = 0; a < 3; ++a) faces *= std::max(nodes.extent(a) - 1, 1);
  return faces;
}

BlockGraph::Block node_of(Mesh const& mesh, Topology const& topology, int block) {
  auto const& placed = topology.blocks[block].pieces;
  auto const& pieces = topology.lattice.pieces();
  Piece const& first = pieces[placed.front().piece];
  BlockGraph::Block out;
  out.name = mesh.zones[first.zone].name + " " + to_string(first.nodes);
  std::set<int> zones;
  for (PlacedPiece const& p : placed) {
    Piece const& piece = pieces[p.piece];
    zones.insert(piece.zone);
    out.cells += cells_of(piece.nodes);
  }
  out.other_zones = int(zones.size()) - 1;
  return out;
}

}  // namespace

BlockGraph block_graph(PreparedMorph const& prepared) {
  Mesh const& mesh = prepared.mesh;
  Topology const topology = plan_basis(mesh, prepared.links, prepared.surface, prepared.options).topology;
  Lattice const& lattice = topology.lattice;
  BlockGraph out;
  std::map<std::tuple<int, int, bool>, Index> faces;
  for (int b = 0; b < topology.blocks.size(); ++b) {
    out.blocks.push_back(node_of(mesh, topology, b));
    std::set<std::string> patches;
    for (int axis = 0; axis < 3; ++axis)
      for (int const side : {0, 1})
        for (int const entity : topology.blocks.face_entities(lattice, {b, axis, side})) {
          int const c = lattice.class_of(entity);
          auto const sides = lattice.face_sides(c);
          if (sides.size() != 2) {
            if (int const p = topology.blocks.patch_of_face()[c]; p >= 0)
              patches.insert(mesh.patches[p].families.empty() ? mesh.patches[p].name
                                                              : mesh.patches[p].families.front());
            continue;
          }
          int const one = topology.blocks.block_of(sides[0].piece), two = topology.blocks.block_of(sides[1].piece);
          int const i = topology.blocks.interface_of_face()[c];
          bool const periodic = i >= 0 && mesh.interfaces[i].periodic.has_value();
          if (topology.blocks.face_of(sides[0]) != BlockFace{b, axis, side})
            continue;  // it comes from its other side too
          faces[{std::min(one, two), std::max(one, two), periodic}] += cell_faces_of(closed_nodes(lattice, entity));
        }
    out.blocks.back().patches.assign(patches.begin(), patches.end());
  }
  for (auto const& [ends, n] : faces)
    out.interfaces.push_back({std::get<0>(ends), std::get<1>(ends), std::get<2>(ends), n});
  auto const names = stages_of(prepared.plan());
  for (std::size_t s = 0; s < prepared.plan().stages.size(); ++s) {
    Stage const& stage = prepared.plan().stages[s];
    if (stage.paths.empty()) continue;  // poles
    out.stages.push_back(names[s + 1].name);
    for (std::size_t n = 0; n < stage.paths.size(); ++n) {
      for (int const b : stage.paths[n].blocks) out.blocks[b].chain = int(out.chains.size());
      out.chains.push_back({int(out.stages.size()) - 1, int(n) + 1, stage.paths[n].blocks, stage.paths[n].ends,
                            n < stage.description.size() ? stage.description[n] : std::string()});
    }
  }
  return out;
}

}  // namespace gridmorph
