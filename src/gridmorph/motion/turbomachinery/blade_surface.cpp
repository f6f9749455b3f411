#include <gridmorph/motion/turbomachinery/blade_surface.hpp>

#include <gridmorph/boundary/patch_points.hpp>
#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace gridmorph {

namespace {

/// Numbers points so that points closer than the tolerance get one number: a hash grid of that cell size.
class MergedPoints {
 public:
  explicit MergedPoints(double tolerance) : tolerance_(tolerance) {}

  /// The number of a known point within the tolerance of p, or `fresh`, which p then has.
  int find_or_add(Vec3 const& p, int fresh) {
    Cell const c = cell(p);
    for (long long i = c[0] - 1; i <= c[0] + 1; ++i)
      for (long long j = c[1] - 1; j <= c[1] + 1; ++j)
        for (long long k = c[2] - 1; k <= c[2] + 1; ++k)
          if (auto const known = cells_.find({i, j, k}); known != cells_.end())
            for (auto const& [q, n] : known->second)
              if (distance(p, q) <= tolerance_) return n;
    cells_[c].emplace_back(p, fresh);
    return fresh;
  }

 private:
  using Cell = std::array<long long, 3>;
  Cell cell(Vec3 const& p) const {
    auto const floor = [this](double v) { return (long long)(std::floor(v / tolerance_)); };
    return {floor(p.x), floor(p.y), floor(p.z)};
  }
  double tolerance_;
  std::map<Cell, std::vector<std::pair<Vec3, int>>> cells_;
};

class Stitcher {
 public:
  Stitcher(Mesh const& mesh, std::vector<int> const& patches, BladeInput const& input, std::vector<std::string>& notes)
      : mesh_(mesh), input_(input), notes_(notes), numbers_(1e-7 * box_diagonal(patch_points(mesh, patches))) {
    for (int p : patches) add_patch(p);
  }

  BladeSurface run() {
    if (lines_.empty())
      throw MotionError(
          "no surface grid line of the blade runs spanwise: "
          "check the axis, and that `of` names its sides");
    join_in_span();
    join_around();
    return std::move(blade_);
  }

 private:
  using Line = std::vector<int>;

  /// One patch as a grid of points: direction 0 varies fastest.
  struct Piece {
    std::array<int, 2> extent{};
    std::vector<Vec3> points;
    std::vector<double> span;
    [[nodiscard]] int at(int direction, int line, int along) const {
      return direction == 0 ? along + extent[0] * line : line + extent[0] * along;
    }
  };

  /// How much of the length of the lines along a direction goes into span, both as fractions of the blade's height.
  static double spanwise_share(Piece const& piece, int direction, double height) {
    double risen = 0, length = 0;
    for (int line = 0; line < piece.extent[1 - direction]; ++line) {
      int const n = piece.extent[direction];
      risen +=
          std::abs(piece.span[piece.at(direction, line, n - 1)] - piece.span[piece.at(direction, line, 0)]) * height;
      for (int k = 0; k + 1 < n; ++k)
        length += distance(piece.points[piece.at(direction, line, k)], piece.points[piece.at(direction, line, k + 1)]);
    }
    return length > 0 ? risen / length : 0;
  }

  void add_patch(int p) {
    Patch const& patch = mesh_.patches[p];
    Piece piece;
    for (int axis = 0, d = 0; axis < 3 && d < 2; ++axis)
      if (patch.range.extent(axis) > 1) piece.extent[d++] = patch.range.extent(axis);
    piece.points = patch_points(mesh_, {p});
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
    std::array<double, 2> const share{spanwise_share(piece, 0, height), spanwise_share(piece, 1, height)};
    int const direction = share[0] > share[1] ? 0 : 1;
    if (!(share[direction] > 0.3)) {
      notes_.push_back("patch " + describe_patch(mesh_, patch) +
                       " has no spanwise grid lines (a tip face?) and is left "
                       "out of the blade's sections");
      return;
    }
    add_lines(piece, direction, nodes);
  }

  void add_lines(Piece const& piece, int direction, std::vector<BladeNode> const& nodes) {
    int const n_lines = piece.extent[1 - direction], n = piece.extent[direction];
    int previous = -1;
    for (int l = 0; l < n_lines; ++l) {
      bool const upwards = piece.span[piece.at(direction, l, 0)] <= piece.span[piece.at(direction, l, n - 1)];
      Line line;
      for (int k = 0; k < n; ++k) {
        int const local = piece.at(direction, l, upwards ? k : n - 1 - k);
        int number = int(blade_.nodes.size());
        // Only nodes on the outline of a piece can be nodes of another piece too.
        if (l == 0 || l == n_lines - 1 || k == 0 || k == n - 1)
          number = numbers_.find_or_add(piece.points[local], number);
        if (number == int(blade_.nodes.size())) blade_.nodes.push_back(nodes[local]);
        if (line.empty() || line.back() != number) line.push_back(number);
      }
      int const own = add_unique(lines_, known_lines_, std::move(line));
      if (previous >= 0 && previous != own) beside_.insert(std::minmax(previous, own));
      previous = own;
    }
  }

  static int add_unique(std::vector<Line>& lines, std::map<Line, int>& known, Line line) {
    auto const [at, fresh] = known.try_emplace(line, int(lines.size()));
    if (fresh) lines.push_back(std::move(line));
    return at->second;
  }

  /// A line that ends where another begins continues in it.
  void join_in_span() {
    std::map<int, int> begins_at;
    std::set<int> ends;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      begins_at.try_emplace(lines_[l].front(), int(l));
      ends.insert(lines_[l].back());
    }
    std::vector<int> whole(lines_.size(), -1);
    std::map<Line, int> known;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      if (ends.contains(lines_[l].front())) continue;  // has something below it
      Line line = lines_[l];
      std::vector<int> parts{int(l)};
      for (auto next = begins_at.find(line.back()); next != begins_at.end() && parts.size() <= lines_.size();
           next = begins_at.find(line.back())) {
        parts.push_back(next->second);
        line.insert(line.end(), lines_[next->second].begin() + 1, lines_[next->second].end());
      }
      int const number = add_unique(blade_.lines, known, std::move(line));
      for (int part : parts)
        if (whole[part] < 0) whole[part] = number;
    }
    std::set<std::pair<int, int>> joined;
    for (auto const& [a, b] : beside_)
      if (whole[a] >= 0 && whole[b] >= 0 && whole[a] != whole[b]) joined.insert(std::minmax(whole[a], whole[b]));
    beside_ = std::move(joined);
  }

  void join_around() {
    std::vector<std::vector<int>> neighbours(blade_.lines.size());
    for (auto const& [a, b] : beside_) {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
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

  Mesh const& mesh_;
  BladeInput const& input_;
  std::vector<std::string>& notes_;
  MergedPoints numbers_;
  BladeSurface blade_;
  std::vector<Line> lines_;
  std::map<Line, int> known_lines_;
  std::set<std::pair<int, int>> beside_;  ///< lines that follow one another around the section
};

}  // namespace

BladeSurface stitch_blade(Mesh const& mesh, std::vector<int> const& patches, BladeInput const& input,
                          std::vector<std::string>& notes) {
  double const size = box_diagonal(patch_points(mesh, patches));
  if (!(size > 0) || !std::isfinite(size)) throw MotionError("the blade's nodes are one point, or not finite");
  return Stitcher(mesh, patches, input, notes).run();
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
