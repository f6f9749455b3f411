// The motion of a wheel whose passages have blades of their own: one plan, boundary displacements per passage.
#pragma once

#include <gridmorph/plan/make_plan.hpp>
#include <gridmorph/wheel/blade_share.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// What stands in the passages of one row.
struct WheelRowBlades {
  int passages = 1;         ///< how many are made
  std::vector<int> blades;  ///< which motion each has; as many as passages. Beyond the last comes the first again.
};

/// Plans one passage for all, and evaluates the blades.
///
/// Rows whose blades are all alike are planned as they stand, with their periodic interfaces. In the others the two periodic sides
/// of a passage become boundaries that move independently: what the rules say of a single blade, as if the whole wheel had it, is
/// evaluated for every blade, and shared between neighbouring blades as blade_share.hpp says. So both passages beside a periodic
/// side move it alike.
class WheelMotion {
 public:
  /// sector: with complete patches (connect_and_check); its periodic interfaces pass find_rows. motions: one per different blade; they
  /// may differ in the rules rigid and function of a patch alone. rows: per WheelRows::rows.
  /// Throws MotionError, PlanError or MeshError. Cost: one plan, and the rules once per motion.
  WheelMotion(Mesh const& sector, Links const& links, WheelRows const& rows, std::vector<Motion> const& motions,
              PlanOptions const& options, std::vector<WheelRowBlades> const& blades);

  /// Moves any passage, in the frame of the sector mesh.
  [[nodiscard]] Plan const& plan() const { return planned_.plan; }
  /// Displacements of Plan::boundary_nodes in a passage. Passages beyond the last of a row have those of its first ones.
  [[nodiscard]] std::vector<Vec3> boundary(int passage) const;
  /// Whether two passages have equal displacements, because they and their neighbours have equal blades.
  [[nodiscard]] bool alike(int passage, int other) const;
  [[nodiscard]] std::vector<std::string> const& notes() const { return notes_; }

 private:
  [[nodiscard]] int motion_of(int row, int passage) const;

  Mesh const& sector_;
  WheelRows const& rows_;
  std::vector<WheelRowBlades> blades_;
  Axis axis_;
  PlannedMorph planned_;
  std::vector<BladeShare> shares_;         ///< per boundary node
  std::vector<int> row_of_node_;           ///< per boundary node
  std::vector<std::vector<Vec3>> values_;  ///< per motion and boundary node; empty for motions that no passage has
  std::vector<std::string> notes_;
};

}  // namespace gridmorph
