// 1-to-1 interfaces from what CGNS files and most solvers keep of them: two ranges of nodes and a Transform.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <optional>
#include <string>

namespace gridmorph {

/// Two opposite corners of nodes, 1-based and inclusive; begin may exceed end (CGNS SIDS PointRange).
struct PointRange {
  Index3 begin{1, 1, 1};
  Index3 end{1, 1, 1};
};

/// The interface between a face range of one zone and one of another, or of the same:
///
///   donor index = T (own index - range.begin) + donor_range.begin
///
/// with Transform[a] = +-d: a step along own axis a is one along donor axis d = 1, 2, 3, forwards or backwards (CGNS
/// SIDS). A single zero in Transform is rebuilt; the sign of the face normal is not needed to match nodes and may be
/// either. Where donor_range does not end where Transform says, it is taken as a range without direction. `periodic`
/// may be set afterwards. Throws MeshError: ranges that are not on a face of their zone, or do not fit each other.
Interface1to1 interface_from_ranges(Mesh const& mesh, std::string name, int zone, PointRange const& range,
                                    int donor_zone, PointRange const& donor_range, std::array<int, 3> const& transform);

namespace detail {

/// A face of nodes as a file gives it, and as nodes of the mesh.
struct FaceOfRange {
  PointRange corners;
  IndexRange nodes;
  int normal;
};

/// The index map from one face to the other. `why`: what is wrong where there is none, else what was assumed, or
/// nothing.
std::optional<IndexMap> join_faces(FaceOfRange const& own, FaceOfRange const& donor, std::array<int, 3> transform,
                                   std::string& why);

/// The sign of a step through a face: +1 where a step out of the own zone through its face leads into the donor at
/// growing index, -1 where at falling index; as a factor on the own step.
int sign_through(IndexRange const& own, int own_normal, IndexRange const& donor, int donor_normal);

/// Whether the entries are +-1, +-2, +-3 in some order; fills o.
bool as_orientation(std::array<int, 3> const& transform, Orientation& o);

}  // namespace detail

}  // namespace gridmorph
