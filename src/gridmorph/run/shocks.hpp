// Regions that are shocks of flow solutions, and the rules that take them to where other solutions have them.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

struct LocatedShocks {
  CaseFile case_file;              ///< InnerRegion::cells and ShockRule::shift filled in
  std::vector<std::string> notes;  ///< what was found where
};

/// Reads the solutions that regions and rules of the case file name and finds their shocks on the mesh. Without any,
/// the case file as it is. Throws one MotionError with every region and rule whose shock cannot be found. Cost O(nodes
/// + cells) for each.
LocatedShocks locate_shocks(CaseFile const& case_file, Mesh const& mesh);

}  // namespace gridmorph::cli
