// Evaluates motion rules on the surface: the displacement of boundary nodes from rules, before the volume stage.
#pragma once

#include <gridmorph/boundary/patch_faces.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/target_reach.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

/// Turns resolved rules into numbers. Construction does what is shared between nodes (blade sections and mid-camber
/// motion for slide and follow, profiles for slip); evaluation is then independent per point.
///
/// Cost: O(nodes of the patches involved) to construct, O(log n) per point to evaluate.
class SurfaceMotion {
 public:
  /// `faces`: of patches with a target that are no grids but the outline of an unstructured mesh; read here only.
  SurfaceMotion(Mesh const& mesh, ResolvedMotion const& motion, PatchFaces const* faces = nullptr);
  ~SurfaceMotion();
  SurfaceMotion(SurfaceMotion&&) noexcept;
  SurfaceMotion& operator=(SurfaceMotion&&) noexcept;

  /// Whether rule number r (in ResolvedMotion::rules) fixes displacements before the volume stage (fixed, rigid,
  /// function, sections, target, circumferential-slide, follow).
  [[nodiscard]] bool is_explicit(int rule) const;

  /// Displacement that rule number r gives to baseline points. Throws MotionError (rule, point and value) when a
  /// displacement is not finite. Precondition: is_explicit(r).
  void displacement(int rule, std::span<Vec3 const> points, std::span<Vec3> out) const;

  /// The surface a slip (or constrained free) rule keeps the nodes of patch p on; nothing for other rules.
  [[nodiscard]] std::optional<SlipSurface> slip_surface(int patch) const;

  /// The number of that surface, the same for patches that share it; -1 for other rules.
  [[nodiscard]] int slip_surface_number(int patch) const;

  /// Whether a point lies upstream of the middle of the blade that circumferential-slide rule number r names.
  [[nodiscard]] bool slides_upstream(int rule, Vec3 const& point) const;

  /// How far the nodes of each target rule ended from their target, measured on the morphed mesh; rules in order, without those
  /// that go a share of the way only.
  [[nodiscard]] std::vector<TargetReach> target_reach(Mesh const& mesh, Coordinates const& morphed) const;

  /// Human-readable facts found on the way: blade sections, span range, profile deviation, mapping distances.
  [[nodiscard]] std::vector<std::string> const& notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gridmorph
