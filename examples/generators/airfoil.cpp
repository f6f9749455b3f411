#include <generators/airfoil.hpp>
#include <gridmorph/core/error.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

using Complex = std::complex<double>;

/// 0 and n further numbers whose steps grow by one ratio, the first step and the last number as asked.
std::vector<double> growing(double first, double last, int n) {
  double low = 0.5, high = 3;
  auto const sum = [&](double ratio) {
    double total = 0, step = first;
    for (int k = 0; k < n; ++k, step *= ratio) total += step;
    return total;
  };
  for (int step = 0; step < 200; ++step) {
    double const middle = 0.5 * (low + high);
    (sum(middle) < last ? low : high) = middle;
  }
  std::vector<double> out{0};
  double step = first;
  for (int k = 0; k < n; ++k, step *= low) out.push_back(out.back() + step);
  out.back() = last;
  return out;
}

/// Upper side of the section, unwrapped.
class UnwrappedSection {
 public:
  explicit UnwrappedSection(double thickness) : thickness_(thickness), start_(0.5 * 1.1019 * thickness * thickness) {}

  /// z - z0 = w^2 at the trailing edge: how far the section reaches along the real axis.
  [[nodiscard]] double end() const { return std::sqrt(1 - start_); }
  [[nodiscard]] Complex place(Complex const& w) const { return start_ + w * w; }
  /// The point of the upper side whose w has this real part, 0 to end().
  [[nodiscard]] Complex at(double real) const {
    double low = 0, high = 1;
    for (int step = 0; step < 200; ++step) {
      double const middle = 0.5 * (low + high);
      (unwrapped(middle).real() < real ? low : high) = middle;
    }
    return {real, real < end() ? unwrapped(0.5 * (low + high)).imag() : 0};
  }

 private:
  [[nodiscard]] Complex unwrapped(double x) const {
    double const y = 5 * thickness_ *
                     (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
    return std::sqrt(Complex(x - start_, y));
  }
  double thickness_, start_;
};

void check(AirfoilOptions const& o) {
  Problems problems;
  auto const within = [&](char const* what, double value, double low, double high) {
    if (!(value >= low && value <= high))
      problems.add("airfoil: " + std::string(what) + " is " + std::to_string(value) + "; it must lie within " +
                   std::to_string(low) + " and " + std::to_string(high));
  };
  within("thickness", o.thickness, 0.02, 0.3);
  within("around", o.around, 8, 100'000);
  within("wake", o.wake, 2, 100'000);
  within("across", o.across, 2, 100'000);
  within("first_cell", o.first_cell, 1e-8, 0.1);
  within("distance", o.distance, 2, 1000);
  if (o.around % 2 != 0)
    problems.add("airfoil: around is " + std::to_string(o.around) + "; it must be even, half of it on either side");
  problems.throw_if_any<ConfigError>();
}

}  // namespace

Mesh make_airfoil(AirfoilOptions const& options) {
  check(options);
  UnwrappedSection const section(options.thickness);
  int const half = options.around / 2, side = half + options.wake, columns = 2 * side + 1, rows = options.across + 1;
  double const height = std::sqrt(options.distance);
  // From the leading edge along the upper side and its wake.
  std::vector<Complex> wall;
  for (int i = 0; i <= half; ++i) wall.push_back(section.at(section.end() * i / half));
  wall.front().real(0);
  auto const behind = growing(section.end() / half, height, options.wake);
  for (int i = 1; i <= options.wake; ++i) wall.emplace_back(section.end() + behind[i], 0);
  auto const up = growing(options.first_cell, height, options.across);

  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "airfoil demo";
  // Row 0 names the nodes of the wake and the trailing edge once, from the lower side.
  Index32 const first_row = Index32(columns - 1 - options.wake);
  auto const node = [&](int i, int j) {
    if (j > 0) return Index32(first_row + i + columns * (j - 1));
    return Index32(i < columns - 1 - options.wake ? i : columns - 1 - i);
  };
  mesh.add_zone("airfoil", Index(first_row) + Index(columns) * options.across);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (int i = 0; i < columns; ++i) {
    int const k = std::abs(i - side);
    for (int j = 0; j < rows; ++j) {
      Complex w = wall[k];
      w += Complex(0, (height - w.imag()) * up[j] / height);
      Complex const z = section.place(w);
      // Columns go from the wake of the lower side around the nose to that of the upper one.
      mesh.coordinates.set(node(i, j), {z.real(), i < side ? -z.imag() : z.imag(), 0});
    }
  }
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i)
      mesh.add_element(ElementType::quadrilateral,
                       std::array{node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)});
  auto const patch = [&](char const* name, PatchKind kind, char const* type) -> Patch& {
    Patch& p = mesh.patches.emplace_back();
    p.name = name;
    p.kind = kind;
    p.bc_type = type;
    p.zone = 0;
    return p;
  };
  Patch& section_patch = patch("airfoil", PatchKind::wall, "BCWallViscous");
  for (int i = options.wake; i < columns - 1 - options.wake; ++i)
    section_patch.faces.add(std::array{node(i, 0), node(i + 1, 0)});
  Patch& outer = patch("farfield", PatchKind::farfield, "BCFarfield");
  for (int i = 0; i + 1 < columns; ++i) outer.faces.add(std::array{node(i, rows - 1), node(i + 1, rows - 1)});
  for (int const i : {0, columns - 1})
    for (int j = 0; j + 1 < rows; ++j) outer.faces.add(std::array{node(i, j), node(i, j + 1)});
  return mesh;
}

}  // namespace gridmorph
