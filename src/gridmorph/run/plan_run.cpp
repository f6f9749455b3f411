// `gridmorph plan`: what a case file would do.
#include <gridmorph/core/error.hpp>
#include <gridmorph/report/block_graph_text.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>

namespace gridmorph::cli {

namespace {

bool is_dot(std::filesystem::path const& path) { return path.extension() == ".dot" || path.extension() == ".gv"; }

}  // namespace

void print_plan(CaseFile const& case_file, Console& console, PlanPrinting const& options) {
  auto const& graph = options.graph;
  MeshSource const file =
      checked_mesh_file(case_file, case_file.sequence ? CaseUse::Run::sequence : CaseUse::Run::morph);
  auto const refuse_what_blocks_have = [&] {
    if (graph)
      throw ConfigError(case_file.input.string() + " is unstructured: there are no blocks to draw; leave out --graph");
    if (case_file.plan.volume.order == OrderBy::prediction)
      throw ConfigError(case_file.input.string() +
                        " is unstructured: there are no chains to put in order; leave out --optimise");
  };
  if (file.kind == MeshKind::unstructured && !file.find_blocks) refuse_what_blocks_have();
  if (graph) check_run_files(inputs_of(case_file, file), {{"drawing", *graph}});
  Run run(case_file, file, console);
  if (!run.mesh().is_structured()) refuse_what_blocks_have();
  PlanPrediction const prediction = run.predict();
  for (auto const& warning : prediction.warnings) console.warn(warning);
  for (auto const& s : run.shortfalls_of_motion()) console.warn(s.message);
  RunDocument document = document_of(case_file);
  document.nodes = run.mesh().n_nodes();
  document.times = run.times;
  document.notes = run.plan().notes();
  document.plan = {run.plan().text(options.all), run.plan().json(), prediction};
  if (graph) {
    PendingFile drawing(*graph, is_dot(*graph) ? dot_text(*run.plan().graph()) : svg_text(*run.plan().graph()));
    drawing.commit();
  }
  console.document(run_json(document));
  if (!console.json())
    console.result(run_text(document) + (graph ? fmt::format("wrote {}\n", graph->string()) : std::string()));
}

}  // namespace gridmorph::cli
