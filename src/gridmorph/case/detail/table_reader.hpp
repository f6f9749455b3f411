// Reads one TOML table key by key: every problem is noted with its line and reading goes on, so that one pass over a
// case file reports all of them. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/toml.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

/// Where problems of one case file go.
struct Context {
  std::string file;                 ///< as the user named it
  std::filesystem::path directory;  ///< relative paths in the case file start here
  Problems problems;
  CaseKeyUse* asked = nullptr;                 ///< every key that is asked for, where somebody wants to know
  std::set<GivenKey> given{};                  ///< every key that is asked for and there
  std::vector<std::filesystem::path> files{};  ///< that have been named as inputs
  std::shared_ptr<TomlLines const> lines{};    ///< of the file

  std::vector<std::string> notes{};  ///< what was taken that nobody wrote

  std::map<std::string, double> names{};  ///< of [parameters] and [constants]; where there are any, strings in the
                                          ///< place of numbers are expressions of them
  /// Keys that are such expressions.
  std::vector<std::pair<GivenKey, std::string>> expressions{};

  /// A file as a key names it, to be read; noted, so that no output takes its place.
  std::filesystem::path input(std::string const& name) {
    return files.emplace_back((directory / name).lexically_normal());
  }

  void problem(unsigned line, std::string const& text) { problems.add(where(line) + ": " + text); }
  [[nodiscard]] unsigned line_of(toml::value const& value) const { return lines ? lines->of(value) : 1; }
  [[nodiscard]] std::string where(unsigned line) const { return file + ":" + std::to_string(line); }
};

/// Keys are known because somebody asks for them; finish() reports every key that nobody asked for.
class TableReader {
 public:
  /// `name` is how messages call the table: "[mesh]", "[[motion]]", "[mesh] axis".
  TableReader(Context& context, toml::value const& table, std::string name, std::string rule = "");

  [[nodiscard]] bool has(std::string const& key) const;
  [[nodiscard]] unsigned line() const { return context_->line_of(*table_); }
  [[nodiscard]] unsigned line(std::string const& key) const;
  [[nodiscard]] std::string where(std::string const& key) const { return context_->where(line(key)); }
  [[nodiscard]] Context& context() const { return *context_; }

  /// The value as it stands, or nothing. Marks the key as known.
  toml::value const* find(std::string const& key);

  /// All of the table as it stands. Marks none of them as known.
  [[nodiscard]] toml::table const& keys() const { return table_->as_table(); }
  /// A number, or an expression of Context::names, as part of the value of a key; nothing, and no word, for others.
  /// Expressions that have no value are noted.
  std::optional<double> value_of(toml::value const& value, std::string const& key);

  // Each returns nothing when the key is absent, and also (after noting the problem) when its value is of another type.
  std::optional<std::string> string(std::string const& key);
  std::optional<bool> boolean(std::string const& key);
  std::optional<double> number(std::string const& key);  ///< integer, float or expression (value_of()), finite
  std::optional<int> integer(std::string const& key);
  std::optional<Vec3> vector(std::string const& key);  ///< three numbers
  std::optional<std::vector<double>> numbers(std::string const& key);
  std::optional<std::vector<std::string>> strings(std::string const& key);  ///< one string or several, none empty
  std::optional<TableReader> table(std::string const& key);
  /// One table or an array of tables.
  std::vector<TableReader> tables(std::string const& key);
  /// Index in `words` of a string value; a problem that names the nearest word otherwise.
  std::optional<std::size_t> choice(std::string const& key, std::vector<std::string> const& words);

  /// A file that is read later, as a key names it; noted as Context::input() does, and a problem where it is not there.
  std::optional<std::filesystem::path> input(std::string const& key);
  /// Notes that a key is missing.
  void require(std::string const& key, std::string_view what_to_write);
  /// Notes a problem with the value of a key (with the table's own line when the key is absent).
  void problem(std::string const& key, std::string const& text);
  /// Notes every key that nobody asked for, with the nearest known key.
  void finish();

 private:
  std::optional<double> finite(toml::value const& value, std::string const& key);
  std::optional<std::vector<double>> list_of_numbers(char const* what, std::string const& key);
  /// find(), where the key is read as one thing: see KeyReading.
  toml::value const* find_as(char const* what, std::string const& key);
  /// Whether a string could be a name; messages would end at a zero in it. Notes a problem where not.
  bool is_text(std::string const& key, std::string const& value);
  [[nodiscard]] std::string plain_name() const;
  /// ". offset: ... (number > 0, length)", to end a message with; empty where the list of keys has nothing.
  [[nodiscard]] std::string about(std::string const& key) const;

  Context* context_;
  toml::value const* table_;
  std::string name_;
  std::string rule_;                ///< of the [[motion]] that this is, or is a part of
  std::vector<std::string> known_;  ///< keys in the order in which they were asked for
  std::set<std::string> asked_;     ///< the same ones
};

/// "a string", "an array", ... for messages, with the value if it is short.
std::string describe_value(toml::value const& value);

}  // namespace gridmorph::casefile
