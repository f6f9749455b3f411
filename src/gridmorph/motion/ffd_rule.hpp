// The rule `ffd`: free-form deformation by a lattice of control points (Sederberg and Parry 1986). Plain values.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// A parallelepiped: x = origin + s edges[0] + t edges[1] + w edges[2] with s, t, w from 0 to 1.
struct FfdBox {
  Vec3 origin;
  std::array<Vec3, 3> edges{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};

/// The nodes of the patches inside a lattice of control points move with them,
///
///   u(x) = share * sum_ijk B_i(s) B_j(t) B_k(w) d_ijk,
///
/// with B clamped B-splines over uniform knots and (s, t, w) the place of x in the lattice as it stands: u is linear in
/// d. Nodes outside of the lattice stay. docs/motion.md has the rest.
struct FfdRule {
  static constexpr int most_degree = 24;

  std::string description{};           ///< for reports: "ffd 8 x 3 x 2"
  std::array<int, 3> counts{2, 2, 2};  ///< control points along i, j, k
  std::array<int, 3> degree{1, 1, 1};  ///< from 0 to counts - 1, which makes Bernstein polynomials
  std::vector<Vec3> displacement{};    ///< d, one for each control point, i fastest
  double share = 1;                    ///< of all displacements
  std::optional<FfdBox> box{};         ///< of three edges that span a volume
  /// Positions of the control points, i fastest, for lattices that are no box; the place of a node in them is found by
  /// Newton's method.
  std::vector<Vec3> points{};
  /// The margin of the lattice where neither box nor points are given: a box along the coordinates around the nodes of
  /// the patches is wider on each side by so much of its length.
  double margin = 0.05;
  /// The number of continuous derivatives, 0 to 2, with which the motion ends at faces of the lattice through which the
  /// patches run out of it: the displacement of continuity + 1 layers of control points there must be zero.
  int continuity = 1;
  /// Faces, i-min, i-max, j-min, ..., at which no layers are held, whether patches run through or not.
  std::array<bool, 6> open{};

  [[nodiscard]] std::size_t size() const {
    return std::size_t(counts[0]) * std::size_t(counts[1]) * std::size_t(counts[2]);
  }
  /// Number of control point (i, j, k), counted from 0.
  [[nodiscard]] std::size_t number(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(counts[0]) * (std::size_t(j) + std::size_t(counts[1]) * std::size_t(k));
  }
};

}  // namespace gridmorph
