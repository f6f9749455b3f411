// What every key of case files is, in one place: messages of the reader and `gridmorph keys` take it from here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::casefile {

/// All texts live as long as the program.
struct KeyDescription {
  /// "top level", "mesh", "mesh axis" (a table in a table), "motion" (keys of every rule), "motion rigid" and "motion
  /// rigid rotation" (of one rule).
  std::string_view table;
  std::string_view key;      ///< "<name>": any name
  std::string_view type;     ///< "string", "number > 0", "[x, y, z]", "\"plane\" or \"baseline\"", ...
  std::string_view unit;     ///< "length" (that of the mesh), "deg", "1" (a pure number); empty where there is none
  std::string_view initial;  ///< what holds without the key; "required" when there is no such thing
  std::string_view meaning;
};

/// Every key, table by table (keys.txt).
std::vector<KeyDescription> const& key_list();

/// A key as the reader meets it: in the table "mesh axis" or "motion rotation", of the rule "rigid"; tables of steps
/// and blades are those of the rule. Null where the list does not have it.
KeyDescription const* find_key(std::string_view table, std::string_view rule, std::string_view key);

/// "key: what it is (number > 0, length)".
std::string describe(KeyDescription const& key);

}  // namespace gridmorph::casefile
