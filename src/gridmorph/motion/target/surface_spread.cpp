#include <gridmorph/motion/target/surface_spread.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

std::vector<int> line(PatchGrid const& grid, int direction, int at, int from, int to) {
  std::vector<int> out;
  for (int n = from; n <= to; ++n) out.push_back(direction == 0 ? grid.at(n, at) : grid.at(at, n));
  return out;
}

}  // namespace

SurfaceSpread::SurfaceSpread(PatchSurface const& surface, std::vector<char> const& known, std::vector<Vec3> image,
                             Edges const& edges)
    : surface_(surface), points_(surface.points), known_(known), edges_(edges), set_(known), image_(std::move(image)) {
  std::vector<Vec3> from, moved;
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (known[v] != 0) {
      from.push_back(points_[v]);
      moved.push_back(image_[v] - points_[v]);
    }
  carried_ = fit_affine(from, moved, points_);
}

void SurfaceSpread::set(int v, Vec3 const& residual) {
  set_[v] = 1;
  image_[v] = (*place_)(v, points_[v] + carried_(points_[v]) + residual);
}

std::vector<Vec3> SurfaceSpread::run(Place const& place) {
  place_ = &place;
  if (!surface_.gridded) {
    set_by_layers();
    return image_;
  }
  struct Box {
    PatchGrid const* grid;
    int a0, a1, b0, b1;
  };
  std::vector<Box> boxes;
  for (PatchGrid const& grid : surface_.grids) {
    std::vector<int> const as = cuts(grid, 0), bs = cuts(grid, 1);
    for (std::size_t b = 0; b + 1 < bs.size(); ++b)
      for (std::size_t a = 0; a + 1 < as.size(); ++a) boxes.push_back({&grid, as[a], as[a + 1], bs[b], bs[b + 1]});
  }
  std::vector<int> corners;
  std::vector<std::vector<int>> sides;
  for (Box const& box : boxes) {
    for (int const a : {box.a0, box.a1})
      for (int const b : {box.b0, box.b1}) corners.push_back(box.grid->at(a, b));
    for (int const b : {box.b0, box.b1}) sides.push_back(line(*box.grid, 0, b, box.a0, box.a1));
    for (int const a : {box.a0, box.a1}) sides.push_back(line(*box.grid, 1, a, box.b0, box.b1));
  }
  set_corners(std::move(corners));
  // Short sides first: a long one that others end on finds their ends in place.
  std::stable_sort(sides.begin(), sides.end(), [](auto const& s, auto const& t) { return s.size() < t.size(); });
  for (auto const& side : sides) set_side(side);
  for (Box const& box : boxes) set_inside(*box.grid, box.a0, box.a1, box.b0, box.b1);
  return image_;
}

void SurfaceSpread::set_by_layers() {
  auto const neighbours = surface_.neighbours();
  std::vector<int> layer;
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (set_[v] != 0) layer.push_back(int(v));
  while (!layer.empty()) {
    std::vector<int> next;
    for (int const v : layer)
      for (int const n : neighbours[v])
        if (set_[n] == 0) next.push_back(n);
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::vector<Vec3> residuals;
    for (int const v : next) {
      Vec3 sum;
      double weights = 0;
      for (int const n : neighbours[v])
        if (set_[n] != 0) {
          double const w = 1 / std::max(distance(points_[v], points_[n]), 1e-30);
          sum += w * residual(n);
          weights += w;
        }
      residuals.push_back((1 / weights) * sum);
    }
    for (std::size_t n = 0; n < next.size(); ++n) set(next[n], residuals[n]);
    layer = std::move(next);
  }
  // What hangs together with nothing known goes along.
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (set_[v] == 0) set(int(v), {});
}

/// Where a patch is cut along a direction: its ends, and grid lines that an edge runs along.
std::vector<int> SurfaceSpread::cuts(PatchGrid const& grid, int direction) const {
  int const n = grid.extent[direction], across = grid.extent[1 - direction];
  std::vector<int> out;
  for (int c = 0; c < n; ++c) {
    bool cut = c == 0 || c == n - 1;
    auto const l = line(grid, 1 - direction, c, 0, across - 1);
    for (std::size_t m = 1; m < l.size() && !cut; ++m) cut = edges_.contains(std::minmax(l[m - 1], l[m]));
    if (cut) out.push_back(c);
  }
  return out;
}

void SurfaceSpread::set_corners(std::vector<int> corners) {
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<int> known;
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (known_[v] != 0) known.push_back(int(v));
  for (int const v : corners) {
    if (set_[v] != 0) continue;
    Vec3 sum;
    double weights = 0;
    for (int const k : known) {
      Vec3 const d = points_[k] - points_[v];
      double const w = 1 / (dot(d, d) * dot(d, d));
      sum += w * residual(k);
      weights += w;
    }
    set(v, weights > 0 ? (1 / weights) * sum : Vec3{});
  }
}

void SurfaceSpread::set_side(std::vector<int> const& side) {
  std::vector<double> length{0};
  for (std::size_t n = 1; n < side.size(); ++n)
    length.push_back(length.back() + distance(points_[side[n - 1]], points_[side[n]]));
  for (std::size_t begin = 0; begin + 1 < side.size();) {
    std::size_t end = begin + 1;
    while (set_[side[end]] == 0) ++end;  // the last one is a corner
    Vec3 const first = residual(side[begin]), last = residual(side[end]);
    double const whole = length[end] - length[begin];
    for (std::size_t n = begin + 1; n < end; ++n) {
      double const t = whole > 0 ? (length[n] - length[begin]) / whole : 0;
      set(side[n], (1 - t) * first + t * last);
    }
    begin = end;
  }
}

void SurfaceSpread::set_inside(PatchGrid const& grid, int a0, int a1, int b0, int b1) {
  auto const r = [&](int a, int b) { return residual(grid.at(a, b)); };
  std::size_t const na = std::size_t(a1 - a0) + 1, nb = std::size_t(b1 - b0) + 1;
  std::vector<double> s(na * nb, 0), t(na * nb, 0);  // shares of the length of each grid line
  auto const share = [&](std::vector<double>& out, std::size_t first, std::size_t step, std::vector<int> const& l) {
    for (std::size_t n = 1; n < l.size(); ++n)
      out[first + n * step] = out[first + (n - 1) * step] + distance(points_[l[n - 1]], points_[l[n]]);
    double const whole = out[first + (l.size() - 1) * step];
    for (std::size_t n = 0; n < l.size() && whole > 0; ++n) out[first + n * step] /= whole;
  };
  for (std::size_t b = 0; b < nb; ++b) share(s, b * na, 1, line(grid, 0, b0 + int(b), a0, a1));
  for (std::size_t a = 0; a < na; ++a) share(t, a, na, line(grid, 1, a0 + int(a), b0, b1));
  Vec3 const r00 = r(a0, b0), r10 = r(a1, b0), r01 = r(a0, b1), r11 = r(a1, b1);
  for (int b = b0 + 1; b < b1; ++b)
    for (int a = a0 + 1; a < a1; ++a) {
      int const v = grid.at(a, b);
      if (set_[v] != 0) continue;
      std::size_t const n = std::size_t(a - a0) + na * std::size_t(b - b0);
      double const p = s[n], q = t[n];
      set(v, (1 - p) * r(a0, b) + p * r(a1, b) + (1 - q) * r(a, b0) + q * r(a, b1) - ((1 - p) * (1 - q)) * r00 -
                 (p * (1 - q)) * r10 - ((1 - p) * q) * r01 - (p * q) * r11);
    }
}

}  // namespace gridmorph
