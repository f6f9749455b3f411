#include <gridmorph/page/canvas.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  auto const a = float(c.opacity);
  // Both with their own opacity: "over" of Porter and Duff (1984), colours not multiplied.
  float const below = float(s.opacity) / 255, sum = a + below * (1 - a);
  if (sum <= 0) return;
  float const share = a / sum;
  auto const mix = [share](std::uint8_t from, std::uint8_t to) {
    return std::uint8_t(float(from) + share * (float(to) - float(from)) + 0.5F);
  };
  s = {s.depth, mix(s.red, c.red), mix(s.green, c.green), mix(s.blue, c.blue), std::uint8_t(255 * sum + 0.5F)};
}

/// A colour over samples that are opaque, as most are that lines are drawn on: cover() in whole numbers, shares of 256.
class Canvas::OverOpaque {
 public:
  explicit OverOpaque(Colour const& c)
      : share_(int(std::lround(256 * std::min(c.opacity, 1.0)))),
        own_{share_ * c.red + 128, share_ * c.green + 128, share_ * c.blue + 128} {}
  void operator()(Sample& s) const {
    s.red = std::uint8_t(((256 - share_) * s.red + own_[0]) >> 8);
    s.green = std::uint8_t(((256 - share_) * s.green + own_[1]) >> 8);
    s.blue = std::uint8_t(((256 - share_) * s.blue + own_[2]) >> 8);
  }

 private:
  int share_;
  std::array<int, 3> own_;
};

/// paint(sample, weights of the corners) for each sample whose middle lies in the triangle.
template <class Paint>
void Canvas::fill(std::array<Place, 3> const& corner, Paint const& paint) {
  std::array<double, 3> x{}, y{};
  for (std::size_t n = 0; n < 3; ++n) {
    x[n] = fine * corner[n].x - 0.5;
    y[n] = fine * corner[n].y - 0.5;
    if (!std::isfinite(x[n]) || !std::isfinite(y[n])) return;
  }
  int const columns = fine * width_, rows = fine * height_;
  auto const clamped = [](double v, int most) { return int(std::clamp(v, -1.0, double(most))); };
  auto const [left, right] = std::minmax({x[0], x[1], x[2]});
  auto const [top, bottom] = std::minmax({y[0], y[1], y[2]});
  int const x0 = std::max(0, clamped(std::ceil(left), columns)), x1 = std::min(columns - 1, clamped(right, columns));
  int const y0 = std::max(0, clamped(std::ceil(top), rows)), y1 = std::min(rows - 1, clamped(bottom, rows));
  if (x0 > x1 || y0 > y1) return;  // so of most triangles that are smaller than a sample
  double const area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  double const per_area = 1 / area;
  // Weight n is at + along px + across py.
  std::array<double, 3> at{}, along{}, across{};
  for (std::size_t n = 0; n < 3; ++n) {
    std::size_t const a = (n + 1) % 3, b = (n + 2) % 3;
    at[n] = (x[a] * y[b] - x[b] * y[a]) * per_area;
    along[n] = (y[a] - y[b]) * per_area;
    across[n] = (x[b] - x[a]) * per_area;
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
  double top = std::numeric_limits<double>::max(), bottom = -top, first = top, last = bottom;
  for (Place const& p : corners) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    top = std::min(top, fine * p.y - 0.5);
    bottom = std::max(bottom, fine * p.y - 0.5);
    first = std::min(first, fine * p.x - 0.5);
    last = std::max(last, fine * p.x - 0.5);
  }
  if (std::ceil(first) > last) return;  // between two columns of samples
  int const columns = fine * width_, rows = fine * height_;
  int const y0 = int(std::ceil(std::clamp(top, 0.0, double(rows)))),
            y1 = int(std::floor(std::clamp(bottom, -1.0, rows - 1.0)));
  for (int py = y0; py <= y1; ++py) {
    // Between the sides that this row of samples meets.
    double left = std::numeric_limits<double>::max(), right = -left;
    for (std::size_t n = 0; n < corners.size(); ++n) {
      Place const *a = &corners[n], *b = &corners[(n + 1) % corners.size()];
      if (a->y > b->y) std::swap(a, b);
      double const ay = fine * a->y - 0.5, by = fine * b->y - 0.5;
      if (ay > py || by < py || ay == by) continue;
      double const x = fine * a->x - 0.5 + (py - ay) / (by - ay) * fine * (b->x - a->x);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (left > right) continue;
    Sample* const samples = samples_.data() + std::size_t(py) * std::size_t(columns);
    int const x0 = int(std::ceil(std::clamp(left, 0.0, double(columns)))),
              x1 = int(std::floor(std::clamp(right, -1.0, columns - 1.0)));
    if (colour.opacity >= 1)
      for (int px = x0; px <= x1; ++px) samples[px] = {samples[px].depth, colour.red, colour.green, colour.blue, 255};
    else
      for (int px = x0; px <= x1; ++px) cover(samples[px], colour);
  }
}

namespace {

/// Where a line lies in [0, columns] x [0, rows], as shares of its length, by Liang and Barsky (1984); begin after end:
/// nowhere.
std::array<double, 2> shares_inside(double x, double y, double dx, double dy, double columns, double rows) {
  auto const inside = [&](double px, double py) { return px >= 0 && py >= 0 && px < columns && py < rows; };
  std::array<double, 2> t{0, 1};
  if (inside(x, y) && inside(x + dx, y + dy)) return t;
  for (auto const& [step, room] :
       {std::pair(-dx, x), std::pair(dx, columns - x), std::pair(-dy, y), std::pair(dy, rows - y)}) {
    if (step == 0 && room < 0) return {1, 0};
    if (step == 0) continue;
    double& end = step < 0 ? t[0] : t[1];
    end = step < 0 ? std::max(end, room / step) : std::min(end, room / step);
  }
  return t;
}

}  // namespace

void Canvas::line(Place const& a, Place const& b, Colour const& colour, double width, bool behind) {
  // One run of samples across for each step along the longer direction.
  double const columns = fine * width_, rows = fine * height_;
  double const ax = fine * a.x, ay = fine * a.y, dx = fine * b.x - ax, dy = fine * b.y - ay;
  if (!std::isfinite(ax + ay + dx + dy)) return;
  auto const [t0, t1] = shares_inside(ax, ay, dx, dy, columns, rows);
  if (t0 >= t1) return;
  bool const flat = std::fabs(dx) >= std::fabs(dy);
  double const length = flat ? std::fabs(dx) : std::fabs(dy);
  int const across = std::max(1, int(std::lround(fine * width)));
  int const steps = std::max(1, int(std::lround((t1 - t0) * length)));
  double const dt = (t1 - t0) / steps;
  OverOpaque const over_opaque(colour);
  for (int n = 0; n < steps; ++n) {
    double const t = t0 + dt * (n + 0.5);  // amid samples, so that rounding leaves none out
    auto const depth = float(a.z + t * (b.z - a.z));
    int const px = int(ax + t * dx), py = int(ay + t * dy);
    for (int w = 0; w < across; ++w) {
      int const sx = flat ? px : px + w - across / 2, sy = flat ? py + w - across / 2 : py;
      if (unsigned(sx) >= unsigned(columns) || unsigned(sy) >= unsigned(rows)) continue;
      Sample& s = samples_[std::size_t(sy) * std::size_t(columns) + std::size_t(sx)];
      if (!behind && depth < s.depth) continue;
      if (s.opacity == 255)
        over_opaque(s);
      else
        cover(s, colour);
    }
  }
}

/// The mean of two samples and of two below them.
void Canvas::set_pixel(Sample const* upper, Sample const* lower, std::uint8_t* pixel) {
  static_assert(fine == 2);
  std::array const four{upper, upper + 1, lower, lower + 1};
  // Steps of 4 and of 16: no eye sees them, and files are a third smaller.
  if ((four[0]->opacity & four[1]->opacity & four[2]->opacity & four[3]->opacity) == 255) {
    auto const byte = [&](std::uint8_t Sample::*channel) {
      unsigned const sum = four[0]->*channel + four[1]->*channel + four[2]->*channel + four[3]->*channel;
      return std::uint8_t(std::min(255U, (sum + 8) / 16 * 4));
    };
    pixel[0] = byte(&Sample::red);
    pixel[1] = byte(&Sample::green);
    pixel[2] = byte(&Sample::blue);
    pixel[3] = 255;
    return;
  }
  int const opacity = four[0]->opacity + four[1]->opacity + four[2]->opacity + four[3]->opacity;
  if (opacity == 0) return;
  auto const byte = [](int sum, int of, int step) {
    return std::uint8_t(std::min(255, (sum + of * step / 2) / (of * step) * step));
  };
  auto const mean = [&](std::uint8_t Sample::*channel) {
    int sum = 0;
    for (Sample const* s : four) sum += s->opacity * s->*channel;
    return byte(sum, opacity, 4);
  };
  pixel[0] = mean(&Sample::red);
  pixel[1] = mean(&Sample::green);
  pixel[2] = mean(&Sample::blue);
  pixel[3] = byte(opacity, fine * fine, 16);
}

io::Picture Canvas::picture() const {
  io::Picture out(width_, height_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      std::size_t const above = std::size_t(fine * y) * std::size_t(fine * width_) + std::size_t(fine * x);
      set_pixel(samples_.data() + above, samples_.data() + above + std::size_t(fine * width_), out.at(x, y));
    }
  return out;
}

}  // namespace gridmorph::page
