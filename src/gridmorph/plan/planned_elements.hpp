// What planning found in a mesh of elements and made of it, for reports and pictures.
#pragma once

#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/classify.hpp>
#include <gridmorph/plan/elements/wrap.hpp>

#include <array>
#include <optional>
#include <vector>

namespace gridmorph {

struct PreparedUnstructured;  ///< plan/unstructured_plan.hpp

/// What was found on the way, for reports and pictures.
struct UnstructuredReport {
  bool by_least_squares = false;  ///< whether least squares carry the walls' motion, without wrap and background mesh
  bool with_sides = false;        ///< whether all of a passage goes with sides that follow its blade
  double layer_height = 0;        ///< of the highest column
  Index n_columns = 0;
  double offset = 0;
  std::optional<Wrap> wrap;
  Classification regions;
  std::vector<int> layer;                  ///< (n_nodes) 0 on moving walls and in columns, -1 in the far field
  Index wrap_nodes = 0, wrap_outside = 0;  ///< of the wrap's nodes, those outside all elements
  double wrap_distance = 0;                ///< largest distance of those
  Index far_nodes = 0, far_outside = 0;
  Index unreached = 0;  ///< near nodes that no chain of edges joins to a moving wall
  Index n_layers = 0;
  struct Seconds {
    double boundary = 0, columns = 0, distances = 0, wrap = 0, layers = 0, background = 0, location = 0, residual = 0;
  } seconds{};
};

/// A plan of elements without parts, or one of the parts of a plan.
struct PlannedPart {
  UnstructuredReport const& report;
  Background const* background = nullptr;  ///< null where the near field is the whole mesh
  Index n_nodes = 0;
  bool has_moving_walls = false;
  bool has_common_motion = false;  ///< one that all its boundaries have in common
  std::size_t number = 0;
};

/// A plan of elements, which must outlive this.
struct PlannedElements {
  explicit PlannedElements(PreparedUnstructured const& prepared);

  PlannedPart whole;               ///< where there are parts, what they add up to
  std::vector<PlannedPart> parts;  ///< those that have plans of their own, if any
  /// Components of the mesh that are x, y and z in wraps and background meshes.
  std::array<int, 3> axes{0, 1, 2};

  /// The plans without parts: `parts`, or `whole` where there are none.
  [[nodiscard]] std::vector<PlannedPart> without_parts() const {
    return parts.empty() ? std::vector<PlannedPart>{whole} : parts;
  }
};

}  // namespace gridmorph
