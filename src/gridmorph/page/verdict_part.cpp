#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>
#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::page {

using nlohmann::json;

std::string number(double value) { return format_value(value); }

std::string number(json const& value) {
  return format_value(value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity());
}

std::string count(json const& value) {
  std::string digits = std::to_string(value.is_number() ? value.get<Index>() : 0), out;
  for (std::size_t n = 0; n < digits.size(); ++n) {
    if (n > 0 && (digits.size() - n) % 3 == 0) out += "\u202F";  // narrow, not broken across lines
    out += digits[n];
  }
  return out;
}

json worst_of(json const& quality, std::string const& measure, bool larger_is_bad) {
  json out;
  for (char const* region : {"near_field", "far_field"}) {
    if (!quality.contains(region) || !quality[region]["measures"].contains(measure)) continue;
    json const& now = quality[region]["measures"][measure]["worst"];
    if (out.is_null()) {
      out = now;
      continue;
    }
    double const beyond = larger_is_bad ? HUGE_VAL : -HUGE_VAL;
    double const a = now["value"].is_number() ? now["value"].get<double>() : beyond;
    double const b = out["value"].is_number() ? out["value"].get<double>() : beyond;
    if (larger_is_bad ? a > b : a < b) out = now;
  }
  return out;
}

std::string place_of(json const& worst) {
  CellName name{worst.value("zone", std::string()), {}};
  if (worst.contains("element"))
    name.index = {worst["element"].get<Index>()};
  else if (worst.contains("cell"))
    name.index = worst["cell"].get<std::vector<Index>>();
  else if (worst.contains("node") && worst["node"].is_array())
    return fmt::format("zone '{}' node (i {}, j {}, k {})", name.zone, worst["node"][0].get<Index>(),
                       worst["node"][1].get<Index>(), worst["node"][2].get<Index>());
  else if (worst.contains("node"))
    return fmt::format("zone '{}' node {}", name.zone, worst["node"].get<Index>());
  return name.index.empty() ? std::string() : to_string(name);
}

namespace {

struct Verdict {
  char const* kind;  ///< class: good, short, bad
  char const* mark;
  std::string title, text;
};

Index newly_inverted_of(json const& morphed) {
  Index out = 0;
  for (char const* region : {"near_field", "far_field"}) out += morphed[region]["newly_inverted"].get<Index>();
  if (morphed.contains("certificate")) out = std::max(out, morphed["certificate"]["broken"]["cells"].get<Index>());
  return out;
}

/// " in 2 of 36 passages", " in any of 36 passages".
std::string of_passages(json const& passages, bool inverted, bool falls_short) {
  auto const fails = [&](json const& passage) {
    if (inverted) return passage["newly_inverted"].get<Index>() > 0;
    return std::any_of(passage["shortfalls"].begin(), passage["shortfalls"].end(),
                       [](json const& s) { return s["severity"] == "failure"; });
  };
  if (!inverted && !falls_short) return fmt::format(" in any of {} passages", passages.size());
  return fmt::format(" in {} of {} passages", std::count_if(passages.begin(), passages.end(), fails), passages.size());
}

Verdict verdict_of(ReportPage const& page) {
  json const& report = page.report;
  json const& morphed = report["morphed"];
  Index inverted = newly_inverted_of(morphed);
  bool falls_short = false, left_out = false;
  std::string steps;
  for (json const& s : report["shortfalls"]) falls_short = falls_short || s["severity"] == "failure";
  if (report.contains("sequence")) {
    Index bad = 0, beyond = 0;
    for (json const& step : report["sequence"]["steps"]) {
      bad += step["newly_inverted"].get<Index>() > 0 ? 1 : 0;
      beyond += step["shortfall"].is_null() ? 0 : 1;
      inverted = std::max(inverted, step["newly_inverted"].get<Index>());
      left_out = left_out || !step.contains("file");
    }
    left_out = left_out && step_word(page) == "design";
    falls_short = falls_short || beyond > 0;
    auto const n = report["sequence"]["steps"].size();
    std::string const word = step_word(page);
    steps = bad > 0      ? fmt::format(" in {} of {} {}s", bad, n, word)
            : beyond > 0 ? fmt::format(" in {} of {} {}s", beyond, n, word)
                         : fmt::format(" in any of {} {}s", n, word);
  }
  if (report.contains("passages")) {
    Index of_all = 0;
    for (json const& passage : report["passages"]) of_all += passage["newly_inverted"].get<Index>();
    inverted = std::max(inverted, of_all);
    if (!report.contains("sequence")) steps = of_passages(report["passages"], inverted > 0, falls_short);
  }
  if (inverted > 0) {
    bool const written = !report["output"].is_null();
    return {"bad", "\u2716",
            !written   ? "Inverted: nothing was written"
            : left_out ? "Some designs are inverted: the others are written"
                       : "Inverted, and written all the same",
            fmt::format("{} {}{} turned inside out that {} sound in the baseline.", count(inverted), page.kind, steps,
                        inverted == 1 ? "was" : "were")};
  }
  if (falls_short)
    return {"short", "\u25B2", "Valid, but short of the thresholds",
            "No cell is inverted" + steps +
                " that was sound in the baseline; what falls short of the case file's thresholds is listed below."};
  return {
      "good", "\u2714", "Valid",
      "No cell is inverted" + steps + " that was sound in the baseline, and no threshold of the case file is missed."};
}

std::string certificate_sentence(ReportPage const& page) {
  json const& morphed = page.report["morphed"];
  if (!morphed.contains("certificate")) return {};
  json const& c = morphed["certificate"];
  std::string of_worst = page.report.contains("passages") ? " of the wheel" : "";
  if (page.report.contains("sequence")) of_worst += " of the worst " + step_word(page);
  if (c["holds"].get<bool>())
    return fmt::format(
        "Certified by bounds of the Jacobian over the whole of all {} {}{}, not at corners alone{}{}.",
        count(c["cells"]), page.kind, of_worst,
        c["negative"].get<Index>() > 0
            ? fmt::format("; {} that are negative somewhere were so in the baseline", count(c["negative"]))
            : std::string(),
        c["flat_before"].get<Index>() > 0
            ? fmt::format("; {} that are negative by little were flat in the baseline", count(c["flat_before"]))
            : std::string());
  return fmt::format(
      "Not certified: {} of {} {}{} are negative somewhere that were not in the baseline; the first is {}.",
      count(c["broken"]["cells"]), count(c["cells"]), page.kind, of_worst, escaped(place_of(c["broken"]["first"])));
}

std::string card(std::string const& title, std::string const& value, std::string const& below) {
  return "<div class=\"card\"><span>" + title + "</span><b>" + value + "</b><small>" + below + "</small></div>\n";
}

/// A morphed mesh that the page is about, and what to say before its places.
struct Shown {
  std::string of;
  json const* quality;
};

/// The mesh, or every passage of a wheel.
std::vector<Shown> shown_of(ReportPage const& page) {
  if (!page.report.contains("passages")) return {{"", &page.report["morphed"]}};
  std::vector<Shown> out;
  for (json const& passage : page.report["passages"])
    out.push_back({fmt::format("passage {}, ", passage["passage"].get<Index>()), &passage["quality"]});
  return out;
}

std::string before_after(ReportPage const& page, char const* title, char const* measure, char const* unit) {
  json after;
  std::string of;
  for (Shown const& shown : shown_of(page)) {
    json const worst = worst_of(*shown.quality, measure, false);
    if (worst.is_null()) continue;
    bool const worse = after.is_null() || !worst["value"].is_number() ||
                       (after["value"].is_number() && worst["value"].get<double>() < after["value"].get<double>());
    if (!worse) continue;
    after = worst;
    of = shown.of;
  }
  if (after.is_null()) return {};
  json const before = page.report.contains("baseline") ? worst_of(page.report["baseline"], measure, false) : json();
  std::string const value =
      (before.is_null() ? "" : number(before["value"]) + " \u2192 ") + number(after["value"]) + unit;
  return card(title, value, escaped(of + place_of(after)));
}

std::string wall_card(ReportPage const& page) {
  json const* change = nullptr;
  std::string of;
  for (Shown const& shown : shown_of(page)) {
    json const& quality = *shown.quality;
    if (!quality.contains("walls") || quality["walls"]["nodes"].get<Index>() == 0) continue;
    json const& own = quality["walls"]["first_height_change"];
    if (change != nullptr && !(own["max"].get<double>() > (*change)["max"].get<double>())) continue;
    change = &own;
    of = shown.of;
  }
  if (change == nullptr) return {};
  json const& worst = (*change)["worst"];
  return card("wall spacing, largest change", fmt::format("{} %", number(100 * (*change)["max"].get<double>())),
              escaped(worst.is_null() ? std::string("unchanged") : of + place_of(worst)));
}

double largest_displacement_of(ReportPage const& page) {
  double out = page.largest_displacement;
  if (page.report.contains("passages"))
    for (json const& passage : page.report["passages"])
      out = std::max(out, passage["largest_displacement"].get<double>());
  return out;
}

std::string cards(ReportPage const& page) {
  json const& report = page.report;
  std::string out = "<div class=\"cards\">\n";
  out += before_after(page, "smallest determinant 3\u00d73\u00d73", "determinant_3x3x3", "");
  out += before_after(page, "smallest angle", "minimum_angle_deg", "\u00b0");
  out += wall_card(page);
  if (page.check.periodic_nodes > 0)
    out += card("periodic match", number(page.check.periodic / page.mesh_size),
                "of the mesh size, largest difference of copies");
  if (page.check.slip_nodes > 0)
    out += card("off slip surfaces", number(page.check.slip / page.mesh_size), "of the mesh size, beyond the baseline");
  if (report.contains("passages"))
    out += card("neighbours apart", number(report["largest_seam_gap"].get<double>() / page.mesh_size),
                "of the size of a passage, nodes that coincide, before one took over the other's position");
  double const largest = largest_displacement_of(page);
  out += card("largest displacement", number(largest),
              fmt::format("{} % of the {} size", number(100 * largest / page.mesh_size),
                          report.contains("passages") ? "passage's" : "mesh"));
  double const seconds = report["times"]["total_seconds"].get<double>();
  out += card("time", fmt::format("{} s", number(seconds)), count(report["nodes"]) + " nodes");
  return out + "</div>\n";
}

std::string list_of(std::vector<std::string> const& items, char const* kind) {
  if (items.empty()) return {};
  std::string out = fmt::format("<ul class=\"{}\">\n", kind);
  for (auto const& item : items) out += "<li>" + escaped(item) + "</li>\n";
  return out + "</ul>\n";
}

}  // namespace

std::string verdict_part(ReportPage const& page) {
  Verdict const v = verdict_of(page);
  std::vector<std::string> failures, warnings, notes;
  for (json const& s : page.report["shortfalls"])
    (s["severity"] == "failure" ? failures : warnings).push_back(s["message"]);
  for (json const& n : page.report["notes"]) notes.push_back(n);
  std::string out = fmt::format(
      "<section class=\"verdict {}\" id=\"verdict\"><h2><span aria-hidden=\"true\">{}</span> {}</h2><p>{} {}</p>\n",
      v.kind, v.mark, v.title, v.text, certificate_sentence(page));
  out += list_of(failures, "failures") + list_of(warnings, "warnings") + "</section>\n" + cards(page);
  if (!notes.empty())
    out += fmt::format("<details{}><summary>{} {}</summary>{}</details>\n", notes.size() <= 4 ? " open" : "",
                       notes.size(), notes.size() == 1 ? "note" : "notes", list_of(notes, "notes"));
  return out;
}

}  // namespace gridmorph::page
