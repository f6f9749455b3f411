// Along a grid line from node to node, through interfaces.
#pragma once

#include <gridmorph/boundary/links.hpp>

namespace gridmorph {

/// A node and the way a grid line leaves it.
struct LinePlace {
  int zone = 0;
  Index3 at{};
  int axis = 0, step = 1;
};

/// Goes on to the next node and adds the length of the cell edge between; false, and nothing changed, at the boundary.
/// Links are as many as a zone has, looked at where its nodes end.
bool advance(Mesh const& mesh, Links const& links, LinePlace& place, double& length);

/// The axis across a face range: the one along which it has one node.
int normal_axis(IndexRange const& range);

}  // namespace gridmorph
