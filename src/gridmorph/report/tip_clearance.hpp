// How far the tips of blades are from the case, before and after.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Distance of tip nodes from a wall of revolution, in the meridional plane: the shortest one, not that along the radius. Negative where a
/// node is on the other side of the wall than the blade is: there it rubs.
struct Clearance {
  double smallest = 0;
  double mean = 0;  ///< over the nodes
  Vec3 at{};        ///< the node of the smallest
};

/// One tip.
struct TipClearance {
  std::string name;
  std::size_t nodes = 0;
  Clearance before;
  std::optional<Clearance>
      by_rule;         ///< where the blade's rule alone takes the tip, whether or not the mesh keeps it on the wall
  Clearance after;     ///< in the morphed mesh
  double scatter = 0;  ///< largest distance of the wall's nodes from the profile through them
};

/// A wall of revolution at one time.
class ClearanceWall {
 public:
  /// Throws MotionError where the nodes are not on a surface of revolution that is a radius over the axial position.
  ClearanceWall(Axis const& axis, std::vector<Vec3> const& nodes);

  /// Smallest and mean distance of nodes, positive on the side where `outwards` is 1 for blades inside (towards the axis), -1 for blades
  /// outside of the wall. Cost: O(log n) in the stations of the wall per node.
  [[nodiscard]] Clearance of(std::vector<Vec3> const& nodes, double outwards) const;
  /// That of one point, positive towards the axis.
  [[nodiscard]] double distance(Vec3 const& point) const;
  [[nodiscard]] double scatter() const { return scatter_; }

 private:
  void refine();
  [[nodiscard]] std::pair<double, double> meridional(Vec3 const& point) const;

  Axis axis_;
  std::vector<std::pair<double, double>> points_;  ///< (axial, radius) of the profile, ascending
  double scatter_ = 0;
};

/// Numbers, in `blade`, of the nodes within a share of the blade's height of its end towards the wall; all of them for share 1.
std::vector<std::size_t> tip_nodes(ClearanceWall const& wall, std::vector<Vec3> const& blade, double share);

/// Of many steps: a line per tip with the smallest clearance of all steps by the rule and in the mesh, and the steps they are in (from 1 on); the largest mean in the mesh
/// beside the smallest. Precondition: every step has the same tips.
std::string clearance_steps_table(std::vector<std::vector<TipClearance>> const& steps);

/// A table with one line per tip, under its header.
std::string clearance_table(std::vector<TipClearance> const& tips);
nlohmann::json clearance_json(std::vector<TipClearance> const& tips);

}  // namespace gridmorph
