// The motion of a wheel of elements whose passages have blades of their own: one plan, boundary displacements per
// passage.
#pragma once

#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/wheel/passage_motions.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

/// The motions of a wheel over time.
struct WheelTimes {
  int steps = 0;  ///< 0: there is but one time
  std::function<std::vector<Motion>(int step)> motions = {};
};

/// WheelMotion of a mesh of elements. Its plan knows both sides of a periodic connection that a rule moves, so passages
/// need no opening: where blades differ every node of the periodic sides must be known, by a rule of the connection or
/// of patches on it.
class ElementWheelMotion {
 public:
  /// sector: checked, with what follows from it; its periodic connections pass find_rows; outlives this. motions: one
  /// per different blade, as in WheelMotion. The plan reckons with the passage whose boundary moves most, at any of the
  /// times, or with options.elements.motion. Of one motion it is the plan of the sector. Throws MotionError, PlanError
  /// or MeshError. Cost: one plan, and the rules once per motion.
  ElementWheelMotion(Mesh const& sector, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                     PassageLinks const& links, WheelRows const& rows, std::vector<Motion> const& motions,
                     SameRules same_rules, PlanOptions options, std::vector<WheelRowBlades> const& blades,
                     WheelTimes const& times = {});

  /// As of WheelMotion; displacement() of UnstructuredPlan::known.
  void move(std::vector<Motion> const& motions);
  [[nodiscard]] std::vector<Vec3> displacement(int m, Motion const& motion) const;

  /// Moves any passage, in the frame of the sector mesh.
  [[nodiscard]] PreparedUnstructured const& prepared() const { return prepared_; }
  /// Displacements of UnstructuredPlan::known.
  [[nodiscard]] PassageMotions const& passages() const { return passages_; }
  [[nodiscard]] std::vector<std::string> const& notes() const { return notes_; }

 private:
  [[nodiscard]] std::vector<std::vector<Vec3>> values_of(std::vector<Motion> const& motions) const;

  Mesh const& sector_;
  SameRules same_rules_;
  std::vector<int> used_;
  std::map<int, std::shared_ptr<BoundaryMotion const>> rules_;  ///< by motion, of those that are no other one's
  BoundaryRequests requests_;
  PreparedUnstructured prepared_;
  PassageMotions passages_;
  std::vector<std::string> notes_;
};

}  // namespace gridmorph
