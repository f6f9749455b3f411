#include <gridmorph/plan/conflict.hpp>
#include <gridmorph/plan/spread_plan.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace gridmorph {
namespace {

bool same_surface(SlipSurface const& a, SlipSurface const& b) {
  return a.kind == b.kind && a.origin == b.origin && a.direction == b.direction && a.profile.axial == b.profile.axial &&
         a.profile.radius == b.profile.radius;
}

/// Number of each patch's slip surface in `surfaces`, -1 for patches that do not slip.
std::vector<int> surface_numbers(Mesh const& mesh, SurfaceMotion const& surface, std::vector<SlipSurface>& surfaces) {
  std::vector<int> number(mesh.patches.size(), -1);
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    std::optional<SlipSurface> const s = surface.slip_surface(p);
    if (!s) continue;
    auto const it = std::find_if(surfaces.begin(), surfaces.end(), [&](auto const& o) { return same_surface(o, *s); });
    number[p] = int(it - surfaces.begin());
    if (it == surfaces.end()) surfaces.push_back(*s);
  }
  return number;
}

}  // namespace

void plan_spreads(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion,
                  SurfaceMotion const& surface, Known const& given, RotationTable& rotations, Plan& plan) {
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  std::vector<int> const surface_of_patch = surface_numbers(mesh, surface, plan.surfaces);
  if (plan.surfaces.empty()) return;

  // One chain per slip block face, the first found wins when both ends slip.
  Known const nothing(lattice.n_classes());
  std::vector<std::pair<std::array<int, 2>, Chain>> chains;  // (rules of the ends, chain)
  std::set<std::pair<int, int>> seen;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = blocks.patch_of_face()[c];
    if (patch < 0 || surface_of_patch[patch] < 0) continue;
    FaceSide const side = lattice.face_sides(c).front();
    int const block = blocks.block_of(side.piece);
    int const axis = blocks.to_block(side.piece).axis[side.axis];
    if (seen.contains({block, axis})) continue;
    std::optional<Chain> chain = find_chain(mesh, topology, nothing, block, axis);
    if (!chain) continue;
    for (ChainStep const& step : chain->steps) seen.insert({step.block, step.to_chain.inverse().axis[0]});
    auto rule_of = [&](ChainEnd const& end) {
      return end.patch >= 0 && surface_of_patch[end.patch] >= 0 ? motion.patch[end.patch].rule
                                                               : std::numeric_limits<int>::max();
    };
    int const first = rule_of(chain->first), last = rule_of(chain->last);
    chains.push_back({{std::min(first, last), std::max(first, last)}, std::move(*chain)});
  }
  std::stable_sort(chains.begin(), chains.end(), [](auto const& a, auto const& b) { return a.first < b.first; });

  while (!chains.empty()) {
    Claims claims(topology, nothing);
    std::vector<Chain> now;
    std::vector<std::pair<std::array<int, 2>, Chain>> later;
    for (auto& entry : chains)
      if (claims.add(entry.second)) {
        now.push_back(std::move(entry.second));
      } else {
        later.push_back(std::move(entry));
      }
    SpreadPass pass = build_spread(mesh, topology, now, surface_of_patch, given, plan.mesh_size, rotations);
    std::map<std::pair<std::string, std::string>, int> ends;
    for (Chain const& chain : now) {
      auto name = [&](ChainEnd const& end) {
        if (end.patch < 0) return std::string("inner face");
        Patch const& p = mesh.patches[end.patch];
        return p.families.empty() ? p.name : p.families.front();
      };
      ++ends[{name(chain.first), name(chain.last)}];
    }
    for (auto const& [who, count] : ends)
      pass.description.push_back(std::to_string(count) + " chains from " + who.first + " to " + who.second);
    plan.spreads.push_back(std::move(pass));
    chains = std::move(later);
  }
}

}  // namespace gridmorph
