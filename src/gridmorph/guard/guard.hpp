// After a morph: nodes moved where cells came out bad, motions that are too large for one plan in steps, and what a
// guard did frozen into the plan.
#pragma once

#include <gridmorph/morph/morph.hpp>

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

/// What a guard found and left. Bad are cells of blocks with a corner whose scaled Jacobian is below 0.2 and below half
/// of what it was, and elements whose determinant is not above a fifth of the baseline's; inverted ones among them.
struct GuardReport {
  Index before = 0, after = 0;
  int rounds = 0;                                 ///< of smoothing, of blocks those that were kept
  Index inverted_before = 0, inverted_after = 0;  ///< by the certificate, and not so in the baseline
  Index middles = 0;                              ///< nodes between corners of second-order elements that were pulled
};

/// Moves nodes around bad cells so that the relative shapes of all corners around become better, those of boundaries
/// that slide on their surfaces; nothing moves where no cell is bad, and nothing gets worse (docs/quality.md: of blocks
/// smooth_shapes(), of elements relax_bad_elements() has what is done, in which order). mesh: what the plan was made
/// for; morphed: what a Morpher of it made. Explicit, the same bits for any number of threads; elements work on the
/// default host instance. Cost: one look at all cells; where some are bad, about 1 kB per node around them and a few
/// microseconds per sweep and node.
GuardReport guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan, Coordinates& morphed);

struct StepOptions {
  int steps = 2;
  PlanOptions plan;                        ///< of every step; `motion` is what the step does
  std::function<void(int step)> progress;  ///< called before each step, from 1; may be empty
};

/// Morphs a mesh of elements in several steps, each planned on the mesh that the one before left, and smoothed around
/// elements that it made bad (guard()). Displacements that add up along straight lines shear what lies between a body
/// that turns and a boundary that stands; steps follow the turn (MotionPath). Boundary conditions and slip surfaces are
/// those of `plan`, which was made for the mesh; its boundary nodes get `displacement` exactly.
///
/// Returns the new coordinates. Throws PlanError for a plan of blocks, and for a background mesh of the user's, which
/// stands still while the walls move. Cost: a plan, an apply and a guard per step, and room for a second list of
/// elements, whose coordinates move on the way.
Coordinates morph_in_steps(IndexedMesh const& mesh, MorphPlan const& plan, std::vector<Vec3> const& displacement,
                           StepOptions const& options);

struct SmoothingMap;  ///< plan/smoothing_map.hpp

struct FreezeOptions {
  /// Directions of the boundary's displacement along which those recorded differ by less than this share of the largest
  /// are one.
  double least_share = 1e-3;
  /// Per node of the mesh the number of its part, of parts that nothing connects: the shifts of a part are then a
  /// function of the displacement of that part's boundary alone. Empty: the mesh is one part.
  std::vector<int> part_of_node{};
};

/// Records boundary displacements u_k with the meshes that a plan and then a guard made of them: guard(),
/// smooth_frozen(), morph_in_steps(), or the caller's own. map() is the linear function of u that
/// fits the guard's shifts s_k best:
///
///   shift(u) = sum over d of (g_d . u) s_d
///
/// with the smallest sum over k of |shift(u_k) - s_k|^2, zero for u at right angles to all u_k,
///
/// by the eigenvectors v_d and eigenvalues l_d of the products u_k . u_m (sums over boundary nodes): g_d = sum of
/// v_d(k) u_k / l_d, s_d = sum of v_d(k) s_k. One displacement comes back to round-off, scaled ones scaled; of a
/// sequence all steps share one map. What it does to displacements that no combination of those recorded makes is as
/// good as their likeness: docs/quality.md has figures. Deterministic.
class SmoothingRecord {
 public:
  static constexpr int most = 32;  ///< displacements

  /// The record keeps the plan.
  explicit SmoothingRecord(MorphPlan plan) : plan_(std::move(plan)) {}

  /// boundary: as for a Morpher; plain: what it makes; guarded: what a guard made of that. Throws ConfigError for other
  /// sizes, and for more than `most`. Memory: 24 bytes per boundary node, 32 per node that the guard moved.
  void add(std::span<Vec3 const> boundary, Coordinates const& plain, Coordinates const& guarded);

  [[nodiscard]] int size() const { return int(recorded_.size()); }

  /// Cost: O(size^2 boundary nodes), O(size) per node that some guard moved.
  [[nodiscard]] std::shared_ptr<SmoothingMap const> map(FreezeOptions const& options = {}) const;

 private:
  struct Recorded {
    std::vector<Vec3> boundary;
    std::vector<std::pair<Index, Vec3>> shift;  ///< ascending by node
  };

  MorphPlan plan_;
  std::vector<Recorded> recorded_;
};

/// The plan with what guard() makes of these boundary displacements as a part of it; of several displacements of blocks
/// smooth_frozen() around all cells that lose their shape in any of the meshes. mesh: what the plan was made for.
/// Throws as SmoothingRecord::add(). Cost: a morph, a look at all cells and a smoothing per displacement.
MorphPlan freeze_guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                       std::span<std::vector<Vec3> const> boundaries, FreezeOptions const& options = {});

}  // namespace gridmorph
