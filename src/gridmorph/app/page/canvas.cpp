#include <gridmorph/app/page/canvas.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::page {

ColourScale::ColourScale(std::span<Colour const> stops) : table_{} {
  for (std::size_t n = 0; n < table_.size(); ++n) {
    double const at = double(n) / 255 * double(stops.size() - 1);
    auto const a = std::min(std::size_t(at), stops.size() - 2);
    double const t = at - double(a);
    auto const mix = [t](std::uint8_t from, std::uint8_t to) {
      return std::uint8_t(std::lround((1 - t) * from + t * to));
    };
    Colour const &p = stops[a], &q = stops[a + 1];
    table_[n] = {mix(p.red, q.red), mix(p.green, q.green), mix(p.blue, q.blue), 1};
  }
}

ColourScale const& displacement_colours() {
  static std::array<Colour, 6> const stops{{{0xb4, 0xbe, 0xca},
                                            {0x5f, 0x9f, 0xd0},
                                            {0x3f, 0xb0, 0x95},
                                            {0xf0, 0xc8, 0x4b},
                                            {0xe8, 0x7d, 0x3c},
                                            {0xc4, 0x2f, 0x32}}};
  static ColourScale const scale(stops);
  return scale;
}

ColourScale const& quality_colours() {
  static std::array<Colour, 6> const stops{{{0xa5, 0x12, 0x26},
                                            {0xe0, 0x5a, 0x38},
                                            {0xf3, 0xb2, 0x55},
                                            {0xf4, 0xe3, 0xa8},
                                            {0xdc, 0xe6, 0xe0},
                                            {0xd3, 0xdd, 0xe8}}};
  static ColourScale const scale(stops);
  return scale;
}

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      samples_(std::size_t(width) * std::size_t(height) * fine * fine,
               Sample{-std::numeric_limits<float>::infinity()}) {}

void Canvas::cover(Sample& s, Colour const& c) {
  if (c.opacity >= 1) {
    s = {s.depth, c.red, c.green, c.blue, 255};
    return;
  }
  // Both with their own opacity: "over" of Porter and Duff (1984), colours not multiplied.
  auto const a = float(c.opacity), below = float(s.opacity) / 255;
  float const sum = a + below * (1 - a);
  if (sum <= 0) return;
  float const share = a / sum;
  auto const mix = [share](std::uint8_t from, std::uint8_t to) {
    return std::uint8_t(float(from) + share * (float(to) - float(from)) + 0.5F);
  };
  s = {s.depth, mix(s.red, c.red), mix(s.green, c.green), mix(s.blue, c.blue), std::uint8_t(255 * sum + 0.5F)};
}

/// paint(sample, weights of the corners) for each sample whose middle lies in the triangle.
template <class Paint>
void Canvas::fill(std::array<Place, 3> const& corner, Paint const& paint) {
  std::array<double, 3> x{}, y{};
  for (std::size_t n = 0; n < 3; ++n) {
    x[n] = fine * corner[n].x - 0.5;
    y[n] = fine * corner[n].y - 0.5;
    if (!std::isfinite(x[n]) || !std::isfinite(y[n])) return;
  }
  double const area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  int const columns = fine * width_, rows = fine * height_;
  auto const clamped = [](double v, int most) { return int(std::clamp(v, -1.0, double(most))); };
  auto const [left, right] = std::minmax({x[0], x[1], x[2]});
  auto const [top, bottom] = std::minmax({y[0], y[1], y[2]});
  int const x0 = std::max(0, clamped(std::ceil(left), columns)), x1 = std::min(columns - 1, clamped(right, columns));
  int const y0 = std::max(0, clamped(std::ceil(top), rows)), y1 = std::min(rows - 1, clamped(bottom, rows));
  // Weight n is at + along px + across py.
  std::array<double, 3> at{}, along{}, across{};
  for (std::size_t n = 0; n < 3; ++n) {
    std::size_t const a = (n + 1) % 3, b = (n + 2) % 3;
    at[n] = (x[a] * y[b] - x[b] * y[a]) / area;
    along[n] = (y[a] - y[b]) / area;
    across[n] = (x[b] - x[a]) / area;
  }
  for (int py = y0; py <= y1; ++py) {
    // Where in this row all weights are positive, then exactly at its ends.
    double begin = x0, end = x1;
    std::array<double, 3> row{};
    for (std::size_t n = 0; n < 3; ++n) {
      row[n] = at[n] + across[n] * py;
      if (along[n] > 0) begin = std::max(begin, -row[n] / along[n] - 1);
      if (along[n] < 0) end = std::min(end, -row[n] / along[n] + 1);
    }
    Sample* const samples = samples_.data() + std::size_t(py) * std::size_t(columns);
    for (int px = int(std::max(begin, 0.0)); px <= int(end); ++px) {
      std::array<double, 3> const w{row[0] + along[0] * px, row[1] + along[1] * px, row[2] + along[2] * px};
      if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
      paint(samples[px], w);
    }
  }
}

void Canvas::triangle(std::array<Place, 3> const& corner, std::array<double, 3> const& share, ColourScale const& scale,
                      double light) {
  fill(corner, [&](Sample& s, std::array<double, 3> const& w) {
    auto const depth = float(w[0] * corner[0].z + w[1] * corner[1].z + w[2] * corner[2].z);
    if (!(depth > s.depth)) return;
    Colour const c = scale.at(w[0] * share[0] + w[1] * share[1] + w[2] * share[2]);
    auto const lit = [light](std::uint8_t v) { return std::uint8_t(std::min(255.0, light * v)); };
    s = {depth, lit(c.red), lit(c.green), lit(c.blue), 255};
  });
}

void Canvas::polygon(std::span<Place const> corners, Colour const& colour) {
  for (std::size_t n = 2; n < corners.size(); ++n)
    fill({corners[0], corners[n - 1], corners[n]}, [&](Sample& s, std::array<double, 3> const&) { cover(s, colour); });
}

void Canvas::line(Place const& a, Place const& b, Colour const& colour, double width, bool behind) {
  // Clipped by Liang and Barsky (1984), then one run of samples across for each step along the longer direction.
  double const columns = fine * width_, rows = fine * height_;
  double const ax = fine * a.x, ay = fine * a.y, dx = fine * b.x - ax, dy = fine * b.y - ay;
  if (!std::isfinite(ax + ay + dx + dy)) return;
  double t0 = 0, t1 = 1;
  for (auto const& [step, room] :
       {std::pair(-dx, ax), std::pair(dx, columns - ax), std::pair(-dy, ay), std::pair(dy, rows - ay)}) {
    if (step == 0) {
      if (room < 0) return;
      continue;
    }
    double const t = room / step;
    if (step < 0)
      t0 = std::max(t0, t);
    else
      t1 = std::min(t1, t);
  }
  if (t0 >= t1) return;
  bool const flat = std::fabs(dx) >= std::fabs(dy);
  double const length = flat ? std::fabs(dx) : std::fabs(dy);
  int const across = std::max(1, int(std::lround(fine * width)));
  int const steps = std::max(1, int(std::lround((t1 - t0) * length)));
  for (int n = 0; n < steps; ++n) {
    double const t = t0 + (t1 - t0) * (n + 0.5) / steps;  // amid samples, so that rounding leaves none out
    auto const depth = float(a.z + t * (b.z - a.z));
    int const px = int(ax + t * dx), py = int(ay + t * dy);
    for (int w = 0; w < across; ++w) {
      int const sx = flat ? px : px + w - across / 2, sy = flat ? py + w - across / 2 : py;
      if (sx < 0 || sy < 0 || sx >= int(columns) || sy >= int(rows)) continue;
      Sample& s = samples_[std::size_t(sy) * std::size_t(columns) + std::size_t(sx)];
      if (behind || depth >= s.depth) cover(s, colour);
    }
  }
}

io::Picture Canvas::picture() const {
  io::Picture out(width_, height_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      int red = 0, green = 0, blue = 0, opacity = 0;
      for (int v = 0; v < fine; ++v)
        for (int u = 0; u < fine; ++u) {
          Sample const& s =
              samples_[std::size_t(fine * y + v) * std::size_t(fine * width_) + std::size_t(fine * x + u)];
          red += s.opacity * s.red;
          green += s.opacity * s.green;
          blue += s.opacity * s.blue;
          opacity += s.opacity;
        }
      if (opacity == 0) continue;
      // Steps of 4 and of 16: no eye sees them, and files are a third smaller.
      auto const byte = [](int sum, int of, int step) {
        return std::uint8_t(std::min(255, (sum + of * step / 2) / (of * step) * step));
      };
      std::uint8_t* const p = out.at(x, y);
      p[0] = byte(red, opacity, 4);
      p[1] = byte(green, opacity, 4);
      p[2] = byte(blue, opacity, 4);
      p[3] = byte(opacity, fine * fine, 16);
    }
  return out;
}

}  // namespace gridmorph::page
