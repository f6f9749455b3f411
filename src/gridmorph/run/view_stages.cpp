// Pictures of what [output] stages leaves.
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/element_stages.hpp>
#include <gridmorph/run/view_parts.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace gridmorph::cli {

namespace {

using page::Colour;
using page::Flat;
using page::FlatBox;

constexpr Colour pale{0xf3, 0xf4, 0xf6, 1};

/// Strokes of digits on a display of seven: top, upper and lower right, bottom, lower and upper left, middle.
constexpr std::array<int, 10> strokes{0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f};
constexpr std::array<std::array<double, 4>, 7> stroke_ends{
    {{0, 2, 1, 2}, {1, 2, 1, 1}, {1, 1, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 1, 0, 2}, {0, 1, 1, 1}}};

/// A number about a place, digits `size` wide.
void write_number(int number, Flat const& middle, double size, page::Overlay& out) {
  std::string const digits = std::to_string(number);
  double left = middle[0] - 0.5 * size * (1.5 * double(digits.size()) - 0.5);
  for (char const digit : digits) {
    for (std::size_t s = 0; s < stroke_ends.size(); ++s)
      if ((strokes[digit - '0'] >> s & 1) != 0) {
        auto const& e = stroke_ends[s];
        out.lines.push_back({Flat{left + size * e[0], middle[1] + size * (e[1] - 1)},
                             Flat{left + size * e[2], middle[1] + size * (e[3] - 1)}});
      }
    left += 1.5 * size;
  }
}

Flat middle_of(page::Section const& section, std::size_t p) {
  Flat out{0, 0};
  std::size_t const begin = section.first[p], n = section.first[p + 1] - begin;
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t d = 0; d < 2; ++d) out[d] += section.corner[begin + c][d] / double(n);
  return out;
}

/// The numbers of the chains that a stage runs, each in the cell of it that is nearest to the middle of all of its
/// cells.
std::vector<page::Overlay> chain_numbers(page::Section const& section, std::vector<double> const& stage,
                                         std::vector<double> const& chain, int number, FlatBox const& box) {
  std::map<int, std::vector<Flat>> places;
  for (std::size_t p = 0; p < stage.size(); ++p) {
    Flat const at = middle_of(section, p);
    bool const inside = at[0] > box.low[0] && at[0] < box.high[0] && at[1] > box.low[1] && at[1] < box.high[1];
    if (inside && int(stage[p]) == number && chain[p] > 0) places[int(chain[p])].push_back(at);
  }
  std::vector<page::Overlay> out{{{}, {0xff, 0xff, 0xff, 1}, 6}, {{}, {0x10, 0x12, 0x16, 1}, 2}};
  double const size = 0.012 * (box.high[0] - box.low[0]);
  for (auto const& [chain_number, cells] : places) {
    Flat mean{0, 0};
    for (Flat const& p : cells)
      for (std::size_t d = 0; d < 2; ++d) mean[d] += p[d] / double(cells.size());
    auto const far = [&](Flat const& p) { return std::hypot(p[0] - mean[0], p[1] - mean[1]); };
    Flat const at =
        *std::min_element(cells.begin(), cells.end(), [&](Flat const& a, Flat const& b) { return far(a) < far(b); });
    for (page::Overlay& overlay : out) write_number(chain_number, at, size, overlay);
  }
  return out;
}

std::vector<double> field_of(Panel const& panel, char const* name) {
  std::string why;
  auto out = variable_of(panel, name, true, why);
  if (out.empty()) throw ConfigError("--stages: " + why + "; name the folder that [output] stages wrote");
  for (double& v : out) v = std::clamp(v, -1.0, 1e9);  // numbers, which whatever a file holds can be counted as
  return out;
}

/// One picture per stage, the cells that it has reached in the colours of stages.
void draw_block_stages(std::filesystem::path const& folder, FrameMaker const& maker, Panel const& baseline,
                       FlatBox const& box, page::ViewPage& out) {
  std::filesystem::path const list = folder / stage_list_name;
  auto const document = nlohmann::json::parse(io::read_file(list.string()), nullptr, false);
  if (!document.is_object() || !document.contains("stages") || !document["stages"].is_array())
    throw ConfigError(
        fmt::format("--stages: '{}' is no list of stages; name the folder that [output] stages wrote", list.string()));
  page::ColourKey key{nullptr, 0, 1, "stages", {}};
  std::map<int, Colour> colours;
  for (auto const& stage : document["stages"])
    if (!stage.value("chains", nlohmann::json::array()).empty() && stage.value("name", "") != "poles") {
      Colour const colour = listed_colour(colours.size());
      colours[stage.value("number", 0)] = colour;
      key.names.emplace_back(colour, stage.value("name", ""));
    }
  for (auto const& stage : document["stages"]) {
    int const number = stage.value("number", 0);
    std::string const name = stage.value("name", "");
    std::filesystem::path const file = std::filesystem::path(stage.value("file", "")).filename();
    std::vector<Panel> panels{panel_of(folder / file, fmt::format("stage {}, {}", number, name))};
    Panel& panel = panels.front();
    cut_panel(panel, maker.cut());
    auto const reached = field_of(panel, "Stage"), chain = field_of(panel, "Chain");
    for (double const s : reached) {
      auto const at = s <= number ? colours.find(int(s)) : colours.end();
      panel.colour.push_back(at == colours.end() ? pale : at->second);
    }
    auto overlays = chain_numbers(panel.section, reached, chain, number, box);
    overlays.insert(overlays.begin(), ghost_of(baseline.section));
    out.stages.push_back(maker.figure(file.stem().string() + ".png", panel.name, panels, {box}, key, {overlays}));
  }
}

/// Near field, partially wrapped and far field; layers of the near field.
void draw_regions(std::filesystem::path const& file, FrameMaker const& maker, FlatBox const& near,
                  page::ViewPage& out) {
  std::vector<Panel> panels{panel_of(file, "morphed")};
  Panel& panel = panels.front();
  cut_panel(panel, maker.cut());
  page::ColourKey const regions{
      nullptr,
      0,
      1,
      "regions",
      {{{0xe4, 0x8a, 0x86, 1}, "near field"}, {white, "partially wrapped"}, {{0xbf, 0xe3, 0xf5, 1}, "far field"}}};
  for (double const r : field_of(panel, "Region"))
    panel.colour.push_back(regions.names[std::size_t(std::clamp(r, 0.0, 2.0))].first);
  out.figures.push_back(
      maker.figure("regions.png", "Near field, partially wrapped and far field", panels, {near}, regions));
  panel.colour.clear();
  page::ColourKey layers{nullptr, 0, 1, "layers of the near field, from the wall on; white: none", {}};
  for (std::size_t n = 0; n < 8; ++n) layers.names.emplace_back(listed_colour(n), std::to_string(n));
  layers.what += ", and from 8 on again from the first";
  for (double const l : field_of(panel, "Layer")) panel.colour.push_back(l < 0 ? white : listed_colour(std::size_t(l)));
  out.figures.push_back(maker.figure("layers.png", "Layers of the near field", panels, {near}, layers));
}

void draw_wrap(std::filesystem::path const& file, FrameMaker const& maker, page::ViewPage& out) {
  Panel const panel = panel_of(file, "wrap");
  auto plane = panel.mesh->pictures->plane();
  // Its faces look one way; those that look the other way are there too, so that it is seen from everywhere.
  for (std::size_t n = 0, facets = plane.facets.size(); n < facets; ++n) {
    page::Facet back = plane.facets[n];
    std::swap(back.node[1], back.node[back.size() == 3 ? 2 : 3]);
    plane.facets.push_back(back);
  }
  page::Surface const surface = page::make_surface(plane, panel.mesh->walls, panel.at);
  out.figures.push_back(surface_figure("wrap.png", "The wrap around the walls that move", surface,
                                       std::vector<Vec3>(surface.nodes.size()), {0, 0, 1}, maker.width()));
}

void draw_background(std::filesystem::path const& file, std::filesystem::path const& morphed, FrameMaker const& maker,
                     FlatBox const& near, page::ViewPage& out) {
  std::vector<Panel> panels{panel_of(file, "background mesh")};
  auto const cut = [&](Panel& panel) {
    cut_panel(panel, maker.cut());
    panel.colour.assign(panel.section.cell.size(), white);
  };
  cut(panels[0]);
  out.figures.push_back(maker.figure("background.png", "Background mesh", panels, {widened(box_of(panels), 0.02)}, {}));
  if (!std::filesystem::exists(morphed)) return;
  panels.push_back(panel_of(morphed, "morphed"));
  try {
    cut(panels[1]);
  } catch (ConfigError const&) {  // it has moved out of a plane that it met at its edge alone
    out.summary += ". The background mesh moves out of the section: there is no background_motion.png";
    return;
  }
  out.figures.push_back(
      maker.figure("background_motion.png", "Motion of the background mesh", panels, {near, near}, {}));
}

}  // namespace

void draw_stages(std::filesystem::path const& folder, FrameMaker const& maker, Panel const& baseline,
                 FlatBox const& box, FlatBox const& near, page::ViewPage& out) {
  auto const is_there = [&](std::string_view name) { return std::filesystem::exists(folder / name); };
  bool any = is_there(stage_list_name);
  try {
    if (any) draw_block_stages(folder, maker, baseline, box, out);
  } catch (nlohmann::json::exception const& e) {
    throw ConfigError(fmt::format("--stages: '{}' is not as [output] stages writes it: {}",
                                  (folder / stage_list_name).string(), e.what()));
  }
  auto const [regions, wrap, background, morphed] = stage_names;
  for (auto const& name : stage_names) any = any || is_there(name);
  if (!any)
    throw ConfigError(
        fmt::format("--stages: the folder '{}' has neither {} nor {}; [output] stages of a morph writes "
                    "them",
                    folder.string(), stage_list_name, regions));
  if (is_there(regions)) draw_regions(folder / regions, maker, near, out);
  if (is_there(wrap)) draw_wrap(folder / wrap, maker, out);
  if (is_there(background)) draw_background(folder / background, folder / morphed, maker, near, out);
}

}  // namespace gridmorph::cli
