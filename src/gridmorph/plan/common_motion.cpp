#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/plan/common_motion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

using Row = std::array<double, 12>;

double product(Row const& a, Row const& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

/// An orthonormal basis of what A may not do.
class Forbidden {
 public:
  /// Adds what a row has beyond the basis: that is taken off twice, so that what is left is orthogonal to round-off.
  /// What repeats the others but for the noise of a mesh is left out.
  void add(Row row) {
    constexpr double repeated = 1e-6;
    double const length = std::sqrt(product(row, row));
    if (!(length > 0)) return;
    for (double& r : row) r /= length;
    for (int pass = 0; pass < 2; ++pass)
      for (Row const& b : basis_) {
        double const along = product(row, b);
        for (std::size_t c = 0; c < row.size(); ++c) row[c] -= along * b[c];
      }
    double const left = std::sqrt(product(row, row));
    if (left < repeated) return;
    for (double& r : row) r /= left;
    basis_.push_back(row);
  }
  /// Adds the row of a linear function of the coefficients a_i of A: its values for each of them being one.
  template <class Function>
  void add_function(Function const& function) {
    Row row{};
    for (std::size_t k = 0; k < row.size(); ++k) {
      kernels::CommonMap unit;
      Vec3& a = unit.a[k / 3];
      (k % 3 == 0 ? a.x : k % 3 == 1 ? a.y : a.z) = 1;
      row[k] = function(unit);
    }
    add(row);
  }
  /// I less the projection onto the basis.
  [[nodiscard]] kernels::CommonProjection projection() const {
    kernels::CommonProjection out{};
    for (std::size_t r = 0; r < 12; ++r)
      for (std::size_t c = 0; c < 12; ++c) {
        out.p[r][c] = r == c ? 1 : 0;
        for (Row const& b : basis_) out.p[r][c] -= b[r] * b[c];
      }
    return out;
  }

 private:
  std::vector<Row> basis_;
};

}  // namespace

kernels::CommonMap CommonMotion::fit(std::span<Vec3 const> displacement) const {
  kernels::CommonMap moments;
  for (std::size_t k = 0; k < position.size(); ++k) moments.add(frame, position[k], weight[k] * displacement[k]);
  return projection * moments;
}

CommonMotion::Reach CommonMotion::reach(std::span<Vec3 const> displacement) const {
  auto const map = fit(displacement);
  Reach out;
  for (std::size_t k = 0; k < position.size(); ++k) {
    Vec3 const here = map(frame, position[k]);
    out.linear = std::max(out.linear, norm(here - map.a[0]));
    out.rest = std::max(out.rest, norm(displacement[k] - here));
  }
  return out;
}

bool CommonMotion::is_common(std::span<Vec3 const> displacement) const {
  constexpr double most_rest = 0.1, rounding = 1e-12;
  double largest = 0;
  for (Vec3 const& u : displacement) largest = std::max(largest, norm(u));
  Reach const is = reach(displacement);
  return is.linear > rounding * largest && is.rest <= most_rest * is.linear;
}

CommonMotion common_motion(std::vector<Vec3> position, std::vector<double> area, CommonLimits const& limits) {
  CommonMotion out;
  out.position = std::move(position);
  out.weight = std::move(area);
  double const sum = std::accumulate(out.weight.begin(), out.weight.end(), 0.0);
  for (double& w : out.weight) w /= sum;
  Vec3& centre = out.frame.centre;
  for (std::size_t k = 0; k < out.position.size(); ++k) centre += out.weight[k] * out.position[k];
  Moments moments;
  for (std::size_t k = 0; k < out.position.size(); ++k) moments.add(out.weight[k], out.position[k] - centre);
  PrincipalAxes const axes(moments);
  constexpr double flat = 1e-18;  // of the square of the largest extent
  Forbidden forbidden;
  std::array<Vec3, 4> place{centre, centre, centre, centre};
  for (int i = 0; i < 3; ++i) {
    double const moment = axes.moment[i];
    Vec3 const direction = axes.direction[i];
    if (moment > flat * axes.moment[0]) {
      out.frame.axis[i] = (1 / std::sqrt(moment)) * direction;
      place[i + 1] = centre + std::sqrt(moment) * direction;
    } else {
      for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        forbidden.add_function([&](kernels::CommonMap const& map) { return dot(e, map.a[i + 1]); });
    }
  }
  for (auto const& plane : limits.planes)
    for (Vec3 const& x : place) {
      Vec3 const on = x - dot(x - plane.origin, plane.normal) * plane.normal;
      forbidden.add_function([&](kernels::CommonMap const& map) { return dot(plane.normal, map(out.frame, on)); });
    }
  auto copies = limits.copies;
  for (Axis const& axis : limits.axes) copies.push_back(rotation_about(axis.origin, axis.direction, 1));
  for (RigidTransform const& copy : copies)
    for (Vec3 const& x : place)
      for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        forbidden.add_function([&](kernels::CommonMap const& map) {
          return dot(e, map(out.frame, copy(x)) - copy.rotation * map(out.frame, x));
        });
  out.projection = forbidden.projection();
  return out;
}

}  // namespace gridmorph
