#include <gridmorph/motion/turbomachinery/blade_surface.hpp>

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/detail/spanwise_lines.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

class Stitcher {
 public:
  Stitcher(Boundary const& boundary, std::vector<int> const& patches, BladeInput const& input,
           std::vector<std::string>& notes)
      : boundary_(boundary), input_(input), notes_(notes), numbers_(1e-7 * box_diagonal(boundary.points(patches))) {
    for (int p : patches) add_patch(p);
  }

  BladeSurface run() {
    if (lines_.lines().empty())
      throw MotionError(
          "no surface grid line of the blade runs spanwise: "
          "check the axis, and that `of` names its sides");
    lines_.join_in_span();
    blade_.lines = lines_.lines();
    join_around();
    return std::move(blade_);
  }

 private:
  /// One patch as a grid of points: direction 0 varies fastest.
  struct Piece {
    std::array<int, 2> extent{};
    std::vector<Vec3> points;
    std::vector<double> span;
  };

  void add_patch(int p) {
    Piece piece;
    piece.extent = boundary_.surface(p).grid.value();
    piece.points = boundary_.points(p);
    if (piece.extent[0] < 2 || piece.extent[1] < 2) return;

    std::vector<Vec3> displacement(piece.points.size());
    input_.displacement(p, piece.points, displacement);
    std::vector<BladeNode> nodes;
    double height = 0;
    for (std::size_t n = 0; n < piece.points.size(); ++n) {
      MeridionalPoint const m = input_.frame.meridional(piece.points[n]);
      FlowPosition const at = input_.position(m);
      nodes.push_back({at.m, at.h, input_.motion(piece.points[n], displacement[n]), piece.points[n]});
      piece.span.push_back(at.h);
      height += input_.height(m) / double(piece.points.size());
    }
    int const direction = detail::spanwise_direction(
        piece.extent, [&](int n) { return piece.points[n]; },
        [&](int a, int b) { return std::abs(piece.span[b] - piece.span[a]) * height; });
    if (direction < 0) {
      notes_.push_back("patch " + describe_patch(boundary_.mesh(), boundary_.mesh().patches[p]) +
                       " has no spanwise grid lines (a tip face?) and is left "
                       "out of the blade's sections");
      return;
    }
    add_lines(piece, direction, nodes);
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
    for (std::size_t l = 0; l < neighbours.size(); ++l)
      if (!used[l] && neighbours[l].size() < 2) walk(int(l), false);
    for (std::size_t l = 0; l < neighbours.size(); ++l)
      if (!used[l]) walk(int(l), true);
  }

  Boundary const& boundary_;
  BladeInput const& input_;
  std::vector<std::string>& notes_;
  PointNumbers numbers_;
  BladeSurface blade_;
  detail::SpanwiseLines lines_;
};

}  // namespace

BladeSurface stitch_blade(Boundary const& boundary, std::vector<int> const& patches, BladeInput const& input,
                          std::vector<std::string>& notes) {
  double const size = box_diagonal(boundary.points(patches));
  if (!(size > 0) || !std::isfinite(size)) throw MotionError("the blade's nodes are one point, or not finite");
  return Stitcher(boundary, patches, input, notes).run();
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
