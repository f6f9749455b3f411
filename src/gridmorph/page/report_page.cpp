#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>
#include <gridmorph_page_files.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace gridmorph::page {

using nlohmann::json;

std::string times_part(ReportPage const& page) {
  json const& times = page.report["times"];
  double const total = times["total_seconds"].get<double>();
  Table table({{"step"}, {"seconds", true}, {"share"}, {"nodes per second", true}});
  for (json const& step : times["steps"]) {
    double const share = total > 0 ? 100 * step["seconds"].get<double>() / total : 0;
    table.add({escaped(step["step"].get<std::string>()), fmt::format("{:.3f}", step["seconds"].get<double>()),
               fmt::format("<span class=\"bar\"><i style=\"width:{:.1f}%\"></i></span>", share),
               step["nodes_per_second"].is_number() ? count(json(Index(step["nodes_per_second"].get<double>()))) : ""});
  }
  table.add({"<b>sum</b>", fmt::format("<b>{:.3f}</b>", total), "", ""});
  return "<section id=\"timings\"><h2>Timings</h2>\n" + table.html() + "</section>\n";
}

std::string repeat_part(ReportPage const& page) {
  std::string out = "<section id=\"repeat\"><h2>To repeat the run</h2>\n";
  if (!page.command_line.empty()) out += "<pre><code>" + escaped(page.command_line) + "</code></pre>\n";
  Table table({{"what"}, {"value"}});
  for (auto const& [name, value] : page.settings) table.add({escaped(name), escaped(value)});
  out += table.html();
  if (!page.case_text.empty())
    out += "<h3>" + escaped(page.report["case_file"].get<std::string>()) + "</h3>\n<pre><code>" +
           escaped(page.case_text) + "</code></pre>\n";
  return out + "</section>\n";
}

std::string page_begin(std::string_view title, std::string_view header) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
         "'unsafe-inline'; script-src "
         "'unsafe-inline'\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" "
         "content=\"light dark\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         std::string(title) + "</title>\n<style>\n" + std::string(page_css) + "</style>\n</head>\n<body>\n<header>" +
         std::string(header) + "</header>\n<main>\n";
}

std::string page_end() { return "</main>\n<script>\n" + std::string(page_js) + "</script>\n</body>\n</html>\n"; }

std::string page_text(ReportPage const& page) {
  std::string const file = page.report["case_file"].get<std::string>();
  std::string const name = escaped(file.substr(file.find_last_of('/') + 1));
  std::string const input = escaped(page.report["input"].get<std::string>());
  std::string const output = page.report["output"].is_null() ? std::string("nothing written")
                                                             : escaped(page.report["output"].get<std::string>());
  std::string out =
      page_begin(name + ": gridmorph report",
                 "<p class=\"dim\">gridmorph " + escaped(page.report["gridmorph"].get<std::string>()) + "</p><h1>" +
                     name + "</h1>\n<p class=\"files\">" + input + " \u2192 " + output + "</p>");
  struct Part {
    char const *id, *title;
    std::string text;
  };
  bool const of_designs = page.report.contains("sequence") && step_word(page) == "design";
  std::vector<Part> const parts{{"moved", "What moved", motion_part(page)},
                                {"sequence", of_designs ? "Designs" : "Steps", sequence_part(page)},
                                {"passages", "Passages", passages_part(page)},
                                {"plan", "Plan", plan_part(page)},
                                {"quality", "Quality", quality_part(page)},
                                {"sections", "Sections", sections_part(page)},
                                {"timings", "Timings", times_part(page)},
                                {"repeat", "Repeat", repeat_part(page)}};
  out += verdict_part(page) + "<nav aria-label=\"parts of the page\">";
  for (Part const& part : parts)
    if (!part.text.empty()) out += fmt::format("<a href=\"#{}\">{}</a> ", part.id, part.title);
  out += "</nav>\n";
  for (Part const& part : parts) out += part.text;
  return out + page_end();
}

}  // namespace gridmorph::page
