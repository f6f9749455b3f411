#include "support/plane_cascade.hpp"

#include "support/mesh_builders.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace gridmorph::test {

namespace {

constexpr int before = 10, along = 16, behind = 10, across = 13;
constexpr int ni = before + along + behind + 1;

/// An H grid whose lower and upper sides are blade in the middle.
Vec3 place_of(PlaneMap const& map, int i, int k) {
  double const c = double(i - before) / along, w = double(k) / (across - 1);
  double const x = c < 0 ? c * 2.24 : c > 1 ? 1 + (c - 1) * 2.24 : 0.5 * (1 - std::cos(std::numbers::pi * c));
  double const half = x > 0 && x < 1 ? 0.2 * x * (1 - x) : 0;
  return map(x, 0.3 * std::sin(1.5 * x) + half + w * (plane_cascade_pitch - 2 * half));
}

Patch patch_of(std::string const& name, PatchKind kind) {
  Patch out;
  out.name = name;
  out.families = {name};
  out.kind = kind;
  out.bc_type = kind == PatchKind::inflow ? "BCInflow" : kind == PatchKind::outflow ? "BCOutflow" : "BCWall";
  out.zone = 0;
  return out;
}

}  // namespace

PlaneMap straight_section() {
  return [](double x, double t) { return Vec3{x, t, 0}; };
}

PlaneMap bent_section(double radius) {
  return [=](double x, double t) { return (radius + x) * Vec3{std::cos(t / radius), std::sin(t / radius), 0}; };
}

PlaneMap section_of_wheel(int blades) {
  double const turn = 2 * std::numbers::pi / (blades * plane_cascade_pitch);
  return [=](double x, double t) { return std::exp(turn * x) * Vec3{std::cos(turn * t), std::sin(turn * t), 0}; };
}

Periodic turned_sides(double angle_rad) { return periodic_rotation({0, 0, 0}, {0, 0, 1}, angle_rad); }

Mesh plane_cascade(PlaneMap const& map, Periodic const& sides) {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "plane cascade";
  mesh.add_zone("passage", Index(ni) * across);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const node = [](int i, int k) { return Index32(i + ni * k); };
  for (int k = 0; k < across; ++k)
    for (int i = 0; i < ni; ++i) mesh.coordinates.set(node(i, k), place_of(map, i, k));
  for (int k = 0; k + 1 < across; ++k)
    for (int i = 0; i + 1 < ni; ++i)
      mesh.add_element(ElementType::quadrilateral,
                       std::array{node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)});
  Patch inlet = patch_of("inlet", PatchKind::inflow), outlet = patch_of("outlet", PatchKind::outflow),
        blade = patch_of("blade", PatchKind::wall);
  for (int k = 0; k + 1 < across; ++k) {
    inlet.faces.add(std::array{node(0, k), node(0, k + 1)});
    outlet.faces.add(std::array{node(ni - 1, k), node(ni - 1, k + 1)});
  }
  for (int const k : {0, across - 1})
    for (int i = before; i < before + along; ++i) blade.faces.add(std::array{node(i, k), node(i + 1, k)});
  mesh.patches = {inlet, outlet, blade};
  mesh.families = {"inlet", "outlet", "blade"};
  for (int const first : {0, before + along}) {
    Connection side;
    side.name = first == 0 ? "upstream" : "downstream";
    side.zone = side.donor_zone = 0;
    side.periodic = sides;
    for (int i = first; i <= (first == 0 ? before : ni - 1); ++i) {
      side.nodes.push_back(node(i, 0));
      side.donor_nodes.push_back(node(i, across - 1));
    }
    mesh.connections.push_back(std::move(side));
  }
  return mesh;
}

namespace {

IndexRange part(IndexRange range, int first, int last) {
  range.begin[0] = first;
  range.end[0] = last + 1;
  return range;
}

/// What a block has whose i goes with the flow; `span` and `pitch`: its other directions.
Mesh with_boundaries(MeshBuilder& build, int zone, int span, int pitch, Periodic const& sides, PatchKind ends) {
  IndexRange const all = whole(build.mesh().zones[zone]);
  build.patch("inlet", PatchKind::inflow, zone, 0, 0);
  build.patch("outlet", PatchKind::outflow, zone, 0, 1);
  build.patch("hub", ends, zone, span, 0);
  build.patch("case", ends, zone, span, 1);
  IndexRange const lower = face_of(all, pitch, 0), upper = face_of(all, pitch, 1);
  for (IndexRange const& side : {lower, upper})
    build.patch("blade", PatchKind::wall, zone, part(side, before, before + along));
  for (int const first : {0, before + along}) {
    int const last = first == 0 ? before : ni - 1;
    build.join(zone, part(lower, first, last), zone, part(upper, first, last), {}, sides);
  }
  return build.finish();
}

}  // namespace

Mesh cascade_between_planes(PlaneMap const& map, Periodic const& sides, double height, int stations, PatchKind ends) {
  MeshBuilder build("cascade between planes");
  int const zone = build.zone("passage", {ni, stations, across}, [&](Index3 const& n) {
    return place_of(map, n[0], n[2]) + Vec3{0, 0, height / (stations - 1) * n[1]};
  });
  return with_boundaries(build, zone, 1, 2, sides, ends);
}

Mesh plane_cascade_block(PlaneMap const& map, Periodic const& sides) {
  MeshBuilder build("plane cascade of a block");
  int const zone = build.zone("passage", {ni, across, 2}, [&](Index3 const& n) {
    return place_of(map, n[0], n[1]) + Vec3{0, 0, 0.1 * n[2]};
  });
  Mesh mesh = with_boundaries(build, zone, 2, 1, sides, PatchKind::symmetry);
  mesh.dimension = 2;
  return mesh;
}

}  // namespace gridmorph::test
