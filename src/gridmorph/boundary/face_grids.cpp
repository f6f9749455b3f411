#include <gridmorph/boundary/face_grids.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

/// Faces as half-edges: number 4 f + s goes from corner s of face f to the next one around it.
class Quads {
 public:
  Quads(std::vector<GridFacet> const& faces, std::vector<Vec3> const& points, double crease_angle)
      : faces_(faces),
        points_(points),
        twin_(4 * faces.size(), -1),
        cut_(4 * faces.size(), false),
        seen_(faces.size(), 0) {
    join();
    std::vector<int> todo;
    bool const creases = crease_angle < 3.14;
    double const least = std::cos(crease_angle);
    for (int h = 0; h < int(twin_.size()); ++h) {
      if (creases && twin_[h] > h && cosine(h / 4, twin_[h] / 4) < least) cut(h, todo);
      todo.push_back(h);
    }
    cut_on(std::move(todo));
  }

  FaceGrids run() {
    FaceGrids out;
    std::vector<char> used(faces_.size(), 0);
    for (int f = 0; f < int(faces_.size()); ++f)
      if (used[f] == 0) part(f, used, out);
    return out;
  }

 private:
  static int next(int h) { return 4 * (h / 4) + (h + 1) % 4; }
  static int before(int h) { return 4 * (h / 4) + (h + 3) % 4; }
  [[nodiscard]] int origin(int h) const { return faces_[h / 4][h % 4]; }
  /// The face beside, unless a cut lies between; -1: none.
  [[nodiscard]] int across(int h) const { return cut_[h] ? -1 : twin_[h]; }

  void join() {
    // More than two faces at a side, or two that go opposite ways around, have no neighbours there.
    std::map<std::pair<int, int>, std::vector<int>> sides;
    for (int h = 0; h < int(twin_.size()); ++h) sides[std::minmax(origin(h), origin(next(h)))].push_back(h);
    for (auto const& [ends, at] : sides)
      if (at.size() == 2 && at[0] / 4 != at[1] / 4 && origin(at[0]) != origin(at[1])) {
        twin_[at[0]] = at[1];
        twin_[at[1]] = at[0];
      }
  }

  [[nodiscard]] Vec3 normal(int f) const {
    auto const at = [&](int s) { return points_[origin(4 * f + s)]; };
    return cross(at(2) - at(0), at(3) - at(1));
  }
  [[nodiscard]] double cosine(int f, int g) const {
    Vec3 const a = normal(f), b = normal(g);
    double const size = norm(a) * norm(b);
    return size > 0 ? dot(a, b) / size : 1;
  }

  void cut(int h, std::vector<int>& todo) {
    if (twin_[h] < 0 || cut_[h]) return;
    for (int const side : {h, twin_[h]}) {
      cut_[side] = true;
      todo.push_back(side);
    }
  }

  /// The half-edges that leave the origin of h between the cuts on both sides of its face, in the order around the
  /// point. `around`: no cut, all around it.
  [[nodiscard]] std::vector<int> sector(int h, bool& around) const {
    int first = h;
    around = false;
    for (int at = across(h); at >= 0; at = across(first)) {
      first = next(at);
      if (first == h) {
        around = true;
        break;
      }
    }
    std::vector<int> out{first};
    for (int at = across(before(first)); at >= 0 && at != first; at = across(before(at))) out.push_back(at);
    return out;
  }

  /// Cuts on from where a part could not be a grid, until all can.
  void cut_on(std::vector<int> todo) {
    while (!todo.empty()) {
      int const h = todo.back();
      todo.pop_back();
      bool around = false;
      auto const leaving = sector(h, around);
      std::size_t const n = leaving.size();
      if (around && n == 4) continue;
      if (around) {
        for (int const e : leaving) cut(e, todo);
      } else if (n == 4) {
        cut(leaving[2], todo);
      } else if (n > 2) {
        for (std::size_t k = 1; k < n; ++k) cut(leaving[k], todo);
      }
    }
  }

  [[nodiscard]] std::vector<int> faces_of_part(int f) {
    std::vector<int> out{f};
    ++walks_;
    seen_[f] = walks_;
    for (std::size_t n = 0; n < out.size(); ++n)
      for (int s = 0; s < 4; ++s)
        if (int const at = across(4 * out[n] + s); at >= 0 && seen_[at / 4] != walks_) {
          seen_[at / 4] = walks_;
          out.push_back(at / 4);
        }
    std::sort(out.begin(), out.end());
    return out;
  }

  void part(int f, std::vector<char>& used, FaceGrids& out) {
    std::vector<int> faces = faces_of_part(f);
    int corner = find_corner(faces);
    if (corner < 0) {
      // Closed around: cut across at its first border, or anywhere where it has none; what is closed both ways is cut
      // twice.
      for (int pass = 0; pass < 2 && corner < 0; ++pass) {
        int at = 4 * faces.front();
        for (int const face : faces)
          for (int s = 0; s < 4; ++s)
            if (across(4 * face + s) < 0 && across(at) >= 0) at = 4 * face + s;
        std::vector<int> todo;
        cut(across(at) < 0 ? before(at) : at, todo);
        cut_on(std::move(todo));
        corner = find_corner(faces);
      }
    }
    for (int const face : faces) used[face] = 1;
    FaceGrid grid;
    if (corner >= 0 && walk(corner, faces.size(), grid))
      out.grids.push_back(std::move(grid));
    else
      out.left_over += faces.size();
  }

  /// A half-edge that leaves a corner of the part along its border; -1: it has none.
  [[nodiscard]] int find_corner(std::vector<int> const& faces) const {
    for (int const face : faces)
      for (int s = 0; s < 4; ++s)
        if (across(4 * face + s) < 0 && across(before(4 * face + s)) < 0) return 4 * face + s;
    return -1;
  }

  /// Row by row from a corner. False when the rows are not alike.
  bool walk(int corner, std::size_t n_faces, FaceGrid& grid) const {
    std::vector<std::vector<int>> rows;
    std::size_t seen = 0;
    int last = -1;
    for (int start = corner; start >= 0; start = across(next(next(start)))) {
      std::vector<int> row;
      int h = start;
      for (; row.size() <= n_faces; h = next(across(next(h)))) {
        row.push_back(h);
        if (across(next(h)) < 0) break;
      }
      seen += row.size();
      if (seen > n_faces || (!rows.empty() && row.size() != rows.front().size())) return false;
      rows.push_back(std::move(row));
      last = start;
    }
    if (seen != n_faces || last < 0) return false;
    grid.extent = {int(rows.front().size()) + 1, int(rows.size()) + 1};
    for (auto const& row : rows) {
      for (int const h : row) grid.point.push_back(origin(h));
      grid.point.push_back(origin(next(row.back())));
    }
    for (int const h : rows.back()) grid.point.push_back(origin(before(h)));
    grid.point.push_back(origin(next(next(rows.back().back()))));
    return true;
  }

  std::vector<GridFacet> const& faces_;
  std::vector<Vec3> const& points_;
  std::vector<int> twin_;  ///< of each half-edge; -1 at borders
  std::vector<bool> cut_;
  std::vector<int> seen_;  ///< the walk that came last to each face
  int walks_ = 0;
};

/// Sides of two corners, end to end.
FaceGrids join_lines(std::vector<GridFacet> const& sides) {
  FaceGrids out;
  std::map<int, std::vector<int>> at_point;
  for (int f = 0; f < int(sides.size()); ++f)
    for (int s = 0; s < 2; ++s) at_point[sides[f][s]].push_back(f);
  std::vector<char> used(sides.size(), 0);
  auto const go = [&](int start) {
    FaceGrid line;
    line.point = {start};
    for (int at = start;;) {
      int side = -1;
      for (int const f : at_point[at])
        if (used[f] == 0 && side < 0) side = f;
      if (side < 0) break;
      used[side] = 1;
      at = sides[side][0] == at ? sides[side][1] : sides[side][0];
      line.point.push_back(at);
      if (at_point[at].size() != 2) break;
    }
    if (line.point.size() < 2) return;
    line.extent = {int(line.point.size()), 1};
    out.grids.push_back(std::move(line));
  };
  for (auto const& [point, at] : at_point)
    if (at.size() != 2)
      for (std::size_t n = 0; n < at.size(); ++n) go(point);
  for (auto const& [point, at] : at_point) go(point);
  return out;
}

}  // namespace

FaceGrids find_face_grids(std::vector<GridFacet> const& faces, std::vector<Vec3> const& points,
                          double crease_angle_rad) {
  std::vector<GridFacet> quads, sides;
  for (GridFacet const& f : faces) {
    if (f[3] >= 0) quads.push_back(f);
    if (f[2] < 0) sides.push_back(f);
  }
  if (!sides.empty()) {
    FaceGrids lines = join_lines(sides);
    lines.left_over = faces.size() - sides.size();
    return lines;
  }
  // What is one grid stays one, as the face of a block does.
  constexpr double no_crease = 4;
  FaceGrids out = Quads(quads, points, no_crease).run();
  if (out.grids.size() != 1 || out.left_over != 0) out = Quads(quads, points, crease_angle_rad).run();
  out.left_over += faces.size() - quads.size();
  return out;
}

}  // namespace gridmorph
