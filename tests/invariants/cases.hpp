// Morphs that every invariant is checked on: one of each kind of topology, with motions that reach all parts of the plan.
#pragma once

#include "support/motions.hpp"

#include <gridmorph/plan/options.hpp>

#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace gridmorph::test {

struct Case {
  std::string name;
  std::function<Mesh()> mesh;
  /// The motion scaled by a factor; 0: the same rules, all displacements zero.
  std::function<Motion(double factor)> motion;
  PlanOptions options;
  /// A common translation that this mesh allows (axial for sectors).
  Vec3 translation{0.3, -0.7, 0.2};
  /// Patches that must follow a translation (the periodic ones and free ones follow by themselves).
  std::vector<std::string> all_patches{"*"};
  /// A ring that closes on itself and has known faces beside its seam: blending across it starts at the seam.
  bool seam_matters = false;

  friend std::ostream& operator<<(std::ostream& out, Case const& c) { return out << c.name; }
};

std::vector<Case> const& cases();
/// Meshes from outside with a motion each; empty when they are not there.
std::vector<Case> shared_cases();

/// "box_all_faces" for names of parameterised tests.
std::string case_name(Case const& c);

bool reduced();  ///< GRIDMORPH_TEST_REDUCED is set: fewer seeds

}  // namespace gridmorph::test
