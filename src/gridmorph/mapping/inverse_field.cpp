#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mapping/inverse_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Iterations over which a residual has to get smaller.
constexpr int stride = 8;

/// Share of the largest displacement by which it may jump between elements.
constexpr double largest_jump = 0.01;

/// A position whose residual does not get smaller any more.
struct Stuck {
  std::size_t node = 0;
  Vec3 x, place;  ///< the position, and the last iterate
  int iterations = 0;
  double residual = 0, earlier = 0;
  // On the elements of one iterate after the other.
  Vec3 anchor{}, at{};
  double held_earlier = 0;
  Vec3 found{};
  double found_residual = std::numeric_limits<double>::infinity();  ///< without holding
};

/// Holds u on the elements of iterates that go to and fro between some.
class HeldIterations {
 public:
  HeldIterations(InverseField::Field const& u, InverseField::HeldField const& held, double share, double tolerance,
                 double jump, int most)
      : u_(u), held_(held), share_(share), tolerance_(tolerance), jump_(jump), most_(most) {}

  void run(std::vector<Stuck>& all) const {
    std::vector<Stuck*> open;
    for (Stuck& s : all) open.push_back(&s);
    for (int iterate = 0; iterate < stride && !open.empty(); ++iterate) {
      for (Stuck* s : open) s->anchor = s->at = s->place;
      take_best(iterate_on_elements(open));
      std::erase_if(open, [&](Stuck const* s) { return s->found_residual <= tolerance_; });
      auto const residuals = free_residuals(open, &Stuck::place);
      for (std::size_t n = 0; n < open.size(); ++n) open[n]->place = open[n]->place - residuals[n];
    }
  }

 private:
  /// Iterates on single elements; returns those positions that got there.
  [[nodiscard]] std::vector<Stuck*> iterate_on_elements(std::vector<Stuck*> open) const {
    std::vector<Stuck*> there;
    for (int k = 0; k < most_ && !open.empty(); ++k) {
      auto const residuals = held_residuals(open);
      std::size_t left = 0;
      for (std::size_t n = 0; n < open.size(); ++n) {
        Stuck& s = *open[n];
        double const size = norm(residuals[n]);
        if (size <= tolerance_) {
          there.push_back(&s);
          continue;
        }
        if (k > 0 && k % stride == 0 && !(size < s.held_earlier)) continue;
        if (k % stride == 0) s.held_earlier = size;
        s.at = s.at - residuals[n];
        open[left++] = &s;
      }
      open.resize(left);
    }
    return there;
  }

  void take_best(std::vector<Stuck*> const& there) const {
    auto const residuals = free_residuals(there, &Stuck::at);
    for (std::size_t n = 0; n < there.size(); ++n) {
      Stuck& s = *there[n];
      double const size = norm(residuals[n]);
      if (size > std::max(tolerance_, jump_) || size >= s.found_residual) continue;
      s.found = s.at;
      s.found_residual = size;
    }
  }

  [[nodiscard]] std::vector<Vec3> free_residuals(std::vector<Stuck*> const& of, Vec3 Stuck::*at) const {
    std::vector<Vec3> places, out(of.size());
    for (Stuck const* s : of) places.push_back(s->*at);
    u_(places, out, true);
    for (std::size_t n = 0; n < of.size(); ++n) out[n] = places[n] - of[n]->x + share_ * out[n];
    return out;
  }
  [[nodiscard]] std::vector<Vec3> held_residuals(std::vector<Stuck*> const& of) const {
    std::vector<Vec3> places, anchors, out(of.size());
    for (Stuck const* s : of) {
      places.push_back(s->at);
      anchors.push_back(s->anchor);
    }
    held_(places, anchors, out);
    for (std::size_t n = 0; n < of.size(); ++n) out[n] = places[n] - of[n]->x + share_ * out[n];
    return out;
  }

  InverseField::Field const& u_;
  InverseField::HeldField const& held_;
  double share_, tolerance_, jump_;
  int most_;
};

}  // namespace

InverseField::InverseField(std::string source, double tolerance, int most_iterations)
    : source_(std::move(source)), tolerance_(tolerance), most_(most_iterations) {}

void InverseField::operator()(Field const& u, double share, std::span<Vec3 const> points, std::span<Vec3> displacement,
                              HeldField const& held) const {
  InverseReport here;
  here.evaluated = Index(points.size());
  std::vector<std::size_t> open(points.size());  // positions that are not there yet
  for (std::size_t n = 0; n < open.size(); ++n) open[n] = n;
  std::vector<Vec3> place(points.begin(), points.end()), field(points.size());
  std::vector<double> earlier(points.size());
  std::vector<Stuck> wandering;
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
      if (stuck || k >= most_) {
        here.iterations = std::max(here.iterations, k);
        wandering.push_back({n, x, place[o], k, size, stuck ? earlier[o] : 0});
        continue;
      }
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
  if (held && !wandering.empty()) {
    double largest = 0;
    for (Stuck const& s : wandering) displacement[s.node] = s.place - s.x;
    for (Vec3 const& d : displacement) largest = std::max(largest, norm(d));
    HeldIterations(u, held, share, tolerance_, largest_jump * largest, most_).run(wandering);
  }
  for (Stuck const& s : wandering) {
    if (!(s.found_residual < std::numeric_limits<double>::infinity())) refuse(s.x, s.residual, s.iterations, s.earlier);
    displacement[s.node] = s.found - s.x;
    ++here.held;
    double& largest = s.found_residual <= tolerance_ ? here.residual : here.jump;
    largest = std::max(largest, s.found_residual);
  }
  std::lock_guard const lock(turn_);
  report_.evaluated += here.evaluated;
  report_.iterations = std::max(report_.iterations, here.iterations);
  report_.residual = std::max(report_.residual, here.residual);
  report_.held += here.held;
  report_.jump = std::max(report_.jump, here.jump);
  if (here.one_step > report_.one_step) {
    report_.one_step = here.one_step;
    report_.worst_of_one_step = here.worst_of_one_step;
  }
}

void InverseField::refuse(Vec3 const& x, double residual, int iterations, double earlier) const {
  throw MotionError(fmt::format(
      "{}: no place X with X + u(X) = x is found for the node at {}: |X + u(X) - x| is {:.3g} after {} iterations "
      "(tolerance {:.3g}){}",
      source_, to_text(x, 9), residual, iterations, tolerance_,
      earlier > 0 ? fmt::format(", and was {:.3g} {} iterations before: the displacement changes by as much as the "
                                "distance does; check length_scale and factor, or go there in parts by amplitude",
                                earlier, stride)
                  : "; raise inverse_iterations or inverse_tolerance"));
}

InverseReport InverseField::report() const {
  std::lock_guard const lock(turn_);
  return report_;
}

}  // namespace gridmorph
