#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/cgns/cgns_sections.hpp>
#include <gridmorph/io/surface/surface_io.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace gridmorph {

namespace {

using cgns::File;
using cgns::Node;

/// ElementType_t of the SIDS: number of nodes and of corners of a surface element (0: not one).
struct ElementKind {
  int nodes = 0, corners = 0;
};
constexpr int mixed = 20, ngon = 22;
constexpr std::array<ElementKind, 22> element_kinds{
    {{0, 0},  {0, 0}, {1, 0},  {2, 0}, {3, 0},  {3, 3},  {6, 3}, {4, 4},  {8, 4},  {9, 4}, {4, 0},
     {10, 0}, {5, 0}, {14, 0}, {6, 0}, {15, 0}, {18, 0}, {8, 0}, {20, 0}, {27, 0}, {0, 0}, {13, 0}}};

class SurfaceReader {
 public:
  explicit SurfaceReader(std::string const& path)
      : file_(path, File::Mode::read), tree_(file_.tree()), types_(file_, tree_) {}

  TargetGeometry run() {
    bool any = false;
    for (Node& base : tree_.children) {
      if (base.label != "CGNSBase_t") continue;
      auto const dimensions = file_.integers(base);
      cell_dimension_ = dimensions.empty() ? 3 : int(dimensions[0]);
      for (Node& zone : base.children)
        if (zone.label == "Zone_t") {
          any = true;
          read_zone(zone);
        }
    }
    if (!any) throw IoError(file_.path() + ": holds no Zone_t node; there is no surface in it");
    if (out_.grids.empty() && out_.triangles.empty())
      throw IoError(file_.path() +
                    ": holds no surface: no structured zone with one node plane and no section of "
                    "triangles or quadrilaterals");
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(Node const& node, std::string const& what) const {
    throw IoError(file_.path() + ", node " + node.path + ": " + what);
  }

  void read_zone(Node& zone) {
    auto const* type = zone.labelled("ZoneType_t");
    std::string const kind = type != nullptr ? file_.text(*type) : "Structured";
    auto const sizes = file_.integers(zone);
    auto const dimensions = file_.dimensions(zone);
    std::size_t const n = dimensions.empty() ? 0 : std::size_t(std::clamp<Index>(dimensions[0], 0, 4));
    if (kind == "Unstructured" && n == 1 && sizes.size() >= 2) return read_unstructured(zone, sizes[0]);
    if (kind != "Structured" || (n != 2 && n != 3) || sizes.size() < n)
      fail(zone, "its type '" + kind + "' and sizes are neither those of a structured nor of an unstructured zone");
    std::vector<int> extent;
    Index count = 1;
    for (std::size_t a = 0; a < n; ++a) {
      if (sizes[a] < 1 || sizes[a] > std::numeric_limits<int>::max() / count)
        fail(zone, "has " + std::to_string(sizes[a]) + " nodes along direction " + std::to_string(a + 1));
      count *= sizes[a];
      if (n == 2 || sizes[a] > 1) extent.push_back(int(sizes[a]));
    }
    if (extent.size() != 2)
      fail(zone, extent.size() > 2 ? "is a volume; name its patches with target_patches, or give a file of surfaces"
                                   : "is a line or a point, not a surface");
    out_.grids.push_back({zone.name, {extent[0], extent[1]}, read_points(zone, count)});
  }

  std::vector<Vec3> read_points(Node const& zone, Index count) const {
    Node const* grid = zone.child("GridCoordinates");
    if (grid == nullptr) grid = zone.labelled("GridCoordinates_t");
    if (grid == nullptr) fail(zone, "has no GridCoordinates_t node, so no coordinates");
    std::vector<Vec3> points;
    static constexpr std::array<char const*, 3> names{"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (int c = 0; c < 3; ++c) {
      Node const* array = grid->child(names[c]);
      if (array == nullptr) fail(*grid, std::string(names[c]) + " is missing; three Cartesian coordinates are needed");
      auto const values = file_.reals(*array);
      if (Index(values.size()) != count)
        fail(*array, "has " + std::to_string(values.size()) + " values for " + std::to_string(count) +
                         " nodes (rind planes are not supported in target surfaces)");
      points.resize(values.size());
      for (std::size_t n = 0; n < values.size(); ++n) {
        if (!std::isfinite(values[n])) fail(*array, "value " + std::to_string(n + 1) + " is not finite");
        (c == 0 ? points[n].x : c == 1 ? points[n].y : points[n].z) = values[n];
      }
    }
    return points;
  }

  void read_unstructured(Node& zone, Index count) {
    if (count < 1 || count > std::numeric_limits<int>::max() / 2 - Index(out_.points.size()))
      fail(zone, "has " + std::to_string(count) + " nodes, which cannot be");
    first_ = Index(out_.points.size());
    count_ = count;
    auto const points = read_points(zone, count);
    out_.points.insert(out_.points.end(), points.begin(), points.end());
    for (Node& section : zone.children)
      if (section.label == "Elements_t") read_section(section);
  }

  void read_section(Node& section) {
    file_.load_children(section);
    auto header = file_.integers(section);
    if (!header.empty()) header[0] = types_(header[0]);
    int const type = header.empty() || header[0] < 0 || header[0] > 100 ? -1 : int(header[0]);
    bool const known = type == mixed || type == ngon || (type >= 0 && type < int(element_kinds.size()));
    if (!known) return;  // kinds of volume elements that came later
    if (type != mixed && type != ngon && element_kinds[type].corners == 0) return;
    if (type == ngon && cell_dimension_ != 2) return;  // faces of a volume, inner ones too
    auto const* list = section.child("ElementConnectivity");
    if (list == nullptr) fail(section, "has no ElementConnectivity");
    auto const nodes = file_.integers(*list);
    if (type == ngon) return read_polygons(section, nodes);
    std::size_t at = 0;
    while (at < nodes.size()) {
      std::int64_t const own = type == mixed ? types_(nodes[at++]) : type;
      if (own < 0 || own >= std::int64_t(element_kinds.size()) || element_kinds[own].nodes == 0)
        fail(section, "names the element type " + std::to_string(own) + ", which is not supported in mixed sections");
      ElementKind const& kind = element_kinds[own];
      if (nodes.size() - at < std::size_t(kind.nodes)) fail(section, "its connectivity ends within an element");
      add_polygon(section, nodes.data() + at, kind.corners);
      at += std::size_t(kind.nodes);
    }
  }

  void read_polygons(Node const& section, std::vector<std::int64_t> const& nodes) {
    auto const* offsets = section.child("ElementStartOffset");
    if (offsets == nullptr)
      fail(section, "has polygons without ElementStartOffset; files before CGNS 4 are not supported");
    auto const starts = file_.integers(*offsets);
    for (std::size_t n = 0; n + 1 < starts.size(); ++n) {
      if (starts[n] < 0 || starts[n + 1] < starts[n] || starts[n + 1] > std::int64_t(nodes.size()) ||
          starts[n + 1] - starts[n] > 1000)
        fail(section, "polygon " + std::to_string(n + 1) + " has offsets " + std::to_string(starts[n]) + " to " +
                          std::to_string(starts[n + 1]) + " of " + std::to_string(nodes.size()));
      add_polygon(section, nodes.data() + starts[n], int(starts[n + 1] - starts[n]));
    }
  }

  void add_polygon(Node const& section, std::int64_t const* nodes, int corners) {
    for (int c = 0; c < corners; ++c)
      if (nodes[c] < 1 || nodes[c] > count_)
        fail(section, "names node " + std::to_string(nodes[c]) + " of " + std::to_string(count_));
    auto const number = [&](int c) { return int(first_ + nodes[c] - 1); };
    for (int c = 2; c < corners; ++c) out_.triangles.push_back({number(0), number(c - 1), number(c)});
  }

  File file_;
  Node tree_;
  cgns::ElementTypes types_;
  int cell_dimension_ = 3;
  Index first_ = 0, count_ = 0;  ///< points of the zone at hand
  TargetGeometry out_;
};

}  // namespace

TargetGeometry read_cgns_surface(std::string const& path) { return SurfaceReader(path).run(); }

}  // namespace gridmorph
