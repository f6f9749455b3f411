#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/case/key_list.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/read_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph::casefile {

/// Unknown keys of one table that are listed.
constexpr std::size_t most_unknown_keys = 20;

std::string describe_value(toml::value const& value) {
  switch (value.type()) {
    case toml::value_t::boolean: return value.as_boolean() ? "true" : "false";
    case toml::value_t::integer: return fmt::format("the number {}", value.as_integer());
    case toml::value_t::floating: return fmt::format("the number {}", value.as_floating());
    case toml::value_t::string: return fmt::format("the string \"{}\"", string_of(value));
    case toml::value_t::array: return fmt::format("an array of {}", value.as_array().size());
    case toml::value_t::table: return "a table";
    case toml::value_t::empty: return "nothing";
    default: return "a date or time";
  }
}

TableReader::TableReader(Context& context, toml::value const& table, std::string name, std::string rule)
    : context_(&context), table_(&table), name_(std::move(name)), rule_(std::move(rule)) {
  if (auto const found = table.as_table().find("rule"); found != table.as_table().end() && found->second.is_string())
    rule_ = string_of(found->second);
}

std::string TableReader::plain_name() const {
  std::string name = name_;
  std::erase_if(name, [](char c) { return c == '[' || c == ']'; });
  return name;
}

std::string TableReader::about(std::string const& key) const {
  KeyDescription const* const known = find_key(plain_name(), rule_, key);
  return known == nullptr ? "" : ". " + describe(*known);
}

bool TableReader::has(std::string const& key) const { return table_->as_table().count(key) > 0; }

unsigned TableReader::line(std::string const& key) const {
  auto const& table = table_->as_table();
  auto const found = table.find(key);
  return found == table.end() ? line() : context_->line_of(found->second);
}

toml::value const* TableReader::find(std::string const& key) {
  std::string name = plain_name();
  if (context_->asked != nullptr) (*context_->asked)[{name, key}];
  if (asked_.insert(key).second) known_.push_back(key);
  auto const& table = table_->as_table();
  auto const found = table.find(key);
  if (found == table.end()) return nullptr;
  context_->given.insert({std::move(name), key, int(context_->line_of(found->second))});
  return &found->second;
}

toml::value const* TableReader::find_as(char const* what, std::string const& key) {
  if (context_->asked != nullptr) (*context_->asked)[{plain_name(), key}].as.insert(what);
  return find(key);
}

void TableReader::problem(std::string const& key, std::string const& text) {
  context_->problem(line(key), fmt::format("{}{}{}: {}", name_, name_.empty() ? "" : " ", key, text));
}

std::optional<std::filesystem::path> TableReader::input(std::string const& key) {
  auto const name = string(key);
  if (!name) return std::nullopt;
  auto path = context_->input(*name);
  if (!is_there(path.string()))
    problem(key, fmt::format("'{}' does not exist; {}", *name, io::looked_for_at(path.string())));
  return path;
}

void TableReader::require(std::string const& key, std::string_view what_to_write) {
  if (find(key) == nullptr)
    context_->problem(line(), fmt::format("{}{}key '{}' is missing; add {}{}", name_, name_.empty() ? "" : ": ", key,
                                          what_to_write, about(key)));
}

bool TableReader::is_text(std::string const& key, std::string const& value) {
  if (value.find('\0') == std::string::npos) return true;
  problem(key, "holds the character \\u0000, which no name and no file has; remove it");
  return false;
}

std::optional<std::string> TableReader::string(std::string const& key) {
  auto const* value = find_as("string", key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) {
    problem(key,
            fmt::format("expected a string, found {}; write {} = \"...\"{}", describe_value(*value), key, about(key)));
    return std::nullopt;
  }
  if (string_of(*value).empty()) {
    problem(key, "the string is empty; give a value or remove the key");
    return std::nullopt;
  }
  if (!is_text(key, string_of(*value))) return std::nullopt;
  return string_of(*value);
}

std::optional<bool> TableReader::boolean(std::string const& key) {
  auto const* value = find_as("true or false", key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_boolean()) {
    problem(key, fmt::format("expected true or false, found {}{}", describe_value(*value), about(key)));
    return std::nullopt;
  }
  return value->as_boolean();
}

std::optional<double> TableReader::value_of(toml::value const& value, std::string const& key) {
  if (value.is_integer()) return double(value.as_integer());
  if (value.is_floating() && std::isfinite(value.as_floating())) return value.as_floating();
  if (!value.is_string() || context_->names.empty()) return std::nullopt;
  unsigned const line = context_->line_of(value);
  context_->expressions.push_back({{plain_name(), key, int(line)}, string_of(value)});
  return value_of_formula({key, string_of(value), context_->where(line)}, context_->names, context_->problems);
}

std::optional<double> TableReader::finite(toml::value const& value, std::string const& key) {
  std::size_t const before = context_->problems.messages().size();
  auto const number = value_of(value, key);
  if (!number && context_->problems.messages().size() == before)
    problem(key, value.is_floating() ? fmt::format("expected a finite number, found {}", value.as_floating())
                                     : fmt::format("expected a number, found {}{}", describe_value(value), about(key)));
  return number;
}

std::optional<double> TableReader::number(std::string const& key) {
  auto const* value = find_as("number", key);
  return value == nullptr ? std::nullopt : finite(*value, key);
}

std::optional<int> TableReader::integer(std::string const& key) {
  auto const* value = find_as("whole number", key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_integer()) {
    problem(key, fmt::format("expected a whole number, found {}{}", describe_value(*value), about(key)));
    return std::nullopt;
  }
  auto const wide = value->as_integer();
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) {
    problem(key, fmt::format("{} is too large", wide));
    return std::nullopt;
  }
  return int(wide);
}

std::optional<std::vector<double>> TableReader::numbers(std::string const& key) {
  return list_of_numbers("list of numbers", key);
}

std::optional<std::vector<double>> TableReader::list_of_numbers(char const* what, std::string const& key) {
  auto const* value = find_as(what, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_array()) {
    problem(key, fmt::format("expected an array of numbers, found {}{}", describe_value(*value), about(key)));
    return std::nullopt;
  }
  std::vector<double> out;
  for (auto const& item : value->as_array()) {
    auto const number = finite(item, key);
    if (!number) return std::nullopt;
    out.push_back(*number);
  }
  return out;
}

std::optional<Vec3> TableReader::vector(std::string const& key) {
  auto const list = list_of_numbers("[x, y, z]", key);
  if (!list) return std::nullopt;
  if (list->size() != 3) {
    problem(key, fmt::format("expected three numbers [x, y, z], found {}{}", list->size(), about(key)));
    return std::nullopt;
  }
  return Vec3{(*list)[0], (*list)[1], (*list)[2]};
}

std::optional<std::vector<std::string>> TableReader::strings(std::string const& key) {
  auto const* value = find_as("string or list", key);
  if (value == nullptr) return std::nullopt;
  std::vector<std::string> out;
  if (value->is_string())
    out.push_back(string_of(*value));
  else if (value->is_array()) {
    for (auto const& item : value->as_array()) {
      if (!item.is_string()) {
        problem(key, fmt::format("expected strings, found {} among them", describe_value(item)));
        return std::nullopt;
      }
      out.push_back(string_of(item));
    }
  } else {
    problem(key,
            fmt::format("expected a string or an array of strings, found {}{}", describe_value(*value), about(key)));
    return std::nullopt;
  }
  if (out.empty()) {
    problem(key, "the list is empty; give at least one name or remove the key");
    return std::nullopt;
  }
  if (std::find(out.begin(), out.end(), std::string()) != out.end()) {
    problem(key, "one of the strings is empty; give a name");
    return std::nullopt;
  }
  for (std::string const& one : out)
    if (!is_text(key, one)) return std::nullopt;
  return out;
}

std::optional<TableReader> TableReader::table(std::string const& key) {
  auto const* value = find_as("table", key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_table()) {
    problem(key, fmt::format("expected a table {{ ... }}, found {}{}", describe_value(*value), about(key)));
    return std::nullopt;
  }
  return TableReader(*context_, *value, name_.empty() ? fmt::format("[{}]", key) : fmt::format("{} {}", name_, key),
                     rule_);
}

std::vector<TableReader> TableReader::tables(std::string const& key) {
  auto const* value = find_as("list of tables", key);
  std::vector<TableReader> out;
  if (value == nullptr) return out;
  std::string const name = name_.empty() ? fmt::format("[[{}]]", key) : fmt::format("{} {}", name_, key);
  if (value->is_table()) {
    out.emplace_back(*context_, *value, name_.empty() ? fmt::format("[{}]", key) : name, rule_);
    return out;
  }
  bool const usable = value->is_array() && std::all_of(value->as_array().begin(), value->as_array().end(),
                                                       [](toml::value const& item) { return item.is_table(); });
  if (!usable) {
    problem(key, fmt::format("expected a table or an array of tables, found {}{}", describe_value(*value), about(key)));
    return out;
  }
  for (auto const& item : value->as_array()) out.emplace_back(*context_, item, name, rule_);
  return out;
}

std::optional<std::size_t> TableReader::choice(std::string const& key, std::vector<std::string> const& words) {
  auto const word = string(key);
  if (context_->asked != nullptr) (*context_->asked)[{plain_name(), key}].words = words;
  if (!word) return std::nullopt;
  auto const found = std::find(words.begin(), words.end(), *word);
  if (found == words.end()) {
    problem(key, fmt::format("\"{}\" is not known{}", *word, suggestion(*word, words)));
    return std::nullopt;
  }
  return std::size_t(found - words.begin());
}

void TableReader::finish() {
  std::vector<std::pair<unsigned, std::string>> unknown;  // toml11 keeps keys in no order: report them by line
  std::size_t left_out = 0;
  for (auto const& [key, value] : table_->as_table()) {
    if (asked_.contains(key)) continue;
    if (unknown.size() < most_unknown_keys)
      unknown.emplace_back(context_->line_of(value), key);
    else
      ++left_out;
  }
  std::sort(unknown.begin(), unknown.end());
  for (auto const& [line, key] : unknown)
    context_->problem(
        line, fmt::format("{}{}unknown key '{}'{}", name_, name_.empty() ? "" : ": ", key, suggestion(key, known_)));
  if (left_out > 0)
    context_->problem(
        line(), fmt::format("{}{}{} more unknown keys are not listed", name_, name_.empty() ? "" : ": ", left_out));
}

}  // namespace gridmorph::casefile
