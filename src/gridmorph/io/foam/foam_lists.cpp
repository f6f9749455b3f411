#include <gridmorph/core/error.hpp>
#include <gridmorph/io/foam/foam_lists.hpp>

#include <algorithm>
#include <string>
#include <string_view>

namespace gridmorph::foam {

namespace {

/// Checks what the lists say of one another.
void check(Lists const& lists, std::string const& where) {
  auto const& [points, single, faces, owner, neighbour, boundary, cell_zones, face_zones] = lists;
  Problems problems;
  if (owner.size() != std::size_t(faces.size()))
    problems.add(where + "owner has " + std::to_string(owner.size()) + " values for " + std::to_string(faces.size()) +
                 " faces");
  if (neighbour.size() > owner.size())
    problems.add(where + "neighbour has " + std::to_string(neighbour.size()) + " values, more than there are faces");
  Index const n = points.size();
  for (Index f = 0; f < faces.size() && problems.empty(); ++f) {
    auto const nodes = faces[f];
    if (nodes.size() < 3)
      problems.add(where + "face " + std::to_string(f) + " has " + std::to_string(nodes.size()) + " nodes");
    for (Index32 const v : nodes)
      if (v >= n && problems.empty())
        problems.add(where + "face " + std::to_string(f) + " has node " + std::to_string(v) + ", and there are " +
                     std::to_string(n) + " points, counted from 0");
  }
  // Every cell has four faces at least, so that damaged labels ask for no memory.
  auto const most = Index32(faces.size() / 2 + 1);
  auto const bad = [&](std::vector<Index32> const& list, char const* name) {
    auto const at = std::find_if(list.begin(), list.end(), [&](Index32 c) { return c < 0 || c >= most; });
    if (at != list.end())
      problems.add(where + name + " of face " + std::to_string(at - list.begin()) + " is cell " + std::to_string(*at) +
                   ", which " + std::to_string(lists.faces.size()) + " faces cannot make");
  };
  bad(owner, "owner");
  bad(neighbour, "neighbour");
  problems.throw_if_any<MeshError>();
}

}  // namespace

Index32 Lists::n_cells() const {
  Index32 last = -1;
  for (auto const* list : {&owner, &neighbour})
    for (Index32 const c : *list) last = std::max(last, c);
  return last + 1;
}

Lists read_lists(Folders const& from) {
  auto const file = [&](char const* name, std::vector<std::string_view> const& classes) {
    return FoamFile((from.mesh / name).string(), classes);
  };
  auto const zones = [&](char const* name, char const* key, Index n) {
    return is_there((from.mesh / name).string()) ? file(name, {"regIOobject"}).zones(key, n) : std::vector<ZoneEntry>();
  };
  Lists out;
  FoamFile points((from.points / "points").string(), {"vectorField"});
  out.points = points.coordinates();
  out.single_precision = points.is_binary() && points.scalar_bytes() == 4;
  out.faces = file("faces", {"faceList", "faceCompactList"}).faces();
  out.owner = file("owner", {"labelList"}).labels(out.faces.size());
  out.neighbour = file("neighbour", {"labelList"}).labels(out.faces.size());
  // Old files name no neighbour of faces on the boundary by -1.
  while (!out.neighbour.empty() && out.neighbour.back() < 0) out.neighbour.pop_back();
  check(out, from.mesh.string() + ": ");
  out.boundary = file("boundary", {"polyBoundaryMesh"}).boundary(out.faces.size());
  out.cell_zones = zones("cellZones", "cellLabels", out.n_cells());
  out.face_zones = zones("faceZones", "faceLabels", out.faces.size());
  return out;
}

}  // namespace gridmorph::foam
