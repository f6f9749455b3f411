// Triangles, polygons and lines as pixels.
#include <gridmorph/page/canvas.hpp>

#include <gtest/gtest.h>

#include <array>

namespace gridmorph::page {
namespace {

std::array<int, 4> pixel(io::Picture const& picture, int x, int y) {
  auto const* p = picture.at(x, y);
  return {p[0], p[1], p[2], p[3]};
}
constexpr std::array clear{0, 0, 0, 0};

ColourScale const& black_to_red() {
  static std::array<Colour, 2> const stops{{{0, 0, 0}, {252, 0, 0}}};
  static ColourScale const scale(stops);
  return scale;
}

/// Two triangles that make a rectangle of the left upper corner (a, b) and the right lower one (c, d).
void rectangle(Canvas& canvas, double a, double b, double c, double d, double depth, double share) {
  std::array<double, 3> const all{share, share, share};
  canvas.triangle({Place{a, b, depth}, {c, b, depth}, {c, d, depth}}, all, black_to_red(), 1);
  canvas.triangle({Place{a, b, depth}, {c, d, depth}, {a, d, depth}}, all, black_to_red(), 1);
}

TEST(Canvas, FillsExactlyThePixelsOfARectangle) {
  Canvas canvas(30, 20);
  rectangle(canvas, 4, 3, 17, 11, 0, 1);
  auto const picture = canvas.picture();
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x) {
      bool const inside = x >= 4 && x < 17 && y >= 3 && y < 11;
      EXPECT_EQ(pixel(picture, x, y), (inside ? std::array{252, 0, 0, 255} : clear)) << x << " " << y;
    }
}

TEST(Canvas, CoversPixelsOfAnEdgeInPart) {
  Canvas canvas(8, 8);
  rectangle(canvas, 2, 2, 5.5, 6, 0, 1);
  auto const picture = canvas.picture();
  EXPECT_EQ(pixel(picture, 4, 3)[3], 255);
  EXPECT_EQ(pixel(picture, 5, 3), (std::array{252, 0, 0, 128}));
  EXPECT_EQ(pixel(picture, 6, 3), clear);
}

TEST(Canvas, ShowsWhatIsInFrontWhateverComesFirst) {
  for (bool const back_first : {true, false}) {
    Canvas canvas(10, 10);
    for (bool const back : {back_first, !back_first}) rectangle(canvas, 1, 1, 9, 9, back ? -1 : 2, back ? 0 : 1);
    EXPECT_EQ(pixel(canvas.picture(), 5, 5), (std::array{252, 0, 0, 255}));
  }
}

TEST(Canvas, ColoursGoEvenlyFromCornerToCorner) {
  Canvas canvas(256, 4);
  canvas.triangle({Place{0, -300, 0}, {256, -300, 0}, {128, 900, 0}}, {0, 1, 0.5}, black_to_red(), 1);
  auto const picture = canvas.picture();
  for (int const x : {64, 128, 192}) EXPECT_NEAR(pixel(picture, x, 1)[0], 252.0 * x / 256, 4);
}

TEST(Canvas, DrawsLinesThatLeaveIt) {
  Canvas canvas(12, 12);
  canvas.line({-1e6, 6, 0}, {1e6, 6, 0}, {10, 20, 30, 1}, 1);
  auto const picture = canvas.picture();
  for (int x = 0; x < 12; ++x) EXPECT_GT(pixel(picture, x, 5)[3] + pixel(picture, x, 6)[3], 200) << x;
  EXPECT_EQ(pixel(picture, 3, 2), clear);
}

TEST(Canvas, TakesPlacesThatAreNoNumbers) {
  Canvas canvas(6, 6);
  double const nan = std::nan("");
  canvas.triangle({Place{nan, 0, 0}, {5, 0, 0}, {0, 5, 0}}, {1, 1, 1}, black_to_red(), 1);
  canvas.line({0, 0, 0}, {nan, 5, 0}, {0, 0, 0, 1}, 1);
  canvas.triangle({Place{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, {nan, nan, nan}, black_to_red(), 1);
  EXPECT_EQ(pixel(canvas.picture(), 1, 1), (std::array{0, 0, 0, 255}));
}

}  // namespace
}  // namespace gridmorph::page
