// Displacements on both sides of periodic interfaces.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <algorithm>
#include <map>

namespace gridmorph::test {

struct PeriodicMatch {
  int pairs = 0;
  double apart = 0;  ///< how far any copy's displacement is from the image of its node's
};

/// Of the nodes that have a displacement; their copies must have one too.
inline PeriodicMatch periodic_match(Mesh const& mesh, std::map<Index, Vec3> const& u) {
  Boundary const boundary(mesh);
  PeriodicMatch out;
  for (int c = 0; c < int(mesh.interfaces.size()); ++c) {
    if (!mesh.interfaces[c].periodic) continue;
    Mat3 const turn = boundary.transform(c).rotation;
    for (auto const& [own, donor] : boundary.pairs(c)) {
      if (!u.contains(own)) continue;
      out.apart = std::max(out.apart, distance(turn * u.at(own), u.at(donor)));
      ++out.pairs;
    }
  }
  return out;
}

}  // namespace gridmorph::test
