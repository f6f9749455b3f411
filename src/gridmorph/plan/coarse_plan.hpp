// Plans of some of the grid lines of a mesh: what a morph makes of those, at a small share of its cost.
#pragma once

#include <gridmorph/plan/blocks/coarse_mesh.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// Makes plans of the lines kept, in any order of chains. Borrows what was prepared.
class CoarsePlanner {
 public:
  /// every: as in sampled_planes(); 0: the smallest power of two from 4 on that keeps at most 40,000 nodes, or 64.
  CoarsePlanner(HostInstance const& host, PreparedMorph const& prepared, int every);
  CoarsePlanner(CoarsePlanner const&) = delete;
  CoarsePlanner& operator=(CoarsePlanner const&) = delete;

  [[nodiscard]] int every() const { return every_; }
  [[nodiscard]] CoarseMesh const& coarse() const { return coarse_; }
  /// A plan of the lines kept, with the line parameters of the mesh itself. `first`, `next`, `choice`: see
  /// build_plan(). Cost: that of a plan of the lines kept.
  [[nodiscard]] PlannedMorph plan(ChainOrder const& first, ChainOrder* next = nullptr,
                                  ChainChoice choice = ChainChoice::rules);
  /// A plan that plan() made, with what parts have in common by `boundary`. Cost: a copy.
  [[nodiscard]] Plan with_common_motions(Plan plan, std::span<Vec3 const> boundary) const;
  /// The displacement of the boundary nodes of a plan that plan() made. `boundary`: that of those of the plan prepared,
  /// in order.
  [[nodiscard]] std::vector<Vec3> displacement(Plan const& plan, std::span<Vec3 const> boundary) const;

 private:
  PreparedMorph const& prepared_;
  PlanBasis basis_;
  int every_;
  CoarseMesh coarse_;
  Topology topology_;
  PlanLines lines_;
  Priority priority_;
};

}  // namespace gridmorph
