// Interfaces from two ranges and a Transform, in all orientations, on all faces, in all directions of writing a range.
#include "support/expect_error.hpp"
#include "support/scramble.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/point_ranges.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace gridmorph::test {
namespace {

constexpr Index3 extent{4, 5, 6};

/// A zone whose face (normal, side) meets a zone oriented by `o`: `to_donor` is the plain formula.
struct TwoZones {
  Mesh mesh;
  IndexMap to_donor;
  IndexRange face{{0, 0, 0}, extent};

  TwoZones(Orientation const& o, int normal, int side) {
    mesh.source = "two zones";
    mesh.add_zone("own", extent);
    Index3 other{};
    for (int a = 0; a < 3; ++a) other[o.axis[a]] = extent[a] + (a == normal ? 2 : 0);
    mesh.add_zone("donor", other);
    face.begin[normal] = side == 0 ? 0 : extent[normal] - 1;
    face.end[normal] = face.begin[normal] + 1;
    to_donor.orientation = o;
    to_donor.own_origin = face.begin;
    for (int a = 0; a < 3; ++a) {
      int const d = o.axis[a];
      bool const from_first = a == normal ? (side == 1) == (o.sign[a] > 0) : o.sign[a] > 0;
      to_donor.donor_origin[d] = from_first ? 0 : other[d] - 1;
    }
  }
  /// The corners of the face as a file would have them; bit a of `flips`: written from the last to the first along a.
  [[nodiscard]] PointRange own(int flips) const {
    PointRange r;
    for (int a = 0; a < 3; ++a) {
      r.begin[a] = face.begin[a] + 1;
      r.end[a] = face.end[a];
      if (flips >> a & 1) std::swap(r.begin[a], r.end[a]);
    }
    return r;
  }
  [[nodiscard]] PointRange donor(PointRange const& own) const {
    auto const image = [&](Index3 const& p) {
      Index3 const q = to_donor(Index3{p[0] - 1, p[1] - 1, p[2] - 1});
      return Index3{q[0] + 1, q[1] + 1, q[2] + 1};
    };
    return {image(own.begin), image(own.end)};
  }
  [[nodiscard]] std::array<int, 3> transform() const {
    std::array<int, 3> t{};
    for (int a = 0; a < 3; ++a) t[a] = to_donor.orientation.sign[a] * (to_donor.orientation.axis[a] + 1);
    return t;
  }
  void expect_found(PointRange const& own, PointRange const& donor, std::array<int, 3> const& t) const {
    Interface1to1 const found = interface_from_ranges(mesh, "joint", 0, own, 1, donor, t);
    EXPECT_EQ(found.range, face);
    EXPECT_EQ(found.zone, 0);
    EXPECT_EQ(found.donor_zone, 1);
    for (int k = -1; k <= extent[2]; ++k)  // through the face too
      for (int j = -1; j <= extent[1]; ++j)
        for (int i = -1; i <= extent[0]; ++i) ASSERT_EQ(found.to_donor(Index3{i, j, k}), to_donor(Index3{i, j, k}));
  }
};

template <class Use>
void for_all_joints(Use const& use) {
  for (auto const& o : all_orientations())
    for (int normal = 0; normal < 3; ++normal)
      for (int side = 0; side < 2; ++side) use(TwoZones(o, normal, side), normal);
}

TEST(PointRanges, GiveTheMapOfTheStandardInAllOrientations) {
  for_all_joints([](TwoZones const& z, int normal) {
    for (int flips = 0; flips < 8; ++flips) {
      PointRange const own = z.own(flips);
      z.expect_found(own, z.donor(own), z.transform());
      auto other_sign = z.transform();  // of the normal: files are seen with either
      other_sign[normal] = -other_sign[normal];
      z.expect_found(own, z.donor(own), other_sign);
    }
  });
}

TEST(PointRanges, RebuildAZeroOfTheTransform) {
  for_all_joints([](TwoZones const& z, int) {
    PointRange const own = z.own(5);
    for (int a = 0; a < 3; ++a) {
      auto t = z.transform();
      t[a] = 0;
      z.expect_found(own, z.donor(own), t);
    }
  });
}

TEST(PointRanges, TakeDonorRangesWrittenInAscendingOrder) {
  for_all_joints([](TwoZones const& z, int) {
    PointRange const own = z.own(0);
    PointRange donor = z.donor(own);
    for (int a = 0; a < 3; ++a)
      if (donor.begin[a] > donor.end[a]) std::swap(donor.begin[a], donor.end[a]);
    z.expect_found(own, donor, z.transform());
  });
}

TEST(PointRanges, ThatDoNotFitAreRefused) {
  TwoZones const z({}, 2, 1);
  PointRange const own = z.own(0), donor = z.donor(own);
  auto const refused = [&](PointRange const& a, PointRange const& b, std::array<int, 3> const& t,
                           std::initializer_list<std::string_view> words) {
    expect_all_in(message_of<MeshError>([&] { (void)interface_from_ranges(z.mesh, "joint", 0, a, 1, b, t); }), words);
  };
  refused(own, donor, {1, 1, 3}, {"joint", "[1, 1, 3]", "signed permutation"});
  refused(own, donor, {2, 1, 3}, {"another shape", "4 nodes along i", "5 along donor j"});
  refused(own, donor, {3, 2, 1}, {"face normal"});
  PointRange inside = own;
  inside.begin[2] = inside.end[2] = 3;
  refused(inside, donor, {1, 2, 3}, {"[1:4, 1:5, 3:3]", "not on a face", "own"});
  PointRange outside = own;
  outside.end[0] = 5;
  refused(outside, donor, {1, 2, 3}, {"leaves zone 'own'", "4 nodes along i"});
  expect_all_in(message_of<MeshError>([&] {
                  (void)interface_from_ranges(z.mesh, "joint", 0, own, 2, donor, {1, 2, 3});
                }),
                {"no zone 2"});
}

}  // namespace
}  // namespace gridmorph::test
