// Points of a mesh of blocks: nodes that coincide, and periodic copies of them, are one; which of them may move when a
// guard looks after cells.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph {

struct Plan;
struct PreparedMorph;  ///< plan/prepare.hpp

/// A node of a point; the node's displacement is that of the point, turned by BlockPoints::rotation() of `matrix` (-1:
/// as it is).
struct PointNode {
  Index node;
  std::int32_t matrix;
};

/// The surfaces that a point slides on, numbers in BlockPoints::slip_surfaces(), in the frame of one of its nodes.
struct SlidingPoint {
  PointNode node{-1, -1};
  int count = 0;
  std::array<int, 3> surface{};
  std::array<double, 3> own_offset{};
};

class BlockPoints {
 public:
  /// What was prepared must outlive it. Throws nothing; cost: O(nodes), two numbers per node of the skeleton and five
  /// bytes per node of the mesh.
  explicit BlockPoints(PreparedMorph const& prepared);

  /// Whether a node, and with it all of its point, keeps its place.
  [[nodiscard]] bool stays(Index node) const { return stays_[node] != 0; }
  void keep(Index node) {
    for_each_node(node, [this](PointNode const& n) { stays_[n.node] = 1; });
  }
  /// All nodes of a node's point.
  template <class Visit>
  void for_each_node(Index node, Visit&& visit) const {
    Index32 const slot = slot_[node];
    if (slot < 0) {
      visit(PointNode{node, -1});
      return;
    }
    for (Index n = first_[slot]; n < first_[slot + 1]; ++n) visit(nodes_[n]);
  }
  /// Where the plan keeps a node's displacement; -1 inside pieces.
  [[nodiscard]] Index slot(Index node) const { return slot_[node]; }
  /// Numbers of the slip surfaces that the patches of a node lie on.
  [[nodiscard]] std::vector<int> surfaces(Index node) const;
  /// nodes: all those of a point. In the frame of the node with most surfaces; nothing where another node of the point
  /// adds one in another frame.
  [[nodiscard]] std::optional<SlidingPoint> sliding(std::vector<PointNode> const& nodes) const;

  /// BoundaryMotion::slip_surfaces().
  [[nodiscard]] std::vector<SlipSurface> const& slip_surfaces() const { return *slip_surfaces_; }
  [[nodiscard]] Mat3 const& rotation(std::int32_t matrix) const { return (*rotations_)[matrix]; }
  [[nodiscard]] Coordinates const& baseline() const { return baseline_; }

 private:
  void gather(Plan const& plan);
  void keep_given(PreparedMorph const& prepared);
  void keep_near_field(PreparedMorph const& prepared);
  void keep_axes(PreparedMorph const& prepared);
  void find_slip(PreparedMorph const& prepared);

  std::vector<SlipSurface> const* slip_surfaces_;
  std::vector<Mat3> const* rotations_;
  Coordinates baseline_;       ///< the mesh's own arrays
  std::vector<Index32> slot_;  ///< per node; -1 inside pieces
  std::vector<Index> first_;   ///< per slot
  std::vector<PointNode> nodes_;
  std::vector<std::uint8_t> stays_;
  std::vector<std::pair<Index, int>> slips_;  ///< (node, surface), ascending, each once
};

}  // namespace gridmorph
