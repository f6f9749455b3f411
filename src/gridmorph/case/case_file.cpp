#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/case_parts.hpp>
#include <gridmorph/case/detail/law_reader.hpp>
#include <gridmorph/case/detail/parameter_reader.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace gridmorph {

namespace {

using casefile::Context;
using casefile::TableReader;

/// A case file is written by hand; anything larger is some other file.
constexpr std::uintmax_t largest_case_file = 4u << 20;
/// Steps are numbered with up to five digits.

void read_mesh_table(TableReader& root, CaseFile& out) {
  root.require("mesh", "[mesh] with input = \"mesh.cgns\"");
  auto mesh = root.table("mesh");
  if (!mesh) return;
  auto const& directory = mesh->context().directory;
  if (auto const input = mesh->string("input")) out.input = (directory / *input).lexically_normal();
  mesh->require("input", "input = \"mesh.cgns\"");
  if (auto const output = mesh->string("output")) out.output = (directory / *output).lexically_normal();
  if (!out.output.empty() && out.output == out.input)
    mesh->problem("output", "is the input; give another file name, the baseline is never overwritten");
  if (auto const side = mesh->string("side_file")) out.side_file = (directory / *side).lexically_normal();
  out.leave_out = mesh->strings("leave_out").value_or(std::vector<std::string>{});
  if (auto const blocks = mesh->choice("blocks", {"off", "find"})) out.find_blocks = *blocks == 1;
  out.axis = casefile::read_axis(*mesh, "axis");
  if (out.axis) out.motion.axis = *out.axis;
  if (auto const tolerance = mesh->number("matching_tolerance")) {
    out.plan.topology.matching_tolerance = *tolerance;
    if (*tolerance <= 0)
      mesh->problem("matching_tolerance",
                    fmt::format("must be a positive length, found {}; remove it for the default", *tolerance));
  }
  out.plan.topology.open_faces = mesh->string("open_faces").value_or("");
  mesh->finish();
}

/// times = [0, 0.5, 1], in place of steps spread evenly.
void read_times(TableReader& table, SequenceOptions& sequence) {
  if (!table.has("times")) return;
  sequence.times = table.numbers("times").value_or(std::vector<double>{0});
  for (char const* key : {"steps", "periods", "include_end"})
    if (table.has(key)) table.problem(key, "stands beside times, which says when the steps are; remove one of them");
  if (sequence.times.empty() || sequence.times.size() > std::size_t(largest_sequence))
    table.problem("times", fmt::format("must be 1 to {} times, found {}", largest_sequence, sequence.times.size()));
  auto const back = std::adjacent_find(sequence.times.begin(), sequence.times.end(), std::greater_equal<>());
  if (back != sequence.times.end())
    table.problem("times", fmt::format("must ascend, found {} after {}", *(back + 1), *back));
  sequence.steps = int(sequence.times.size());
}

void read_sequence(TableReader& root, CaseFile& out) {
  auto table = root.table("sequence");
  if (!table) return;
  SequenceOptions sequence;
  auto const steps = table->integer("steps");
  sequence.steps = steps.value_or(1);
  read_times(*table, sequence);
  if (!table->has("times")) table->require("steps", "steps = 32, the number of meshes, or times = [0, 0.5, 1]");
  if (sequence.steps < 1 || sequence.steps > largest_sequence)
    table->problem("steps", fmt::format("must be 1 to {}, found {}", largest_sequence, sequence.steps));
  auto const positive = [&](std::string const& key, double& value) {
    value = table->number(key).value_or(1);
    if (value <= 0) table->problem(key, fmt::format("must be positive, found {}", value));
  };
  positive("period", sequence.period);
  positive("periods", sequence.periods);
  sequence.include_end = table->boolean("include_end").value_or(false);
  if (auto const output = table->string("output"))
    sequence.output = (table->context().directory / *output).lexically_normal();
  if (!sequence.output.empty() && sequence.output == out.input)
    table->problem("output", "is the input; give another file name, the baseline is never overwritten");
  table->finish();
  out.sequence = sequence;
}

bool changes_with_time(CaseFile const& out) {
  auto const any = [](std::vector<TimedRule> const& rules) {
    return std::any_of(rules.begin(), rules.end(), [](TimedRule const& r) { return r.changes; });
  };
  return any(out.timed) || (out.wheel && std::any_of(out.wheel->blades.begin(), out.wheel->blades.end(),
                                                     [&](WheelBlade const& blade) { return any(blade.timed); }));
}

/// constants: of all formulas.
void read_motion(TableReader& root, std::map<std::string, double> const& constants, CaseFile& out) {
  if (auto const word = root.choice("default", {"type", "error"})) out.motion.strict = *word == 1;
  if (auto conformity = root.table("conformity")) {
    if (auto const tolerance = conformity->number("tolerance")) {
      out.motion.conformity_tolerance = *tolerance;
      if (*tolerance < 0 || *tolerance >= 1)
        conformity->problem("tolerance",
                            fmt::format("must be a share of the mesh size between 0 and 1, found {}", *tolerance));
    }
    conformity->finish();
  }
  casefile::RuleContext shared{out.axis, constants, out.sequence.has_value()};
  for (auto& table : root.tables("motion")) casefile::read_motion_rule(table, shared, out);
  for (auto& table : root.tables("region")) {
    InnerRegion region = casefile::read_region(table, out.axis);
    (region.only_measured ? out.measured_regions : out.motion.regions).push_back(std::move(region));
  }
  casefile::read_wheel(root, shared, out);
  if (!root.has("motion"))
    root.context().problems.add(root.context().file +
                                ": no [[motion]] rule; add at least one, for example [[motion]] with "
                                "patches = [\"blade\"] and rule = \"rigid\"");
  else if (out.sequence && root.context().problems.empty() && !changes_with_time(out))
    root.context().problem(root.line("sequence"),
                           "[sequence]: no rule changes with time, so that all steps would be alike; give a rule an "
                           "amplitude over time, use t or step in a formula, or add modes to a rule \"field\"");
}

BoundaryLayer read_boundary_layer(TableReader& table) {
  BoundaryLayer layer;
  layer.walls = table.strings("walls").value_or(std::vector<std::string>{});
  if (auto const* extent = table.find("extent")) {
    if (extent->is_string()) {
      if (table.choice("extent", {"block"})) layer.extent = BoundaryLayer::Extent::block;
    } else if (auto inner = table.table("extent")) {
      auto const layers = inner->integer("layers");
      auto const thickness = inner->number("thickness");
      if (layers && *layers < 1) inner->problem("layers", fmt::format("must be at least 1, found {}", *layers));
      if (thickness && *thickness <= 0)
        inner->problem("thickness", fmt::format("must be a positive length, found {}", *thickness));
      if (inner->has("layers") == inner->has("thickness"))
        table.problem("extent", "needs exactly one of { layers = 30 } and { thickness = 2e-3 }");
      inner->finish();
      layer.extent = layers ? BoundaryLayer::Extent::layers : BoundaryLayer::Extent::thickness;
      layer.layers = layers.value_or(0);
      layer.thickness = thickness.value_or(0);
    }
  }
  if (auto const mode = table.choice("mode", {"translate", "rotate", "blend"})) layer.mode = BoundaryLayer::Mode(*mode);
  table.finish();
  return layer;
}

/// Kinds of ends of chains.
std::vector<std::string> const end_kinds{"wall",     "periodic",   "inflow",     "outflow", "symmetry",
                                         "farfield", "degenerate", "connection", "other",   "region"};

void require_kind(TableReader& table, char const* key, std::string const& word) {
  if (std::find(end_kinds.begin(), end_kinds.end(), word) == end_kinds.end())
    table.problem(key, fmt::format("\"{}\" is no kind of boundary{}", word, suggestion(word, end_kinds)));
}

std::vector<LawOfEnds> read_laws(TableReader& volume, std::map<std::string, double> const& constants) {
  std::vector<LawOfEnds> out;
  for (auto& table : volume.tables("laws")) {
    table.require("between", "between = [\"wall\", \"periodic\"]");
    table.require("law", "law = \"c1\"");
    LawOfEnds law;
    law.where = table.where("between");
    auto const between = table.strings("between");
    if (between && between->size() != 2)
      table.problem("between", fmt::format("names two ends, found {}", between->size()));
    else if (between)
      law.between = {between->front(), between->back()};
    casefile::read_law(table, {"linear", "c1", "c2", "mixed", "matched", "formula"}, constants, law.law, law.own);
    table.finish();
    out.push_back(std::move(law));
  }
  return out;
}

std::vector<PriorityRule> read_priority(TableReader& volume) {
  std::vector<PriorityRule> priority;
  for (auto& table : volume.tables("priority")) {
    PriorityRule rule;
    table.require("rule", "rule = \"boundary\", \"quality\" or \"aspect-ratio\"");
    auto const kind = table.choice("rule", {"boundary", "quality", "aspect-ratio"});
    if (kind) rule.kind = PriorityRule::Kind(*kind);
    if (kind && *kind == 0) {
      if (auto const patches = table.strings("patches")) rule.patches = *patches;
      if (auto const order = table.strings("order")) {
        rule.order = *order;
        for (std::size_t i = 0; i < order->size(); ++i) {
          std::string const& word = (*order)[i];
          require_kind(table, "order", word);
          if (std::find(order->begin(), order->begin() + std::ptrdiff_t(i), word) != order->begin() + std::ptrdiff_t(i))
            table.problem("order", fmt::format("names \"{}\" twice", word));
        }
      }
    } else {
      rule.order.clear();
    }
    if (kind) table.finish();
    priority.push_back(std::move(rule));
  }
  return priority;
}

/// cuts = [ { zone = "Zone 1", i = 33 }, ... ], counted from 1.
std::vector<BlockCut> read_cuts(TableReader& volume) {
  std::vector<BlockCut> out;
  for (auto& table : volume.tables("cuts")) {
    table.require("zone", "zone = \"Zone 1\"");
    BlockCut cut;
    cut.where = table.where("zone");
    cut.zone = table.string("zone").value_or("");
    int given = 0;
    for (int a = 0; a < 3; ++a)
      if (auto const node = table.number(std::string(1, "ijk"[a]))) {
        ++given;
        cut.axis = a;
        cut.node = int(std::clamp(*node, -1e9, 1e9)) - 1;
        if (std::floor(*node) != *node)
          table.problem(std::string(1, "ijk"[a]), fmt::format("is the number of a node, found {}", *node));
      }
    if (given != 1)
      table.problem("zone", "needs one of i, j and k beside it: the plane of nodes to cut at, counted from 1");
    table.finish();
    out.push_back(std::move(cut));
  }
  return out;
}

void read_plan(TableReader& root, std::map<std::string, double> const& constants, CaseFile& out) {
  if (auto const* given = root.find("boundary_layer"); given != nullptr && given->is_boolean()) {
    out.plan.default_boundary_layer = root.boolean("boundary_layer").value_or(true);
  } else {
    for (auto& table : root.tables("boundary_layer")) out.plan.boundary_layers.push_back(read_boundary_layer(table));
  }
  auto volume = root.table("volume");
  if (!volume) return;
  std::vector<std::string> const laws{"linear", "c1", "c2", "mixed", "matched", "formula", "prediction"};
  VolumeOptions& to = out.plan.volume;
  // What is said of laws is meant, even where it is what would be taken anyway.
  auto const law = casefile::read_law(*volume, laws, constants, to.law, to.own_law);
  if (law) to.order = OrderBy::priority;
  if (law && laws[*law] == "prediction") {
    to.laws_by_prediction = true;
    to.law = Law::linear;
  }
  if (auto const share = volume->number("linear_share")) {
    out.plan.volume.linear_share = *share;
    if (*share < 0 || *share > 1)
      volume->problem("linear_share", fmt::format("is a share of the linear law, 0 to 1, found {}", *share));
  }
  out.plan.volume.laws = read_laws(*volume, constants);
  if (auto const order = volume->choice("order", {"priority", "prediction"})) out.plan.volume.order = OrderBy(*order);
  if (auto const turn = volume->number("turn")) {
    out.plan.volume.turn = *turn;
    if (*turn < 0 || *turn > 1)
      volume->problem("turn", fmt::format("is a share of the walls' turn, 0 to 1, found {}", *turn));
  }
  if (auto priority = read_priority(*volume); !priority.empty()) out.plan.volume.priority = std::move(priority);
  out.plan.volume.cuts = read_cuts(*volume);
  volume->finish();
}

void read_clearances(TableReader& root, CaseFile& out) {
  for (auto& table : root.tables("clearance")) {
    ClearanceCase one;
    one.where = table.context().where(table.line());
    one.tips = table.strings("tips").value_or(std::vector<std::string>{});
    one.walls = table.strings("walls").value_or(std::vector<std::string>{});
    table.require("tips", "tips = [\"blade_tip\"], or the blade with rim = 0.02");
    table.require("walls", "walls = [\"case\"], the wall that the tips run along");
    one.name = table.string("name").value_or(one.tips.empty() ? "" : one.tips.front());
    one.rim = table.number("rim").value_or(1);
    if (one.rim <= 0 || one.rim > 1)
      table.problem("rim",
                    fmt::format("is the share of the blade's height that is its tip, 0 < rim <= 1, found {}", one.rim));
    table.finish();
    out.clearances.push_back(std::move(one));
  }
}

void read_results(TableReader& root, CaseFile& out) {
  read_clearances(root, out);
  if (auto guard = root.table("guard")) {
    auto const limit = [&](char const* key, double& value, bool (*passes)(double), std::string_view meaning) {
      auto const found = guard->number(key);
      if (!found) return;
      value = *found;
      if (!passes(value)) guard->problem(key, fmt::format("is {}, found {}", meaning, value));
    };
    limit(
        "min_determinant", out.guard.min_determinant, [](double d) { return d >= -1 && d < 1; },
        "the smallest 3x3x3 determinant that passes, -1 <= value < 1");
    limit(
        "min_angle_deg", out.guard.min_angle_deg, [](double a) { return a >= 0 && a < 90; },
        "the smallest angle that passes, in degrees, 0 <= value < 90");
    limit(
        "max_skewness", out.guard.max_skewness, [](double s) { return s > 0 && s <= 1; },
        "the largest equiangle skewness that passes, 0 < value <= 1");
    limit(
        "max_loss", out.guard.max_loss, [](double l) { return l > 0 && l <= 1; },
        "the largest share of its determinant or smallest angle that a cell may lose, 0 < value <= 1");
    limit(
        "max_trim", out.guard.max_trim, [](double l) { return l > 0 && l <= 1; },
        "the largest share of a displacement that slip surfaces may undo, 0 < value <= 1");
    if (auto const mode = guard->choice("quality", {"auto", "full", "fast"})) out.guard.quality = QualityMode(*mode);
    out.guard.write_inverted = guard->boolean("write_inverted").value_or(false);
    out.guard.retry = guard->boolean("retry");
    out.guard.freeze = guard->boolean("freeze").value_or(false);
    out.guard.smooth = guard->boolean("smooth").value_or(false);
    if (auto const steps = guard->integer("steps")) {
      constexpr int most = 64;
      out.guard.steps = std::clamp(*steps, 1, most);
      if (*steps < 1 || *steps > most)
        guard->problem("steps", fmt::format("is the number of steps to try at most, 1 to {}, found {}", most, *steps));
    }
    guard->finish();
  }
  if (auto output = root.table("output")) {
    out.output_options.displacement = output->boolean("displacement").value_or(false);
    out.output_options.quality = output->boolean("quality").value_or(false);
    if (auto const stages = output->string("stages"))
      out.output_options.stages = (output->context().directory / *stages).lexically_normal();
    if (auto const vtk = output->string("vtk"))
      out.output_options.vtk = (output->context().directory / *vtk).lexically_normal();
    if (auto const page = output->string("html"))
      out.output_options.page = (output->context().directory / *page).lexically_normal();
    if (auto const report = output->string("report"))
      out.output_options.report = (output->context().directory / *report).lexically_normal();
    output->finish();
  }
}

}  // namespace

struct CaseDocument::Root {
  casefile::TomlText text;
};

CaseDocument::CaseDocument(std::filesystem::path const& path)
    : CaseDocument(mapping::read_text_file(path, "case file", largest_case_file), path) {}

CaseDocument::CaseDocument(std::string const& text, std::filesystem::path path)
    : path_(std::move(path)),
      root_(std::make_shared<Root const>(Root{casefile::parse_toml_text(text, path_.string())})) {}

std::optional<std::filesystem::path> CaseDocument::mesh() const {
  try {
    return (path_.parent_path() / toml::find<std::string>(root_->text.root, "mesh", "input")).lexically_normal();
  } catch (std::exception const&) {  // read_case_file() says what is wrong
    return std::nullopt;
  }
}

namespace {

/// [constants] as they stand; those that are expressions are true.
std::map<std::string, bool> given_constants(toml::value const& root) {
  std::map<std::string, bool> out;
  if (auto const at = root.as_table().find("constants"); at != root.as_table().end() && at->second.is_table())
    for (auto const& [name, value] : at->second.as_table()) out[name] = value.is_string();
  return out;
}

/// Names that formulas of the plan may use: of a sweep, whose designs have one plan, those that no parameter changes.
std::map<std::string, double> constants_of_plan(toml::value const& root, CaseFile const& file,
                                                std::map<std::string, double> names) {
  if (!file.sequence || !file.sequence->is_sweep()) return names;
  for (Parameter const& p : file.parameters) names.erase(p.name);
  for (auto const& [name, is_expression] : given_constants(root))
    if (is_expression) names.erase(name);
  return names;
}

CaseFile read(CaseDocument const& document, ParameterValues const& values, CaseKeyUse* asked) {
  Context context{document.path().string(), document.path().parent_path(), {}, asked};
  CaseFile out;
  out.source = document.path();
  context.lines = document.root().text.lines;
  TableReader root(context, document.root().text.root, "");
  casefile::read_parameters(root, values, out);
  // What constants are made of are parameters alone: tables have no order.
  auto constants = context.names;
  casefile::read_constants(root, "constants", constants);
  for (Parameter const& p : out.parameters)
    if (given_constants(document.root().text.root).contains(p.name))
      root.problem("constants", fmt::format("names '{}', which is one of [parameters]; rename one of the two", p.name));
  context.names = constants;
  read_mesh_table(root, out);
  read_sequence(root, out);
  read_motion(root, constants, out);
  casefile::read_sweep(root, out);
  auto const of_plan = constants_of_plan(document.root().text.root, out, std::move(constants));
  read_plan(root, of_plan, out);
  casefile::read_near_field(root, of_plan, out);
  read_results(root, out);
  casefile::require_one_plan(context, out);
  root.finish();
  context.problems.throw_if_any<ConfigError>();
  out.files = std::move(context.files);
  out.notes = std::move(context.notes);
  out.given.assign(context.given.begin(), context.given.end());
  out.motion_for = [document, values](ParameterValues const& other) {
    ParameterValues now = other;
    now.insert(values.begin(), values.end());
    return read(document, now, nullptr).motion;
  };
  return out;
}

}  // namespace

CaseFile read_case_file(CaseDocument const& document, ParameterValues const& values) {
  return read(document, values, nullptr);
}

CaseFile parse_case_file(std::string const& text, std::filesystem::path const& path, CaseKeyUse* asked) {
  return read(CaseDocument(text, path), {}, asked);
}

Rule rule_at(TimedRule const& timed, std::string const& where, Moment const& when, double factor) {
  double const share = timed.amplitude ? timed.amplitude(when) : 1;
  if (!std::isfinite(share))
    throw MotionError(fmt::format("{}: amplitude is {} at t = {:.9g}, step {}", where, share, when.time, when.step));
  return timed.at(share * factor, when);
}

bool one_file_per_step(SequenceOptions const& options) {
  return options.output.filename().string().find(options.is_sweep() ? "{design}" : "{step}") != std::string::npos;
}

Motion motion_at(CaseFile const& case_file, Moment const& when) {
  if (case_file.sequence && case_file.sequence->is_sweep()) {
    ParameterValues const values = case_file.sequence->values_at(when.step - 1);
    try {
      return case_file.motion_for(values);
    } catch (ConfigError const& e) {
      std::string design;
      for (auto const& [name, value] : values) design += fmt::format(", {} = {}", name, value);
      throw ConfigError(fmt::format("design {}{}:\n{}", when.step, design, e.what()));
    }
  }
  Motion motion = case_file.motion;
  for (std::size_t r = 0; r < case_file.timed.size(); ++r)
    if (case_file.timed[r].changes) motion.rules[r].rule = rule_at(case_file.timed[r], motion.rules[r].where, when);
  return motion;
}

Motion fraction_of(CaseFile const& case_file, double share) {
  Motion motion = case_file.motion;
  for (std::size_t r = 0; r < case_file.timed.size(); ++r)
    if (case_file.timed[r].at) motion.rules[r].rule = case_file.timed[r].at(share, {});
  return motion;
}

void take_fraction(CaseFile& case_file, double share) {
  case_file.motion = fraction_of(case_file, share);
  for (TimedRule& rule : case_file.timed)
    if (rule.at)
      rule.at = [at = std::move(rule.at), share](double part, Moment const& when) { return at(part * share, when); };
}

}  // namespace gridmorph
