#include <generators/passage_zones.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::passage {

namespace {

/// An edge of a piece: i_min, i_max (axis 0) or k_min, k_max (axis 2).
struct Edge {
  Piece piece;
  int axis, side;
};

enum class Along { same, reversed, periodic };

/// Two edges that coincide, node by node in the same or in reversed order; periodic ones go from lower to upper.
struct Joint {
  Edge a, b;
  Along along;
};

constexpr std::array<Joint, 19> joints{{
    {{ring_le, 0, 1}, {ring_upper, 0, 0}, Along::same},
    {{ring_upper, 0, 1}, {ring_te, 0, 0}, Along::same},
    {{ring_te, 0, 1}, {ring_lower, 0, 0}, Along::same},
    {{ring_lower, 0, 1}, {ring_le, 0, 0}, Along::same},
    {{ring_le, 2, 1}, {inlet_middle, 0, 1}, Along::same},
    {{ring_upper, 2, 1}, {upper, 2, 0}, Along::same},
    {{ring_te, 2, 1}, {outlet_middle, 0, 0}, Along::reversed},
    {{ring_lower, 2, 1}, {lower, 2, 1}, Along::reversed},
    {{inlet_lower, 0, 1}, {lower, 0, 0}, Along::same},
    {{inlet_upper, 0, 1}, {upper, 0, 0}, Along::same},
    {{lower, 0, 1}, {outlet_lower, 0, 0}, Along::same},
    {{upper, 0, 1}, {outlet_upper, 0, 0}, Along::same},
    {{inlet_lower, 2, 1}, {inlet_middle, 2, 0}, Along::same},
    {{inlet_middle, 2, 1}, {inlet_upper, 2, 0}, Along::same},
    {{outlet_lower, 2, 1}, {outlet_middle, 2, 0}, Along::same},
    {{outlet_middle, 2, 1}, {outlet_upper, 2, 0}, Along::same},
    {{inlet_lower, 2, 0}, {inlet_upper, 2, 1}, Along::periodic},
    {{lower, 2, 0}, {upper, 2, 1}, Along::periodic},
    {{outlet_lower, 2, 0}, {outlet_upper, 2, 1}, Along::periodic},
}};

struct Boundary {
  Edge edge;
  char const* family;
};

constexpr std::array<Boundary, 10> boundaries{{{{ring_le, 2, 0}, "blade"},
                                               {{ring_upper, 2, 0}, "blade"},
                                               {{ring_te, 2, 0}, "blade"},
                                               {{ring_lower, 2, 0}, "blade"},
                                               {{inlet_lower, 0, 0}, "inlet"},
                                               {{inlet_middle, 0, 0}, "inlet"},
                                               {{inlet_upper, 0, 0}, "inlet"},
                                               {{outlet_lower, 0, 1}, "outlet"},
                                               {{outlet_middle, 0, 1}, "outlet"},
                                               {{outlet_upper, 0, 1}, "outlet"}}};

struct Found {
  int zone;
  PiecePlace place;
};

Found find(std::vector<ZoneLayout> const& layouts, Piece piece) {
  for (int z = 0; z < int(layouts.size()); ++z)
    for (PiecePlace const& p : layouts[z].pieces)
      if (p.piece == piece) return {z, p};
  return {-1, {piece}};
}

/// Nodes of an edge over the whole span, in its zone.
IndexRange edge_range(Found const& found, Edge const& edge, PassageCounts const& counts) {
  auto const [ni, nk] = piece_cells(counts, edge.piece);
  IndexRange r{{found.place.i, 0, found.place.k}, {found.place.i + ni + 1, counts.span + 1, found.place.k + nk + 1}};
  if (edge.side == 0)
    r.end[edge.axis] = r.begin[edge.axis] + 1;
  else
    r.begin[edge.axis] = r.end[edge.axis] - 1;
  return r;
}

IndexMap map_between(Joint const& joint, IndexRange const& a, IndexRange const& b) {
  int const along_a = 2 - joint.a.axis, along_b = 2 - joint.b.axis;
  IndexMap map;
  // Out of a is into b: across keeps its direction when a max face meets a min face.
  map.orientation.axis[joint.a.axis] = joint.b.axis;
  map.orientation.sign[joint.a.axis] = joint.a.side != joint.b.side ? 1 : -1;
  map.orientation.axis[along_a] = along_b;
  map.orientation.sign[along_a] = joint.along == Along::reversed ? -1 : 1;
  map.own_origin = a.begin;
  map.donor_origin = b.begin;
  if (joint.along == Along::reversed) map.donor_origin[along_b] = b.end[along_b] - 1;
  return map;
}

std::string connection_name(Piece from, Piece to) {
  std::string text(name(from));
  text += "_to_";
  text += name(to);
  return text;
}

/// Neighbours that simply follow one another inside one zone need no interface.
bool continues_inside(Found const& a, IndexRange const& ra, Found const& b, IndexRange const& rb) {
  return a.zone == b.zone && ra == rb;
}

void add_patch(Mesh& mesh, int zone, std::string const& family, IndexRange const& range) {
  PatchKind const kind = family == "inlet"    ? PatchKind::inflow
                         : family == "outlet" ? PatchKind::outflow
                                              : PatchKind::wall;
  char const* const type = kind == PatchKind::inflow    ? "BCInflow"
                           : kind == PatchKind::outflow ? "BCOutflow"
                                                        : "BCWallViscous";
  for (Patch& p : mesh.patches) {
    if (p.zone != zone || p.families.front() != family) continue;
    // Pieces tile their zone, so the patches of one face join to a box.
    for (int d = 0; d < 3; ++d) {
      p.range.begin[d] = std::min(p.range.begin[d], range.begin[d]);
      p.range.end[d] = std::max(p.range.end[d], range.end[d]);
    }
    return;
  }
  mesh.patches.push_back({family + "_" + mesh.zones[zone].name, type, kind, {family}, zone, range});
}

/// Angles about x, y, z whose rotations, applied in this order, make the matrix (CGNS SIDS RotationAngle).
Vec3 rotation_angles(Mat3 const& r) {
  auto const& m = r.m;
  return {std::atan2(m[2][1], m[2][2]), std::atan2(-m[2][0], std::hypot(m[0][0], m[1][0])),
          std::atan2(m[1][0], m[0][0])};
}

}  // namespace

std::vector<ZoneLayout> zone_layouts(PassageOptions::Layout layout, PassageCounts const& counts) {
  std::vector<ZoneLayout> zones;
  if (layout == PassageOptions::Layout::whole_faces) {
    for (int n = 0; n < n_pieces; ++n)
      zones.push_back({std::string(name(Piece(n))), {{Piece(n)}}, piece_cells(counts, Piece(n))});
    return zones;
  }
  auto const stacked = [&](char const* zone_name, std::vector<Piece> const& pieces, int axis) {
    ZoneLayout zone{zone_name, {}, piece_cells(counts, pieces.front())};
    zone.cells[axis] = 0;
    for (Piece const p : pieces) {
      zone.pieces.push_back({p, axis == 0 ? zone.cells[0] : 0, axis == 1 ? zone.cells[1] : 0});
      zone.cells[axis] += piece_cells(counts, p)[axis];
    }
    zones.push_back(std::move(zone));
  };
  stacked("ring", {ring_le, ring_upper, ring_te, ring_lower}, 0);
  stacked("h_inlet", {inlet_lower, inlet_middle, inlet_upper}, 1);
  stacked("h_lower", {lower}, 1);
  stacked("h_upper", {upper}, 1);
  stacked("h_outlet", {outlet_lower, outlet_middle, outlet_upper}, 1);
  return zones;
}

void add_zones(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts) {
  for (ZoneLayout const& zone : layouts)
    mesh.add_zone(zone.name, {zone.cells[0] + 1, counts.span + 1, zone.cells[1] + 1});
}

void add_patches(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts, bool left_handed) {
  mesh.families = {"blade", "hub", "case", "inlet", "outlet"};
  for (Boundary const& b : boundaries) {
    Found const found = find(layouts, b.edge.piece);
    add_patch(mesh, found.zone, b.family, edge_range(found, b.edge, counts));
  }
  for (int z = 0; z < int(layouts.size()); ++z) {
    Index3 const n = mesh.zones[z].extent;
    add_patch(mesh, z, left_handed ? "case" : "hub", {{0, 0, 0}, {n[0], 1, n[2]}});
    add_patch(mesh, z, left_handed ? "hub" : "case", {{0, n[1] - 1, 0}, n});
  }
}

void add_interfaces(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts,
                    RigidTransform const& turn, Vec3 const& center) {
  auto const periodic_with = [&](RigidTransform const& t) {
    return Periodic{center, rotation_angles(t.rotation), {}, t};
  };
  for (Joint const& joint : joints) {
    Found const a = find(layouts, joint.a.piece), b = find(layouts, joint.b.piece);
    IndexRange const ra = edge_range(a, joint.a, counts), rb = edge_range(b, joint.b, counts);
    bool const periodic = joint.along == Along::periodic;
    if (!periodic && continues_inside(a, ra, b, rb)) continue;
    IndexMap const map = map_between(joint, ra, rb);
    Interface1to1 own{connection_name(joint.a.piece, joint.b.piece), {}, a.zone, b.zone, ra, map, {}};
    Interface1to1 other{connection_name(joint.b.piece, joint.a.piece), {}, b.zone, a.zone, rb, map.inverse(), {}};
    if (periodic) {
      own.periodic = periodic_with(turn);
      other.periodic = periodic_with(turn.inverse());
    }
    mesh.interfaces.push_back(std::move(own));
    mesh.interfaces.push_back(std::move(other));
  }
}

}  // namespace gridmorph::passage
