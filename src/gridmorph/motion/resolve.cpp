#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/detail/free_periodics.hpp>
#include <gridmorph/motion/ffd/check_ffd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace gridmorph {

namespace {

constexpr int unclaimed = -1;

bool finite(Vec3 const& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

template <class T>
bool is(Rule const& rule) {
  return std::holds_alternative<T>(rule);
}

/// Displacements that need no other patch: what a blade must have for others to follow it.
bool is_direct(Rule const& rule) {
  return is<FixedRule>(rule) || is<RigidRule>(rule) || is<FunctionRule>(rule) || is<SectionsRule>(rule) ||
         is<TargetRule>(rule) || is<InflateRule>(rule) || is<FfdRule>(rule);
}

std::vector<std::string> names_of(std::vector<Patch> const& of, std::vector<int> const& patches) {
  std::set<std::string> names;
  for (int p : patches) names.insert(of[p].families.empty() ? of[p].name : of[p].families.front());
  return {names.begin(), names.end()};
}

class Resolver {
 public:
  Resolver(NamedBoundary const& boundary, Motion const& motion)
      : boundary_(boundary),
        motion_(motion),
        patch_claim_(boundary.patches().size(), unclaimed),
        connections_(boundary.connections()),
        interface_claim_(connections_.size(), unclaimed) {}

  ResolvedMotion run() {
    result_.axis = motion_.axis;
    result_.conformity_tolerance = motion_.conformity_tolerance;
    result_.rules = motion_.rules;
    result_.patch.resize(boundary_.patches().size());
    result_.interface.resize(connections_.size());

    check_motion();
    for (std::size_t r = 0; r < motion_.rules.size(); ++r) {
      check_rule(int(r));
      claim(int(r));
    }
    report_conflicts();
    resolve_interfaces();
    resolve_patches();
    for (std::size_t r = 0; r < motion_.rules.size(); ++r) check_blades(int(r));
    check_regions();
    problems_.throw_if_any<MotionError>();
    return std::move(result_);
  }

 private:
  std::string label(int r) const {
    MotionRule const& rule = motion_.rules[r];
    return "rule " + std::to_string(r + 1) + " (" + std::string(rule_name(rule.rule)) +
           (rule.where.empty() ? "" : ", " + rule.where) + ")";
  }

  void check_motion() {
    if (!finite(motion_.axis.origin) || !finite(motion_.axis.direction) || !(norm(motion_.axis.direction) > 0))
      problems_.add(
          "the axis must have a finite origin and a direction that "
          "is not (0, 0, 0)");
    if (!(motion_.conformity_tolerance >= 0) || !std::isfinite(motion_.conformity_tolerance))
      problems_.add("the conformity tolerance is " + std::to_string(motion_.conformity_tolerance) +
                    "; give a fraction of the mesh size, such as 1e-9");
  }

  void check_rule(int r) {
    Rule const& rule = motion_.rules[r].rule;
    if (motion_.rules[r].patches.empty()) problems_.add(label(r) + " names no patches");
    if (auto const* rigid = std::get_if<RigidRule>(&rule)) {
      bool ok = finite(rigid->translation);
      for (auto const& row : rigid->matrix.m)
        for (double m : row) ok = ok && std::isfinite(m);
      if (!ok) problems_.add(label(r) + ": its matrix or translation is not finite");
    } else if (auto const* function = std::get_if<FunctionRule>(&rule)) {
      if (!function->function) problems_.add(label(r) + ": it has no function");
    } else if (auto const* slip = std::get_if<SlipRule>(&rule)) {
      if (slip->plane &&
          (!finite(slip->plane->first) || !finite(slip->plane->second) || !(norm(slip->plane->second) > 0)))
        problems_.add(label(r) +
                      ": the plane needs a finite point and a "
                      "normal that is not (0, 0, 0)");
      if (!(slip->crease_angle_rad > 0))
        problems_.add(label(r) + ": the angle of a crease is " + std::to_string(slip->crease_angle_rad) +
                      " rad; it must be positive");
    } else if (auto const* sections = std::get_if<SectionsRule>(&rule)) {
      check_sections(r, *sections);
    } else if (auto const* carry = std::get_if<CarryRule>(&rule); carry != nullptr && carry->fade) {
      if (!std::isfinite(*carry->fade) || !(*carry->fade > 0))
        problems_.add(label(r) + ": the distance within which the motion of its features fades is " +
                      std::to_string(*carry->fade) + "; give a positive length, or none");
    } else if (auto const* attached = std::get_if<AttachedRule>(&rule); attached != nullptr && attached->near) {
      auto const& [place, distance] = *attached->near;
      if (!finite(place) || !std::isfinite(distance) || !(distance > 0))
        problems_.add(label(r) + ": the place that it is attached near must be finite and the distance " +
                      std::to_string(distance) + " positive");
    } else if (auto const* target = std::get_if<TargetRule>(&rule);
               target != nullptr && !std::isfinite(target->share)) {
      problems_.add(label(r) + ": its share of the way to the target is not finite");
    } else if (auto const* inflate = std::get_if<InflateRule>(&rule)) {
      if (!inflate->height) problems_.add(label(r) + ": it has no height");
      if (!std::isfinite(inflate->share)) problems_.add(label(r) + ": its share of the height is not finite");
      if (!(inflate->crease_angle_deg > 0 && inflate->crease_angle_deg <= 180))
        problems_.add(label(r) + ": the crease angle is " + std::to_string(inflate->crease_angle_deg) +
                      " degrees; give one above 0 and up to 180");
    } else if (auto const* ffd = std::get_if<FfdRule>(&rule)) {
      check_ffd(*ffd, label(r), problems_);
    }
  }

  void check_sections(int r, SectionsRule const& rule) {
    constexpr double inf = std::numeric_limits<double>::infinity(), right_angle = std::numbers::pi / 2;
    // Each parameter with its name and the open interval of its values.
    struct Parameter {
      char const* name;
      SpanwiseTable const& table;
      double above, below;
    };
    for (Parameter const& p :
         {Parameter{"chord", rule.chord, -1, inf}, Parameter{"scale", rule.scale, -1, inf},
          Parameter{"thickness", rule.thickness, -1, inf}, Parameter{"twist", rule.twist_rad, -inf, inf},
          Parameter{"stagger", rule.stagger_rad, -2 * right_angle, 2 * right_angle},
          Parameter{"sweep", rule.sweep, -inf, inf}, Parameter{"lean", rule.lean, -inf, inf},
          Parameter{"bow", rule.bow_rad, -right_angle, right_angle}}) {
      double before = -inf;
      for (auto const& [span, value] : p.table.stations) {
        if (!std::isfinite(span) || !(span > before))
          problems_.add(label(r) + ": " + p.name + ": span fraction " + std::to_string(span) +
                        " does not lie above the one before; give them in ascending order, each once");
        if (!(value > p.above && value < p.below) || !std::isfinite(value))
          problems_.add(label(r) + ": " + p.name + ": the value " + std::to_string(value) + " at span fraction " +
                        std::to_string(span) + " is not " +
                        (p.above == -1    ? "finite and above -1, which would leave nothing of the section"
                         : p.below == inf ? "finite"
                                          : "a number of radians that a line can turn by"));
        before = span;
      }
    }
    if (!std::isfinite(rule.pivot)) problems_.add(label(r) + ": the pivot is not finite; give a chord fraction");
    if (!finite(rule.flow) || !(norm(rule.flow) > 0) || (rule.span && (!finite(*rule.span) || !(norm(*rule.span) > 0))))
      problems_.add(label(r) + ": the directions of flow and span must be finite and not (0, 0, 0)");
  }

  void claim(int r) {
    for (std::string const& selector : motion_.rules[r].patches) {
      Selection s;
      try {
        s = boundary_.select(selector);
      } catch (MotionError const& e) {
        problems_.add(label(r) + ": " + e.what());
        continue;
      }
      if (s.empty()) problems_.add(label(r) + ": " + boundary_.matches_nothing(selector));
      for (int p : s.patches) claim_one(patch_claim_[p], r, boundary_.describe_patch(p));
      for (int i : s.interfaces) claim_interface(i, r);
    }
  }

  void claim_interface(int i, int r) {
    std::string const name = "interface " + boundary_.describe_interface(connections_[i]);
    if (!connections_[i].periodic) {
      problems_.add(label(r) + " names the plain " + name +
                    ", which is inside the domain and moves with the volume; "
                    "name patches or periodic interfaces");
      return;
    }
    Rule const& rule = motion_.rules[r].rule;
    auto const* free = std::get_if<FreeRule>(&rule);
    if (is<SlipRule>(rule) || is<SectionsRule>(rule) || is<TargetRule>(rule) || is<AttachedRule>(rule) ||
        is<CarryRule>(rule) || is<InflateRule>(rule) || is<ExtendRule>(rule) || is<FfdRule>(rule) ||
        (free != nullptr && free->constraint != FreeRule::Constraint::none)) {
      problems_.add(label(r) + " names the periodic " + name +
                    "; periodic interfaces take free without constraint, "
                    "follow, circumferential-slide, fixed, rigid or "
                    "function");
      return;
    }
    claim_one(interface_claim_[i], r, "periodic " + name);
    // The file stores the connection once per side: both sides are one interface to the user.
    if (int const partner = boundary_.other_side(i); partner >= 0)
      claim_one(interface_claim_[partner], r,
                "periodic interface " + boundary_.describe_interface(connections_[partner]));
  }

  void claim_one(int& claim, int r, std::string name) {
    if (claim == unclaimed) claim = r;
    if (claim != r) conflicts_[{claim, r}].insert(std::move(name));
  }

  void report_conflicts() {
    for (auto const& [pair, names] : conflicts_) {
      std::string list;
      for (auto const& name : names) list += (list.empty() ? "" : ", ") + name;
      problems_.add(label(pair.first) + " and " + label(pair.second) + " both name " + list +
                    "; a patch has one rule: narrow the selectors of one of them");
    }
  }

  void resolve_interfaces() {
    for (std::size_t i = 0; i < connections_.size(); ++i) {
      int const r = interface_claim_[i];
      if (r != unclaimed)
        result_.interface[i].rule = is<FreeRule>(motion_.rules[r].rule) ? -1 : r;
      else
        result_.interface[i].by_default = connections_[i].periodic.has_value();
    }
    if (auto const free = detail::free_by_default(connections_, result_); !free.empty())
      took_default(detail::periodics, free, detail::move_as_one);
  }

  void resolve_patches() {
    std::vector<int> symmetry, poles, fixed;
    for (std::size_t p = 0; p < boundary_.patches().size(); ++p) {
      result_.patch[p].rule = patch_claim_[p];
      if (patch_claim_[p] != unclaimed) continue;
      result_.patch[p].by_default = true;
      // A polar line is no plane to slide on.
      bool const plane =
          boundary_.patches()[p].kind == PatchKind::symmetry && boundary_.patches()[p].bc_type != "BCSymmetryPolar";
      bool const pole = boundary_.patches()[p].kind == PatchKind::degenerate;
      (plane ? symmetry : pole ? poles : fixed).push_back(int(p));
    }
    add_default(symmetry, SlipRule{}, "symmetry patches", "slip on their own plane");
    add_default(poles, FreeRule{}, "poles", "move as one with what they end on");
    add_default(fixed, FixedRule{}, "patches", "fixed");
  }

  void add_default(std::vector<int> const& patches, Rule rule, char const* what, char const* decision) {
    if (patches.empty()) return;
    std::vector<std::string> const names = names_of(boundary_.patches(), patches);
    for (int p : patches) result_.patch[p].rule = int(result_.rules.size());
    result_.rules.push_back({names, std::move(rule), 0, std::string("default of ") + what});
    took_default(what, names, decision);
  }

  void took_default(std::string const& what, std::vector<std::string> const& names, std::string const& decision) {
    if (motion_.strict)
      problems_.add("no rule names the " + what + " " + quote_list(names) +
                    ", and the motion is strict; give each a rule (the default "
                    "would be: " +
                    decision + ")");
    else
      result_.notes.push_back(detail::default_note(what, names, decision));
  }

  void check_blades(int r) {
    Rule const& rule = motion_.rules[r].rule;
    std::vector<std::string> const* of = nullptr;
    if (auto const* slide = std::get_if<CircumferentialSlideRule>(&rule)) of = &slide->of;
    if (auto const* follow = std::get_if<FollowRule>(&rule)) of = &follow->of;
    if (auto const* attached = std::get_if<AttachedRule>(&rule)) of = &attached->of;
    if (auto const* carry = std::get_if<CarryRule>(&rule)) of = &carry->of;
    if (auto const* wake = std::get_if<WakeRule>(&rule)) of = &wake->of;
    if (auto const* shock = std::get_if<ShockRule>(&rule); shock != nullptr && !shock->of.empty()) of = &shock->of;
    if (auto const* extend = std::get_if<ExtendRule>(&rule)) of = &extend->of;
    if (of == nullptr) return;
    if (of->empty()) problems_.add(label(r) + ": `of` is empty; name the walls whose motion it takes up");
    std::vector<int> blades;
    try {
      blades = boundary_.select_patches(*of);
    } catch (MotionError const& e) {
      problems_.add(label(r) + ": of: " + e.what());
    }
    if (is<CarryRule>(rule)) check_named(r, blades);
    std::map<int, std::vector<int>> unfit;
    for (int p : blades)
      if (int const own = result_.patch[p].rule; !is_direct(result_.rules[own].rule)) unfit[own].push_back(p);
    for (auto const& [own, patches] : unfit)
      problems_.add(label(r) + ": of: " + quote_list(names_of(boundary_.patches(), patches)) + " has the rule '" +
                    std::string(rule_name(result_.rules[own].rule)) +
                    "', whose displacement is not known beforehand; give it "
                    "fixed, rigid, formula, field, sections, target, inflate or ffd");
  }

  /// Walls that features sit on have a rule that says how they move.
  void check_named(int r, std::vector<int> const& walls) {
    std::vector<int> unnamed;
    for (int const p : walls)
      if (result_.patch[p].by_default) unnamed.push_back(p);
    if (!unnamed.empty())
      problems_.add(
          label(r) + ": of: no rule names " + quote_list(names_of(boundary_.patches(), unnamed)) +
          ", so nothing says how the walls move that the features sit on; give them one (\"fixed\" if they stand)");
  }

  /// Checks the rules of regions, which ask for something at places inside the domain, with no surface to go by.
  void check_regions() {
    std::map<int, std::set<std::string>> unfit;
    for (std::size_t p = 0; p < boundary_.patches().size(); ++p) {
      if (boundary_.patches()[p].kind != PatchKind::region) continue;
      Rule const& rule = result_.rules[result_.patch[p].rule].rule;
      if (!is<FixedRule>(rule) && !is<RigidRule>(rule) && !is<FunctionRule>(rule) && !is<AttachedRule>(rule) &&
          !is<WakeRule>(rule) && !is<ShockRule>(rule) && !is<PrescribedRule>(rule))
        unfit[result_.patch[p].rule].insert(boundary_.patches()[p].name);
    }
    for (auto const& [r, names] : unfit)
      problems_.add(label(r) + " names the region " + quote_list({names.begin(), names.end()}) +
                    "; regions take fixed, rigid, formula, field, attached, wake or shock");
  }

  NamedBoundary const& boundary_;
  Motion const& motion_;
  std::vector<int> patch_claim_;
  std::vector<AnyConnection> connections_;
  std::vector<int> interface_claim_;
  std::map<std::pair<int, int>, std::set<std::string>> conflicts_;
  Problems problems_;
  ResolvedMotion result_;
};

}  // namespace

std::string_view rule_name(Rule const& rule) {
  static constexpr std::array<std::string_view, std::variant_size_v<Rule>> names{
      "fixed",  "rigid",      "function", "circumferential-slide",
      "follow", "slip",       "free",     "sections",
      "target", "prescribed", "attached", "inflate",
      "extend", "wake",       "ffd",      "shock",
      "carry"};
  return names[rule.index()];
}

ResolvedMotion resolve(NamedBoundary const& boundary, Motion const& motion) { return Resolver(boundary, motion).run(); }

ResolvedMotion resolve(BoundaryMesh const& mesh, Motion const& motion) { return resolve(NamedBoundary(mesh), motion); }

}  // namespace gridmorph
