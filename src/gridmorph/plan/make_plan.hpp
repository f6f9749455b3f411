// From topology and motion to a plan.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/motion/boundary_requests.hpp>
#include <gridmorph/plan/chain_order.hpp>
#include <gridmorph/plan/plan.hpp>

namespace gridmorph {

/// A plan together with what is needed to evaluate the motion on its boundary nodes.
struct PlannedMorph {
  Plan plan;
  BoundaryRequests boundary;
  ChainOrder order;  ///< of the stages after poles and near field
};

/// Plans the morph of a mesh whose links are connected and whose coverage is checked. Coordinates are read
/// on surfaces, and in whole blocks only where the quality rule has to break a tie. `first`: chains of the first
/// stages, instead of those that rank best. Throws PlanError naming blocks that no chain reaches, near fields that
/// cannot be, and chains of `first` that end nowhere.
PlannedMorph make_plan(HostInstance const& host, Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                       PlanOptions const& options, ChainOrder const& first = {});

}  // namespace gridmorph
