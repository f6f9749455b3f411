#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>
#include <gridmorph/page/view_page.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace gridmorph::page {

namespace {

std::string key_html(ColourKey const& key) {
  if (key.scale != nullptr) return scale_html(*key.scale, key.low, key.high, key.what);
  if (key.names.empty()) return {};
  std::string out = "<p class=\"key\">" + escaped(key.what);
  for (auto const& [colour, name] : key.names)
    out += fmt::format(" <i style=\"background:rgb({} {} {})\"></i>{}", colour.red, colour.green, colour.blue,
                       escaped(name));
  return out + "</p>\n";
}

std::string figure_html(ViewFigure const& f) {
  return figure(image(f.picture, f.title + ": " + f.caption), f.file + ": " + f.caption);
}

}  // namespace

std::string view_page_text(ViewPage const& page) {
  std::string out = page_begin(escaped(page.files) + ": gridmorph view",
                               "<p class=\"dim\">gridmorph " + escaped(page.version) + "</p><h1>" +
                                   escaped(page.files) + "</h1>\n<p class=\"files\">" + escaped(page.summary) + "</p>");
  std::string said;  // once for all pictures in a row that have it
  for (ViewFigure const& f : page.figures) {
    std::string const key = key_html(f.key);
    out += "<section><h3>" + escaped(f.title) + "</h3>\n" + (key == said ? "" : key) + figure_html(f) + "</section>\n";
    said = key;
  }
  if (page.stages.empty()) return out + page_end();
  out += "<section><h3>Stage by stage</h3>\n<div class=\"steps\" data-shown=\"0\">\n";
  for (ViewFigure const& f : page.stages) out += figure_html(f);
  return out + "</div>\n" + key_html(page.stages.front().key) + "</section>\n" + page_end();
}

io::Picture side_by_side(std::span<io::Picture const> pictures) {
  constexpr int band = 12;  // pixels
  int width = -band, height = 0;
  for (io::Picture const& p : pictures) {
    width += p.width + band;
    height = std::max(height, p.height);
  }
  io::Picture out(width, height);
  std::fill(out.rgba.begin(), out.rgba.end(), std::uint8_t(255));
  int left = 0;
  for (io::Picture const& p : pictures) {
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        std::uint8_t const* const from = p.at(x, y);
        std::uint8_t* const to = out.at(left + x, y);
        for (int c = 0; c < 3; ++c) to[c] = std::uint8_t((from[c] * from[3] + 255 * (255 - from[3]) + 127) / 255);
      }
    left += p.width + band;
    for (int y = 0; y < height && left < width; ++y)
      for (int x = left - band; x < left; ++x) std::fill_n(out.at(x, y), 3, std::uint8_t(0xc4));
  }
  return out;
}

}  // namespace gridmorph::page
