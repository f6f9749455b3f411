// What motion rules ask of the boundary nodes of a plan, and what they give them.
#pragma once

#include <gridmorph/motion/boundary_motion.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph {

/// Which explicit rule asks for which boundary node, before any displacement is evaluated. Several requests may ask for
/// the same boundary node where patches meet.
struct BoundaryRequests {
  struct Request {
    Index boundary_node = 0;     ///< among the plan's
    Index node = 0;              ///< of the requesting patch: its position is what the rule sees
    std::int32_t rotation = -1;  ///< frame of the plan's node -> frame of that node
    int rule = 0;
    int patch = -1;  ///< or
    int interface = -1;
  };
  std::vector<Request>
      requests;  ///< by (rank, rule): the first request of a node gives its value, the others must agree
  Index n_boundary_nodes = 0;
  /// Nodes of several zones may be one without a connection: there a rule that the user gives goes before a default.
  bool defaults_yield = false;
  /// What messages call the patches and connections, by their numbers in the requests: families where they have one.
  std::vector<std::string> patch_names, interface_names;

  /// Takes their names from where they were numbered, which may have more of them than what the rules were resolved
  /// for (wheel/open_passage.hpp).
  void name(NamedBoundary const& boundary);
  /// Puts the requests in order.
  void sort(std::vector<MotionRule> const& rules);
};

/// Displacement of every boundary node of the plan, in its frame. Throws MotionError that lists every pair of patches
/// whose displacements disagree on their common nodes by more than the conformity tolerance (place, size). Cost
/// O(requests) evaluations.
std::vector<Vec3> evaluate(BoundaryRequests const& boundary, BoundaryMotion const& motion,
                           std::vector<Mat3> const& rotations);

/// Meshes of elements, in which both nodes of a periodic connection may have requests of their own: throws MotionError
/// where one rule gives them displacements that are no copies of one another, by more than evaluate() lets rules
/// differ. Cost O(requests).
void require_equal_copies(BoundaryRequests const& boundary, BoundaryMotion const& motion,
                          std::vector<Vec3> const& displacement);

/// The request that gives every boundary node its value there, by its number; -1: none. Cost O(requests); no rule is
/// evaluated.
std::vector<Index> deciding_requests(BoundaryRequests const& boundary, BoundaryMotion const& motion);

}  // namespace gridmorph
