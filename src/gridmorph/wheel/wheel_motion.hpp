// The motion of a wheel of blocks whose passages have blades of their own: one plan, boundary displacements per
// passage.
#pragma once

#include <gridmorph/plan/make_plan.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/wheel/passage_motions.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <map>
#include <string>
#include <vector>

namespace gridmorph {

/// Plans one passage for all, and evaluates the blades.
///
/// Rows whose blades are all alike are planned as they stand, with their periodic interfaces. In the others the two
/// periodic sides of a passage become boundaries that move independently: what the rules say of a single blade, as if
/// the whole wheel had it, is evaluated for every blade, and shared between neighbouring blades as blade_share.hpp
/// says. So both passages beside a periodic side move it alike.
class WheelMotion {
 public:
  /// sector: with complete patches (connect_and_check); its periodic interfaces pass find_rows; outlives this. motions:
  /// one per different blade; they may differ in rules that give a displacement of their own (rigid, function,
  /// sections, target, inflate) alone. rows: per WheelRows::rows. Throws MotionError, PlanError or MeshError. Cost: one
  /// plan, and the rules once per motion; what they share at different times once per motion that is no other one's.
  WheelMotion(Mesh const& sector, PassageLinks const& links, WheelRows const& rows, std::vector<Motion> const& motions,
              SameRules same_rules, PlanOptions const& options, std::vector<WheelRowBlades> const& blades);

  /// The same motions at another time: passages() is then of that. The plan stays.
  void move(std::vector<Motion> const& motions);
  /// What a motion, number m at any time, gives Plan::boundary_nodes where the whole wheel has that blade.
  [[nodiscard]] std::vector<Vec3> displacement(int m, Motion const& motion) const;

  /// Displacements of passages() that lead off slip surfaces.
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary) const;

  /// Moves any passage, in the frame of the sector mesh.
  [[nodiscard]] Plan const& plan() const { return planned_.plan; }
  /// Displacements of Plan::boundary_nodes.
  [[nodiscard]] PassageMotions const& passages() const { return passages_; }
  [[nodiscard]] std::vector<std::string> const& notes() const { return notes_; }

 private:
  SameRules same_rules_;
  std::vector<int> used_;
  Mesh opened_;                          ///< whose numbers the plan's requests have
  std::map<int, BoundaryMotion> rules_;  ///< by motion, of those that are no other one's
  PlannedMorph planned_;
  PassageMotions passages_;
  std::vector<std::string> notes_;
};

}  // namespace gridmorph
