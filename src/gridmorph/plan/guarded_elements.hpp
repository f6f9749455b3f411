// What a guard asks of the plan of a mesh of elements.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

#include <vector>

namespace gridmorph {

struct PreparedUnstructured;  ///< plan/unstructured_plan.hpp

/// Lists of a plan, which must outlive this. Node numbers are those of representatives (NodeGraph) unless said
/// otherwise.
struct GuardedElements {
  GuardedElements(PreparedUnstructured const& prepared);

  NodeGraph const& graph;
  BoundaryConditions const& conditions;
  std::vector<Index32> const& known;         ///< nodes whose displacement is given, in the order of MorphPlan's
  std::vector<Index32> const& beside_known;  ///< nodes of other boundaries, and of columns on them
  std::vector<Index32> const& in_columns;
  std::vector<PeriodicImage> const& images;
  std::vector<SlipSurface> const& surfaces;
  std::vector<Index32> const& copies;   ///< nodes that coincide with a representative,
  std::vector<Index32> const& copied;   ///< and that
  InterpolationOperator const& middle;  ///< further nodes of second-order elements: by the corners around them
  /// Those of them on boundaries, with slots in `known` or -1, and numbers of `surfaces` where not known.
  std::vector<Index32> const& middle_on_boundary;
  std::vector<Index32> const& middle_slots;
  CsrGraph const& middle_surfaces;
};

}  // namespace gridmorph
