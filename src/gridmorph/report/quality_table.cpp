#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <numeric>
#include <string_view>
#include <tuple>
#include <vector>

namespace gridmorph {

namespace {

/// One column: a region of one of the two reports.
struct Column {
  std::string_view region, state;
  QualityRegion const* values;
};

std::vector<Column> columns(QualityReport const& baseline, std::optional<QualityReport> const& morphed) {
  std::vector<Column> list;
  auto const add = [&](std::string_view name, QualityRegion QualityReport::*region) {
    if ((baseline.*region).cells > 0) list.push_back({name, "baseline", &(baseline.*region)});
    if (morphed && ((*morphed).*region).cells > 0) list.push_back({name, "morphed", &((*morphed).*region)});
  };
  add("near field", &QualityReport::near_field);
  add("far field", &QualityReport::far_field);
  return list;
}

constexpr std::string_view row_start = "{:<30}";
constexpr std::string_view cell = "{:>14}";

void row(std::string& out, std::string_view title, std::vector<Column> const& list,
         std::function<std::string(QualityRegion const&)> const& value) {
  out += fmt::format(fmt::runtime(row_start), title);
  for (Column const& c : list) out += fmt::format(fmt::runtime(cell), value(*c.values));
  out += '\n';
}

void measure_row(std::string& out, std::vector<Column> const& list, Measure measure, std::string_view statistic,
                 double MeasureStatistics::*member) {
  if (std::none_of(list.begin(), list.end(), [&](Column const& c) { return (*c.values)[measure].worst_zone >= 0; }))
    return;
  row(out, fmt::format("{}, {}", text_of(measure).title, statistic), list, [&](QualityRegion const& r) {
    MeasureStatistics const& s = r[measure];
    return s.worst_zone < 0 ? std::string("-") : format_value(s.*member);
  });
}

void heading(std::string& out, std::string_view title, std::vector<Column> const& list) {
  out += fmt::format(fmt::runtime(row_start), title);
  for (Column const& c : list) out += fmt::format(fmt::runtime(cell), c.region);
  out += '\n' + fmt::format(fmt::runtime(row_start), "");
  for (Column const& c : list) out += fmt::format(fmt::runtime(cell), c.state);
  out += '\n';
}

void walls(std::string& out, QualityReport const& baseline, std::optional<QualityReport> const& morphed) {
  if (baseline.wall.nodes == 0) return;
  out += fmt::format("\n{:<30}{:>14}", fmt::format("Walls ({} nodes)", baseline.wall.nodes), "baseline");
  if (morphed) out += fmt::format("{:>14}", "morphed");
  out += '\n';
  auto const wall_row = [&](std::string_view title, double WallQuality::*member) {
    out += fmt::format("{:<30}{:>14}", title, format_value(baseline.wall.*member));
    if (morphed) out += fmt::format("{:>14}", format_value(morphed->wall.*member));
    out += '\n';
  };
  wall_row("first cell height, min", &WallQuality::first_height_min);
  wall_row("first cell height, mean", &WallQuality::first_height_mean);
  wall_row("first cell height, max", &WallQuality::first_height_max);
  wall_row("line to normal [deg], mean", &WallQuality::orthogonality_deg_mean);
  wall_row("line to normal [deg], max", &WallQuality::orthogonality_deg_max);
  if (!morphed) return;
  out += fmt::format("largest change of a first cell height {:.3g} % at {}\n", 100 * morphed->wall.height_change_max,
                     node_place(*morphed, morphed->wall.height_change_worst));
  out += fmt::format("largest change of a line's angle to the normal {:.3g} deg at {}\n",
                     morphed->wall.orthogonality_change_deg_max,
                     node_place(*morphed, morphed->wall.orthogonality_change_worst));
}

/// Groups for the terminal: all in their order or, where they are many, the worst first.
std::vector<std::size_t> shown_groups(std::vector<WallGroup> const& groups, std::size_t limit) {
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  if (order.size() <= limit) return order;
  auto const badness = [&](std::size_t g) {
    WallQuality const& q = groups[g].quality;
    return std::tuple(q.height_change_max, q.orthogonality_change_deg_max, q.orthogonality_deg_max);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return badness(a) > badness(b); });
  order.resize(limit);
  return order;
}

void wall_groups(std::string& out, QualityReport const& baseline, std::optional<QualityReport> const& morphed) {
  constexpr std::size_t limit = 12, name_width = 23;
  auto const& before = baseline.wall_groups;
  auto const& now = morphed ? morphed->wall_groups : before;
  if (before.size() < 2 || now.size() != before.size()) return;
  auto const cells = [&](std::initializer_list<std::string> list, int width) {
    for (std::string const& text : list) out += fmt::format("{:>{}}", text, width);
    out += '\n';
  };
  out += fmt::format("\n{:<24}{:>9}", "By wall", "nodes");
  if (morphed) {
    cells({"first height, min", "to normal, max [deg]", "largest change"}, 22);
    out += fmt::format("{:33}", "");
    cells({"baseline", "morphed", "baseline", "morphed", "height, %", "angle, deg"}, 11);
  } else {
    cells({"first height, min", "to normal, max [deg]"}, 22);
  }
  for (std::size_t const g : shown_groups(now, limit)) {
    WallQuality const &b = before[g].quality, &m = now[g].quality;
    std::string name = now[g].name;
    if (name.size() > name_width) name = name.substr(0, name_width - 3) + "...";
    out += fmt::format("{:<24}{:>9}", name, m.nodes);
    auto const degrees = [](double angle) { return fmt::format("{:.3g}", angle); };
    if (morphed)
      cells({format_value(b.first_height_min), format_value(m.first_height_min), degrees(b.orthogonality_deg_max),
             degrees(m.orthogonality_deg_max), fmt::format("{:.3g}", 100 * m.height_change_max),
             degrees(m.orthogonality_change_deg_max)},
            11);
    else
      cells({format_value(m.first_height_min), degrees(m.orthogonality_deg_max)}, 22);
  }
  if (now.size() > limit) out += fmt::format("and {} more, in the JSON report\n", now.size() - limit);
}

/// A line per region and mesh: near field, far field, and those that have a name.
void regions(std::string& out, QualityReport const& baseline, std::optional<QualityReport> const& morphed) {
  QualityReport const& named = morphed ? *morphed : baseline;
  if (named.regions.empty()) return;
  constexpr std::size_t name_width = 22;
  struct Entry {
    Measure measure;
    double MeasureStatistics::*statistic;
    std::string_view title, unit;
  };
  std::vector<Entry> const entries{{Measure::aspect_ratio, &MeasureStatistics::max, "aspect", "max"},
                                   {Measure::determinant_3x3x3, &MeasureStatistics::min, "determ.", "min"},
                                   {Measure::minimum_angle_deg, &MeasureStatistics::min, "angle", "min"},
                                   {Measure::volume_ratio, &MeasureStatistics::max, "volume", "ratio"},
                                   {Measure::growth_ratio, &MeasureStatistics::max, "growth", "ratio"},
                                   {Measure::face_area_ratio, &MeasureStatistics::max, "area", "ratio"},
                                   {Measure::relative_displacement_i, &MeasureStatistics::max, "displ.", "i"},
                                   {Measure::relative_displacement_j, &MeasureStatistics::max, "displ.", "j"},
                                   {Measure::relative_displacement_k, &MeasureStatistics::max, "displ.", "k"}};
  out += fmt::format("\n{:<{}}{:<9}{:>9}", "Regions", name_width, "", "cells");
  for (Entry const& e : entries) out += fmt::format("{:>9}", e.title);
  out += fmt::format("\n{:{}}", "", name_width + 18);
  for (Entry const& e : entries) out += fmt::format("{:>9}", e.unit);
  out += '\n';
  auto const line = [&](std::string name, std::string_view state, QualityRegion const& region) {
    if (region.cells == 0) return;
    if (name.size() >= name_width) name = name.substr(0, name_width - 4) + "...";
    out += fmt::format("{:<{}}{:<9}{:>9}", name, name_width, state, region.cells);
    for (Entry const& e : entries) {
      MeasureStatistics const& s = region[e.measure];
      out += fmt::format("{:>9}", s.worst_zone < 0 ? std::string("-") : fmt::format("{:.4g}", s.*e.statistic));
    }
    out += '\n';
  };
  auto const both = [&](std::string const& name, QualityRegion const& before, QualityRegion const* after) {
    line(name, "baseline", before);
    if (after != nullptr) line(name, "morphed", *after);
  };
  both("near field", baseline.near_field, morphed ? &morphed->near_field : nullptr);
  both("far field", baseline.far_field, morphed ? &morphed->far_field : nullptr);
  for (std::size_t r = 0; r < baseline.regions.size() && r < named.regions.size(); ++r)
    both(named.regions[r].name, baseline.regions[r].quality, morphed ? &morphed->regions[r].quality : nullptr);
}

void worst_cells(std::string& out, QualityReport const& report, std::string_view state) {
  out += fmt::format("\nWorst cells, {}\n", state);
  auto const region = [&](std::string_view name, QualityRegion const& r) {
    for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg, Measure::aspect_ratio,
                            Measure::volume_ratio, Measure::growth_ratio, Measure::face_area_ratio,
                            Measure::non_orthogonality_deg, Measure::face_skewness, Measure::relative_displacement}) {
      MeasureStatistics const& s = r[m];
      if (s.worst_zone < 0) continue;
      out += fmt::format("{:<11}{:<24}{:>10}  {}\n", name, text_of(m).title, format_value(s.worst),
                         worst_place(report, s));
    }
  };
  region("near field", report.near_field);
  region("far field", report.far_field);
}

}  // namespace

std::string format_table(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                         QualityThresholds const& thresholds) {
  std::vector<Column> const list = columns(baseline, morphed);
  std::string out;
  heading(out, "Quality", list);
  row(out, "cells", list, [](QualityRegion const& r) { return std::to_string(r.cells); });
  row(out, "inverted cells", list, [](QualityRegion const& r) { return std::to_string(r.inverted); });
  auto const count_row = [&](std::string_view title, Index QualityRegion::*member) {
    if (std::any_of(list.begin(), list.end(), [&](Column const& c) { return c.values->*member > 0; }))
      row(out, title, list, [&](QualityRegion const& r) { return std::to_string(r.*member); });
  };
  count_row("flat cells", &QualityRegion::flat);
  count_row("cells with collapsed edges", &QualityRegion::collapsed);
  measure_row(out, list, Measure::aspect_ratio, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::aspect_ratio, "mean", &MeasureStatistics::mean);
  measure_row(out, list, Measure::determinant_3x3x3, "min", &MeasureStatistics::min);
  measure_row(out, list, Measure::determinant_2x2x2, "min", &MeasureStatistics::min);
  measure_row(out, list, Measure::minimum_angle_deg, "min", &MeasureStatistics::min);
  measure_row(out, list, Measure::equiangle_skewness, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::volume, "min", &MeasureStatistics::min);
  measure_row(out, list, Measure::volume_ratio, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::growth_ratio, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::face_area_ratio, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::non_orthogonality_deg, "max", &MeasureStatistics::max);
  measure_row(out, list, Measure::face_skewness, "max", &MeasureStatistics::max);
  if (morphed && morphed->against_baseline && !morphed->fast) {
    measure_row(out, list, Measure::relative_displacement, "max", &MeasureStatistics::max);
    for (int d = 0; d < 3; ++d) measure_row(out, list, relative_displacement_along(d), "max", &MeasureStatistics::max);
  }
  if (morphed && morphed->certificate) out += certificate_text(*morphed);
  if (morphed) out += flat_text(*morphed);
  regions(out, baseline, morphed);
  walls(out, baseline, morphed);
  wall_groups(out, baseline, morphed);
  worst_cells(out, morphed ? *morphed : baseline, morphed ? "morphed" : "baseline");

  auto const list_short = shortfalls(baseline, morphed, thresholds);
  if (!list_short.empty()) out += '\n';
  for (Shortfall const& s : list_short)
    out += fmt::format("{}: {}\n", s.severity == Shortfall::Severity::failure ? "falls short" : "warning", s.message);
  return out;
}

std::string certificate_text(QualityReport const& report) {
  Certificate const& c = *report.certificate;
  Index const bad = c.negative + c.undecided;
  std::string_view const cells = report.unstructured ? "elements" : "cells";
  std::string text =
      bad == 0 ? fmt::format("certificate: the Jacobian of all {} {} is positive everywhere", c.cells, cells)
               : fmt::format("certificate: the Jacobian of {} of {} {} is negative somewhere", bad, c.cells, cells);
  if (c.zero > 0) text += fmt::format(", as far as coordinates can tell zero on {} of them", c.zero);
  if (!c.holds()) {
    MeasureStatistics first;
    first.worst_zone = c.broken.worst_zone;
    first.worst_cell = c.broken.worst_cell;
    text += fmt::format("; {} were sound in the baseline, the first is {}", c.broken.cells, worst_place(report, first));
  } else if (bad > 0) {
    text += "; none of them was sound in the baseline";
  }
  return text + "\n";
}

std::string flat_text(QualityReport const& report) {
  FallenCells const &near = report.near_field[Fall::flat_before], &far = report.far_field[Fall::flat_before];
  Index const cells = std::max(near.cells + far.cells, report.certificate ? report.certificate->flat_before : 0);
  if (cells == 0) return {};
  std::string text = fmt::format(
      "flat before: {} {} had no volume in the baseline, and {} negative by little: no scaled Jacobian is "
      "below {}, so they count as flat",
      cells, report.unstructured ? "elements" : "cells", cells == 1 ? "is" : "are",
      format_value(-kernels::flat_allowance));
  FallenCells const& worst = near.cells > 0 && (far.cells == 0 || near.worst <= far.worst) ? near : far;
  if (worst.cells > 0) {
    MeasureStatistics at;
    at.worst_zone = worst.worst_zone;
    at.worst_cell = worst.worst_cell;
    text += fmt::format("; the smallest is {}, {}", format_value(worst.worst), worst_place(report, at));
  }
  return text + "\n";
}

std::string format_short_table(QualityReport const& baseline, std::optional<QualityReport> const& morphed) {
  auto const value = [](QualityRegion const& r, Measure m, double MeasureStatistics::*member) {
    return r.cells == 0 ? std::string("-") : fmt::format("{:.{}f}", r[m].*member, m == Measure::aspect_ratio ? 1 : 3);
  };
  std::string out = fmt::format("{:<10}{:^24}{:^24}\n", "", "Aspect ratio (max)", "Determinant 3x3x3 (min)");
  out += fmt::format("{:<10}{:>12}{:>12}{:>12}{:>12}\n", "Mesh", "near field", "far field", "near field", "far field");
  auto const line = [&](std::string_view name, QualityReport const& r) {
    out += fmt::format("{:<10}{:>12}{:>12}{:>12}{:>12}\n", name,
                       value(r.near_field, Measure::aspect_ratio, &MeasureStatistics::max),
                       value(r.far_field, Measure::aspect_ratio, &MeasureStatistics::max),
                       value(r.near_field, Measure::determinant_3x3x3, &MeasureStatistics::min),
                       value(r.far_field, Measure::determinant_3x3x3, &MeasureStatistics::min));
  };
  line("baseline", baseline);
  if (morphed) line("morphed", *morphed);
  return out;
}

}  // namespace gridmorph
