// Turns the two ranges of a matching connection into an index map.
#pragma once

#include <gridmorph/io/cgns/cgns_ranges.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph::cgns {

struct Joined {
  enum class Outcome { joined, skipped, wrong };
  Outcome outcome = Outcome::joined;
  std::string why;   ///< the reason unless joined; where joined, what was assumed (may be empty)
  IndexRange range;  ///< own nodes, ascending
  IndexMap to_donor;
};

/// Joins two vertex ranges through a SIDS Transform: Index2 = T.(Index1 - Begin1) + Begin2. Both ranges are inside
/// their zones.
///
/// A zero in Transform is rebuilt: its axis goes to the donor axis nobody else goes to, in the direction that the
/// ranges run, or for the face normal in the direction that leads out of one zone into the other. The sign for the
/// normal is not needed to match nodes, and files are seen with either; the map always continues into the donor.
Joined join(ZoneLayout const& zone, Corners const& own, ZoneLayout const& donor, Corners const& other,
            std::vector<std::int64_t> const& transform);

/// Joins two point sets whose points correspond one by one, if they are rectangles and the correspondence is a signed
/// permutation of the axes. `own_face` is the node range of `own`; donor points are two corners if `donor_is_range`.
Joined join_lists(ZoneLayout const& zone, PointSet const& own, IndexRange const& own_face, ZoneLayout const& donor,
                  std::vector<Index3> const& donor_points, bool donor_is_range);

}  // namespace gridmorph::cgns
