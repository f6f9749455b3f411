// A plan kept in a file: planned once, used by any number of later runs on the same mesh with the same rules.
//
// The file, all numbers little-endian:
//
//   8 bytes  magic            u32  plan_format_version
//   the rest of the key       PlanKey: structure, coordinates, rules, options (u64 each), number of nodes (i64)
//   tables                    fields in the order of plan/detail/plan_fields.hpp; every list with its count (u64) first
//   u64  XXH64 of all bytes before it
#pragma once

#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/plan_key.hpp>

#include <filesystem>

namespace gridmorph {

/// Writes a plan with its key (plan_key()). The file appears whole or not at all: it is written beside `path` and
/// renamed. Throws PlanError when plan and key are not of the same mesh, IoError when there is no such folder,
/// MachineError when the file cannot be written. Cost: O(nodes on faces of pieces).
void save_plan(std::filesystem::path const& path, Plan const& plan, PlanKey const& key);

/// Reads a plan back, equal in every bit to the one that was saved.
///
/// What a solver needs besides is Morpher(exec, plan, baseline coordinates) and displacements of its own for
/// Plan::boundary_nodes, in that order. What the rules of a motion give there (PreparedMorph::boundary_displacement) is
/// not part of a plan: it takes prepare().
///
/// Throws IoError when the file cannot be read or is damaged (magic, checksum, counts, and every number that kernels use
/// as an index are checked), and PlanError, naming what differs, when the plan was made for another key.
/// Cost: O(nodes on faces of pieces).
Plan load_plan(std::filesystem::path const& path, PlanKey const& key);

}  // namespace gridmorph
