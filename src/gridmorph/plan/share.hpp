// The share that some boxes of nodes have in a plan: what one of many processes keeps of the plan of the whole mesh.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/smoothing_map.hpp>

#include <span>

namespace gridmorph {

/// The plan of the nodes of these boxes, box after box, i fastest within each. Boxes may overlap, as planes that parts
/// of a zone have in common or layers of ghost nodes do: each box has its own copy of a node.
///
/// Of every stage it has the lines that the boxes depend on, back to the boundary, and of the pass through the volume
/// the rows in the boxes; chains beside known sides are kept whole. Nothing that decides a value is cut, so nodes go to
/// the same bits as by the whole plan, and nothing is exchanged with whoever has the others. Boundary nodes are all of
/// the whole plan's, with its numbers; what a plan says for reports is left to it. Line parameters are measured along
/// whole lines of `mesh` here; the share has no lines itself. Transposes of shares add up to that of the whole plan,
/// where each node's gradient is in one of them.
///
/// Throws ConfigError: a zone that the mesh has not, a box that is empty or goes beyond its zone. Cost: arc lengths of
/// all lines of the chains kept; memory 8 bytes per line parameter of one stage of the whole plan at a time, and what
/// a plan of the boxes takes.
Plan share_of(HostInstance const& host, Plan const& whole, BoundaryMesh const& mesh, std::span<NodeBox const> boxes);

/// What a guard moved the nodes of these boxes by. Cost: nodes that it moved times boxes of their zone.
SmoothingMap share_of(SmoothingMap const& whole, BoundaryMesh const& mesh, std::span<NodeBox const> boxes);

}  // namespace gridmorph
