#include <gridmorph/boundary/contradicted_periodics.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {
namespace {

constexpr int uncovered = -1;

/// Who covers each cell of one zone face. Owners: patch p >= 0, interface link -2 - l, or uncovered.
struct FaceCells {
  int zone, axis, side;
  int u, v;    ///< tangential axes
  int nu, nv;  ///< cells along them
  std::vector<int> owner;

  FaceCells(Mesh const& mesh, int zone_, int axis_, int side_)
      : zone(zone_), axis(axis_), side(side_), u(axis == 0 ? 1 : 0), v(axis == 2 ? 1 : 2) {
    nu = mesh.zones[zone].extent[u] - 1;
    nv = mesh.zones[zone].extent[v] - 1;
    owner.assign(std::size_t(nu) * nv, uncovered);
  }
  int& at(int a, int b) { return owner[std::size_t(b) * nu + a]; }

  [[nodiscard]] IndexRange node_range(Mesh const& mesh, int a0, int a1, int b0, int b1) const {
    IndexRange r;
    r.begin[axis] = side == 0 ? 0 : mesh.zones[zone].extent[axis] - 1;
    r.end[axis] = r.begin[axis] + 1;
    r.begin[u] = a0;
    r.end[u] = a1 + 1;
    r.begin[v] = b0;
    r.end[v] = b1 + 1;
    return r;
  }
};

bool lies_on(Mesh const& mesh, FaceCells const& face, IndexRange const& r) {
  int const plane = face.side == 0 ? 0 : mesh.zones[face.zone].extent[face.axis] - 1;
  return r.extent(face.axis) == 1 && r.begin[face.axis] == plane && r.extent(face.u) > 1 && r.extent(face.v) > 1;
}

/// Overlaps found while marking: (patch, other owner) -> first place.
using Overlaps = std::map<std::pair<int, int>, IndexRange>;

/// Numbers of the patches of each zone.
std::vector<std::vector<int>> patches_by_zone(Mesh const& mesh) {
  std::vector<std::vector<int>> out(mesh.zones.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) out[mesh.patches[p].zone].push_back(int(p));
  return out;
}

/// Whether one patch or interface covers the face and nothing else lies on it: the rule in most meshes, and known
/// without a look at single cells.
bool has_one_owner(Mesh const& mesh, Links const& links, std::vector<int> const& patches, int zone, int axis,
                   int side) {
  int const plane = side == 0 ? 0 : mesh.zones[zone].extent[axis] - 1;
  IndexRange whole{{0, 0, 0}, mesh.zones[zone].extent};
  whole.begin[axis] = plane;
  whole.end[axis] = plane + 1;
  int on_face = 0;
  bool covered = false;
  auto const count = [&](IndexRange const& r) {
    if (r.extent(axis) != 1 || r.begin[axis] != plane) return;
    ++on_face;
    covered = covered || r == whole;
  };
  for (int const l : links.of_zone[zone]) count(links.all[l].range);
  for (int const p : patches) count(mesh.patches[p].range);
  return covered && on_face == 1;
}

FaceCells mark(Mesh const& mesh, Links const& links, std::vector<int> const& patches, int zone, int axis, int side,
               Overlaps* overlaps) {
  FaceCells face(mesh, zone, axis, side);
  auto cover = [&](IndexRange const& r, int who) {
    for (int b = r.begin[face.v]; b < r.end[face.v] - 1; ++b)
      for (int a = r.begin[face.u]; a < r.end[face.u] - 1; ++a) {
        int& owner = face.at(a, b);
        if (owner != uncovered && overlaps && (owner >= 0 || who >= 0))
          overlaps->try_emplace({std::max(owner, who), std::min(owner, who)},
                                face.node_range(mesh, a, a + 1, b, b + 1));
        owner = who;
      }
  };
  for (int l : links.of_zone[zone])
    if (lies_on(mesh, face, links.all[l].range)) cover(links.all[l].range, -2 - l);
  for (int const p : patches)
    if (lies_on(mesh, face, mesh.patches[p].range)) cover(mesh.patches[p].range, p);
  return face;
}

/// Covers the cells that nothing claims by rectangles, as large as a greedy row scan finds them.
std::vector<IndexRange> open_rectangles(Mesh const& mesh, FaceCells& face) {
  std::vector<IndexRange> found;
  for (int b = 0; b < face.nv; ++b)
    for (int a = 0; a < face.nu; ++a) {
      if (face.at(a, b) != uncovered) continue;
      int a1 = a;
      while (a1 < face.nu && face.at(a1, b) == uncovered) ++a1;
      int b1 = b + 1;
      auto row_is_open = [&](int row) {
        for (int c = a; c < a1; ++c)
          if (face.at(c, row) != uncovered) return false;
        return true;
      };
      while (b1 < face.nv && row_is_open(b1)) ++b1;
      for (int row = b; row < b1; ++row)
        for (int c = a; c < a1; ++c) face.at(c, row) = 0;
      found.push_back(face.node_range(mesh, a, a1, b, b1));
    }
  return found;
}

/// Whether a face range is collapsed to a line or a point: all its cells have (almost) no area.
bool is_collapsed(Mesh const& mesh, int zone, IndexRange const& r, double size) {
  double extent[3] = {0, 0, 0};
  Zone const& z = mesh.zones[zone];
  auto const stride = z.strides();
  for (int a = 0; a < 3; ++a)
    if (r.begin[a] < 0 || r.end[a] > z.extent[a]) return false;  // check_coverage reports it
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        Index3 const p{i, j, k};
        for (int a = 0; a < 3; ++a)
          if (p[a] + 1 < r.end[a]) {
            Index const n = z.node(p);
            extent[a] = std::max(extent[a], distance(mesh.coordinates[n], mesh.coordinates[n + stride[a]]));
          }
      }
  double const tolerance = std::max(1e-12 * size, coordinate_resolution(mesh, zone));
  for (int a = 0; a < 3; ++a)
    if (r.extent(a) > 1 && extent[a] < tolerance) return true;
  return false;
}

template <class Visit>
void for_each_face(Mesh const& mesh, Visit&& visit) {
  for (int z = 0; z < int(mesh.zones.size()); ++z)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) visit(z, axis, side);
}

/// Throws MeshError naming every patch that is not a part of one face of an existing zone.
void check_patch_ranges(Mesh const& mesh) {
  Problems problems;
  for (Patch const& patch : mesh.patches) {
    if (patch.zone < 0 || patch.zone >= int(mesh.zones.size())) {
      problems.add("patch '" + patch.name + "' is on zone number " + std::to_string(patch.zone) +
                   ", and the mesh has " + std::to_string(mesh.zones.size()) + "; correct the boundary condition");
      continue;
    }
    int flat = 0;
    bool inside = true, on_face = false;
    for (int a = 0; a < 3; ++a) {
      int const n = mesh.zones[patch.zone].extent[a];
      inside = inside && patch.range.begin[a] >= 0 && patch.range.end[a] <= n && patch.range.extent(a) > 0;
      if (patch.range.extent(a) == 1) {
        ++flat;
        on_face = on_face || patch.range.begin[a] == 0 || patch.range.begin[a] == n - 1;
      }
    }
    if (!inside || flat != 1 || !on_face)
      problems.add("patch " + describe_patch(mesh, patch) + ": range " + to_string(patch.range) +
                   " is not a part of one face of its zone (" + to_string({{0, 0, 0}, mesh.zones[patch.zone].extent}) +
                   "); correct the boundary condition");
  }
  problems.throw_if_any<MeshError>();
}

}  // namespace

void complete_patches(Mesh& mesh, Links const& links, TopologyOptions const& options) {
  check_patch_ranges(mesh);
  int poles = 0, open = 0;
  for (Patch& patch : mesh.patches) {
    bool const solid =
        patch.kind == PatchKind::wall || patch.kind == PatchKind::inflow || patch.kind == PatchKind::outflow;
    if (solid || patch.kind == PatchKind::degenerate || !is_collapsed(mesh, patch.zone, patch.range, links.mesh_size))
      continue;
    mesh.notes.push_back("patch " + describe_patch(mesh, patch) + " is collapsed to a line; taken as a pole");
    patch.kind = PatchKind::degenerate;
  }
  std::vector<Patch> added;
  auto const patches = patches_by_zone(mesh);
  for_each_face(mesh, [&](int z, int axis, int side) {
    if (has_one_owner(mesh, links, patches[z], z, axis, side)) return;
    FaceCells face = mark(mesh, links, patches[z], z, axis, side, nullptr);
    for (IndexRange const& r : open_rectangles(mesh, face)) {
      bool const pole = is_collapsed(mesh, z, r, links.mesh_size);
      if (!pole && options.open_faces.empty()) continue;
      std::string const name = pole ? "pole" : options.open_faces;
      added.push_back({name, "", pole ? PatchKind::degenerate : PatchKind::other, {}, z, r});
      ++(pole ? poles : open);
    }
  });
  mesh.patches.insert(mesh.patches.end(), added.begin(), added.end());
  if (poles > 0) mesh.notes.push_back(std::to_string(poles) + " undeclared collapsed faces taken as patch 'pole'");
  if (open > 0)
    mesh.notes.push_back(std::to_string(open) + " face ranges claimed by nothing taken as patch '" +
                         options.open_faces + "'");
}

void check_coverage(Mesh const& mesh, Links const& links) {
  check_patch_ranges(mesh);
  Problems problems;
  auto const patches = patches_by_zone(mesh);
  for_each_face(mesh, [&](int z, int axis, int side) {
    if (has_one_owner(mesh, links, patches[z], z, axis, side)) return;
    Overlaps overlaps;
    FaceCells face = mark(mesh, links, patches[z], z, axis, side, &overlaps);
    for (auto const& [who, where] : overlaps) {
      std::string const other = who.second >= 0
                                    ? "patch " + describe_patch(mesh, mesh.patches[who.second])
                                    : "interface '" + mesh.interfaces[links.all[-2 - who.second].interface].name + "'";
      problems.add("patch " + describe_patch(mesh, mesh.patches[who.first]) + " overlaps " + other + ", first at " +
                   describe_range(mesh, z, where) + "; a face cell can belong to one of them only");
    }
    for (IndexRange const& r : open_rectangles(mesh, face))
      problems.add(
          describe_range(mesh, z, r) +
          " has neither a boundary condition nor a 1-to-1 interface; add one, or declare open faces as a patch "
          "(open_faces = \"open\")");
  });
  problems.throw_if_any<MeshError>();
}

Links connect_and_check(HostInstance const& host, Mesh& mesh, TopologyOptions const& options) {
  check_coordinates(mesh, "gridmorph::connect_and_check");
  check_usable(host, mesh, "gridmorph::connect_and_check");
  Problems problems;
  Links links = connect(host, mesh, options, problems);
  try {
    complete_patches(mesh, links, options);
    check_coverage(mesh, links);
  } catch (MeshError const& e) {
    problems.add(e.what());
  }
  problems.throw_if_any<MeshError>();
  for (auto& line : contradicted_periodics(mesh, links.mesh_size)) mesh.notes.push_back(std::move(line));
  return links;
}

}  // namespace gridmorph
