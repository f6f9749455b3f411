#include <gridmorph/case/ignored_keys.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Notes each given key that has no effect.
class Ignored {
 public:
  Ignored(CaseFile const& case_file, CaseUse const& use) : case_(case_file), use_(use) {}

  void run() {
    if (use_.unstructured)
      of_unstructured();
    else
      of_structured();
    if (use_.run == CaseUse::Run::wheel) of_wheel();
    if (use_.run == CaseUse::Run::sequence) refuse("output", "stages", "is for one morph, and a sequence writes none");
    bool const is_sweep = case_.sequence && case_.sequence->is_sweep();
    if (use_.run == CaseUse::Run::sequence)
      refuse("mesh", "output",
             fmt::format("names one file, and the meshes of a {0} go where output in [{0}] says",
                         is_sweep ? "sweep" : "sequence"));
    if ((!case_.sequence || is_sweep) && !(use_.run == CaseUse::Run::wheel && has_wave()))
      refuse("motion modes", "harmonic", "says how often a shape oscillates in time, and there is no [sequence]");
    fields();
    std::stable_sort(lines_.begin(), lines_.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    Problems problems;
    for (auto const& [line, text] : lines_) problems.add(text);
    problems.throw_if_any<ConfigError>();
  }

 private:
  [[nodiscard]] bool has_wave() const {
    return case_.wheel && std::any_of(case_.wheel->rows.begin(), case_.wheel->rows.end(),
                                      [](WheelRowCase const& row) { return row.nodal_diameters.value_or(0) != 0; });
  }

  void of_unstructured() {
    std::string const why = "is for structured meshes, and '" + case_.input.string() + "' is unstructured";
    refuse("", "volume", why + ": law in [background] and weights in [near_field] say there how the volume follows");
    if (!case_.plan.default_boundary_layer)
      refuse("", "boundary_layer", "is false, which is for structured meshes: elements have columns off moving walls");
    refuse("mesh", "open_faces", why + ": boundary faces that no patch claims have to be given one in the mesh");
    refuse("mesh", "matching_tolerance", why + ": connections pair nodes there, which are taken as they are paired");
    refuse("guard", "smooth", why + ": elements that come out bad are always smoothed around");
    if (case_.background)
      refuse("guard", "steps",
             "plans every step on the mesh before it, and the background mesh of a file fits the first only");
  }

  void of_structured() {
    std::string const why =
        "is for unstructured meshes, and '" + case_.input.string() +
        (use_.found_blocks ? "' is morphed as the blocks found in it (blocks = \"off\" in [mesh] prevents that)"
                           : "' is structured");
    if (!use_.found_blocks) refuse("mesh", "blocks", why + ": it is blocks already");
    refuse("", "near_field", why + ": [boundary_layer] says there how far the near field reaches");
    refuse("", "background", why + ": law in [volume] says there how displacements fall off");
    refuse("guard", "steps", why + ": displacements follow grid lines there, and steps add up to what one gives");
    if (case_.guard.smooth) return;
    if (use_.run == CaseUse::Run::wheel)
      refuse("guard", "freeze", "keeps what smooth does, which is not true; use smooth = true");
    else if (!case_.guard.retry.value_or(false))
      refuse("guard", "freeze", "keeps what smooth or retry do, and neither is true; use smooth = true");
  }

  void of_wheel() {
    if (case_.find_blocks.value_or(false))
      refuse("mesh", "blocks", "is for `gridmorph morph`, and wheels take a mesh as it is");
    refuse("", "region", "is for `gridmorph morph`, and passages of a wheel are morphed without regions");
    refuse("", "sweep", "is for `gridmorph morph`: a wheel has one design, with --set another one");
    std::string const why = "is for `gridmorph morph`, and passages of a wheel have one plan";
    if (use_.unstructured && !case_.background) refuse("guard", "steps", why);
    refuse("output", "stages", why);
    if (case_.plan.volume.order == OrderBy::prediction)
      refuse("volume", "order", "is for `gridmorph morph`, and chains of a wheel, whose blades differ, go by priority");
    if (case_.plan.volume.laws_by_prediction)
      refuse("volume", "law", "is \"prediction\", for `gridmorph morph`, and blades of a wheel differ; name a law");
    if (case_.output_options.displacement) refuse("output", "displacement", "is not written into wheels");
    if (case_.output_options.quality) refuse("output", "quality", "is not written into wheels; the report has it");
  }

  /// What has no place in the format of the output.
  void fields() {
    if (use_.run != CaseUse::Run::morph)
      refuse("output", "vtk", "is for one morph; use output = \"step_{step}.vtu\" with a mesh that is a VTK file");
    if (use_.format == CaseUse::Format::cgns) return;
    refuse("mesh", "leave_out", "names bases and zones of CGNS files");
    if (use_.format == CaseUse::Format::vtk || case_.output_options.vtk) return;
    std::string const why = fmt::format(
        "is true, and {} files have no place for solutions; use vtk = \"mesh.vtu\" beside it, or a CGNS or VTK mesh",
        to_string(use_.format));
    if (case_.output_options.displacement) refuse("output", "displacement", why);
    if (case_.output_options.quality) refuse("output", "quality", why);
  }

  void refuse(std::string_view table, std::string_view key, std::string const& why) {
    for (auto const& given : case_.given) {
      if (given.table != table || given.key != key) continue;
      std::string const name = table.empty()                 ? fmt::format("[{}]", key)
                               : table.starts_with("motion") ? fmt::format("[[motion]]{} {}", table.substr(6), key)
                                                             : fmt::format("[{}] {}", table, key);
      std::string const advice = why.find("; use ") == std::string::npos ? "; remove it" : "";
      lines_.emplace_back(given.line, fmt::format("{}:{}: {} has no effect here: it {}{}", case_.source.string(),
                                                  given.line, name, why, advice));
    }
  }

  CaseFile const& case_;
  CaseUse const& use_;
  std::vector<std::pair<int, std::string>> lines_;
};

}  // namespace

std::string why_elements(CaseFile const& case_file) {
  if (case_file.find_blocks) return *case_file.find_blocks ? "" : "[mesh] blocks is \"off\"";
  auto const of_elements = [](GivenKey const& k) {
    return (k.table.empty() && (k.key == "near_field" || k.key == "background")) ||
           (k.table == "guard" && k.key == "steps");
  };
  auto const key = std::find_if(case_file.given.begin(), case_file.given.end(), of_elements);
  if (key != case_file.given.end())
    return fmt::format("{}:{}: [{}] {}is for elements", case_file.source.string(), key->line,
                       key->table.empty() ? key->key : key->table, key->table.empty() ? "" : key->key + " ");
  if (!case_file.shock_follows.empty()) return "the flow of a shock is solved on the elements";
  for (auto const* regions : {&case_file.motion.regions, &case_file.measured_regions})
    for (InnerRegion const& region : *regions) {
      if (!region.zones.empty()) return fmt::format("{}: zones of a region are those of elements", region.where);
      if (region.shock || region.cells) return "the flow of a shock is solved on the elements";
    }
  return "";
}

void refuse_ignored_keys(CaseFile const& case_file, CaseUse const& use) { Ignored(case_file, use).run(); }

}  // namespace gridmorph
