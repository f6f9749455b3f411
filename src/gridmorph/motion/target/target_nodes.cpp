#include <gridmorph/motion/target/target_mappings.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

/// The distance by which targets of coincident nodes may differ: 1e-6 of the surface's size, since files of targets are
/// in single precision, or what the precision of the mesh makes of it.
double same_place(PatchSurface const& surface) { return std::max(1e-6 * surface.size, surface.tolerance); }

/// How a patch is laid over a grid of its size.
struct Layout {
  bool swapped = false;
  std::array<bool, 2> reversed{false, false};  ///< along the grid's directions
  std::array<int, 2> shift{0, 0};              ///< along the grid's directions
  [[nodiscard]] bool as_given() const { return !swapped && !reversed[0] && !reversed[1] && shift[0] + shift[1] == 0; }
};

class GridMatcher {
 public:
  GridMatcher(PatchSurface const& surface, std::vector<TargetGrid> const& grids)
      : surface_(surface), grids_(grids), taken_(grids.size(), 0) {
    placed.assign(surface.points.size(), 0);
    target.resize(surface.points.size());
  }

  /// Lays a patch over a grid of the target; false when no free grid has the size of the patch.
  bool place(PatchGrid const& patch, std::vector<std::string>& found) {
    struct Choice {
      Cost cost{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
      int grid = -1;
      Layout layout;
    } nearest, alike;
    double const tie = 1e-20 * surface_.size * surface_.size;
    auto const less = [tie](double a, double b) { return a < (1 - 1e-9) * b - tie; };
    for (std::size_t g = 0; g < grids_.size(); ++g) {
      if (taken_[g] != 0) continue;
      for (Layout const& layout : layouts(patch, grids_[g])) {
        Cost const c = cost(patch, grids_[g], layout);
        if (less(c.moved, nearest.cost.moved)) nearest = {c, int(g), layout};
        if (less(c.bent, alike.cost.bent)) alike = {c, int(g), layout};
      }
    }
    if (nearest.grid < 0) return false;
    bool const turned = less(alike.cost.bent, 0.1 * nearest.cost.bent);
    int const best_grid = turned ? alike.grid : nearest.grid;
    Layout const best = turned ? alike.layout : nearest.layout;
    taken_[best_grid] = 1;
    for (int b = 0; b < patch.extent[1]; ++b)
      for (int a = 0; a < patch.extent[0]; ++a) {
        int const v = patch.at(a, b);
        Vec3 const t = at(patch, grids_[best_grid], best, a, b);
        if (placed[v] == 0) {
          placed[v] = 1;
          target[v] = t;
        } else if (double const d = distance(t, target[v]); d > gap) {
          gap = d;
          gap_vertex = v;
          gap_patch = patch.patch;
        }
      }
    if (!best.as_given())
      found.push_back("'" + grids_[best_grid].name + "'" + (best.swapped ? " with its directions swapped" : "") +
                      (best.reversed[0] || best.reversed[1] ? " reversed" : "") +
                      (best.shift[0] + best.shift[1] > 0 ? " from another start" : ""));
    return true;
  }

  std::vector<char> placed;
  std::vector<Vec3> target;
  double gap = 0;
  int gap_vertex = -1, gap_patch = -1;

 private:
  [[nodiscard]] bool closed(PatchGrid const& patch, int direction) const {
    for (int n = 0; n < patch.extent[1 - direction]; ++n) {
      int const last = patch.extent[direction] - 1;
      if ((direction == 0 ? patch.at(0, n) != patch.at(last, n) : patch.at(n, 0) != patch.at(n, last))) return false;
    }
    return patch.extent[direction] > 3;
  }
  [[nodiscard]] bool closed(TargetGrid const& grid, int direction) const {
    int const last = grid.extent[direction] - 1;
    for (int n = 0; n < grid.extent[1 - direction]; ++n) {
      Vec3 const first = direction == 0 ? point(grid, 0, n) : point(grid, n, 0);
      Vec3 const end = direction == 0 ? point(grid, last, n) : point(grid, n, last);
      if (distance(first, end) > same_place(surface_)) return false;
    }
    return last > 2;
  }
  static Vec3 const& point(TargetGrid const& grid, int p, int q) {
    return grid.points[std::size_t(p) + std::size_t(grid.extent[0]) * q];
  }

  [[nodiscard]] std::vector<Layout> layouts(PatchGrid const& patch, TargetGrid const& grid) const {
    std::vector<Layout> out;
    for (bool const swapped : {false, true}) {
      if (grid.extent[0] != patch.extent[swapped ? 1 : 0] || grid.extent[1] != patch.extent[swapped ? 0 : 1]) continue;
      std::array<int, 2> starts{1, 1};
      for (int d = 0; d < 2; ++d)
        if (closed(grid, d) && closed(patch, swapped ? 1 - d : d)) starts[d] = grid.extent[d] - 1;
      for (int const reversed : {0, 1, 2, 3})
        for (int s1 = 0; s1 < starts[1]; ++s1)
          for (int s0 = 0; s0 < starts[0]; ++s0)
            out.push_back({swapped, {(reversed & 1) != 0, (reversed & 2) != 0}, {s0, s1}});
    }
    return out;
  }

  static Vec3 const& at(PatchGrid const&, TargetGrid const& grid, Layout const& layout, int a, int b) {
    std::array<int, 2> p{layout.swapped ? b : a, layout.swapped ? a : b};
    for (int d = 0; d < 2; ++d) {
      if (layout.reversed[d]) p[d] = grid.extent[d] - 1 - p[d];
      if (layout.shift[d] > 0) p[d] = (p[d] + layout.shift[d]) % (grid.extent[d] - 1);
    }
    return point(grid, p[0], p[1]);
  }

  /// Mean squares: how far nodes move, and how far they are from the best rigid motion.
  struct Cost {
    double moved, bent;
  };
  [[nodiscard]] Cost cost(PatchGrid const& patch, TargetGrid const& grid, Layout const& layout) const {
    // Lines of nodes left out evenly, the outline never.
    auto const step = [](int n) { return std::max(1, n / 45); };
    std::vector<Vec3> from, to;
    double raw = 0, torn = 0;
    for (int b = 0; b < patch.extent[1]; ++b)
      for (int a = 0; a < patch.extent[0]; ++a) {
        bool const border = a == 0 || b == 0 || a == patch.extent[0] - 1 || b == patch.extent[1] - 1;
        if (!border && (a % step(patch.extent[0]) != 0 || b % step(patch.extent[1]) != 0)) continue;
        int const v = patch.at(a, b);
        Vec3 const t = at(patch, grid, layout, a, b);
        from.push_back(surface_.points[v]);
        to.push_back(t);
        raw += dot(t - from.back(), t - from.back());
        if (placed[v] != 0 && distance(t, target[v]) > same_place(surface_)) torn += surface_.size * surface_.size;
      }
    RigidTransform const fit = fit_rigid_transform(from, to);
    double bent = 0;
    for (std::size_t n = 0; n < from.size(); ++n) {
      Vec3 const d = to[n] - fit(from[n]);
      bent += dot(d, d);
    }
    return {raw / double(from.size()) + torn, bent / double(from.size()) + torn};
  }

  PatchSurface const& surface_;
  std::vector<TargetGrid> const& grids_;
  std::vector<char> taken_;
};

std::vector<Vec3> displacement(PatchSurface const& surface, std::vector<Vec3> const& target) {
  std::vector<Vec3> out;
  out.reserve(target.size());
  for (std::size_t v = 0; v < target.size(); ++v) out.push_back(target[v] - surface.points[v]);
  return out;
}

}  // namespace

std::optional<std::vector<Vec3>> match_grids(PatchSurface const& surface, std::vector<TargetGrid> const& grids,
                                             Boundary const& boundary, std::string const& name,
                                             std::vector<std::string>& notes) {
  GridMatcher matcher(surface, grids);
  std::vector<std::string> found;
  for (PatchGrid const& patch : surface.grids)
    if (!matcher.place(patch, found)) return std::nullopt;
  if (matcher.gap > same_place(surface))
    throw MotionError(name + ": the grids that were matched with the patches come apart at the node " +
                      to_text(surface.points[matcher.gap_vertex], 9) + " of patch " +
                      boundary.describe_patch(matcher.gap_patch) + " by " + std::to_string(matcher.gap) +
                      "; give a target whose pieces meet where the patches do, or mapping = \"projection\"");
  std::string note = name + ": mapped node for node";
  for (std::size_t n = 0; n < found.size(); ++n) note += (n == 0 ? "; " : ", ") + found[n];
  notes.push_back(note);
  return displacement(surface, matcher.target);
}

std::vector<Vec3> match_nodes(PatchSurface const& surface, std::vector<Vec3> const& nodes, Boundary const& boundary,
                              std::string const& name) {
  std::size_t wanted = 0;
  for (PatchGrid const& patch : surface.grids) wanted += patch.vertex.size();
  if (wanted != nodes.size())
    throw MotionError(name + ": lists " + std::to_string(nodes.size()) + " points, but its patches have " +
                      std::to_string(wanted) + " nodes; give one point per node, patch after patch, i fastest");
  std::vector<Vec3> target(surface.points.size());
  std::vector<char> placed(surface.points.size(), 0);
  std::size_t n = 0;
  for (PatchGrid const& patch : surface.grids)
    for (std::size_t k = 0; k < patch.vertex.size(); ++k) {
      int const v = patch.vertex[patch.listed.empty() ? k : std::size_t(patch.listed[k])];
      Vec3 const& t = nodes[n++];
      if (placed[v] == 0) {
        placed[v] = 1;
        target[v] = t;
      } else if (distance(t, target[v]) > same_place(surface)) {
        throw MotionError(name + ": the node " + to_text(surface.points[v], 9) + " of patch " +
                          boundary.describe_patch(patch.patch) + " coincides with one listed before, but goes to " +
                          to_text(t, 9) + " (point " + std::to_string(n) + ") instead of " + to_text(target[v], 9) +
                          "; nodes that coincide need one target");
      }
    }
  return displacement(surface, target);
}

}  // namespace gridmorph
