// The reader of case files knows the keys that its list (keys.txt) and the tables of docs/case_file.md have. That the
// list and the tables say the same is the test docs.case_file_tables.
#include "case_text.hpp"

#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/key_list.hpp>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

/// One row of a table of the docs.
struct CaseKey {
  /// As "mesh", "mesh axis" (a table in a table), "motion" (keys of every rule), "motion rigid" and "motion rigid
  /// rotation" (keys of one rule); "" for the top level.
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

/// The rule of the case file that shows a key; a sequence needs one that changes with time, an amplitude one that
/// moves.
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
  if (table == "constants" || table == "parameters") text += example;
  // A parameter that nothing uses is an error, and so is a sweep of none.
  if (table == "sweep") text += "[parameters]\nlean = { value = 0, range = [-1, 1] }\n";
  if (table == "parameters" || table == "sweep") text += "[constants]\nslope = \"2 * lean\"\n";
  text += "[[motion]]\n";
  if (!(common && key.key == "patches")) text += "patches = [\"blade\"]\n";
  if (!(common && key.key == "rule")) text += "rule = \"" + (rule.empty() ? "fixed" : rule) + "\"\n";
  if (common && rule == "rigid") text += "translation = [0.1, 0, 0]\n";
  if (table == "sequence") text += "modes = [ { file = \"mode.csv\" } ]\n";
  if (table == "motion") text += example;
  if (!key.table.empty() && table != "mesh" && table != "motion" && table != "constants" && table != "parameters")
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
    for (auto const& [place, reading] : keys) {
      auto const& [asked_table, key] = place;
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

TEST(CaseKeys, LinesOfTheListAreForATerminal) {
  auto const& list = casefile::key_list();
  ASSERT_EQ(list.size(), case_keys().size());
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (auto const& k : list) {
    EXPECT_TRUE(seen.emplace(k.table, k.key).second) << k.table << " " << k.key << " twice";
    EXPECT_FALSE(k.meaning.empty()) << k.table << " " << k.key;
    EXPECT_LT(k.meaning.size(), 220U) << k.table << " " << k.key << ": the docs are for what is longer";
    EXPECT_EQ(k.meaning.find("]("), std::string_view::npos) << k.meaning << ": a link, in a terminal";
  }
}

/// "\"a\", \"b\" or \"c\"".
std::string as_type(std::vector<std::string> const& words) {
  std::string out;
  for (std::size_t n = 0; n < words.size(); ++n)
    out += (n == 0 ? "\"" : n + 1 == words.size() ? " or \"" : ", \"") + words[n] + '"';
  return out;
}

/// Whether a type of the list can be what the reader reads a key as.
bool goes_with(std::string_view type, std::string const& read_as) {
  auto const has = [&](std::string_view word) { return type.find(word) != std::string_view::npos; };
  if (has("as of `rigid`")) return true;
  if (read_as == "[x, y, z]") return has("[") || has("as ");
  if (read_as == "list of numbers") return has("list") || has("[") || has("three");
  if (read_as == "number") return has("number") || has("values") || has("factor") || has("three") || has("list of [");
  if (read_as == "whole number") return has("whole number") || has(" to ") || has("0, 1 or 2");
  if (read_as == "string or list") return has("string or list") || has("list of") || has("list") || has("string");
  if (read_as == "table") return has("table");
  if (read_as == "list of tables") return has("list of tables");
  if (read_as == "true or false") return has("true or false");
  for (std::string_view const word : {"string", "file", "folder", "name", "expression", "\""})
    if (has(word)) return true;
  return false;
}

TEST(CaseKeys, TypesOfTheListAreWhatTheReaderReads) {
  std::size_t checked = 0, chosen = 0;
  for (auto const& [rule, keys] : everything_asked())
    for (auto const& [place, reading] : keys) {
      auto const& [table, key] = place;
      auto const* listed = casefile::find_key(table, rule, key);
      if (listed == nullptr) continue;  // that every key is listed is another test
      for (auto const& as : reading.as) {
        EXPECT_TRUE(goes_with(listed->type, as))
            << "[" << listed->table << "] " << key << " is " << listed->type << ", and is read as " << as;
        ++checked;
      }
      // One word of which the reader knows several: the type lists them, as the only ones or beside others.
      if (reading.words.size() < 2) continue;
      std::string_view const type = listed->type;
      for (auto const& word : reading.words)
        EXPECT_NE(type.find('"' + word + '"'), std::string_view::npos)
            << "[" << listed->table << "] " << key << " may be \"" << word << "\", and its type is " << type;
      if (type.starts_with('"') && type.find("table") == std::string_view::npos &&
          type.find('[') == std::string_view::npos && type.find("radius") == std::string_view::npos) {
        EXPECT_EQ(type, as_type(reading.words)) << "[" << listed->table << "] " << key;
        ++chosen;
      }
    }
  EXPECT_GT(checked, 250U);
  EXPECT_GT(chosen, 15U);
}

TEST(CaseKeys, MessagesSayWhatAKeyIsFromTheList) {
  auto const* offset = casefile::find_key("near_field", "", "offset");
  ASSERT_NE(offset, nullptr);
  std::string const rule = "[[motion]]\npatches = \"blade\"\nrule = \"rigid\"\n";
  auto const said = [&](std::string const& more) {
    return problems_of("[mesh]\ninput = \"in.cgns\"\n" + rule + more).at(0);
  };
  EXPECT_NE(said("translation = [1, 0, 0]\n[near_field]\noffset = \"wide\"\n").find(casefile::describe(*offset)),
            std::string::npos);
  // Of the rule that the table belongs to, in tables inside it and in steps.
  for (std::string const table : {"rotation", "steps = [ { rotation"}) {
    std::string const end = table == "rotation" ? "\n" : " } ]\n";
    std::string const text = said(table + " = { angle_deg = \"far\", axis = [1, 0, 0], origin = [0, 0, 0] }" + end);
    EXPECT_NE(text.find(casefile::describe(*casefile::find_key("motion rotation", "rigid", "angle_deg"))),
              std::string::npos)
        << text;
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
}  // namespace gridmorph::test
