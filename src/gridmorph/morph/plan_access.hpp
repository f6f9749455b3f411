// What a MorphPlan is made of, and what it says of itself by kind of mesh, for the library itself.
#pragma once

#include <gridmorph/morph/morph.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

class BlockPoints;
class BoundaryMotion;
class PlanShare;
struct BlockGraph;
struct BoundaryConditions;
struct GuardedElements;
struct Links;
struct NodeGraph;
struct Plan;
struct PlannedElements;
struct PlannedMorph;
struct PreparedMorph;         ///< plan/prepare.hpp
struct ShareContents;         ///< morph/share_contents.hpp
struct PreparedUnstructured;  ///< plan/unstructured_plan.hpp

struct PlanAccess {
  /// The plan of a mesh of blocks, null of elements, and the other way round: what plans and morphs are made of. All
  /// else asks for what it needs of them, below.
  static PreparedMorph const* blocks(MorphPlan const& plan);
  static PreparedUnstructured const* elements(MorphPlan const& plan);
  /// What a Morpher of a share applies.
  static Plan const& chains(PlanShare const& share);
  /// Null where it carries none.
  static std::shared_ptr<SmoothingMap const> const& smoothing(PlanShare const& share);
  static PlanShare of(ShareContents&& contents);

  /// Plans that were made in another way than by rules on a mesh as it stands.
  static MorphPlan of(PreparedMorph&& prepared);
  static MorphPlan of(PreparedUnstructured&& prepared);
  /// The plan of blocks that are connected, with resolved rules and a plan in chains for them.
  static MorphPlan of(Mesh mesh, Links links, BoundaryMotion rules, PlannedMorph planned, PlanOptions const& options);
  /// The plan of elements with resolved rules, on the default host instance: prepare() of these
  /// (plan/unstructured_plan.hpp).
  static MorphPlan of(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                      NodeGraph graph, BoundaryConditions conditions, PlanOptions const& options,
                      std::optional<std::vector<Vec3>> displacement);

  /// Of blocks, whose plan must outlive what these return. The mesh with the patches that planning added; null of
  /// elements.
  static Mesh const* patched_mesh(MorphPlan const& plan);
  /// Null of elements.
  static Plan const* chains(MorphPlan const& plan);
  static std::optional<BlockGraph> block_graph(MorphPlan const& plan);
  /// May be asked of blocks alone.
  static BlockPoints block_points(MorphPlan const& plan);

  /// What a plan of elements has, which must outlive what these return; nothing of blocks.
  static std::optional<GuardedElements> guarded_elements(MorphPlan const& plan);
  static std::optional<PlannedElements> planned_elements(MorphPlan const& plan);
  /// put_back_given() (plan/given_slip.hpp), of elements alone.
  static std::vector<Vec3> put_back(MorphPlan const& plan, Coordinates const& x, std::vector<Vec3> given);

  /// MorphPlan::trims() in words of `rules`, which the plan asks for the displacements of its boundary; elements have
  /// their own.
  static std::vector<Trim> trims(MorphPlan const& plan, std::vector<Vec3> const& boundary, BoundaryMotion const& rules);
};

}  // namespace gridmorph
