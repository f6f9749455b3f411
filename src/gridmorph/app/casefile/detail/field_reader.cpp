#include <gridmorph/app/casefile/detail/field_reader.hpp>
#include <gridmorph/app/casefile/formula.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/modal_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

FieldOptions read_options(TableReader& table) {
  FieldOptions options;
  if (auto const s = table.number("length_scale")) {
    options.length_scale = *s;
    if (*s <= 0) table.problem("length_scale", fmt::format("must be positive, found {}", *s));
  }
  options.factor = table.number("factor").value_or(1);
  if (auto const d = table.number("max_distance")) {
    options.max_distance = *d;
    if (*d <= 0) table.problem("max_distance", fmt::format("must be positive, found {}; remove it for no limit", *d));
  }
  if (auto const word = table.choice("extrapolation", {"linear", "nearest"}))
    options.extrapolation = Extrapolation(*word);
  if (auto const d = table.number("max_extrapolation")) {
    options.max_extrapolation = *d;
    if (*d < 0)
      table.problem("max_extrapolation", fmt::format("must not be negative, found {}; remove it for no limit", *d));
  }
  if (auto const word = table.choice("offset", {"turn", "translate"})) options.turn_offset = *word == 0;
  return options;
}

/// Reads a model; problems of its files are noted at the key `file`.
std::optional<StructuralModel> read_model(TableReader& table, std::optional<std::string> const& elements,
                                          std::optional<std::string> const& solution) {
  auto const file = table.string("file");
  if (!file) return std::nullopt;
  auto const path = [&](std::string const& name) { return table.context().input(name); };
  ModelFiles files{path(*file), std::nullopt, solution};
  if (elements) files.elements = path(*elements);
  try {
    return read_structural_model(files);
  } catch (Error const& e) {
    table.problem("file", e.what());
    return std::nullopt;
  }
}

std::optional<Mode> read_mode(TableReader& table, std::optional<std::string> const& shared_elements,
                              double const* period) {
  Mode mode;
  table.require("file", "file = \"mode_1.csv\", the displacement of the mode shape");
  mode.amplitude = table.number("amplitude").value_or(1);
  mode.phase_turns = table.number("phase_deg").value_or(0) / 360;
  mode.harmonic = table.number("harmonic").value_or(1);
  if (auto const frequency = table.number("frequency")) {
    if (table.has("harmonic"))
      table.problem("frequency",
                    "stands beside harmonic, which says the same in cycles per period; remove one of them");
    if (!period) table.problem("frequency", "needs the period; add period to [sequence]");
    mode.harmonic = *frequency * (period ? *period : 1);
  }
  auto const own = table.string("elements");
  auto const solution = table.string("solution");
  auto model = read_model(table, own ? own : shared_elements, solution);
  table.finish();
  if (!model) return std::nullopt;
  mode.model = std::move(*model);
  return mode;
}

/// A load case, its factor over time, and whether that changes.
struct Load {
  StructuralModel model;
  std::function<double(Moment const&)> factor;
  bool changes = false;
};

std::optional<Load> read_load(TableReader& table, RuleContext const& shared,
                              std::optional<std::string> const& shared_elements) {
  table.require("file", "file = \"speed.csv\", the displacement under that load");
  Load load{{}, [](Moment const&) { return 1.0; }, false};
  if (auto const* value = table.find("factor"); value != nullptr && value->is_string()) {
    if (auto const expression = table.string("factor")) {
      load.factor =
          make_time_formula({"factor", *expression, table.where("factor")}, shared.constants, table.context().problems);
      load.changes = uses_time(*expression);
      if (load.changes) needs_sequence(table, shared, "factor");
    }
  } else if (auto const factor = table.number("factor")) {
    load.factor = [factor = *factor](Moment const&) { return factor; };
  }
  auto const own = table.string("elements");
  auto const solution = table.string("solution");
  auto model = read_model(table, own ? own : shared_elements, solution);
  table.finish();
  if (!model) return std::nullopt;
  load.model = std::move(*model);
  if (!load.model.nodes.imaginary.empty())
    load.model.notes.push_back("the imaginary part of a load case is not used; modes have one");
  load.model.nodes.imaginary.clear();
  return load;
}

/// A displacement field times a share.
FunctionRule shared_field(std::string description, double share,
                          std::function<void(std::span<Vec3 const> points, std::span<Vec3> u)> field) {
  if (share == 1) return {std::move(description), std::move(field)};
  return {std::move(description), [share, field = std::move(field)](std::span<Vec3 const> points, std::span<Vec3> u) {
            field(points, u);
            for (Vec3& one : u) one = share * one;
          }};
}

TimedRule modal_rule(TableReader& table, CaseFile& out, FieldOptions const& options,
                     std::optional<StructuralModel> mean, std::vector<Mode> modes, std::vector<Load> loads) {
  TimedRule rule;
  rule.changes =
      !modes.empty() || std::any_of(loads.begin(), loads.end(), [](Load const& load) { return load.changes; });
  std::vector<StructuralModel> models;
  std::vector<std::function<double(Moment const&)>> factors;
  for (Load& load : loads) {
    models.push_back(std::move(load.model));
    factors.push_back(std::move(load.factor));
  }
  auto const field = std::make_shared<ModalField const>(std::move(mean), std::move(modes), std::move(models), options);
  for (auto const& one : field->fields()) out.fields.push_back({table.context().where(table.line()), one});
  std::string description = "field of";
  if (field->n_loads() > 0) description += fmt::format(" {} load cases", field->n_loads());
  if (field->n_loads() > 0 && field->n_modes() > 0) description += " and";
  if (field->n_modes() > 0) description += fmt::format(" {} modes", field->n_modes());
  std::string const where = table.context().where(table.line());
  rule.at = [field, factors, description, where](double share, Moment const& when) {
    std::vector<double> now;
    for (auto const& factor : factors) {
      now.push_back(factor(when));
      if (!std::isfinite(now.back()))
        throw MotionError(fmt::format("{}: factor of load case {} is {} at t = {:.9g}, step {}", where, now.size(),
                                      now.back(), when.time, when.step));
    }
    return shared_field(description, share, [field, when, now](std::span<Vec3 const> points, std::span<Vec3> u) {
      field->at(when.periods, now, points, u);
    });
  };
  return rule;
}

/// Points have no surface that an offset could turn with. `first`: of the rule's fields.
void refuse_offset_of_points(TableReader& table, CaseFile const& out, std::size_t first) {
  if (!table.has("offset") || first == out.fields.size()) return;
  for (std::size_t f = first; f < out.fields.size(); ++f)
    if (out.fields[f].field->n_elements() > 0) return;
  table.problem("offset", "is for models with elements, and this one has points alone; add elements or remove it");
}

}  // namespace

TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out) {
  std::size_t const first_field = out.fields.size();
  FieldOptions const options = read_options(table);
  auto const elements = table.string("elements");
  auto const solution = table.string("solution");
  double const* const period = out.sequence ? &out.sequence->period : nullptr;
  bool const has_modes = table.has("modes");
  std::vector<Mode> modes;
  bool good = true;
  for (auto& mode_table : table.tables("modes")) {
    auto mode = read_mode(mode_table, elements, period);
    good = good && mode;
    if (mode) modes.push_back(std::move(*mode));
  }
  if (has_modes && good && modes.empty()) {
    table.problem("modes", "the list is empty; give { file = \"mode_1.csv\" } or remove it");
    good = false;
  }
  bool const has_loads = table.has("loads");
  std::vector<Load> loads;
  for (auto& load_table : table.tables("loads")) {
    auto load = read_load(load_table, shared, elements);
    good = good && load;
    if (load) loads.push_back(std::move(*load));
  }
  if (has_loads && good && loads.empty()) {
    table.problem("loads", "the list is empty; give { file = \"speed.csv\", factor = 1 } or remove it");
    good = false;
  }
  bool const is_sum = has_modes || has_loads;
  if (!is_sum) table.require("file", "file = \"displacement.csv\" (columns x,y,z,dx,dy,dz)");
  auto const file = table.string("file");
  auto model = read_model(table, elements, solution);
  if (!good || (!model && (file || !is_sum))) return {};
  try {
    if (is_sum) {
      TimedRule rule = modal_rule(table, out, options, std::move(model), std::move(modes), std::move(loads));
      refuse_offset_of_points(table, out, first_field);
      return rule;
    }
    if (!model->nodes.imaginary.empty())
      model->notes.push_back(fmt::format("{}: the imaginary part is not used; name the file in modes", *file));
    auto const field = std::make_shared<PointField const>(std::move(*model), options);
    out.fields.push_back({table.context().where(table.line()), field});
    refuse_offset_of_points(table, out, first_field);
    std::string const description =
        fmt::format("field {} ({} points{})", *file, field->size(),
                    field->n_elements() > 0 ? fmt::format(", {} elements", field->n_elements()) : "");
    TimedRule rule;
    rule.at = [field, description](double share, Moment const&) {
      return shared_field(description, share,
                          [field](std::span<Vec3 const> points, std::span<Vec3> u) { (*field)(points, u); });
    };
    return rule;
  } catch (Error const& e) {
    table.problem("file", e.what());
    return {};
  }
}

}  // namespace gridmorph::casefile
