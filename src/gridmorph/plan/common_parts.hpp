// Motions that the boundaries of a part of a mesh of blocks have in common: which parts have one, and what a plan keeps
// of them.
//
// Zones that interfaces connect, periodic ones too, are one part. docs/algorithms/common_motion.md has the formulas.
#pragma once

#include <gridmorph/plan/prepare.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace gridmorph {

/// Fills Plan::common of what was prepared. A part has a motion in common where no rule holds a patch of it in place,
/// its nodes slide on planes and surfaces of revolution alone, and what its boundary nodes are given is one affine
/// motion but for a tenth (CommonMotion::is_common()). displacement: of Plan::boundary_nodes, asked for where a part
/// may have one; of displacements to come, nothing, where one rule moves all boundaries of the part. Plans without such
/// a part stay as they are. Cost O(boundary nodes + nodes of the skeleton).
void split_common_motions(PreparedMorph& prepared,
                          std::function<std::optional<std::vector<Vec3>>()> const& displacement);

/// Fills Plan::common of another plan of the same mesh with the same parts.
void carry_common_motions(PreparedMorph const& from, PlannedMorph& to);

/// Fills Plan::common of a plan of some of its lines, `mesh` with the same zones, with the same parts and the motions
/// that they have by `boundary`, displacements of the nodes of the plan prepared.
void carry_common_motions(PreparedMorph const& from, std::span<Vec3 const> boundary, Mesh const& mesh, Plan& to);

}  // namespace gridmorph
