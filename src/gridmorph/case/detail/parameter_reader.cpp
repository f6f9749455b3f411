#include <gridmorph/case/detail/number_table.hpp>
#include <gridmorph/case/detail/parameter_reader.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace gridmorph::casefile {

namespace {

/// What is wrong with a value; empty: nothing.
std::string out_of_range(Parameter const& parameter, double value) {
  if (!parameter.range || (value >= parameter.range->front() && value <= parameter.range->back())) return {};
  return fmt::format("{} is {}, outside its range [{}, {}]", parameter.name, value, parameter.range->front(),
                     parameter.range->back());
}

/// name = 0.01, or name = { value = 0.01, range = [0, 0.02], unit = "m" }.
std::optional<Parameter> read_parameter(TableReader& table, std::string const& name, toml::value const& value) {
  Parameter out;
  out.name = name;
  if (!value.is_table()) {
    auto const number = table.number(name);
    if (!number) return std::nullopt;
    out.value = *number;
    return out;
  }
  (void)table.find(name);
  TableReader own(table.context(), value, "[parameters] <name>");
  own.require("value", "value = 0");
  out.value = own.number("value").value_or(0);
  out.unit = own.string("unit").value_or("");
  if (auto const range = own.numbers("range")) {
    if (range->size() != 2 || !((*range)[0] < (*range)[1]))
      own.problem("range", "is two numbers, [lowest, highest], the first below the second");
    else
      out.range = {(*range)[0], (*range)[1]};
  }
  own.finish();
  return out;
}

/// Whether any string in a value, its tables and lists has the name in it as a word.
bool is_used(std::string const& name, toml::value const& value) {
  if (value.is_string()) return uses_name(string_of(value), name);
  if (value.is_array())
    return std::any_of(value.as_array().begin(), value.as_array().end(),
                       [&](toml::value const& item) { return is_used(name, item); });
  if (!value.is_table()) return false;
  auto const& table = value.as_table();
  return std::any_of(table.begin(), table.end(), [&](auto const& item) { return is_used(name, item.second); });
}

void refuse_idle_ones(TableReader& table, TableReader const& root, std::vector<Parameter> const& parameters) {
  for (Parameter const& p : parameters) {
    auto const& keys = root.keys();
    bool const used = std::any_of(keys.begin(), keys.end(), [&](auto const& key) {
      return key.first != "parameters" && is_used(p.name, key.second);
    });
    if (!used)
      table.problem(p.name, "is used by no expression; name it in one, angle_deg = \"" + p.name + "\", or remove it");
  }
}

std::vector<std::vector<double>> read_designs(TableReader& table, std::filesystem::path const& path,
                                              std::vector<Parameter> const& parameters) {
  std::vector<NumberColumn> columns;
  for (Parameter const& p : parameters) {
    std::string wanted = "a number";
    if (p.range) wanted += fmt::format(" in its range [{}, {}]", p.range->front(), p.range->back());
    columns.push_back({p.name, wanted, [p](double value) { return out_of_range(p, value).empty(); }, false, p.value});
  }
  std::vector<std::vector<double>> out;
  try {
    for (auto& line : read_number_table(mapping::read_text_file(path, "table"), path.string(), columns, "designs"))
      out.push_back(std::move(line.values));
  } catch (Error const& e) {
    table.problem("designs", e.what());
  }
  return out;
}

std::vector<std::vector<double>> read_hypercube(TableReader& table, std::vector<Parameter> const& parameters) {
  int const count = table.integer("latin_hypercube").value_or(1), seed = table.integer("seed").value_or(1);
  if (seed < 0) table.problem("seed", fmt::format("is a number from 0 on, found {}", seed));
  if (count < 1 || count > largest_sequence) {
    table.problem("latin_hypercube", fmt::format("is a number of designs, 1 to {}, found {}", largest_sequence, count));
    return {};
  }
  for (Parameter const& p : parameters)
    if (!p.range)
      table.problem("latin_hypercube", fmt::format("needs the range of '{0}'; write {0} = {{ value = {1}, range = "
                                                   "[lowest, highest] }} in [parameters]",
                                                   p.name, p.value));
  return table.context().problems.empty() ? latin_hypercube(parameters, count, std::uint64_t(seed))
                                          : std::vector<std::vector<double>>();
}

}  // namespace

void require_one_plan(Context& context, CaseFile const& file) {
  if (!file.sequence || !file.sequence->is_sweep()) return;
  for (auto const& [key, expression] : context.expressions) {
    if (key.table == "constants" || key.table.starts_with("motion") || key.table.starts_with("region")) continue;
    for (Parameter const& p : file.parameters)
      if (uses_name(expression, p.name))
        context.problem(unsigned(key.line),
                        fmt::format("[{}] {} = \"{}\" depends on '{}', and all designs of a [sweep] have one plan; "
                                    "parameters of a sweep are for [[motion]]",
                                    key.table, key.key, expression, p.name));
  }
}

void read_parameters(TableReader& root, ParameterValues const& values, CaseFile& out) {
  auto table = root.table("parameters");
  if (table) {
    for (auto const& [name, value] : table->keys()) {
      auto parameter = read_parameter(*table, name, value);
      if (!is_free_formula_name(name)) {
        table->problem(name, not_a_constant);
      } else if (parameter) {
        if (auto const at = values.find(name); at != values.end()) parameter->value = at->second;
        if (std::string const text = out_of_range(*parameter, parameter->value); !text.empty())
          table->problem(name, text);
        out.parameters.push_back(*std::move(parameter));
      }
    }
    // toml11 keeps tables by hashes, whose order is nobody's.
    std::sort(out.parameters.begin(), out.parameters.end(),
              [](Parameter const& a, Parameter const& b) { return a.name < b.name; });
    refuse_idle_ones(*table, root, out.parameters);
  }
  std::vector<std::string> names;
  for (Parameter const& p : out.parameters) {
    names.push_back(p.name);
    root.context().names[p.name] = p.value;
  }
  for (auto const& [name, value] : values)
    if (std::find(names.begin(), names.end(), name) == names.end())
      root.context().problems.add(fmt::format("{}: '{}' is given a value and is none of [parameters]{}",
                                              root.context().file, name, suggestion(name, names)));
}

void read_sweep(TableReader& root, CaseFile& out) {
  auto table = root.table("sweep");
  if (!table) return;
  auto const problem = [&](char const* text) {
    table->context().problem(table->line(), fmt::format("[sweep] {}", text));
  };
  if (out.parameters.empty())
    problem("has no parameters to vary; give them in [parameters], lean = { value = 0, range = [-1, 1] }");
  if (root.has("sequence"))
    problem("stands beside [sequence], and a run makes one of them: meshes of designs, or over time");
  SequenceOptions sweep;
  for (Parameter const& p : out.parameters) sweep.parameters.push_back(p.name);
  auto const file = table->input("designs");
  if (table->has("designs") == table->has("latin_hypercube"))
    problem("needs one of designs = \"designs.csv\" and latin_hypercube = 20");
  else if (file && is_there(file->string()))
    sweep.designs = read_designs(*table, *file, out.parameters);
  else if (table->has("latin_hypercube"))
    sweep.designs = read_hypercube(*table, out.parameters);
  if (table->has("seed") && !table->has("latin_hypercube")) table->problem("seed", "belongs to latin_hypercube");
  (void)table->integer("seed");
  if (auto const output = table->string("output")) {
    sweep.output = (table->context().directory / *output).lexically_normal();
    if (!one_file_per_step(sweep))
      table->problem("output", "has to have {design} in the name of the file, output = \"blade_{design}.cgns\"");
  }
  table->finish();
  sweep.steps = int(sweep.designs.size());
  out.sequence = std::move(sweep);
}

std::vector<std::vector<double>> latin_hypercube(std::vector<Parameter> const& parameters, int count,
                                                 std::uint64_t seed) {
  // The engine's numbers are those of the standard; what its distributions and shuffle make of them is not.
  std::mt19937_64 random(seed);
  auto const below_one = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<std::vector<double>> out(std::size_t(count), std::vector<double>(parameters.size()));
  std::vector<int> part(out.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    std::iota(part.begin(), part.end(), 0);
    for (std::size_t n = part.size(); n > 1; --n) std::swap(part[n - 1], part[std::size_t(below_one() * double(n))]);
    auto const [low, high] = *parameters[p].range;
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n][p] = low + (high - low) * (part[n] + below_one()) / double(count);
  }
  return out;
}

}  // namespace gridmorph::casefile
