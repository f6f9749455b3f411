#include <gridmorph/boundary/links.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/found_blocks.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/run/elements_as_blocks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph::cli {

namespace {

/// Of the faces inside the mesh at most this share may be limits of blocks. A box of 4 x 4 x 1 cells among others has
/// a quarter of its faces there; in meshes of multi-block generators it is some hundredths.
constexpr double most_limits = 0.25;

bool has_long_lines(Mesh const& blocks) {
  Index inside = 0, limits = 0;
  for (Zone const& zone : blocks.zones)
    for (std::size_t a = 0; a < 3; ++a)
      inside += Index(zone.extent[a] - 2) * (zone.extent[(a + 1) % 3] - 1) * (zone.extent[(a + 2) % 3] - 1);
  for (Interface1to1 const& interface : blocks.interfaces) {
    if (interface.periodic) continue;
    Index faces = 1;
    for (int a = 0; a < 3; ++a) faces *= std::max(1, interface.range.extent(a) - 1);
    limits += faces;
  }
  return double(limits) <= most_limits * double(inside + limits);
}

/// A patch that the blocks do not have, as its faces, or some of them, lie inside the mesh; -1: none.
int inner_patch(IndexedMesh const& elements) {
  auto const& patches = elements.mesh().patches;
  auto const& found = elements.face_patches().faces_of_patch;
  for (std::size_t p = 0; p < patches.size(); ++p)
    if (found[p] < std::max<Index>(patches[p].faces.size(), patches[p].nodes.empty() ? 0 : 1)) return int(p);
  return -1;
}

}  // namespace

bool may_have_blocks(Mesh const& elements) {
  auto const& [type, nodes, number] = elements.elements;
  ElementType const wanted = elements.dimension == 2 ? ElementType::quadrilateral : ElementType::hexahedron;
  return !elements.is_structured() && !type.empty() &&
         nodes.item.size() == type.size() * std::size_t(n_corners(wanted)) &&
         std::all_of(type.begin(), type.end(), [&](ElementType t) { return t == wanted; });
}

ElementsAsBlocks::ElementsAsBlocks(IndexedMesh&& elements, Lines lines) {
  Mesh const& mesh = elements.mesh();
  if (int const inner = inner_patch(elements); inner >= 0) {
    why_none_ = fmt::format("{}: patch '{}' has faces inside the mesh", mesh.source, mesh.patches[inner].name);
    return;
  }
  FoundBlocks found = find_blocks(HostInstance(), mesh, elements.topology(), elements.face_patches());
  if (found.n_left > 0) {
    why_none_ = fmt::format("{}: {} of {} elements lie in no block of grid lines; the first: {}", mesh.source,
                            found.n_left, mesh.n_elements(), found.why_left);
    return;
  }
  // Connections pair nodes that lie within 1e-6 of the mesh size; what blocks ask of theirs is a hundredth of that.
  Problems apart;
  (void)connect(found.mesh, {}, apart);
  if (!apart.empty()) {
    why_none_ = mesh.source + ": periodic sides lie farther apart than those of blocks may, 1e-8 of the mesh size";
    return;
  }
  if (lines == Lines::long_ones && !has_long_lines(found.mesh)) {
    why_none_ = mesh.source + ": limits of blocks run through nearly every row of cells";
    return;
  }
  blocks_ = std::move(found.mesh);
  blocks_.notes.push_back(fmt::format("{}: {} block{} found in {} {} (`gridmorph blocks` writes them)", mesh.source,
                                      blocks_.zones.size(), blocks_.zones.size() == 1 ? "" : "s", mesh.n_elements(),
                                      mesh.dimension == 2 ? "quadrilaterals" : "hexahedra"));
  element_ = std::move(found.element);
  Index first_cell = 0;
  for (Zone const& block : blocks_.zones) {
    zone_of_block_.push_back(mesh.zone_of_element(element_[first_cell]));
    first_cell += Index(block.extent[0] - 1) * (block.extent[1] - 1) * (block.extent[2] - 1);
  }
  block_node_ = std::move(found.in_blocks);
  node_ = std::move(found.node);
  if (mesh.dimension == 2) {
    Vec3 const up = plane_normal(mesh);
    across_ = std::fabs(up.x) > 0.5 ? 0 : std::fabs(up.y) > 0.5 ? 1 : 2;
  }
  elements_ = std::move(elements).take_mesh();
}

Coordinates ElementsAsBlocks::coordinates(Coordinates const& of_blocks) const {
  Coordinates const& x = elements_.coordinates;
  Coordinates out(x.size());
  for (Index n = 0; n < x.size(); ++n) {
    Index32 const b = block_node_[n], r = b < 0 ? Index32(n) : node_[b];
    // Nodes that are one may be apart by a rounding: they move alike.
    Vec3 moved = b < 0 ? x[n] : r == n ? of_blocks[b] : x[n] + (of_blocks[b] - x[r]);
    if (across_ == 0) moved.x = x[n].x;
    if (across_ == 1) moved.y = x[n].y;
    if (across_ == 2) moved.z = x[n].z;
    out.set(n, moved);
  }
  return out;
}

OutputFields ElementsAsBlocks::fields(OutputFields const& of_blocks) const {
  OutputFields out;
  out.displacement = of_blocks.displacement;
  for (CellField const& field : of_blocks.cells) {
    CellField& own = out.cells.emplace_back(field);
    for (std::size_t c = 0; c < element_.size(); ++c) own.values[element_[c]] = field.values[c];
  }
  for (NodeField const& field : of_blocks.nodes) {
    NodeField& own = out.nodes.emplace_back(field);
    own.values.assign(block_node_.size(), 0);
    for (std::size_t n = 0; n < block_node_.size(); ++n)
      if (block_node_[n] >= 0) own.values[n] = field.values[block_node_[n]];
  }
  return out;
}

}  // namespace gridmorph::cli
