#include <gridmorph/case/key_list.hpp>

#include <gridmorph_case_keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gridmorph::casefile {

namespace {

std::string_view trimmed(std::string_view text) {
  auto const begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// "key | type | unit | default | meaning"; what is missing is empty, which a test looks for.
KeyDescription key_of_line(std::string_view table, std::string_view line) {
  std::array<std::string_view, 5> cells;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    auto const end = n + 1 < cells.size() ? line.find('|') : std::string_view::npos;
    cells[n] = trimmed(line.substr(0, end));
    line = end == std::string_view::npos ? std::string_view() : line.substr(end + 1);
  }
  return {table, cells[0], cells[1], cells[2], cells[3], cells[4]};
}

std::vector<KeyDescription> read_list() {
  std::vector<KeyDescription> out;
  std::string_view table;
  for (std::string_view text = keys_text; !text.empty();) {
    std::string_view const line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[')
      table = line.substr(1, line.find(']') - 1);
    else
      out.push_back(key_of_line(table, line));
  }
  return out;
}

void drop(std::string& text, std::string_view part) {
  if (auto const at = text.find(part); at != std::string::npos) text.erase(at, part.size());
}

}  // namespace

std::vector<KeyDescription> const& key_list() {
  static std::vector<KeyDescription> const list = read_list();
  return list;
}

KeyDescription const* find_key(std::string_view table, std::string_view rule, std::string_view key) {
  std::string name(table.empty() ? "top level" : table);
  if (name.starts_with("wheel blade motion")) drop(name, "wheel blade ");
  std::string of_rule;
  if (name == "motion" || name.starts_with("motion ")) {
    of_rule = fmt::format("motion {}{}", rule, name.substr(6));
    // A step has the keys of its rule, and the tables in it too.
    if (of_rule.find(" steps ") != std::string::npos) drop(of_rule, " steps");
  }
  KeyDescription const* any_name = nullptr;
  for (KeyDescription const& k : key_list()) {
    if (k.table != name && k.table != of_rule) continue;
    if (k.key == key) return &k;
    if (k.key == "<name>") any_name = &k;
  }
  return any_name;
}

std::string describe(KeyDescription const& key) {
  std::string_view const unit = key.unit == "1" ? "" : key.unit;
  return fmt::format("{}: {} ({}{}{})", key.key, key.meaning, key.type, unit.empty() ? "" : ", ", unit);
}

}  // namespace gridmorph::casefile
