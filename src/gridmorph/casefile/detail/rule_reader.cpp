#include <gridmorph/casefile/detail/field_reader.hpp>
#include <gridmorph/casefile/detail/rule_reader.hpp>
#include <gridmorph/casefile/detail/sections_reader.hpp>
#include <gridmorph/casefile/detail/target_reader.hpp>
#include <gridmorph/casefile/formula.hpp>
#include <gridmorph/casefile/suggest.hpp>
#include <gridmorph/core/rigid_transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

std::vector<std::string> const rule_names{"fixed",  "rigid", "formula", "field",    "circumferential-slide",
                                          "follow", "slip",  "free",    "sections", "target"};

/// x' = matrix * x + translation.
struct Affine {
  Mat3 matrix;
  Vec3 translation;

  void then(Affine const& next) {
    matrix = next.matrix * matrix;
    translation = next.matrix * translation + next.translation;
  }
};

/// rotation = { axis, origin, angle_deg }. Without axis and origin: about the machine axis.
std::optional<Affine> read_rotation(TableReader& step, RuleContext const& shared) {
  auto table = step.table("rotation");
  if (!table) return std::nullopt;
  auto const angle = table->number("angle_deg");
  table->require("angle_deg", "angle_deg = 10.0 (degrees, right-handed about the axis)");
  auto const direction = table->vector("axis");
  auto const origin = table->vector("origin");
  bool const given = table->has("axis");
  if (given && direction && norm(*direction) == 0) {
    table->problem("axis", "the direction [0, 0, 0] has no length; give the direction to turn about");
    return std::nullopt;
  }
  if (!given && !shared.axis)
    table->problem("axis", "is missing and [mesh] has no axis; add axis = [x, y, z] here or axis to [mesh]");
  if (given && !table->has("origin"))
    table->problem("origin", "is missing; add origin = [x, y, z], a point on the line to turn about");
  table->finish();
  if (!angle || (given && (!direction || !origin)) || (!given && !shared.axis)) return std::nullopt;
  Vec3 const about = given ? *direction : shared.axis->direction;
  Vec3 const point = origin ? *origin : shared.axis->origin;
  if (*angle == 0) return Affine{};
  RigidTransform const turn = rotation_about(point, about, *angle * std::numbers::pi / 180);
  return Affine{turn.rotation, turn.translation};
}

/// scale = 0.95, scale = [sx, sy, sz], or scale = { factor = one of these, origin = [x, y, z] }.
std::optional<Affine> read_scale(TableReader& step) {
  auto const* value = step.find("scale");
  if (value == nullptr) return std::nullopt;
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
  if (!factor) return std::nullopt;
  Affine a;
  a.matrix.m[0][0] = factor->x;
  a.matrix.m[1][1] = factor->y;
  a.matrix.m[2][2] = factor->z;
  a.translation = {origin.x - factor->x * origin.x, origin.y - factor->y * origin.y, origin.z - factor->z * origin.z};
  return a;
}

/// Scale, then rotation, then translation, as far as given. False when none is.
bool read_step(TableReader& step, RuleContext const& shared, Affine& affine) {
  bool const any = step.has("scale") || step.has("rotation") || step.has("translation");
  if (auto const scale = read_scale(step)) affine.then(*scale);
  if (auto const rotation = read_rotation(step, shared)) affine.then(*rotation);
  if (auto const shift = step.vector("translation")) affine.then({Mat3{}, *shift});
  return any;
}

Rule read_rigid(TableReader& table, RuleContext const& shared) {
  Affine affine;
  bool const any = read_step(table, shared, affine);
  auto steps = table.tables("steps");
  if (any && !steps.empty())
    table.problem("steps", "cannot stand beside scale, rotation or translation; put these into a step of their own");
  for (auto& step : steps) {
    if (!read_step(step, shared, affine))
      step.context().problem(step.line(), "[[motion]] steps: a step needs scale, rotation or translation");
    step.finish();
  }
  if (!any && !table.has("steps"))
    table.problem("rule",
                  "rigid needs translation = [x, y, z], rotation = { axis, origin, angle_deg } or scale; for no "
                  "motion use rule = \"fixed\"");
  return RigidRule{affine.matrix, affine.translation};
}

Rule read_formula(TableReader& table, RuleContext const& shared) {
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
  bool axis_used = round;
  for (int c = 0; c < 3; ++c) {
    auto const a = table.string(cartesian[c]), b = table.string(cylindrical[c]);
    std::string const& key = round ? cylindrical[c] : cartesian[c];
    components[c] = {key, round ? b.value_or("") : a.value_or(""), table.where(key)};
    axis_used = axis_used || uses_axis(components[c].expression);
  }
  if (axis_used && !shared.axis)
    table.problem("rule",
                  "the formula uses r, theta or axial, but [mesh] has no axis; add axis = { origin = [0, 0, 0], "
                  "direction = [1, 0, 0] } to [mesh]");
  return make_formula(round ? FormulaFrame::cylindrical : FormulaFrame::cartesian, components, constants,
                      shared.axis.value_or(Axis{}), table.context().problems);
}

std::vector<std::string> read_of(TableReader& table) {
  auto const of = table.strings("of");
  table.require("of", "of = \"blade\", the patches whose motion is taken over");
  return of.value_or(std::vector<std::string>{});
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
  if (auto const* profile = table.find("profile")) {
    if (!round) table.problem("profile", "belongs to surface = \"revolution\"; remove it or change the surface");
    bool good = profile->is_array();
    if (good)
      for (auto const& pair : profile->as_array()) {
        auto const number = [](toml::value const& v) {
          return v.is_integer() ? double(v.as_integer()) : v.as_floating();
        };
        good = pair.is_array() && pair.as_array().size() == 2 &&
               std::all_of(pair.as_array().begin(), pair.as_array().end(),
                           [](toml::value const& v) { return v.is_integer() || v.is_floating(); });
        if (!good) break;
        double const axial = number(pair.as_array()[0]), radius = number(pair.as_array()[1]);
        if (!std::isfinite(axial) || !std::isfinite(radius) || radius < 0)
          table.problem(
              "profile",
              fmt::format("the point [{}, {}] is not [axial, radius] with a radius of zero or more", axial, radius));
        rule.profile.emplace_back(axial, radius);
      }
    if (!good || rule.profile.size() < 2)
      table.problem("profile", "expected at least two points [[axial, radius], [axial, radius], ...]");
  }
  if (round && !shared.axis)
    table.problem("surface",
                  "a surface of revolution needs the machine axis; add axis = { origin = [0, 0, 0], direction = "
                  "[1, 0, 0] } to [mesh]");
  return rule;
}

Rule read_free(TableReader& table, RuleContext const& shared) {
  FreeRule rule;
  if (auto const c = table.choice("constraint", {"none", "axial", "plane"})) rule.constraint = FreeRule::Constraint(*c);
  if (rule.constraint == FreeRule::Constraint::axial && !shared.axis)
    table.problem("constraint", "\"axial\" needs the machine axis; add axis to [mesh]");
  return rule;
}

void needs_axis(TableReader& table, RuleContext const& shared, std::string const& name) {
  if (!shared.axis)
    table.problem("rule",
                  fmt::format("{} needs the machine axis; add axis = {{ origin = [0, 0, 0], direction = [1, 0, 0] }} "
                              "to [mesh]",
                              name));
}

Rule read_rule(std::size_t number, TableReader& table, RuleContext const& shared, CaseFile& out) {
  switch (number) {
    case 1: return read_rigid(table, shared);
    case 2: return read_formula(table, shared);
    case 3: return read_field(table, out);
    case 4: needs_axis(table, shared, rule_names[number]); return CircumferentialSlideRule{read_of(table)};
    case 5: needs_axis(table, shared, rule_names[number]); return FollowRule{read_of(table)};
    case 6: return read_slip(table, shared);
    case 7: return read_free(table, shared);
    case 8: return read_sections(table, shared.axis.has_value());
    case 9: return read_target_rule(table, shared);
    default: return FixedRule{};
  }
}

}  // namespace

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
    if (auto const number = names->number(name)) constants[name] = *number;
    if (!is_free_formula_name(name))
      names->problem(name,
                     "cannot be the name of a constant; use letters, digits and '_', and none of x, y, z, r, theta, "
                     "axial, pi, deg or the functions");
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
  motion.rule = read_rule(std::size_t(known - rule_names.begin()), table, shared, out);
  table.finish();
  out.motion.rules.push_back(std::move(motion));
}

}  // namespace gridmorph::casefile
