#include <gridmorph/fillet/split_mesh.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

/// The face that a patch lies on: axis and side.
std::pair<int, int> face_of(Mesh const& mesh, Patch const& patch) {
  for (int axis = 0; axis < 3; ++axis)
    if (patch.range.extent(axis) == 1) return {axis, patch.range.begin[axis] == 0 ? 0 : 1};
  throw MeshError(describe_patch(mesh, patch) + " is not on a face of its zone");
}

/// Whether two patches of a zone have a line of two nodes or more in common.
bool meet(Patch const& one, Patch const& other) {
  if (one.zone != other.zone) return false;
  Index common = 1;
  for (int axis = 0; axis < 3; ++axis)
    common *= std::max(0, std::min(one.range.end[axis], other.range.end[axis]) -
                              std::max(one.range.begin[axis], other.range.begin[axis]));
  return common > 1;
}

/// Whether two patches of a zone have a line of two nodes or more in common and lie on faces of it across two
/// directions.
bool meet_in_corner(Mesh const& mesh, Patch const& one, Patch const& other) {
  return meet(one, other) && face_of(mesh, one).first != face_of(mesh, other).first;
}

class Search {
 public:
  Search(Mesh const& mesh, Links const& links) : mesh_(mesh), links_(links) { out_.of_zone.resize(mesh.zones.size()); }

  void add(Sheet const& sheet) {
    for (int n : out_.of_zone[sheet.zone]) {
      Sheet const& there = out_.all[n];
      if (there.axis == sheet.axis && there.side == sheet.side) {
        if (there.wall != sheet.wall)
          throw MeshError("the layers along the blade and those along the end wall come to lie on one face, " +
                          face_text(sheet) + "; a fillet between them needs walls that meet in a corner");
        return;
      }
      if (there.wall == sheet.wall && there.axis != sheet.axis)
        throw MeshError("layers along one wall cross in zone '" + mesh_.zones[sheet.zone].name + "', off " +
                        face_text(there) + " and " + face_text(sheet) +
                        "; a fillet needs walls whose layers do not cross");
    }
    out_.of_zone[sheet.zone].push_back(int(out_.all.size()));
    out_.all.push_back(sheet);
  }

  WallSheets run() {
    for (std::size_t n = 0; n < out_.all.size(); ++n) spread(Sheet(out_.all[n]));
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string face_text(Sheet const& sheet) const {
    return "'" + mesh_.zones[sheet.zone].name + "' " + std::string(face_name(sheet.axis, sheet.side));
  }

  void spread(Sheet const& sheet) {
    Index3 const extent = mesh_.zones[sheet.zone].extent;
    int const plane = sheet.side == 0 ? 0 : extent[sheet.axis] - 1;
    for (int n : links_.of_zone[sheet.zone]) {
      Link const& link = links_.all[n];
      if (link.range.extent(sheet.axis) == 1) continue;  // along the sheet, not across
      if (plane < link.range.begin[sheet.axis] || plane >= link.range.end[sheet.axis]) continue;
      Index3 from = link.range.begin;
      from[sheet.axis] = plane;
      Index3 const to = link.to_donor(from);
      int const axis = link.to_donor.orientation.axis[sheet.axis];
      int const inward = (sheet.side == 0 ? 1 : -1) * link.to_donor.orientation.sign[sheet.axis];
      Sheet const next{link.donor_zone, axis, inward > 0 ? 0 : 1, sheet.wall};
      if (to[axis] != (inward > 0 ? 0 : mesh_.zones[next.zone].extent[axis] - 1))
        throw MeshError("the layers off " + face_text(sheet) + " run on inside of zone '" +
                        mesh_.zones[next.zone].name + "', off its plane " + std::to_string(to[axis] + 1) + " along " +
                        "ijk"[axis] + "; cut the zone there, so that the wall goes on as a face");
      add(next);
    }
  }

  Mesh const& mesh_;
  Links const& links_;
  WallSheets out_;
};

}  // namespace

bool meet_in_corners(Mesh const& mesh, std::span<int const> blade, std::span<int const> end_wall) {
  return std::any_of(blade.begin(), blade.end(), [&](int b) {
    return std::any_of(end_wall.begin(), end_wall.end(),
                       [&](int w) { return b != w && meet_in_corner(mesh, mesh.patches[b], mesh.patches[w]); });
  });
}

WallSheets find_wall_sheets(Mesh const& mesh, Links const& links, std::span<int const> blade,
                            std::span<int const> end_wall) {
  Search search(mesh, links);
  bool found = false;
  for (int b : blade)
    for (int w : end_wall) {
      Patch const &one = mesh.patches[b], &other = mesh.patches[w];
      if (b == w || !meet_in_corner(mesh, one, other)) continue;
      auto const [axis, side] = face_of(mesh, one);
      auto const [other_axis, other_side] = face_of(mesh, other);
      search.add({one.zone, axis, side, Wall::blade});
      search.add({one.zone, other_axis, other_side, Wall::end_wall});
      found = true;
    }
  if (!found)
    throw MeshError(
        "the blade and the end wall meet in no corner of a zone, so that there is nothing to fill; name two walls that "
        "touch, of a mesh "
        "without a fillet between them");
  return search.run();
}

}  // namespace gridmorph
