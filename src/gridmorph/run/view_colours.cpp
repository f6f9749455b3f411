// What colours the cells of a view have.
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/io/read_solution.hpp>
#include <gridmorph/run/view_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace gridmorph::cli {

namespace {

using page::Colour;

std::array<Colour, 7> const& type_colours() {
  static std::array<Colour, 7> const colours{{{0xee, 0xf3, 0xfb},
                                              {0x9f, 0xd3, 0xa8},
                                              {0xee, 0xf3, 0xfb},
                                              {0xf2, 0xb8, 0x4b},
                                              {0x9f, 0xd3, 0xa8},
                                              {0x7f, 0xb2, 0xe5},
                                              {0xd6, 0xb8, 0xe0}}};
  return colours;
}

ElementType type_of(Mesh const& mesh, Index cell) {
  if (!mesh.is_structured()) return mesh.elements.type[cell];
  return mesh.dimension == 2 ? ElementType::quadrilateral : ElementType::hexahedron;
}

page::ColourKey paint_types(std::vector<Panel>& panels) {
  page::ColourKey key;
  std::array<bool, 7> present{};
  for (Panel& panel : panels)
    for (Index const cell : panel.section.cell) {
      auto const t = std::size_t(type_of(panel.mesh->mesh.mesh(), cell));
      panel.colour.push_back(type_colours()[t]);
      present[t] = true;
    }
  for (std::size_t t = 0; t < present.size(); ++t)
    if (present[t]) key.names.emplace_back(type_colours()[t], to_string(ElementType(t)));
  return key;
}

template <class Value>
std::vector<double> values_of(Panel const& panel, Value const& value) {
  std::vector<double> out;
  out.reserve(panel.section.cell.size());
  for (Index const cell : panel.section.cell) out.push_back(value(cell));
  return out;
}

double mean_displacement(Panel const& panel, Coordinates const& baseline, Coordinates const& morphed, Index cell) {
  auto const nodes = panel.mesh->pictures->nodes(cell);
  double sum = 0;
  for (Index32 const n : nodes) sum += norm(morphed[n] - baseline[n]);
  return sum / double(nodes.size());
}

void paint_values(std::vector<Panel>& panels, std::vector<std::vector<double>> const& values,
                  page::ColourKey const& key) {
  double const range = key.high > key.low ? key.high - key.low : 1;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    panels[p].colour.assign(panels[p].section.cell.size(), white);
    for (std::size_t n = 0; n < values[p].size(); ++n)
      panels[p].colour[n] = key.scale->at((values[p][n] - key.low) / range);
  }
}

/// The ends of the values that a box shows.
void find_range(ViewRequest const& request, std::vector<Panel> const& panels,
                std::vector<std::vector<double>> const& values, page::ColourKey& key) {
  key.low = HUGE_VAL;
  key.high = -HUGE_VAL;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    page::Section const& section = panels[p].section;
    for (std::size_t n = 0; n < values[p].size(); ++n) {
      bool const seen =
          !request.box ||
          std::any_of(section.corner.begin() + std::ptrdiff_t(section.first[n]),
                      section.corner.begin() + std::ptrdiff_t(section.first[n + 1]), [&](page::Flat const& c) {
                        auto const& b = *request.box;
                        return c[0] >= b[0] && c[0] <= b[1] && c[1] >= b[2] && c[1] <= b[3];
                      });
      if (!seen) continue;
      key.low = std::min(key.low, values[p][n]);
      key.high = std::max(key.high, values[p][n]);
    }
  }
  if (!(key.low <= key.high)) throw ConfigError("--box: the section has no cell there; give another one");
}

page::ColourKey paint_variable(ViewRequest const& request, std::vector<Panel>& panels) {
  std::string why;
  std::vector<std::vector<double>> values;
  values.reserve(panels.size());
  for (Panel const& panel : panels) values.push_back(variable_of(panel, request.color, false, why));
  if (std::all_of(values.begin(), values.end(), [](auto const& v) { return v.empty(); }))
    throw ConfigError(
        fmt::format("--color {}: {}. It takes determinant, displacement, type, none or the name of a variable of a "
                    "flow solution",
                    request.color, why));
  page::ColourKey key{&page::displacement_colours(), 0, 1, request.color, {}};
  if (request.color.find("eterminant") != std::string::npos)
    key.scale = &page::quality_colours();
  else
    find_range(request, panels, values, key);
  if (!why.empty()) key.what += " (white: " + why + ")";
  paint_values(panels, values, key);
  return key;
}

}  // namespace

page::Colour listed_colour(std::size_t n) {
  static std::array<Colour, 8> const colours{{{0xbf, 0xc7, 0xd3},
                                              {0x9c, 0xca, 0xae},
                                              {0xea, 0xc0, 0x95},
                                              {0xb5, 0xaf, 0xdd},
                                              {0xe0, 0xa6, 0xb8},
                                              {0x95, 0xca, 0xd7},
                                              {0xcb, 0xbe, 0x90},
                                              {0xa8, 0xb2, 0x9e}}};
  return colours[n % colours.size()];
}

std::vector<double> variable_of(Panel const& panel, std::string const& name, bool least, std::string& why) {
  FlowSolution solution;
  try {
    SolutionWanted wanted;
    wanted.variables = {name};
    solution = read_flow_solution(panel.path.string(), panel.mesh->mesh.mesh(), wanted);
  } catch (IoError const& e) {
    why = std::string(e.what()).substr(0, std::string(e.what()).find('\n'));
    return {};
  }
  std::vector<double> const* const values = solution.find(name);
  if (values == nullptr) {
    why = fmt::format("{} has no '{}'{}", solution.source, name, suggestion(name, solution.available));
    return {};
  }
  return values_of(panel, [&](Index cell) {
    if (!solution.at_nodes) return (*values)[cell];
    auto const nodes = panel.mesh->pictures->nodes(cell);
    double sum = 0, smallest = HUGE_VAL;
    for (Index32 const n : nodes) {
      sum += (*values)[n];
      smallest = std::min(smallest, (*values)[n]);
    }
    return least ? smallest : sum / double(nodes.size());
  });
}

page::ColourKey paint(ViewRequest const& request, std::vector<Panel>& panels) {
  std::string const color = !request.color.empty()                 ? request.color
                            : panels[0].mesh->mesh.is_structured() ? "determinant"
                                                                   : "type";
  for (Panel& panel : panels) panel.colour.clear();
  if (color == "type") return paint_types(panels);
  if (color == "none") {
    for (Panel& panel : panels) panel.colour.assign(panel.section.cell.size(), white);
    return {};
  }
  if (color != "determinant" && color != "displacement") return paint_variable(request, panels);
  std::vector<std::vector<double>> values;
  if (color == "determinant") {
    for (Panel const& panel : panels)
      values.push_back(values_of(
          panel, [&](Index cell) { return panel.mesh->pictures->measures(cell, panel.at).determinant_3x3x3; }));
    page::ColourKey key{&page::quality_colours(), 0, 1, "determinant 3\u00d73\u00d73; red: none, or inverted", {}};
    paint_values(panels, values, key);
    return key;
  }
  if (panels.size() < 2 || panels[0].mesh != panels[1].mesh)
    throw ConfigError(
        "--color displacement: is that between a mesh and its morphed mesh; give both, of one mesh, or leave it out");
  for (Panel const& panel : panels)
    values.push_back(
        values_of(panel, [&](Index cell) { return mean_displacement(panel, panels[0].at, panels[1].at, cell); }));
  page::ColourKey key{&page::displacement_colours(), 0, 0, "displacement", {}};
  for (auto const& of_panel : values)
    for (double const v : of_panel) key.high = std::max(key.high, v);
  paint_values(panels, values, key);
  return key;
}

page::Overlay moved_cells(Panel const& panel, Coordinates const& baseline, Coordinates const& morphed, double length) {
  page::Overlay out{{}, {0x10, 0x12, 0x16, 1}, 1.5};
  page::Section const& section = panel.section;
  for (std::size_t p = 0; p < section.cell.size(); ++p) {
    auto const nodes = panel.mesh->pictures->nodes(section.cell[p]);
    if (std::any_of(nodes.begin(), nodes.end(), [&](Index32 n) { return norm(morphed[n] - baseline[n]) < length; }))
      continue;
    std::size_t const begin = section.first[p], n = section.first[p + 1] - begin;
    for (std::size_t c = 0; c < n; ++c)
      out.lines.push_back({section.corner[begin + c], section.corner[begin + (c + 1) % n]});
  }
  return out;
}

}  // namespace gridmorph::cli
