#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/wheel_setup.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace gridmorph::cli {

namespace {

/// Walls between which the blades stand are the same for all, and rules that follow others do so by themselves.
bool is_of_blade(TimedRule const& timed) { return timed.at && !timed.end_wall; }

/// A rule times a factor: rigid motions and sections by their parameters,
/// targets by the way to them; formulas and fields by their displacement in the
/// components that neighbours share, so that in a wheel a turn stays a turn.
Rule scaled(TimedRule const& timed, std::string const& where, Moment const& when, double factor,
            RowPitch const& pitch) {
  Rule rule = rule_at(timed, where, when);
  auto const* function = std::get_if<FunctionRule>(&rule);
  if (function == nullptr) return rule_at(timed, where, when, factor);
  return FunctionRule{fmt::format("{} times {}", factor, function->description),
                      [inner = function->function, pitch, factor](std::span<Vec3 const> points, std::span<Vec3> out) {
                        inner(points, out);
                        for (std::size_t n = 0; n < points.size(); ++n)
                          out[n] = pitch.share_motion(points[n], {}, out[n], factor);
                      }};
}

/// What a wall does that stands in this passage and moves in others.
FunctionRule standing() {
  return {"fixed", [](auto, std::span<Vec3> out) { std::fill(out.begin(), out.end(), Vec3{}); }};
}

std::vector<int> patches_of(Mesh const& mesh, std::vector<std::string> const& selectors) {
  std::vector<int> out;
  for (auto const& selector : selectors) {
    auto const found = select(mesh, selector).patches;
    out.insert(out.end(), found.begin(), found.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

class Setup {
 public:
  Setup(CaseFile const& case_file, Mesh const& mesh, WheelRows const& rows)
      : case_(case_file), wheel_(*case_file.wheel), mesh_(mesh), rows_(rows) {}

  WheelSetup run() {
    out_.pitch = rows_.any_pitch(case_.motion.axis);
    if (auto const& sequence = case_.sequence) {
      out_.period = sequence->period;
      for (int step = 0; step < sequence->steps; ++step) out_.moments.push_back(sequence->moment(step));
    } else {
      out_.moments.emplace_back();
    }
    for (auto const& row : rows_.rows) out_.blades.push_back({row.passages, {}});
    std::vector<WheelRowCase const*> taken(rows_.rows.size(), nullptr);
    for (auto const& row : wheel_.rows) {
      bool any = false;
      for (int r = 0; r < int(rows_.rows.size()); ++r) {
        if (!rows_.rows[r].periodic() || !names(row, r)) continue;
        any = true;
        if (std::exchange(taken[r], &row) != nullptr)
          problems_.add(row.where + ": zones: the row of zone '" + mesh_.zones[rows_.rows[r].zones.front()].name +
                        "' is named by another [[wheel.row]] too");
        place(row, r);
      }
      if (!any)
        problems_.add(row.where + ": zones: names no zone of a row with periodic interfaces; there are " +
                      periodic_zones());
    }
    for (int r = 0; r < int(rows_.rows.size()); ++r)
      if (taken[r] == nullptr) (void)need_number(r, wheel_.rows.front().where);
    for (auto& row : out_.blades)
      if (row.blades.empty()) row.blades.assign(row.passages, motion(-1, 1, {}, {}));
    problems_.throw_if_any<ConfigError>();
    stand_where_others_move();
    return std::move(out_);
  }

 private:
  /// Whether row r has no number of its own, which is a problem where the case
  /// file gives none.
  bool need_number(int r, std::string const& where) {
    if (!rows_.rows[r].pitch.is_straight()) return false;
    problems_.add(
        fmt::format("{}: passages: is missing, and the row of zone '{}' is straight (its "
                    "periodic sides are shifted, not turned), "
                    "so that nothing says how many blades it has; add passages = 5, say",
                    where, mesh_.zones[rows_.rows[r].zones.front()].name));
    return true;
  }

  /// How many blades stand round the wheel, or in one period of a straight row.
  [[nodiscard]] int round_of(int r) const {
    return rows_.rows[r].pitch.is_straight() ? out_.blades[r].passages : rows_.rows[r].passages;
  }

  [[nodiscard]] bool names(WheelRowCase const& row, int r) const {
    auto const& zones = rows_.rows[r].zones;
    return row.zones.empty() || std::any_of(zones.begin(), zones.end(), [&](int z) {
             return std::any_of(row.zones.begin(), row.zones.end(),
                                [&](auto const& pattern) { return glob_match(pattern, mesh_.zones[z].name); });
           });
  }

  [[nodiscard]] std::string periodic_zones() const {
    std::vector<std::string> out;
    for (auto const& row : rows_.rows)
      if (row.periodic())
        for (int const z : row.zones) out.push_back(mesh_.zones[z].name);
    return out.empty() ? "none" : quote_list(out);
  }

  void place(WheelRowCase const& row, int r) {
    WheelRowBlades& blades = out_.blades[r];
    std::string const zone = mesh_.zones[rows_.rows[r].zones.front()].name;
    if (row.passages == 0 && need_number(r, row.where)) return;
    if (!rows_.rows[r].pitch.is_straight() && row.passages > rows_.rows[r].passages) {
      problems_.add(fmt::format("{}: passages: {} asked for, but the row of zone '{}' has {} in 360 degrees", row.where,
                                row.passages, zone, rows_.rows[r].passages));
      return;
    }
    if (row.passages > 0) blades.passages = row.passages;
    auto const fits = [&](std::size_t length, char const* key) {
      if (length == 0 || std::size_t(blades.passages) % length == 0) return true;
      problems_.add(
          fmt::format("{}: {}: has {} entries, which do not go evenly into the {} passages of the row of zone '{}'",
                      row.where, key, length, blades.passages, zone));
      return false;
    };
    bool const sequence = fits(row.sequence.size(), "sequence"), factors = fits(row.factors.size(), "factors");
    bool const wave = !row.nodal_diameters || fits_wave(row, r, blades.passages);
    if (!sequence || !factors || !wave) return;
    int const whole = round_of(r), diameters = row.nodal_diameters.value_or(0);
    for (std::size_t p = 0; p < std::size_t(blades.passages); ++p) {
      int blade = -1;
      if (!row.sequence.empty()) {
        auto const& name = row.sequence[p % row.sequence.size()];
        auto const at =
            std::find_if(wheel_.blades.begin(), wheel_.blades.end(), [&](auto const& b) { return b.name == name; });
        blade = int(at - wheel_.blades.begin());
      }
      // Parts of a turn as whole numbers, so that passages in phase have one motion.
      int const turned = int(((std::int64_t(p) * diameters) % whole + whole) % whole);
      int const part = std::gcd(turned, whole);
      blades.blades.push_back(motion(blade, row.factors.empty() ? 1 : row.factors[p % row.factors.size()],
                                     {turned / part, whole / part}, row.where));
    }
    if (diameters == 0) return;
    bool const moves = std::any_of(blades.blades.begin(), blades.blades.end(), [&](int m) {
      auto const& one = out_.motions[m];
      for (std::size_t n = 0; n < one.timed.size(); ++n)
        if (one.timed[n].changes && is_of_blade(one.timed[n]) && is_in_row(one.motion.rules[n], r)) return true;
      return false;
    });
    if (!moves)
      problems_.add(fmt::format(
          "{}: nodal_diameters: no blade of the row of zone '{}' moves with time, so that there is no wave; give its "
          "rule modes, an amplitude over time or t in a formula, or remove the key",
          row.where_diameters, zone));
  }

  [[nodiscard]] bool is_in_row(MotionRule const& rule, int r) const {
    auto const patches = patches_of(mesh_, rule.patches);
    return std::any_of(patches.begin(), patches.end(),
                       [&](int p) { return rows_.row_of_zone[mesh_.patches[p].zone] == r; });
  }

  /// A wave of so many nodal diameters round the wheel.
  bool fits_wave(WheelRowCase const& row, int r, int passages) {
    int const whole = round_of(r), diameters = *row.nodal_diameters;
    std::string const zone = mesh_.zones[rows_.rows[r].zones.front()].name;
    if (2 * std::abs(std::int64_t(diameters)) > whole) {
      int const alias = int(std::remainder(double(diameters), double(whole)));
      problems_.add(
          fmt::format("{}: nodal_diameters: the row of zone '{}' has {} blades, which tell waves of {} to {} nodal "
                      "diameters apart, "
                      "found {}; to these blades that is {}",
                      row.where_diameters, zone, whole, -(whole / 2), whole / 2, diameters, alias));
      return false;
    }
    int const wave = whole / std::gcd(diameters, whole);
    if (passages % wave == 0) return true;
    problems_.add(fmt::format(
        "{}: nodal_diameters: the ends of {} of {} passages do not match in a wave of {} nodal diameters; use "
        "passages = {} or a multiple of it",
        row.where_diameters, passages, whole, diameters, wave));
    return false;
  }

  /// A near field of fixed walls would be another plan.
  void stand_where_others_move() {
    for (std::size_t r = 0; r < case_.motion.rules.size(); ++r) {
      auto const is_fixed = [&](WheelBladeMotion const& m) {
        return std::holds_alternative<FixedRule>(m.motion.rules[r].rule);
      };
      if (std::all_of(out_.motions.begin(), out_.motions.end(), is_fixed)) continue;
      for (auto& m : out_.motions)
        if (is_fixed(m)) m.motion.rules[r].rule = standing();
    }
  }

  struct Ahead {
    int turned = 0, of = 1;
    auto operator<=>(Ahead const&) const = default;
  };

  /// Number of a blade's motion; equal blades have one. where: of the row that asks for it.
  int motion(int blade, double factor, Ahead ahead, std::string where) {
    auto const [at, fresh] = known_.try_emplace({blade, factor, ahead}, int(out_.motions.size()));
    if (!fresh) return at->second;
    int const number = at->second;
    int same_rules = number;
    for (auto const& [key, other] : known_)
      if (std::get<0>(key) == blade && std::get<1>(key) == factor) same_rules = std::min(same_rules, other);
    Motion made = case_.motion;
    std::vector<TimedRule> timed = case_.timed;
    std::string name;
    double all = factor;
    bool stands = false;
    if (blade >= 0) {
      WheelBlade const& own = wheel_.blades[blade];
      name = own.name;
      all *= own.factor;
      if (own.factor != 1) where = own.where;
      stands = std::any_of(own.rules.begin(), own.rules.end(),
                           [](MotionRule const& r) { return std::holds_alternative<FixedRule>(r.rule); });
      for (std::size_t r = 0; r < own.rules.size(); ++r) replace(made, timed, own.rules[r], own.timed[r]);
    }
    if (factor != 1) name += fmt::format("{}x {:g}", name.empty() ? "" : " ", factor);
    if (ahead.turned != 0) name += fmt::format("{}{:g} deg", name.empty() ? "" : " ", 360.0 * ahead.turned / ahead.of);
    if (all != 1 && !stands && std::none_of(timed.begin(), timed.end(), is_of_blade))
      problems_.add(where +
                    ": the factor has nothing to multiply; give the blade a rule rigid, formula, field, sections or "
                    "target in [[motion]] or [[wheel.blade.motion]]");
    out_.motions.push_back(
        {std::move(made), std::move(timed), all, double(ahead.turned) / ahead.of, same_rules, std::move(name)});
    return number;
  }

  void replace(Motion& motion, std::vector<TimedRule>& timed, MotionRule const& rule, TimedRule const& own) {
    auto const patches = patches_of(mesh_, rule.patches);
    for (std::size_t r = 0; r < motion.rules.size(); ++r) {
      if (patches.empty() || patches_of(mesh_, case_.motion.rules[r].patches) != patches) continue;
      Rule& base = motion.rules[r].rule;
      if (std::holds_alternative<FixedRule>(base) || (timed[r].at && !timed[r].end_wall)) {
        base = std::holds_alternative<FixedRule>(rule.rule) ? Rule(standing()) : rule.rule;
        motion.rules[r].where = rule.where;
        timed[r] = own;
        return;
      }
    }
    problems_.add(
        fmt::format("{}: patches {} are those of no rule fixed, rigid, formula, field, sections, target, inflate, "
                    "bulb or ffd in [[motion]]; a blade replaces such a rule with the same patches",
                    rule.where, quote_list(rule.patches)));
  }

  CaseFile const& case_;
  WheelCase const& wheel_;
  Mesh const& mesh_;
  WheelRows const& rows_;
  WheelSetup out_;
  std::map<std::tuple<int, double, Ahead>, int> known_;
  Problems problems_;
};

}  // namespace

std::vector<int> WheelSetup::passages() const {
  std::vector<int> out;
  for (auto const& row : blades) out.push_back(row.passages);
  return out;
}

SameRules WheelSetup::same_rules() const {
  SameRules out;
  for (auto const& motion : motions) out.push_back(motion.same_rules);
  return out;
}

bool WheelSetup::has_wave() const {
  return std::any_of(motions.begin(), motions.end(), [](auto const& m) { return m.ahead != 0; });
}

std::vector<Motion> WheelSetup::at(Moment const& when) const {
  std::vector<Motion> out;
  for (int m = 0; m < int(motions.size()); ++m) out.push_back(at(m, when));
  return out;
}

Motion WheelSetup::at(int number, Moment const& when) const {
  WheelBladeMotion const& m = motions[number];
  Motion out = m.motion;
  Moment const own{when.periods + m.ahead, when.time + m.ahead * period, when.step};
  for (std::size_t r = 0; r < m.timed.size(); ++r) {
    TimedRule const& timed = m.timed[r];
    if (!timed.at) continue;
    std::string const& where = out.rules[r].where;
    if (!timed.end_wall && m.factor != 1)
      out.rules[r].rule = scaled(timed, where, own, m.factor, pitch);
    else if (timed.changes)
      out.rules[r].rule = rule_at(timed, where, timed.end_wall ? when : own);
  }
  return out;
}

WheelSetup wheel_setup(CaseFile const& case_file, Mesh const& mesh, WheelRows const& rows) {
  return Setup(case_file, mesh, rows).run();
}

}  // namespace gridmorph::cli
