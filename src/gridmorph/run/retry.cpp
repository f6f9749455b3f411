// Where a morph, or a step of a sequence, came out short: other recipes for the same motion.
#include <gridmorph/run/run.hpp>

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace gridmorph::cli {

/// Inverted cells are what is mended unasked; who asks wants the limits kept too.
bool Run::falls_short(QualityReport const& quality) const {
  return newly_inverted(quality) > 0 || (case_file_.guard.retry.value_or(false) && any_failure(shortfalls_of(quality)));
}

bool Run::wants_retry() const {
  if (!falls_short(result_.quality)) return false;
  GuardOptions const& guard = case_file_.guard;
  if (guard.retry) return *guard.retry;
  return mesh_->is_structured() && !guard.write_inverted &&
         likely_causes(case_file_, plan_->for_messages(), result_.morphed).empty();
}

bool Run::retry(Moment const* when, Guarded& guarded, std::vector<Moment> const& moments) {
  struct Before {
    Result result;
    std::vector<Vec3> displacement;
    std::unique_ptr<CasePlan> plan;
  };
  std::optional<Before> before;
  bool const elements = result_.quality.unstructured;
  auto const judged = [&] { return Trial{badness_of(result_.quality), falls_short(result_.quality)}; };
  bool kept_any = false;
  Retried tried = RecipeSearch{
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
              kept_any = true;
              return;
            }
            plan_ = std::move(before->plan);
            result_ = std::move(before->result);
            displacement_ = std::move(before->displacement);
          }}.run(judged());
  if (when != nullptr && !tried.text.empty()) {
    tried.json["step"] = when->step;
    tried.text = fmt::format("step {}, the worst one: {}", when->step, tried.text);
  }
  if (!tried.json["tried"].empty()) guarded.json["retry"] = std::move(tried.json);
  if (!tried.text.empty()) guarded.notes.push_back(std::move(tried.text));
  return kept_any;
}

}  // namespace gridmorph::cli
