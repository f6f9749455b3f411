#include <generators/hybrid_mesh.hpp>
#include <generators/stand_ins.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

namespace heated_coil {

using demo::Hex;
using demo::HybridMesh;
using demo::Quad;
using demo::Rank;
using demo::rank_of;

constexpr double body = 0.5, duct = 1, length = 2.25;
constexpr double tube = 0.085, tube_r = 0.75, tube_z = 1;
constexpr double strut_deg = 10;  ///< half its angle
constexpr int steps = 72;         ///< cells from one side of the strut to the other
constexpr int bare = 2;           ///< without prisms, at either end of the tube
constexpr int side = 6;           ///< cells along a quarter of the tube
constexpr int around = 4 * side;
constexpr std::array<double, 6> layer{0, 0.012, 0.028, 0.048, 0.072, 0.1};  ///< of prisms, heights above the tube
constexpr int layers = int(layer.size()) - 1;
constexpr int beyond = 2;  ///< cells between the prisms and the square around them
constexpr int levels = layers + beyond + 1;
constexpr int upstream = 7, downstream = 9;  ///< cells along the duct before and behind that square
constexpr int rings = 2;                     ///< of cells in the tube, around its square core

/// A point of the section that is swept around the axis.
struct Section {
  double z = 0, r = 0;
};

Section mix(Section a, Section b, double t) { return {a.z + t * (b.z - a.z), a.r + t * (b.r - a.r)}; }

Section on_circle(int q, double radius) {
  double const angle = (q - 0.5 * side) * 2 * std::numbers::pi / around;
  return {tube_z + radius * std::cos(angle), tube_r + radius * std::sin(angle)};
}

/// Node q of a square about the tube's middle, counted from the lower corner on the side of the outflow.
Section on_square(int q, double half) {
  int const s = (q / side) % 4;
  double const t = half * (2.0 * (q % side) / side - 1);
  std::array<Section, 4> const at{{{half, t}, {-t, half}, {-half, -t}, {t, -half}}};
  return {tube_z + at[s].z, tube_r + at[s].r};
}

Vec3 swept(Section const& p, int step) {
  double const angle = (strut_deg + step * (360 - 2 * strut_deg) / steps) * std::numbers::pi / 180;
  return {p.r * std::sin(angle), p.r * std::cos(angle), p.z};
}

/// Nodes of a zone: those of its section, step after step, and their ranks.
struct Swept {
  std::vector<Section> section;
  std::vector<int> column;  ///< (section) place around the tube of nodes on a normal of its wall; -1: none
  std::vector<int> level;   ///< (section) along that normal

  int add(Section const& p, int q = -1, int l = 0) {
    section.push_back(p);
    column.push_back(q);
    level.push_back(l);
    return int(section.size()) - 1;
  }
  [[nodiscard]] Index32 node(int n, int step) const { return Index32(n + int(section.size()) * step); }
  /// Normals of the wall are ranked by their feet, which both zones number alike: they cut the wall alike.
  [[nodiscard]] HybridMesh mesh() const {
    std::vector<Vec3> nodes;
    std::vector<Rank> ranks;
    for (int step = 0; step <= steps; ++step)
      for (std::size_t n = 0; n < section.size(); ++n) {
        nodes.push_back(swept(section[n], step));
        ranks.push_back(column[n] >= 0 ? rank_of(Index32(column[n] + around * step), level[n])
                                       : rank_of(Index32(around * (steps + 1)) + node(int(n), step)));
      }
    return {std::move(nodes), std::move(ranks)};
  }
  /// A cell over a quadrilateral a b c d of the section, which runs from z to r: face a b c d looks back along the
  /// sweep.
  [[nodiscard]] Hex cell(std::array<int, 4> const& q, int step) const {
    return {node(q[0], step),     node(q[3], step),     node(q[2], step),     node(q[1], step),
            node(q[0], step + 1), node(q[3], step + 1), node(q[2], step + 1), node(q[1], step + 1)};
  }
  [[nodiscard]] Quad quad(int a, int b, int step) const {
    return {node(a, step), node(b, step), node(b, step + 1), node(a, step + 1)};
  }
  [[nodiscard]] Quad end(std::array<int, 4> const& q, int step) const {
    return {node(q[0], step), node(q[1], step), node(q[2], step), node(q[3], step)};
  }
};

/// The section of the duct: rings of nodes around the tube out to a square, and a lattice before and behind it.
class Fluid {
 public:
  Fluid() {
    for (int l = 0; l < levels; ++l)
      for (int q = 0; q < around; ++q) {
        Section const top = on_circle(q, tube + layer.back());
        swept_.add(l <= layers ? on_circle(q, tube + layer[l])
                               : mix(top, on_square(q, 0.5 * (duct - body)), double(l - layers) / beyond),
                   q, l);
      }
    for (int j = 0; j <= side; ++j) {
      before_.push_back(row(j, upstream, 0, ring(2 * side + side - j, levels - 1)));
      behind_.push_back(row(j, downstream, length, ring(j, levels - 1)));
    }
  }

  Mesh mesh() const {
    HybridMesh out = swept_.mesh();
    int const wall = out.add_patch("Default 1 Side FluidZone Part 1", PatchKind::other, "Null");
    int const casing = out.add_patch("FluidZone Default", PatchKind::wall, "BCWall");
    int const inflow = out.add_patch("inflow", PatchKind::inflow, "BCInflow");
    int const outflow = out.add_patch("outflow", PatchKind::other, "Null");
    for (int step = 0; step < steps; ++step) {
      for (int q = 0; q < around; ++q) {
        out.add_triangles(wall, swept_.quad(ring(q, 0), ring(q + 1, 0), step));
        if ((q / side) % 2 == 1)
          out.add_triangles(casing, swept_.quad(ring(q, levels - 1), ring(q + 1, levels - 1), step));
        for (int l = 0; l + 1 < levels; ++l) add_ring_cell(out, q, l, step);
      }
      for (int j = 0; j < side; ++j) {
        for (auto const& c : lattice_cells(j)) out.add_tetrahedra(swept_.cell(c, step));
        out.add_triangles(inflow, swept_.quad(before_[j].front(), before_[j + 1].front(), step));
        out.add_triangles(outflow, swept_.quad(behind_[j].back(), behind_[j + 1].back(), step));
      }
      for (auto const* lattice : {&before_, &behind_})
        for (auto const* line : {&lattice->front(), &lattice->back()})
          for (std::size_t i = 0; i + 1 < line->size(); ++i)
            out.add_triangles(casing, swept_.quad((*line)[i], (*line)[i + 1], step));
    }
    for (int const step : {0, steps}) {
      for (int q = 0; q < around; ++q)
        for (int l = 0; l + 1 < levels; ++l) out.add_triangles(casing, swept_.end(ring_cell(q, l), step));
      for (int j = 0; j < side; ++j)
        for (auto const& c : lattice_cells(j)) out.add_triangles(casing, swept_.end(c, step));
    }
    return out.finish("FluidZone", "heated coil");
  }

 private:
  static int ring(int q, int l) { return q % around + around * l; }
  static std::array<int, 4> ring_cell(int q, int l) {
    return {ring(q, l), ring(q, l + 1), ring(q + 1, l + 1), ring(q + 1, l)};
  }

  /// Nodes along the duct at height j, in the sense of z; the one on the square is there already.
  std::vector<int> row(int j, int cells, double end, int on_square) {
    Section const near = swept_.section[on_square];
    Section const far{end, body + j * (duct - body) / side};
    std::vector<int> out;
    for (int i = 0; i <= cells; ++i) {
      int const n = end > near.z ? i : cells - i;
      double const t = double(n) / cells;
      out.push_back(n == 0 ? on_square : swept_.add(mix(near, far, t * (0.6 + 0.4 * t))));
    }
    return out;
  }

  [[nodiscard]] std::vector<std::array<int, 4>> lattice_cells(int j) const {
    std::vector<std::array<int, 4>> out;
    auto const lower = std::size_t(j), upper = std::size_t(j) + 1;
    for (auto const* lattice : {&before_, &behind_})
      for (std::size_t i = 0; i + 1 < lattice->front().size(); ++i)
        out.push_back({(*lattice)[lower][i], (*lattice)[lower][i + 1], (*lattice)[upper][i + 1], (*lattice)[upper][i]});
    return out;
  }

  void add_ring_cell(HybridMesh& out, int q, int l, int step) const {
    auto const n = [&](int dq, int dl, int ds) { return swept_.node(ring(q + dq, l + dl), step + ds); };
    if (l >= layers || step < bare - 1 || step > steps - bare) {
      out.add_tetrahedra(swept_.cell(ring_cell(q, l), step));
    } else if (step == bare - 1) {
      out.add_pyramid({n(0, 0, 1), n(0, 1, 1), n(1, 1, 1), n(1, 0, 1), n(0, 0, 0), n(0, 1, 0), n(1, 1, 0), n(1, 0, 0)});
    } else if (step == steps - bare) {
      out.add_pyramid({n(0, 0, 0), n(1, 0, 0), n(1, 1, 0), n(0, 1, 0), n(0, 0, 1), n(1, 0, 1), n(1, 1, 1), n(0, 1, 1)});
    } else {
      out.add_prisms({n(0, 0, 0), n(0, 0, 1), n(1, 0, 1), n(1, 0, 0), n(0, 1, 0), n(0, 1, 1), n(1, 1, 1), n(1, 1, 0)});
    }
  }

  Swept swept_;
  std::vector<std::vector<int>> before_, behind_;  ///< lattices, row by row
};

/// The section of the tube: a square core and rings around it, the last one the wall.
Mesh make_solid() {
  Swept swept;
  double const half = 0.5 * tube;
  std::vector<std::vector<int>> ring;
  for (int l = 0; l <= rings; ++l) {
    ring.emplace_back();
    for (int q = 0; q < around; ++q)
      ring.back().push_back(l == rings ? swept.add(on_circle(q, tube), q)
                                       : swept.add(mix(on_square(q, half), on_circle(q, tube), double(l) / rings)));
  }
  auto const core = [&](int i, int j) {
    if (i == side) return ring[0][j];
    if (j == side) return ring[0][side + side - i];
    if (i == 0) return ring[0][2 * side + side - j];
    if (j == 0) return ring[0][std::size_t(3 * side + i) % around];
    return -1;
  };
  std::vector<std::array<int, 4>> cells;
  std::vector<std::vector<int>> inner(side + 1, std::vector<int>(side + 1));
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      inner[j][i] = core(i, j) >= 0
                        ? core(i, j)
                        : swept.add({tube_z + half * (2.0 * i / side - 1), tube_r + half * (2.0 * j / side - 1)});
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i)
      cells.push_back({inner[j][i], inner[j][i + 1], inner[j + 1][i + 1], inner[j + 1][i]});
  for (std::size_t l = 0; l < rings; ++l)
    for (std::size_t q = 0; q < around; ++q) {
      std::size_t const next = (q + 1) % around;
      cells.push_back({ring[l][q], ring[l + 1][q], ring[l + 1][next], ring[l][next]});
    }

  HybridMesh out = swept.mesh();
  int const wall = out.add_patch("Default 1 Side SolidZone Part 2", PatchKind::other, "Null");
  int const ends = out.add_patch("SolidZone Default", PatchKind::wall, "BCWall");
  for (int step = 0; step < steps; ++step) {
    for (auto const& c : cells) out.add_tetrahedra(swept.cell(c, step));
    for (std::size_t q = 0; q < around; ++q)
      out.add_triangles(wall, swept.quad(ring.back()[q], ring.back()[(q + 1) % around], step));
  }
  for (int const step : {0, steps})
    for (auto const& c : cells) out.add_triangles(ends, swept.end(c, step));
  return out.finish("SolidZone", "heated coil");
}

/// Appends the only zone of a mesh to another one.
void append(Mesh& mesh, Mesh const& zone) {
  auto const shift = Index32(mesh.n_nodes());
  Coordinates x(mesh.n_nodes() + zone.n_nodes());
  for (Index n = 0; n < x.size(); ++n)
    x.set(n, n < mesh.n_nodes() ? mesh.coordinates[n] : zone.coordinates[n - mesh.n_nodes()]);
  int const z = mesh.add_zone(zone.zones[0].name, zone.n_nodes());
  for (Index e = 0; e < zone.n_elements(); ++e) {
    std::vector<Index32> nodes(zone.elements.nodes[e].begin(), zone.elements.nodes[e].end());
    for (Index32& n : nodes) n += shift;
    mesh.add_element(zone.elements.type[e], nodes);
  }
  for (Patch patch : zone.patches) {
    patch.zone = z;
    for (Index32& n : patch.faces.item) n += shift;
    mesh.patches.push_back(std::move(patch));
  }
  mesh.coordinates = x;
}

}  // namespace heated_coil

}  // namespace

Mesh make_heated_coil() {
  Mesh mesh = heated_coil::Fluid().mesh();
  heated_coil::append(mesh, heated_coil::make_solid());
  mesh.families.clear();
  for (auto& patch : mesh.patches) patch.families.clear();
  for (auto& zone : mesh.zones) zone.single_precision = true;
  return mesh;
}

}  // namespace gridmorph
