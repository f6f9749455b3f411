#include <generators/passage_zones.hpp>
#include <generators/zone_joints.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
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

constexpr std::array<Joint, 31> joints{{
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
    // Where one of the two is not there the other one has a wall.
    {{ring_le, 2, 0}, {tip_le, 2, 1}, Along::same},
    {{ring_upper, 2, 0}, {tip_upper, 2, 1}, Along::same},
    {{ring_te, 2, 0}, {tip_te, 2, 1}, Along::same},
    {{ring_lower, 2, 0}, {tip_lower, 2, 1}, Along::same},
    {{tip_le, 0, 1}, {tip_upper, 0, 0}, Along::same},
    {{tip_upper, 0, 1}, {tip_te, 0, 0}, Along::same},
    {{tip_te, 0, 1}, {tip_lower, 0, 0}, Along::same},
    {{tip_lower, 0, 1}, {tip_le, 0, 0}, Along::same},
    {{tip_le, 2, 0}, {tip_core, 0, 0}, Along::same},
    {{tip_upper, 2, 0}, {tip_core, 2, 1}, Along::same},
    {{tip_te, 2, 0}, {tip_core, 0, 1}, Along::reversed},
    {{tip_lower, 2, 0}, {tip_core, 2, 0}, Along::reversed},
}};

struct Boundary {
  Edge edge;
  char const* family;
};

constexpr std::array<Boundary, 6> boundaries{{{{inlet_lower, 0, 0}, "inlet"},
                                              {{inlet_middle, 0, 0}, "inlet"},
                                              {{inlet_upper, 0, 0}, "inlet"},
                                              {{outlet_lower, 0, 1}, "outlet"},
                                              {{outlet_middle, 0, 1}, "outlet"},
                                              {{outlet_upper, 0, 1}, "outlet"}}};

/// A piece in a zone, and stations of the span there.
struct Found {
  int zone = -1;
  PiecePlace place{};
  int bottom = 0, top = 0;
};

Found find(PassageLayout const& layout, Piece piece, int bottom, int top) {
  for (int z = 0; z < int(layout.zones.size()); ++z) {
    ZoneLayout const& zone = layout.zones[z];
    if (zone.bottom > bottom || zone.top < top) continue;
    for (PiecePlace const& p : zone.pieces)
      if (p.piece == piece) return {z, p, bottom, top};
  }
  return {};
}

/// Nodes of an edge over these stations, in its zone.
IndexRange edge_range(PassageLayout const& layout, Found const& found, Edge const& edge) {
  auto const [ni, nk] = piece_cells(layout.counts, edge.piece);
  ZoneLayout const& zone = layout.zones[found.zone];
  int const j0 = layout.j_of(zone, found.bottom), j1 = layout.j_of(zone, found.top);
  IndexRange r{{found.place.i, std::min(j0, j1), found.place.k},
               {found.place.i + ni + 1, std::max(j0, j1) + 1, found.place.k + nk + 1}};
  if (edge.side == 0)
    r.end[edge.axis] = r.begin[edge.axis] + 1;
  else
    r.begin[edge.axis] = r.end[edge.axis] - 1;
  return r;
}

/// Calls visit(a, b) for what lies on the two sides of a joint, over as many stations as zones are the same; one of
/// them may be nothing.
template <class Visit>
void for_each_stretch(PassageLayout const& layout, Joint const& joint, Visit const& visit) {
  Found a, b;
  auto const finish = [&] {
    if (a.zone >= 0 || b.zone >= 0) visit(a, b);
  };
  for (std::size_t l = 1; l < layout.levels.size(); ++l) {
    int const bottom = layout.levels[l - 1], top = layout.levels[l];
    Found const next_a = find(layout, joint.a.piece, bottom, top), next_b = find(layout, joint.b.piece, bottom, top);
    if (l > 1 && next_a.zone == a.zone && next_b.zone == b.zone) {
      a.top = b.top = top;
      continue;
    }
    finish();
    a = next_a;
    b = next_b;
  }
  finish();
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

/// Whether two ranges of a face make one: the same but along one axis, where they touch.
bool join_to_one(IndexRange const& a, IndexRange const& b) {
  int differs = -1;
  for (int d = 0; d < 3; ++d) {
    if (a.begin[d] == b.begin[d] && a.end[d] == b.end[d]) continue;
    if (differs >= 0) return false;
    differs = d;
  }
  return differs < 0 || (a.extent(differs) > 1 && b.extent(differs) > 1 &&
                         (a.end[differs] - 1 == b.begin[differs] || b.end[differs] - 1 == a.begin[differs]));
}

void add_patch(Mesh& mesh, int zone, std::string const& family, IndexRange const& range) {
  PatchKind const kind = family == "inlet"    ? PatchKind::inflow
                         : family == "outlet" ? PatchKind::outflow
                                              : PatchKind::wall;
  char const* const type = kind == PatchKind::inflow    ? "BCInflow"
                           : kind == PatchKind::outflow ? "BCOutflow"
                                                        : "BCWallViscous";
  int of_family = 1;
  for (Patch& p : mesh.patches) {
    if (p.zone != zone || p.families.front() != family) continue;
    ++of_family;
    if (!join_to_one(p.range, range)) continue;
    for (int d = 0; d < 3; ++d) {
      p.range.begin[d] = std::min(p.range.begin[d], range.begin[d]);
      p.range.end[d] = std::max(p.range.end[d], range.end[d]);
    }
    return;
  }
  std::string const number = of_family > 1 ? "_" + std::to_string(of_family) : "";
  mesh.patches.push_back({family + "_" + mesh.zones[zone].name + number, type, kind, {family}, zone, range});
}

/// Angles about x, y, z whose rotations, applied in this order, make the matrix (CGNS SIDS RotationAngle).
Vec3 rotation_angles(Mat3 const& r) {
  auto const& m = r.m;
  return {std::atan2(m[2][1], m[2][2]), std::atan2(-m[2][0], std::hypot(m[0][0], m[1][0])),
          std::atan2(m[1][0], m[0][0])};
}

}  // namespace

PassageLayout::PassageLayout(PassageOptions const& options, PassageCounts const& c)
    : counts(c), left_handed(options.left_handed), tip_(options.tip) {
  if (tip_ == BladeTip::squealer || tip_ == BladeTip::groove) cavity = name(tip_);
  levels = {0};
  if (c.cavity > 0) levels.push_back(c.span - c.gap - c.cavity);
  if (c.gap > 0) levels.push_back(c.span - c.gap);
  levels.push_back(c.span);
  if (options.layout == PassageOptions::Layout::whole_faces) {
    for (std::size_t l = 1; l < levels.size(); ++l)
      for (int n = 0; n < n_pieces; ++n)
        if (bottom_of(Piece(n)) <= levels[l - 1]) {
          std::string const layer = l == 1 ? "" : l + 1 == levels.size() ? "_gap" : "_rim";
          zones.push_back(
              {std::string(name(Piece(n))) + layer, {{Piece(n)}}, piece_cells(c, Piece(n)), levels[l - 1], levels[l]});
        }
    return;
  }
  auto const stacked = [&](char const* zone_name, std::vector<Piece> const& pieces, int axis) {
    ZoneLayout zone{zone_name, {}, piece_cells(c, pieces.front()), bottom_of(pieces.front()), c.span};
    zone.cells[axis] = 0;
    for (Piece const p : pieces) {
      zone.pieces.push_back({p, axis == 0 ? zone.cells[0] : 0, axis == 1 ? zone.cells[1] : 0});
      zone.cells[axis] += piece_cells(c, p)[axis];
    }
    zones.push_back(std::move(zone));
  };
  stacked("ring", {ring_le, ring_upper, ring_te, ring_lower}, 0);
  stacked("h_inlet", {inlet_lower, inlet_middle, inlet_upper}, 1);
  stacked("h_lower", {lower}, 1);
  stacked("h_upper", {upper}, 1);
  stacked("h_outlet", {outlet_lower, outlet_middle, outlet_upper}, 1);
  if (tip_ == BladeTip::none) return;
  for (Piece const p : {tip_le, tip_upper, tip_te, tip_lower, tip_core}) stacked(name(p).data(), {p}, 0);
}

int PassageLayout::bottom_of(Piece piece) const {
  if (piece < tip_le) return 0;
  if (tip_ == BladeTip::none) return counts.span;
  bool const open = (tip_ == BladeTip::squealer && piece == tip_core) ||
                    (tip_ == BladeTip::groove && piece != tip_upper && piece != tip_lower);
  return counts.span - counts.gap - (open ? counts.cavity : 0);
}

Index PassageLayout::n_nodes() const {
  Index n = 0;
  for (ZoneLayout const& zone : zones) n += Index(zone.cells[0] + 1) * zone.n_span() * (zone.cells[1] + 1);
  return n;
}

void add_zones(Mesh& mesh, PassageLayout const& layout) {
  for (ZoneLayout const& zone : layout.zones)
    mesh.add_zone(zone.name, {zone.cells[0] + 1, zone.n_span(), zone.cells[1] + 1});
}

void add_patches(Mesh& mesh, PassageLayout const& layout) {
  mesh.families = {"blade", "hub", "case", "inlet", "outlet"};
  if (layout.counts.gap > 0) mesh.families.emplace_back("tip");
  if (!layout.cavity.empty()) mesh.families.push_back(layout.cavity);
  for (Joint const& joint : joints)
    if (joint.b.piece >= tip_le)
      for_each_stretch(layout, joint, [&](Found const& a, Found const& b) {
        if (a.zone >= 0 && b.zone >= 0) return;
        Found const& only = a.zone >= 0 ? a : b;
        Edge const& edge = a.zone >= 0 ? joint.a : joint.b;
        add_patch(mesh, only.zone, edge.piece < tip_le ? "blade" : layout.cavity, edge_range(layout, only, edge));
      });
  for (Boundary const& boundary : boundaries)
    for (std::size_t l = 1; l < layout.levels.size(); ++l) {
      Found const found = find(layout, boundary.edge.piece, layout.levels[l - 1], layout.levels[l]);
      add_patch(mesh, found.zone, boundary.family, edge_range(layout, found, boundary.edge));
    }
  int const tip = layout.counts.span - layout.counts.gap;
  for (int z = 0; z < int(layout.zones.size()); ++z) {
    ZoneLayout const& zone = layout.zones[z];
    Index3 const n = mesh.zones[z].extent;
    auto const whole_face = [&](int station) {
      int const j = layout.j_of(zone, station);
      return IndexRange{{0, j, 0}, {n[0], j + 1, n[2]}};
    };
    if (zone.bottom == 0)
      add_patch(mesh, z, "hub", whole_face(0));
    else if (zone.bottom == layout.bottom_of(zone.pieces.front().piece))
      add_patch(mesh, z, zone.bottom == tip ? "tip" : layout.cavity, whole_face(zone.bottom));
    if (zone.top == layout.counts.span) add_patch(mesh, z, "case", whole_face(zone.top));
  }
}

namespace {

/// Zones of one piece that follow one another along the span.
void join_along_span(Mesh& mesh, PassageLayout const& layout) {
  for (int a = 0; a < int(layout.zones.size()); ++a)
    for (int b = 0; b < int(layout.zones.size()); ++b) {
      ZoneLayout const &low = layout.zones[a], &high = layout.zones[b];
      if (low.pieces.front().piece != high.pieces.front().piece || low.top != high.bottom) continue;
      Index3 const n = mesh.zones[a].extent;
      int const j = layout.j_of(low, low.top);
      Interface1to1 face{"to_" + high.name, {}, a, b, {{0, j, 0}, {n[0], j + 1, n[2]}}, {}, {}};
      face.to_donor.own_origin = {0, j, 0};
      face.to_donor.donor_origin = {0, layout.j_of(high, high.bottom), 0};
      demo::join(mesh, face, "to_" + low.name);
    }
}

}  // namespace

void add_interfaces(Mesh& mesh, PassageLayout const& layout, RigidTransform const& turn, Vec3 const& center) {
  auto const periodic_with = [&](RigidTransform const& t) {
    return Periodic{center, rotation_angles(t.rotation), {}, t};
  };
  for (Joint const& joint : joints)
    for_each_stretch(layout, joint, [&](Found const& a, Found const& b) {
      if (a.zone < 0 || b.zone < 0) return;
      IndexRange const ra = edge_range(layout, a, joint.a), rb = edge_range(layout, b, joint.b);
      bool const periodic = joint.along == Along::periodic;
      if (!periodic && continues_inside(a, ra, b, rb)) return;
      Interface1to1 own{
          connection_name(joint.a.piece, joint.b.piece), {}, a.zone, b.zone, ra, map_between(joint, ra, rb), {}};
      if (periodic) own.periodic = periodic_with(turn);
      demo::join(mesh, own, connection_name(joint.b.piece, joint.a.piece),
                 periodic ? std::optional(periodic_with(turn.inverse())) : std::nullopt);
    });
  join_along_span(mesh, layout);
}

}  // namespace gridmorph::passage
