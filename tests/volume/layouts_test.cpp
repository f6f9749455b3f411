// Coordinates and displacements in the arrays of a caller: whatever their layout, the same vectors come out.
#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/morph/morph.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Memory = Exec::memory_space;
using In = Morpher<Exec>::In;
using Out = Morpher<Exec>::Out;

template <class V>
void put(V const& v, Coordinates const& from) {
  for (Index n = 0; n < from.size(); ++n) {
    v(n, 0) = typename V::value_type(from.x(n));
    v(n, 1) = typename V::value_type(from.y(n));
    v(n, 2) = typename V::value_type(from.z(n));
  }
}

/// The zones of a mesh, each with arrays of its own inside a frame of `ghosts` layers that hold -7, filled by
/// at(node) -> Vec3.
template <class T, class Layout>
struct GhostedZones {
  std::vector<Kokkos::View<T****, Layout, Memory>> whole;
  std::vector<Kokkos::View<T****, Kokkos::LayoutStride, Memory>> inner;

  GhostedZones(Mesh const& mesh, int ghosts, std::function<Vec3(Index)> const& at) {
    for (Zone const& zone : mesh.zones) {
      auto const [ni, nj, nk] = zone.extent;
      whole.emplace_back("test::zone", ni + 2 * ghosts, nj + 2 * ghosts, nk + 2 * ghosts, 3);
      Kokkos::deep_copy(whole.back(), T(-7));
      auto const inside = [&](int n) { return std::pair(ghosts, ghosts + n); };
      inner.emplace_back(Kokkos::subview(whole.back(), inside(ni), inside(nj), inside(nk), Kokkos::ALL));
      for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
        auto const [i, j, k] = zone.index(n);
        Vec3 const v = at(n);
        inner.back()(i, j, k, 0) = T(v.x);
        inner.back()(i, j, k, 1) = T(v.y);
        inner.back()(i, j, k, 2) = T(v.z);
      }
    }
  }
  [[nodiscard]] Vec3 operator()(Mesh const& mesh, Index n) const {
    int const z = mesh.zone_of(n);
    auto const [i, j, k] = mesh.zones[z].index(n);
    auto const& v = inner[z];
    return {v(i, j, k, 0), v(i, j, k, 1), v(i, j, k, 2)};
  }
  /// Nodes of the frame that have been written to.
  [[nodiscard]] Index touched() const {
    Index count = 0;
    for (std::size_t z = 0; z < whole.size(); ++z) {
      auto const& v = whole[z];
      int const g = int(v.extent(0) - inner[z].extent(0)) / 2;
      auto const outside = [&](std::size_t n, int d) { return int(n) < g || int(n) >= int(v.extent(d)) - g; };
      for (std::size_t i = 0; i < v.extent(0); ++i)
        for (std::size_t j = 0; j < v.extent(1); ++j)
          for (std::size_t k = 0; k < v.extent(2); ++k)
            for (int c = 0; c < 3; ++c)
              if ((outside(i, 0) || outside(j, 1) || outside(k, 2)) && v(i, j, k, c) != T(-7)) ++count;
    }
    return count;
  }
};

/// An annulus sector that slides, with periodic turns, corrections and slip surfaces, and what flat arrays of double
/// give.
class Layouts : public ::testing::Test {
 protected:
  Outcome const run = [] {
    Sector const shape;
    Motion m = motion({rule({"inlet", "outlet"}, function_rule(turning_waves(shape, 0.05))),
                       rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
    m.axis = {shape.origin, shape.axis};
    return morph(annulus_sector({}, 1), m);
  }();
  Mesh const& mesh = run.mesh;
  Exec exec;
  Kokkos::View<Vec3*, Memory> boundary = upload<Memory>(run.boundary);

  /// Positions and displacements of a morph with these arrays; at(f, n) reads node n of what was written to them.
  void expect_same(In const& x, In const& given, Out const& out, std::function<Vec3(Index)> const& written) const {
    auto const morpher = MorpherAccess::of(exec, run.plan(), x);
    morpher.positions(exec, given, out);
    exec.fence();
    Index different = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) different += same_bits(written(n), run.morphed.position[n]) ? 0 : 1;
    EXPECT_EQ(different, 0) << "positions";
    morpher.displacements(exec, given, out);
    exec.fence();
    different = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) different += same_bits(written(n), run.morphed.displacement[n]) ? 0 : 1;
    EXPECT_EQ(different, 0) << "displacements";
  }

  template <class Layout>
  void expect_same_in_rank_two() const {
    Index const n = mesh.n_nodes();
    Kokkos::View<double*[3], Layout, Memory> const x("test::x", n), out("test::out", n);
    Kokkos::View<double**, Layout, Memory> const given("test::given", run.boundary.size(), 3);
    put(x, mesh.coordinates);
    for (std::size_t b = 0; b < run.boundary.size(); ++b) {
      given(b, 0) = run.boundary[b].x;
      given(b, 1) = run.boundary[b].y;
      given(b, 2) = run.boundary[b].z;
    }
    expect_same(x, given, out, [&](Index m) { return Vec3{out(m, 0), out(m, 1), out(m, 2)}; });
  }

  template <class Layout>
  void expect_same_zone_by_zone() const {
    GhostedZones<double, Layout> const x(mesh, 2, [&](Index n) { return mesh.coordinates[n]; }),
        out(mesh, 1, [](Index) { return Vec3{}; });
    expect_same(In(exec, mesh, x.inner), boundary, Out(exec, mesh, out.inner), [&](Index n) { return out(mesh, n); });
    EXPECT_EQ(out.touched(), 0);
  }
};

TEST_F(Layouts, RankTwoViewsOfAnyLayout) {
  expect_same_in_rank_two<Kokkos::LayoutRight>();
  expect_same_in_rank_two<Kokkos::LayoutLeft>();
}

TEST_F(Layouts, ColumnsOfWiderArrays) {
  Kokkos::View<double* [7], Kokkos::LayoutRight, Memory> const state("test::state", mesh.n_nodes());
  auto const x = Kokkos::subview(state, Kokkos::ALL, std::pair(0, 3));
  auto const out = Kokkos::subview(state, Kokkos::ALL, std::pair(4, 7));
  put(x, mesh.coordinates);
  expect_same(x, boundary, out, [&](Index n) { return Vec3{out(n, 0), out(n, 1), out(n, 2)}; });
  for (Index n = 0; n < mesh.n_nodes(); ++n) ASSERT_EQ(state(n, 3), 0);
}

TEST_F(Layouts, ThreeArraysAndStructsOfThem) {
  Coordinates const out(mesh.n_nodes());
  Coordinates const& x = mesh.coordinates;
  auto const written = [&](Index n) { return out[n]; };
  expect_same({x.x, x.y, x.z}, boundary, {out.x, out.y, out.z}, written);
  expect_same(x, boundary, out, written);
}

TEST_F(Layouts, ZonesApartWithGhostLayers) {
  expect_same_zone_by_zone<Kokkos::LayoutLeft>();
  expect_same_zone_by_zone<Kokkos::LayoutRight>();
}

TEST_F(Layouts, ZonesApartWithThreeArraysEach) {
  using Array = Kokkos::View<double***, Kokkos::LayoutLeft, Memory>;
  struct Block {
    Array x, y, z;
  };
  std::vector<Block> x, out;
  for (Zone const& zone : mesh.zones) {
    auto const [ni, nj, nk] = zone.extent;
    for (auto* list : {&x, &out})
      list->push_back({Array("test::x", ni, nj, nk), Array("test::y", ni, nj, nk), Array("test::z", ni, nj, nk)});
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      auto const [i, j, k] = zone.index(n);
      Vec3 const p = mesh.coordinates[n];
      x.back().x(i, j, k) = p.x;
      x.back().y(i, j, k) = p.y;
      x.back().z(i, j, k) = p.z;
    }
  }
  expect_same(In(exec, mesh, x), boundary, Out(exec, mesh, out), [&](Index n) {
    int const zone = mesh.zone_of(n);
    auto const [i, j, k] = mesh.zones[zone].index(n);
    return Vec3{out[zone].x(i, j, k), out[zone].y(i, j, k), out[zone].z(i, j, k)};
  });
}

/// What is computed with coordinates and displacements in single precision: in double from them, and rounded once.
TEST_F(Layouts, SinglePrecisionIsRoundedOnceOnTheWayOut) {
  auto const rounded = [](double v) { return double(float(v)); };
  Coordinates x(mesh.n_nodes()), expected(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    x.set(n, {rounded(p.x), rounded(p.y), rounded(p.z)});
  }
  Kokkos::View<float* [3], Kokkos::LayoutLeft, Memory> const given("test::given", run.boundary.size());
  Kokkos::View<Vec3*, Memory> const same_given("test::given", run.boundary.size());
  for (std::size_t b = 0; b < run.boundary.size(); ++b) {
    given(b, 0) = float(run.boundary[b].x);
    given(b, 1) = float(run.boundary[b].y);
    given(b, 2) = float(run.boundary[b].z);
    same_given(b) = {given(b, 0), given(b, 1), given(b, 2)};
  }
  MorpherAccess::of(exec, run.plan(), x).positions(exec, same_given, expected);
  exec.fence();
  auto const expect_rounded = [&](auto const& written) {
    Index different = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const e = expected[n];
      different += written(n) == Vec3{rounded(e.x), rounded(e.y), rounded(e.z)} ? 0 : 1;
    }
    EXPECT_EQ(different, 0);
  };
  Kokkos::View<float*[3], Kokkos::LayoutRight, Memory> const flat("test::x", mesh.n_nodes()),
      out("test::out", mesh.n_nodes());
  put(flat, x);
  MorpherAccess::of(exec, run.plan(), flat).positions(exec, given, out);
  exec.fence();
  expect_rounded([&](Index n) { return Vec3{out(n, 0), out(n, 1), out(n, 2)}; });
  GhostedZones<float, Kokkos::LayoutRight> const blocks(mesh, 1, [&](Index n) { return x[n]; });
  Out const in_place(exec, mesh, blocks.inner);
  MorpherAccess::of(exec, run.plan(), in_place).positions(exec, given, in_place);
  exec.fence();
  expect_rounded([&](Index n) { return blocks(mesh, n); });
  EXPECT_EQ(blocks.touched(), 0);
}

TEST_F(Layouts, ExtentsThatDoNotFitAreRefusedWithBothNumbers) {
  Index const n = mesh.n_nodes();
  auto const morpher = MorpherAccess::of(exec, run.plan(), mesh.coordinates);
  for (Index const other : {n - 1, n + 1}) {
    auto const refused = [&](auto const& call) {
      expect_all_in(message_of<ConfigError>(call), {std::to_string(other) + " nodes", std::to_string(n)});
    };
    Coordinates const wrong(other);
    refused([&] { MorpherAccess::of(exec, run.plan(), wrong); });
    refused([&] { morpher.positions(exec, boundary, wrong); });
    refused([&] { morpher.displacements(exec, boundary, wrong); });
  }
  auto const refused = [&](auto const& call, std::initializer_list<std::string_view> words) {
    expect_all_in(message_of<ConfigError>(call), words);
  };
  Kokkos::View<double**, Memory> const four("test::four", n, 4);
  refused([&] { (void)In(four); }, {"3 components", "extent is 4"});
  Kokkos::View<double*, Memory> const a("test::a", 5), b("test::b", 6);
  refused([&] { (void)In(a, a, b); }, {"extent 5", "6"});
  Kokkos::View<double* [2], Kokkos::LayoutRight, Memory> const pairs("test::pairs", 5);
  refused([&] { (void)In(a, a, Kokkos::subview(pairs, Kokkos::ALL, 1)); }, {"stride 1", "2"});
  GhostedZones<double, Kokkos::LayoutLeft> zones(mesh, 1, [](Index) { return Vec3{}; });
  refused([&] { (void)Out(exec, mesh, zones.whole); },
          {mesh.zones[0].name, std::to_string(mesh.zones[0].extent[0] + 2)});
  zones.inner.pop_back();
  refused([&] { (void)Out(exec, mesh, zones.inner); },
          {std::to_string(mesh.zones.size()) + " zones", std::to_string(mesh.zones.size() - 1)});
}

// Plans read coordinates on the host: from whatever layout a solver has them in, the same ones come.
TEST_F(Layouts, ComeToTheHostForPlans) {
  Exec const exec;
  Mesh const mesh = annulus_sector({}, 1);
  auto const expect_same = [&](In const& x, double tolerance) {
    Coordinates const host = host_coordinates(exec, x);
    ASSERT_EQ(host.size(), mesh.n_nodes());
    for (Index n = 0; n < host.size(); ++n) ASSERT_LE(distance(host[n], mesh.coordinates[n]), tolerance) << n;
  };
  expect_same(mesh.coordinates, 0);
  Kokkos::View<double* [3], Kokkos::LayoutRight, Memory> const rows("test::rows", mesh.n_nodes());
  put(rows, mesh.coordinates);
  expect_same(rows, 0);
  Kokkos::View<float**, Kokkos::LayoutLeft, Memory> const single("test::single", mesh.n_nodes(), 3);
  put(single, mesh.coordinates);
  expect_same(single, 1e-6 * mesh.size());
  GhostedZones<double, Kokkos::LayoutRight> const zones(mesh, 2, [&](Index n) { return mesh.coordinates[n]; });
  expect_same(In(exec, mesh, zones.inner), 0);
}

// Other spaces are refused when they are compiled, in a sentence.
struct OtherSpace {};
static_assert(BuiltFor<Exec> && !BuiltFor<OtherSpace>);

}  // namespace
}  // namespace gridmorph::test
