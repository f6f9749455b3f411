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

/// Some coordinates of a zone.
struct CoordinateSample {
  std::vector<double> values;
  double largest = 0;
  static constexpr double unlimited = std::numeric_limits<double>::infinity();
  Vec3 low{unlimited, unlimited, unlimited}, high{-unlimited, -unlimited, -unlimited};  ///< box

  void join(CoordinateSample const& other) { include(other.low, other.high, other.largest); }
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

CoordinateSample sample_of(Mesh const& mesh, Zone const& zone) {
  constexpr Index wanted = 200;
  CoordinateSample out;
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
int significant_bits(double v) {
  int exponent = 0;
  double rest = std::frexp(std::abs(v), &exponent);
  int n = 0;
  for (; rest != 0 && n < 53; ++n) rest = std::ldexp(rest, 1) - std::floor(std::ldexp(rest, 1));
  return n;
}

/// Whether all are numbers of single precision, and not because they are round ones.
bool holds_single_precision(CoordinateSample const& sample) {
  constexpr int round = 18;
  int most = 0;
  for (double const v : sample.values) {
    if (double(float(v)) != v) return false;
    most = std::max(most, significant_bits(v));
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

double decade_of(double v) { return std::floor(std::log10(v)); }

/// Decimals of some numbers of a file, as far as they are as large as the largest of them and as far as they are
/// smaller.
struct Decimals {
  std::vector<int> last;  ///< exponents of the last one, of the large numbers
  int finest = std::numeric_limits<int>::max(), finest_of_small = finest;
  bool many = false;  ///< some number has more of them than text with few digits

  explicit Decimals(CoordinateSample const& sample) {
    constexpr int most = 12;
    double const decade = std::pow(10.0, decade_of(sample.largest));
    for (double const v : sample.values) {
      Decimal const d = decimal(v);
      if (many = d.digits > most; many) return;
      bool const large = std::abs(v) >= decade;
      if (large) last.push_back(d.last);
      int& least = large ? finest : finest_of_small;
      least = std::min(least, d.last);
    }
  }
  /// Whether numbers were rounded when they were written: of rounded numbers nine of ten end with their last decimal,
  /// of round ones few.
  [[nodiscard]] bool are_rounded() const {
    auto const ending = std::count_if(last.begin(), last.end(), [&](int const at) { return at <= finest + 1; });
    return 2 * ending > std::ptrdiff_t(last.size());
  }
  /// Whether numbers have as many digits each; otherwise as many decimals.
  [[nodiscard]] bool are_digits() const { return finest_of_small != finest; }
};

/// The largest coordinate of all nodes of a zone, not of some.
double largest_coordinate(Mesh const& mesh, Zone const& zone) {
  double largest = 0;
  Index const end = std::min(zone.first_node + zone.size(), mesh.coordinates.size());
  for (Index n = zone.first_node; n < end; ++n) {
    Vec3 const p = mesh.coordinates[n];
    double const most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (std::isfinite(most)) largest = std::max(largest, most);
  }
  return largest;
}

/// One unit of the last decimal of the largest coordinates where a file has few digits, and not because they are round;
/// 0: it has many.
double last_decimal(Mesh const& mesh, Zone const& zone, CoordinateSample const& sample) {
  constexpr int least = 6;
  Decimals const d(sample);
  if (d.many || d.last.empty() || decade_of(sample.largest) + 1 - d.finest < least || !d.are_rounded()) return 0;
  // With so many digits for each number, those larger than any of the sample have a decimal less.
  double const beyond = d.are_digits() ? decade_of(largest_coordinate(mesh, zone)) - decade_of(sample.largest) : 0;
  return std::pow(10.0, d.finest + beyond);
}

CoordinatePrecision precision_of(Mesh const& mesh, Zone const& zone, CoordinateSample const& sample) {
  if (zone.single_precision || holds_single_precision(sample))
    return {double(std::numeric_limits<float>::epsilon()), 0, sample.extent()};
  return {std::numeric_limits<double>::epsilon(), last_decimal(mesh, zone, sample), sample.extent()};
}

}  // namespace

double coordinate_resolution(Mesh const& mesh, int zone) {
  Zone const& own = mesh.zones[zone];
  return precision_of(mesh, own, sample_of(mesh, own)).resolution();
}

std::vector<CoordinatePrecision> coordinate_precisions(Mesh const& mesh) {
  std::vector<CoordinatePrecision> out;
  CoordinateSample all;
  for (Zone const& zone : mesh.zones) {
    CoordinateSample const sample = sample_of(mesh, zone);
    out.push_back(precision_of(mesh, zone, sample));
    all.join(sample);
  }
  for (CoordinatePrecision& own : out) own.extent = all.extent();
  return out;
}

CoordinatePrecision coordinate_precision(Mesh const& mesh) {
  CoordinatePrecision out;
  for (auto const& own : coordinate_precisions(mesh))
    out = {std::max(out.relative, own.relative), std::max(out.last_decimal, own.last_decimal), own.extent};
  return out;
}

}  // namespace gridmorph
