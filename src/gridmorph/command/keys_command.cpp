// keys: what case files can say, from the list that the reader's own messages are made of.
#include <gridmorph/case/key_list.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cli {

namespace {

using casefile::KeyDescription;

std::vector<std::string> words_of(std::string_view table) {
  std::vector<std::string> out(1);
  for (char const c : table)
    if (c == ' ')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

/// Where the keys of a table stand in a case file: [[motion]] rule = "rigid", rotation.
std::string place_of(std::string_view table) {
  if (table == "top level") return "before the first table, and tables";
  auto const words = words_of(table);
  bool const several = words[0] == "motion" || words[0] == "region" || words[0] == "clearance";
  std::string out = several ? "[[" + words[0] + "]]" : "[" + words[0] + "]";
  for (std::size_t n = 1; n < words.size(); ++n)
    out += n == 1 && words[0] == "motion" ? fmt::format(" rule = \"{}\"", words[n]) : (n == 1 ? " " : ", ") + words[n];
  return out;
}

/// A key or its table goes by a name: that of the key, of the table, or of a part of the table's.
bool goes_by(KeyDescription const& key, std::string const& name) {
  auto const words = words_of(key.table);
  return key.key == name || key.table == name || key.table.starts_with(name + ' ') ||
         std::find(words.begin(), words.end(), name) != words.end();
}

std::string instead_of(std::string const& name, std::set<std::string> const& known) {
  std::string const near = nearest_word(name, {known.begin(), known.end()});
  return near.empty() ? "; gridmorph keys lists all" : fmt::format("; did you mean '{}'?", near);
}

std::vector<KeyDescription> chosen_keys(std::vector<std::string> const& names) {
  auto const& all = casefile::key_list();
  if (names.empty()) return all;
  std::set<std::string> known;
  for (KeyDescription const& key : all) {
    known.emplace(key.key);
    for (auto& word : words_of(key.table)) known.insert(word);
  }
  Problems problems;
  for (auto const& name : names)
    if (std::none_of(all.begin(), all.end(), [&](KeyDescription const& k) { return goes_by(k, name); }))
      problems.add(fmt::format("keys: '{}' is no key and no table of case files{}", name, instead_of(name, known)));
  problems.throw_if_any<ConfigError>();
  std::vector<KeyDescription> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), [&](KeyDescription const& key) {
    return std::any_of(names.begin(), names.end(), [&](auto const& name) { return goes_by(key, name); });
  });
  return out;
}

std::string text_of(std::vector<KeyDescription> const& keys) {
  std::string out, table;
  for (KeyDescription const& key : keys) {
    if (key.table != table) {
      out += fmt::format("{}{}\n", table.empty() ? "" : "\n", place_of(key.table));
      table = key.table;
    }
    std::string_view const unit = key.unit == "1" ? "" : key.unit;
    out += fmt::format("  {:<18} {}{}{}{}\n", key.key, key.type, unit.empty() ? "" : ", ", unit,
                       key.initial == "required" ? "; required" : fmt::format("; default: {}", key.initial));
    out += fmt::format("  {:<18} {}\n", "", key.meaning);
  }
  return out;
}

nlohmann::json json_of(std::vector<KeyDescription> const& keys) {
  nlohmann::json list = nlohmann::json::array();
  for (KeyDescription const& key : keys)
    list.push_back({{"table", key.table},
                    {"place", place_of(key.table)},
                    {"key", key.key},
                    {"type", key.type},
                    {"unit", key.unit},
                    {"default", key.initial},
                    {"meaning", key.meaning}});
  return {{"gridmorph", GRIDMORPH_VERSION}, {"keys", list}};
}

}  // namespace

int run_keys_command(CommandLine const& options, Terminal& terminal) {
  auto const keys = chosen_keys(options.names);
  if (terminal.json())
    terminal.document(json_of(keys));
  else
    terminal.result(text_of(keys));
  return done;
}

}  // namespace gridmorph::cli
