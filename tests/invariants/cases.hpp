// Morphs that every invariant is checked on: one of each kind of topology, with motions that reach all parts of the
// plan.
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
  std::string file = {};  ///< what mesh() reads, where it reads a file

  friend std::ostream& operator<<(std::ostream& out, Case const& c) { return out << c.name; }
};

/// The cases of this test program.
std::vector<Case> make_cases();

}  // namespace gridmorph::test
