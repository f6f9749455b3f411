// What a MorphPlan is made of, for the library itself.
#pragma once

#include <gridmorph/morph/morph.hpp>

#include <vector>

namespace gridmorph {

struct PreparedMorph;         ///< plan/prepare.hpp
struct PreparedUnstructured;  ///< plan/unstructured_plan.hpp

struct PlanAccess {
  /// The plan of a mesh of blocks; null of elements.
  static PreparedMorph const* blocks(MorphPlan const& plan);
  /// The plan of a mesh of elements; null of blocks.
  static PreparedUnstructured const* elements(MorphPlan const& plan);

  /// Plans that were made in another way than by rules on a mesh as it stands.
  static MorphPlan of(PreparedMorph&& prepared);
  static MorphPlan of(PreparedUnstructured&& prepared);
};

}  // namespace gridmorph
