// Rules that give a node and its periodic copy different displacements, as messages.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <map>
#include <string>
#include <vector>

namespace gridmorph {

/// Collects nodes whose periodic copies one rule moves in another way; one message for each rule, with what would fit.
class TornCopies {
 public:
  struct Copies {
    Index node = 0, copy = 0;
    Vec3 displacement, of_copy;  ///< in the frame of the node
    double turn_rad = 0;         ///< from one to the other; 0: a translation
  };

  /// `rule`: where it is given; `name`: of its rule; `patch`: of the node, as users know it.
  void add(std::string const& rule, std::string const& name, std::string const& patch, Copies const& copies);

  [[nodiscard]] std::vector<std::string> messages(BoundaryMesh const& mesh) const;

 private:
  struct Found {
    std::string name, patch;
    Copies worst;
    double gap = 0;
    Index count = 0;
  };
  std::map<std::string, Found> found_;
};

}  // namespace gridmorph
