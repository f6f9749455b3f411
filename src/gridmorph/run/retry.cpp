// Where a morph, or a step of a sequence, came out short: other recipes for the same motion.
#include <gridmorph/run/run.hpp>

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace gridmorph::cli {

Retried Run::retry(std::vector<Moment> const& moments) {
  Moment const* when = nullptr;
  auto const judged = [&] {
    return Trial{badness_of(result_.quality),
                 newly_inverted(result_.quality) > 0 || any_failure(shortfalls_of(result_.quality))};
  };
  if (!moments.empty()) {
    std::optional<Badness> most;
    for (std::size_t step = 0; step < moments.size(); ++step) {
      console_.progress(fmt::format("looking for the worst step, {} of {}", step + 1, moments.size()));
      (void)morph(&moments[step]);
      measure();
      if (Badness const now = badness_of(result_.quality); !most || *most < now) {
        most = now;
        when = &moments[step];
      }
    }
    (void)morph(when);
    measure();
  }
  Trial const first = judged();
  if (!first.falls_short) return {};

  struct Before {
    Result result;
    std::vector<Vec3> displacement;
    std::unique_ptr<CasePlan> plan;
  };
  std::optional<Before> before;
  bool const elements = result_.quality.unstructured;
  Retried out = RecipeSearch{
      .case_file = case_file_,
      .unstructured = elements,
      .chains = !elements,
      .smoothing = !elements,
      .cells = mesh_->kind().cells,
      .progress = [&](std::string const& keys) { console_.progress("trying " + keys); },
      .make =
          [&](CaseFile const& other) {
            before.emplace(Before{std::move(result_), displacement_, std::exchange(plan_, nullptr)});
            result_ = {Coordinates(mesh_->n_nodes()), {}, {case_file_.output_options.displacement, {}, {}}};
            plan_ = std::make_unique<CasePlan>(*mesh_, other);
            if (other.guard.smooth) freeze_guard(moments);
            (void)morph(when);
            measure();
            return judged();
          },
      .decide =
          [&](std::unique_ptr<CaseFile> kept) {
            if (kept) {
              before.reset();  // the plan before refers to the case file that goes
              recipe_ = std::move(kept);
              return;
            }
            plan_ = std::move(before->plan);
            result_ = std::move(before->result);
            displacement_ = std::move(before->displacement);
          }}.run(first);
  if (when != nullptr && !out.text.empty()) {
    out.json["step"] = when->step;
    out.text = fmt::format("step {}, the worst one: {}", when->step, out.text);
  }
  return out;
}

}  // namespace gridmorph::cli
