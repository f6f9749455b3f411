// The 48 signed permutations of index axes, and maps of index ranges.
#include <gridmorph/core/index.hpp>

#include "support/scramble.hpp"

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

/// Matrix of an orientation, written from the SIDS definition: column a is sign(T[a]) times unit vector |T[a]|.
std::array<std::array<int, 3>, 3> matrix(Orientation const& o) {
  std::array<std::array<int, 3>, 3> m{};
  for (int a = 0; a < 3; ++a) m[o.axis[a]][a] = o.sign[a];
  return m;
}

TEST(Orientation, AppliesAsTheMatrixOfTheSids) {
  Index3 const v{2, 3, 5};
  for (auto const& o : all_orientations()) {
    auto const m = matrix(o);
    Index3 const image = o.apply(v);
    for (int r = 0; r < 3; ++r) EXPECT_EQ(image[r], m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2]);
  }
}

TEST(Orientation, All48ComposeAsMatrices) {
  Index3 const v{2, 3, 5};
  for (auto const& a : all_orientations())
    for (auto const& b : all_orientations()) EXPECT_EQ(a.then(b).apply(v), b.apply(a.apply(v)));
}

TEST(Orientation, All48HaveAnInverse) {
  Orientation const identity;
  for (auto const& o : all_orientations()) {
    EXPECT_EQ(o.then(o.inverse()), identity);
    EXPECT_EQ(o.inverse().then(o), identity);
  }
}

TEST(Orientation, HalfOfThemMirror) {
  int mirrored = 0;
  for (auto const& o : all_orientations()) {
    auto const m = matrix(o);
    int const determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                            m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                            m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    EXPECT_EQ(o.determinant(), determinant);
    mirrored += determinant < 0;
  }
  EXPECT_EQ(mirrored, 24);
}

TEST(IndexMap, ImageOfARangeHoldsTheImagesOfItsNodes) {
  IndexRange const range{{1, 2, 3}, {4, 3, 8}};
  for (auto const& o : all_orientations()) {
    IndexMap const map{o, {1, 1, 1}, {10, 20, 30}};
    IndexRange const image = map(range);
    EXPECT_EQ(image.size(), range.size());
    for (int k = 3; k < 8; ++k)
      for (int i = 1; i < 4; ++i) EXPECT_TRUE(image.contains(map(Index3{i, 2, k})));
    EXPECT_EQ(map.inverse()(image), range);
  }
}

TEST(IndexMap, ComposesAndInverts) {
  IndexMap const first{{{1, 2, 0}, {1, -1, 1}}, {3, 0, 2}, {5, 6, 7}};
  IndexMap const second{{{2, 1, 0}, {-1, 1, 1}}, {1, 1, 1}, {-4, 2, 9}};
  Index3 const p{11, 7, -3};
  EXPECT_EQ(first.then(second)(p), second(first(p)));
  EXPECT_EQ(first.inverse()(first(p)), p);
}

}  // namespace
}  // namespace gridmorph::test
