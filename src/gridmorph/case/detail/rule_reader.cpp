#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/sections_reader.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/motion/contour.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

std::vector<std::string> const rule_names{"fixed",   "rigid",    "formula", "field",    "circumferential-slide",
                                          "follow",  "slip",     "free",    "sections", "target",
                                          "contour", "attached", "inflate", "bulb",     "extend",
                                          "wake",    "ffd",      "shock",   "carry"};

/// scale = 0.95, scale = [sx, sy, sz], or scale = { factor = one of these, origin = [x, y, z] }.
void read_scale(TableReader& step, RigidSteps& rigid) {
  auto const* value = step.find("scale");
  if (value == nullptr) return;
  auto const factors = [](TableReader& table, std::string const& key) -> std::optional<Vec3> {
    auto const* v = table.find(key);
    if (v == nullptr) return std::nullopt;
    std::optional<Vec3> f;
    if (v->is_array())
      f = table.vector(key);
    else if (auto const s = table.number(key))
      f = Vec3{*s, *s, *s};
    if (f && !(f->x > 0 && f->y > 0 && f->z > 0)) {
      table.problem(key, "every factor must be positive; a mirrored or flattened surface is no motion of the mesh");
      return std::nullopt;
    }
    return f;
  };
  std::optional<Vec3> factor;
  Vec3 origin{0, 0, 0};
  if (value->is_table()) {
    auto table = *step.table("scale");
    factor = factors(table, "factor");
    table.require("factor", "factor = 0.95 or factor = [sx, sy, sz]");
    origin = table.vector("origin").value_or(Vec3{0, 0, 0});
    table.finish();
  } else {
    factor = factors(step, "scale");
  }
  if (!factor) return;
  rigid.scale = *factor;
  rigid.scale_center = origin;
}

TimedRule read_rigid(TableReader& table, RuleContext const& shared) {
  std::vector<RigidSteps> all;
  bool const any = read_rigid_step(table, shared, all);
  auto steps = table.tables("steps");
  if (any && !steps.empty())
    table.problem("steps", "cannot stand beside scale, rotation or translation; put these into a step of their own");
  for (auto& step : steps) {
    if (!read_rigid_step(step, shared, all))
      step.context().problem(step.line(), "[[motion]] steps: a step needs scale, rotation or translation");
    step.finish();
  }
  if (!any && !table.has("steps"))
    table.problem("rule",
                  "rigid needs translation = [x, y, z], rotation = { axis, origin, angle_deg } or scale; for no "
                  "motion use rule = \"fixed\"");
  return {[all](double share, Moment const&) { return make_rigid_steps(all, share); }, {}};
}

TimedRule read_formula(TableReader& table, RuleContext const& shared) {
  std::array<std::string, 3> const cartesian{"dx", "dy", "dz"}, cylindrical{"dr", "dtheta", "daxial"};
  auto constants = shared.constants;
  read_constants(table, "constants", constants);
  auto const any_of = [&](auto const& keys) {
    return std::any_of(keys.begin(), keys.end(), [&](std::string const& k) { return table.has(k); });
  };
  bool const round = any_of(cylindrical), straight = any_of(cartesian);
  if (round && straight)
    table.problem("rule",
                  "mixes dx, dy, dz with dr, dtheta, daxial; use one set (a second rule can move other patches)");
  if (!round && !straight)
    table.problem("rule", "formula needs at least one of dx, dy, dz or of dr, dtheta [rad], daxial");
  std::array<FormulaComponent, 3> components;
  bool axis_used = round, in_time = false;
  for (int c = 0; c < 3; ++c) {
    auto const a = table.string(cartesian[c]), b = table.string(cylindrical[c]);
    std::string const& key = round ? cylindrical[c] : cartesian[c];
    components[c] = {key, round ? b.value_or("") : a.value_or(""), table.where(key)};
    axis_used = axis_used || uses_axis(components[c].expression);
    if (!uses_time(components[c].expression)) continue;
    needs_sequence(table, shared, key);
    in_time = true;
  }
  if (axis_used && !shared.axis)
    table.problem("rule",
                  "the formula uses r, theta or axial, but [mesh] has no axis; add axis = { origin = [0, 0, 0], "
                  "direction = [1, 0, 0] } to [mesh]");
  return {make_formula_in_time(round ? FormulaFrame::cylindrical : FormulaFrame::cartesian, components, constants,
                               shared.axis.value_or(Axis{}), table.context().problems),
          {},
          in_time};
}

std::vector<std::string> read_of(TableReader& table) {
  auto const of = table.strings("of");
  table.require("of", "of = \"blade\", the patches whose motion is taken over");
  return of.value_or(std::vector<std::string>{});
}

/// Pairs of numbers, [[a, b], ...], `least` of them; `what` says so in messages.
std::vector<std::pair<double, double>> read_pairs(TableReader& table, std::string const& key, std::size_t least,
                                                  std::string const& what) {
  auto const* value = table.find(key);
  if (value == nullptr) return {};
  std::vector<std::pair<double, double>> out;
  bool good = value->is_array() && value->as_array().size() >= least;
  if (good)
    for (auto const& pair : value->as_array()) {
      bool const two = pair.is_array() && pair.as_array().size() == 2;
      auto const a = two ? table.value_of(pair.as_array()[0], key) : std::nullopt,
                 b = two ? table.value_of(pair.as_array()[1], key) : std::nullopt;
      good = good && a && b;
      if (!good) break;
      out.emplace_back(*a, *b);
    }
  if (!good) table.problem(key, fmt::format("expected at least {}, as finite numbers", what));
  return good ? out : std::vector<std::pair<double, double>>{};
}

std::vector<std::pair<double, double>> read_profile(TableReader& table) {
  auto const profile = read_pairs(table, "profile", 2, "two points [[axial, radius], ...]");
  for (auto const& [axial, radius] : profile)
    if (radius < 0) table.problem("profile", fmt::format("the point [{}, {}] has a negative radius", axial, radius));
  return profile;
}

/// The sum of two motions.
FunctionRule both(FunctionRule first, FunctionRule second) {
  return {first.description + ", " + second.description,
          [one = std::move(first.function), other = std::move(second.function)](std::span<Vec3 const> points,
                                                                                std::span<Vec3> out) {
            std::vector<Vec3> more(points.size());
            one(points, out);
            other(points, more);
            for (std::size_t n = 0; n < points.size(); ++n) out[n] += more[n];
          }};
}

TimedRule read_contour(TableReader& table, RuleContext const& shared) {
  auto const profile = read_profile(table);
  auto const offset = table.string("offset");
  auto constants = shared.constants;
  read_constants(table, "constants", constants);
  TimedRule rule;
  rule.end_wall = true;
  if (!table.has("profile") && !offset)
    table.problem("profile",
                  "is missing; add profile = [[axial, radius], [axial, radius], ...], or offset = "
                  "\"0.002 * cos(36 * theta)\"");
  if (!shared.axis) return rule;
  FormulaAt bumps;
  if (offset) {
    rule.changes = uses_time(*offset);
    if (rule.changes) needs_sequence(table, shared, "offset");
    bumps = make_formula_in_time(FormulaFrame::cylindrical, {{{"offset", *offset, table.where("offset")}, {}, {}}},
                                 constants, *shared.axis, table.context().problems);
  }
  if (!profile.empty()) {
    try {
      (void)make_contour(profile, *shared.axis, {});
    } catch (MotionError const& e) {
      table.problem("profile", e.what());
      return rule;
    }
  } else if (!bumps) {
    return rule;
  }
  rule.at = [profile, bumps, axis = *shared.axis, where = table.where("profile")](double share, Moment const& when) {
    if (profile.empty()) return bumps(share, when);
    FunctionRule const contour = make_contour(profile, axis, where, share);
    return bumps ? both(contour, bumps(share, when)) : contour;
  };
  return rule;
}

Rule read_slip(TableReader& table, RuleContext const& shared) {
  SlipRule rule;
  auto const surface = table.choice("surface", {"plane", "revolution", "baseline"});
  table.require("surface", "surface = \"plane\", \"revolution\" or \"baseline\"");
  if (surface)
    rule.surface =
        std::array{SlipRule::Surface::plane, SlipRule::Surface::revolution, SlipRule::Surface::baseline}[*surface];
  bool const round = rule.surface == SlipRule::Surface::revolution;
  if (table.has("crease_angle_deg")) {
    if (rule.surface != SlipRule::Surface::baseline)
      table.problem("crease_angle_deg", "belongs to surface = \"baseline\"; remove it or change the surface");
    if (auto const angle = table.number("crease_angle_deg")) {
      if (!(*angle > 0 && *angle <= 180))
        table.problem("crease_angle_deg", fmt::format("the angle {} is not above 0 and up to 180 degrees", *angle));
      rule.crease_angle_rad = *angle * std::numbers::pi / 180;
    }
  }
  if (auto plane = table.table("plane")) {
    if (rule.surface != SlipRule::Surface::plane)
      table.problem("plane", "belongs to surface = \"plane\"; remove it or change the surface");
    auto const point = plane->vector("point"), normal = plane->vector("normal");
    plane->require("point", "point = [x, y, z]");
    plane->require("normal", "normal = [x, y, z]");
    if (normal && norm(*normal) == 0)
      plane->problem("normal", "the direction [0, 0, 0] has no length");
    else if (point && normal)
      rule.plane = {*point, *normal};
    plane->finish();
  }
  if (table.has("profile") && !round)
    table.problem("profile", "belongs to surface = \"revolution\"; remove it or change the surface");
  rule.profile = read_profile(table);
  if (round && !shared.axis)
    table.problem("surface",
                  "a surface of revolution needs the machine axis; add axis = { origin = [0, 0, 0], direction = "
                  "[1, 0, 0] } to [mesh]");
  return rule;
}

FreeRule::Constraint read_constraint(TableReader& table, RuleContext const& shared) {
  auto const number = table.choice("constraint", {"none", "axial", "plane"});
  auto const constraint = number ? FreeRule::Constraint(*number) : FreeRule::Constraint::none;
  if (constraint == FreeRule::Constraint::axial && !shared.axis)
    table.problem("constraint", "\"axial\" needs the machine axis; add axis to [mesh]");
  return constraint;
}

void needs_axis(TableReader& table, RuleContext const& shared, std::string const& name) {
  if (!shared.axis)
    table.problem("rule",
                  fmt::format("{} needs the machine axis; add axis = {{ origin = [0, 0, 0], direction = [1, 0, 0] }} "
                              "to [mesh]",
                              name));
}

/// The same rule, of which all shares are this one's shares.
void take_share(TimedRule& rule, double amplitude) {
  rule.amplitude = nullptr;
  rule.at = [at = std::move(rule.at), amplitude](double share, Moment const& when) {
    return at(share * amplitude, when);
  };
}

/// Values over time: before the first and after the last as there; between them linear, or level at each and smooth.
std::function<double(Moment const&)> amplitude_table(std::vector<std::pair<double, double>> stations, bool smooth) {
  return [stations = std::move(stations), smooth](Moment const& when) {
    if (when.time <= stations.front().first) return stations.front().second;
    if (when.time >= stations.back().first) return stations.back().second;
    auto const time = [&](int k) { return stations[k].first; };
    std::size_t const n = std::size_t(piece_at(int(stations.size()), time, when.time));
    auto const [from, a] = stations[n];
    auto const [to, b] = stations[n + 1];
    double const width = to - from, t = (when.time - from) / width;
    return smooth ? cubic_piece(a, b, 0.0, 0.0, width, t) : a + t * (b - a);
  };
}

/// amplitude = 0.5, amplitude = "sin(t)" or amplitude = [[time, value], ...].
void read_amplitude(TableReader& table, RuleContext const& shared, TimedRule& rule) {
  auto const* value = table.find("amplitude");
  auto const smooth = table.choice("amplitude_law", {"linear", "smooth"});
  if (table.has("amplitude_law") && (value == nullptr || !value->is_array()))
    table.problem("amplitude_law", "belongs to amplitude = [[time, value], ...]; remove it");
  if (value == nullptr) return;
  if (value->is_array()) {
    auto const stations = read_pairs(table, "amplitude", 1, "one pair [[time, value], ...]");
    for (std::size_t n = 1; n < stations.size(); ++n)
      if (!(stations[n].first > stations[n - 1].first))
        table.problem("amplitude",
                      fmt::format("times must ascend, found {} after {}", stations[n].first, stations[n - 1].first));
    rule.amplitude = amplitude_table(stations, smooth.value_or(0) == 1);
  } else if (value->is_string()) {
    auto const expression = table.string("amplitude");
    if (!expression) return;
    rule.amplitude = make_time_formula({"amplitude", *expression, table.where("amplitude")}, shared.constants,
                                       table.context().problems);
    if (!uses_time(*expression)) {
      // Known now; a formula with problems has been reported.
      try {
        if (rule.at && table.context().problems.empty()) take_share(rule, rule.amplitude({}));
      } catch (MotionError const& e) {
        table.problem("amplitude", e.what());
      }
      return;
    }
  } else {
    if (auto const share = table.number("amplitude"); share && rule.at) take_share(rule, *share);
    return;
  }
  needs_sequence(table, shared, "amplitude");
  rule.changes = true;
}

/// Lengths that must be positive, as far as they are given.
std::optional<double> read_length(TableReader& table, char const* key) {
  auto const value = table.number(key);
  if (value && !(*value > 0)) table.problem(key, fmt::format("must be a positive length, found {}", *value));
  return value;
}

/// What needs the mesh is left to those who have it (ShockFollow).
TimedRule read_shock(TableReader& table, CaseFile& out) {
  ShockFollow follow;
  follow.rule = out.motion.rules.size();
  follow.where = table.context().where(table.line());
  table.require("to", "to = \"new_flow.cgns\", a CGNS file with the mesh and the solution on it");
  if (auto const to = table.input("to")) follow.to = to->string();
  follow.solution = table.string("solution").value_or("");
  follow.direction = table.vector("direction");
  if (follow.direction && !(norm(*follow.direction) > 0)) table.problem("direction", "[0, 0, 0] has no length");
  follow.smooth = read_length(table, "smooth");
  ShockRule rule;
  rule.of = table.strings("of").value_or(std::vector<std::string>{});
  rule.fade = read_length(table, "fade").value_or(0);
  if (rule.of.empty() != !table.has("fade"))
    table.problem(rule.of.empty() ? "fade" : "of",
                  "of and fade belong together: the walls that the shock stands on, and the distance from them within "
                  "which its motion fades to theirs");
  out.shock_follows.push_back(std::move(follow));
  return {[rule](double share, Moment const&) {
            ShockRule at = rule;
            at.share = share;
            return at;
          },
          {}};
}

/// Rules with a displacement of their own, by their number in rule_names; none for the others.
std::optional<TimedRule> read_explicit(std::size_t number, TableReader& table, RuleContext const& shared,
                                       CaseFile& out) {
  switch (number) {
    case 1: return read_rigid(table, shared);
    case 2: return read_formula(table, shared);
    case 3: return read_field(table, shared, out);
    case 8:
      return TimedRule{[sections = read_sections(table, shared.axis.has_value())](double share, Moment const&) {
                         return share == 1 ? sections : share_of(sections, share);
                       },
                       {}};
    case 9:
      return TimedRule{[target = std::get<TargetRule>(read_target_rule(table, shared))](double share, Moment const&) {
                         TargetRule rule = target;
                         rule.share = share;
                         return rule;
                       },
                       {}};
    case 10: needs_axis(table, shared, rule_names[number]); return read_contour(table, shared);
    case 12: return read_inflate(table, shared);
    case 13: return read_bulbs(table, shared);
    case 16: return read_ffd(table, shared);
    case 17: return read_shock(table, out);
    default: return std::nullopt;
  }
}

Rule read_attached(TableReader& table) {
  AttachedRule rule;
  rule.of = read_of(table);
  auto const how = table.choice("how", {"rigid", "shift", "nearest"});
  if (how) rule.how = AttachedRule::How(*how);
  if (auto near = table.table("near")) {
    if (rule.how == AttachedRule::How::nearest)
      table.problem("near", "belongs to how = \"rigid\" or \"shift\"; remove it, or change how");
    auto const point = near->vector("point");
    auto const distance = near->number("distance");
    near->require("point", "point = [x, y, z]");
    near->require("distance", "distance = 0.1");
    if (distance && *distance <= 0)
      near->problem("distance", fmt::format("must be a positive length, found {}", *distance));
    else if (point && distance)
      rule.near = {*point, *distance};
    near->finish();
  }
  return rule;
}

Rule read_carry(TableReader& table, RuleContext const& shared) {
  CarryRule rule;
  rule.of = read_of(table);
  rule.constraint = read_constraint(table, shared);
  rule.fade = read_length(table, "fade");
  return rule;
}

Rule read_wake(TableReader& table, RuleContext const& shared) {
  WakeRule rule;
  rule.of = read_of(table);
  SectionsRule search;
  read_section_search(table, shared.axis.has_value(), search);
  rule.sections = search.sections;
  rule.span = search.span;
  rule.flow = search.flow;
  rule.fade = read_length(table, "fade");
  rule.turn = table.number("turn").value_or(rule.turn);
  if (!(rule.turn >= 0 && rule.turn <= 1))
    table.problem("turn", fmt::format("is a share, 0 to 1, found {}", rule.turn));
  return rule;
}

Rule read_other(std::size_t number, TableReader& table, RuleContext const& shared) {
  switch (number) {
    case 4: needs_axis(table, shared, rule_names[number]); return CircumferentialSlideRule{read_of(table)};
    case 5: needs_axis(table, shared, rule_names[number]); return FollowRule{read_of(table)};
    case 6: return read_slip(table, shared);
    case 7: return FreeRule{read_constraint(table, shared)};
    case 11: return read_attached(table);
    case 14: return ExtendRule{read_of(table)};
    case 15: return read_wake(table, shared);
    case 18: return read_carry(table, shared);
    default: return FixedRule{};
  }
}

}  // namespace

bool read_rigid_step(TableReader& step, RuleContext const& shared, std::vector<RigidSteps>& all) {
  bool const any = step.has("scale") || step.has("rotation") || step.has("translation");
  RigidSteps rigid;
  read_scale(step, rigid);
  read_rotation(step, shared, rigid);
  if (auto const shift = step.vector("translation")) rigid.translation = *shift;
  if (any) all.push_back(rigid);
  return any;
}

void read_rotation(TableReader& step, RuleContext const& shared, RigidSteps& rigid) {
  auto table = step.table("rotation");
  if (!table) return;
  auto const angle = table->number("angle_deg");
  table->require("angle_deg", "angle_deg = 10.0 (degrees, right-handed about the axis)");
  auto const direction = table->vector("axis");
  auto const origin = table->vector("origin");
  bool const given = table->has("axis");
  if (given && direction && norm(*direction) == 0) {
    table->problem("axis", "the direction [0, 0, 0] has no length; give the direction to turn about");
    return;
  }
  if (!given && !shared.axis)
    table->problem("axis", "is missing and [mesh] has no axis; add axis = [x, y, z] here or axis to [mesh]");
  if (given && !table->has("origin"))
    table->problem("origin", "is missing; add origin = [x, y, z], a point on the line to turn about");
  table->finish();
  if (!angle || (given && (!direction || !origin)) || (!given && !shared.axis)) return;
  if (!given)
    step.context().notes.push_back(
        fmt::format("{}: the rotation names no axis; it turns about that of [mesh], through ({:.6g}, {:.6g}, {:.6g}) "
                    "along ({:.6g}, "
                    "{:.6g}, {:.6g})",
                    step.where("rotation"), shared.axis->origin.x, shared.axis->origin.y, shared.axis->origin.z,
                    shared.axis->direction.x, shared.axis->direction.y, shared.axis->direction.z));
  rigid.axis = {origin ? *origin : shared.axis->origin, given ? *direction : shared.axis->direction};
  rigid.angle_rad = *angle * std::numbers::pi / 180;
}

void needs_sequence(TableReader& table, RuleContext const& shared, std::string const& key) {
  if (!shared.in_time)
    table.problem(key, "depends on the time or the step, and there is no [sequence]; add one, or take t and step out");
}

std::vector<std::string> const& known_rules() { return rule_names; }

std::optional<Axis> read_axis(TableReader& table, std::string const& key) {
  auto const* value = table.find(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) {
    auto const letter = table.choice(key, {"x", "y", "z"});
    if (!letter) return std::nullopt;
    return Axis{{0, 0, 0}, {*letter == 0 ? 1.0 : 0.0, *letter == 1 ? 1.0 : 0.0, *letter == 2 ? 1.0 : 0.0}};
  }
  if (!value->is_table()) {
    table.problem(
        key, fmt::format("expected {{ origin = [0, 0, 0], direction = [1, 0, 0] }} or \"x\", \"y\", \"z\", found {}",
                         describe_value(*value)));
    return std::nullopt;
  }
  auto axis = *table.table(key);
  auto const origin = axis.vector("origin"), direction = axis.vector("direction");
  axis.require("direction", "direction = [1, 0, 0]");
  if (direction && norm(*direction) == 0) axis.problem("direction", "the direction [0, 0, 0] has no length");
  axis.finish();
  if (!direction || norm(*direction) == 0) return std::nullopt;
  return Axis{origin.value_or(Vec3{0, 0, 0}), *direction};
}

void read_constants(TableReader& table, std::string const& key, std::map<std::string, double>& constants) {
  auto names = table.table(key);
  if (!names) return;
  for (auto const& [name, value] : table.find(key)->as_table()) {
    auto const number = names->number(name);
    // A name that no formula can use would make the formula library throw.
    if (!is_free_formula_name(name))
      names->problem(name, not_a_constant);
    else if (number)
      constants[name] = *number;
  }
}

void read_motion_rule(TableReader& table, RuleContext const& shared, CaseFile& out) {
  MotionRule motion;
  motion.where = table.context().where(table.line());
  motion.patches = table.strings("patches").value_or(std::vector<std::string>{});
  table.require("patches", "patches = [\"blade\"] (family, BC or connection names, globs, or type:wall ...)");
  motion.rank = table.integer("rank").value_or(0);
  auto const name = table.string("rule");
  table.require("rule", "rule = \"fixed\" or another rule");
  if (!name) return;
  auto const known = std::find(rule_names.begin(), rule_names.end(), *name);
  if (known == rule_names.end()) {
    table.problem("rule", fmt::format("\"{}\" is no rule{}", *name, suggestion(*name, rule_names)));
    return;  // its other keys cannot be judged
  }
  auto const number = std::size_t(known - rule_names.begin());
  TimedRule timed;
  if (auto own = read_explicit(number, table, shared, out)) {
    timed = std::move(*own);
    read_amplitude(table, shared, timed);
  } else {
    motion.rule = read_other(number, table, shared);
    if (table.find("amplitude") != nullptr)
      table.problem("amplitude", number == 4 || number == 5 || number == 11 || number == 14 || number == 18
                                     ? "belongs to the rule of the blade or wall, which this rule goes along with"
                                     : fmt::format("multiplies a displacement, and \"{}\" gives none", *name));
  }
  table.finish();
  try {
    if (timed.at) motion.rule = timed.at(1, {});
  } catch (Error const& e) {
    table.problem("rule", e.what());
  }
  out.motion.rules.push_back(std::move(motion));
  out.timed.push_back(std::move(timed));
}

}  // namespace gridmorph::casefile
