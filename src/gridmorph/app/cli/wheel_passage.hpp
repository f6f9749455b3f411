// The passage of a wheel, as `gridmorph wheel` sees it whatever kind its mesh is: blocks are in wheel_blocks.cpp,
// elements in wheel_elements.cpp.
#pragma once

#include <gridmorph/app/any_mesh.hpp>
#include <gridmorph/app/cli/wheel_setup.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/wheel/wheel_mesh.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// One plan for all passages.
class PassagePlan {
 public:
  virtual ~PassagePlan() = default;

  [[nodiscard]] virtual PassageMotions const& passages() const = 0;
  /// The same motions at another time: passages() is then of that.
  virtual void move(std::vector<Motion> const& motions) = 0;
  /// What a motion, number m at any time, gives the nodes of passages() where the whole wheel has that blade.
  [[nodiscard]] virtual std::vector<Vec3> displacement(int m, Motion const& motion) const = 0;
  /// Displacements of passages() that lead off slip surfaces.
  [[nodiscard]] virtual std::vector<Trim> trims(std::vector<Vec3> const& boundary) const = 0;
  [[nodiscard]] virtual std::vector<std::string> const& notes() const = 0;
  [[nodiscard]] virtual NearCells near() const = 0;
  /// Moves the sector from its baseline by what a passage's boundary does, and smooths around cells that came out bad
  /// where this kind of mesh always does.
  virtual RelaxReport morph(std::vector<Vec3> const& boundary, Coordinates& morphed) = 0;
  [[nodiscard]] virtual MeshForMessages for_messages() const = 0;
};

class PassageMesh {
 public:
  virtual ~PassageMesh() = default;

  [[nodiscard]] virtual KindTraits const& kind() const = 0;
  [[nodiscard]] virtual Mesh const& mesh() const = 0;
  [[nodiscard]] virtual Index n_cells() const = 0;
  [[nodiscard]] virtual PassageLinks const& links() const = 0;
  [[nodiscard]] virtual std::vector<std::string> notes() const { return mesh().notes; }
  /// As it goes into the file.
  [[nodiscard]] virtual WheelMesh wheel(WheelRows const& rows, std::vector<int> const& passages,
                                        WheelFamilies families) const = 0;
  [[nodiscard]] virtual Coordinates in_file_order(Coordinates const& x) const { return x; }
  /// As pictures see it; must not outlive this.
  [[nodiscard]] virtual std::unique_ptr<page::PictureMesh> pictures() const = 0;
  [[nodiscard]] virtual QualityReport measure(QualityWanted const& wanted) const = 0;
  [[nodiscard]] virtual Boundary boundary() const = 0;
  /// Of some zones of a passage in its place: neither turns nor shifts change a
  /// sign.
  [[nodiscard]] virtual Certificate certify(Coordinates const& placed, std::vector<int> const& zones) const = 0;
  /// The case file and the mesh must outlive the plan. Throws MeshError, MotionError, PlanError.
  [[nodiscard]] virtual std::unique_ptr<PassagePlan> plan(CaseFile const& case_file, WheelRows const& rows,
                                                          WheelSetup const& setup) const = 0;
};

/// Reads the mesh and connects its zones.
std::unique_ptr<PassageMesh> block_passage(CaseFile const& case_file);
std::unique_ptr<PassageMesh> element_passage(CaseFile const& case_file);

}  // namespace gridmorph::cli
