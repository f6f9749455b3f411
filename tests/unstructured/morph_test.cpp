// Whole morphs of unstructured meshes: what must hold whatever the mesh, on made meshes of all element types.
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/morph_run.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <tuple>

namespace gridmorph {
namespace {

using test::rotation;
using test::translation;
using Case = test::UnstructuredCase;
using Morphed = test::UnstructuredMorphed;

/// n unit cells along each side of the domain, patches "i_min" ... "k_max"; the wall "body" takes the middle third.
Mesh box_with_body(int n) {
  double const low = n / 3, high = n - n / 3;
  return test::box_around({n, n, n}, [=](Vec3 const& p) {
    return p.x > low && p.x < high && p.y > low && p.y < high && p.z > low && p.z < high;
  });
}

Motion body_moves(Rule rule, std::vector<MotionRule> more = {}) {
  Motion motion;
  motion.rules.push_back({{"body"}, std::move(rule), 0, "test"});
  for (auto& rule_of : more) motion.rules.push_back(std::move(rule_of));
  return motion;
}

TEST(UnstructuredMorph, WithoutMotionNothingChangesBitForBit) {
  Case const c(box_with_body(12));
  Morphed const m = c.morph(body_moves(translation({0, 0, 0})));
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const a = c.mesh.coordinates[n], b = m.x[n];
    ASSERT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z) << n;
  }
}

TEST(UnstructuredMorph, ZerosKeepTheirSigns) {
  Mesh mesh = box_with_body(9);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.coordinates.z(n) == 0) mesh.coordinates.z(n) = -0.0;
  Case const c(std::move(mesh));
  Morphed const m = c.morph(body_moves(translation({0.2, 0, 0})));
  Index zeros = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n)
    if (c.mesh.coordinates.z(n) == 0 && m.x.z(n) == 0) {
      ++zeros;
      EXPECT_TRUE(std::signbit(m.x.z(n))) << n;
    }
  EXPECT_GT(zeros, 0);
}

TEST(UnstructuredMorph, PlanesUnderOneNameAreAsMany) {
  auto const bent = [](std::vector<std::string> sides) {
    FunctionRule rule{"bent", [](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n) u[n] = {0, 0, 0.1 * x[n].x * x[n].y};
                      }};
    return test::motion_of({test::rule_for({"k_min"}, std::move(rule)), test::rule_for({"k_max"}, FixedRule{}),
                            test::rule_for(std::move(sides), SlipRule{SlipRule::Surface::plane})});
  };
  for (bool const second_order : {false, true}) {
    Mesh const apart = second_order ? test::second_order(test::to_hexahedra(test::unit_box({4, 3, 5})))
                                    : test::to_hexahedra(test::unit_box({4, 3, 5}));
    // Opposite sides, and sides that meet in an edge.
    for (auto const& names : {std::pair<std::string, std::string>("j_min", "j_max"), {"i_max", "j_min"}}) {
      if (second_order && names.second == "j_max") continue;
      Mesh together = apart;
      Patch both;
      both.name = "side";
      both.zone = 0;
      std::erase_if(together.patches, [&](Patch const& patch) {
        if (patch.name != names.first && patch.name != names.second) return false;
        both.kind = patch.kind;
        for (Index f = 0; f < patch.faces.size(); ++f) both.faces.add(patch.faces[f]);
        return true;
      });
      together.patches.push_back(both);
      std::vector<std::string> sides;
      for (Patch const& patch : together.patches)
        if (!patch.name.starts_with("k_")) sides.push_back(patch.name);
      Case const a(apart), b(std::move(together));
      Morphed const x = a.morph(bent({"i_*", "j_*"})), y = b.morph(bent(sides));
      for (Index n = 0; n < apart.n_nodes(); ++n) ASSERT_LT(distance(x.x[n], y.x[n]), 1e-12) << n;
    }
  }
  // What bends is no plane, and no two.
  Mesh curved = test::to_hexahedra(test::unit_box({4, 3, 5}));
  for (Index n = 0; n < curved.n_nodes(); ++n)
    curved.coordinates.y(n) += 0.05 * curved.coordinates.x(n) * curved.coordinates.x(n);
  EXPECT_NE(test::message_of<MotionError>([&] {
              (void)Case(curved).morph(bent({"i_*", "j_*"}));
            }).find("off the nearest plane"),
            std::string::npos);
}

/// Sides inside the mesh all of whose nodes are accepted, each once.
template <class Accept>
std::vector<std::vector<Index32>> inner_faces(Mesh const& mesh, Accept const& accept) {
  std::map<std::vector<Index32>, std::vector<Index32>> found;
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const nodes = side_nodes(mesh, e, s, room);
      if (!std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) { return accept(mesh.coordinates[n]); })) continue;
      std::vector<Index32> key(nodes.begin(), nodes.end());
      std::sort(key.begin(), key.end());
      found.try_emplace(std::move(key), nodes.begin(), nodes.end());
    }
  std::vector<std::vector<Index32>> out;
  for (auto const& [key, nodes] : found) out.push_back(nodes);
  return out;
}

/// `mesh` with a wall of these faces inside of it: one patch, or one for each side; every other face listed the other
/// way round if `mixed`.
Mesh with_plate(Mesh mesh, std::vector<std::vector<Index32>> const& faces, bool two_patches, bool mixed) {
  for (int side = 0; side < (two_patches ? 2 : 1); ++side) {
    Patch plate;
    plate.name = two_patches ? side == 0 ? "plate_master" : "plate_slave" : "plate";
    plate.zone = 0;
    plate.kind = PatchKind::wall;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      auto nodes = faces[f];
      if ((side == 1) != (mixed && f % 2 == 1)) std::reverse(nodes.begin(), nodes.end());
      plate.faces.add(nodes);
    }
    mesh.patches.push_back(std::move(plate));
  }
  return mesh;
}

TEST(UnstructuredMorph, BafflesMoveAsTheyAreToldOnBothSides) {
  for (bool const plane : {true, false}) {
    SCOPED_TRACE(plane ? "2-D" : "3-D");
    Mesh const box = plane ? test::flat_box(8, 8, 8) : test::to_hexahedra(test::unit_box({8, 6, 6}));
    auto const faces =
        inner_faces(box, [&](Vec3 const& p) { return p.x == 4 && p.y <= 4 && (plane || (p.z >= 1 && p.z <= 4)); });
    ASSERT_GT(faces.size(), 3U);
    auto const bends = [](double amount) {
      FunctionRule bent{"bent", [amount](std::span<Vec3 const> x, std::span<Vec3> u) {
                          for (std::size_t n = 0; n < x.size(); ++n) u[n] = {amount * x[n].y * x[n].y, 0, 0};
                        }};
      return test::motion_of({test::rule_for({"plate*"}, std::move(bent)), test::rule_for({"?_m*"}, FixedRule{})});
    };
    std::vector<Coordinates> results;
    for (auto const& [two_patches, mixed] : {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
      if (test::reduced() && two_patches == mixed) continue;
      Case const c(with_plate(box, faces, two_patches, mixed));
      EXPECT_TRUE(c.face_patches.problems.empty());
      auto const& behind = c.topology.boundary.behind;
      ASSERT_EQ(Index(behind.size()), c.topology.boundary.size());
      EXPECT_EQ(std::size_t(std::count_if(behind.begin(), behind.end(), [](Index32 f) { return f >= 0; })),
                2 * faces.size());
      for (std::size_t f = 0; f < behind.size(); ++f)
        if (behind[f] >= 0) {
          EXPECT_EQ(behind[behind[f]], Index32(f));
        }
      for (std::size_t p = 4 + (plane ? 0 : 2); p < c.mesh.patches.size(); ++p)
        EXPECT_EQ(c.face_patches.faces_of_patch[p], Index(faces.size()) * (two_patches ? 1 : 2));
      Morphed const m = c.morph(bends(0.05));
      EXPECT_EQ(c.largest_miss(m), 0);
      EXPECT_EQ(c.inverted(m.x), 0);
      results.push_back(m.x);
    }
    // Which side a patch lists, and which way round, says nothing about where nodes go.
    for (auto const& other : results)
      for (Index n = 0; n < box.n_nodes(); ++n) ASSERT_LT(distance(other[n], results.front()[n]), 1e-6) << n;
    // Bent the other way, each side does what the other one did, as far as lattices are mirror images of themselves.
    Coordinates const back = Case(with_plate(box, faces, false, false)).morph(bends(-0.05)).x;
    std::map<std::array<double, 3>, Index> at;
    for (Index n = 0; n < box.n_nodes(); ++n)
      at[{box.coordinates.x(n), box.coordinates.y(n), box.coordinates.z(n)}] = n;
    for (Index n = 0; n < box.n_nodes(); ++n) {
      Vec3 const x = box.coordinates[n], there = back[at.at({8 - x.x, x.y, x.z})];
      ASSERT_LT(distance(results[0][n], {8 - there.x, there.y, there.z}), 0.08) << n;
    }
    // A plate that goes along with everything.
    Case const c(with_plate(box, faces, true, false));
    Vec3 const t{0.3, -0.2, 0};
    Morphed const m = c.morph(test::motion_of({test::rule_for({"*"}, translation(t))}));
    for (Index n = 0; n < c.mesh.n_nodes(); ++n)
      ASSERT_NEAR(distance(m.x[n], c.mesh.coordinates[n] + t), 0, 1e-13 * c.mesh.size()) << n;
  }
}

TEST(UnstructuredMorph, PlaneMeshesMoveAlikeAcrossAnyAxis) {
  // Where x, y and z of the plane across z go.
  using Map = std::function<Vec3(Vec3 const&)>;
  struct Turned {
    Map to, from;
  };
  std::array<Turned, 3> const ways{{{[](Vec3 const& v) { return v; }, [](Vec3 const& v) { return v; }},
                                    {[](Vec3 const& v) {
                                       return Vec3{v.y, v.z, v.x};
                                     },
                                     [](Vec3 const& v) {
                                       return Vec3{v.z, v.x, v.y};
                                     }},
                                    {[](Vec3 const& v) {
                                       return Vec3{v.z, v.x, v.y};
                                     },
                                     [](Vec3 const& v) {
                                       return Vec3{v.y, v.z, v.x};
                                     }}}};
  std::vector<Vec3> reference;
  for (auto const& [way, periodic] : {std::pair(ways[0], false),
                                      {ways[1], false},
                                      {ways[2], false},
                                      {ways[0], true},
                                      {ways[1], true},
                                      {ways[2], true}}) {
    if (periodic && test::reduced()) continue;
    bool const is_first = way.to({1, 0, 0}).x == 1;
    if (is_first) reference.clear();
    Mesh const flat = periodic ? test::periodic_flat_box(6, 5, 2) : test::flat_box(6, 5, 2);
    Mesh mesh = flat;
    for (Connection& connection : mesh.connections)
      connection.periodic = periodic_translation(way.to(connection.periodic->declared.translation));
    mesh.coordinates = Coordinates(flat.n_nodes());
    for (Index n = 0; n < flat.n_nodes(); ++n) {
      Vec3 const p = flat.coordinates[n];
      mesh.coordinates.set(n, way.to({p.x + 0.03 * p.y, p.y, 0.25}));
    }
    Case const c(std::move(mesh));
    auto const bends = [&, &way = way, periodic = periodic](double amount) {
      FunctionRule bent{"bent", [&way, periodic, amount](std::span<Vec3 const> x, std::span<Vec3> u) {
                          for (std::size_t n = 0; n < x.size(); ++n) {
                            double const s = way.from(x[n]).x / 6, bump = 4 * s * (1 - s);
                            u[n] = way.to({amount * (periodic ? bump : s * s), amount * bump, 0});
                          }
                        }};
      std::vector<MotionRule> rules{test::rule_for({"j_min"}, std::move(bent)), test::rule_for({"j_max"}, FixedRule{})};
      // The corner of the wall is taken off the side, and put back.
      if (!periodic) rules.push_back(test::rule_for({"i_max"}, SlipRule{SlipRule::Surface::plane}));
      return test::motion_of(std::move(rules));
    };
    Motion const motion = bends(0.2);
    Morphed const m = c.guarded_morph(motion);
    EXPECT_EQ(c.inverted(m.x), 0);
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      Vec3 const x = way.from(m.x[n]);
      EXPECT_EQ(x.z, 0.25) << n;
      if (is_first)
        reference.push_back(x);
      else
        ASSERT_LT(distance(x, reference[n]), 1e-12) << n;
    }
    if (is_first || (way.to({1, 0, 0}).y == 1) != periodic) continue;
    auto const rate =
        test::rate_error(c, m.prepared.plan, [&](double t) { return evaluate(m.prepared.boundary, bends(0.2 + t)); });
    EXPECT_LT(rate.error, 1e-6 * rate.largest);
    // The transpose is that of the velocities.
    auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion, {});
    MorpherOptions options{1, true};
    options.transpose = true;
    auto const morpher = MorpherAccess::of(Case::Host(), prepared.plan, c.mesh.coordinates, options);
    auto const as_view = [](std::vector<Vec3> const& v) {
      return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(v.data(), v.size());
    };
    auto const u = evaluate(prepared.boundary, motion);
    std::vector<Vec3> du, dJ_dx, dJ_db(u.size());
    for (std::size_t k = 0; k < u.size(); ++k)
      du.push_back(way.to({0.1 + 0.01 * double(k % 7), 0.2 - 0.02 * double(k % 5), 0}));
    for (Index n = 0; n < c.mesh.n_nodes(); ++n)
      dJ_dx.push_back(way.to({0.3 - 0.01 * double(n % 11), 0.1 + 0.03 * double(n % 3), 0}));
    Coordinates v(c.mesh.n_nodes());
    morpher.velocities(Case::Host(), as_view(u), as_view(du), v);
    morpher.transpose(Case::Host(), as_view(u), as_view(dJ_dx),
                      Kokkos::View<Vec3*, Kokkos::HostSpace>(dJ_db.data(), dJ_db.size()));
    Case::Host().fence();
    double forwards = 0, backwards = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) forwards += dot(dJ_dx[n], v[n]);
    for (std::size_t k = 0; k < u.size(); ++k) backwards += dot(dJ_db[k], du[k]);
    EXPECT_NEAR(forwards, backwards, 1e-10 * std::abs(forwards));
  }
}

TEST(UnstructuredMorph, MotionsOutOfThePlaneOfAPlaneMeshAreRefused) {
  Case const c(test::flat_box(6, 5, 2));
  auto const moved_by = [&](Rule rule) {
    return test::message_of<MotionError>([&] {
      (void)c.morph(
          test::motion_of({test::rule_for({"j_min"}, std::move(rule)), test::rule_for({"i_*", "j_max"}, FreeRule{})}));
    });
  };
  for (Vec3 const& axis : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{1, 0, 1}}) {
    std::string const said = moved_by(rotation({3, 1, 0}, axis, 0.4));
    EXPECT_NE(said.find("out of the plane of a 2-D mesh"), std::string::npos) << said;
    EXPECT_NE(said.find("j_min"), std::string::npos) << said;
  }
  EXPECT_NE(moved_by(translation({0, 0.1, 0.02})).find("out of the plane"), std::string::npos);
  // What rounding leaves of a turn within the plane is no such motion.
  EXPECT_NO_THROW((void)c.morph(test::motion_of({test::rule_for({"j_min"}, rotation({3, 1, 0}, {1e-17, 0, 1}, 0.05)),
                                                 test::rule_for({"i_*", "j_max"}, FreeRule{})})));
}

TEST(UnstructuredMorph, AMotionOfAllBoundariesMovesAllNodesAlike) {
  Case const c(box_with_body(12));
  Vec3 const t{0.3, -0.2, 0.1};
  Morphed const m = c.morph(body_moves(translation(t), {{{"?_min", "?_max"}, translation(t), 0, "all"}}));
  for (Index n = 0; n < c.mesh.n_nodes(); ++n)
    ASSERT_NEAR(distance(m.x[n], c.mesh.coordinates[n] + t), 0, 1e-13 * c.mesh.size()) << n;
}

TEST(UnstructuredMorph, PrescribedDisplacementsHoldExactlyAndTheRestIsSound) {
  for (int const n : {9, 12, 18}) {
    Case const c(box_with_body(n));
    double const third = n / 3;
    // The gap is as wide as the body: a third of it is a large motion.
    for (Rule const& rule : {translation({0.33 * third, 0, 0}), translation({0.2 * third, 0.2 * third, -0.2 * third}),
                             rotation({n / 2., n / 2., n / 2.}, {1, 2, 3}, 0.4)}) {
      Morphed const m = c.morph(body_moves(rule));
      auto const& plan = m.prepared.plan;
      for (std::size_t k = 0; k < plan.known.size(); ++k) {
        Vec3 const x = c.mesh.coordinates[plan.known[k]], want = x + m.boundary[k], is = m.x[plan.known[k]];
        ASSERT_TRUE(is.x == want.x && is.y == want.y && is.z == want.z) << describe_node(c.mesh, plan.known[k]);
      }
      EXPECT_EQ(c.inverted(m.x), 0) << n;
    }
  }
}

TEST(UnstructuredMorph, NodesWherePlanesMeetAtAnyAngleStayOnBoth) {
  for (double const lean : {0.0, 0.5, 2.0}) {
    // The body stands in the edge of two planes, on which the nodes before and behind it slip.
    Mesh mesh = test::box_around({9, 9, 9}, [](Vec3 const& p) { return p.x < 3 && p.z < 3 && p.y > 3 && p.y < 6; });
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const q = mesh.coordinates[n];
      mesh.coordinates.set(n, {q.x + lean * q.z, q.y, q.z});
    }
    Case const c(std::move(mesh));
    Morphed const m = c.morph(body_moves(translation({0.3, 0.1, 0.2}), {{{"i_min", "k_min"}, SlipRule{}, 0, "slip"}}));
    auto const& known = m.prepared.plan.known;
    auto const off = [&](std::string const& side, Vec3 const& normal) {
      double worst = 0, moved = 0;
      for (Index const n : m.prepared.boundary.nodes_of(c.patch(side))) {
        if (std::binary_search(known.begin(), known.end(), n)) continue;
        Vec3 const u = m.x[n] - c.mesh.coordinates[n];
        worst = std::max(worst, std::abs(dot(u, normal)) / norm(normal));
        moved = std::max(moved, norm(u));
      }
      EXPECT_GT(moved, 0.01) << side << " " << lean;
      return worst;
    };
    EXPECT_LT(off("i_min", {1, 0, -lean}), 1e-12) << lean;
    EXPECT_LT(off("k_min", {0, 0, 1}), 1e-12) << lean;
  }
}

TEST(UnstructuredMorph, ProfilesThatDifferInTheMiddleOnlyAreTwoSurfaces) {
  // Half an annulus along x; two parts of its case slip, on profiles with the same ends.
  auto const radius = [](double x, bool bulged) {
    return 2 + (bulged ? 0.3 * std::pow(std::sin(std::clamp(x, 0.0, std::numbers::pi)), 2) : 0.0);
  };
  auto const profile = [&](bool bulged) {
    std::vector<std::pair<double, double>> points;
    for (int k = 0; k <= 32; ++k)
      points.emplace_back(k * std::numbers::pi / 32, radius(k * std::numbers::pi / 32, bulged));
    return points;
  };
  Mesh mesh = test::to_hexahedra(test::unit_box({16, 6, 12}));
  auto const part_of_case = [](double k) { return k <= 4 ? 0 : k >= 8 ? 1 : 2; };
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const q = mesh.coordinates[n];
    double const x = q.x * std::numbers::pi / 16, angle = q.z * std::numbers::pi / 12;
    double const share = std::clamp((q.z - 4) / 4, 0.0, 1.0);
    double const outer = (1 - share) * radius(x, false) + share * radius(x, true), r = 1 + (outer - 1) * q.y / 6;
    mesh.coordinates.set(n, {x, r * std::cos(angle), r * std::sin(angle)});
  }
  Patch parts[3];
  for (auto& patch : mesh.patches)
    if (patch.name == "j_max")
      for (Index f = 0; f < patch.faces.size(); ++f) {
        double angle = 0;
        for (Index32 const n : patch.faces[f])
          angle += 0.25 * std::atan2(mesh.coordinates.z(n), mesh.coordinates.y(n)) * 12 / std::numbers::pi;
        parts[part_of_case(angle)].faces.add(patch.faces[f]);
      }
  std::erase_if(mesh.patches, [](auto const& patch) { return patch.name == "j_max"; });
  for (int p = 0; p < 3; ++p) {
    parts[p].name = "part" + std::to_string(p);
    parts[p].zone = 0;
    mesh.patches.push_back(parts[p]);
  }
  Case const c(mesh);
  Motion motion;
  motion.rules.push_back({{"j_min"}, translation({0.15, 0, 0}), 0, "hub"});
  for (bool const bulged : {false, true})
    motion.rules.push_back({{bulged ? "part1" : "part0"},
                            SlipRule{.surface = SlipRule::Surface::revolution, .profile = profile(bulged)},
                            0,
                            "case"});
  motion.rules.push_back({{"part2", "i_min", "i_max", "k_min", "k_max"}, FreeRule{}, 0, "rest"});
  Morphed const m = c.morph(motion);
  EXPECT_EQ(m.prepared.plan.surfaces.size(), 2u);
  double largest = 0;
  for (bool const bulged : {false, true})
    for (Index32 const n : c.nodes_of(bulged ? "part1" : "part0")) {
      Vec3 const x = m.x[n];
      largest = std::max(largest, distance(x, c.mesh.coordinates[n]));
      EXPECT_NEAR(std::hypot(x.y, x.z), radius(x.x, bulged), 1e-5) << describe_node(c.mesh, n);
    }
  EXPECT_GT(largest, 0.01) << "nodes slide";
}

TEST(UnstructuredMorph, AroundARigidWallTheNearFieldIsTheSameRigidMotion) {
  Case const c(box_with_body(18));
  RigidTransform const r = rotation_about({9, 9, 9}, {0, 0, 1}, 0.3);
  PlanOptions options = test::by_lattice();
  options.elements.offset = 1.2;
  Morphed const m = c.morph(body_moves(RigidRule{r.rotation, r.translation}), options);
  // One element off the body, where other boundaries are five times as far as the wall.
  Index seen = 0;
  for (Index32 const n : m.prepared.plan.near.rows.target) {
    Vec3 const x = c.mesh.coordinates[n];
    double const d = std::max({std::abs(x.x - 9), std::abs(x.y - 9), std::abs(x.z - 9)}) - 3;
    if (d > 1.01 || !m.prepared.report.wrap->contains(x)) continue;
    ++seen;
    EXPECT_LT(distance(m.x[n], r(x)), 0.35 * distance(x, r(x)) + 1e-8) << n;
  }
  EXPECT_GT(seen, 100);
}

TEST(UnstructuredMorph, AMotionOfNoWallIsRefused) {
  Case const c(box_with_body(9));
  EXPECT_THROW((void)c.morph(body_moves(FixedRule{})), MotionError);
}

TEST(UnstructuredMorph, RulesThatDisagreeOnCommonNodesAreNamed) {
  Mesh const mesh = test::to_prisms_and_tetrahedra(test::unit_box({6, 6, 6}), 2);
  Case const c(mesh);
  Motion motion;
  motion.rules.push_back({{"k_min"}, translation({0, 0, 0.5}), 0, "here.toml:4"});
  try {
    (void)c.morph(motion);
    FAIL() << "accepted";
  } catch (MotionError const& e) {
    EXPECT_NE(std::string(e.what()).find("here.toml:4"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("common nodes"), std::string::npos) << e.what();
  }
}

TEST(UnstructuredMorph, ColumnsOfPrismsKeepTheirHeight) {
  // The wall k_min bulges; its prisms go with it, the other sides slide.
  Mesh mesh = test::to_prisms_and_tetrahedra(test::unit_box({10, 10, 10}), 3);
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.z(n) = std::pow(mesh.coordinates.z(n) / 10, 2) * 10;
  Case const c(mesh);
  Motion motion;
  motion.rules.push_back({{"k_min"},
                          FunctionRule{"bump",
                                       [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                         for (std::size_t n = 0; n < x.size(); ++n) {
                                           double const s = std::sin(x[n].x * std::numbers::pi / 10) *
                                                            std::sin(x[n].y * std::numbers::pi / 10);
                                           u[n] = {0, 0, s * s};
                                         }
                                       }},
                          0,
                          "bump"});
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"k_min"}, .extent = BoundaryLayer::Extent::layers, .layers = 3});
  Morphed const m = c.morph(motion, options);
  EXPECT_EQ(c.inverted(m.x), 0);
  auto const& columns = m.prepared.plan.columns;
  ASSERT_GT(columns.node.size(), 100u);
  for (std::size_t k = 0; k < columns.node.size(); ++k) {
    Index32 const wall = m.prepared.plan.driving[columns.root[k]];
    // The rim of the wall is where the fixed sides begin.
    Vec3 const w = c.mesh.coordinates[wall];
    if (w.x < 1 || w.x > 9 || w.y < 1 || w.y > 9) continue;
    double const before = distance(c.mesh.coordinates[columns.node[k]], w),
                 after = distance(m.x[columns.node[k]], m.x[wall]);
    EXPECT_NEAR(after, before, 1e-9 * before);
  }
}

TEST(UnstructuredMorph, StructuredMeshesMoveAlikeByBothWays) {
  // The floor of a box bulges: through blocks and through elements. The boundary goes the same way; between floor and
  // lid both fall off, along grid lines and by distance.
  constexpr int n = 12;
  Motion motion;
  motion.rules.push_back({{"k_min"},
                          FunctionRule{"bump",
                                       [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                         for (std::size_t k = 0; k < x.size(); ++k)
                                           u[k] = {0, 0,
                                                   2 * std::pow(std::sin(x[k].x * std::numbers::pi / n) *
                                                                    std::sin(x[k].y * std::numbers::pi / n),
                                                                2)};
                                       }},
                          0,
                          "bump"});
  auto const blocks = test::morph(test::unit_box({n, n, n}), motion);
  Case const c(test::to_hexahedra(test::unit_box({n, n, n})));
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"k_min"}, .mode = BoundaryLayer::Mode::translate});
  Morphed const elements = c.morph(motion, options);
  double squares = 0, farthest = 0;
  Index inside = 0;
  for (Index k = 0; k < c.mesh.n_nodes(); ++k) {
    Vec3 const x = c.mesh.coordinates[k], a = blocks.u(k), b = elements.x[k] - x;
    double const apart = distance(a, b);
    if (std::min({x.x, x.y, x.z}) == 0 || std::max({x.x, x.y, x.z}) == n) {
      ASSERT_LT(apart, 1e-13) << k;
      continue;
    }
    // Grid lines give each node its share of what the floor below it does.
    EXPECT_LT(distance(a, {0, 0, (1 - x.z / n) * blocks.u(k % ((n + 1) * (n + 1))).z}), 1e-13) << k;
    EXPECT_GE(b.z, -1e-6) << k;
    EXPECT_LE(b.z, 2 + 1e-6) << k;
    EXPECT_LT(std::abs(b.x) + std::abs(b.y), 1e-6) << k;
    ++inside;
    squares += apart * apart;
    farthest = std::max(farthest, apart);
  }
  EXPECT_EQ(inside, (n - 1) * (n - 1) * (n - 1));
  EXPECT_LT(farthest, 0.5);
  EXPECT_LT(std::sqrt(squares / double(inside)), 0.25);
  EXPECT_EQ(c.inverted(elements.x), 0);
  EXPECT_EQ(c.inverted(blocks.morphed.position), 0);
}

}  // namespace
}  // namespace gridmorph
