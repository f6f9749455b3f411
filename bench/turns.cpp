// How shapes of elements stand turns and shifts: this project, in one step and without its guard, beside thin plate
// splines with every boundary node as a centre (thin_plate.hpp).
//
//   bench_turns [--small] [CASE ...]      cases: airfoil, sphere, pair, gap, shift, wide, plunge; all of them
//                                         where none is named
//
//   airfoil   a C mesh of 24,576 quadrilaterals, outer boundary 29 chords away, turned about the middle of its chord
//   sphere    prisms and tetrahedra, outer sphere four diameters away, turned about an axis that no grid line follows
//   pair      two squares as far from one another as they are wide, turned against one another in a box of squares
//   gap       a square half its width beside a wall that stands
//   shift     the sphere, moved by diameters; outer sphere twenty diameters away
//   wide      the same, outer sphere sixty diameters away
//   plunge    the airfoil, moved across its chord by chords
//
// Writes lines of comma separated values: case, amount (degrees, diameters or chords), method, smallest scaled
// Jacobian, inverted elements. Scaled Jacobian: determinant of the edges at a corner over the product of their lengths,
// the smallest over all corners of all elements. scripts/plot-turns draws them. --small: meshes of a few thousand
// elements and two amounts each, which the tests run.
#include "scaled_jacobian.hpp"
#include "thin_plate.hpp"

#include <generators/airfoil.hpp>
#include <generators/sphere.hpp>
#include <gridmorph/gridmorph.hpp>
#include <gridmorph/morph/apply_on_host.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::bench {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

struct Body {
  std::string patch;
  Vec3 centre;
  double sense = 1;
};

/// A mesh whose bodies turn about one axis by one angle, or shift.
struct Case {
  std::string name;
  Mesh mesh;
  std::vector<Body> bodies;
  Vec3 axis{0, 0, 1};  ///< unit
  bool shifts = false;
  std::vector<double> amounts;
  double unit = std::numbers::pi / 180;
};

Coordinates by_this_project(Case const& c, double amount) {
  Motion motion;
  for (Body const& b : c.bodies) {
    MotionRule& rule = motion.rules.emplace_back();
    rule.patches = {b.patch};
    auto const turn = rotation_about(b.centre, c.axis, c.shifts ? 0 : b.sense * amount * c.unit);
    rule.rule = RigidRule{turn.rotation, c.shifts ? amount * c.unit * c.axis : turn.translation};
    rule.where = "turns";
  }
  MorphPlan const plan(c.mesh, motion);
  Coordinates x(c.mesh.n_nodes());
  apply_on_host(Morpher<Exec>(Exec(), plan, c.mesh.coordinates), plan.boundary_displacement(), x);
  return x;
}

/// Displacements that the boundary's are linear in: (R - I) r = sin a (k x r) + (1 - cos a) k x (k x r).
class SplineFields {
 public:
  explicit SplineFields(Case const& c) : case_(c) {
    std::vector<Vec3> centres, first, second;
    std::vector<char> seen(std::size_t(c.mesh.n_nodes()), 0);
    for (Patch const& patch : c.mesh.patches)
      for (Index32 const n : patch_nodes(patch)) {
        if (std::exchange(seen[std::size_t(n)], 1) != 0) continue;
        centres.push_back(c.mesh.coordinates[n]);
        Vec3 u, v;
        for (Body const& b : c.bodies)
          if (b.patch == patch.name) {
            u = c.shifts ? c.axis : b.sense * cross(c.axis, centres.back() - b.centre);
            v = c.shifts ? Vec3{} : cross(c.axis, cross(c.axis, centres.back() - b.centre));
          }
        first.push_back(u);
        second.push_back(v);
      }
    n_centres = centres.size();
    std::vector<std::vector<Vec3>> given{first};
    if (!c.shifts) given.push_back(second);
    ThinPlate const spline(std::move(centres), given, c.mesh.dimension);
    fields_.resize(std::size_t(c.mesh.n_nodes()));
    Kokkos::parallel_for("gridmorph::bench::thin_plate", Kokkos::RangePolicy<Exec>(0, fields_.size()),
                         [&](std::size_t n) { fields_[n] = spline(c.mesh.coordinates[Index(n)]); });
    Exec().fence();
  }
  [[nodiscard]] Coordinates at(double amount) const {
    Coordinates x(case_.mesh.n_nodes());
    double const a = amount * case_.unit;
    for (std::size_t n = 0; n < fields_.size(); ++n) {
      Vec3 u = (case_.shifts ? a : std::sin(a)) * fields_[n].front();
      if (!case_.shifts) u += (1 - std::cos(a)) * fields_[n].back();
      x.set(Index(n), case_.mesh.coordinates[Index(n)] + u);
    }
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
  auto const node = [&](int i, int j) -> Index32& { return number[std::size_t(i + (n_i + 1) * j)]; };
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

Case pair_case(bool small) {
  int const w = small ? 8 : 20;
  return {"pair",
          squares(9 * w, 6 * w, w, {{3 * w, 5 * w / 2}, {5 * w, 5 * w / 2}}),
          {{"square 1", {3.5 * w, 3.0 * w, 0}}, {"square 2", {5.5 * w, 3.0 * w, 0}, -1}},
          {0, 0, 1},
          false,
          by_degrees(small)};
}
Case gap_case(bool small) {
  int const w = small ? 8 : 20;
  return {"gap",
          squares(6 * w, 6 * w, w, {{5 * w / 2, w / 2}}),
          {{"square 1", {3.0 * w, 1.0 * w, 0}}},
          {0, 0, 1},
          false,
          by_degrees(small)};
}

Case airfoil_case(bool small) {
  AirfoilOptions options;
  if (small) options = {.around = 48, .wake = 12, .across = 16, .first_cell = 5e-3};
  return {"airfoil", make_airfoil(options), {{"airfoil", {0.5, 0, 0}}}, {0, 0, 1}, false, by_degrees(small)};
}

Case plunge_case(bool small) {
  Case c = airfoil_case(small);
  c.name = "plunge";
  c.axis = {0, 1, 0};
  c.shifts = true;
  c.unit = 1;
  c.amounts = {1, 2, 4, 8, 12, 16};
  if (small) c.amounts = {2, 8};
  return c;
}

Vec3 const oblique = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};

Case sphere_case(bool small) {
  SphereOptions options;
  options.elements = small ? 12'000 : 40'000;
  return {"sphere", make_sphere(options), {{"sphere", {}}}, oblique, false, by_degrees(small)};
}
Case shift_case(bool small, std::string const& name, double distance) {
  SphereOptions options;
  options.elements = small ? 12'000 : 40'000;
  options.distance = distance;
  std::vector<double> amounts{1, 2, 4, 6, 8, 10, 12, 14, 16};
  if (distance > 20) amounts.insert(amounts.end(), {20, 30, 40});
  if (small) amounts = {4, 8};
  return {name, make_sphere(options), {{"sphere", {}}}, oblique, true, amounts, 2 * options.radius};
}

void run(Case const& c) {
  SplineFields const spline(c);
  std::fprintf(stderr, "%s: %lld elements, %zu centres, baseline %.4f\n", c.name.c_str(),
               static_cast<long long>(c.mesh.n_elements()), spline.n_centres,
               judge(c.mesh, c.mesh.coordinates).smallest);
  for (double const amount : c.amounts)
    for (bool const ours : {true, false}) {
      Verdict const v = judge(c.mesh, ours ? by_this_project(c, amount) : spline.at(amount));
      std::printf("%s,%g,%s,%.4f,%lld\n", c.name.c_str(), amount, ours ? "gridmorph" : "thin plate", v.smallest,
                  static_cast<long long>(v.inverted));
    }
}

}  // namespace
}  // namespace gridmorph::bench

int main(int argc, char** argv) {
  using namespace gridmorph::bench;
  Kokkos::ScopeGuard const kokkos(argc, argv);
  bool small = false;
  std::vector<std::string> wanted;
  for (int a = 1; a < argc; ++a) {
    if (std::string(argv[a]) == "--small")
      small = true;
    else
      wanted.emplace_back(argv[a]);
  }
  std::map<std::string, std::function<Case()>> const cases{{"airfoil", [&] { return airfoil_case(small); }},
                                                           {"pair", [&] { return pair_case(small); }},
                                                           {"gap", [&] { return gap_case(small); }},
                                                           {"sphere", [&] { return sphere_case(small); }},
                                                           {"shift", [&] { return shift_case(small, "shift", 20); }},
                                                           {"wide", [&] { return shift_case(small, "wide", 60); }},
                                                           {"plunge", [&] { return plunge_case(small); }}};
  for (std::string const& name : wanted)
    if (!cases.contains(name)) {
      std::fprintf(stderr, "bench_turns: no case '%s'\n", name.c_str());
      return 2;
    }
  std::printf("case,amount,method,smallest,inverted\n");
  for (auto const& [name, make] : cases)
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) run(make());
}
