// The tables of docs/case_file.md and the reader of case files say the same.
#include "case_text.hpp"

#include <gridmorph/app/casefile/detail/rule_reader.hpp>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::testing {
namespace {

/// One row of a table of the docs.
struct CaseKey {
  /// As "mesh", "mesh axis" (a table in a table), "motion" (keys of every rule), "motion rigid" and "motion rigid rotation" (keys of
  /// one rule); "" for the top level.
  std::string table;
  std::string key;      ///< "<name>": any name
  std::string type;     ///< "string", "number", "[x, y, z]", ...
  std::string unit;     ///< "length" (that of the mesh), "deg", "rad", "1" (a pure number); empty where there is none
  std::string initial;  ///< what holds without the key; "required" when there is no such thing
  std::string example;  ///< a line of TOML with a typical value; further lines where it cannot stand alone
  std::string meaning;
};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// The text between backquotes, which <br> goes on in a new line.
std::string code(std::string text) {
  replace_all(text, "`<br>`", "\n");
  EXPECT_TRUE(text.size() > 1 && text.front() == '`' && text.back() == '`') << text;
  return text.size() > 1 ? text.substr(1, text.size() - 2) : text;
}

CaseKey row_of(std::string const& table, std::string_view line) {
  std::vector<std::string> cells(1);
  for (std::size_t n = 2; n + 1 < line.size(); ++n)
    if (line.substr(n, 3) == " | ") {
      cells.emplace_back();
      n += 2;
    } else if (line.substr(n, 2) == "\\|") {
      cells.back() += line[++n];
    } else {
      cells.back() += line[n];
    }
  if (cells.back().ends_with(' ')) cells.back().pop_back();
  EXPECT_EQ(cells.size(), 6U) << line;
  cells.resize(6);
  return {table, code(cells[0]), cells[1], cells[2], cells[3], code(cells[4]), cells[5]};
}

std::vector<CaseKey> read_docs() {
  std::ifstream in(GRIDMORPH_DOCS_DIR "/case_file.md");
  EXPECT_TRUE(in);
  std::string const open = "<!-- keys: ", close = "<!-- end of keys -->";
  std::vector<CaseKey> out;
  std::string table, line;
  for (bool inside = false; std::getline(in, line);) {
    if (line == close) inside = false;
    if (line.starts_with(open)) {
      inside = true;
      table = line.substr(open.size(), line.find(" -->") - open.size());
      if (table == "top level") table.clear();
    } else if (inside && line.starts_with("| `")) {
      out.push_back(row_of(table, line));
    }
  }
  return out;
}

std::vector<CaseKey> const& case_keys() {
  static std::vector<CaseKey> const keys = read_docs();
  return keys;
}

/// First word of a table's name: "mesh", "motion", ...
std::string top(std::string_view table) { return std::string(table.substr(0, table.find(' '))); }

/// The rule that a table belongs to, "" for keys of all rules and other tables.
std::string rule_of_table(std::string_view table) {
  if (!table.starts_with("motion ")) return "";
  table.remove_prefix(7);
  return std::string(table.substr(0, table.find(' ')));
}

/// The rule of the case file that shows a key; a sequence needs one that changes with time, an amplitude one that moves.
std::string rule_beside(CaseKey const& key) {
  bool const amplitude = key.table == "motion" && key.key.starts_with("amplitude");
  return amplitude ? "rigid" : key.table == "sequence" ? "field" : rule_of_table(key.table);
}

/// What the reader calls the table: without the rule.
std::string as_asked(std::string_view table) {
  std::string const rule = rule_of_table(table);
  if (rule.empty()) return std::string(table);
  return "motion" + std::string(table.substr(7 + rule.size()));
}

/// A case file that has the example of a key and as little else as can be.
std::string case_with(CaseKey const& key, std::string const& rule) {
  std::string const table = top(key.table), example = std::string(key.example) + "\n";
  bool const common = key.table == "motion";
  std::string text = key.table.empty() && key.key == "default" ? example : "";
  text += "[mesh]\n";
  if (!(table == "mesh" && key.key == "input")) text += "input = \"in.cgns\"\n";
  if (table != "mesh" || !example.starts_with("axis")) text += "axis = \"x\"\n";
  if (table == "mesh") text += example;
  if (table == "constants") text += example;
  text += "[[motion]]\n";
  if (!(common && key.key == "patches")) text += "patches = [\"blade\"]\n";
  if (!(common && key.key == "rule")) text += "rule = \"" + (rule.empty() ? "fixed" : rule) + "\"\n";
  if (common && rule == "rigid") text += "translation = [0.1, 0, 0]\n";
  if (table == "sequence") text += "modes = [ { file = \"mode.csv\" } ]\n";
  if (table == "motion") text += example;
  if (!key.table.empty() && table != "mesh" && table != "motion" && table != "constants")
    text += "[" + table + "]\n" + example;
  if (example.find("frequency") != std::string::npos || example.find("amplitude = [[") != std::string::npos)
    text += "[sequence]\nsteps = 4\nperiod = 1\n";
  return text;
}

/// What the reader asks for when it reads every example, per rule.
std::map<std::string, CaseKeyUse> everything_asked() {
  std::map<std::string, CaseKeyUse> asked;
  auto const read = [&](CaseKey const& key, std::string const& rule) {
    try {
      (void)parse_case_file(case_with(key, rule), "case.toml", &asked[rule]);
    } catch (ConfigError const&) {  // files that are not there
    }
  };
  for (auto const& rule : casefile::known_rules()) read({"motion", "rank", "", "", "", "", ""}, rule);
  for (auto const& key : case_keys()) read(key, rule_beside(key));
  return asked;
}

TEST(CaseKeys, EveryKeyThatTheReaderKnowsIsListed) {
  std::set<std::pair<std::string, std::string>> reported;
  for (auto const& [rule, keys] : everything_asked())
    for (auto const& [asked_table, key] : keys) {
      // Tables in a step are those of the rule.
      std::string table = asked_table;
      if (auto const at = table.find(" steps "); at != std::string::npos) table.erase(at, 6);
      // Tables of a blade are those of any rule.
      bool const of_blade = table.starts_with("wheel blade motion");
      if (of_blade) table.erase(0, std::string_view("wheel blade ").size());
      bool const listed = std::any_of(case_keys().begin(), case_keys().end(), [&](CaseKey const& k) {
        std::string const of = rule_of_table(k.table);
        return as_asked(k.table) == table && (k.key == key || k.key == "<name>") &&
               (of.empty() || of == rule || of_blade);
      });
      if (!listed && reported.emplace(table, key).second)
        ADD_FAILURE() << "the reader knows key '" << key << "' of [" << table << "]"
                      << (table.starts_with("motion") ? ", rule \"" + rule + "\"" : "")
                      << ", but docs/case_file.md has no row for it";
    }
}

TEST(CaseKeys, EveryKeyThatIsListedIsKnownToTheReader) {
  auto const asked = everything_asked();
  for (auto const& k : case_keys()) {
    if (k.key == "<name>") continue;
    auto const found = asked.find(rule_beside(k));
    EXPECT_TRUE(found != asked.end() && found->second.count({as_asked(k.table), std::string(k.key)}) == 1)
        << "docs/case_file.md describes '" << k.key << "' of [" << k.table
        << "], but the reader does not ask for it; take it out";
  }
}

TEST(CaseKeys, EveryExampleIsValid) {
  for (auto const& k : case_keys()) {
    std::string const text = case_with(k, rule_beside(k));
    // A motion table has keys without which no other key can stand.
    for (auto const& line : problems_of(text))
      EXPECT_TRUE(line.find("does not exist") != std::string::npos || line.find("no such file") != std::string::npos)
          << "[" << k.table << "] " << k.key << ": " << line << "\n"
          << text;
  }
}

TEST(CaseKeys, EveryLineIsComplete) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  EXPECT_GT(case_keys().size(), 140U);
  for (auto const& k : case_keys()) {
    EXPECT_TRUE(seen.emplace(k.table, k.key).second) << k.table << " " << k.key << " is there twice";
    for (auto const& text : {k.key, k.type, k.initial, k.example, k.meaning})
      EXPECT_FALSE(text.empty()) << k.table << " " << k.key;
  }
}

}  // namespace
}  // namespace gridmorph::testing
