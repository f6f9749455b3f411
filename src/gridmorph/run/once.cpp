// One morph from a case file to a mesh, a report and a page.
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/element_stages.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/run_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>

namespace gridmorph::cli {

namespace {

/// Files that [output] stages writes, as far as they are known before there is a plan: which stages blocks have is not,
/// so of these what is there already, and what has the name of a stage among the other outputs.
RunFiles stage_files(std::filesystem::path const& folder, MeshSource const& file, RunFiles const& others) {
  RunFiles out;
  auto const add = [&](std::filesystem::path const& path) { out.push_back({"stage", path, true}); };
  if (file.kind == MeshKind::unstructured) {
    for (char const* name : stage_names) add(folder / name);
    if (!file.find_blocks) return out;
  }
  add(folder / stage_list_name);
  std::error_code error;
  for (auto const& entry : std::filesystem::directory_iterator(folder, error))
    if (is_stage_of_blocks(entry.path())) add(entry.path());
  std::size_t const n_there = out.size();
  for (RunFile const& other : others) {
    auto const at = folder / other.path.filename();
    bool const is_there = std::any_of(out.begin(), out.begin() + std::ptrdiff_t(n_there),
                                      [&](RunFile const& stage) { return stage.path == at; });
    if (!is_there && is_stage_of_blocks(at)) add(at);
  }
  return out;
}

/// Throws ConfigError when an output or the report cannot be written where it should.
void check_outputs(CaseFile const& case_file, MeshSource const& file) {
  auto const& options = case_file.output_options;
  RunFiles outputs = outputs_of({{"output", case_file.output}}, options);
  if (options.stages) {
    auto const stages = stage_files(*options.stages, file, outputs);
    outputs.insert(outputs.end(), stages.begin(), stages.end());
  }
  if (options.vtk) outputs.push_back({"VTK file", *options.vtk});
  check_run_files(inputs_of(case_file, file), outputs);
}

class Once {
 public:
  Once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed)
      : case_file_(case_file),
        options_(case_file.output_options),
        file_(file),
        console_(console),
        page_(options_.page ? std::make_optional<RunPage>(case_file, typed) : std::nullopt),
        run_(case_file, file, console) {
    if (page_) run_.keep_measures();
  }

  int operator()() {
    morph();
    judge();
    try_steps();
    retry();
    freeze();
    look_at_result();
    written_ = newly_inverted(run_.quality()) == 0 || case_file_.guard.write_inverted;
    if (!written_) find_valid_share();
    draw_page();
    return end();
  }

 private:
  void morph() {
    GuardReport const relaxed = run_.morph(nullptr, &run_.times);
    if (relaxed.before > 0)
      guarded_.notes.push_back(fmt::format("{} {}; displacements around them are smoothed in {} rounds, {} are left",
                                           relaxed.before, run_.mesh().kind().lost, relaxed.rounds, relaxed.after));
    if (relaxed.middles > 0)
      guarded_.notes.push_back(
          fmt::format("{} nodes between corners are pulled where they alone broke elements", relaxed.middles));
  }

  void judge() {
    console_.progress("measuring quality");
    watch_.lap();
    run_.measure_baseline();
    run_.measure();
    run_.times.push_back({"quality", watch_.lap(), true});
  }

  void try_steps() {
    if (newly_inverted(run_.quality()) == 0) return;
    console_.expect({});  // how many steps it will take is not known
    TriedSteps const tried = run_.try_steps();
    guarded_.notes.insert(guarded_.notes.end(), tried.notes.begin(), tried.notes.end());
    if (tried.text.empty()) return;
    guarded_.notes.push_back(tried.text);
    run_.times.push_back({"steps", watch_.lap(), true});
  }

  void retry() {
    if (!run_.wants_retry()) return;
    console_.expect({});
    watch_.lap();
    (void)run_.retry(nullptr, guarded_);
    run_.times.push_back({"retries", watch_.lap(), true});
  }

  void freeze() {
    if (!case_file_.guard.freeze) return;
    watch_.lap();
    run_.freeze_into_plan(guarded_);
    run_.times.push_back({"freeze", watch_.lap(), true});
  }

  void look_at_result() {
    watch_.lap();
    document_ = run_.document(run_.quality(), guarded_);
    document_.mesh->clearances = run_.clearances();
    add_time(document_.times, "quality", watch_.lap());
  }

  void find_valid_share() {
    advice_ = "move the boundary less, " + file_.traits().change;
    ValidShare const share = run_.largest_valid_share();
    if (share.percent > 0)
      advice_ = fmt::format("morph what is valid with --fraction {:.2f}, ", share.percent / 100.0) + advice_;
    std::string const valid =
        fmt::format("valid up to {} % of the motion, every cell of that certified", share.percent) +
        (share.broken.empty() ? "" : fmt::format("; at {} % {}", share.percent + 1, share.broken));
    document_.notes.push_back(valid);
    advice_ = valid + ": " + advice_;
  }

  void draw_page() {
    if (!page_) return;
    console_.progress("drawing the page");
    watch_.lap();
    page_->begin(run_);
    page_->finish(run_, run_.quality());
    document_.times.push_back({"page", watch_.lap()});
  }

  void write() {
    watch_.lap();
    if (written_) {
      run_.mesh().write(case_file_.input, case_file_.output, run_.morphed(),
                        holds_fields(file_.format) ? run_.fields() : OutputFields());
      if (options_.vtk) run_.mesh().write_vtk(*options_.vtk, run_.morphed(), run_.fields());
      add_time(document_.times, "write", watch_.lap());
      if (page_) page_->add_output(case_file_.output);
      if (page_) add_time(document_.times, "page", watch_.lap(), false);
    }
    if (options_.stages) run_.write_stages(*options_.stages);
  }

  int end() {
    if (written_) document_.times.push_back({"write", 0, true});
    std::string const vtk = options_.vtk ? fmt::format("wrote {}\n", options_.vtk->string()) : std::string();
    std::string stages;
    if (options_.stages)
      stages = fmt::format("wrote {} to {}\n",
                           run_.mesh().is_structured() ? "the mesh after every stage" : "wrap and background mesh",
                           options_.stages->string());
    return conclude(
        {.document = document_,
         .options = options_,
         .output = case_file_.output,
         .page = page_,
         .written = written_,
         .write = [&] { write(); },
         .wrote = fmt::format("\nwrote {}\n", case_file_.output.string()) + vtk,
         .also_wrote = stages,
         .refusal = [&] { return run_.refusal_of(case_file_.output, file_.traits().cells + " are", advice_); }},
        console_);
  }

  CaseFile const& case_file_;
  OutputOptions const& options_;
  MeshSource const& file_;
  Console& console_;
  std::optional<RunPage> page_;
  Run run_;
  Stopwatch watch_;
  Guarded guarded_;
  RunDocument document_;
  bool written_ = false;
  std::string advice_;
};

}  // namespace

int morph_once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  check_outputs(case_file, file);
  console.expect(file.traits().costs);
  return Once(case_file, file, console, typed)();
}

}  // namespace gridmorph::cli
