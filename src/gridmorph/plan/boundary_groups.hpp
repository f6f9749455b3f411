// Boundary nodes in groups of groups, as rows: what far nodes say counts as one.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/plan/layers.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gridmorph {

class PlaceOrder;

/// Groups of groups of nodes, halved at the median, the whole first. Which nodes make a group is seen in fields made of
/// them, so noise does not decide it.
class BoundaryGroups {
 public:
  struct Group {
    Vec3 centre;  ///< weighted by area
    double radius = 0, area = 0;
    double moments[3][3] = {};   ///< of second order about the centre, over the area; of Along::principal_axes alone
    Index32 part[2] = {-1, -1};  ///< -1: a leaf
    Index32 begin = 0, end = 0;  ///< of the ordered nodes
    int height = 0;              ///< 0: a leaf
  };

  /// Where groups are halved: across the coordinate along which they are longest, in steps of a thousandth of the mesh;
  /// or across their longest principal axis, in steps of a millionth, so that groups turn with the mesh; where two axes
  /// are alike to a thousandth, across a coordinate.
  enum class Along { coordinates, principal_axes };

  /// area: of each node. leaf_radius: of groups of up to four nodes, none of which need be told apart. Cost O(n log n).
  BoundaryGroups(Coordinates const& x, std::vector<Index32> const& nodes, std::vector<double> const& area,
                 double leaf_radius, Along along = Along::coordinates);

  std::vector<Group> groups;

  /// The distance of a place from the nearest node; infinite where there is none. Cost O(log n) beside nodes.
  [[nodiscard]] double distance(Vec3 const& x) const;
  /// About the largest distance between two nodes.
  [[nodiscard]] double size() const { return groups.empty() ? 0 : 2 * groups.front().radius; }

  /// Means over groups: rows from the nodes, by their numbers in the list, to leaves, and from the two parts of a group
  /// to the group, from the smallest on.
  void add_rows(InterpolationOperator& leaves, LayerRows& rows) const;

 private:
  Index32 make(Index32 begin, Index32 end);
  /// The longest principal axis of a group, with a sense; zero where two are as long.
  [[nodiscard]] Vec3 longest_axis(Group const& group) const;
  /// Brings the nodes of a group in an order, and returns where the second part begins. Along principal axes nodes that
  /// are equally far along them stay together, so that mirrored meshes have mirrored groups.
  Index32 halve(Group const& group, Vec3 const& extent);
  [[nodiscard]] Index32 item(Index32 k) const { return order_[k]; }
  [[nodiscard]] Index32 node(Index32 k) const { return nodes_[order_[k]]; }
  [[nodiscard]] double area(Index32 k) const { return area_[order_[k]]; }

  Coordinates const& x_;
  std::vector<Index32> const& nodes_;
  std::vector<double> const& area_;
  double leaf_radius_;
  Along along_;
  double step_ = 1;                     ///< of PlaceOrder
  std::vector<Index32> order_, place_;  ///< by position, and where each is in that order
  std::vector<std::array<std::int64_t, 3>> steps_;
  std::vector<std::int64_t> key_;  ///< of the nodes of the group that is halved
};

}  // namespace gridmorph
