// Every key of a case file with what it means: the tables of docs/case_file.md are made from this list, and a test
// compares it with what the reader asks for. Whoever adds a key to the reader adds a line here.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gridmorph {

struct CaseKey {
  /// As "mesh", "mesh axis" (a table in a table), "motion" (keys of every rule), "motion rigid" and "motion rigid rotation" (keys of
  /// one rule); "" for the top level.
  std::string_view table;
  std::string_view key;   ///< "<name>": any name
  std::string_view type;  ///< "string", "number", "[x, y, z]", "\"a\" or \"b\"", ...
  std::string_view unit;  ///< "length" (that of the mesh), "deg", "rad", "1" (a pure number); empty where there is none
  std::string_view initial;  ///< what holds without the key; "required" when there is no such thing
  std::string_view example;  ///< a line of TOML with a typical value; further lines where it cannot stand alone
  std::string_view meaning;
};

/// In the order of the docs.
std::span<CaseKey const> case_keys();

/// The keys of one table as a Markdown table.
std::string case_key_table(std::string_view table);

}  // namespace gridmorph
