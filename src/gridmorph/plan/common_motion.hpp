// The motion that all boundaries of a part of a mesh have in common: which affine displacements the part may make, and
// the fit among them.
//
// docs/algorithms/common_motion.md has the formulas; kernels/common_motion.hpp applies them.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/common_motion.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// What the affine displacement A of a part must leave as it is.
struct CommonLimits {
  struct Plane {
    Vec3 origin, normal;  ///< unit
  };
  std::vector<Plane> planes;  ///< A takes them into themselves: nodes slide on them
  std::vector<Axis> axes;     ///< A is the same for all angles about them: nodes slide on surfaces of revolution
  std::vector<RigidTransform> copies;  ///< A(T x) = R A(x): nodes are periodic copies
};

/// The fit by least squares, weighted by area, of a displacement affine in space to what the boundary nodes of a part
/// are given.
struct CommonMotion {
  kernels::CommonFrame frame{};
  kernels::CommonProjection projection{};
  std::vector<Vec3> position;  ///< per boundary node of the part
  std::vector<double> weight;  ///< likewise; they add up to one

  /// `position`, for kernels on the host; valid while this lives unchanged.
  [[nodiscard]] Kokkos::View<Vec3 const*, Kokkos::HostSpace> view() const {
    return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(position.data(), position.size());
  }
  /// The fit: of all displacements within the limits the one nearest to `displacement`.
  [[nodiscard]] kernels::CommonMap fit(std::span<Vec3 const> displacement) const;
  /// Largest |A(x) - A(centre)|, and largest |u - A(x)|, at the boundary nodes.
  struct Reach {
    double linear = 0, rest = 0;
  };
  [[nodiscard]] Reach reach(std::span<Vec3 const> displacement) const;
  /// Whether nearly all of what tells the displacements apart is one affine motion: the rest is below a tenth of it. A
  /// shift alone is none: every stage keeps that to the last bit but rounding.
  [[nodiscard]] bool is_common(std::span<Vec3 const> displacement) const;
};

/// The fit for nodes at some places. Nodes that lie on a line or in a plane say nothing of what is across it: A does
/// not change along that direction. area: of each node, any unit. Cost O(nodes + limits).
CommonMotion common_motion(std::vector<Vec3> position, std::vector<double> area, CommonLimits const& limits);

}  // namespace gridmorph
