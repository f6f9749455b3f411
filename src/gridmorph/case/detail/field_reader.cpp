#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/inverse_field.hpp>
#include <gridmorph/mapping/modal_field.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

struct InverseOptions {
  double tolerance = 0;  ///< [length]; 0: by the size of the model
  int most = 100;
};

FieldOptions read_options(TableReader& table) {
  FieldOptions options;
  if (auto const s = table.number("length_scale")) {
    options.length_scale = *s;
    if (*s <= 0) table.problem("length_scale", fmt::format("must be positive, found {}", *s));
  }
  options.factor = table.number("factor").value_or(1);
  if (auto const d = table.number("max_distance")) {
    options.max_distance = *d;
    if (*d <= 0)
      table.problem("max_distance",
                    fmt::format("must be positive, found {}; remove it for 5 % of the size of the patches", *d));
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

/// Where the models of a rule stand.
struct Placement {
  bool deformed = false;          ///< at the positions that the displacement of `file` leads to
  std::vector<RigidSteps> frame;  ///< from the coordinate system of the model to that of the mesh
};

Placement read_placement(TableReader& table, RuleContext const& shared) {
  Placement out;
  out.deformed = table.choice("positions", {"undeformed", "deformed"}).value_or(0) == 1;
  for (auto& step : table.tables("frame")) {
    RigidSteps rigid;
    read_rotation(step, shared, rigid);
    if (auto const shift = step.vector("translation")) rigid.translation = *shift;
    if (!step.has("rotation") && !step.has("translation"))
      step.context().problem(step.line(),
                             "[[motion]] frame: needs rotation = { angle_deg, axis, origin } or translation = "
                             "[x, y, z], from the coordinates of the model to those of the mesh");
    step.finish();
    out.frame.push_back(rigid);
  }
  return out;
}

/// Puts every model where it stands in the mesh, in units of its file.
void place_models(TableReader& table, Placement const& placement, double length_scale, StructuralModel* mean,
                  std::vector<StructuralModel*> const& others) {
  if (placement.deformed) {
    if (mean == nullptr) {
      table.problem("positions",
                    "is \"deformed\", by the displacement of file, which is missing; add file, or remove it");
      return;
    }
    std::vector<Vec3> const deformed = mean->nodes.position;
    for (std::size_t n = 0; n < deformed.size(); ++n)
      mean->nodes.position[n] = deformed[n] - mean->nodes.displacement[n];
    for (StructuralModel* other : others) {
      if (other->nodes.position != deformed) {
        table.problem("positions", fmt::format("is \"deformed\", by the displacement of file, and the points of {} are "
                                               "others; give loads and modes at the points of file",
                                               other->nodes.source));
        return;
      }
      other->nodes.position = mean->nodes.position;
    }
  }
  if (placement.frame.empty()) return;
  RigidRule const rule = make_rigid_steps(placement.frame);
  auto const place = [&](StructuralModel& model) {
    for (Vec3& x : model.nodes.position) x = rule.matrix * x + (1 / length_scale) * rule.translation;
    for (Vec3& u : model.nodes.displacement) u = rule.matrix * u;
    for (Vec3& u : model.nodes.imaginary) u = rule.matrix * u;
  };
  if (mean != nullptr) place(*mean);
  for (StructuralModel* other : others) place(*other);
}

/// Whether the displacement is taken back, and how.
std::optional<InverseOptions> read_inverse(TableReader& table) {
  bool const wanted = table.boolean("inverse").value_or(false);
  InverseOptions options;
  if (auto const tolerance = table.number("inverse_tolerance")) {
    options.tolerance = *tolerance;
    if (*tolerance <= 0) table.problem("inverse_tolerance", fmt::format("must be positive, found {}", *tolerance));
  }
  if (auto const most = table.integer("inverse_iterations")) {
    options.most = *most;
    if (*most < 1) table.problem("inverse_iterations", fmt::format("must be at least 1, found {}", *most));
  }
  for (char const* key : {"inverse_tolerance", "inverse_iterations"})
    if (!wanted && table.has(key)) table.problem(key, "belongs to inverse = true; add that, or remove it");
  return wanted ? std::optional(options) : std::nullopt;
}

std::shared_ptr<InverseField const> make_inverse(std::optional<InverseOptions> const& options, std::string source,
                                                 double coincidence) {
  if (!options) return nullptr;
  // Within `coincidence`, 1e-7 of the model, displacements are those of its points.
  double const tolerance = options->tolerance > 0 ? options->tolerance : 1e-2 * coincidence;
  return std::make_shared<InverseField const>(std::move(source), tolerance, options->most);
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
                     std::optional<StructuralModel> mean, std::vector<Mode> modes, std::vector<Load> loads,
                     std::optional<InverseOptions> const& inverse_options) {
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
  std::size_t const first = out.fields.size();
  for (auto const& one : field->fields()) out.fields.push_back({table.context().where(table.line()), one});
  auto const inverse =
      make_inverse(inverse_options, out.fields[first].field->source(), out.fields[first].field->coincidence());
  out.fields[first].inverse = inverse;
  std::string description = "field of";
  if (field->n_loads() > 0) description += fmt::format(" {} load cases", field->n_loads());
  if (field->n_loads() > 0 && field->n_modes() > 0) description += " and";
  if (field->n_modes() > 0) description += fmt::format(" {} modes", field->n_modes());
  std::string const where = table.context().where(table.line());
  rule.at = [field, factors, description, where, inverse](double share, Moment const& when) {
    std::vector<double> now;
    for (auto const& factor : factors) {
      now.push_back(factor(when));
      if (!std::isfinite(now.back()))
        throw MotionError(fmt::format("{}: factor of load case {} is {} at t = {:.9g}, step {}", where, now.size(),
                                      now.back(), when.time, when.step));
    }
    if (inverse)
      return FunctionRule{description + ", taken back",
                          [field, when, now, inverse, share](std::span<Vec3 const> points, std::span<Vec3> u) {
                            (*inverse)(
                                [&](std::span<Vec3 const> places, std::span<Vec3> there, bool iterates) {
                                  field->at(when.periods, now, places, there, iterates);
                                },
                                share, points, u,
                                [&](std::span<Vec3 const> places, std::span<Vec3 const> anchors,
                                    std::span<Vec3> there) { field->held(when.periods, now, places, anchors, there); });
                          }};
    return shared_field(description, share, [field, when, now](std::span<Vec3 const> points, std::span<Vec3> u) {
      field->at(when.periods, now, points, u);
    });
  };
  return rule;
}

/// The rule of a model by itself. `source`: its file, as the case file names it.
TimedRule single_rule(std::string const& source, std::shared_ptr<PointField const> const& field,
                      std::shared_ptr<InverseField const> const& inverse) {
  std::string const description =
      fmt::format("field {} ({} points{})", source, field->size(),
                  field->n_elements() > 0 ? fmt::format(", {} elements", field->n_elements()) : "");
  TimedRule rule;
  if (inverse) {
    rule.at = [field, inverse, description](double share, Moment const&) {
      return FunctionRule{
          description + ", taken back", [field, inverse, share](std::span<Vec3 const> points, std::span<Vec3> u) {
            (*inverse)(
                [&](std::span<Vec3 const> places, std::span<Vec3> there, bool iterates) {
                  constexpr double all = 1;
                  field->evaluate({&all, 1}, places, there, iterates);
                },
                share, points, u,
                [&](std::span<Vec3 const> places, std::span<Vec3 const> anchors, std::span<Vec3> there) {
                  constexpr double all = 1;
                  field->held({&all, 1}, places, anchors, there);
                });
          }};
    };
    return rule;
  }
  rule.at = [field, description](double share, Moment const&) {
    return shared_field(description, share,
                        [field](std::span<Vec3 const> points, std::span<Vec3> u) { (*field)(points, u); });
  };
  return rule;
}

/// Reads the keys of one rule and its models, and makes it of them: of `file` alone, or of a sum of that, modes and
/// loads.
class FieldReader {
 public:
  FieldReader(TableReader& table, RuleContext const& shared, CaseFile& out)
      : table_(table), shared_(shared), out_(out), first_field_(out.fields.size()) {}

  TimedRule run() {
    options_ = read_options(table_);
    placement_ = read_placement(table_, shared_);
    inverse_ = read_inverse(table_);
    elements_ = table_.string("elements");
    auto const solution = table_.string("solution");
    read_modes();
    read_loads();
    is_sum_ = table_.has("modes") || table_.has("loads");
    if (!is_sum_) table_.require("file", "file = \"displacement.csv\" (columns x,y,z,dx,dy,dz)");
    file_ = table_.string("file");
    model_ = read_model(table_, elements_, solution);
    if (!good_ || (!model_ && (file_ || !is_sum_))) return {};
    place();
    try {
      TimedRule rule = make();
      refuse_offset_of_points();
      return rule;
    } catch (Error const& e) {
      table_.problem("file", e.what());
      return {};
    }
  }

 private:
  void read_modes() {
    double const* const period = out_.sequence ? &out_.sequence->period : nullptr;
    for (auto& mode_table : table_.tables("modes")) {
      auto mode = read_mode(mode_table, elements_, period);
      good_ = good_ && mode;
      if (mode) modes_.push_back(std::move(*mode));
    }
    if (table_.has("modes") && good_ && modes_.empty()) {
      table_.problem("modes", "the list is empty; give { file = \"mode_1.csv\" } or remove it");
      good_ = false;
    }
  }

  void read_loads() {
    for (auto& load_table : table_.tables("loads")) {
      auto load = read_load(load_table, shared_, elements_);
      good_ = good_ && load;
      if (load) loads_.push_back(std::move(*load));
    }
    if (table_.has("loads") && good_ && loads_.empty()) {
      table_.problem("loads", "the list is empty; give { file = \"speed.csv\", factor = 1 } or remove it");
      good_ = false;
    }
  }

  void place() {
    std::vector<StructuralModel*> others;
    for (Mode& mode : modes_) others.push_back(&mode.model);
    for (Load& load : loads_) others.push_back(&load.model);
    place_models(table_, placement_, options_.length_scale, model_ ? &*model_ : nullptr, others);
  }

  TimedRule make() {
    if (is_sum_)
      return modal_rule(table_, out_, options_, std::move(model_), std::move(modes_), std::move(loads_), inverse_);
    if (!model_->nodes.imaginary.empty())
      model_->notes.push_back(fmt::format("{}: the imaginary part is not used; name the file in modes", *file_));
    auto const field = std::make_shared<PointField const>(std::move(*model_), options_);
    auto const inverse = make_inverse(inverse_, field->source(), field->coincidence());
    out_.fields.push_back({table_.context().where(table_.line()), field, inverse});
    return single_rule(*file_, field, inverse);
  }

  /// Points have no surface that an offset could turn with.
  void refuse_offset_of_points() {
    if (!table_.has("offset") || first_field_ == out_.fields.size()) return;
    for (std::size_t f = first_field_; f < out_.fields.size(); ++f)
      if (out_.fields[f].field->n_elements() > 0) return;
    table_.problem("offset", "is for models with elements, and this one has points alone; add elements or remove it");
  }

  TableReader& table_;
  RuleContext const& shared_;
  CaseFile& out_;
  std::size_t first_field_;  ///< of this rule, in CaseFile::fields
  FieldOptions options_;
  Placement placement_;
  std::optional<InverseOptions> inverse_;
  std::optional<std::string> elements_;  ///< of all models that name none of their own
  std::optional<std::string> file_;
  std::optional<StructuralModel> model_;  ///< of `file`
  std::vector<Mode> modes_;
  std::vector<Load> loads_;
  bool is_sum_ = false;
  bool good_ = true;  ///< whether modes and loads could be read
};

}  // namespace

TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out) {
  return FieldReader(table, shared, out).run();
}

}  // namespace gridmorph::casefile
