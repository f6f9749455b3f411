#include <gridmorph/run/clearances.hpp>

#include <gridmorph/boundary/periodic_copies.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/point_numbers.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

std::vector<Vec3> places_of_nodes(Coordinates const& x, std::vector<Index> const& nodes) {
  std::vector<Vec3> at;
  for (Index const n : nodes) at.push_back(x[n]);
  return at;
}

/// Those of the nodes that are at one of the places.
std::vector<Index> at_places(Coordinates const& x, std::vector<Index> const& nodes, std::vector<Vec3> const& places,
                             double tolerance) {
  PointNumbers known(tolerance);
  for (Vec3 const& p : places) known.add(p, 0);
  std::vector<Index> out;
  for (Index const n : nodes)
    if (known.find(x[n]) >= 0) out.push_back(n);
  return out;
}

/// Per patch the number of the rule that names it, or -1.
std::vector<int> rules_of_patches(Boundary const& boundary, std::vector<MotionRule> const& rules) {
  std::vector<int> out(boundary.patches().size(), -1);
  for (std::size_t r = 0; r < rules.size(); ++r)
    for (std::string const& selector : rules[r].patches)
      for (int const p : boundary.select(selector).patches) out[p] = int(r);
  return out;
}

}  // namespace

Clearances::Clearances(CaseFile const& case_file, Boundary boundary)
    : case_file_(case_file), boundary_(std::move(boundary)) {
  auto const rule_of_patch = rules_of_patches(boundary_, case_file_.motion.rules);
  for (ClearanceCase const& one : case_file_.clearances) tips_.push_back(tip(one, rule_of_patch));
}

std::vector<Index> Clearances::nodes_of(std::vector<int> const& patches) const {
  std::vector<Index> out;
  for (int const p : patches) {
    auto const& nodes = boundary_.surface(p).nodes;
    out.insert(out.end(), nodes.begin(), nodes.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Clearances::Tip Clearances::tip(ClearanceCase const& one, std::vector<int> const& rule_of_patch) const {
  auto const walls = boundary_.select_patches(one.walls);
  auto const tips = boundary_.select_patches(one.tips);
  Tip out;
  out.name = one.name;
  out.wall = nodes_of(walls);
  auto const blade = nodes_of(tips);
  auto const blade_places = places_of_nodes(baseline(), blade);
  for (PatchesOfRow& row : patches_by_row(boundary_, walls))
    out.rows.push_back({InwardFacets(boundary_, row.patches), std::move(row.copies),
                        at_places(baseline(), nodes_of(row.patches), blade_places,
                                  place_tolerance(1e-7, boundary_.size(), boundary_.precision().resolution()))});
  // Nodes slide on a wall that slips, and those of a blade may be off it: the wall itself stays.
  out.wall_moves = std::any_of(walls.begin(), walls.end(), [&](int p) {
    int const r = rule_of_patch[p];
    return r >= 0 && (case_file_.timed[r].at || std::holds_alternative<AttachedRule>(case_file_.motion.rules[r].rule) ||
                      std::holds_alternative<CarryRule>(case_file_.motion.rules[r].rule));
  });
  out.before = revolution(out, baseline());
  if (!out.before) {
    out.before = surface(out, baseline());
  } else if (out.wall_moves) {
    out.before_as_surface = surface(out, baseline());
  }
  int const r = rule_of_patch[tips.front()];
  bool const one_rule = std::all_of(tips.begin(), tips.end(), [&](int p) { return rule_of_patch[p] == r; });
  out.rule = one_rule ? r : -1;
  if (out.before->measure() == ClearanceMeasure::meridional) {
    double sum = 0;
    for (Vec3 const& node : blade_places) sum += out.before->distance(node);
    if (sum < 0) out.side = -1;
  }
  for (std::size_t const n : tip_nodes(*out.before, blade_places, one.rim)) out.nodes.push_back(blade[n]);
  return out;
}

Clearances::Wall Clearances::revolution(Tip const& tip, Coordinates const& x) const {
  return case_file_.axis ? RevolutionWall::through(*case_file_.axis, places_of_nodes(x, tip.wall)) : nullptr;
}

Clearances::Wall Clearances::surface(Tip const& tip, Coordinates const& x) {
  FacetList all;
  std::vector<Vec3> standing;
  for (WallOfRow const& row : tip.rows) {
    all.add(with_copies(row.facets.at(x), row.copies));
    FacetList const stands = with_copies({places_of_nodes(x, row.standing), {}}, row.copies);
    standing.insert(standing.end(), stands.points.begin(), stands.points.end());
  }
  try {
    return std::make_shared<SurfaceWall const>(all, standing);
  } catch (MotionError const& e) {
    throw MotionError("clearance '" + tip.name + "': the wall: " + e.what());
  }
}

TipClearance Clearances::of(std::size_t t, Coordinates const& morphed, ByRule const& by_rule) const {
  Tip const& tip = tips_[t];
  Wall before = tip.before, after = before;
  if (tip.wall_moves) {
    after = before->measure() == ClearanceMeasure::meridional ? revolution(tip, morphed) : nullptr;
    if (!after) {  // both by one measure
      after = surface(tip, morphed);
      if (tip.before_as_surface) before = tip.before_as_surface;
    }
  }
  double const side = after->measure() == ClearanceMeasure::meridional ? tip.side : 1;
  auto at = places_of_nodes(baseline(), tip.nodes);
  TipClearance found{tip.name,
                     tip.nodes.size(),
                     before->of(at, side),
                     {},
                     after->of(places_of_nodes(morphed, tip.nodes), side),
                     std::max(before->scatter(), after->scatter()),
                     after->measure()};
  std::vector<Vec3> u(at.size());
  if (!by_rule(tip.nodes, u)) return found;
  for (std::size_t n = 0; n < at.size(); ++n) at[n] += u[n];
  found.by_rule = after->of(at, side);
  return found;
}

}  // namespace gridmorph::cli
