// Evaluates motion rules on the boundary: the displacement of its nodes from rules, before the volume stage.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/target_reach.hpp>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

class CylindricalFrame;
class FfdMotion;

/// resolve() (motion/motion.hpp) of what has names alone.
ResolvedMotion resolve(NamedBoundary const& boundary, Motion const& motion);

/// Turns resolved rules into numbers. Construction does what is shared between nodes (blade sections and mid-camber
/// motion for slide and follow, profiles for slip); evaluation is then independent per point.
///
/// Cost: O(nodes of the patches involved) to construct, O(log n) per point to evaluate.
class BoundaryMotion {
 public:
  BoundaryMotion(std::shared_ptr<Boundary const> boundary, ResolvedMotion const& motion);
  /// The motion of the boundary of a mesh of blocks.
  BoundaryMotion(Mesh const& mesh, ResolvedMotion const& motion);
  ~BoundaryMotion();
  BoundaryMotion(BoundaryMotion&&) noexcept;
  BoundaryMotion& operator=(BoundaryMotion&&) noexcept;

  /// The motion by the same rules for the same patches at another time, when they displace by something else. Slip
  /// surfaces and the places of nodes on targets are shared; slides and followers take over the blade's motion as it is
  /// then.
  [[nodiscard]] BoundaryMotion with(Motion const& motion) const;

  [[nodiscard]] Boundary const& boundary() const;
  [[nodiscard]] std::shared_ptr<Boundary const> const& shared_boundary() const;
  [[nodiscard]] ResolvedMotion const& motion() const;

  /// Whether rule number r (in ResolvedMotion::rules) fixes displacements before the volume stage (fixed, rigid,
  /// function, sections, target, inflate, ffd, extend, circumferential-slide, follow, attached, carry, wake,
  /// prescribed).
  [[nodiscard]] bool is_explicit(int rule) const;

  /// Displacement that rule number r gives to baseline points; zero where the caller prescribes it. Throws MotionError
  /// (rule, point and value) when a displacement is not finite. Precondition: is_explicit(r).
  void displacement(int rule, std::span<Vec3 const> points, std::span<Vec3> out) const;

  /// The surfaces that slip (or constrained free) rules keep nodes on, each once.
  [[nodiscard]] std::vector<SlipSurface> const& slip_surfaces() const;
  /// Number in slip_surfaces() of that of patch p; -1 for other rules. Patches of elements may lie on several: this is
  /// one of them.
  [[nodiscard]] int slip_surface_of(int patch) const;
  /// Calls visit(number in slip_surfaces(), nodes) for each surface of patch p with its nodes on it; nodes where two
  /// meet come with both.
  void each_slip_surface(int patch, std::function<void(int, std::vector<Index> const&)> const& visit) const;
  /// The surface with the number slip_surface_of(patch), or null.
  [[nodiscard]] SlipSurface const* slip_surface(int patch) const;

  /// Whether a point lies upstream of the middle of the blade that circumferential-slide rule number r names.
  [[nodiscard]] bool slides_upstream(int rule, Vec3 const& point) const;

  /// The frame of the row whose blade rule number r follows or slides with; null for other rules.
  [[nodiscard]] CylindricalFrame const* row_frame(int rule) const;

  /// Whether what rule number r gives to nodes of a patch is the rule of that patch, seen through sections cut from its
  /// facets: the patch's own rule says it better.
  [[nodiscard]] bool gives_way(int rule, int patch) const;

  /// The lattice of rule number r, an ffd rule; null for others.
  [[nodiscard]] FfdMotion const* lattice(int rule) const;
  /// Whether rule number r alone displaces its points: no blades are extended to them, and no features carried on them.
  [[nodiscard]] bool alone(int rule) const;

  /// How far the nodes of each target rule ended from their target; rules in order, without those that go a share of
  /// the way only.
  [[nodiscard]] std::vector<TargetReach> target_reach(Coordinates const& morphed) const;

  /// Human-readable facts found on the way: blade sections, span range, profile deviation, mapping distances.
  [[nodiscard]] std::vector<std::string> const& notes() const;

 private:
  struct Impl;
  explicit BoundaryMotion(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gridmorph
