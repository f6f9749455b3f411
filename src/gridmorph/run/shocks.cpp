#include <gridmorph/run/shocks.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/read_solution.hpp>
#include <gridmorph/motion/shock/shock_shift.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace gridmorph::cli {

namespace {

/// So that nodes of a plane along which the shock goes stay in it.
Vec3 unit_without_round_off(Vec3 const& v) {
  constexpr double nothing = 1e-9;
  Vec3 out = (1 / norm(v)) * v;
  for (double* c : {&out.x, &out.y, &out.z})
    if (std::abs(*c) < nothing) *c = 0;
  return (1 / norm(out)) * out;
}

class ShockLocator {
 public:
  ShockLocator(CaseFile const& case_file, Mesh const& mesh) : mesh_(mesh), out_{case_file, {}} {}

  LocatedShocks run() {
    for (auto* regions : {&out_.case_file.motion.regions, &out_.case_file.measured_regions})
      for (InnerRegion& region : *regions)
        if (region.shock) attempt(label(region), [&] { locate(region); });
    problems_.throw_if_any<MotionError>();
    for (ShockFollow const& follow : out_.case_file.shock_follows) attempt(follow.where, [&] { take_along(follow); });
    problems_.throw_if_any<MotionError>();
    return std::move(out_);
  }

 private:
  static std::string label(InnerRegion const& region) {
    return "region '" + region.name + "'" + (region.where.empty() ? "" : " (" + region.where + ")");
  }

  template <class Do>
  void attempt(std::string const& what, Do const& act) {
    try {
      act();
    } catch (MachineError const&) {
      throw;
    } catch (Error const& e) {
      problems_.add(what + ": shock: " + e.what());
    }
  }

  /// In a solution on `mesh`.
  [[nodiscard]] ShockCells find(Mesh const& mesh, std::string const& file, std::string const& solution,
                                InnerRegion const& region) const {
    SolutionWanted wanted{shock_variables(*region.shock), solution, out_.case_file.leave_out};
    FlowSolution const flow = read_flow_solution(file, mesh, wanted);
    InnerRegion everywhere = region;
    everywhere.cells.reset();
    return find_shock(mesh, flow, *region.shock, cells_looked_at(mesh, everywhere));
  }

  void locate(InnerRegion& region) {
    bool const own = region.shock->file.empty();
    std::string const file = own ? out_.case_file.input.string() : region.shock->file;
    ShockCells found = find(mesh_, file, region.shock->solution, region);
    out_.notes.push_back("region '" + region.name + "': shock of " + found.summary);
    region.cells = std::make_shared<std::vector<std::uint8_t> const>(std::move(found.cells));
    found.cells.clear();
    found_.insert_or_assign(region.name, std::move(found));
  }

  void take_along(ShockFollow const& follow) {
    MotionRule& rule = out_.case_file.motion.rules[follow.rule];
    Mesh const there = read_mesh(follow.to, {.leave_out = out_.case_file.leave_out});
    std::vector<ShockPoint> from, to;
    Vec3 direction;
    for (InnerRegion const& region : out_.case_file.motion.regions) {
      bool const named = std::any_of(rule.patches.begin(), rule.patches.end(), [&](std::string const& selector) {
        return selector == "type:region" || glob_match(selector, region.name);
      });
      if (!named || !region.shock) continue;
      ShockCells const& old = found_.at(region.name);
      ShockCells const next = find(there, follow.to, follow.solution, region);
      from.insert(from.end(), old.points.begin(), old.points.end());
      to.insert(to.end(), next.points.begin(), next.points.end());
      direction += old.direction;
      out_.notes.push_back(follow.where + ": there the shock is of " + next.summary);
    }
    if (from.empty())
      throw MotionError("the rule names no region with shock = { ... }; name one, which says where the shock is now");
    if (follow.direction) direction = *follow.direction;
    if (!(norm(direction) > 0))
      throw MotionError("the gradients of the shock's cells add up to nothing; give the direction that it goes along");
    direction = unit_without_round_off(direction);
    constexpr double share = 0.1;
    double const extent = extent_across(from, direction);
    double const radius = follow.smooth ? *follow.smooth : extent > 0 ? share * extent : 1;
    auto const shift = std::make_shared<ShockShift const>(from, to, direction, radius);
    out_.notes.push_back(fmt::format("{}: the shock goes by {:.4g} to {:.4g} along {}, smoothed over {:.4g}",
                                     follow.where, shift->least(), shift->greatest(), to_text(direction, 3), radius));
    give(follow.rule, shift);
  }

  void give(std::size_t r, std::shared_ptr<ShockShift const> const& shift) {
    std::get<ShockRule>(out_.case_file.motion.rules[r].rule).shift = shift;
    RuleAt& at = out_.case_file.timed[r].at;
    at = [before = std::move(at), shift](double share, Moment const& when) {
      Rule rule = before(share, when);
      std::get<ShockRule>(rule).shift = shift;
      return rule;
    };
  }

  Mesh const& mesh_;
  LocatedShocks out_;
  std::map<std::string, ShockCells> found_;
  Problems problems_;
};

}  // namespace

LocatedShocks locate_shocks(CaseFile const& case_file, Mesh const& mesh) { return ShockLocator(case_file, mesh).run(); }

}  // namespace gridmorph::cli
