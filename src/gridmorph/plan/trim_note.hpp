// Given displacements that lead off the slip surfaces of patches that their nodes lie on as well.
#pragma once

#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/plan.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace gridmorph {

/// What one rule, which does not go along with walls alone, asks of the nodes that lie on one slip surface too, as far
/// as it leads off it.
struct Trim {
  std::string patch;        ///< the patch that slips, as messages name it
  std::string rule;         ///< where the displacement comes from
  Index nodes = 0;          ///< number of nodes that are taken off it
  double most = 0;          ///< the most that one of them is taken off by [length]
  std::string where;        ///< the node that is taken off most, as messages name it
  double displacement = 0;  ///< largest that the rule gives anywhere [length]
  std::string outcome;      ///< what becomes of the nodes
  double mesh_size = 0;     ///< diagonal of the box of the mesh [length]

  /// The share of what was asked for that is undone.
  [[nodiscard]] double share() const { return displacement > 0 ? std::min(1.0, most / displacement) : 0; }
};

/// What is trimmed in a mesh of blocks: displacements (per Plan::boundary_nodes) that finalize puts back. Empty when
/// all stay on the slip surfaces as build_spread() asks of them. Cost: O(nodes on slip surfaces, requests).
std::vector<Trim> trims(Plan const& plan, BoundaryRequests const& requests, BoundaryMotion const& motion,
                        std::vector<Vec3> const& boundary);
/// What is trimmed in a mesh of elements: displacements (per BoundaryConditions::known) that a morph puts back before
/// anything else.
std::vector<Trim> trims(BoundaryConditions const& boundary, std::vector<Vec3> const& given);

/// A trim in words: "the displacement by case.toml:12 takes 47 nodes off the slip surface of 'hub', most zone ... by
/// 0.0012, 3 % of its largest, 0.04; they are put back ...".
std::string describe(Trim const& trim);
/// Throws MotionError that lists those of which more than half is undone, or more than `allowed` where that is larger.
void refuse_undone(std::vector<Trim> const& trims, double allowed);

}  // namespace gridmorph
