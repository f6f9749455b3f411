#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace gridmorph::page {

using nlohmann::json;

namespace {

struct Curve {
  std::string title;
  std::vector<double> value;
  double low = 0;  ///< what the axis includes
};

/// Values over time, or of designs, with a mark at the worst step.
std::string curve_svg(Curve const& curve, std::vector<double> const& time, std::size_t worst, char const* axis) {
  constexpr double wide = 560, high = 180, left = 64, right = 12, top = 10, bottom = 30;
  auto [least, most] = std::minmax_element(curve.value.begin(), curve.value.end());
  double const low = std::min(curve.low, *least), height = std::max(*most - low, 1e-300);
  double const span = std::max(time.back() - time.front(), 1e-300);
  auto const x = [&](std::size_t n) {
    return left + (wide - left - right) * (time.size() == 1 ? 0.5 : (time[n] - time.front()) / span);
  };
  auto const y = [&](double v) { return high - bottom - (high - top - bottom) * (v - low) / height; };
  std::string path;
  for (std::size_t n = 0; n < time.size(); ++n)
    path += fmt::format("{}{:.1f} {:.1f}", n == 0 ? "M" : "L", x(n), y(curve.value[n]));
  std::string svg = fmt::format(
      "<svg class=\"curve\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "aria-label=\"{2}\">",
      wide, high, escaped(curve.title));
  for (double const v : {low, low + 0.5 * height, low + height})
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>",
        left, y(v), wide - right, left - 6, y(v) + 4, fmt::format("{:.3g}", v));
  svg += fmt::format("<path class=\"line\" d=\"{}\"/>", path);
  for (std::size_t n = 0; n < time.size() && time.size() <= 200; ++n)
    svg += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", n == worst ? "worst" : "dot",
                       x(n), y(curve.value[n]), n == worst ? 5 : 2.5);
  for (std::size_t const n : {std::size_t(0), time.size() - 1})
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{:.4g}</text>", x(n), high - 10,
                       n == 0 ? "start" : "end", time[n]);
  return svg + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text></svg>",
                           0.5 * (left + wide), high - 10, axis);
}

std::string step_caption(json const& step) {
  std::string when;
  if (step.contains("time")) {
    when = ", time " + number(step["time"]);
  } else {
    for (auto const& [name, value] : step["parameters"].items()) when += fmt::format(", {} {}", name, number(value));
  }
  std::string text = fmt::format("{} {}{}: largest displacement {}", step.contains("time") ? "step" : "design",
                                 step["step"].get<Index>(), when, number(step["largest_displacement"]));
  if (!step["min_determinant"].is_null()) text += ", smallest determinant " + number(step["min_determinant"]["value"]);
  if (Index const n = step["newly_inverted"].get<Index>(); n > 0) text += fmt::format(", {} newly inverted", n);
  return text;
}

/// Where the smallest determinant of a step is: of a wheel in which passage too.
std::string place_in_step(json const& step) {
  json const& least = step["min_determinant"];
  if (least.is_null()) return {};
  std::string const passage =
      step.contains("worst_passage") ? fmt::format("passage {}, ", step["worst_passage"].get<Index>()) : std::string();
  return escaped(passage + place_of(least));
}

}  // namespace

std::string sequence_part(ReportPage const& page) {
  if (!page.report.contains("sequence")) return {};
  json const& sequence = page.report["sequence"];
  json const& steps = sequence["steps"];
  auto const worst = sequence["worst_step"].get<std::size_t>() - 1;
  std::vector<double> time;
  bool const of_designs = sequence.contains("parameters");
  std::string const word = step_word(page), over = of_designs ? " of the designs" : " over time";
  char const* const axis = of_designs ? "design" : "time";
  Curve quality{"smallest determinant 3\u00d73\u00d73" + over, {}, 0}, motion{"largest displacement" + over, {}, 0};
  for (json const& step : steps) {
    time.push_back(of_designs ? double(time.size() + 1) : step["time"].get<double>());
    motion.value.push_back(step["largest_displacement"]);
    if (!step["min_determinant"].is_null() && step["min_determinant"]["value"].is_number())
      quality.value.push_back(step["min_determinant"]["value"]);
  }
  std::string out = fmt::format("<section id=\"sequence\"><h2>The {} {}s</h2>\n", steps.size(), word);
  if (!page.steps.empty()) {
    std::size_t shown = 0;
    for (std::size_t n = 0; n < page.steps.size(); ++n)
      if (page.steps[n].step == int(worst) + 1) shown = n;
    out += fmt::format("<div class=\"steps\" data-shown=\"{}\">\n", shown);
    for (StepFigure const& f : page.steps) out += figure(f.body, step_caption(steps[f.step - 1]));
    out += "</div>\n" + scale_of_displacement(page.scale_end);
    if (page.steps.size() < steps.size())
      out += fmt::format("<p class=\"dim\">{} of {} {}s are shown, the worst one among them.</p>\n", page.steps.size(),
                         steps.size(), word);
  }
  out += "<div class=\"figures charts\">";
  if (quality.value.size() == time.size())
    out += figure(curve_svg(quality, time, worst, axis),
                  quality.title + fmt::format("; the worst is {} {}", word, worst + 1));
  out += figure(curve_svg(motion, time, worst, axis), motion.title) + "</div>\n";
  std::vector<std::string> const varied =
      of_designs ? sequence["parameters"].get<std::vector<std::string>>() : std::vector<std::string>{"time"};
  std::vector<Table::Column> columns{{word, true}};
  for (std::string const& name : varied) columns.push_back({name, true});
  for (Table::Column const& c :
       {Table::Column{"largest displacement", true}, Table::Column{"smallest determinant", true},
        Table::Column{"newly inverted", true}, Table::Column{"at"}, Table::Column{"short of a threshold"}})
    columns.push_back(c);
  Table table(std::move(columns));
  constexpr std::size_t most_rows = 100;
  std::size_t const stride = (steps.size() + most_rows - 1) / most_rows;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (s % stride != 0 && s != worst) continue;
    json const& step = steps[s];
    json const& least = step["min_determinant"];
    std::vector<std::string> row{s == worst ? fmt::format("<b>{}</b>", s + 1) : std::to_string(s + 1)};
    for (std::string const& name : varied) row.push_back(number(of_designs ? step["parameters"][name] : step["time"]));
    for (std::string const& cell :
         {number(step["largest_displacement"]), least.is_null() ? std::string() : number(least["value"]),
          count(step["newly_inverted"]), place_in_step(step),
          step["shortfall"].is_null() ? std::string() : escaped(step["shortfall"].get<std::string>())})
      row.push_back(cell);
    table.add(std::move(row));
  }
  return out + table.html() + "</section>\n";
}

}  // namespace gridmorph::page
