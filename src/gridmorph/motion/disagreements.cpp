#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/disagreements.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

constexpr double flat = 1e-6;   // deviation of a plane, of the mesh size
constexpr double round = 1e-3;  // deviation of a surface of revolution, of its largest radius

bool is_plane(std::vector<Vec3> const& points, double size) {
  if (points.empty()) return true;
  PlaneFit const plane = fit_plane(points);
  return !plane.determined || plane.deviation <= flat * size;
}

bool is_of_revolution(std::vector<std::vector<Vec3>> const& patches, Axis const& axis) {
  CylindricalFrame const frame(axis);
  std::vector<std::pair<double, double>> profile;
  double largest = 0;
  for (auto const& points : patches)
    for (Vec3 const& p : points) {
      auto const m = frame.meridional(p);
      profile.emplace_back(m.axial, m.radius);
      largest = std::max(largest, m.radius);
    }
  try {
    return largest > 0 && TurnedProfile::from_points(profile).profile.deviation <= round * largest;
  } catch (Error const&) {
    return false;
  }
}

/// The rule that lets the nodes of a surface slide on it.
std::string sliding_rule(Boundary const& boundary, Axis const& axis, std::vector<std::vector<Vec3>> const& patches) {
  double const size = boundary.size();
  if (std::all_of(patches.begin(), patches.end(), [&](auto const& points) { return is_plane(points, size); }))
    return R"(rule = "slip", surface = "plane")";
  if (boundary.dimension() == 2) return R"(rule = "fixed", rank = 1)";
  return is_of_revolution(patches, axis) ? R"(rule = "slip", surface = "revolution")"
                                         : R"(rule = "slip", surface = "baseline")";
}

}  // namespace

void Disagreements::add(Index node, Disagreeing const& first, Disagreeing const& second) {
  double const gap = distance(first.displacement, second.displacement);
  bool const in_order = first.name <= second.name;
  Found& found = found_[{in_order ? first.name : second.name, in_order ? second.name : first.name}];
  Index const count = found.count + 1;
  if (found.count == 0 || gap > found.gap) found = {first, second, gap, node, count};
  found.count = count;
}

std::vector<Disagreements::Pair const*> Disagreements::largest() const {
  std::vector<Pair const*> out;
  for (auto const& pair : found_) out.push_back(&pair);
  std::stable_sort(out.begin(), out.end(),
                   [](Pair const* a, Pair const* b) { return a->second.count > b->second.count; });
  if (out.size() > most) out.resize(most);
  return out;
}

std::string Disagreements::statement(Boundary const& boundary, Pair const& pair) {
  Found const& f = pair.second;
  return "patches " + f.first.name + " and " + f.second.name + " disagree on " + std::to_string(f.count) +
         " common nodes, most at " + boundary.describe_node(f.node) + ": " + to_text(f.first.displacement, 6) +
         " from " + f.first.where + ", " + to_text(f.second.displacement, 6) + " from " + f.second.where +
         ", apart by " + to_text(f.gap, 6);
}

std::string Disagreements::missing_rule(Boundary const& boundary, Axis const& axis, std::string const& name,
                                        std::vector<std::vector<Vec3>> const& patches) {
  return "no rule names " + name + ", so it stays where it is: add one, [[motion]] with patches = [\"" +
         name.substr(1, name.find('\'', 1) - 1) + "\"], " + sliding_rule(boundary, axis, patches);
}

}  // namespace gridmorph
