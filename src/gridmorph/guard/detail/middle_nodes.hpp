// Nodes amid edges and faces of second-order elements, pulled where these are broken by them alone.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/plan/guarded_elements.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <span>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// The further nodes of a plan's mesh. Those that a rule gives a displacement, and those with a periodic image, stay;
/// those on slip surfaces stay on these.
class MiddleNodes {
 public:
  /// signs: numbering_signs(). All that is given must outlive it.
  MiddleNodes(Mesh const& mesh, GuardedElements const& plan, ElementTables<Kokkos::HostSpace> const& tables,
              std::vector<signed char> const& signs);

  /// An element is broken by its middles when its margin (kernels/curved_margin.hpp) has fallen below `share` of the
  /// baseline's, or below the baseline's where that is not positive, and the element with the same corners and straight
  /// edges is valid. Around those of `suspects`, movable nodes get a place to go to, x*: offsets interpolated between
  /// those of the nodes that stay, over `rings` of elements, in 2 rings^2 Jacobi sweeps; nodes amid faces and elements
  /// where their edges put them, off by as much as opposite faces are; else, where that does not do, straight: no
  /// offsets. Then nodes of broken elements go an eighth of the way after the other, until none is broken or all went
  /// the whole way. What leaves more invalid or, as many, more broken ones, or as many with a smaller smallest margin,
  /// is taken back. Returns the rows of GuardedElements::middle that moved, ascending. Explicit; the same bits for any
  /// number of threads. Cost: two margins per suspect, up to 10 for each element around.
  std::vector<Index> pull(std::vector<Index32> const& suspects, double share, Coordinates& x);

 private:
  static constexpr int rings_at_first = 4, rings_at_most = 16;

  struct Place {
    Index32 row, element;
    std::int8_t at;  ///< in the element's list of nodes
  };
  class Interpolation;
  struct Verdict {
    std::vector<Index32> broken;  ///< ascending
    Index invalid = 0;            ///< of these: margin not above 0, as it may be somewhere
    double smallest = 1;          ///< margin

    [[nodiscard]] bool better_than(Verdict const& other) const {
      if (invalid != other.invalid) return invalid < other.invalid;
      return broken.size() != other.broken.size() ? broken.size() < other.broken.size() : smallest > other.smallest;
    }
  };

  void find_places();
  [[nodiscard]] double margin_at(CoordinateViews<Kokkos::HostSpace> const& x, Index32 element) const;
  [[nodiscard]] bool straight_one_is_valid(CoordinateViews<Kokkos::HostSpace> const& x, Index32 element) const;
  [[nodiscard]] Verdict judge(std::vector<Index32> const& elements, double share, Coordinates const& x);
  /// Rows that may move and have a place in one of the elements; ascending.
  [[nodiscard]] std::vector<Index32> rows_of(std::vector<Index32> const& elements) const;
  [[nodiscard]] std::vector<Index32> elements_of(std::vector<Index32> const& rows) const;
  [[nodiscard]] std::vector<Vec3> interpolated(std::vector<Index32> const& region, int sweeps,
                                               Coordinates const& x) const;
  [[nodiscard]] std::vector<Vec3> straight(std::vector<Index32> const& rows, Coordinates const& x) const;
  [[nodiscard]] Vec3 on_surfaces(Index32 row, Vec3 const& place) const;
  void set(Index32 row, Vec3 const& place, Coordinates& x) const;
  /// `now` becomes what it made; rows that moved for the better are added to `touched`.
  void pull_to(std::vector<Index32> const& rows, std::vector<Vec3> const& goals, double share, Verdict& now,
               std::vector<Index32>& touched, Coordinates& x);

  Mesh const& mesh_;
  GuardedElements const& plan_;
  ElementTables<Kokkos::HostSpace> const& tables_;
  std::vector<signed char> const& signs_;
  std::vector<Index32> row_of_;        ///< (nodes) of what represents them, or -1
  std::vector<std::uint8_t> movable_;  ///< (rows)
  std::vector<Place> places_;          ///< row after row
  std::vector<Index> first_place_;     ///< (rows + 1)
  CsrGraph copies_;                    ///< (rows) nodes that coincide with a row's
  std::vector<Index32> slides_;        ///< (rows) entry of GuardedElements::middle_on_boundary, or -1
  std::vector<double> margin_before_;  ///< (elements) in the baseline; NaN where nobody asked yet
};

}  // namespace gridmorph::detail
