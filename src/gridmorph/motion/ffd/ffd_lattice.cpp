#include <gridmorph/motion/ffd/ffd_lattice.hpp>

namespace gridmorph {

namespace {

constexpr double box_inside = 1e-9;  ///< of the edges of a box

/// Puts a place back onto the faces of the lattice that round-off has taken it off.
Vec3 onto_faces(Vec3 place) {
  for (double* s : {&place.x, &place.y, &place.z}) *s = *s < 1e-12 ? 0.0 : *s > 1 - 1e-12 ? 1.0 : *s;
  return place;
}

BSplineBasis basis_of(FfdRule const& rule, std::size_t a) { return {rule.counts[a], rule.degree[a]}; }

}  // namespace

FfdLattice::FfdLattice(FfdRule const& rule, std::string const& name)
    : basis_{basis_of(rule, 0), basis_of(rule, 1), basis_of(rule, 2)} {
  if (!rule.box) {
    inverse_ = std::make_shared<LatticeInverse const>(basis_, rule.points, name);
    return;
  }
  box_ = *rule.box;
  auto const& e = box_.edges;
  double const volume = dot(cross(e[0], e[1]), e[2]);
  dual_ = {(1 / volume) * cross(e[1], e[2]), (1 / volume) * cross(e[2], e[0]), (1 / volume) * cross(e[0], e[1])};
}

std::optional<Vec3> FfdLattice::place(Vec3 const& point) const {
  if (inverse_) {
    auto const found = inverse_->place(point);
    return found ? std::optional(onto_faces(*found)) : std::nullopt;
  }
  Vec3 const arm = point - box_.origin;
  Vec3 place{dot(dual_[0], arm), dot(dual_[1], arm), dot(dual_[2], arm)};
  for (double const s : {place.x, place.y, place.z})
    if (!(s >= -box_inside && s <= 1 + box_inside)) return std::nullopt;
  return onto_faces(place);
}

Vec3 FfdLattice::control_point(int i, int j, int k) const {
  if (inverse_)
    return inverse_->points()[std::size_t(i) + std::size_t(basis_[0].count()) *
                                                   (std::size_t(j) + std::size_t(basis_[1].count()) * std::size_t(k))];
  return box_.origin + basis_[0].place(i) * box_.edges[0] + basis_[1].place(j) * box_.edges[1] +
         basis_[2].place(k) * box_.edges[2];
}

Vec3 FfdLattice::step(Vec3 const& place, Vec3 const& step) const {
  if (inverse_) return inverse_->step(place, step);
  return {dot(dual_[0], step), dot(dual_[1], step), dot(dual_[2], step)};
}

}  // namespace gridmorph
