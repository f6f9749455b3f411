#include <gridmorph/core/error.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <system_error>

namespace gridmorph::mapping {

std::string_view trimmed(std::string_view text) {
  auto const blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    while (!(line = trimmed(line)).empty() && fields.size() <= most_columns) {
      std::size_t const end = std::min(line.find_first_of(" \t"), line.size());
      fields.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    return;
  }
  for (;;) {
    std::size_t const end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos || fields.size() > most_columns) return;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view line) {
  for (char const c : {';', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

std::string plain_name(std::string_view field) {
  std::string name;
  for (char const c : field)
    if (c != '"' && c != '\'' && c != ' ') name += char(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

Lines::Lines(std::string_view text) : text_(text) {
  if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);  // spreadsheet programs write it
}

bool Lines::next() {
  while (!text_.empty()) {
    std::size_t const end = text_.find('\n');
    line_ = trimmed(text_.substr(0, end));
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++number_;
    if (!line_.empty() && line_.front() != '#') return true;
  }
  return false;
}

std::string read_text_file(std::filesystem::path const& path, std::string_view what, std::uintmax_t most) {
  std::error_code error;
  auto const status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw ConfigError(fmt::format("{} '{}' does not exist; {}", what, path.string(), io::looked_for_at(path.string())));
  if (std::filesystem::is_directory(status))
    throw ConfigError(fmt::format("{} '{}' is a directory; give a file", what, path.string()));
  if (!std::filesystem::is_regular_file(status))
    throw ConfigError(
        fmt::format("{} '{}' is no ordinary file (a device, a pipe or a socket); give a file", what, path.string()));
  if (auto const size = std::filesystem::file_size(path, error); !error && size > most)
    throw ConfigError(fmt::format("{} '{}' has {} bytes, too many for one; is it a mesh?", what, path.string(), size));
  return io::read_file(path.string());
}

}  // namespace gridmorph::mapping
