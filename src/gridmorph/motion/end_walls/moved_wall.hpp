// An end wall and where its rule takes it, as blades that are extended to it see it.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The patches of one rule, and the displacement that it gives to their nodes.
class MovedWall {
 public:
  using Displacement = std::function<void(std::span<Vec3 const> points, std::span<Vec3> out)>;

  /// `anywhere`: the displacement is known beside the nodes too. Throws MotionError, beginning with `name`, where there
  /// are no faces.
  MovedWall(Boundary const& boundary, std::vector<int> patches, Displacement displacement, bool anywhere,
            std::string const& name);

  [[nodiscard]] std::vector<int> const& patches() const { return patches_; }
  [[nodiscard]] PatchSurface const& surface() const { return surface_; }
  /// The displacement of each vertex.
  [[nodiscard]] std::vector<Vec3> const& displacement() const { return displacement_; }
  /// Whether any vertex moves.
  [[nodiscard]] bool moves() const;
  /// Whether the baseline has a node of the wall there.
  [[nodiscard]] bool has(Vec3 const& point) const { return surface_.numbers.find(point) >= 0; }
  /// The facets as they are moved, and their copies across the periodic connections that they touch.
  [[nodiscard]] TargetTree const& moved() const { return moved_; }
  /// Where vertex v goes if it is first moved along the wall by `shift`: its own place for no shift.
  [[nodiscard]] Vec3 displaced(int v, Vec3 const& shift) const;
  /// The shift with which vertex v goes by u: displaced(v, shift_to(v, u)) = u, by fixed-point iteration. Throws
  /// MotionError, beginning with `name`, where the wall's displacement changes too fast from place to place for that.
  [[nodiscard]] Vec3 shift_to(int v, Vec3 const& u, std::string const& name) const;

 private:
  [[nodiscard]] Vec3 at(Vec3 const& point) const;

  std::vector<int> patches_;
  Displacement rule_;
  bool anywhere_;
  PatchSurface surface_;
  std::vector<Vec3> displacement_;
  TargetTree moved_;
};

}  // namespace gridmorph
