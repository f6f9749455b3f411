#include <gridmorph/fillet/mitre_path.hpp>

#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr double reached = 0.8;       ///< radii, from which on layers of both walls may meet at right angles
constexpr double looked_at = 2;       ///< radii
constexpr double straight_on = 0.85;  ///< cosine between two edges of a grid line

enum class Step { diagonal, off_blade, off_end_wall };

/// Distances from the corner along the lines of the walls: those of the nodes that are 1, 2, ... cells from it.
struct LineHeights {
  std::array<std::vector<double>, 2> off;  ///< off the blade (along the end wall), off the end wall
};

class PathFinder {
 public:
  PathFinder(CornerLattice const& lattice, RootLine const& line, MitreReach const& reach)
      : lattice_(lattice), line_(line), reach_(reach), heights_(line.places.size()) {
    for (std::size_t k = 0; k < line.n_edges(); ++k) {
      roots_.push_back(lattice.first(line.edge(k)));
      measure(k);
    }
  }

  [[nodiscard]] Mitre find() const {
    auto steps = choose();
    Mitre out;
    std::vector<std::vector<CornerCell>> cells;
    for (std::size_t k = 0; k < line_.n_edges(); ++k) {
      cells.push_back(along(k, steps));
      steps.resize(std::min(steps.size(), cells.back().size()));
    }
    while (!steps.empty() && steps.back() != Step::diagonal) steps.pop_back();
    out.at.resize(line_.places.size());
    out.on_walls.resize(line_.places.size());
    for (std::size_t k = 0; k < line_.n_edges(); ++k)
      for (std::size_t end = 0; end < 2; ++end) {
        auto const& root = roots_[k].node[end];
        out.on_walls[(k + end) % line_.places.size()] = {place(root[0][1]), place(root[1][0])};
      }
    std::vector<std::array<int, 2>> layers;
    for (Step const step : steps) {
      if (step != Step::off_end_wall) ++out.layers[0];
      if (step != Step::off_blade) ++out.layers[1];
      layers.push_back(out.layers);
    }
    for (std::size_t k = 0; k < line_.n_edges(); ++k)
      for (std::size_t s = 0; s < steps.size(); ++s) {
        CornerCell const& cell = cells[k][s];
        bool const cut = steps[s] == Step::diagonal;
        if (cut) out.cut.push_back(cell);
        for (std::size_t end = 0; end < 2; ++end) {
          auto& at = out.at[(k + end) % line_.places.size()];
          auto const& node = cell.node[end];
          if (at.size() == s)
            at.push_back({place(cut ? node[1][1] : steps[s] == Step::off_blade ? node[1][0] : node[0][1]), layers[s]});
        }
      }
    return out;
  }

 private:
  [[nodiscard]] Index32 place(Index32 node) const { return lattice_.elements().place(node); }
  [[nodiscard]] Vec3 position(Index32 node) const { return lattice_.elements().mesh().coordinates[node]; }

  /// Measures the heights of layers along both walls, from the root edge on.
  void measure(std::size_t k) {
    double const far = looked_at * *std::max_element(reach_.radius.begin(), reach_.radius.end());
    for (int wall = 0; wall < 2; ++wall) {
      std::optional<CornerCell> cell = roots_[k];
      std::array<std::vector<double>, 2> heights;
      std::array<double, 2> height{0, 0};
      auto const enough = std::size_t(reach_.layers[wall]);
      while (cell && heights[0].size() < 10000) {
        for (std::size_t end = 0; end < 2; ++end) {
          auto const& node = cell->node[end];
          height[end] += distance(position(node[0][0]), position(wall == 0 ? node[1][0] : node[0][1]));
          heights[end].push_back(height[end]);
        }
        if (enough > 0 ? heights[0].size() > enough : std::min(height[0], height[1]) > far) break;
        cell = lattice_.off(*cell, wall);
      }
      for (std::size_t end = 0; end < 2; ++end) {
        auto& known = heights_[(k + end) % line_.places.size()].off[wall];
        if (known.empty() || heights[end].size() < known.size()) known = heights[end];
      }
    }
  }

  /// The steps of the mitre, the same everywhere, from the geometric means of heights.
  [[nodiscard]] std::vector<Step> choose() const {
    std::array<std::vector<double>, 2> mean;
    for (std::size_t wall = 0; wall < 2; ++wall) {
      std::size_t n = heights_.front().off[wall].size();
      for (LineHeights const& h : heights_) n = std::min(n, h.off[wall].size());
      mean[wall].assign(n, 0.0);
      for (LineHeights const& h : heights_)
        for (std::size_t l = 0; l < n; ++l) mean[wall][l] += std::log(h.off[wall][l]) / double(heights_.size());
    }
    // Logarithms of how much farther from one wall than from the other.
    auto const slant = [&](std::size_t i, std::size_t j) {
      return i < mean[0].size() && j < mean[1].size() ? std::abs(mean[0][i] - mean[1][j])
                                                      : std::numeric_limits<double>::infinity();
    };
    std::vector<Step> steps{Step::diagonal};
    std::size_t i = 0, j = 0;  // layers passed, less one
    while (!far_enough(i, j)) {
      double const on = slant(i + 1, j + 1), blade = slant(i + 1, j), wall = slant(i, j + 1);
      if (std::min({on, blade, wall}) == std::numeric_limits<double>::infinity()) break;
      Step const step = on <= blade && on <= wall ? Step::diagonal
                        : blade <= wall           ? Step::off_blade
                                                  : Step::off_end_wall;
      if (step != Step::off_end_wall) ++i;
      if (step != Step::off_blade) ++j;
      steps.push_back(step);
    }
    return steps;
  }

  [[nodiscard]] bool far_enough(std::size_t i, std::size_t j) const {
    if (reach_.layers != std::array<int, 2>{0, 0})
      return int(i) + 1 >= reach_.layers[0] && int(j) + 1 >= reach_.layers[1];
    for (std::size_t k = 0; k < heights_.size(); ++k)
      if (std::min(heights_[k].off[0][i], heights_[k].off[1][j]) < reached * reach_.radius[k]) return false;
    return true;
  }

  /// Cells of the path along one root edge: those that diagonals go through, and those that its edges lead into from.
  [[nodiscard]] std::vector<CornerCell> along(std::size_t k, std::vector<Step> const& steps) const {
    std::vector<CornerCell> out;
    std::optional<CornerCell> cell = roots_[k];
    for (std::size_t s = 0; s < steps.size() && cell; ++s) {
      out.push_back(*cell);
      if (steps[s] != Step::off_end_wall) cell = lattice_.off(*cell, 0);
      if (steps[s] != Step::off_blade && cell) cell = lattice_.off(*cell, 1);
    }
    return out;
  }

  CornerLattice const& lattice_;
  RootLine const& line_;
  MitreReach const& reach_;
  std::vector<CornerCell> roots_;     ///< per edge of the line
  std::vector<LineHeights> heights_;  ///< per place of it
};

/// Places that edges of elements lead to from one.
std::set<Index32> neighbours(JoinedElements const& elements, Index32 place, std::vector<Index32> const& of) {
  std::set<Index32> out;
  Mesh const& mesh = elements.mesh();
  for (Index32 const e : of) {
    ElementType const type = mesh.elements.type[e];
    auto const corners = mesh.elements.corners(e);
    for (int k = 0; type != ElementType::polyhedron && k < n_edges(type); ++k)
      for (int end = 0; end < 2; ++end)
        if (elements.place(corners[edge_corner(type, k, end)]) == place)
          out.insert(elements.place(corners[edge_corner(type, k, 1 - end)]));
  }
  return out;
}

/// The grid line that leaves both walls at a place of their common line.
std::vector<MitrePlace> grid_line(JoinedElements const& elements, WallEdges const& edges, Index32 root, double far) {
  std::vector<MitrePlace> out;
  auto inner = neighbours(elements, root, elements.around(root));
  std::erase_if(inner, [&](Index32 n) { return !edges.on_none(root, n); });
  if (inner.size() != 1) return out;
  out.push_back({*inner.begin(), {1, 1}});
  Index32 before = root;
  while (distance(elements.position(root), elements.position(out.back().place)) < far) {
    Index32 const here = out.back().place;
    auto above = elements.around(here);
    auto below = above;
    std::erase_if(above, [&](Index32 e) { return elements.has(e, before); });
    std::erase_if(below, [&](Index32 e) { return !elements.has(e, before); });
    auto next = neighbours(elements, here, above);
    for (Index32 const n : neighbours(elements, here, below)) next.erase(n);
    if (next.size() != 1) break;
    Index32 const n = *next.begin();
    if (dot(unit(elements.position(n) - elements.position(here)),
            unit(elements.position(here) - elements.position(before))) < straight_on)
      break;
    before = here;
    int const layer = int(out.size()) + 1;
    out.push_back({n, {layer, layer}});
  }
  return out;
}

}  // namespace

Mitre find_mitre(CornerLattice const& lattice, WallEdges const& edges, RootLine const& line, MitreReach const& reach) {
  if (line.cut) return PathFinder(lattice, line, reach).find();
  Mitre out;
  for (std::size_t k = 0; k < line.places.size(); ++k)
    out.at.push_back(grid_line(lattice.elements(), edges, line.places[k], looked_at * reach.radius[k]));
  return out;
}

}  // namespace gridmorph
