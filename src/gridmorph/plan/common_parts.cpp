#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/plan/common_parts.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace gridmorph {
namespace {

std::vector<std::vector<int>> parts_of_zones(Mesh const& mesh, Links const& links) {
  DisjointSets<int> sets(mesh.zones.size());
  for (Link const& link : links.all) sets.join(link.zone, link.donor_zone);
  std::vector<int> const number = sets.set_numbers();
  std::vector<std::vector<int>> out;
  for (int z = 0; z < int(number.size()); ++z) {
    out.resize(std::max(out.size(), std::size_t(number[z]) + 1));
    out[number[z]].push_back(z);
  }
  return out;
}

/// A part and its tables in a plan of the mesh, or of some of its lines.
class PartBuilder {
 public:
  PartBuilder(Mesh const& mesh, std::vector<int> const& zones) : mesh_(mesh), has_(mesh.zones.size(), 0) {
    out_.zones = zones;
    for (int const z : zones) has_[z] = 1;
  }

  [[nodiscard]] bool has_zone(int zone) const { return has_[zone] != 0; }
  [[nodiscard]] bool has_node(Index node) const { return has_zone(mesh_.zone_of(node)); }

  void list(Plan const& plan) {
    for (std::size_t k = 0; k < plan.boundary_nodes.size(); ++k)
      if (has_node(plan.boundary_nodes[k])) out_.boundary.push_back(std::int32_t(k));
    // Copies of a slot come with that of its owner first.
    std::vector<char> seen(plan.n_slots, 0);
    for (kernels::NodeCopy const& copy : plan.skeleton_nodes) {
      if (!has_node(copy.destination)) continue;
      for (Index q = 0; q < copy.n_q; ++q)
        for (Index p = 0; p < copy.n_p; ++p) {
          Index const slot = copy.source + p * copy.source_stride_p + q * copy.source_stride_q;
          if (std::exchange(seen[slot], 1) != 0) continue;
          out_.slots.push_back(std::int32_t(slot));
          out_.position.push_back(
              mesh_.coordinates[copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q]);
        }
    }
  }
  /// The values that belong to the boundary nodes of the part, in their order.
  template <class T>
  [[nodiscard]] std::vector<T> listed(std::span<T const> of_boundary) const {
    std::vector<T> out;
    for (std::int32_t const k : out_.boundary) out.push_back(of_boundary[k]);
    return out;
  }
  [[nodiscard]] std::vector<Vec3> positions(Plan const& plan) const {
    std::vector<Vec3> out;
    for (std::int32_t const k : out_.boundary) out.push_back(mesh_.coordinates[plan.boundary_nodes[k]]);
    return out;
  }

  void add_to(Plan& plan, CommonMotion motion, std::optional<kernels::CommonMap> map) && {
    for (kernels::VolumeBox& box : plan.boxes)
      if (has_node(box.first)) box.common = std::int32_t(plan.common.size());
    out_.motion = std::move(motion);
    out_.map = map;
    plan.common.push_back(std::move(out_));
  }

 private:
  Mesh const& mesh_;
  std::vector<char> has_;
  CommonPart out_;
};

/// Calls add(node of the mesh, area) for every corner of the cells of a patch; of lines their length.
template <class Add>
void each_share_of_area(Boundary const& boundary, int patch, Add const& add) {
  BoundarySurface const& surface = boundary.surface(patch);
  if (!surface.grid) return;
  int const n_a = (*surface.grid)[0], n_b = (*surface.grid)[1];
  auto const node = [&](int a, int b) { return surface.nodes[std::size_t(a) + std::size_t(n_a) * std::size_t(b)]; };
  auto const at = [&](int a, int b) { return boundary.coordinates()[node(a, b)]; };
  int const up_a = n_a > 1 ? 1 : 0, up_b = n_b > 1 ? 1 : 0;
  for (int b = 0; b + up_b < n_b; ++b)
    for (int a = 0; a + up_a < n_a; ++a) {
      Vec3 const one = at(a + up_a, b + up_b) - at(a, b), other = at(a, b + up_b) - at(a + up_a, b);
      double const size = up_a + up_b < 2 ? norm(one) : 0.5 * norm(cross(one, other));
      for (int const j : {b, b + up_b})
        for (int const i : {a, a + up_a}) add(node(i, j), 0.25 * size);
    }
}

/// Shares of the boundary nodes in the area of what rules move; the mean for those of none, as on periodic sides.
std::vector<double> areas(PreparedMorph const& prepared, PlannedMorph const& planned) {
  BoundaryMotion const& surface = prepared.surface;
  std::vector<std::int32_t> number(prepared.mesh.n_nodes(), -1);
  for (auto const& r : planned.boundary.requests) number[r.node] = std::int32_t(r.boundary_node);
  std::vector<double> out(planned.plan.boundary_nodes.size(), 0);
  for (int p = 0; p < int(prepared.mesh.patches.size()); ++p) {
    int const rule = surface.motion().patch[p].rule;
    if (rule < 0 || !surface.is_explicit(rule)) continue;
    each_share_of_area(surface.boundary(), p, [&](Index node, double area) {
      if (std::int32_t const k = number[node]; k >= 0) out[k] += area;
    });
  }
  double sum = 0;
  Index count = 0;
  for (double const a : out) {
    sum += a;
    if (a > 0) ++count;
  }
  for (double& a : out)
    if (!(a > 0)) a = count > 0 ? sum / double(count) : 1;
  return out;
}

/// What the motion of a part leaves as it is; nothing where its nodes slide on what no affine motion leaves so.
std::optional<CommonLimits> limits_of(PreparedMorph const& prepared, PartBuilder const& part) {
  CommonLimits out;
  for (int p = 0; p < int(prepared.mesh.patches.size()); ++p) {
    if (!part.has_zone(prepared.mesh.patches[p].zone)) continue;
    SlipSurface const* const surface = prepared.surface.slip_surface(p);
    if (surface == nullptr) continue;
    if (surface->kind == SlipKind::axial || surface->kind == SlipKind::facets) return {};
    if (surface->kind == SlipKind::plane)
      out.planes.push_back({surface->origin, surface->direction});
    else
      out.axes.push_back({surface->origin, surface->direction});
  }
  for (Link const& link : prepared.links.all)
    if (link.periodic && part.has_zone(link.zone)) out.copies.push_back(link.transform);
  return out;
}

/// How the boundary nodes of a part come to move.
struct Asking {
  std::set<int> rules;
  bool fixed = false, prescribed = false;

  Asking(PreparedMorph const& prepared, PartBuilder const& part) {
    auto const& all = prepared.surface.motion().rules;
    for (auto const& r : prepared.planned.boundary.requests)
      if (part.has_node(r.node)) rules.insert(r.rule);
    for (int const r : rules) {
      fixed = fixed || std::holds_alternative<FixedRule>(all[r].rule);
      prescribed = prescribed || std::holds_alternative<PrescribedRule>(all[r].rule);
    }
  }
};

bool any_moves(std::vector<Vec3> const& u) {
  return std::any_of(u.begin(), u.end(), [](Vec3 const& v) { return norm(v) > 0; });
}

std::string note_on(Mesh const& mesh, std::vector<int> const& zones) {
  std::vector<std::string> names;
  for (int const z : zones) names.push_back(mesh.zones[z].name);
  constexpr std::size_t most = 4;
  return "what all boundaries of " + quote_list(names, most) +
         " have in common, an affine motion, is taken off before the first stage and added to all nodes after the last";
}

CommonMotion motion_of(PartBuilder const& part, Plan const& plan, std::vector<double> const& area,
                       CommonLimits const& limits) {
  return common_motion(part.positions(plan), part.listed<double>(area), limits);
}

}  // namespace

void split_common_motions(PreparedMorph& prepared,
                          std::function<std::optional<std::vector<Vec3>>()> const& displacement) {
  Plan& plan = prepared.planned.plan;
  std::optional<std::vector<Vec3>> all;
  std::vector<double> area;
  bool asked = false;
  for (auto const& zones : parts_of_zones(prepared.mesh, prepared.links)) {
    PartBuilder part(prepared.mesh, zones);
    Asking const asking(prepared, part);
    if (asking.rules.empty() || asking.fixed) continue;
    auto const limits = limits_of(prepared, part);
    if (!limits) continue;
    if (!std::exchange(asked, true)) {
      all = displacement();
      area = areas(prepared, prepared.planned);
    }
    part.list(plan);
    bool const is_known = all && any_moves(*all) && !asking.prescribed;
    if (!is_known && asking.rules.size() > 1) continue;
    CommonMotion motion = motion_of(part, plan, area, *limits);
    if (is_known && !motion.is_common(part.listed<Vec3>(*all))) continue;
    std::move(part).add_to(plan, std::move(motion), {});
    plan.notes.push_back(note_on(prepared.mesh, zones));
  }
}

void carry_common_motions(PreparedMorph const& from, PlannedMorph& to) {
  if (from.plan().common.empty()) return;
  auto const area = areas(from, to);
  for (CommonPart const& same : from.plan().common) {
    PartBuilder part(from.mesh, same.zones);
    part.list(to.plan);
    CommonMotion motion = motion_of(part, to.plan, area, *limits_of(from, part));
    std::move(part).add_to(to.plan, std::move(motion), same.map);
    to.plan.notes.push_back(note_on(from.mesh, same.zones));
  }
}

void carry_common_motions(PreparedMorph const& from, std::span<Vec3 const> boundary, Mesh const& mesh, Plan& to) {
  for (CommonPart const& same : from.plan().common) {
    std::vector<Vec3> given;
    for (std::int32_t const k : same.boundary) given.push_back(boundary[k]);
    PartBuilder part(mesh, same.zones);
    part.list(to);
    CommonMotion motion = same.motion;
    motion.position = part.positions(to);
    motion.weight.assign(motion.position.size(), 0);
    std::move(part).add_to(to, std::move(motion), same.motion.fit(given));
  }
}

}  // namespace gridmorph
