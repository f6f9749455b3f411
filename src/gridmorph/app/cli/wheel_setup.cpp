#include <gridmorph/app/cli/wheel_setup.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/blade_share.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace gridmorph::cli {

namespace {

/// A rule times a factor: rigid motions and sections by their parameters, targets by the way to them; formulas and fields by their
/// displacement in cylindrical components, so that a turn stays a turn. Rules that follow others do so by themselves; walls between
/// which the blades stand are the same for all. False for rules that have nothing to multiply.
bool scale(Rule& rule, TimedRule const& timed, double factor, Axis const& axis) {
  if (!timed.at || timed.end_wall) return false;
  auto const* function = std::get_if<FunctionRule>(&rule);
  if (function == nullptr) {
    rule = timed.at(factor, {});
    return true;
  }
  rule = FunctionRule{fmt::format("{} times {}", factor, function->description),
                      [inner = function->function, axis, factor](std::span<Vec3 const> points, std::span<Vec3> out) {
                        inner(points, out);
                        for (std::size_t n = 0; n < points.size(); ++n)
                          out[n] = share_motion(axis, points[n], {}, out[n], factor);
                      }};
  return true;
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
    for (auto& row : out_.blades)
      if (row.blades.empty()) row.blades.assign(std::size_t(row.passages), motion(-1, 1, {}));
    problems_.throw_if_any<ConfigError>();
    return std::move(out_);
  }

 private:
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
    if (row.passages > rows_.rows[r].passages) {
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
    if (!sequence || !factors) return;
    for (std::size_t p = 0; p < std::size_t(blades.passages); ++p) {
      int blade = -1;
      if (!row.sequence.empty()) {
        auto const& name = row.sequence[p % row.sequence.size()];
        auto const at =
            std::find_if(wheel_.blades.begin(), wheel_.blades.end(), [&](auto const& b) { return b.name == name; });
        blade = int(at - wheel_.blades.begin());
      }
      blades.blades.push_back(motion(blade, row.factors.empty() ? 1 : row.factors[p % row.factors.size()], row.where));
    }
  }

  /// Number of a blade's motion; equal blades have one. where: of the row that asks for it.
  int motion(int blade, double factor, std::string where) {
    auto const [at, fresh] = known_.try_emplace({blade, factor}, int(out_.motions.size()));
    if (!fresh) return at->second;
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
    if (all != 1 && !scale_all(made, timed, all) && !stands)
      problems_.add(where +
                    ": the factor has nothing to multiply; give the blade a rule rigid, formula, field, sections or "
                    "target in [[motion]] or [[wheel.blade.motion]]");
    out_.motions.push_back(std::move(made));
    out_.names.push_back(std::move(name));
    return at->second;
  }

  static bool scale_all(Motion& motion, std::vector<TimedRule> const& timed, double factor) {
    bool any = false;
    for (std::size_t r = 0; r < motion.rules.size(); ++r)
      any = scale(motion.rules[r].rule, timed[r], factor, motion.axis) || any;
    return any;
  }

  void replace(Motion& motion, std::vector<TimedRule>& timed, MotionRule const& rule, TimedRule const& own) {
    auto const patches = patches_of(mesh_, rule.patches);
    for (std::size_t r = 0; r < motion.rules.size(); ++r) {
      if (patches.empty() || patches_of(mesh_, case_.motion.rules[r].patches) != patches) continue;
      Rule& base = motion.rules[r].rule;
      if (std::holds_alternative<FixedRule>(base) || (timed[r].at && !timed[r].end_wall)) {
        // A near field of fixed walls would be another plan.
        base = std::holds_alternative<FixedRule>(rule.rule)
                   ? Rule(FunctionRule{"fixed",
                                       [](auto, std::span<Vec3> out) { std::fill(out.begin(), out.end(), Vec3{}); }})
                   : rule.rule;
        motion.rules[r].where = rule.where;
        timed[r] = own;
        return;
      }
    }
    problems_.add(
        fmt::format("{}: patches {} are those of no rule fixed, rigid, formula, field, sections or target in "
                    "[[motion]]; a blade replaces "
                    "such a rule with the same patches",
                    rule.where, quote_list(rule.patches)));
  }

  CaseFile const& case_;
  WheelCase const& wheel_;
  Mesh const& mesh_;
  WheelRows const& rows_;
  WheelSetup out_;
  std::map<std::pair<int, double>, int> known_;
  Problems problems_;
};

}  // namespace

std::vector<int> WheelSetup::passages() const {
  std::vector<int> out;
  for (auto const& row : blades) out.push_back(row.passages);
  return out;
}

WheelSetup wheel_setup(CaseFile const& case_file, Mesh const& mesh, WheelRows const& rows) {
  return Setup(case_file, mesh, rows).run();
}

}  // namespace gridmorph::cli
