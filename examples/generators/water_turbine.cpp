#include <generators/spacing.hpp>
#include <generators/stand_ins.hpp>
#include <generators/zone_joints.hpp>

#include <cmath>
#include <numbers>

namespace gridmorph {

namespace {

namespace water_turbine {

constexpr int sectors = 5;
constexpr int across = 10, spanwise = 10;  ///< cells
constexpr double hub = 0.05, casing = 0.1;
constexpr double pitch_deg = 360.0 / sectors;

enum class Row { vanes, runner, draft_tube };

/// Lower side of a passage in degrees, without the thickness of blades. s: 0 at the lower edge of the blades, 1 at the
/// upper one; beyond them the camber line goes on straight. Vanes turn the flow from axial at the inlet; the runner's
/// blades are twisted along the span.
double camber_deg(Row row, double z, double r) {
  if (row == Row::draft_tube) return -8;
  double const s = row == Row::vanes ? (z - 0.09) / 0.1 : (z + 0.05) / 0.1;
  auto const line = [&](double t) {
    return row == Row::vanes ? -72 + 38.67 * t * (2 - t) : -14.4 - 96.6 * t + 32 * t * t;
  };
  double const inside = s < 0 ? 0 : s > 1 ? 1 : s;
  double const slope = row == Row::vanes ? 77.34 * (1 - inside) : -96.6 + 64 * inside;
  double const angle = line(inside) + slope * (s - inside);
  return row == Row::vanes ? angle : -54.7 + (angle + 54.7) * (1 - 12 * (r - 0.075));
}

/// Half of a blade's thickness in degrees: a lens with sharp edges.
double half_thickness_deg(Row row, double z) {
  if (row == Row::draft_tube) return 0;
  double const s = row == Row::vanes ? (z - 0.09) / 0.1 : (z + 0.05) / 0.1;
  return s <= 0 || s >= 1 ? 0 : (row == Row::vanes ? 14 : 10) * s * (1 - s);
}

struct Part {
  char const* name;
  Row row;
  double low, high;  ///< axial
  int cells;
  char const* family_low;   ///< of j_min; empty: joined to another zone
  char const* family_high;  ///< of j_max
  bool blade;               ///< i_min and i_max are the sides of a blade; otherwise periodic
};

constexpr Part parts[] = {{"GV_in", Row::vanes, 0.07, 0.09, 2, "MIXING", "", false},
                          {"GV_vane", Row::vanes, 0.09, 0.19, 10, "", "", true},
                          {"GV_out", Row::vanes, 0.19, 0.29, 10, "", "INLET", false},
                          {"RU_out", Row::runner, -0.07, -0.05, 2, "MIXING", "", false},
                          {"RU_blade", Row::runner, -0.05, 0.05, 10, "", "", true},
                          {"RU_in", Row::runner, 0.05, 0.07, 2, "", "MIXING", false},
                          {"DT", Row::draft_tube, -0.14, -0.07, 7, "OUTLET", "MIXING", false}};

void place_nodes(Mesh& mesh, Zone const& zone, Part const& part) {
  bool const runner = part.row == Row::runner;
  auto const around = demo::tanh_spacing(across, runner ? 0.07 : 0.1);
  auto const span = demo::tanh_spacing(spanwise, runner ? 0.08 : 0.1);
  for (int k = 0; k <= spanwise; ++k)
    for (int j = 0; j <= part.cells; ++j)
      for (int i = 0; i <= across; ++i) {
        double const r = k == 0 ? hub : k == spanwise ? casing : hub + span[k] * (casing - hub);
        double const z = j == 0            ? part.low
                         : j == part.cells ? part.high
                                           : part.low + j * (part.high - part.low) / part.cells;
        double const half = half_thickness_deg(part.row, z);
        double const degrees = camber_deg(part.row, z, r) + half + around[i] * (pitch_deg - 2 * half);
        double const angle = degrees * std::numbers::pi / 180;
        mesh.coordinates.set(zone.node({i, j, k}), {r * std::cos(angle), r * std::sin(angle), z});
      }
}

void add_patches(Mesh& mesh, int z, Part const& part) {
  auto const add = [&](char const* name, char const* family, int axis, int side) {
    std::string const f = family;
    if (f.empty()) return;
    PatchKind const kind = f == "INLET"    ? PatchKind::inflow
                           : f == "OUTLET" ? PatchKind::outflow
                           : f == "MIXING" ? PatchKind::other
                                           : PatchKind::wall;
    char const* const type = f == "INLET"    ? "BCInflow"
                             : f == "OUTLET" ? "BCOutflow"
                             : f == "MIXING" ? "BCGeneral"
                                             : "BCWall";
    mesh.patches.push_back({name, type, kind, {f}, z, demo::whole_face(mesh.zones[z], axis, side)});
  };
  char const* const blade = !part.blade ? "" : part.row == Row::vanes ? "BLADE_GV" : "BLADE_RU";
  add("ps", blade, 0, 0);
  add("ss", blade, 0, 1);
  add("hub", "HUB", 2, 0);
  add("shroud", "SHROUD", 2, 1);
  add("ax_lo", part.family_low, 1, 0);
  add("ax_hi", part.family_high, 1, 1);
}

void add_interfaces(Mesh& mesh, int z, Part const& part) {
  Zone const& zone = mesh.zones[z];
  if (!part.blade) {
    double const pitch = pitch_deg * std::numbers::pi / 180;
    auto const turn = [&](double angle) { return periodic_rotation({}, {0, 0, 1}, angle); };
    demo::join(mesh, {"per_lo", {}, z, z, demo::whole_face(zone, 0, 0), {{}, {0, 0, 0}, {across, 0, 0}}, turn(pitch)},
               "per_hi", turn(-pitch));
  }
  for (int other = 0; other < int(std::size(parts)); ++other) {
    if (parts[other].row != part.row || parts[other].low != part.high) continue;
    demo::join(mesh,
               {std::string("match_") + parts[other].name,
                {},
                z,
                other,
                demo::whole_face(zone, 1, 1),
                {{}, {0, part.cells, 0}, {0, 0, 0}},
                std::nullopt},
               std::string("match_") + part.name);
  }
}

}  // namespace water_turbine

}  // namespace

Mesh make_water_turbine() {
  using namespace water_turbine;
  Mesh mesh;
  mesh.source = "water turbine";
  mesh.families = {"BLADE_GV", "BLADE_RU", "HUB", "SHROUD", "INLET", "OUTLET", "MIXING"};
  for (Part const& part : parts) mesh.add_zone(part.name, {across + 1, part.cells + 1, spanwise + 1});
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (int z = 0; z < int(std::size(parts)); ++z) {
    place_nodes(mesh, mesh.zones[z], parts[z]);
    add_patches(mesh, z, parts[z]);
    add_interfaces(mesh, z, parts[z]);
  }
  return mesh;
}

}  // namespace gridmorph
