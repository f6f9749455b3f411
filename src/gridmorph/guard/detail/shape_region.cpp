#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/shape_region.hpp>
#include <gridmorph/kernels/cell_quality.hpp>

namespace gridmorph::detail {

namespace {

class RegionBuilder {
 public:
  RegionBuilder(HostInstance const& host, BlockCells const& mesh_cells, BlockPoints& points)
      : host_(host),
        mesh_cells_(mesh_cells),
        points_(points),
        local_(std::size_t(mesh_cells.size()), outside),
        point_(std::size_t(points.baseline().size()), outside) {}

  ShapeRegion build(std::span<Index const> cells, int rings) {
    grow(cells, rings);
    keep_collapsed();
    for (Index const node : reached_)
      if (point_[node] == reached && !points_.stays(node)) add_point(node);
    for (Index const cell : cells)
      if (local_[cell] < 0) region_.others.push_back(cell);
    find_corners();
    colour();
    return std::move(region_);
  }

 private:
  static constexpr Index32 outside = -1, reached = -2;

  /// Marks the nodes of the cells and of the rings around them, with their copies.
  void grow(std::span<Index const> cells, int rings) {
    std::vector<Index> now(cells.begin(), cells.end()), next, found;
    std::vector<std::uint8_t> taken(mesh_cells_.size(), 0);
    for (Index const cell : now) taken[cell] = 1;
    for (int ring = 0; ring <= rings && !now.empty(); ++ring) {
      found.clear();
      for (Index const cell : now) {
        CellNodes const nodes = mesh_cells_.nodes(cell);
        for (int c = 0; c < 8; ++c) reach(nodes.node(c), found);
      }
      next.clear();
      for (Index const node : found)
        mesh_cells_.around(node, [&](Index cell, int) {
          if (std::exchange(taken[cell], 1) == 0) next.push_back(cell);
        });
      std::swap(now, next);
    }
    std::sort(reached_.begin(), reached_.end());
  }
  void reach(Index node, std::vector<Index>& found) {
    if (point_[node] != outside) return;
    points_.for_each_node(node, [&](PointNode const& n) {
      if (std::exchange(point_[n.node], reached) != outside) return;
      found.push_back(n.node);
      reached_.push_back(n.node);
    });
  }

  /// Ends of edges without length are several nodes at one place that no interface names.
  void keep_collapsed() {
    Coordinates const& x = points_.baseline();
    for (Index const node : reached_)
      mesh_cells_.around(node, [&](Index cell, int corner) {
        CellNodes const nodes = mesh_cells_.nodes(cell);
        Vec3 edge[3];
        corner_edges(x, nodes, corner, edge);
        double longest = 0;
        for (Vec3 const& e : edge) longest = std::max(longest, dot(e, e));
        constexpr double limit = kernels::collapsed_fraction * kernels::collapsed_fraction;
        for (Vec3 const& e : edge)
          if (dot(e, e) <= limit * longest) points_.keep(node);
      });
  }

  void add_point(Index node) {
    std::vector<PointNode> nodes;
    points_.for_each_node(node, [&](PointNode const& n) { nodes.push_back(n); });
    auto const slide = points_.sliding(nodes);
    auto const corners = slide ? changed_corners(nodes) : std::nullopt;
    if (!corners) {
      points_.keep(node);
      return;
    }
    for (PointNode const& n : nodes) point_[n.node] = Index32(region_.sliding.size());
    region_.nodes.insert(region_.nodes.end(), nodes.begin(), nodes.end());
    region_.first_node.push_back(Index(region_.nodes.size()));
    for (auto [cell, corner] : *corners) {
      corner.cell = local(cell);
      region_.changing[corner.cell] |= std::uint8_t(1 << corner.corner);
      region_.point_corners.push_back(corner);
    }
    region_.first_corner.push_back(Index(region_.point_corners.size()));
    region_.sliding.push_back(slide->count > 0 ? Index32(region_.slides.size()) : -1);
    if (slide->count > 0) region_.slides.push_back(*slide);
  }

  Index32 local(Index cell) {
    Index32& number = local_[cell];
    if (number < 0) {
      number = Index32(region_.cells.size());
      region_.cells.push_back(mesh_cells_.nodes(cell));
      region_.numbers.push_back(cell);
      region_.changing.push_back(0);
    }
    return number;
  }

  using CornerOfCell = std::pair<Index, PointCorner>;
  [[nodiscard]] std::optional<std::vector<CornerOfCell>> changed_corners(std::vector<PointNode> const& nodes) const {
    std::vector<CornerOfCell> out;
    for (PointNode const& n : nodes)
      mesh_cells_.around(n.node, [&](Index cell, int corner) {
        auto const matrix = std::int16_t(n.matrix);
        out.push_back({cell, {0, std::uint8_t(corner), 1, matrix}});
        for (int d = 0; d < 3; ++d)
          out.push_back({cell, {0, std::uint8_t(corner ^ (1 << d)), std::uint8_t(2 << d), matrix}});
      });
    std::stable_sort(out.begin(), out.end(), [](CornerOfCell const& a, CornerOfCell const& b) {
      return std::pair(a.first, a.second.corner) < std::pair(b.first, b.second.corner);
    });
    std::size_t kept = 0;
    for (CornerOfCell const& c : out) {
      bool const again = kept > 0 && out[kept - 1].first == c.first && out[kept - 1].second.corner == c.second.corner;
      if (again && out[kept - 1].second.matrix != c.second.matrix) return {};
      if (again)
        out[kept - 1].second.roles |= c.second.roles;
      else
        out[kept++] = c;
    }
    out.resize(kept);
    return out;
  }

  void find_corners() {
    region_.corners.resize(region_.cells.size());
    for_all(host_, "gridmorph::shape_smoothing::baseline", Index(region_.cells.size()), [this](Index n) {
      for (int c = 0; c < 8; ++c) {
        Vec3 edge[3];
        corner_edges(points_.baseline(), region_.cells[n], c, edge);
        region_.corners[n][c] = kernels::BaselineCorner::of(edge);
      }
    });
  }

  void colour() {
    std::vector<Index32> colour(region_.n_points(), -1), taken_by;
    for (Index p = 0; p < region_.n_points(); ++p) {
      Index32 last = -1;
      for (PointCorner const& c : region_.corners_of(p)) {
        if (c.cell == last) continue;
        last = c.cell;
        for (int corner = 0; corner < 8; ++corner) {
          Index32 const q = point_[region_.cells[c.cell].node(corner)];
          if (q >= 0 && colour[q] >= 0) taken_by[colour[q]] = Index32(p);
        }
      }
      std::size_t free = 0;
      while (free < taken_by.size() && taken_by[free] == p) ++free;
      if (free == taken_by.size()) {
        taken_by.push_back(-1);
        region_.colours.emplace_back();
      }
      colour[p] = Index32(free);
      region_.colours[free].push_back(Index32(p));
    }
  }

  HostInstance const& host_;
  BlockCells const& mesh_cells_;
  BlockPoints& points_;
  std::vector<Index32> local_, point_;  ///< number in the region, per cell and per node
  std::vector<Index> reached_;
  ShapeRegion region_;
};

}  // namespace

ShapeRegion shape_region(HostInstance const& host, BlockCells const& mesh_cells, BlockPoints& points,
                         std::span<Index const> cells, int rings) {
  return RegionBuilder(host, mesh_cells, points).build(cells, rings);
}

}  // namespace gridmorph::detail
