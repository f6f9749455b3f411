// The motion of a wheel whose passages have blades of their own: one plan, boundary displacements per passage.
#pragma once

#include <gridmorph/morph/morph.hpp>
#include <gridmorph/motion/boundary_requests.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/wheel/blade_share.hpp>
#include <gridmorph/wheel/passage_motions.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// The motions of a wheel over time.
struct WheelTimes {
  int steps = 0;  ///< 0: there is but one time
  std::function<std::vector<Motion>(int step)> motions = {};
};

/// Plans one passage for all, and evaluates the blades.
///
/// Rows whose blades are all alike are planned as they stand, with their periodic interfaces. In the others the two
/// periodic sides of a passage become boundaries that move independently: what the rules say of a single blade, as if
/// the whole wheel had it, is evaluated for every blade, and shared between neighbouring blades as blade_share.hpp
/// says. So both passages beside a periodic side move it alike. Plans of elements know both sides of a periodic
/// connection that a rule moves, so their passages need no opening: where blades differ every node of the periodic
/// sides must be known, by a rule of the connection or of patches on it.
class WheelMotion {
 public:
  /// sector: with complete patches (connect_and_check) where it is one of blocks; its periodic interfaces pass
  /// find_rows. motions: one per different blade; they may differ in rules that give a displacement of their own
  /// (rigid, function, sections, target, inflate) alone. blades: per WheelRows::rows. A plan of elements reckons with
  /// the passage whose boundary moves most, at any of the times, or with options.elements.motion; of one motion it is
  /// the plan of the sector. Throws MotionError, PlanError or MeshError. Cost: one plan, and the rules once per motion;
  /// what they share at different times once per motion that is no other one's.
  WheelMotion(IndexedMesh sector, PassageLinks const& links, WheelRows const& rows, std::vector<Motion> const& motions,
              SameRules same_rules, PlanOptions const& options, std::vector<WheelRowBlades> const& blades,
              WheelTimes const& times = {});

  /// The same motions at another time: passages() is then of that. The plan stays.
  void move(std::vector<Motion> const& motions) { passages_.take(values_of(motions)); }
  /// From here on plan() carries what a guard did to some passages (guard/guard.hpp).
  void freeze(std::shared_ptr<SmoothingMap const> guard) { plan_ = plan_->with(std::move(guard)); }
  /// What a motion, number m at any time, gives MorphPlan::boundary_nodes() where the whole wheel has that blade.
  [[nodiscard]] std::vector<Vec3> displacement(int m, Motion const& motion) const;

  /// Displacements of passages() that lead off slip surfaces.
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary) const;

  /// Moves any passage, in the frame of the sector mesh.
  [[nodiscard]] MorphPlan const& plan() const { return *plan_; }
  /// Displacements of MorphPlan::boundary_nodes().
  [[nodiscard]] PassageMotions const& passages() const { return passages_; }
  [[nodiscard]] std::vector<std::string> const& notes() const { return notes_; }

 private:
  struct Asked {  ///< what planning is given
    PassageLinks const& links;
    WheelRows const& rows;
    std::vector<Motion> const& motions;
    PlanOptions const& options;
    std::vector<WheelRowBlades> const& blades;
    WheelTimes const& times;
    std::vector<char> open;  ///< per row whether its blades differ
  };

  void plan_blocks(Asked const& asked);
  void plan_elements(Asked const& asked);
  /// The displacement that a plan of elements reckons with: that of the passage that moves most, where there is one
  /// motion; otherwise, in `options`, how far any goes.
  [[nodiscard]] std::optional<std::vector<Vec3>> largest_of(Asked const& asked, PlanOptions& options) const;
  /// make(m): the rules of motion m on the boundary.
  template <class Make>
  void add_rules(Make const& make);
  /// nodes: of the plan's boundary, in its order.
  void add_passages(Asked const& asked, std::vector<Index> const& nodes, std::vector<BladeShare> const& shares);
  [[nodiscard]] std::vector<std::vector<Vec3>> values_of(std::vector<Motion> const& motions) const;

  IndexedMesh sector_;
  SameRules same_rules_;
  std::vector<int> used_;
  std::map<int, std::shared_ptr<BoundaryMotion const>> rules_;  ///< by motion, of those that are no other one's
  BoundaryRequests requests_;
  std::vector<Mat3> rotations_;
  std::optional<MorphPlan> plan_;
  PassageMotions passages_;
  std::vector<std::string> notes_;
};

}  // namespace gridmorph
