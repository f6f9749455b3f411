// The passage of a wheel as `gridmorph wheel` reads, plans and moves it.
#pragma once

#include <gridmorph/run/case_plan.hpp>
#include <gridmorph/run/wheel_setup.hpp>
#include <gridmorph/wheel/wheel_mesh.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// A sector with where its zones meet and which rows they make.
struct LinkedSector {
  IndexedMesh indexed;
  PassageLinks links;
  WheelRows rows;

  [[nodiscard]] Mesh const& mesh() const { return indexed.mesh(); }
};

class WheelPassage {
 public:
  /// Reads the mesh and connects its zones; hexahedra are taken as the blocks found among them, as MeshSource says,
  /// where these make the rows that the zones of the file make. Throws MeshError, ConfigError.
  WheelPassage(CaseFile const& case_file, MeshSource const& file);

  [[nodiscard]] LoadedMesh const& loaded() const { return loaded_; }
  /// What is planned, morphed and measured. Its rows have the numbers of those of in_file().
  [[nodiscard]] LinkedSector const& planned() const { return planned_; }
  [[nodiscard]] Mesh const& mesh() const { return planned_.mesh(); }
  /// What is turned and written: the same, or the elements of the file where that is blocks found among them.
  [[nodiscard]] LinkedSector const& in_file() const { return as_elements_ ? *as_elements_ : planned_; }
  /// Coordinates of planned() as in_file() has them.
  [[nodiscard]] Coordinates in_file(Coordinates const& x) const { return loaded_.in_file(x); }
  /// As it goes into the file.
  [[nodiscard]] WheelMesh wheel(std::vector<int> const& passages, WheelFamilies families) const;
  /// Coordinates of in_file() in the order of the file.
  [[nodiscard]] Coordinates in_file_order(Coordinates const& x) const;

 private:
  LoadedMesh loaded_;
  LinkedSector planned_;
  std::optional<LinkedSector> as_elements_;
};

/// One plan for all passages, and one guard.
class PassagePlan {
 public:
  /// Case file and passage must outlive the plan. Throws MeshError, MotionError, PlanError.
  PassagePlan(WheelPassage const& passage, CaseFile const& case_file, WheelSetup const& setup);

  [[nodiscard]] WheelMotion const& motion() const { return motion_; }
  [[nodiscard]] PassageMotions const& passages() const { return motion_.passages(); }
  /// The same motions at another time: passages() is then of that.
  void move(std::vector<Motion> const& motions) { motion_.move(motions); }
  /// Moves the sector from its baseline by what a passage's boundary does.
  void morph(std::vector<Vec3> const& boundary, Coordinates& morphed);

  /// Whether the case file asks for smoothing of blocks.
  [[nodiscard]] bool smooths_blocks() const { return mesh_.is_structured() && smooth_; }
  /// Smooths around cells that came out bad: elements as guard() does; blocks where the case file says so, each row by
  /// itself, so that rows of equal blades are alike in all passages; nothing after freeze_recorded().
  GuardReport relax(Coordinates& morphed) const;
  /// Remembers where a passage of blocks lost its shape: relax() then does the same to all of them at all times, so
  /// that meshes do not jump.
  void freeze(Coordinates const& morphed);
  /// Cells that did.
  [[nodiscard]] std::size_t n_frozen() const { return frozen_ ? frozen_->cells.size() : 0; }
  /// Remembers what became of a passage that morph() brings to `plain`. Throws ConfigError beyond
  /// SmoothingRecord::most.
  void record(std::vector<Vec3> const& boundary, Coordinates const& plain, Coordinates const& guarded);
  /// From here on morph() does what was recorded, linear in the displacement of each row, and relax() nothing.
  SmoothingMap const& freeze_recorded();

  [[nodiscard]] MeshForMessages for_messages() const;

 private:
  using Exec = Kokkos::DefaultHostExecutionSpace;

  [[nodiscard]] std::vector<int> part_of_nodes() const;

  LoadedMesh const& mesh_;
  WheelRows const& rows_;
  bool smooth_;
  WheelMotion motion_;
  std::optional<Morpher<Exec>> morpher_;  ///< of the plan as it is
  std::optional<FrozenSmoothing> frozen_;
  std::optional<SmoothingRecord> record_;
};

}  // namespace gridmorph::cli
