// What the parts of a view share: meshes as they are drawn, their colours, frames.
#pragma once

#include <gridmorph/page/section.hpp>
#include <gridmorph/page/surface_picture.hpp>
#include <gridmorph/page/view_page.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/view.hpp>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cli {

/// Cells without a value.
inline constexpr page::Colour white{0xff, 0xff, 0xff, 1};

/// A mesh with what pictures of it need.
struct ViewedMesh {
  explicit ViewedMesh(std::filesystem::path const& path);

  LoadedMesh mesh;
  std::unique_ptr<page::PictureMesh> pictures;
  std::vector<page::Facet> boundary;
  /// Per patch: 1 a wall in focus, since it moves or none is known to, 0 another one, -1 no wall.
  std::vector<signed char> walls;

  void focus_on_all_walls();
  /// Its walls with the nodes where they are; of a plane mesh all of it.
  [[nodiscard]] page::Surface surface() const;
};

/// One of the meshes of a picture.
struct Panel {
  std::string name;  ///< "baseline"
  std::filesystem::path path;
  std::shared_ptr<ViewedMesh> mesh;  ///< of a morphed mesh that of its baseline
  Coordinates at;
  page::Section section;
  std::vector<page::Colour> colour;  ///< of its polygons
};

/// A mesh by itself. Cost: reading it.
Panel panel_of(std::filesystem::path const& path, std::string name);
/// Throws ConfigError where nothing is cut.
void cut_panel(Panel& panel, page::Cut const& cut);

/// The first family of a patch, or its name.
std::string const& family_of(Patch const& patch);

/// Gives the polygons of all panels their colours, those of one scale. Throws ConfigError for what is not there.
page::ColourKey paint(ViewRequest const& request, std::vector<Panel>& panels);
/// One value per polygon of a panel; of a solution at nodes the smallest of a cell's with `least`, else their mean.
/// Empty where the file lacks the variable, and `why` says so.
std::vector<double> variable_of(Panel const& panel, std::string const& name, bool least, std::string& why);
/// Outlines of the cells that move by at least `length` as a whole.
page::Overlay moved_cells(Panel const& panel, Coordinates const& baseline, Coordinates const& morphed, double length);

/// The colour of number n of a list, again from the first one after the last.
page::Colour listed_colour(std::size_t n);

/// Makes figures of panels that are cut alike.
class FrameMaker {
 public:
  FrameMaker(page::Cut const& cut, int width) : cut_(cut), width_(width) {}
  /// Panels side by side, each in a box of its own; `overlays`: one list per panel, or none.
  [[nodiscard]] page::ViewFigure figure(std::string file, std::string title, std::vector<Panel> const& panels,
                                        std::vector<page::FlatBox> const& boxes, page::ColourKey const& key,
                                        std::vector<std::vector<page::Overlay>> const& overlays = {}) const;
  [[nodiscard]] page::Cut const& cut() const { return cut_; }
  [[nodiscard]] int width() const { return width_; }

 private:
  page::Cut const& cut_;
  int width_;
};

/// About all polygons of some panels.
page::FlatBox box_of(std::vector<Panel> const& panels);
/// With room around it, a share of its longer side.
page::FlatBox widened(page::FlatBox box, double share);
/// The walls of a section as lines over another one.
page::Overlay ghost_of(page::Section const& section);
/// Two views of a surface beside one another, coloured by displacement.
page::ViewFigure surface_figure(std::string file, std::string title, page::Surface const& surface,
                                std::vector<Vec3> const& displacement, Vec3 const& up, int width);

/// What is in the folder of the stages, after the other pictures.
void draw_stages(std::filesystem::path const& folder, FrameMaker const& maker, Panel const& baseline,
                 page::FlatBox const& box, page::FlatBox const& near, page::ViewPage& out);

}  // namespace gridmorph::cli
