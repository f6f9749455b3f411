#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/morph/design_modes.hpp>
#include <gridmorph/quality/design_box.hpp>
#include <gridmorph/report/json_text.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/run/certify_run.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::cli {

namespace {

using nlohmann::json;

/// The parameters with a range, which make the box.
class Ranges {
 public:
  explicit Ranges(std::vector<Parameter> const& parameters) {
    for (Parameter const& p : parameters)
      if (p.range) {
        of_.push_back(p);
        low.push_back(p.range->front());
        high.push_back(p.range->back());
      }
  }

  std::vector<double> low, high;

  [[nodiscard]] std::vector<Parameter> const& parameters() const { return of_; }
  /// A place in the box, -1 ... 1 in each direction, as values of parameters.
  [[nodiscard]] double value(std::size_t i, double t) const {
    return 0.5 * (low[i] + high[i]) + 0.5 * t * (high[i] - low[i]);
  }
  [[nodiscard]] ParameterValues middle() const {
    ParameterValues out;
    for (std::size_t i = 0; i < of_.size(); ++i) out[of_[i].name] = value(i, 0);
    return out;
  }
  [[nodiscard]] ParameterValues named(std::span<double const> p) const {
    ParameterValues out;
    for (std::size_t i = 0; i < of_.size(); ++i) out[of_[i].name] = p[i];
    return out;
  }
  [[nodiscard]] ParameterValues at(std::vector<double> const& t) const {
    ParameterValues out;
    for (std::size_t i = 0; i < of_.size(); ++i) out[of_[i].name] = value(i, t[i]);
    return out;
  }

 private:
  std::vector<Parameter> of_;
};

std::string listed(ParameterValues const& values) {
  std::string out;
  for (auto const& [name, value] : values) out += fmt::format("{}{} = {:.6g}", out.empty() ? "" : ", ", name, value);
  return out;
}

std::string place_text(Mesh const& mesh, DesignBox const& found) {
  if (found.zone < 0) return "";
  std::string const& zone = mesh.zones[std::size_t(found.zone)].name;
  return mesh.is_structured() ? describe_cell(zone, found.cell)
                              : fmt::format("zone '{}' element {}", zone, found.cell[0] + 1);
}

json box_json(Ranges const& box, Mesh const& mesh, DesignBox const& found) {
  json parameters = json::object();
  for (std::size_t i = 0; i < box.parameters().size(); ++i) {
    Parameter const& p = box.parameters()[i];
    parameters[p.name] = {{"unit", p.unit.empty() ? json() : json(p.unit)},
                          {"range", {box.low[i], box.high[i]}},
                          {"certified", {box.value(i, -found.certified), box.value(i, found.certified)}}};
  }
  json worst;
  if (found.zone >= 0) {
    worst = {{"zone", mesh.zones[std::size_t(found.zone)].name}};
    if (mesh.is_structured())
      worst["cell"] = {found.cell[0] + 1, found.cell[1] + 1, found.cell[2] + 1};
    else
      worst["element"] = found.cell[0] + 1;
  }
  return {{"parameters", parameters},
          {"certified", found.certified},
          {"holds", found.holds()},
          {"broken", std::isfinite(found.broken) ? json(found.broken) : json()},
          {"design", found.design.empty() ? json() : json(box.at(found.design))},
          {"worst", worst},
          {"cells", found.cells},
          {"negative", found.negative},
          {"flat", found.flat},
          {"by_slopes", found.by_slopes},
          {"searched", found.searched}};
}

std::string box_text(Ranges const& box, Mesh const& mesh, DesignBox const& found, double limit) {
  std::string text =
      fmt::format("{:<20}  {:>12}  {:>12}  {:>12}  {:>12}  unit\n", "parameter", "from", "to", "certified", "to");
  for (std::size_t i = 0; i < box.parameters().size(); ++i)
    text += fmt::format("{:<20}  {:>12.6g}  {:>12.6g}  {:>12.6g}  {:>12.6g}  {}\n", box.parameters()[i].name,
                        box.low[i], box.high[i], box.value(i, -found.certified), box.value(i, found.certified),
                        box.parameters()[i].unit);
  std::string const cells = mesh.is_structured() ? "cells" : "elements";
  text += fmt::format(
      "\n{}: {:.1f} % of the box about its middle; in no design of that is any of {} {} inverted, anywhere "
      "in it\n",
      found.holds() ? "CERTIFIED" : "CERTIFIED IN PART", 100 * found.certified, found.cells, cells);
  if (!found.design.empty())
    text += fmt::format("beyond: {} ({:.1f} %) turns {} inside out\n", listed(box.at(found.design)), 100 * found.broken,
                        place_text(mesh, found));
  else if (found.certified < limit)
    text += fmt::format("beyond: no design is known that turns a cell inside out; {} could not be decided\n",
                        place_text(mesh, found));
  if (found.negative + found.flat > 0)
    text += fmt::format("left out: {} {} that are inside out in the mesh itself, {} without volume there\n",
                        found.negative, cells, found.flat);
  return text + fmt::format("looked at: {} {} by norms, {} by slopes too, {} by parts of the box\n", found.cells, cells,
                            found.by_slopes, found.searched);
}

}  // namespace

bool certify_case(CaseDocument const& document, CertifyOptions const& options, Console& console) {
  CaseFile as_given = read_case_file(document, options.values);
  std::string const who = as_given.source.string() + ": ";
  Ranges const box(as_given.parameters);
  if (box.parameters().empty())
    throw ConfigError(who +
                      "no parameter has a range, which is what is certified; write lean = { value = 0, range = "
                      "[-0.1, 0.1] } in [parameters]");
  if (as_given.sequence && !as_given.sequence->is_sweep())
    throw ConfigError(who + "[sequence] makes meshes over time, and a box of designs has none; remove it");
  ParameterValues values = options.values;
  for (auto const& [name, value] : box.middle()) values[name] = value;
  CaseFile case_file = read_case_file(document, values);
  case_file.sequence.reset();
  if (options.report)
    check_run_files(inputs_of(case_file, checked_mesh_file(case_file, CaseUse::Run::morph)),
                    {{"report", *options.report}});
  Run run(case_file, checked_mesh_file(case_file, CaseUse::Run::morph), console);
  Stopwatch watch;
  console.progress("making the meshes of the ends of the ranges");
  DesignModes modes;
  try {
    modes = design_modes(
        run.plan().morph_plan(), run.mesh().coordinates(),
        [&](std::span<double const> p) { return case_file.motion_for(box.named(p)); }, box.low, box.high);
  } catch (ConfigError const& e) {
    std::string names;
    for (std::size_t i = 0; i < box.parameters().size(); ++i)
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", i + 1, box.parameters()[i].name);
    throw ConfigError(fmt::format("{}{}\n  parameters: {}", who, e.what(), names));
  }
  run.times.push_back({"meshes", watch.lap(), true});
  console.progress("bounds of Jacobians over the box");
  DesignBoxOptions wanted;
  wanted.limit = options.limit;
  DesignBox const found = certify_designs({}, run.mesh().indexed(), modes, wanted);
  run.times.push_back({"bounds", watch.lap(), true});
  RunDocument described = document_of(case_file);
  json out = box_json(box, run.mesh().mesh(), found);
  out.update({{"gridmorph", GRIDMORPH_VERSION},
              {"case_file", described.case_file},
              {"input", described.input},
              {"nodes", run.mesh().n_nodes()},
              {"deviation", modes.deviation},
              {"times", times_json(run.times, run.mesh().n_nodes())}});
  if (options.report) {
    PendingFile report(*options.report, json_text(out));
    report.commit();
  }
  console.document(out);
  if (!console.json())
    console.result(box_text(box, run.mesh().mesh(), found, options.limit) + "\n" +
                   format_times(run.times, run.mesh().n_nodes()) +
                   (options.report ? fmt::format("wrote {}\n", options.report->string()) : std::string()));
  return found.holds();
}

}  // namespace gridmorph::cli
