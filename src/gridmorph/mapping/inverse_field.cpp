#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mapping/inverse_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Iterations over which a residual has to get smaller.
constexpr int stride = 8;

}  // namespace

InverseField::InverseField(std::string source, double tolerance, int most_iterations)
    : source_(std::move(source)), tolerance_(tolerance), most_(most_iterations) {}

void InverseField::operator()(Field const& u, double share, std::span<Vec3 const> points,
                              std::span<Vec3> displacement) const {
  InverseReport here;
  here.evaluated = Index(points.size());
  std::vector<std::size_t> open(points.size());  // positions that are not there yet
  for (std::size_t n = 0; n < open.size(); ++n) open[n] = n;
  std::vector<Vec3> place(points.begin(), points.end()), field(points.size());
  std::vector<double> earlier(points.size());
  for (int k = 0; !open.empty(); ++k) {
    u(place, field, k > 0);
    std::size_t left = 0;
    for (std::size_t o = 0; o < open.size(); ++o) {
      std::size_t const n = open[o];
      Vec3 const x = points[n], residual = place[o] - x + share * field[o];
      double const size = norm(residual);
      if (k == 1 && size > here.one_step) {
        here.one_step = size;
        here.worst_of_one_step = x;
      }
      if (size <= tolerance_) {
        displacement[n] = place[o] - x;
        here.residual = std::max(here.residual, size);
        here.iterations = std::max(here.iterations, k);
        continue;
      }
      bool const stuck = k > 0 && k % stride == 0 && !(size < earlier[o]);
      if (stuck || k >= most_)
        throw MotionError(fmt::format(
            "{}: no place X with X + u(X) = x is found for the node at {}: |X + u(X) - x| is {:.3g} after {} "
            "iterations "
            "(tolerance {:.3g}){}",
            source_, to_text(x, 9), size, k, tolerance_,
            stuck ? fmt::format(", and was {:.3g} {} iterations before: the displacement changes by as much as the "
                                "distance does; check length_scale and factor, or go there in parts by amplitude",
                                earlier[o], stride)
                  : "; raise inverse_iterations or inverse_tolerance"));
      open[left] = n;
      place[left] = place[o] - residual;
      earlier[left] = k % stride == 0 ? size : earlier[o];
      ++left;
    }
    open.resize(left);
    place.resize(left);
    field.resize(left);
    earlier.resize(left);
  }
  std::lock_guard const lock(turn_);
  report_.evaluated += here.evaluated;
  report_.iterations = std::max(report_.iterations, here.iterations);
  report_.residual = std::max(report_.residual, here.residual);
  if (here.one_step > report_.one_step) {
    report_.one_step = here.one_step;
    report_.worst_of_one_step = here.worst_of_one_step;
  }
}

InverseReport InverseField::report() const {
  std::lock_guard const lock(turn_);
  return report_;
}

}  // namespace gridmorph
