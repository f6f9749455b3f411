#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/detail/joint_slip.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gridmorph::detail {

namespace {

constexpr double same_surface = 0.01;  // rad; surfaces that meet at less count as one, as in slip_edge.hpp

/// The axes of rotations by more than an angle, each once.
std::vector<Vec3> axes_of(std::span<Mat3 const> rotations, double more_than) {
  constexpr double parallel = 1e-6;
  std::vector<Vec3> out;
  for (Mat3 const& r : rotations) {
    Vec3 const turn = rotation_vector(r);
    double const angle = norm(turn);
    if (!(angle > more_than)) continue;
    Vec3 const axis = (1 / angle) * turn;
    if (std::none_of(out.begin(), out.end(), [&](Vec3 const& a) { return norm(cross(a, axis)) < parallel; }))
      out.push_back(axis);
  }
  return out;
}

/// Two unit vectors across a third.
std::array<Vec3, 2> across_of(Vec3 const& axis) {
  Vec3 const other = std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 const a = cross(axis, other), first = (1 / norm(a)) * a, b = cross(axis, first);
  return {first, (1 / norm(b)) * b};
}

}  // namespace

double RotationNumbers::least_angle() const {
  double least = std::numbers::pi;
  for (Mat3 const& r : rotations_)
    if (double const angle = norm(rotation_vector(r)); angle > 0) least = std::min(least, angle);
  return least;
}

std::int32_t RotationNumbers::then(std::int32_t first, std::int32_t next) {
  if (first < 0) return next;
  if (next < 0) return first;
  auto const [at, fresh] = composed_.try_emplace({first, next}, std::int32_t(rotations_.size()));
  if (fresh) rotations_.push_back(rotations_[next] * rotations_[first]);
  return at->second;
}

std::int32_t RotationNumbers::back(std::int32_t number) {
  if (number < 0) return number;
  auto const [at, fresh] = inverse_.try_emplace(number, std::int32_t(rotations_.size()));
  if (fresh) rotations_.push_back(transpose(rotations_[number]));
  return at->second;
}

void JointSlipFinder::add(std::vector<ClassMember> const& members, std::size_t k, std::span<Mat3 const> around,
                          Index32 of, JointSlip& to) {
  std::vector<Held> all;
  auto const add_surfaces = [&](std::size_t m) {
    ClassMember const& member = members[m];
    for (Index32 const s : surfaces_of_(member.node)) {
      if (!has_a_way_back(s, member.node)) continue;
      Held const now =
          held(s, member.node, m == k ? -1 : rotations_.then(rotations_.back(members[k].turned), member.turned));
      // A surface that goes on behind the periodic side holds both nodes in one way.
      bool const known = m != k && std::any_of(all.begin(), all.end(), [&](Held const& h) {
                           return norm(cross(h.across, now.across)) < same_surface;
                         });
      if (!known) all.push_back(now);
    }
  };
  add_surfaces(k);
  for (std::size_t m = 0; m < members.size(); ++m)
    if (m != k) add_surfaces(m);
  auto const axes = axes_of(around, least_turn_);
  if (axes.size() == 1)
    for (Vec3 const& direction : across_of(axes.front())) all.push_back({across(direction), members[k].node, -1, {}});
  if (axes.size() > 1)
    for (Vec3 const& direction : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      all.push_back({across(direction), members[k].node, -1, {}});
  if (all.empty()) return;
  to.of.push_back(of);
  for (Held const& h : all) {
    to.surface.push_back(h.surface);
    to.place.push_back(h.place);
    to.turned.push_back(h.turned);
  }
  to.first.push_back(Index(to.surface.size()));
}

JointSlipFinder::Held JointSlipFinder::held(Index32 surface, Index32 node, std::int32_t turned) const {
  auto const view = surfaces_[surface].view();
  Vec3 gradient;
  (void)view.excess(x_[node], view.own_offset(x_[node]), {}, gradient);
  Vec3 const own = turned < 0 ? gradient : transpose(rotations_[turned]) * gradient;
  return {surface, node, turned, (1 / norm(own)) * own};
}

/// A surface of revolution knows no way back for nodes on its axis, but where it lies across it.
bool JointSlipFinder::has_a_way_back(Index32 surface, Index32 node) const {
  constexpr double on_axis = 1e-12;
  SlipSurface const& s = surfaces_[surface];
  bool const turns = s.kind == SlipKind::revolution || (s.kind == SlipKind::meridional && s.frame.cosine != 0);
  return !turns || norm(cross(x_[node] - s.origin, s.direction)) > on_axis * size_;
}

Index32 JointSlipFinder::across(Vec3 const& direction) {
  constexpr double same = 1e-14;
  auto const known = std::find_if(across_axes_.begin(), across_axes_.end(),
                                  [&](SlipSurface const& s) { return distance(s.direction, direction) < same; });
  auto const number = Index32(surfaces_.size()) + Index32(known - across_axes_.begin());
  if (known == across_axes_.end()) {
    SlipSurface axial;
    axial.kind = SlipKind::axial;
    axial.direction = direction;
    axial.size = size_;
    across_axes_.push_back(std::move(axial));
  }
  return number;
}

}  // namespace gridmorph::detail
