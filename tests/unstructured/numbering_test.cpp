// What does not depend on how nodes and elements are numbered: displacements of meshes that were numbered anew at
// random.
#include "io/io_support.hpp"
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;

Rule displaced(std::function<Vec3(Vec3 const&)> const& u) {
  return FunctionRule{"bends", [u](std::span<Vec3 const> x, std::span<Vec3> out) {
                        std::transform(x.begin(), x.end(), out.begin(), u);
                      }};
}

/// A mesh and a motion that bends its walls, so that all stages have something to carry.
struct Bent {
  Mesh mesh;
  Motion motion;
};

Bent rooted_body() {
  return {box_around(
              {12, 12, 10},
              [](Vec3 const& p) {
                return norm(p - Vec3{6, 6, 0}) < 3.2;
              },
              true),
          motion_of({rule_for({"body"}, displaced([](Vec3 const& x) {
                                return rotation_about({6, 6, 0}, {0, 0, 1}, 0.1 * x.z)(x) - x;
                              })),
                     rule_for({"k_min"}, FixedRule{})})};
}
Bent cascade() {
  return {read_mesh(shared_mesh("mesh_vki_turbine.su2")), motion_of({rule_for({"airfoil"}, displaced([](Vec3 const& x) {
                                                                                double const s =
                                                                                    std::max(0.0, x.x - 0.01) / 0.03;
                                                                                return Vec3{0, 0.002 * s * s, 0};
                                                                              })),
                                                                     rule_for({"periodic_*"}, FreeRule{})})};
}
Bent coil() {
  return {read_mesh(shared_mesh("heated_coil.cgns")),
          motion_of({rule_for({"Default 1 Side*"}, displaced([](Vec3 const& x) {
                                double const s = std::max(0.0, 0.65 - x.y) / 1.5;
                                return Vec3{0, 0, 0.1 * s * s * (3 - s)};
                              })),
                     rule_for({"SolidZone Default"}, FixedRule{}), rule_for({"FluidZone Default"}, FixedRule{})})};
}

/// Nodes and elements inside their zones at random.
FileOrder shuffled(Mesh const& mesh, unsigned seed) {
  Random random(seed);
  FileOrder order;
  order.node.resize(mesh.n_nodes());
  order.element.resize(mesh.n_elements());
  std::iota(order.node.begin(), order.node.end(), 0);
  std::iota(order.element.begin(), order.element.end(), 0);
  auto const shuffle_part = [&](std::vector<Index32>& list, Index first, Index n) {
    std::vector<Index32> part(list.begin() + first, list.begin() + first + n);
    random.shuffle(part);
    std::copy(part.begin(), part.end(), list.begin() + first);
  };
  for (Zone const& zone : mesh.zones) {
    shuffle_part(order.node, zone.first_node, zone.size());
    shuffle_part(order.element, zone.first_element, zone.n_elements);
  }
  return order;
}

/// Largest difference between the displacements of a mesh and of itself numbered anew, over the largest displacement.
double difference(Bent const& bent, PlanOptions const& options, unsigned seed) {
  Case const c(bent.mesh);
  auto order = shuffled(bent.mesh, seed);
  auto const place = order.node;
  Mesh again = bent.mesh;
  reorder(again, std::move(order));
  auto const a = c.morph(bent.motion, options), b = Case(again).morph(bent.motion, options);
  double largest = 0, motion = 0;
  for (std::size_t n = 0; n < place.size(); ++n)
    largest = std::max(largest, distance(b.x[Index(n)], a.x[Index(place[n])]));
  for (Vec3 const& u : a.boundary) motion = std::max(motion, norm(u));
  EXPECT_GT(motion, 0);
  return largest / motion;
}

PlanOptions by(NearFieldMethod method, LayerWeight weight = LayerWeight::inverse_distance) {
  PlanOptions options;
  options.elements.method = method;
  options.elements.weight = weight;
  return options;
}

/// Weights are kept in single precision, some of which round-off rounds the other way.
constexpr double rounded_weights = 1e-8;

class Numbering : public testing::TestWithParam<Bent (*)()> {
 protected:
  void SetUp() override {
    if (reduced())
      GTEST_SKIP() << "of morphs, which are many here; files and plans of such meshes meet sanitizers elsewhere";
    if (!everything() && GetParam() == coil) GTEST_SKIP() << "half a minute, and the others are numbered anew as well";
  }
};
std::string name_of(testing::TestParamInfo<Bent (*)()> const& info) {
  char const* const names[] = {"rooted_body", "cascade", "coil"};
  return names[info.index];
}
INSTANTIATE_TEST_SUITE_P(Meshes, Numbering, testing::Values(rooted_body, cascade, coil), name_of);

TEST_P(Numbering, DoesNotMatter) {
  Bent const bent = GetParam()();
  unsigned seed = 5;
  for (auto const method : {NearFieldMethod::lattice, NearFieldMethod::layers})
    EXPECT_LT(difference(bent, by(method), seed++), rounded_weights) << int(method);
  for (auto const weight : {LayerWeight::uniform, LayerWeight::quality, LayerWeight::curvature})
    EXPECT_LT(difference(bent, by(NearFieldMethod::layers, weight), seed++), rounded_weights) << int(weight);
}

/// The same between a mesh and itself with coordinates that are off by a share of their size.
double trembling(Bent const& bent, PlanOptions const& options, double noise, unsigned seed) {
  Case const c(bent.mesh);
  Random random(seed);
  Mesh shaken = bent.mesh;
  shaken.coordinates = Coordinates(bent.mesh.n_nodes());  // not the same memory
  for (Index n = 0; n < shaken.n_nodes(); ++n) {
    Vec3 const x = bent.mesh.coordinates[n], r = random.vector(noise);
    shaken.coordinates.set(n, {x.x * (1 + r.x), x.y * (1 + r.y), x.z * (1 + r.z)});
  }
  // The same displacements.
  auto const a = c.morph(bent.motion, options);
  Case const other(shaken);
  auto const prepared = prepare(other.mesh, other.topology, other.face_patches, bent.motion, options);
  Coordinates x(shaken.n_nodes());
  apply_on_host(MorpherAccess::of(Case::Host(), prepared.plan, shaken.coordinates), a.boundary, x);
  double largest = 0, motion = 0;
  for (Index n = 0; n < x.size(); ++n)
    largest = std::max(largest, distance(x[n] - shaken.coordinates[n], a.x[n] - c.mesh.coordinates[n]));
  for (Vec3 const& u : a.boundary) motion = std::max(motion, norm(u));
  return largest / motion;
}

TEST_P(Numbering, NorDoesRoundOffInCoordinates) {
  Bent const bent = GetParam()();
  unsigned seed = 11;
  for (auto const method : {NearFieldMethod::lattice, NearFieldMethod::layers})
    for (double const noise : {1e-14, 1e-10, 1e-6}) {
      // More than the two zones of the coil are apart.
      if (noise == 1e-6 && GetParam() == coil) continue;
      EXPECT_LT(trembling(bent, by(method), noise, seed++), std::max(rounded_weights, 1e4 * noise))
          << int(method) << ' ' << noise;
    }
}

/// The same between a mesh and itself in another unit, against round-off of coordinates of that size.
double scaling(Bent const& bent, PlanOptions const& options, double scale) {
  Case const c(bent.mesh);
  Mesh scaled = bent.mesh;
  scaled.coordinates = Coordinates(bent.mesh.n_nodes());  // not the same memory
  for (Index n = 0; n < scaled.n_nodes(); ++n) scaled.coordinates.set(n, scale * bent.mesh.coordinates[n]);
  auto const a = c.morph(bent.motion, options);
  Case const other(scaled);
  Motion in_unit = bent.motion;
  for (auto& rule : in_unit.rules)
    if (auto* function = std::get_if<FunctionRule>(&rule.rule)) {
      auto const displacement = function->function;
      function->function = [displacement, scale](std::span<Vec3 const> x, std::span<Vec3> u) {
        std::vector<Vec3> there(x.begin(), x.end());
        for (Vec3& p : there) p = (1 / scale) * p;
        displacement(there, u);
        for (Vec3& v : u) v = scale * v;
      };
    }
  auto const b = other.morph(in_unit, options);
  double largest = 0, motion = 0;
  for (Index n = 0; n < b.x.size(); ++n) largest = std::max(largest, distance((1 / scale) * b.x[n], a.x[n]));
  for (Vec3 const& u : a.boundary) motion = std::max(motion, norm(u));
  return largest / motion;
}

TEST_P(Numbering, NorDoesTheUnitOfLength) {
  Bent const bent = GetParam()();
  for (auto const method : {NearFieldMethod::lattice, NearFieldMethod::layers})
    for (double const scale : {0.1, 3.0, 1e3})
      EXPECT_LT(scaling(bent, by(method), scale), rounded_weights) << int(method) << ' ' << scale;
}

}  // namespace
}  // namespace gridmorph::test
