#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/run/wheel_page.hpp>

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
        PatchKind const kind = mesh.patches[p].kind;
        if (kind == PatchKind::wall || kind == PatchKind::other) out.wall[p] = 1;
      }
    } catch (MotionError const&) {  // of connections alone, which are no walls
    }
  }
  return out;
}

}  // namespace

void draw_wheel_page(WheelRun const& run, CaseFile const& case_file, Coordinates const& worst, RunDocument& document,
                     RunPage& page, Console& console) {
  console.progress("drawing the page");
  Stopwatch watch;
  Mesh const& mesh = run.sector().mesh();
  page.begin_passage(run.sector().loaded().pictures(), roles_of_passage(mesh, case_file.motion), mesh.coordinates);
  auto const& passages = document.wheel->passages;
  page.finish_passage({mesh.coordinates, worst, run.near(), {}}, passages[worst_passage(passages)].quality,
                      run.sector().loaded().kind().cells);
  document.times.push_back({"page", watch.lap()});
}

}  // namespace gridmorph::cli
