// How far the tips of blades are from the case, before and after.
#pragma once

#include <gridmorph/report/clearance_wall.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// One tip.
struct TipClearance {
  std::string name;
  std::size_t nodes = 0;
  Clearance before;
  std::optional<Clearance>
      by_rule;         ///< where the blade's rule alone takes the tip, whether or not the mesh keeps it on the wall
  Clearance after;     ///< in the morphed mesh
  double scatter = 0;  ///< ClearanceWall::scatter(), the larger one of before and after
  ClearanceMeasure measure = ClearanceMeasure::meridional;  ///< of all three
};

/// Of many steps: a line per tip with the smallest clearance of all steps by the rule and in the mesh, and the steps
/// they are in (from 1 on); the largest mean in the mesh beside the smallest. Precondition: every step has the same
/// tips.
std::string clearance_steps_table(std::vector<std::vector<TipClearance>> const& steps);

/// A table with one line per tip, under its header.
std::string clearance_table(std::vector<TipClearance> const& tips);
nlohmann::json clearance_json(std::vector<TipClearance> const& tips);

}  // namespace gridmorph
