// How long the edges of grid lines are.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <utility>
#include <vector>

namespace gridmorph {

/// Arc lengths between neighbouring nodes of grid lines: straight, or what a finer mesh has between them. Borrows the
/// mesh.
class GridLengths {
 public:
  /// A node, for kernels::walk_line().
  struct Place {
    GridLengths const* lengths;
    Index node;
    friend double distance(Place const& a, Place const& b) { return (*a.lengths)(a.node, b.node); }
  };

  /// Lengths that are straight between neighbouring nodes.
  explicit GridLengths(Mesh const& mesh) : mesh_(mesh) {}
  /// up_to[d]: of each node, the length along direction d from its zone's lower face.
  GridLengths(Mesh const& mesh, std::array<std::vector<double>, 3> up_to) : mesh_(mesh), up_to_(std::move(up_to)) {}

  [[nodiscard]] double operator()(Index from, Index to) const {
    if (up_to_[0].empty()) return distance(mesh_.coordinates[from], mesh_.coordinates[to]);
    Index const step = from < to ? to - from : from - to;
    auto const& up_to = up_to_[step == 1 ? 0 : step == mesh_.zones[mesh_.zone_of(from)].strides()[1] ? 1 : 2];
    double const length = up_to[to] - up_to[from];
    return length < 0 ? -length : length;
  }
  [[nodiscard]] Place operator[](Index node) const { return {this, node}; }

 private:
  Mesh const& mesh_;
  std::array<std::vector<double>, 3> up_to_;
};

}  // namespace gridmorph
