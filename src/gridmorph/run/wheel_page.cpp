#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/wheel_page.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>

namespace gridmorph::cli {

namespace {

/// Whether a rule has a displacement of its own that is more than none.
bool moves_by_itself(Rule const& rule) {
  return !std::holds_alternative<FixedRule>(rule) && !std::holds_alternative<CircumferentialSlideRule>(rule) &&
         !std::holds_alternative<FollowRule>(rule) && !std::holds_alternative<SlipRule>(rule) &&
         !std::holds_alternative<FreeRule>(rule);
}

/// Walls that rules move, and the others. Blades of [wheel] have the patches that [[motion]] has.
PatchRoles roles_of_passage(Mesh const& mesh, Motion const& motion) {
  PatchRoles out{std::vector<signed char>(mesh.patches.size(), -1)};
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (mesh.patches[p].kind == PatchKind::wall) out.wall[p] = 0;
  for (MotionRule const& rule : motion.rules) {
    if (!moves_by_itself(rule.rule)) continue;
    try {
      for (int const p : select_patches(mesh, rule.patches)) {
        PatchKind const kind = mesh.patches[std::size_t(p)].kind;
        if (kind == PatchKind::wall || kind == PatchKind::other) out.wall[std::size_t(p)] = 1;
      }
    } catch (MotionError const&) {  // of connections alone, which are no walls
    }
  }
  return out;
}

}  // namespace

void draw_wheel_page(WheelRun const& run, CaseFile const& case_file, WheelResult& result, RunPage& page,
                     Console& console) {
  console.progress("drawing the page");
  Stopwatch watch;
  Mesh const& mesh = run.sector().mesh();
  WorstPassage const& worst = *result.worst;
  page.begin_passage(run.sector().loaded().pictures(), roles_of_passage(mesh, case_file.motion), mesh.coordinates);
  page.finish_passage({mesh.coordinates, worst.morphed, run.near(), {}},
                      result.passages[std::size_t(worst.passage)].quality, run.sector().loaded().kind().cells);
  result.times.push_back({"page", watch.lap()});
}

nlohmann::json wheel_page_json(CaseFile const& case_file, WheelResult const& result, nlohmann::json const& report) {
  auto const worst = std::size_t(result.worst->passage);
  nlohmann::json json = quality_json(result.baseline, result.passages[worst].quality, thresholds_of(case_file));
  for (char const* key : {"gridmorph", "case_file", "input", "output", "nodes", "times", "notes"})
    json[key] = report[key];
  json["morphed"]["certificate"] = report["certificate"];
  std::string step;
  if (report.contains("sequence")) {
    json["sequence"] = report["sequence"];
    step = fmt::format("step {}, ", report["sequence"]["worst_step"].get<int>());
  }
  json["shortfalls"] = nlohmann::json::array();
  for (auto const& passage : report["passages"])
    for (auto shortfall : passage["shortfalls"]) {
      shortfall["message"] =
          fmt::format("{}passage {}: {}", step, passage["passage"].get<int>(), shortfall["message"].get<std::string>());
      json["shortfalls"].push_back(std::move(shortfall));
    }
  json["wheel"] = {{"passages", report["passages"]},
                   {"rows", report["rows"]},
                   {"worst_passage", worst + 1},
                   {"largest_seam_gap", report["largest_seam_gap"]}};
  return json;
}

}  // namespace gridmorph::cli
