// What rules did to the nodes of their patches.
#include <gridmorph/run/run_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::cli {

namespace {

std::string label_of(Patch const& patch) { return patch.families.empty() ? patch.name : patch.families.front(); }

std::string listed_names(std::vector<std::string> names) {
  constexpr std::size_t most = 12;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string out;
  for (std::size_t n = 0; n < names.size() && n < most; ++n) out += (n == 0 ? "" : ", ") + names[n];
  return names.size() > most ? out + fmt::format(" and {} more", names.size() - most) : out;
}

std::string text_of_rule(Rule const& rule) {
  if (auto const* function = std::get_if<FunctionRule>(&rule)) {
    constexpr std::size_t most = 120;  // the case file is on the page whole
    std::string const& text = function->description;
    return text.size() <= most ? text : text.substr(0, text.rfind(' ', most)) + " \u2026";
  }
  std::string const name(rule_name(rule));
  if (auto const* inflate = std::get_if<InflateRule>(&rule)) return name + " " + inflate->description;
  auto const* slip = std::get_if<SlipRule>(&rule);
  if (slip == nullptr) return name;
  return name + (slip->surface == SlipRule::Surface::plane        ? " on a plane"
                 : slip->surface == SlipRule::Surface::revolution ? " on a surface of revolution"
                                                                  : " on the baseline surface");
}

page::RuleRow row_of(std::vector<Index> nodes, Coordinates const& baseline, Coordinates const& morphed) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  page::RuleRow row;
  row.nodes = Index(nodes.size());
  for (Index const n : nodes) {
    double const u = norm(morphed[n] - baseline[n]);
    row.largest = std::max(row.largest, u);
    row.mean += u / double(nodes.size());
  }
  return row;
}

/// How far a point is from where its slip surface has it.
double distance_from(kernels::SlipSurfaceView const& surface, Vec3 const& baseline, Vec3 const& morphed) {
  if (surface.kind == SlipKind::axial) return std::fabs(dot(morphed - baseline, surface.direction));
  auto const off = [&](Vec3 const& p) { return norm(p - surface.project(p)); };
  return std::fabs(off(morphed) - off(baseline));
}

}  // namespace

PatchRoles roles_of(BoundaryMotion const& rules, std::size_t n_patches) {
  PatchRoles out{std::vector<signed char>(n_patches, -1)};
  ResolvedMotion const& motion = rules.motion();
  for (std::size_t p = 0; p < n_patches && p < motion.patch.size(); ++p) {
    PatchKind const kind = rules.boundary().patches()[p].kind;
    bool const body = kind == PatchKind::wall || kind == PatchKind::other;
    int const r = motion.patch[p].rule;
    bool const moves = r >= 0 && rules.is_explicit(r) && !std::holds_alternative<FixedRule>(motion.rules[r].rule);
    if (body && moves)
      out.wall[p] = 1;
    else if (kind == PatchKind::wall)
      out.wall[p] = 0;
  }
  return out;
}

std::vector<page::RuleRow> rule_rows(BoundaryMotion const& rules, Coordinates const& baseline,
                                     Coordinates const& morphed) {
  ResolvedMotion const& motion = rules.motion();
  Boundary const& boundary = rules.boundary();
  std::vector<page::RuleRow> out;
  std::vector<AnyConnection> const connections = boundary.connections();
  // Rules in order, then periodic connections that no rule has.
  for (int r = 0; r <= int(motion.rules.size()); ++r) {
    bool const none = r == int(motion.rules.size());
    std::vector<std::string> names;
    std::vector<Index> nodes;
    bool by_default = none;
    for (int p = 0; p < int(motion.patch.size()) && !none; ++p) {
      if (motion.patch[p].rule != r) continue;
      by_default = motion.patch[p].by_default;
      names.push_back(label_of(boundary.patches()[p]));
      auto const& of = boundary.surface(p).nodes;
      nodes.insert(nodes.end(), of.begin(), of.end());
    }
    for (std::size_t c = 0; c < connections.size() && c < motion.interface.size(); ++c) {
      if (motion.interface[c].rule != (none ? -1 : r) || !connections[c].periodic) continue;
      names.push_back(connections[c].name);
      for (auto const& [own, donor] : boundary.pairs(int(c))) nodes.insert(nodes.end(), {own, donor});
    }
    if (names.empty()) continue;
    page::RuleRow row = row_of(std::move(nodes), baseline, morphed);
    row.rule = none ? "free, both sides as one" : text_of_rule(motion.rules[r].rule);
    row.patches = listed_names(std::move(names));
    row.where = by_default ? "default" : motion.rules[r].where;
    out.push_back(std::move(row));
  }
  return out;
}

page::BoundaryCheck boundary_check(BoundaryMotion const& rules, Coordinates const& baseline,
                                   Coordinates const& morphed) {
  page::BoundaryCheck out;
  Boundary const& boundary = rules.boundary();
  auto const u = [&](Index n) { return morphed[n] - baseline[n]; };
  for (AnyConnection const& c : boundary.connections()) {
    if (!c.periodic) continue;
    Mat3 const rotation = boundary.transform(c.number).rotation;
    for (auto const& [own, donor] : boundary.pairs(c.number)) {
      ++out.periodic_nodes;
      out.periodic = std::max(out.periodic, norm(rotation * u(own) - u(donor)));
    }
  }
  for (int p = 0; p < int(boundary.patches().size()); ++p)
    rules.each_slip_surface(p, [&](int s, std::vector<Index> const& nodes) {
      auto const view = rules.slip_surfaces()[s].view();
      for (Index const n : nodes) {
        ++out.slip_nodes;
        if (norm(u(n)) > 0) out.slip = std::max(out.slip, distance_from(view, baseline[n], morphed[n]));
      }
    });
  return out;
}

}  // namespace gridmorph::cli
