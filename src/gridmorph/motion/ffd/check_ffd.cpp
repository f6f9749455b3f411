#include <gridmorph/motion/ffd/check_ffd.hpp>

#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gridmorph {

namespace {

bool is_finite(Vec3 const& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool check_counts(FfdRule const& rule, std::string const& name, Problems& problems) {
  bool good = true;
  for (std::size_t a = 0; a < 3; ++a) {
    std::string const along = std::string(" along ") + "ijk"[a];
    int const count = rule.counts[a], degree = rule.degree[a];
    if (count < 1 || count > 10000) {
      problems.add(name + ": " + std::to_string(count) + " control points" + along + "; give from 1 to 10000");
      good = false;
      continue;
    }
    int const most = std::min(count - 1, FfdRule::most_degree);
    if (degree >= std::min(1, most) && degree <= most) continue;
    problems.add(name + ": degree " + std::to_string(degree) + along + "; with " + std::to_string(count) +
                 " control points it is " + (most > 1 ? "from 1 to " + std::to_string(most) : std::to_string(most)));
    good = false;
  }
  if (good && rule.size() > most_control_points) {
    problems.add(name + ": " + std::to_string(rule.size()) + " control points; a lattice has up to " +
                 std::to_string(most_control_points));
    good = false;
  }
  return good;
}

/// The name of control point n in messages: "control point (1, 2, 3)".
std::string control_point(FfdRule const& rule, std::size_t n) {
  auto const i = n % std::size_t(rule.counts[0]), rest = n / std::size_t(rule.counts[0]);
  return "control point (" + std::to_string(i + 1) + ", " + std::to_string(rest % std::size_t(rule.counts[1]) + 1) +
         ", " + std::to_string(rest / std::size_t(rule.counts[1]) + 1) + ")";
}

void check_list(FfdRule const& rule, std::vector<Vec3> const& list, std::string const& what, std::string const& name,
                Problems& problems) {
  if (list.size() != rule.size())
    problems.add(name + ": " + std::to_string(list.size()) + " " + what + "s for " + std::to_string(rule.size()) +
                 " control points; give one for each");
  else if (auto const bad = std::find_if(list.begin(), list.end(), [](Vec3 const& v) { return !is_finite(v); });
           bad != list.end())
    problems.add(name + ": the " + what + " of " + control_point(rule, std::size_t(bad - list.begin())) + " is " +
                 to_text(*bad, 6) + "; it must be finite");
}

void check_box(FfdBox const& box, std::string const& name, Problems& problems) {
  auto const& e = box.edges;
  if (!is_finite(box.origin) || !std::all_of(e.begin(), e.end(), is_finite))
    problems.add(name + ": the origin and the edges of its box must be finite");
  else if (!(std::abs(dot(cross(e[0], e[1]), e[2])) > 1e-12 * norm(e[0]) * norm(e[1]) * norm(e[2])))
    problems.add(name + ": the edges " + to_text(e[0], 6) + ", " + to_text(e[1], 6) + " and " + to_text(e[2], 6) +
                 " of its box span no volume");
}

}  // namespace

void check_ffd(FfdRule const& rule, std::string const& name, Problems& problems) {
  if (check_counts(rule, name, problems)) {
    check_list(rule, rule.displacement, "displacement", name, problems);
    if (!rule.points.empty()) {
      check_list(rule, rule.points, "position", name, problems);
      if (*std::min_element(rule.counts.begin(), rule.counts.end()) < 2)
        problems.add(name + ": a lattice of positions needs two control points along i, j and k at least");
    }
  }
  if (rule.box) check_box(*rule.box, name, problems);
  if (rule.box && !rule.points.empty())
    problems.add(name + ": it has a box and positions of control points; leave one of the two out");
  if (!std::isfinite(rule.share)) problems.add(name + ": its share of the displacements is not finite");
  if (!(rule.margin >= 0) || !std::isfinite(rule.margin))
    problems.add(name + ": the margin of its box is " + to_text(rule.margin, 6) +
                 "; give a share of the patches' size, 0 or more");
  if (rule.continuity < 0 || rule.continuity > 2)
    problems.add(name + ": continuity " + std::to_string(rule.continuity) + "; give 0, 1 or 2");
}

}  // namespace gridmorph
