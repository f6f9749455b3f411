// What the boundary of every passage of a wheel does, from what it would do if all passages had one blade.
#pragma once

#include <gridmorph/wheel/blade_share.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <utility>
#include <vector>

namespace gridmorph {

/// What stands in the passages of one row.
struct WheelRowBlades {
  int passages = 1;         ///< how many are made
  std::vector<int> blades;  ///< which motion each has; as many as passages. Beyond the last comes the first again.
};

/// Motions that are an earlier one at another time, as blades of a travelling wave are: the number of that, per motion;
/// itself for the others.
using SameRules = std::vector<int>;
/// For motions of which none is another one's.
SameRules all_differ(std::size_t motions);

/// Throws MotionError for motions with regions, which passages of a wheel do without.
void refuse_regions(std::vector<Motion> const& motions);
/// Numbers of the motions that stand in any passage, ascending.
std::vector<int> used_motions(std::vector<WheelRowBlades> const& blades);
/// Per row whether its blades differ: then its periodic sides move independently.
std::vector<char> open_rows(std::vector<WheelRowBlades> const& blades);

/// Boundary nodes of a plan that serves all passages, with their displacements by each motion. Passages are in the
/// frame of the sector mesh.
class PassageMotions {
 public:
  struct Node {
    Vec3 place;  ///< in the baseline
    int row = 0;
    BladeShare share;
  };

  PassageMotions() = default;
  /// values: per motion and node; empty for motions that no passage has. blades: per row.
  PassageMotions(WheelRows const& rows, std::vector<WheelRowBlades> blades, std::vector<Node> nodes,
                 std::vector<std::vector<Vec3>> values);

  /// The same blades at another time.
  void take(std::vector<std::vector<Vec3>> values) { values_ = std::move(values); }

  /// Displacements of the nodes in a passage. Passages beyond the last of a row have those of its first ones.
  [[nodiscard]] std::vector<Vec3> boundary(int passage) const;
  /// Whose displacements boundary() has.
  [[nodiscard]] std::vector<Node> const& nodes() const { return nodes_; }
  /// Whether two passages have equal displacements, because they and their neighbours have equal blades.
  [[nodiscard]] bool alike(int passage, int other) const;
  /// The first passage whose displacements a passage has: itself where there is none before it.
  [[nodiscard]] int first_alike(int passage) const;
  /// The passages of the row that has most.
  [[nodiscard]] int n_passages() const;

 private:
  [[nodiscard]] int motion_of(int row, int passage) const;

  std::vector<RowPitch> pitches_;  ///< per row
  std::vector<WheelRowBlades> blades_;
  std::vector<Node> nodes_;
  std::vector<std::vector<Vec3>> values_;
};

}  // namespace gridmorph
