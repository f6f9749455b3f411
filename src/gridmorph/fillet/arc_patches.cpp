#include <gridmorph/fillet/arc_patches.hpp>

#include <gridmorph/fillet/corner_frame.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace gridmorph {

namespace {

constexpr std::string_view fillet_suffix = "_fillet";
constexpr std::size_t longest_arc_name = 32;  // of a CGNS node

std::string with_suffix(std::string const& name) {
  return name.substr(0, longest_arc_name - fillet_suffix.size()) + std::string(fillet_suffix);
}

/// Makes patches of arcs from those of the walls that they are taken from.
class ArcNames {
 public:
  ArcNames(Mesh const& before, FilletOptions const& options, Mesh& to) {
    Patch const& blade = before.patches[options.blade.front()];
    std::string const family = blade.families.empty() ? blade.name : blade.families.front();
    name_ = with_suffix(blade.name);
    families_ = {with_suffix(family), family};
    std::set<std::string> known{families_.front()};
    // Pieces of one zone cannot all have the name of the wall, so that walls without a family get one of that name.
    for (auto const* walls : {&options.blade, &options.end_wall})
      for (int const p : *walls) {
        Patch const& wall = before.patches[p];
        if (wall.families.empty()) known.insert(wall.name);
      }
    for (Patch& patch : to.patches) {
      if (patch.families.empty() && known.contains(patch.name)) patch.families = {patch.name};
      taken_.insert({patch.zone, patch.name});
    }
    for (std::string const& name : known)
      if (std::find(to.families.begin(), to.families.end(), name) == to.families.end()) to.families.push_back(name);
  }

  [[nodiscard]] Patch arc_of(Patch const& wall) {
    Patch out = wall;
    out.families = families_;
    for (int n = 1;; ++n) {
      std::string const end = n == 1 ? "" : std::to_string(n);
      out.name = name_.substr(0, longest_arc_name - end.size()) + end;
      if (taken_.insert({out.zone, out.name}).second) break;
    }
    return out;
  }

 private:
  std::string name_;
  std::vector<std::string> families_;
  std::set<std::pair<int, std::string>> taken_;
};

/// What is left of a range of nodes without the faces of another one that it holds.
std::vector<IndexRange> without(IndexRange const& all, IndexRange const& part, int normal) {
  std::vector<IndexRange> out;
  IndexRange rest = all;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == normal) continue;
    if (part.begin[axis] > rest.begin[axis]) {
      out.push_back(rest);
      out.back().end[axis] = part.begin[axis] + 1;
      rest.begin[axis] = part.begin[axis];
    }
    if (part.end[axis] < rest.end[axis]) {
      out.push_back(rest);
      out.back().begin[axis] = part.end[axis] - 1;
      rest.end[axis] = part.end[axis];
    }
  }
  return out;
}

}  // namespace

void separate_arcs(Mesh const& before, FilletOptions const& options, WallSheets const& sheets,
                   SheetLayers const& layers, std::span<ArcFaces const> arcs, SplitMesh& split) {
  Mesh& mesh = split.mesh;
  auto const corners = corners_of(before, sheets);
  ArcNames names(before, options, mesh);
  for (ArcFaces const& arc : arcs) {
    CornerFrame const& corner = corners[arc.corner];
    Sheet const& sheet = *corner.sheet[arc.wall];
    Sheet const& other = *corner.sheet[1 - arc.wall];
    auto const& walls = arc.wall == 0 ? options.blade : options.end_wall;
    for (std::size_t p = 0, count = mesh.patches.size(); p < count; ++p) {
      SplitZone const& part = split.zones[mesh.patches[p].zone];
      if (part.sheet < 0 || &sheets.all[part.sheet] != &sheet) continue;
      if (std::find(walls.begin(), walls.end(), split.patches[p]) == walls.end()) continue;
      Patch const wall = mesh.patches[p];
      int const on_wall = sheet.side == 0 ? 0 : layers.made;
      if (wall.range.extent(sheet.axis) != 1 || wall.range.begin[sheet.axis] != on_wall) continue;
      IndexRange faces = wall.range;
      int const extent = part.box.extent(other.axis), along = corner.along();
      int const low = other.side == 0 ? 0 : extent - 1 - arc.faces, high = other.side == 0 ? arc.faces : extent - 1;
      auto const clip = [&](int axis, int begin, int end) {
        faces.begin[axis] = std::max(faces.begin[axis], begin);
        faces.end[axis] = std::min(faces.end[axis], end);
      };
      clip(other.axis, low, high + 1);
      clip(along, arc.first_station - part.box.begin[along], arc.last_station - part.box.begin[along] + 1);
      if (faces.extent(other.axis) < 2 || faces.extent(along) < 2) continue;
      auto const rest = without(wall.range, faces, sheet.axis);
      Patch next = names.arc_of(wall);
      next.range = faces;
      mesh.patches[p] = std::move(next);
      int const from = split.patches[p];
      split.patches[p] = -1;  // taken
      for (std::size_t n = 0; n < rest.size(); ++n) {
        Patch piece = wall;
        piece.range = rest[n];
        mesh.patches.push_back(std::move(piece));
        split.patches.push_back(from);
      }
    }
  }
}

void separate_arcs(FilletOptions const& options, std::span<std::uint8_t const> on_arc, Mesh& mesh) {
  ArcNames names(mesh, options, mesh);
  for (auto const* walls : {&options.blade, &options.end_wall})
    for (int const p : *walls) {
      Patch& wall = mesh.patches[p];
      CsrGraph arc, rest;
      for (Index f = 0; f < wall.faces.size(); ++f) {
        auto const face = wall.faces[f];
        bool const of_arc = std::any_of(face.begin(), face.end(), [&](Index32 n) { return on_arc[n] != 0; });
        (of_arc ? arc : rest).add(face);
      }
      if (arc.size() == 0 || rest.size() == 0) continue;
      wall.faces = std::move(rest);
      Patch next = names.arc_of(wall);
      next.faces = std::move(arc);
      mesh.patches.push_back(std::move(next));
    }
}

}  // namespace gridmorph
