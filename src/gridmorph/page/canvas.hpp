// A picture that is drawn on: triangles with a depth, and lines; each pixel is four samples.
#pragma once

#include <gridmorph/io/png.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph::page {

using kernels::Vec3;

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  double opacity = 1;
};

/// A scale of colours from 0 to 1.
class ColourScale {
 public:
  /// Evenly spaced stops.
  explicit ColourScale(std::span<Colour const> stops);
  [[nodiscard]] Colour at(double share) const {
    double const n = share * 255;
    return table_[n > 0 ? (n < 255 ? std::size_t(n) : 255) : 0];  // what is no number is at the beginning
  }

 private:
  std::array<Colour, 256> table_;
};

/// From where nothing moves, grey, to where most does.
ColourScale const& displacement_colours();
/// From inverted, red, to good, grey: cells of a section.
ColourScale const& quality_colours();

/// x to the right and y down in pixels; z: depth, what is larger is in front.
using Place = Vec3;

class Canvas {
 public:
  Canvas(int width, int height);

  /// A triangle with a share of the scale at each corner, its colours times `light`. Hides what lies behind it. Cost:
  /// its samples.
  void triangle(std::array<Place, 3> const& corner, std::array<double, 3> const& share, ColourScale const& scale,
                double light);
  /// A convex polygon of one colour over what is there, whatever its depth.
  void polygon(std::span<Place const> corners, Colour const& colour);
  /// A line, `width` pixels wide. `behind`: also where triangles hide it.
  void line(Place const& a, Place const& b, Colour const& colour, double width, bool behind = true);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] io::Picture picture() const;

 private:
  struct Sample {
    float depth = 0;
    std::uint8_t red = 0, green = 0, blue = 0, opacity = 0;
  };
  class OverOpaque;
  static constexpr int fine = 2;  ///< samples along the side of a pixel

  template <class Paint>
  void fill(std::array<Place, 3> const& corner, Paint const& paint);
  static void cover(Sample& sample, Colour const& colour);
  static void set_pixel(Sample const* upper, Sample const* lower, std::uint8_t* pixel);

  int width_, height_;
  std::vector<Sample> samples_;
};

}  // namespace gridmorph::page
