// Coordinates of coincident nodes of a wheel: one passage decides, the others copy.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/wheel/shared_nodes.hpp>

#include <map>
#include <optional>
#include <vector>

namespace gridmorph {

/// What copying changed most.
struct SeamGap {
  double distance = 0;
  Index node = -1;
  int passage = -1;
};

/// Closes the seams of one row, passage by passage from the first to the last:
/// the first copy of a point to come decides. The last passage meets the first
/// one again. The two ends of a part of a wheel are each other, that part's
/// pitches apart.
///
/// Memory: 24 bytes per interface node, for the two or three passages that are not closed yet and for the first one.
class Seams {
 public:
  /// passages: how many are made. `shared` covers all rows.
  Seams(Mesh const& mesh, SharedNodes const& shared, WheelRows const& rows, int row, int passages);

  /// Replaces the positions of the row's nodes that an earlier one decides; positions are in the wheel's frame.
  void close(int passage, Coordinates& x);

  [[nodiscard]] SeamGap const& largest_gap() const { return gap_; }

 private:
  struct Points {
    std::vector<Vec3> position;  ///< per group of the row
    std::vector<char> known;
  };

  [[nodiscard]] Points& points_at(int count);
  /// Where a point is that is known at the other end of the passages, turned by all of them.
  [[nodiscard]] std::optional<Vec3> round_the_end(int count, int group) const;

  std::vector<SharedNodes::Member> members_;  ///< of the row, groups renumbered
  std::vector<char> on_axis_;                 ///< per group
  RowPitch pitch_;
  int passages_;
  int lowest_ = 0, highest_ = 0;  ///< offsets
  std::map<int, Points> open_;    ///< by the passage of the group's own count, the first one's copies before it too
  SeamGap gap_;
};

}  // namespace gridmorph
