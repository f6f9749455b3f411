// The passage of a wheel as `gridmorph wheel` reads, plans and moves it.
#pragma once

#include <gridmorph/run/case_plan.hpp>
#include <gridmorph/run/wheel_setup.hpp>
#include <gridmorph/wheel/wheel_mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

class WheelPassage {
 public:
  /// Reads the mesh and connects its zones. Throws MeshError.
  explicit WheelPassage(CaseFile const& case_file);

  [[nodiscard]] LoadedMesh const& loaded() const { return loaded_; }
  [[nodiscard]] Mesh const& mesh() const { return loaded_.mesh(); }
  [[nodiscard]] PassageLinks const& links() const { return links_; }
  /// As it goes into the file.
  [[nodiscard]] WheelMesh wheel(WheelRows const& rows, std::vector<int> const& passages, WheelFamilies families) const;
  [[nodiscard]] Coordinates in_file_order(Coordinates const& x) const;

 private:
  WheelPassage(CaseFile const& case_file, Mesh mesh);

  PassageLinks links_;  ///< of blocks found first: it completes the patches of the mesh
  LoadedMesh loaded_;
};

/// One plan for all passages.
class PassagePlan {
 public:
  /// Case file and mesh must outlive the plan. Throws MeshError, MotionError, PlanError.
  PassagePlan(WheelPassage const& passage, CaseFile const& case_file, WheelRows const& rows, WheelSetup const& setup);

  [[nodiscard]] WheelMotion const& motion() const { return motion_; }
  [[nodiscard]] PassageMotions const& passages() const { return motion_.passages(); }
  /// The same motions at another time: passages() is then of that.
  void move(std::vector<Motion> const& motions) { motion_.move(motions); }
  /// Moves the sector from its baseline by what a passage's boundary does; elements are smoothed around those that came
  /// out bad.
  GuardReport morph(std::vector<Vec3> const& boundary, Coordinates& morphed);
  [[nodiscard]] MeshForMessages for_messages() const;

 private:
  LoadedMesh const& mesh_;
  WheelMotion motion_;
  Morpher<Kokkos::DefaultHostExecutionSpace> morpher_;
};

}  // namespace gridmorph::cli
