#include <gridmorph/mesh/coordinate_resolution.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Some coordinates of a zone.
struct Sample {
  std::vector<double> values;
  double largest = 0;
  Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf};  ///< box

  void join(Sample const& other) { include(other.low, other.high, other.largest); }
  void include(Vec3 const& from, Vec3 const& to, double size) {
    low = {std::min(low.x, from.x), std::min(low.y, from.y), std::min(low.z, from.z)};
    high = {std::max(high.x, to.x), std::max(high.y, to.y), std::max(high.z, to.z)};
    largest = std::max(largest, size);
  }

  /// What rounding is relative to: neither the largest coordinate nor what is between them is known better.
  [[nodiscard]] double extent() const {
    double const size = distance(low, high);
    return std::isfinite(size) ? std::max(size, largest) : largest;
  }
};

Sample sample_of(Mesh const& mesh, Zone const& zone) {
  constexpr Index wanted = 200;
  Sample out;
  // An odd step meets nodes on different lines of a block.
  Index const step = std::max<Index>(1, zone.size() / wanted) | 1;
  // While a file is read, zones may be known before their coordinates.
  Index const end = std::min(zone.first_node + zone.size(), mesh.coordinates.size());
  for (Index n = zone.first_node; n < end; n += step) {
    Vec3 const p = mesh.coordinates[n];
    for (double const v : {p.x, p.y, p.z})
      if (v != 0 && std::isfinite(v)) out.values.push_back(v);
    out.include(p, p, std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
  }
  return out;
}

/// Bits of the significand that a number needs.
int bits(double v) {
  int exponent = 0;
  double rest = std::frexp(std::abs(v), &exponent);
  int n = 0;
  for (; rest != 0 && n < 53; ++n) rest = std::ldexp(rest, 1) - std::floor(std::ldexp(rest, 1));
  return n;
}

/// Nothing but numbers of single precision, and not because they are round ones.
bool holds_single_precision(Sample const& sample) {
  constexpr int round = 18;
  int most = 0;
  for (double const v : sample.values) {
    if (double(float(v)) != v) return false;
    most = std::max(most, bits(v));
  }
  return most > round;
}

struct Decimal {
  int digits = 0;
  int last = 0;  ///< exponent of the last one
};

/// The shortest decimal number that reads as v.
Decimal decimal(double v) {
  std::array<char, 40> text{};
  auto const end =
      std::to_chars(text.data(), text.data() + text.size(), std::abs(v), std::chars_format::scientific).ptr;
  std::string_view const all(text.data(), std::size_t(end - text.data()));
  std::size_t const e = all.find('e');
  int exponent = 0;
  std::size_t const sign = all[e + 1] == '+' ? 1 : 0;
  std::from_chars(text.data() + e + 1 + sign, end, exponent);
  int const digits = e > 1 ? int(e) - 1 : 1;
  return {digits, exponent + 1 - digits};
}

/// One unit of the last decimal of the largest coordinates where a file has few digits, and not because they are round; 0: it has many.
double last_decimal(Sample const& sample) {
  constexpr int least = 6, most = 12;
  double const decade = std::pow(10.0, std::floor(std::log10(sample.largest)));
  int finest = std::numeric_limits<int>::max();
  std::vector<int> last;
  for (double const v : sample.values) {
    Decimal const d = decimal(v);
    if (d.digits > most) return 0;
    if (std::abs(v) < decade) continue;  // smaller numbers have further decimals
    last.push_back(d.last);
    finest = std::min(finest, d.last);
  }
  if (last.empty() || std::floor(std::log10(sample.largest)) + 1 - finest < least) return 0;
  // Of rounded numbers nine of ten end with their last decimal, of round ones few.
  auto const ending = std::count_if(last.begin(), last.end(), [&](int const at) { return at <= finest + 1; });
  return 2 * ending > std::ptrdiff_t(last.size()) ? std::pow(10.0, finest) : 0;
}

double resolution(Zone const& zone, Sample const& sample, double extent) {
  if (zone.single_precision || holds_single_precision(sample))
    return extent * double(std::numeric_limits<float>::epsilon());
  return std::max(extent * std::numeric_limits<double>::epsilon(), last_decimal(sample));
}

}  // namespace

double coordinate_resolution(Mesh const& mesh, int zone) {
  Zone const& own = mesh.zones[std::size_t(zone)];
  Sample const sample = sample_of(mesh, own);
  return resolution(own, sample, sample.extent());
}

std::vector<double> coordinate_resolutions(Mesh const& mesh) {
  std::vector<Sample> samples;
  Sample all;
  for (Zone const& zone : mesh.zones) {
    samples.push_back(sample_of(mesh, zone));
    all.join(samples.back());
  }
  std::vector<double> out;
  for (std::size_t z = 0; z < samples.size(); ++z) out.push_back(resolution(mesh.zones[z], samples[z], all.extent()));
  return out;
}

double coordinate_resolution(Mesh const& mesh) {
  double most = 0;
  for (double const own : coordinate_resolutions(mesh)) most = std::max(most, own);
  return most;
}

}  // namespace gridmorph
