#include <gridmorph/motion/turbomachinery/blade_surface.hpp>

#include <gridmorph/boundary/face_grids.hpp>
#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_many.hpp>
#include <gridmorph/motion/detail/spanwise_lines.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace gridmorph {

namespace {

class Stitcher {
 public:
  Stitcher(Boundary const& boundary, std::vector<int> const& patches, BladeInput const& input,
           std::vector<std::string>& notes)
      : boundary_(boundary),
        patches_(patches),
        input_(input),
        notes_(notes),
        numbers_(1e-7 * box_diagonal(boundary.points(patches))) {}

  BladeSurface run() {
    for (int const p : patches_) first_.push_back(first_.back() + int(boundary_.points(p).size()));
    for (std::size_t p = 0; p < patches_.size(); ++p) add_patch(p);
    if (!sliced_) stitch();
    // What looks like grid lines of elements need not run from end to end of the span.
    if (!sliced_ && !of_blocks_ && !lines_reach()) sliced_ = true;
    if (sliced_) slice();
    for (int const p : left_out_)
      notes_.push_back("patch " + boundary_.describe_patch(p) +
                       " has no spanwise grid lines (a tip face?) and is left "
                       "out of the blade's sections");
    return std::move(blade_);
  }

 private:
  /// Points of one patch as a grid: direction 0 varies fastest.
  struct Piece {
    std::array<int, 2> extent{};
    std::vector<Vec3> points;
    std::vector<double> span;
    std::vector<BladeNode> nodes;
  };

  /// All nodes of the patch with this place in the list; of a plane mesh twice, as Boundary::points() has them.
  Piece nodes_of(std::size_t patch) {
    Piece all;
    all.points = boundary_.points(patches_[patch]);
    for (std::size_t n = 0; n < all.points.size(); ++n) {
      FlowPosition const at = input_.position(input_.frame.meridional(all.points[n]));
      all.nodes.push_back({at.m, at.h, first_[patch] + int(n), all.points[n]});
      all.span.push_back(at.h);
    }
    return all;
  }

  /// The grids that a patch is made of, and whether they are all of it.
  FaceGrids grids_of(int p, Piece const& all) {
    BoundarySurface const& own = boundary_.surface(p);
    if (own.grid) {
      std::vector<int> every(own.nodes.size());
      std::iota(every.begin(), every.end(), 0);
      return {{{*own.grid, std::move(every)}}, 0};
    }
    of_blocks_ = false;
    FaceGrids found = find_face_grids(own.faces, all.points);
    if (boundary_.is_plane())
      for (FaceGrid& line : found.grids) {
        line.extent[1] = 2;
        for (int n = 0; n < line.extent[0]; ++n) line.point.push_back(line.point[n] + int(own.nodes.size()));
      }
    return found;
  }

  void add_patch(std::size_t patch) {
    int const p = patches_[patch];
    Piece const all = nodes_of(patch);
    FaceGrids const found = grids_of(p, all);
    if (found.left_over > 0 && !is_tip(p, all)) sliced_ = true;
    bool any = false;
    for (FaceGrid const& grid : found.grids) {
      Piece piece;
      piece.extent = grid.extent;
      for (int const n : grid.point) {
        piece.points.push_back(all.points[n]);
        piece.span.push_back(all.span[n]);
        piece.nodes.push_back(all.nodes[n]);
      }
      any = add_grid(piece) || any;
    }
    if (!any && (found.left_over > 0 || std::any_of(found.grids.begin(), found.grids.end(), [](FaceGrid const& g) {
                   return g.extent[0] > 1 && g.extent[1] > 1;
                 })))
      left_out_.push_back(p);
  }

  /// Whether most of the area of a patch gains no span.
  bool is_tip(int p, Piece const& all) {
    double flat = 0, area = 0;
    double height = 0;
    for (Vec3 const& x : all.points) height += input_.height(input_.frame.meridional(x)) / double(all.points.size());
    FacetList const list = boundary_.facets({&p, 1});
    for (auto const& f : list.facets) {
      std::array<Vec3, 3> x;
      std::array<double, 3> span{};
      for (std::size_t k = 0; k < 3; ++k) {
        x[k] = list.points[f[k]];
        span[k] = all.span[f[k]];
      }
      double const own = norm(cross(x[1] - x[0], x[2] - x[0]));
      area += own;
      if (gradient_in(x, span) * height < least_span_gain) flat += own;
    }
    return flat > 0.5 * area;
  }

  bool add_grid(Piece const& piece) {
    if (piece.extent[0] < 2 || piece.extent[1] < 2) return false;
    double height = 0;
    for (Vec3 const& x : piece.points)
      height += input_.height(input_.frame.meridional(x)) / double(piece.points.size());
    int const direction = detail::spanwise_direction(
        piece.extent, [&](int n) { return piece.points[n]; },
        [&](int a, int b) { return std::abs(piece.span[b] - piece.span[a]) * height; });
    if (direction < 0) return false;
    add_lines(piece, direction, piece.nodes);
    return true;
  }

  void stitch() {
    if (lines_.lines().empty()) {
      if (!of_blocks_) {
        sliced_ = true;
        return;
      }
      throw MotionError(
          "no surface grid line of the blade runs spanwise: "
          "check the axis, and that `of` names its sides");
    }
    lines_.join_in_span();
    blade_.lines = lines_.lines();
    if (!of_blocks_) {
      auto const neighbours = lines_.neighbours();
      sliced_ = std::any_of(neighbours.begin(), neighbours.end(), [](auto const& list) { return list.size() > 2; });
      if (sliced_) return;
    }
    join_around();
  }

  /// Whether the lines of all contours run along nearly the same span.
  [[nodiscard]] bool lines_reach() const {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo, first = -lo, last = lo;
    for (BladeContour const& contour : blade_.contours)
      for (int const l : contour.lines) {
        double const a = blade_.nodes[blade_.lines[l].front()].span;
        double const b = blade_.nodes[blade_.lines[l].back()].span;
        lo = std::min(lo, a);
        hi = std::max(hi, b);
        first = std::max(first, a);
        last = std::min(last, b);
      }
    return last - first > 0.5 * (hi - lo);
  }

  /// The facets of all patches cut at span fractions.
  void slice() {
    blade_ = {};
    left_out_.clear();
    PointNumbers numbers(1e-7 * box_diagonal(boundary_.points(patches_)));
    SliceInput input;
    std::vector<BladeNode> nodes;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      Piece const all = nodes_of(p);
      std::vector<int> number;
      for (std::size_t n = 0; n < all.points.size(); ++n) {
        number.push_back(numbers.find_or_add(all.points[n], int(nodes.size())));
        if (number.back() < int(nodes.size())) continue;
        nodes.push_back(all.nodes[n]);
        input.points.push_back(all.points[n]);
      }
      for (auto const& f : boundary_.facets({&patches_[p], 1}).facets) add_triangles(f, number, input);
    }
    auto const meridional = [this](Vec3 const& x) { return input_.frame.meridional(x); };
    input.span = [&](Vec3 const& x) { return input_.position(meridional(x)).h; };
    input.along = [&](Vec3 const& x) { return input_.along(x); };
    input.height = [&](Vec3 const& x) { return input_.height(meridional(x)); };
    for (SlicedContour const& contour : slice_surface(input, notes_)) {
      BladeContour own{{}, contour.closed};
      for (auto const& line : contour.lines) {
        own.lines.push_back(int(blade_.lines.size()));
        auto& list = blade_.lines.emplace_back();
        for (SlicePlace const& place : line) {
          list.push_back(int(blade_.nodes.size()));
          blade_.nodes.push_back({input_.position(meridional(place.point)).m, place.span, -1, place.point});
          auto& mean = blade_.means.emplace_back();
          for (auto const& [n, w] : place.weights) mean.emplace_back(nodes[n].number, w);
        }
      }
      blade_.contours.push_back(std::move(own));
    }
    blade_.sliced = true;
  }

  /// Quadrilaterals are cut along the shorter diagonal.
  static void add_triangles(std::array<std::int32_t, 4> const& facet, std::vector<int> const& number,
                            SliceInput& input) {
    auto const add = [&](int a, int b, int c) {
      if (a != b && b != c && c != a) input.triangles.push_back({a, b, c});
    };
    int const a = number[facet[0]], b = number[facet[1]], c = number[facet[2]];
    if (facet[3] < 0) return add(a, b, c);
    int const d = number[facet[3]];
    auto const x = [&](int n) { return input.points[n]; };
    if (distance(x(a), x(c)) <= distance(x(b), x(d))) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(a, b, d);
      add(b, c, d);
    }
  }

  void add_lines(Piece const& piece, int direction, std::vector<BladeNode> const& nodes) {
    int const n_lines = piece.extent[1 - direction];
    for (int l = 0; l < n_lines; ++l) {
      auto nodes_of_line = detail::grid_line(piece.extent, direction, l);
      if (piece.span[nodes_of_line.front()] > piece.span[nodes_of_line.back()])
        std::reverse(nodes_of_line.begin(), nodes_of_line.end());
      std::vector<int> line;
      for (int const local : nodes_of_line) {
        int number = int(blade_.nodes.size());
        // Only nodes on the outline of a piece can be nodes of another piece too.
        bool const end = local == nodes_of_line.front() || local == nodes_of_line.back();
        if (l == 0 || l == n_lines - 1 || end) number = numbers_.find_or_add(piece.points[local], number);
        if (number == int(blade_.nodes.size())) blade_.nodes.push_back(nodes[local]);
        if (line.empty() || line.back() != number) line.push_back(number);
      }
      lines_.add(std::move(line), l == 0);
    }
  }

  void join_around() {
    auto const neighbours = lines_.neighbours();
    for (std::size_t l = 0; l < neighbours.size(); ++l)
      if (neighbours[l].size() > 2) {
        BladeNode const& node = blade_.nodes[blade_.lines[l].front()];
        throw MotionError("at position " + std::to_string(node.m) + " along the flow path" + " and span fraction " +
                          std::to_string(node.span) +
                          " more than two surfaces of the blade meet in one spanwise line; "
                          "let `of` name the two sides of one blade row only");
      }
    std::vector<bool> used(blade_.lines.size(), false);
    auto const walk = [&](int start, bool closed) {
      BladeContour contour{{}, closed};
      for (int at = start; at >= 0;) {
        used[at] = true;
        contour.lines.push_back(at);
        int next = -1;
        for (int n : neighbours[at])
          if (next < 0 && !used[n]) next = n;
        at = next;
      }
      if (contour.lines.size() > 1) blade_.contours.push_back(std::move(contour));
    };
    // Open contours first, each from an end: a walk from amid one would miss the lines before it.
    for (std::size_t l = 0; l < neighbours.size(); ++l)
      if (!used[l] && neighbours[l].size() < 2) walk(int(l), false);
    for (std::size_t l = 0; l < neighbours.size(); ++l)
      if (!used[l]) walk(int(l), true);
  }

  Boundary const& boundary_;
  std::vector<int> const& patches_;
  BladeInput const& input_;
  std::vector<std::string>& notes_;
  PointNumbers numbers_;
  std::vector<int> first_{0};  ///< number of the first node of each patch, and of all at the end
  BladeSurface blade_;
  detail::SpanwiseLines lines_;
  std::vector<int> left_out_;  ///< patches without spanwise lines
  bool of_blocks_ = true;
  bool sliced_ = false;  ///< by facets, since grid lines do not make up the surface
};

}  // namespace

BladeSurface stitch_blade(Boundary const& boundary, std::vector<int> const& patches, BladeInput const& input,
                          std::vector<std::string>& notes) {
  double const size = box_diagonal(boundary.points(patches));
  if (!(size > 0) || !std::isfinite(size)) throw MotionError("the blade's nodes are one point, or not finite");
  return Stitcher(boundary, patches, input, notes).run();
}

std::vector<CylindricalMotion> motions_of(BladeSurface const& blade, Boundary const& boundary,
                                          std::vector<int> const& patches, BladeDisplacement const& given) {
  std::vector<Vec3> const points = boundary.points(patches);
  std::vector<Vec3> displacement(points.size());
  std::size_t first = 0;
  for (int const p : patches) {
    // Those of a plane mesh come a second time, across it.
    std::size_t const n_own = boundary.surface(p).nodes.size(), n_all = boundary.is_plane() ? 2 * n_own : n_own;
    auto const of_patch = std::span(displacement).subspan(first, n_all);
    given.displacement(p, std::span(points).subspan(first, n_own), of_patch.first(n_own));
    std::copy_n(of_patch.begin(), n_all - n_own, of_patch.begin() + std::ptrdiff_t(n_own));
    first += n_all;
  }
  std::vector<CylindricalMotion> motion(points.size());
  detail::for_many("gridmorph::motions_of", Index(points.size()),
                   [&](Index n) { motion[n] = given.motion(points[n], displacement[n]); });
  std::vector<CylindricalMotion> out(blade.nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    if (!blade.sliced) {
      out[n] = motion[blade.nodes[n].number];
      continue;
    }
    for (auto const& [k, w] : blade.means[n]) {
      out[n].axial += w * motion[k].axial;
      out[n].radial += w * motion[k].radial;
      out[n].angle_rad += w * motion[k].angle_rad;
    }
  }
  return out;
}

int leave_out_splitters(BladeSurface& blade) {
  struct Chord {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    [[nodiscard]] double length() const { return hi - lo; }
  };
  // Chords at mid-span of each line: sweep moves the edges of a blade along the span as far as splitters are apart.
  std::vector<Chord> chords;
  for (BladeContour const& contour : blade.contours) {
    Chord& chord = chords.emplace_back();
    for (int l : contour.lines) {
      std::vector<int> const& line = blade.lines[l];
      double const middle = 0.5 * (blade.nodes[line.front()].span + blade.nodes[line.back()].span);
      int const n = *std::min_element(line.begin(), line.end(), [&](int a, int b) {
        return std::abs(blade.nodes[a].span - middle) < std::abs(blade.nodes[b].span - middle);
      });
      chord.lo = std::min(chord.lo, blade.nodes[n].m);
      chord.hi = std::max(chord.hi, blade.nodes[n].m);
    }
  }
  if (chords.empty()) return 0;
  Chord const longest = *std::max_element(chords.begin(), chords.end(),
                                          [](Chord const& a, Chord const& b) { return a.length() < b.length(); });
  constexpr double alike = 0.15;
  std::vector<BladeContour> kept;
  for (std::size_t c = 0; c < chords.size(); ++c) {
    if (chords[c].hi < longest.lo || chords[c].lo > longest.hi)
      throw MotionError("the blade has surfaces from " + std::to_string(longest.lo) + " to " +
                        std::to_string(longest.hi) + " along the flow path and from " + std::to_string(chords[c].lo) +
                        " to " + std::to_string(chords[c].hi) + ": blades of two rows; let `of` name those of one row");
    if (std::max(std::abs(chords[c].lo - longest.lo), std::abs(chords[c].hi - longest.hi)) <= alike * longest.length())
      kept.push_back(std::move(blade.contours[c]));
  }
  int const left_out = int(chords.size() - kept.size());
  blade.contours = std::move(kept);
  return left_out;
}

}  // namespace gridmorph
