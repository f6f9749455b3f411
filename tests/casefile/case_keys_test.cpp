// docs/case_file.md, the list of keys and the reader of case files say the same.
//
// With GRIDMORPH_WRITE_DOCS=1 in the environment the tables of docs/case_file.md are written anew instead of compared.
#include "case_text.hpp"

#include <gridmorph/app/casefile/case_keys.hpp>
#include <gridmorph/app/casefile/detail/rule_reader.hpp>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

namespace gridmorph::testing {
namespace {

constexpr std::string_view note =
    "list it in src/gridmorph/app/casefile/case_keys.cpp, then run this test with GRIDMORPH_WRITE_DOCS=1";

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
                      << ", but nothing describes it; " << note;
    }
}

TEST(CaseKeys, EveryKeyThatIsListedIsKnownToTheReader) {
  auto const asked = everything_asked();
  for (auto const& k : case_keys()) {
    if (k.key == "<name>") continue;
    auto const found = asked.find(rule_beside(k));
    EXPECT_TRUE(found != asked.end() && found->second.count({as_asked(k.table), std::string(k.key)}) == 1)
        << "case_keys.cpp describes '" << k.key << "' of [" << k.table
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
  for (auto const& k : case_keys()) {
    EXPECT_TRUE(seen.emplace(k.table, k.key).second) << k.table << " " << k.key << " is there twice";
    for (auto const text : {k.key, k.type, k.initial, k.example, k.meaning})
      EXPECT_FALSE(text.empty()) << k.table << " " << k.key;
  }
}

TEST(CaseKeys, TheTablesOfTheDocsAreThoseOfTheList) {
  std::filesystem::path const path = GRIDMORPH_DOCS_DIR "/case_file.md";
  std::ifstream in(path);
  ASSERT_TRUE(in) << path;
  std::ostringstream whole;
  whole << in.rdbuf();
  in.close();
  std::string docs = whole.str();
  std::set<std::string> tables, described;
  for (auto const& k : case_keys()) tables.emplace(k.table);
  bool const write = std::getenv("GRIDMORPH_WRITE_DOCS") != nullptr;
  std::string const open = "<!-- keys: ", close = "<!-- end of keys -->";
  for (std::size_t at = docs.find(open); at != std::string::npos; at = docs.find(open, at + 1)) {
    std::size_t const name_at = at + open.size(), name_end = docs.find(" -->", name_at);
    ASSERT_NE(name_end, std::string::npos);
    std::string name = docs.substr(name_at, name_end - name_at);
    if (name == "top level") name.clear();
    std::size_t const begin = docs.find('\n', name_end) + 1, end = docs.find(close, begin);
    ASSERT_NE(end, std::string::npos) << name;
    described.insert(name);
    EXPECT_EQ(tables.count(name), 1U) << "docs/case_file.md has a table for [" << name << "], which has no keys";
    std::string const expected = "\n" + case_key_table(name) + "\n";
    if (write)
      docs.replace(begin, end - begin, expected);
    else
      EXPECT_EQ(docs.substr(begin, end - begin), expected)
          << "docs/case_file.md, [" << name << "]: not what case_keys.cpp says; " << note;
  }
  for (auto const& table : tables)
    EXPECT_EQ(described.count(table), 1U) << "docs/case_file.md has no table for [" << table << "]; add the lines\n"
                                          << open << (table.empty() ? "top level" : table) << " -->\n"
                                          << close;
  if (write) std::ofstream(path) << docs;
}

}  // namespace
}  // namespace gridmorph::testing
