// Some of the grid lines of a mesh as a mesh of their own, with the same zones, patches, interfaces and pieces, and
// plans of it: what a morph makes of those, at a small share of its cost.
#pragma once

#include <gridmorph/plan/blocks/cuts.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// Planes of nodes to keep per zone and axis, ascending: all cuts, and pairs of neighbours, so that what lies between
/// them are whole cells of the mesh: the first and the last cell of every piece, and of those between one in `every`,
/// spread evenly. The same at both sides of interfaces. planes: asked for when the mesh is cut.
std::vector<ZoneCuts> sampled_planes(Mesh const& mesh, Links const& links, std::vector<CutPlane> const& planes,
                                     int every);

/// The number of nodes that such planes have.
Index count_nodes(std::vector<ZoneCuts> const& planes);

struct CoarseMesh {
  Mesh mesh;
  Links links;
  std::vector<ZoneCuts> planes;                ///< of the fine mesh, in the order of the indices of this one
  std::array<std::vector<double>, 3> lengths;  ///< GridLengths: along the lines of the fine mesh

  /// The index that a node has in the fine mesh.
  [[nodiscard]] Index3 fine_index(int zone, Index3 const& p) const;
  /// Whether a cell is one of the fine mesh; false where it stands for several.
  [[nodiscard]] bool is_cell(int zone, Index3 const& cell) const;
  /// The place of a plane of the fine mesh that was kept.
  [[nodiscard]] int place(int zone, int axis, int fine_index) const;
};

/// The mesh of the lines kept. Cost: one visit to each node of the lines kept, a share of about 12 / every^2 of the
/// mesh.
CoarseMesh coarsen(Mesh const& mesh, Links const& links, std::vector<ZoneCuts> planes);

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
