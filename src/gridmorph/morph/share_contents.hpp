// What a share of a plan has, and the same on its way to another process of the program.
#pragma once

#include <gridmorph/core/ranks.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/smoothing_map.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

/// All that a Morpher takes of a share (plan/share.hpp), and what else its owner has of the whole plan.
struct ShareContents {
  Plan chains;  ///< without what plans say for reports
  std::vector<BoundaryPlace> places;
  std::vector<Vec3> displacement;                 ///< of the boundary, by the rules
  std::shared_ptr<SmoothingMap const> smoothing;  ///< null where the plan carries none
};

/// As it lies in memory.
Bytes to_bytes(ShareContents const& share);
/// What to_bytes() was given; of bytes that are no others.
ShareContents share_from_bytes(std::span<std::byte const> bytes);

}  // namespace gridmorph
