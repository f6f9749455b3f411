#include <gridmorph/motion/target/section_profile.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/cubic_piece.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

constexpr double corner_turn = 0.766044443118978;  // cosine of 40 degrees
constexpr double near_edge = 0.1;                  // of the chord
constexpr double most_open = 0.5;  // of the chord: between the ends of coarse profiles, or across a base

/// Slope at b of the parabola through a, b, c that lie at lengths -h and k from it.
Vec3 parabola_slope(Vec3 const& a, Vec3 const& b, Vec3 const& c, double h, double k) {
  return (h / (k * (h + k))) * (c - b) + (k / (h * (h + k))) * (b - a);
}

}  // namespace

SectionProfile::SectionProfile(std::vector<Vec3> points, Vec3 const& span, Vec3 const& flow, std::string const& name,
                               Edges edges, double window)
    : window_(window) {
  double around = 0;
  for (std::size_t n = 1; n < points.size(); ++n) around += distance(points[n - 1], points[n]);
  if (!(around > 0) || !std::isfinite(around))
    throw MotionError(name + ": the section's points are one point, or not finite");
  double const same = 1e-9 * around;
  for (Vec3 const& p : points) {
    if (!points_.empty() && distance(p, points_.back()) <= same) {
      given_.push_back(size() - 1);
      continue;
    }
    given_.push_back(size());
    points_.push_back(p);
  }
  if (size() > 1 && distance(points_.front(), points_.back()) <= same) {
    for (int& n : given_) n = n == size() - 1 ? 0 : n;
    points_.pop_back();
  }
  if (size() < 5)
    throw MotionError(name + ": the section has " + std::to_string(size()) + " different points; give at least 5");
  Vec3 area;
  for (int n = 1; n + 1 < size(); ++n) area += cross(points_[n] - points_[0], points_[n + 1] - points_[0]);
  if (dot(area, span) < 0) {
    std::reverse(points_.begin(), points_.end());
    for (int& n : given_) n = size() - 1 - n;
  }
  length_ = {0};
  for (int n = 0; n < size(); ++n) length_.push_back(length_.back() + distance(points_[n], points_[wrap(n + 1)]));
  find_edges(flow, name, edges);
}

bool SectionProfile::is_corner(int n) const {
  Vec3 const in = points_[wrap(n)] - points_[wrap(n - 1)], out = points_[wrap(n + 1)] - points_[wrap(n)];
  return dot(in, out) < corner_turn * norm(in) * norm(out);
}

double SectionProfile::extreme_length(int n, std::function<double(Vec3 const&)> const& measure) const {
  if (is_corner(n)) return length_[n];
  if (window_ > 0) return fitted_extreme(n, measure);
  double const h = distance(points_[wrap(n - 1)], points_[n]), k = distance(points_[n], points_[wrap(n + 1)]);
  double const a = measure(points_[wrap(n - 1)]), b = measure(points_[n]), c = measure(points_[wrap(n + 1)]);
  double const slope = (h * (c - b) / k + k * (b - a) / h) / (h + k);
  double const bend = 2 * ((c - b) / k - (b - a) / h) / (h + k);
  if (!(bend < 0)) return length_[n];
  return length_[n] + std::clamp(-slope / bend, -0.5 * h, 0.5 * k);
}

/// The vertex of the parabola a + b s + c s^2 that fits the measure best around point n, s being the length from there.
/// Points have the weight of the line beside them.
double SectionProfile::fitted_extreme(int n, std::function<double(Vec3 const&)> const& measure) const {
  double const whole = length_.back();
  std::array<double, 5> moment{};  // of s^0 ... s^4
  std::array<double, 3> product{};
  auto const add = [&](int at, double s) {
    double const weight =
        distance(points_[wrap(at - 1)], points_[wrap(at)]) + distance(points_[wrap(at)], points_[wrap(at + 1)]);
    double const value = measure(points_[wrap(at)]) - measure(points_[n]);
    double power = weight;
    for (std::size_t k = 0; k < moment.size(); ++k, power *= s) {
      moment[k] += power;
      if (k < product.size()) product[k] += power * value;
    }
  };
  add(n, 0);
  constexpr int around = 8;
  double spacing = 0;
  for (int k = -around; k < around; ++k)
    spacing += distance(points_[wrap(n + k)], points_[wrap(n + k + 1)]) / (2 * around);
  std::array<double, 2> reach{};
  for (int const side : {0, 1}) {
    int const step = side == 0 ? -1 : 1;
    double s = 0;
    for (int k = 1; k < size() / 4 && reach[side] <= window_ * spacing; ++k) {
      s += distance(points_[wrap(n + step * k)], points_[wrap(n + step * (k - 1))]);
      reach[side] = s;
      if (is_corner(wrap(n + step * k))) break;
      add(n + step * k, step * s);
    }
  }
  auto const [m0, m1, m2, m3, m4] = moment;
  auto const [p0, p1, p2] = product;
  double const det = m0 * (m2 * m4 - m3 * m3) - m1 * (m1 * m4 - m2 * m3) + m2 * (m1 * m3 - m2 * m2);
  double const slope = m0 * (p1 * m4 - m3 * p2) - p0 * (m1 * m4 - m2 * m3) + m2 * (m1 * p2 - p1 * m2);
  double const bend = m0 * (m2 * p2 - p1 * m3) - m1 * (m1 * p2 - p1 * m2) + p0 * (m1 * m3 - m2 * m2);
  if (!(det > 0) || !(bend < 0) || !(whole > 0)) return length_[n];
  return length_[n] + std::clamp(-0.5 * slope / bend, -0.5 * reach[0], 0.5 * reach[1]);
}

void SectionProfile::find_edges(Vec3 const& flow, std::string const& name, Edges edges) {
  auto const most = [&](auto const& measure) {
    int best = 0;
    for (int n = 1; n < size(); ++n)
      if (measure(points_[n]) > measure(points_[best])) best = n;
    return best;
  };
  auto const from = [](Vec3 const& q) { return [q](Vec3 const& p) { return distance(p, q); }; };
  auto const farthest = [&](Vec3 const& q) { return most(from(q)); };
  int a = farthest(points_[0]), b = farthest(points_[a]);
  for (int turn = 0; turn < 8; ++turn) {
    int const next = farthest(points_[b]);
    if (!(distance(points_[next], points_[b]) > distance(points_[a], points_[b]))) break;
    a = b;
    b = next;
  }
  double const chord = distance(points_[a], points_[b]);
  double const gap = distance(points_.front(), points_.back());
  if (gap > most_open * chord)
    throw MotionError(name + ": the section is open, its ends are " + std::to_string(gap) + " apart at a chord of " +
                      std::to_string(chord) + "; give profiles that go around, and patches of a whole blade or wing");
  double const downstream = dot(points_[b] - points_[a], flow);
  if (!(std::fabs(downstream) > 1e-3 * chord * norm(flow)))
    throw MotionError(name +
                      ": the section's chord lies across the flow direction, so that its leading edge cannot be "
                      "told from its trailing edge; give the flow direction");
  int trailing = downstream > 0 ? b : a;
  Vec3 const opposite = points_[downstream > 0 ? a : b];
  bool const extreme = edges == Edges::extreme;
  auto const along = [&](double sign) { return [=](Vec3 const& p) { return sign * dot(p, flow); }; };
  // Corners of the trailing edge, in order around it.
  int first = 0, last = 0;
  bool corner = false;
  for (int const step : {-1, 1})
    for (int n = 0; n < size() / 3; ++n) {
      int const at = trailing + step * n;
      if (distance(points_[wrap(at)], points_[trailing]) > near_edge * chord) break;
      if (!is_corner(at)) continue;
      first = corner ? std::min(first, at) : at;
      last = corner ? std::max(last, at) : at;
      corner = true;
    }
  double begin = 0, end = 0;  // of the base
  Vec3 edge;
  if (corner) {
    begin = length_[wrap(first)];
    end = length_[wrap(last)];
    edge = 0.5 * (points_[wrap(first)] + points_[wrap(last)]);
  } else {
    if (extreme) trailing = most(along(1));
    begin = end = extreme ? extreme_length(trailing, along(1)) : extreme_length(trailing, from(opposite));
    edge = at_length(begin);
  }
  double const whole = length_.back();
  double lead = extreme ? extreme_length(most(along(-1)), along(-1)) : extreme_length(farthest(edge), from(edge));
  while (lead <= end) lead += whole;
  while (begin < end || begin <= lead) begin += whole;
  while (begin - end > whole * (1 + 1e-12)) begin -= whole;
  stretch_ = {end, lead, begin, end + whole};
}

SectionPosition SectionProfile::position_at(double s) const {
  double const whole = length_.back(), tiny = 1e-12 * whole;
  while (s < stretch_[0] - tiny) s += whole;
  while (s >= stretch_[3] - tiny) s -= whole;
  int stretch = 0;
  while (stretch < 2 && s > stretch_[stretch + 1] + tiny) ++stretch;
  double const long_ = stretch_[stretch + 1] - stretch_[stretch];
  return {stretch, long_ > 0 ? std::clamp((s - stretch_[stretch]) / long_, 0.0, 1.0) : 0.0};
}

std::vector<SectionPosition> SectionProfile::positions() const {
  std::vector<SectionPosition> out;
  for (int const n : given_) out.push_back(position_at(length_[n]));
  return out;
}

SectionPosition SectionProfile::position(int n, double t) const {
  int const a = given_[n], b = given_[(std::size_t(n) + 1) % given_.size()];
  if (a == b) return position_at(length_[a]);
  bool const forward = b == wrap(a + 1);  // the points may have been turned round
  double const way = t * distance(points_[a], points_[b]);
  return position_at(forward ? length_[a] + way : length_[a] - way);
}

Vec3 SectionProfile::at(SectionPosition const& p) const {
  return at_length(stretch_[p.stretch] + p.fraction * (stretch_[p.stretch + 1] - stretch_[p.stretch]));
}

Vec3 SectionProfile::slope(int n, int side) const {
  // A corner has a slope on each side, from the two points there.
  int const m = is_corner(n) ? n + side : n;
  Vec3 const &a = points_[wrap(m - 1)], &b = points_[wrap(m)], &c = points_[wrap(m + 1)];
  double const h = distance(a, b), k = distance(b, c);
  if (m == n) return parabola_slope(a, b, c, h, k);
  Vec3 const near = side > 0 ? (1 / h) * (b - a) : (1 / k) * (c - b);
  if (is_corner(m)) return near;
  return 2 * near - parabola_slope(a, b, c, h, k);  // the parabola's slopes at the ends of a piece average to its chord
}

Vec3 SectionProfile::at_length(double s) const {
  double const whole = length_.back(), same = 1e-9 * whole;
  s -= std::floor(s / whole) * whole;
  int const n = piece_at(
      int(length_.size()), [&](int k) { return length_[k]; }, s);
  if (s - length_[n] <= same) return points_[n];
  if (length_[n + 1] - s <= same) return points_[wrap(n + 1)];
  double const h = length_[n + 1] - length_[n], t = (s - length_[n]) / h;
  int const next = wrap(n + 1);
  return cubic_piece(points_[n], points_[next], slope(n, +1), slope(next, -1), h, t);
}

}  // namespace gridmorph
