#include <gridmorph/page/html.hpp>

#include <fmt/format.h>

#include <cstddef>

namespace gridmorph::page {

namespace {

/// Bytes of the character that begins there (RFC 3629); 0 where none does.
std::size_t length_of_character(std::string_view text, std::size_t at) {
  auto const byte = [&](std::size_t n) { return at + n < text.size() ? static_cast<unsigned char>(text[at + n]) : 0U; };
  unsigned const b = byte(0);
  auto const goes_on = [&](std::size_t n) { return (byte(n) & 0xC0U) == 0x80U; };
  if (b < 0x80) return 1;
  if (b >= 0xC2 && b < 0xE0) return goes_on(1) ? 2 : 0;
  if (b >= 0xE0 && b < 0xF0) {
    bool const overlong = b == 0xE0 && byte(1) < 0xA0, surrogate = b == 0xED && byte(1) >= 0xA0;
    return goes_on(1) && goes_on(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (b >= 0xF0 && b < 0xF5) {
    bool const overlong = b == 0xF0 && byte(1) < 0x90, beyond = b == 0xF4 && byte(1) >= 0x90;
    return goes_on(1) && goes_on(2) && goes_on(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    std::size_t const n = length_of_character(text, at);
    auto const c = static_cast<unsigned char>(text[at]);
    bool const control = n == 1 && ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7F);
    bool const control_of_two = n == 2 && c == 0xC2 && static_cast<unsigned char>(text[at + 1]) < 0xA0;
    if (n == 0 || control || control_of_two)
      out += "\uFFFD";
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += text.substr(at, n);
    at += n == 0 ? 1 : n;
  }
  return out;
}

std::string Table::html() const {
  auto const cell = [&](char const* tag, std::size_t column, std::string const& content) {
    return fmt::format("<{0}{1}>{2}</{0}>", tag, columns_[column].number ? " class=\"n\"" : "", content);
  };
  std::string text = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t c = 0; c < columns_.size(); ++c) text += cell("th", c, escaped(columns_[c].title));
  text += "</tr></thead><tbody>\n";
  for (auto const& row : rows_) {
    text += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) text += cell("td", c, row[c]);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string image(io::Picture const& picture, std::string_view description) {
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\">", picture.width, picture.height,
                     escaped(description), io::png_data_uri(picture));
}

std::string figure(std::string const& body, std::string_view caption) {
  return "<figure>" + body + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

}  // namespace gridmorph::page
