#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/run/mesh_cuts.hpp>
#include <gridmorph/run/view_parts.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph::cli {

using page::Cut;
using page::FlatBox;

ViewedMesh::ViewedMesh(std::filesystem::path const& path) : mesh(path, {}, {}), pictures(mesh.pictures()) {
  if (!pictures->is_plane() || mesh.is_structured()) boundary = pictures->boundary();
  for (Patch const& patch : mesh.mesh().patches) walls.push_back(patch.kind == PatchKind::wall ? 0 : -1);
}

page::Surface ViewedMesh::surface() const {
  return pictures->is_plane() ? page::make_surface(pictures->plane(), walls, mesh.coordinates())
                              : page::make_surface(boundary, walls, mesh.coordinates());
}

void ViewedMesh::focus_on_all_walls() {
  for (signed char& role : walls) role = role < 0 ? role : 1;
}

Panel panel_of(std::filesystem::path const& path, std::string name) {
  Panel out{std::move(name), path, std::make_shared<ViewedMesh>(path), {}, {}, {}};
  out.at = out.mesh->mesh.coordinates();
  return out;
}

void cut_panel(Panel& panel, Cut const& cut) {
  if (!cut.levels && !cut.index_plane && !panel.mesh->pictures->is_plane())
    throw ConfigError(
        fmt::format("'{}' is no plane mesh, as the first one is; cut both with --plane x=V", panel.path.string()));
  panel.section = page::cut_mesh(*panel.mesh->pictures, panel.mesh->boundary, panel.at, cut, panel.mesh->walls);
  if (panel.section.cell.empty())
    throw ConfigError(
        fmt::format("'{}': {} meets no cell of it; cut elsewhere, --plane x=V", panel.path.string(), cut.title));
}

std::string const& family_of(Patch const& patch) { return patch.families.empty() ? patch.name : patch.families[0]; }

FlatBox box_of(std::vector<Panel> const& panels) {
  FlatBox out;
  for (Panel const& panel : panels)
    for (page::Flat const& p : panel.section.corner) out.take(p);
  return out;
}

FlatBox widened(FlatBox box, double share) {
  double const more = share * std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  for (int d = 0; d < 2; ++d) {
    box.low[d] -= more;
    box.high[d] += more;
  }
  return box;
}

page::Overlay ghost_of(page::Section const& section) {
  page::Overlay out{{}, {0x7a, 0xb8, 0xff, 1}, 1};
  for (auto const& wall : section.walls)
    if (wall.moves) out.lines.push_back({wall.a, wall.b});
  return out;
}

page::ViewFigure FrameMaker::figure(std::string file, std::string title, std::vector<Panel> const& panels,
                                    std::vector<FlatBox> const& boxes, page::ColourKey const& key,
                                    std::vector<std::vector<page::Overlay>> const& overlays) const {
  auto const wide = [&](std::size_t n, int d) { return boxes[n].high[d] - boxes[n].low[d]; };
  double const ratio = std::clamp(wide(0, 0) > 0 ? wide(0, 1) / wide(0, 0) : 1.0, 0.35, 1.8);
  int const height = std::max(1, int(std::lround(width_ * ratio)));
  std::vector<io::Picture> drawn(panels.size());
  std::string caption;
  for (std::size_t n = 0; n < panels.size(); ++n) {
    page::Window const window{{0.5 * (boxes[n].low[0] + boxes[n].high[0]), 0.5 * (boxes[n].low[1] + boxes[n].high[1])},
                              0.5 * std::max(wide(n, 0), wide(n, 1) / ratio)};
    auto const over = overlays.empty() ? std::span<page::Overlay const>() : std::span(overlays[n]);
    drawn[n] = page::section_picture(panels[n].section, panels[n].colour, window, width_, height, over);
    if (n > 0 && boxes[n].low == boxes[0].low && boxes[n].high == boxes[0].high) continue;
    caption += fmt::format("{}{} to the right from {:.5g} to {:.5g}, {} up from {:.5g} to {:.5g}",
                           n > 0 ? "; " + panels[n].name + ": " : "", cut_.labels[0],
                           window.centre[0] - window.half_width, window.centre[0] + window.half_width, cut_.labels[1],
                           window.centre[1] - window.half_width * ratio, window.centre[1] + window.half_width * ratio);
  }
  return {std::move(file), std::move(title), std::move(caption), page::side_by_side(drawn), key};
}

page::ViewFigure surface_figure(std::string file, std::string title, page::Surface const& surface,
                                std::vector<Vec3> const& displacement, Vec3 const& up, int width) {
  int const height = width * 3 / 4;
  double const most = largest_norm(displacement);
  std::vector<io::Picture> drawn;
  for (page::View const& view : page::find_views(surface, displacement, up, width, height))
    drawn.push_back(page::surface_picture(surface, displacement, most, view, width, height));
  page::ColourKey key;
  if (most > 0) key = {&page::displacement_colours(), 0, most, "displacement", {}};
  return {std::move(file), std::move(title),
          most > 0 ? "from two sides, after the morph; blue: edges of what moves, in the baseline"
                   : "from two sides; blue: edges",
          page::side_by_side(drawn), key};
}

namespace {

/// The axis that a mesh is periodic about.
std::optional<Axis> periodic_axis(Mesh const& mesh) {
  std::optional<AxisTurn> turn;
  auto const look = [&](auto const& connections) {
    for (auto const& c : connections)
      if (c.periodic && !turn) turn = as_turn(c.periodic->declared, 1e-4 * mesh.size());
  };
  look(mesh.interfaces);
  look(mesh.connections);
  return turn ? std::optional(Axis{turn->origin, turn->direction}) : std::nullopt;
}

class View {
 public:
  View(ViewRequest const& request, Console& console) : request_(request), console_(console) {}

  page::ViewPage draw() {
    load();
    find_roles();
    surface_ = panels_[0].mesh->surface();
    cut_ = choose_cut();
    for (Panel& panel : panels_) cut_panel(panel, cut_);
    key_ = paint(request_, panels_);
    describe();
    FrameMaker const maker(cut_, width());
    draw_sections(maker);
    draw_model();
    if (request_.stages) {
      console_.progress("drawing the stages");
      FlatBox const whole = asked_box().value_or(widened(box_of({panels_[0]}), 0.03));
      FlatBox const walls = moving_box();
      draw_stages(*request_.stages, maker, panels_[0], whole, walls.empty() ? whole : widened(walls, 0.12), page_);
    }
    return std::move(page_);
  }

 private:
  [[nodiscard]] int width() const { return std::max(1, int(std::lround(6.4 * request_.dpi))); }
  [[nodiscard]] bool is_pair() const { return panels_.size() == 2 && panels_[0].mesh == panels_[1].mesh; }
  /// Elements of a plane, which nothing can cut.
  [[nodiscard]] bool is_flat() const { return !mesh().is_structured() && mesh().dimension == 2; }
  [[nodiscard]] Mesh const& mesh() const { return panels_[0].mesh->mesh.mesh(); }

  /// The second file is the first mesh with other coordinates, or another mesh, which is drawn beside it.
  void load() {
    console_.progress("reading " + request_.mesh.string());
    panels_.push_back(panel_of(request_.mesh, request_.morphed ? "baseline" : "mesh"));
    if (!request_.morphed) return;
    console_.progress("reading " + request_.morphed->string());
    Panel morphed{"morphed", *request_.morphed, panels_[0].mesh, {}, {}, {}};
    try {
      morphed.at = panels_[0].mesh->mesh.coordinates_of(*request_.morphed, {});
    } catch (MeshError const&) {
      morphed = panel_of(*request_.morphed, "second");
      console_.warn(fmt::format("'{}' is not the mesh of '{}': it is drawn beside it, and what moved is not known",
                                request_.morphed->string(), request_.mesh.string()));
    }
    panels_.push_back(std::move(morphed));
  }

  /// In focus are walls with a node that moves, and all where none is known to move.
  void find_roles() {
    auto& walls = panels_[0].mesh->walls;
    auto const& patches = mesh().patches;
    for (std::size_t p = 0; p < walls.size(); ++p)
      if (!request_.wall.empty() && is_asked_for(patches[p])) walls[p] = std::max(walls[p], (signed char)0);
    find_moving(walls);
    moves_ = std::find(walls.begin(), walls.end(), 1) != walls.end();
    for (Panel const& panel : panels_)
      if (auto const& of_panel = panel.mesh->walls; std::find(of_panel.begin(), of_panel.end(), 1) == of_panel.end())
        panel.mesh->focus_on_all_walls();
  }

  void find_moving(std::vector<signed char>& walls) const {
    if (!is_pair()) return;
    double const little = 1e-12 * mesh().size();
    auto const look = [&](std::span<Index32 const> nodes, int patch) {
      if (patch < 0 || walls[patch] < 0) return;
      for (Index32 const n : nodes)
        if (n >= 0 && norm(panels_[1].at[n] - panels_[0].at[n]) > little) walls[patch] = 1;
    };
    if (panels_[0].mesh->pictures->is_plane())
      for (page::Edge const& side : panels_[0].mesh->pictures->plane().sides) look(side.node, side.patch);
    for (page::Facet const& facet : panels_[0].mesh->boundary) look(facet.node, facet.patch);
  }

  [[nodiscard]] bool is_asked_for(Patch const& patch) const {
    return patch.name == request_.wall ||
           std::find(patch.families.begin(), patch.families.end(), request_.wall) != patch.families.end();
  }

  [[nodiscard]] std::vector<Vec3> displacement() const {
    std::vector<Vec3> out(surface_.nodes.size());
    if (is_pair())
      for (std::size_t n = 0; n < out.size(); ++n) out[n] = panels_[1].at[surface_.nodes[n]] - surface_.baseline[n];
    return out;
  }

  [[nodiscard]] std::vector<Vec3> all_nodes() const {
    std::vector<Vec3> out;
    for (Index n = 0; n < panels_[0].at.size(); ++n) out.push_back(panels_[0].at[n]);
    return out;
  }

  [[nodiscard]] std::optional<Axis> axis() const {
    auto const periodic = periodic_axis(mesh());
    if (!request_.axis) return periodic;
    Axis out{periodic ? periodic->origin : Vec3{}, {0, 0, 0}};
    (*request_.axis == 0 ? out.direction.x : *request_.axis == 1 ? out.direction.y : out.direction.z) = 1;
    return out;
  }

  /// Empty where the mesh is no annulus.
  [[nodiscard]] std::vector<Cut> span_cuts_of(Axis const& axis, double share) const {
    auto about = nodes_in_focus(surface_);
    if (about.empty()) about = all_nodes();
    return span_cuts(panels_[0].at, axis, std::array{share}, about);
  }

  [[nodiscard]] Cut choose_cut() const {
    page::PictureMesh const& pictures = *panels_[0].mesh->pictures;
    if (is_flat() && (request_.span || request_.axis))
      throw ConfigError(
          fmt::format("--span, --axis: '{}' is 2-D and drawn as it is; leave them out", request_.mesh.string()));
    if (request_.plane) return asked_plane(request_.plane->first, request_.plane->second);
    if (request_.index) {
      if (!mesh().is_structured())
        throw ConfigError(
            fmt::format("--{} {}: planes of nodes are those of blocks, and '{}' is a mesh of elements; "
                        "cut it with --plane x=V",
                        "ijk"[(*request_.index)[0]], (*request_.index)[1], request_.mesh.string()));
      return index_cut(pictures, panels_[0].at, (*request_.index)[0], (*request_.index)[1] - 1);
    }
    if (request_.span || request_.axis) {
      auto const cuts = span_cuts_of(axis().value_or(Axis{}), request_.span.value_or(0.5));
      if (!cuts.empty()) return cuts.front();
      throw ConfigError(
          fmt::format("--span {}: '{}' fills no annulus along the axis; name another one, --axis z, or "
                      "cut with --plane x=V",
                      request_.span.value_or(0.5), request_.mesh.string()));
    }
    if (pictures.is_plane()) return flat_cut(all_nodes());
    if (auto const about = axis())
      if (auto const cuts = span_cuts_of(*about, 0.5); !cuts.empty()) return cuts.front();
    return fullest_plane();
  }

  [[nodiscard]] Cut asked_plane(int coordinate, double value) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (Index n = 0; n < panels_[0].at.size(); ++n) {
      double const x = component(panels_[0].at[n], coordinate);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (is_flat()) {
      if (high - low <= 1e-9 * mesh().size()) return flat_cut(all_nodes());
      throw ConfigError(fmt::format("--plane {}={}: '{}' is 2-D and drawn as it is; leave it out", "xyz"[coordinate],
                                    value, request_.mesh.string()));
    }
    // On a side of the mesh, such as its symmetry plane, it is cut a hair inside.
    double const hair = 1e-7 * mesh().size();
    double const inside = high - low > 2 * hair && value >= low - hair && value <= high + hair
                              ? std::clamp(value, low + hair, high - hair)
                              : value;
    Cut cut = plane_cut(coordinate, inside);
    cut.title = fmt::format("{} = {:g}", "xyz"[coordinate], value);
    return cut;
  }

  /// Of planes through the middle of the walls in focus that with most pieces of them, in all meshes.
  [[nodiscard]] Cut fullest_plane() const {
    auto cuts = plane_cuts(surface_, displacement());
    if (cuts.empty()) {
      Vec3 middle;
      for (Vec3 const& p : all_nodes()) middle += (1 / double(mesh().n_nodes())) * p;
      return plane_cut(1, middle.y);
    }
    std::size_t best = 0, most = 0;
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      std::size_t pieces = 0;
      for (Panel const& panel : panels_)
        for (auto const& wall :
             page::cut_mesh(*panel.mesh->pictures, panel.mesh->boundary, panel.at, cuts[c], panel.mesh->walls).walls)
          pieces += wall.moves ? 1 : 0;
      if (pieces > most) best = c;
      most = std::max(most, pieces);
    }
    return cuts[best];
  }

  void describe() {
    page_.version = GRIDMORPH_VERSION;
    page_.files = request_.mesh.filename().string();
    if (request_.morphed) page_.files += ", " + request_.morphed->filename().string();
    page_.summary = fmt::format("{}: {} {}. {}", request_.mesh.string(), panels_[0].mesh->mesh.n_cells(),
                                panels_[0].mesh->mesh.kind().cells, cut_.title);
    if (moves_)
      page_.summary +=
          ". Baseline left, morphed right; blue: walls that move, light blue: where they were, grey: "
          "walls that stay";
    else if (is_pair())
      page_.summary += ". Baseline left, morphed right; no wall moves, blue: walls";
    else if (request_.morphed)
      page_.summary +=
          ". These are two meshes, not one and what was made of it by a morph: how far nodes moved is not known. Blue: "
          "walls";
    else
      page_.summary += ". Blue: walls";
  }

  [[nodiscard]] std::optional<FlatBox> asked_box() const {
    if (!request_.box) return std::nullopt;
    auto const& b = *request_.box;
    return FlatBox{{b[0], b[2]}, {b[1], b[3]}};
  }

  /// Around the walls that move; empty where none does.
  [[nodiscard]] FlatBox moving_box() const {
    FlatBox out;
    if (!moves_) return out;
    for (Panel const& panel : panels_)
      if (FlatBox const box = page::moving_walls(panel.section); !box.empty()) {
        out.take(box.low);
        out.take(box.high);
      }
    return out;
  }

  void draw_sections(FrameMaker const& maker) {
    console_.progress("drawing");
    std::vector<std::vector<page::Overlay>> overlays(panels_.size());
    if (moves_) overlays[1].push_back(ghost_of(panels_[0].section));
    if (request_.moved) {
      if (!is_pair())
        throw ConfigError("--moved: outlines cells between a mesh and its morphed mesh; give both, or leave it out");
      for (std::size_t n = 0; n < 2; ++n)
        overlays[n].push_back(moved_cells(panels_[n], panels_[0].at, panels_[1].at, *request_.moved));
    }
    auto const add = [&](char const* file, std::string const& what, std::vector<FlatBox> boxes) {
      boxes.resize(panels_.size(), boxes.front());
      page_.figures.push_back(maker.figure(file, cut_.title + ": " + what, panels_, boxes, key_, overlays));
    };
    add("section.png", "section", {widened(box_of(panels_), 0.03)});
    if (auto const box = asked_box()) add("box.png", "close-up", {*box});
    if (FlatBox const box = moving_box(); !box.empty())
      add("near.png", "around the walls that move", {widened(box, 0.12)});
    draw_wall(add);
  }

  /// The walls of a panel's section that the close-ups are of.
  struct Ends {
    page::Flat first{HUGE_VAL, 0}, last{-HUGE_VAL, 0};
    FlatBox box;
  };

  [[nodiscard]] Ends ends_of(Panel const& panel, std::string const& family) const {
    Ends out;
    for (auto const& wall : panel.section.walls) {
      if (family_of(panel.mesh->mesh.mesh().patches[wall.patch]) != family) continue;
      for (page::Flat const& p : {wall.a, wall.b}) {
        out.box.take(p);
        if (p[0] < out.first[0]) out.first = p;
        if (p[0] > out.last[0]) out.last = p;
      }
    }
    return out;
  }

  /// The family of the close-ups: what is asked for, else the first one that moves, or that is there.
  [[nodiscard]] std::string choose_wall() const {
    std::set<int> met;
    for (auto const& wall : panels_[0].section.walls) met.insert(wall.patch);
    std::set<std::string> names;
    std::string first;
    bool moves = false;
    for (int const p : met) {
      Patch const& patch = mesh().patches[p];
      if (!request_.wall.empty() && is_asked_for(patch)) return family_of(patch);
      names.insert(family_of(patch));
      bool const better = panels_[0].mesh->walls[p] > 0 && !moves;
      if (first.empty() || better) first = family_of(patch);
      moves = moves || better;
    }
    if (!request_.wall.empty())
      throw ConfigError(fmt::format("--wall {}: the section meets these walls: {}; name one of them", request_.wall,
                                    names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    return first;
  }

  template <class Add>
  void draw_wall(Add const& add) {
    std::string const family = choose_wall();
    std::vector<Ends> ends;
    ends.reserve(panels_.size());
    for (Panel const& panel : panels_) ends.push_back(ends_of(panel, family));
    if (family.empty() || std::any_of(ends.begin(), ends.end(), [](Ends const& e) { return e.box.empty(); })) {
      page_.summary += ". No wall in this section is known in all meshes: there are no close-ups of one";
      return;
    }
    double const chord = std::hypot(ends[0].box.high[0] - ends[0].box.low[0], ends[0].box.high[1] - ends[0].box.low[1]);
    auto const square = [](page::Flat const& c, double half) {
      return FlatBox{{c[0] - half, c[1] - half}, {c[0] + half, c[1] + half}};
    };
    auto const edge = [&](page::Flat const& a, page::Flat const& b) {
      page::Flat const middle{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
      double const apart = std::max(std::fabs(a[0] - middle[0]), std::fabs(a[1] - middle[1]));
      return std::vector{square(middle, 0.09 * chord + 0.6 * apart)};
    };
    add("leading_edge.png", fmt::format("leading edge of '{}'", family), edge(ends.front().first, ends.back().first));
    add("trailing_edge.png", fmt::format("trailing edge of '{}'", family), edge(ends.front().last, ends.back().last));
    std::vector<FlatBox> layers;
    for (Ends const& e : ends) layers.push_back(square(e.first, 0.016 * chord));
    add("boundary_layer.png",
        fmt::format("layers at the leading edge of '{}'{}", family,
                    panels_.size() > 1 ? ", each mesh about its own" : ""),
        layers);
  }

  void draw_model() {
    if (panels_[0].mesh->pictures->is_plane() || surface_.facets.empty()) return;
    page_.figures.push_back(surface_figure("model.png", "The walls as the flow sees them", surface_, displacement(),
                                           upwards(axis(), surface_), width()));
  }

  ViewRequest const& request_;
  Console& console_;
  std::vector<Panel> panels_;
  bool moves_ = false;  ///< a wall, from the baseline to the morphed mesh
  page::Surface surface_;
  Cut cut_;
  page::ColourKey key_;
  page::ViewPage page_;
};

}  // namespace

page::ViewPage draw_view(ViewRequest const& request, Console& console) { return View(request, console).draw(); }

}  // namespace gridmorph::cli
