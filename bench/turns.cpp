// How shapes of elements stand what bodies do: this project, in one step and without its guard, by default and by the
// lattice (NearFieldMethod), beside thin plate splines with every boundary node as a centre (thin_plate.hpp).
//
//   bench_turns [--small] [--against FILE] [CASE ...]      all cases where none is named
//
// Bodies that move as they are:
//
//   airfoil   a C mesh of 24,576 quadrilaterals, outer boundary 29 chords away, turned about the middle of its chord
//   sphere    prisms and tetrahedra, outer sphere four diameters away, turned about an axis that no grid line follows
//   pair      two squares as far from one another as they are wide, turned against one another in a box of squares
//   gap       a square half its width beside a wall that stands
//   shift     the sphere, moved by diameters; outer sphere twenty diameters away
//   wide      the same, outer sphere sixty diameters away
//   plunge    the airfoil, moved across its chord by chords
//   heave     a square in a box thirteen times as wide, moved along its side by sides
//   pin       a square half way between the walls of a channel three times as high, towards one of them by shares
//             of the gap
//
// Bodies that designers change:
//
//   thicker, longer    the airfoil, by shares of its thickness and its chord
//   bent               its rear half, up by chords at the trailing edge
//   flap               its last three tenths, by degrees
//   bump               a wave on its upper side, by chords
//   swell              the sphere, by radii
//   stretched, sheared, twisted, curved    an ellipsoid three times as long as it is thick, in an outer one: along its
//                      axis by shares of its length, across it by shares of the way along it, about it by degrees from
//                      end to end, and its front half up by shares of its length
//
// Writes lines of comma separated values: case, amount, method, smallest scaled Jacobian, inverted elements. Scaled
// Jacobian: determinant of the edges at a corner over the product of their lengths, the smallest over all corners of
// all elements. scripts/plot-turns draws them. --small: meshes of a few thousand elements and two amounts each, which
// the tests run. --against: the lines of an earlier run; the exit status is 1 where one of this project's is worse now,
// by more than 0.005 or by an inverted element, and standard error says which.
#include "scaled_jacobian.hpp"
#include "thin_plate.hpp"

#include <generators/airfoil.hpp>
#include <generators/sphere.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/gridmorph.hpp>
#include <gridmorph/morph/apply_on_host.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace gridmorph::bench {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

constexpr double degrees = std::numbers::pi / 180;

/// What a body does by an amount: the displacement of a place.
using Moves = std::function<Vec3(Vec3 const& x, double amount)>;

struct Body {
  std::string patch;
  Moves moves;
};

struct Case {
  std::string name;
  Mesh mesh;
  std::vector<Body> bodies;
  std::vector<double> amounts;
};

Moves turning(Vec3 const& centre, Vec3 const& axis, double sense = 1) {
  return [=](Vec3 const& x, double amount) { return rotation_about(centre, axis, sense * amount * degrees)(x) - x; };
}
Moves shifting(Vec3 const& by) {
  return [=](Vec3 const&, double amount) { return amount * by; };
}

Coordinates by_this_project(Case const& c, double amount, NearFieldMethod method) {
  Motion motion;
  for (Body const& b : c.bodies) {
    MotionRule& rule = motion.rules.emplace_back();
    rule.patches = {b.patch};
    rule.rule = FunctionRule{"moves", [moves = b.moves, amount](std::span<Vec3 const> x, std::span<Vec3> u) {
                               for (std::size_t n = 0; n < x.size(); ++n) u[n] = moves(x[n], amount);
                             }};
    rule.where = c.name;
  }
  PlanOptions options;
  options.elements.method = method;
  MorphPlan const plan(c.mesh, motion, options);
  Coordinates x(c.mesh.n_nodes());
  apply_on_host(Morpher<Exec>(Exec(), plan, c.mesh.coordinates), plan.boundary_displacement(), x);
  return x;
}

/// A displacement of all nodes for each amount.
class SplineFields {
 public:
  explicit SplineFields(Case const& c) : case_(c) {
    std::vector<Vec3> centres;
    std::vector<std::vector<Vec3>> given(c.amounts.size());
    std::vector<char> seen(c.mesh.n_nodes(), 0);
    for (Patch const& patch : c.mesh.patches)
      for (Index32 const n : patch_nodes(patch)) {
        if (std::exchange(seen[n], 1) != 0) continue;
        centres.push_back(c.mesh.coordinates[n]);
        for (std::size_t a = 0; a < given.size(); ++a) {
          Vec3 u;
          for (Body const& b : c.bodies)
            if (b.patch == patch.name) u = b.moves(centres.back(), c.amounts[a]);
          given[a].push_back(u);
        }
      }
    n_centres = centres.size();
    ThinPlate const spline(std::move(centres), std::move(given), c.mesh.dimension);
    fields_.resize(c.mesh.n_nodes());
    Kokkos::parallel_for("gridmorph::bench::thin_plate", Kokkos::RangePolicy<Exec>(0, fields_.size()),
                         [&](std::size_t n) { fields_[n] = spline(c.mesh.coordinates[Index(n)]); });
    Exec().fence();
  }
  /// By amount a.
  [[nodiscard]] Coordinates at(std::size_t a) const {
    Coordinates x(case_.mesh.n_nodes());
    for (std::size_t n = 0; n < fields_.size(); ++n) x.set(Index(n), case_.mesh.coordinates[Index(n)] + fields_[n][a]);
    return x;
  }
  std::size_t n_centres = 0;

 private:
  Case const& case_;
  std::vector<std::vector<Vec3>> fields_;
};

std::vector<double> by_degrees(bool small) {
  if (small) return {40, 120};
  std::vector<double> out;
  for (int a = 10; a <= 180; a += 10) out.push_back(a);
  return out;
}

/// Squares of `width` cells, at their lower left corners, cut out of n_i by n_j unit cells.
Mesh squares(int n_i, int n_j, int width, std::vector<std::array<int, 2>> const& low) {
  auto const hole_of = [&](int i, int j) {
    for (std::size_t h = 0; h < low.size(); ++h)
      if (i >= low[h][0] && i < low[h][0] + width && j >= low[h][1] && j < low[h][1] + width) return int(h);
    return -1;
  };
  // The nodes that cells have.
  std::vector<Index32> number(std::size_t(n_i + 1) * std::size_t(n_j + 1), -1);
  auto const node = [&](int i, int j) -> Index32& { return number[i + (n_i + 1) * j]; };
  std::vector<Vec3> places;
  for (int j = 0; j <= n_j; ++j)
    for (int i = 0; i <= n_i; ++i) {
      bool used = false;
      for (int const c : {i - 1, i})
        for (int const d : {j - 1, j}) used = used || (c >= 0 && c < n_i && d >= 0 && d < n_j && hole_of(c, d) < 0);
      if (!used) continue;
      node(i, j) = Index32(places.size());
      places.push_back({double(i), double(j), 0});
    }
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "squares";
  mesh.add_zone("squares", Index(places.size()));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t n = 0; n < places.size(); ++n) mesh.coordinates.set(Index(n), places[n]);
  for (std::size_t p = 0; p <= low.size(); ++p) {
    Patch& patch = mesh.patches.emplace_back();
    patch.name = p == 0 ? "outer" : "square " + std::to_string(p);
    patch.kind = p == 0 ? PatchKind::farfield : PatchKind::wall;
    patch.bc_type = p == 0 ? "BCFarfield" : "BCWall";
    patch.zone = 0;
  }
  for (int j = 0; j < n_j; ++j)
    for (int i = 0; i < n_i; ++i) {
      if (hole_of(i, j) >= 0) continue;
      std::array const corner{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
      mesh.add_element(ElementType::quadrilateral, corner);
      constexpr int beside[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
      for (std::size_t side = 0; side < 4; ++side) {
        int const c = i + beside[side][0], d = j + beside[side][1];
        bool const outside = c < 0 || c >= n_i || d < 0 || d >= n_j;
        if (!outside && hole_of(c, d) < 0) continue;
        mesh.patches[outside ? 0 : std::size_t(hole_of(c, d) + 1)].faces.add(
            std::array{corner[side], corner[(side + 1) % 4]});
      }
    }
  return mesh;
}

Vec3 const z_axis{0, 0, 1};

Case pair_case(bool small) {
  int const w = small ? 8 : 20;
  return {
      "pair",
      squares(9 * w, 6 * w, w, {{3 * w, 5 * w / 2}, {5 * w, 5 * w / 2}}),
      {{"square 1", turning({3.5 * w, 3.0 * w, 0}, z_axis)}, {"square 2", turning({5.5 * w, 3.0 * w, 0}, z_axis, -1)}},
      by_degrees(small)};
}
Case gap_case(bool small) {
  int const w = small ? 8 : 20;
  return {"gap",
          squares(6 * w, 6 * w, w, {{5 * w / 2, w / 2}}),
          {{"square 1", turning({3.0 * w, 1.0 * w, 0}, z_axis)}},
          by_degrees(small)};
}

Case heave_case(bool small) {
  int const w = small ? 4 : 10;
  return {"heave",
          squares(13 * w, 13 * w, w, {{6 * w, 6 * w}}),
          {{"square 1", shifting({0, double(w), 0})}},
          small ? std::vector<double>{0.5, 4} : std::vector<double>{0.5, 2, 4, 5}};
}
Case pin_case(bool small) {
  int const w = small ? 8 : 20;
  return {"pin",
          squares(9 * w, 3 * w, w, {{4 * w, w}}),
          {{"square 1", shifting({0, double(w), 0})}},
          small ? std::vector<double>{0.25, 0.5} : std::vector<double>{0.25, 0.5, 0.75}};
}

/// The airfoil that does something, by the amounts of the full or the small case.
std::function<Case(bool)> airfoil_case(std::string const& name, Moves const& moves, std::vector<double> const& amounts,
                                       std::vector<double> const& few) {
  return [=](bool small) {
    AirfoilOptions options;
    if (small) options = {.around = 48, .wake = 12, .across = 16, .first_cell = 5e-3};
    return Case{name, make_airfoil(options), {{"airfoil", moves}}, small ? few : amounts};
  };
}
std::function<Case(bool)> sphere_case(std::string const& name, double distance, Moves const& moves,
                                      std::vector<double> const& amounts, std::vector<double> const& few,
                                      double slenderness = 1) {
  return [=](bool small) {
    SphereOptions options;
    options.elements = small ? 12'000 : 40'000;
    options.distance = distance;
    Case c{name, make_sphere(options), {{"sphere", moves}}, small ? few : amounts};
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      Vec3 const x = c.mesh.coordinates[n];
      c.mesh.coordinates.set(n, {slenderness * x.x, x.y, x.z});
    }
    return c;
  };
}

Vec3 const oblique = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};

Vec3 thicken(Vec3 const& x, double amount) { return {0, amount * x.y, 0}; }
Vec3 lengthen(Vec3 const& x, double amount) { return {amount * (x.x - 0.25), 0, 0}; }
Vec3 bend(Vec3 const& x, double amount) {
  double const s = std::max(0.0, x.x - 0.5) / 0.5;
  return {0, amount * s * s, 0};
}
/// The hinge is rounded over a tenth of the chord.
Vec3 deflect(Vec3 const& x, double amount) {
  return rotation_about({0.7, 0, 0}, z_axis, -smoothstep((x.x - 0.65) / 0.1) * amount * degrees)(x) - x;
}
Vec3 raise(Vec3 const& x, double amount) {
  double const s = (x.x - 0.4) / 0.2;
  return {0, x.y > 0 && std::abs(s) < 1 ? amount * (1 - s * s) * (1 - s * s) : 0, 0};
}
// The ellipsoid's half axes are 1.5, 0.5 and 0.5.
constexpr double half_length = 1.5;
Vec3 twist(Vec3 const& x, double amount) {
  return rotation_about({}, {1, 0, 0}, amount * degrees * x.x / (2 * half_length))(x) - x;
}
Vec3 curve(Vec3 const& x, double amount) {
  double const s = std::max(0.0, x.x) / half_length;
  return {0, amount * 2 * half_length * s * s, 0};
}

std::map<std::string, std::function<Case(bool)>> all_cases() {
  std::map<std::string, std::function<Case(bool)>> out{
      {"pair", pair_case}, {"gap", gap_case}, {"heave", heave_case}, {"pin", pin_case}};
  std::vector<double> const near{1, 2, 4, 6, 8, 10, 12, 14, 16};
  std::vector<double> far = near;
  far.insert(far.end(), {20, 30, 40});
  auto const foil = [&](std::string const& name, Moves const& moves, std::vector<double> const& amounts,
                        std::vector<double> const& few) { out[name] = airfoil_case(name, moves, amounts, few); };
  auto const ball = [&](std::string const& name, double distance, Moves const& moves,
                        std::vector<double> const& amounts, std::vector<double> const& few, double slenderness = 1) {
    out[name] = sphere_case(name, distance, moves, amounts, few, slenderness);
  };
  foil("airfoil", turning({0.5, 0, 0}, z_axis), by_degrees(false), by_degrees(true));
  foil("plunge", shifting({0, 1, 0}), {1, 2, 4, 8, 12, 16}, {2, 8});
  foil("thicker", thicken, {0.2, 0.5, 1}, {0.5, 1});
  foil("longer", lengthen, {0.1, 0.3}, {0.1, 0.3});
  foil("bent", bend, {0.05, 0.1, 0.2, 0.3}, {0.05, 0.1});
  foil("flap", deflect, {5, 10, 20, 30}, {5, 10});
  foil("bump", raise, {0.01, 0.03, 0.06}, {0.01, 0.03});
  ball("sphere", 4, turning({}, oblique), by_degrees(false), by_degrees(true));
  ball("shift", 20, shifting(oblique), near, {4, 8});
  ball("wide", 60, shifting(oblique), far, {4, 8});
  ball("swell", 10, [](Vec3 const& x, double amount) { return amount * x; }, {0.3, 1, 2}, {0.3, 1});
  ball(
      "stretched", 10,
      [](Vec3 const& x, double amount) {
        return Vec3{amount * x.x, 0, 0};
      },
      {0.1, 0.3, 1}, {0.1, 0.3}, 3);
  ball(
      "sheared", 10,
      [](Vec3 const& x, double amount) {
        return Vec3{0, amount * x.x, 0};
      },
      {0.2, 0.5}, {0.2, 0.5}, 3);
  ball("twisted", 10, twist, {45, 120}, {45, 120}, 3);
  ball("curved", 10, curve, {0.05, 0.1, 0.2}, {0.05, 0.1}, 3);
  return out;
}

using Row = std::tuple<std::string, double, std::string>;  ///< case, amount, method

std::string const splines = "thin plate";
std::vector<std::pair<std::string, NearFieldMethod>> const methods{{"gridmorph", NearFieldMethod::automatic},
                                                                   {"lattice", NearFieldMethod::lattice}};

/// What this project had in the lines of an earlier run.
std::map<Row, Verdict> read_earlier(char const* path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string(path) + " cannot be read");
  std::map<Row, Verdict> out;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string name, amount, method, smallest, inverted;
    for (std::string* cell : {&name, &amount, &method, &smallest, &inverted}) std::getline(cells, *cell, ',');
    if (method != splines && method != "method")
      out[{name, std::stod(amount), method}] = {std::stod(smallest), std::stoll(inverted)};
  }
  if (out.empty()) throw std::runtime_error(std::string(path) + " has no lines of this project");
  return out;
}

/// Whether it is no worse than it was.
bool holds(Row const& row, Verdict const& now, std::map<Row, Verdict> const& earlier) {
  auto const was = earlier.find(row);
  if (was == earlier.end() ||
      (now.inverted <= was->second.inverted && (now.inverted > 0 || now.smallest > was->second.smallest - 0.005)))
    return true;
  auto const& [name, amount, method] = row;
  std::fprintf(stderr, "%s by %g, %s: smallest %.4f, %lld inverted; it was %.4f, %lld\n", name.c_str(), amount,
               method.c_str(), now.smallest, static_cast<long long>(now.inverted), was->second.smallest,
               static_cast<long long>(was->second.inverted));
  return false;
}

/// Whether nothing is worse than it was.
bool run(Case const& c, std::map<Row, Verdict> const& earlier) {
  bool held = true;
  SplineFields const spline(c);
  std::fprintf(stderr, "%s: %lld elements, %zu centres, baseline %.4f\n", c.name.c_str(),
               static_cast<long long>(c.mesh.n_elements()), spline.n_centres,
               judge(c.mesh, c.mesh.coordinates).smallest);
  for (std::size_t a = 0; a < c.amounts.size(); ++a) {
    auto const report = [&](std::string const& method, Coordinates const& moved) {
      Verdict const v = judge(c.mesh, moved);
      std::printf("%s,%g,%s,%.4f,%lld\n", c.name.c_str(), c.amounts[a], method.c_str(), v.smallest,
                  static_cast<long long>(v.inverted));
      return method == splines || holds({c.name, c.amounts[a], method}, v, earlier);
    };
    for (auto const& [name, method] : methods) held = report(name, by_this_project(c, c.amounts[a], method)) && held;
    report(splines, spline.at(a));
  }
  return held;
}

}  // namespace
}  // namespace gridmorph::bench

int main(int argc, char** argv) {
  using namespace gridmorph::bench;
  Kokkos::ScopeGuard const kokkos(argc, argv);
  bool small = false;
  std::vector<std::string> wanted;
  std::map<Row, Verdict> earlier;
  for (int a = 1; a < argc; ++a) {
    if (std::string(argv[a]) == "--small")
      small = true;
    else if (std::string(argv[a]) == "--against" && a + 1 < argc)
      earlier = read_earlier(argv[++a]);
    else
      wanted.emplace_back(argv[a]);
  }
  auto const cases = all_cases();
  for (std::string const& name : wanted)
    if (!cases.contains(name)) {
      std::fprintf(stderr, "bench_turns: no case '%s'\n", name.c_str());
      return 2;
    }
  std::printf("case,amount,method,smallest,inverted\n");
  bool held = true;
  for (auto const& [name, make] : cases)
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end())
      held = run(make(small), earlier) && held;
  return held ? 0 : 1;
}
