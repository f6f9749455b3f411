#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/blocks/line_walk.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace gridmorph {
namespace {

/// Cells from a wall node along its grid line until the arc length reaches `thickness`; runs through interfaces.
int layers_to(Mesh const& mesh, Links const& links, LinePlace place, double thickness) {
  double length = 0;
  int layers = 0;
  Index const limit = mesh.n_nodes();
  while (length < thickness && layers < limit && advance(mesh, links, place, length)) ++layers;
  return layers;
}

int median_layers(Mesh const& mesh, Links const& links, std::vector<int> const& walls, double thickness) {
  std::vector<int> counts;
  for (int p : walls) {
    Patch const& patch = mesh.patches[p];
    int const axis = normal_axis(patch.range);
    int const step = patch.range.begin[axis] == 0 ? 1 : -1;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
          counts.push_back(layers_to(mesh, links, {patch.zone, {i, j, k}, axis, step}, thickness));
  }
  std::nth_element(counts.begin(), counts.begin() + counts.size() / 2, counts.end());
  return std::max(1, counts[counts.size() / 2]);
}

/// The patch of the face that a chain ends on, -1 inside the domain.
int patch_at_end(Topology const& topology, Chain const& chain) {
  auto const faces = topology.blocks.face_entities(topology.lattice, end_face(chain.steps.back(), 1));
  return topology.blocks.patch_of_face()[topology.lattice.class_of(faces.front())];
}

bool is_region(Mesh const& mesh, int patch) { return patch >= 0 && mesh.patches[patch].kind == PatchKind::region; }

/// Whether a chain ends on a periodic interface: what lies beyond is a copy, whose motion rules may give.
bool ends_periodic(Mesh const& mesh, Topology const& topology, Chain const& chain) {
  auto const faces = topology.blocks.face_entities(topology.lattice, end_face(chain.steps.back(), 1));
  int const interface = topology.blocks.interface_of_face()[topology.lattice.class_of(faces.front())];
  return interface >= 0 && mesh.interfaces[interface].periodic;
}

/// The walls that move: every patch that ranks as a wall and that an explicit rule other than `fixed` moves.
std::vector<int> moving_walls(BoundaryMotion const& surface, std::vector<PatchKind> const& kinds) {
  ResolvedMotion const& motion = surface.motion();
  std::vector<int> walls;
  for (int p = 0; p < int(kinds.size()); ++p) {
    int const rule = motion.patch[p].rule;
    if (kinds[p] == PatchKind::wall && rule >= 0 && surface.is_explicit(rule) &&
        !std::holds_alternative<FixedRule>(motion.rules[rule].rule))
      walls.push_back(p);
  }
  return walls;
}

std::set<int> walls_of(std::vector<NearField> const& fields) {
  std::set<int> walls;
  for (NearField const& field : fields) walls.insert(field.walls.begin(), field.walls.end());
  return walls;
}

/// Cells of a near field where so many lie between its wall and a boundary; 0: none has room. The choice is not
/// delicate: a wing that turns keeps its angles with any from a tenth to a half.
int layers_of(int cells_to_boundary) { return cells_to_boundary < 2 ? 0 : std::max(1, cells_to_boundary / 3); }

std::string room_note(Mesh const& mesh, std::vector<NearField> const& fields, bool to_blocks,
                      std::map<int, int> const& layers) {
  std::set<std::string> names;
  for (NearField const& field : fields)
    if (field.automatic)
      for (int const p : field.walls)
        names.insert(mesh.patches[p].families.empty() ? mesh.patches[p].name : mesh.patches[p].families.front());
  std::string text;
  if (to_blocks) text = "to the next block";
  std::string counts;
  for (auto const& [all, some] : layers) {
    if (some == 0) continue;
    counts += (counts.empty() ? "" : ", ") + std::to_string(some) + " of " + std::to_string(all);
  }
  if (!counts.empty()) text += (text.empty() ? "" : ", and ") + counts + " cells where lines run on to a boundary";
  if (text.empty()) text = "nowhere, as there is no room off them";
  constexpr std::size_t most = 6;
  return "the near field of moving walls " + quote_list({names.begin(), names.end()}, most) + " reaches " + text +
         "; [boundary_layer] sets walls and extent, `boundary_layer = false` leaves it out";
}

}  // namespace

std::vector<NearField> near_fields(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                                   std::vector<PatchKind> const& kinds, std::vector<char> const& at_gap,
                                   PlanOptions const& options) {
  ResolvedMotion const& motion = surface.motion();
  std::vector<NearField> fields;
  std::vector<BoundaryLayer> layers = options.boundary_layers;
  if (layers.empty() && options.default_boundary_layer && !moving_walls(surface, kinds).empty())
    layers = {BoundaryLayer{}};
  for (BoundaryLayer const& option : layers) {
    NearField field;
    field.mode = option.mode;
    if (option.walls.empty()) {
      field.walls = moving_walls(surface, kinds);
      if (field.walls.empty())
        throw PlanError("the boundary layer names no walls and no wall patch has a moving rule; name its walls");
    } else {
      field.walls = select_patches(mesh, option.walls);
      for (int p : field.walls) {
        if (is_region(mesh, p))
          throw PlanError("boundary layer wall " + describe_patch(mesh, mesh.patches[p]) +
                          ": near fields are off walls; a larger region moves what is around this one");
        if (!surface.is_explicit(motion.patch[p].rule))
          throw PlanError("boundary layer wall " + describe_patch(mesh, mesh.patches[p]) +
                          " has no prescribed displacement (its rule is '" +
                          std::string(rule_name(motion.patch_rule(p))) + "'); near fields need walls that are moved");
      }
    }
    std::erase_if(field.walls, [&](int p) { return at_gap[p] != 0; });
    if (field.walls.empty()) continue;
    switch (option.extent) {
      case BoundaryLayer::Extent::block: break;
      case BoundaryLayer::Extent::automatic: field.automatic = true; break;
      case BoundaryLayer::Extent::layers: field.layers = std::max(1, option.layers); break;
      case BoundaryLayer::Extent::thickness:
        field.layers = median_layers(mesh, links, field.walls, option.thickness);
        break;
    }
    fields.push_back(std::move(field));
  }
  return fields;
}

std::vector<CutPlane> near_field_limits(Mesh const& mesh, Links const& links, std::vector<NearField> const& fields) {
  std::vector<CutPlane> planes;
  Problems problems;
  for (NearField const& field : fields) {
    if (field.layers == 0) continue;
    for (int p : field.walls) {
      LayerLimit const limit = layer_limit(mesh, links, mesh.patches[p].zone, mesh.patches[p].range, field.layers);
      planes.insert(planes.end(), limit.planes.begin(), limit.planes.end());
      for (std::size_t n = 0; n < limit.hit_zones.size(); ++n)
        problems.add("the near field of wall " + describe_patch(mesh, mesh.patches[p]) + ", " +
                     std::to_string(field.layers) + " cells thick, reaches the boundary at " +
                     describe_range(mesh, limit.hit_zones[n], limit.hit_patches[n]) + "; give it fewer layers");
    }
  }
  problems.throw_if_any<PlanError>();
  return planes;
}

std::vector<CutPlane> room_limits(Mesh const& mesh, Topology const& topology, std::vector<NearField> const& fields,
                                  std::vector<std::string>& notes) {
  if (std::none_of(fields.begin(), fields.end(), [](NearField const& f) { return f.automatic; })) return {};
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  Known const nothing(lattice.n_classes());
  std::set<int> const all_walls = walls_of(fields);
  std::set<int> walls;
  for (NearField const& field : fields)
    if (field.automatic) walls.insert(field.walls.begin(), field.walls.end());
  std::set<BlockFace> done;
  std::vector<CutPlane> planes;
  std::map<int, int> layers;  // of so many cells; what depends on these alone is the same for all walls that one sheet
                              // of cells lies on
  bool to_blocks = false;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    if (!walls.contains(blocks.patch_of_face()[c])) continue;
    FaceSide const off_wall = lattice.face_sides(c).front();
    BlockFace const wall = blocks.face_of(off_wall);
    if (blocks.region_of(off_wall.piece) >= 0 || !done.insert(wall).second) continue;
    // Its part in the first block.
    std::optional<Chain> const chain = walk_from(mesh, topology, nothing, wall, [](Chain const&) { return true; });
    if (!chain) continue;
    int const beyond = patch_at_end(topology, *chain);
    if (all_walls.contains(beyond)) continue;
    if (is_region(mesh, beyond) || (beyond < 0 && !ends_periodic(mesh, topology, *chain))) {
      to_blocks = true;
      continue;
    }
    int const cells = lay_out(topology, *chain).n_nodes[0] - 1;
    int const n = layers.try_emplace(cells, layers_of(cells)).first->second;
    if (n == 0) continue;
    for (int const entity : blocks.face_entities(lattice, wall)) {
      LayerLimit const limit =
          layer_limit(mesh, topology.links, lattice.zone_of(entity), closed_nodes(lattice, entity), n);
      planes.insert(planes.end(), limit.planes.begin(), limit.planes.end());
    }
  }
  notes.push_back(room_note(mesh, fields, to_blocks, layers));
  return planes;
}

std::vector<StageChain> near_field_chains(Mesh const& mesh, Topology const& topology, Known const& known,
                                          std::vector<NearField> const& fields) {
  std::vector<StageChain> chains;
  std::set<BlockFace> done;
  Blocks const& blocks = topology.blocks;
  Lattice const& lattice = topology.lattice;
  // Nothing stops a walk off the wall but the domain's boundary.
  Known const nothing(lattice.n_classes());
  std::set<int> const all_walls = walls_of(fields);
  for (NearField const& field : fields) {
    std::set<int> const walls(field.walls.begin(), field.walls.end());
    for (int c = 0; c < lattice.n_classes(); ++c) {
      int const patch = blocks.patch_of_face()[c];
      if (patch < 0 || !walls.contains(patch)) continue;
      FaceSide const off_wall = lattice.face_sides(c).front();
      BlockFace const wall = blocks.face_of(off_wall);
      if (blocks.region_of(off_wall.piece) >= 0 || !done.insert(wall).second) continue;

      int cells = 0;
      std::optional<Chain> chain = walk_from(mesh, topology, nothing, wall, [&](Chain const& so_far) {
        Chain one;
        one.steps = {so_far.steps.back()};
        cells += lay_out(topology, one).n_nodes[0] - 1;
        return cells >= field.layers || is_region(mesh, patch_at_end(topology, so_far));
      });
      int beyond = chain ? patch_at_end(topology, *chain) : -1;
      if (is_region(mesh, beyond)) beyond = -1;
      if (beyond >= 0 && field.layers == 0 && all_walls.contains(beyond)) continue;
      if (field.automatic && (!chain || beyond >= 0 || ends_periodic(mesh, topology, *chain))) continue;
      if (!chain || beyond >= 0)
        throw PlanError("the near field of wall " + describe_patch(mesh, mesh.patches[patch]) +
                        (beyond >= 0 ? " reaches patch " + describe_patch(mesh, mesh.patches[beyond])
                                     : std::string(" comes to a boundary or back to itself")) +
                        "; give its boundary layer fewer layers or a smaller thickness");
      chain->first = {true, known.kind[c], patch, known.patches[c]};
      chain->last = {};
      chains.push_back({std::move(*chain), kernels::LineLaw::constant, true,
                        turns(field) ? kernels::TurnLaw::near_field : kernels::TurnLaw::none});
    }
  }
  return chains;
}

}  // namespace gridmorph
