// Passages whose inlet, exit and mixing plane are planes, cones and curved surfaces of revolution, one row and two.
//
// The demo passage is bent along the axis by a function of the radius: circles about the axis stay such, so every
// surface of revolution stays one, and where a node is on it follows from the formula.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/periodic_match.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr double size = 0.67;  // largest radius

/// Bends the annulus: x + cone (r - 0.5) + curve (r - 0.5)^2.
struct Bend {
  char const* name;
  double cone = 0, curve = 0;

  [[nodiscard]] double shift(double r) const { return cone * (r - 0.5) + curve * (r - 0.5) * (r - 0.5); }
  [[nodiscard]] Vec3 there(Vec3 const& p) const { return {p.x + shift(std::hypot(p.y, p.z)), p.y, p.z}; }
  [[nodiscard]] Vec3 back(Vec3 const& p) const { return {p.x - shift(std::hypot(p.y, p.z)), p.y, p.z}; }
};

/// One row of the machine: its patches are called after it, and every face that is an end keeps its own name.
struct Row {
  std::string name;
  PassageOptions options;
  double begins;  ///< axial position of its inlet before the bend

  [[nodiscard]] double shift() const { return begins - options.inlet; }
  [[nodiscard]] std::vector<std::string> patches(std::string const& family) const { return {name + "_" + family}; }
};

Row stator() {
  Row row{"stator", {}, -0.16};
  row.options.nodes = 10'000;
  row.options.hub = {0.44, 0.47, 1, 0};
  row.options.casing = {0.67, 0.65, 1, 0};
  return row;
}

Row rotor() {
  Row row{"rotor", {}, 0.20};
  row.options.nodes = 14'000;
  row.options.blades = 29;
  row.options.hub = {0.47, 0.48, 1, 0};
  row.options.casing = {0.65, 0.64, 1, 0};
  return row;
}

void append(Mesh& mesh, Row const& row, Bend const& bend) {
  Mesh const passage = make_passage(row.options);
  int const first = int(mesh.zones.size());
  Coordinates const before = mesh.coordinates;
  for (Zone const& zone : passage.zones) mesh.add_zone(row.name + "_" + zone.name, zone.extent);
  for (Patch patch : passage.patches) {
    patch.zone += first;
    patch.families = row.patches(patch.families.front());
    patch.name = row.name + "_" + patch.name;
    mesh.patches.push_back(patch);
  }
  for (Interface1to1 link : passage.interfaces) {
    link.name = row.name + "_" + link.name;
    link.zone += first;
    link.donor_zone += first;
    mesh.interfaces.push_back(link);
  }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < before.size(); ++n) mesh.coordinates.set(n, before[n]);
  for (Index n = 0; n < passage.n_nodes(); ++n)
    mesh.coordinates.set(before.size() + n, bend.there(passage.coordinates[n] + Vec3{row.shift(), 0, 0}));
}

Mesh joined(std::vector<Row> const& rows, Bend const& bend) {
  Mesh mesh;
  mesh.coordinates = Coordinates(0);
  for (Row const& row : rows) append(mesh, row, bend);
  return mesh;
}

/// The sections of a blade turn and change their chord; every node keeps its span fraction.
VectorField redesign(Row const& row, Bend const& bend, PassageMotion const& change) {
  return [=](Vec3 const& p) {
    Vec3 const straight = bend.back(p), own = straight - Vec3{row.shift(), 0, 0};
    return bend.there(straight + passage_displacement(row.options, change, own)) - p;
  };
}

enum class Ends { slide, slip };

void add_rules(Motion& m, Row const& row, Bend const& bend, PassageMotion const& change, Ends ends) {
  auto const blade = row.patches("blade");
  m.rules.push_back(rule(blade, function_rule(redesign(row, bend, change))));
  for (char const* end : {"inlet", "outlet"})
    if (ends == Ends::slide)
      m.rules.push_back(rule(row.patches(end), CircumferentialSlideRule{blade}));
    else
      m.rules.push_back(rule(row.patches(end), SlipRule{SlipRule::Surface::revolution}));
  std::vector<std::string> periodics;
  for (char const* part : {"inlet_lower_to_inlet_upper", "lower_to_upper", "outlet_lower_to_outlet_upper"})
    periodics.push_back(row.name + "_" + part);
  m.rules.push_back(rule(periodics, FollowRule{blade}));
  for (char const* wall : {"hub", "case"})
    m.rules.push_back(rule(row.patches(wall), SlipRule{SlipRule::Surface::revolution}));
}

template <class Each>
void for_nodes(Mesh const& mesh, std::vector<std::string> const& family, Each const& each) {
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    Patch const& patch = mesh.patches[p];
    if (patch.families != family) continue;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
          each(int(p), mesh.zones[patch.zone].node({i, j, k}));
  }
}

double radius_of(Vec3 const& p) { return std::hypot(p.y, p.z); }

/// What has to hold for a row, whatever its ends do.
void expect_row(Outcome const& out, Row const& row, Bend const& bend, PassageMotion const& change, Ends ends) {
  VectorField const given = redesign(row, bend, change);
  for_nodes(out.mesh, row.patches("blade"), [&](int, Index n) {
    ASSERT_LE(distance(out.u(n), given(out.mesh.coordinates[n])), 1e-10 * size) << row.name;
  });
  for (std::string const end : {"inlet", "outlet"}) {
    double const x = end == "inlet" ? row.begins : row.begins + row.options.outlet - row.options.inlet;
    double off = 0, along = 0, moved = 0;
    for_nodes(out.mesh, row.patches(end), [&](int, Index n) {
      off = std::max(off, std::abs(bend.back(out.morphed.position[n]).x - x));
      along = std::max(along, std::abs(radius_of(out.morphed.position[n]) - radius_of(out.mesh.coordinates[n])));
      moved = std::max(moved, norm(out.u(n)));
    });
    EXPECT_LE(off, 1e-10 * size) << row.name << ' ' << end;
    if (ends == Ends::slide) {
      EXPECT_LE(along, 1e-12 * size) << row.name << ' ' << end;
      EXPECT_GT(moved, 1e-3) << row.name << ' ' << end;
    }
  }
  for (char const* wall : {"hub", "case"}) {
    double off = 0;
    for_nodes(out.mesh, row.patches(wall), [&](int p, Index n) {
      SlipSurface const* const surface = out.prepared.surface.slip_surface(p);
      ASSERT_TRUE(surface);
      ASSERT_EQ(surface->kind, SlipSurface::Kind::revolution);
      auto const height = [&](Vec3 const& at) { return radius_of(at) - surface->profile(at.x); };
      off = std::max(off, std::abs(height(out.morphed.position[n]) - height(out.mesh.coordinates[n])));
    });
    EXPECT_LE(off, 1e-10 * size) << row.name << ' ' << wall;
  }
}

/// Also that periodic copies match, and that no cell is inside out.
void expect_sound(Outcome const& out) {
  std::map<Index, Vec3> u;
  for (Index n = 0; n < out.mesh.n_nodes(); ++n) u[n] = out.u(n);
  PeriodicMatch const match = periodic_match(out.mesh, u);
  EXPECT_GT(match.pairs, 0);
  EXPECT_LE(match.apart, 1e-12 * size);
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(out.morphed.position);
  input.baseline = views(out.mesh.coordinates);
  EXPECT_EQ(measure_quality(Kokkos::DefaultHostExecutionSpace(), out.mesh, input).far_field.inverted, 0);
}

struct Case {
  Bend bend;
  Ends ends;
};

class CurvedEnds : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    PlanesConesAndCurves, CurvedEnds,
    ::testing::Values(Case{{"Plane", 0, 0}, Ends::slide}, Case{{"Plane", 0, 0}, Ends::slip},
                      Case{{"Cone", 0.5, 0}, Ends::slide}, Case{{"Cone", 0.5, 0}, Ends::slip},
                      Case{{"SteepCone", -1.2, 0}, Ends::slide}, Case{{"SteepCone", -1.2, 0}, Ends::slip},
                      Case{{"Curve", 0.2, 1.5}, Ends::slide}, Case{{"Curve", 0.2, 1.5}, Ends::slip}),
    [](auto const& info) {
      return std::string(info.param.bend.name) + (info.param.ends == Ends::slide ? "Slides" : "Slips");
    });

PassageMotion turned(double degrees) { return {"turned", degrees, {{0, 1}, {0.5, 1.03}, {1, 0.98}}}; }

TEST_P(CurvedEnds, OfAPassageStayOnTheirSurfaceOfRevolution) {
  auto const& [bend, ends] = GetParam();
  Row const row = stator();
  Motion m;
  add_rules(m, row, bend, turned(4), ends);
  Outcome const out = morph(joined({row}, bend), m);
  expect_row(out, row, bend, turned(4), ends);
  expect_sound(out);
}

TEST_P(CurvedEnds, BetweenTwoRowsThatBothMoveStayTheSameSurface) {
  auto const& [bend, ends] = GetParam();
  std::vector<Row> const rows{stator(), rotor()};
  std::vector<PassageMotion> const changes{turned(4), turned(-3)};
  Motion m;
  for (std::size_t r = 0; r < rows.size(); ++r) add_rules(m, rows[r], bend, changes[r], ends);
  Outcome const out = morph(joined(rows, bend), m);
  for (std::size_t r = 0; r < rows.size(); ++r) expect_row(out, rows[r], bend, changes[r], ends);
  expect_sound(out);
}

}  // namespace
}  // namespace gridmorph::test
