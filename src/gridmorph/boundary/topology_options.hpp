// How strictly what a file declares about its boundary is taken.
#pragma once

#include <string>

namespace gridmorph {

struct TopologyOptions {
  /// Largest distance, in length units of the mesh, between nodes that a 1-to-1 interface declares coincident.
  /// 0: the default, 1e-8 of the mesh size, or what the precision of a zone's coordinates allows
  /// (coincidence_tolerance()).
  double matching_tolerance = 0;
  /// Name of the patch that faces claimed by nothing are given (kind `other`); empty: they are an error.
  std::string open_faces;
};

}  // namespace gridmorph
