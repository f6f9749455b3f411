#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/elements/background.hpp>

#include <algorithm>
#include <string>

namespace gridmorph {
namespace {

/// Makes the zones of a tensor grid with boxes left out, and joins and closes their faces.
class LatticeMesh {
 public:
  LatticeMesh(FineLattice& lattice, Wrap const& wrap) : lattice_(lattice), wrap_(wrap), dimension_(wrap.dimension) {}

  Mesh run() {
    mesh_.source = "background mesh";
    mesh_.families = {"wrap", "outer"};
    if (dimension_ == 2) mesh_.families.emplace_back("sides");
    for_sides([&](std::string const& family, int, int) { mesh_.families.push_back(family); });
    for_slabs([&](Index3 const& s) { add_zone(s); });
    for_slabs([&](Index3 const& s) { add_faces(s); });
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    for_slabs([&](Index3 const& s) { set_coordinates(s); });
    return std::move(mesh_);
  }

  /// Sides that are not outer ones: their families.
  template <class Function>
  void for_sides(Function const& f) const {
    for (int axis = 0; axis < dimension_; ++axis)
      for (int const side : {0, 1})
        if (moves_along(axis, side)) f(side_family(axis, side), axis, side);
  }

 private:
  template <class Function>
  void for_slabs(Function const& f) const {
    for (int k = 0; k < lattice_.slabs(2); ++k)
      for (int j = 0; j < lattice_.slabs(1); ++j)
        for (int i = 0; i < lattice_.slabs(0); ++i) f(Index3{i, j, k});
  }
  /// Whether nodes slide on a side or go along: also where the wrap reaches one that stands, for the reason that
  /// Wrap::slides() has.
  [[nodiscard]] bool moves_along(int axis, int side) const {
    auto const a = std::size_t(axis), which = std::size_t(side);
    auto const is = wrap_.domain.side[a][which];
    return is != ChartedDomain::Side::open && (is != ChartedDomain::Side::stands || wrap_.reaches[a][which]);
  }
  static std::string side_family(int axis, int side) { return "side " + std::string(face_name(axis, side)); }
  [[nodiscard]] int cut(std::size_t axis, int slab) const { return lattice_.cut[axis][slab]; }

  void add_zone(Index3 const& s) {
    int& zone = lattice_.zone[lattice_.box(s)];
    if (zone < 0) return;
    Index3 extent{};
    for (std::size_t a = 0; a < 3; ++a) extent[a] = cut(a, s[a] + 1) - cut(a, s[a]) + 1;
    zone = mesh_.add_zone("block " + std::to_string(mesh_.zones.size() + 1), extent);
  }

  void add_faces(Index3 const& s) {
    int const zone = lattice_.zone[lattice_.box(s)];
    if (zone < 0) return;
    for (int axis = 0; axis < 3; ++axis)
      for (int const side : {0, 1}) {
        auto const a = std::size_t(axis);
        IndexRange range{{0, 0, 0}, mesh_.zones[zone].extent};
        (side == 0 ? range.end[a] : range.begin[a]) = side == 0 ? 1 : range.end[a] - 1;
        Index3 beyond = s;
        beyond[a] += 2 * side - 1;
        if (beyond[a] < 0 || beyond[a] == lattice_.slabs(axis)) {
          if (axis >= dimension_)
            add_patch("sides", "BCSymmetryPlane", PatchKind::symmetry, zone, axis, side, range);
          else if (moves_along(axis, side))
            add_patch(side_family(axis, side), "BCSymmetryPlane", PatchKind::symmetry, zone, axis, side, range);
          else
            add_patch("outer", "BCFarfield", PatchKind::farfield, zone, axis, side, range);
          continue;
        }
        int const donor = lattice_.zone[lattice_.box(beyond)];
        if (donor < 0)
          add_patch("wrap", "BCWall", PatchKind::wall, zone, axis, side, range);
        else
          add_interface(zone, donor, axis, side, range);
      }
  }

  void add_patch(std::string const& family, char const* bc_type, PatchKind kind, int zone, int axis, int side,
                 IndexRange const& range) {
    mesh_.patches.push_back({family + " " + std::string(face_name(axis, side)), bc_type, kind, {family}, zone, range});
  }

  void add_interface(int zone, int donor, int axis, int side, IndexRange const& range) {
    Interface1to1 face;
    face.name = "to " + mesh_.zones[donor].name;
    face.zone = zone;
    face.donor_zone = donor;
    face.range = range;
    face.to_donor.own_origin = range.begin;
    face.to_donor.donor_origin = range.begin;
    face.to_donor.donor_origin[axis] = side == 0 ? mesh_.zones[donor].extent[axis] - 1 : 0;
    mesh_.interfaces.push_back(std::move(face));
  }

  void set_coordinates(Index3 const& s) {
    int const number = lattice_.zone[lattice_.box(s)];
    if (number < 0) return;
    Zone const& zone = mesh_.zones[number];
    auto plane = [&](std::size_t axis, int node) { return lattice_.planes[axis][cut(axis, s[axis]) + node]; };
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i)
          mesh_.coordinates.set(zone.node({i, j, k}), lattice_.chart.place({plane(0, i), plane(1, j), plane(2, k)}));
  }

  FineLattice& lattice_;
  Wrap const& wrap_;
  int dimension_;
  Mesh mesh_;
};

/// How nodes slide on a side of a chart at a place there.
SlipRule sliding(Chart const& chart, int axis, LatticeBox const& box, int side) {
  SlipRule rule;
  bool const limited = bool(chart.limits[axis]), turned = chart.frame == Chart::Frame::cylindrical,
             disc = chart.frame == Chart::Frame::disc;
  auto const a = std::size_t(axis);
  double const at = side == 0 ? box.low[a] : box.high[a];
  bool const rim = disc && axis < 2 && std::abs(at) > 0.5 * chart.radius;
  if ((turned && axis == 1) || rim) {
    rule.surface = SlipRule::Surface::revolution;
  } else if (limited) {
    rule.surface = SlipRule::Surface::baseline;
  } else {
    std::array<double, 3> on{};
    for (std::size_t a = 0; a < 3; ++a) on[a] = 0.5 * (box.low[a] + box.high[a]);
    on[a] = at;
    Vec3 const p = chart.place({on[0], on[1], on[2]});
    Vec3 normal{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
    if (turned) {
      Vec3 const d = p - chart.origin, r = d - dot(d, chart.axis) * chart.axis;
      normal = axis == 0 ? chart.axis : (1 / norm(r)) * cross(chart.axis, r);
    }
    if (disc) normal = axis == 0 ? chart.zero : axis == 1 ? chart.quarter : chart.axis;
    rule.plane = {p, normal};
  }
  return rule;
}

/// Nodes between two planes of the lattice, spacings near `low` and `high` at its ends (0: any).
std::vector<double> nodes_between(double a, double b, double low, double high, int cells, double growth) {
  double const length = b - a;
  std::vector<double> at;
  if (low > 0 && high > 0) {
    // From both ends to the middle.
    std::vector<double> const left = detail::growing(length / 2, std::min(low, high), growth);
    for (double const place : left) at.push_back(a + place);
    for (std::size_t n = left.size() - 1; n-- > 0;) at.push_back(b - left[n]);
  } else if (low > 0 || high > 0) {
    std::vector<double> const places = detail::growing(length, std::max(low, high), growth);
    for (std::size_t n = 0; n < places.size(); ++n)
      at.push_back(low > 0 ? a + places[n] : b - places[places.size() - 1 - n]);
  } else {
    for (int n = 0; n <= cells; ++n) at.push_back(a + n * length / cells);
  }
  at.front() = a;
  at.back() = b;
  return at;
}

/// Node planes of one axis and where the planes of the coarse lattice are among them.
struct FinePlanes {
  std::vector<double> planes;
  std::vector<int> coarse;
};

FinePlanes refine(std::vector<double> const& coarse, std::array<bool, 2> const& reaches, double spacing, int cells,
                  double growth) {
  FinePlanes out;
  out.planes.push_back(coarse.front());
  out.coarse.push_back(0);
  int const n = int(coarse.size()) - 1;
  auto size = [&](int i) { return coarse[i + 1] - coarse[i]; };
  // Outermost intervals, and those between walls far apart.
  auto stretched = [&](int i) {
    return n > 1 && ((i == 0 && !reaches[0]) || (i == n - 1 && !reaches[1]) || size(i) > 1.6 * spacing);
  };
  for (int i = 0; i < n; ++i) {
    double const low = stretched(i) && i > 0 ? size(i - 1) / cells : 0;
    double const high = stretched(i) && i < n - 1 ? size(i + 1) / cells : 0;
    std::vector<double> const at = nodes_between(coarse[i], coarse[i + 1], low, high, cells, growth);
    out.planes.insert(out.planes.end(), at.begin() + 1, at.end());
    out.coarse.push_back(int(out.planes.size()) - 1);
  }
  return out;
}

/// Whether the coarse cells on both sides of a plane are inside or outside alike.
bool alike(Wrap const& wrap, int axis, int plane) {
  auto const a = std::size_t(axis);
  for (Index n = 0; n < wrap.n_cells(); ++n) {
    Index3 const c = wrap.index(n);
    if (c[a] != plane) continue;
    Index3 below = c;
    --below[a];
    if (wrap.is_inside(c) != wrap.is_inside(below)) return false;
  }
  return true;
}

}  // namespace

Background make_background(Wrap const& wrap, int cells, double growth) {
  if (cells < 1 || !(growth >= 1))
    throw MotionError(
        "a background mesh needs at least 1 cell per cell of the wrap and a growth of at least 1; it got " +
        std::to_string(cells) + " and " + std::to_string(growth));
  Background out;
  out.dimension = wrap.dimension;
  if (wrap.tube) {
    out.mesh = detail::o_type_mesh(*wrap.tube, wrap.planes, growth);
    return out;
  }
  FineLattice& lattice = out.lattice.emplace();
  std::array<std::vector<int>, 3> first_cell;  // of each slab
  for (int axis = 0; axis < 3; ++axis) {
    auto const a = std::size_t(axis);
    FinePlanes const fine =
        refine(wrap.planes[a], wrap.reaches[a], wrap.spacing, axis < wrap.dimension ? cells : 1, growth);
    lattice.planes[a] = fine.planes;
    for (int p = 0; p <= wrap.cells(axis); ++p)
      if (p == 0 || p == wrap.cells(axis) || !alike(wrap, axis, p)) {
        lattice.cut[a].push_back(fine.coarse[p]);
        first_cell[a].push_back(p);
      }
    for (int s = 0; s < lattice.slabs(axis); ++s) lattice.slab[a].resize(lattice.cut[a][s + 1], s);
  }
  for (int k = 0; k < lattice.slabs(2); ++k)
    for (int j = 0; j < lattice.slabs(1); ++j)
      for (int i = 0; i < lattice.slabs(0); ++i)
        lattice.zone.push_back(wrap.is_inside({first_cell[0][i], first_cell[1][j], first_cell[2][k]}) ? -1 : 0);
  lattice.chart = wrap.domain.chart;
  LatticeMesh blocks(lattice, wrap);
  LatticeBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = wrap.planes[a].front();
    box.high[a] = wrap.planes[a].back();
  }
  out.mesh = blocks.run();
  auto const has = [&](std::string const& family) {
    return std::any_of(out.mesh.patches.begin(), out.mesh.patches.end(),
                       [&](Patch const& patch) { return patch.families.front() == family; });
  };
  // The wrap may cover all of a side.
  blocks.for_sides([&](std::string const& family, int axis, int side) {
    if (!has(family)) return;
    if (wrap.slides(axis, side))
      out.sides.push_back({family, sliding(lattice.chart, axis, box, side)});
    else
      out.sides.push_back({family, FreeRule{}});
  });
  if (!has("outer")) out.outer.clear();
  return out;
}

Background make_background(Mesh mesh, std::vector<std::string> wrap, std::vector<std::string> outer) {
  for (auto const* selectors : {&wrap, &outer})
    if (!selectors->empty()) (void)select_patches(mesh, *selectors);
  if (wrap.empty()) throw MotionError("no patch of the background mesh is named as its wrap");
  Background out;
  out.dimension = mesh.dimension;
  out.mesh = std::move(mesh);
  out.wrap = std::move(wrap);
  out.outer = std::move(outer);
  return out;
}

PreparedMorph prepare_background(HostInstance const& host, Background const& background, VolumeOptions const& volume) {
  Motion motion;
  // Values come from elsewhere: the rule says only that they are given.
  FunctionRule const given{"displacement of the wrap",
                           [](std::span<Vec3 const>, std::span<Vec3> u) { std::fill(u.begin(), u.end(), Vec3{}); }};
  motion.rules.push_back({background.wrap, given, 0, "background mesh"});
  if (!background.outer.empty()) motion.rules.push_back({background.outer, FixedRule{}, 1, "background mesh"});
  if (background.dimension == 2 && background.lattice)
    motion.rules.push_back({{"sides"}, FreeRule{}, 2, "background mesh"});
  for (Background::Side const& side : background.sides)
    motion.rules.push_back({{side.family}, side.rule, 2, "background mesh"});
  if (background.lattice && background.lattice->chart.frame != Chart::Frame::straight)
    motion.axis = {background.lattice->chart.origin, background.lattice->chart.axis};
  PlanOptions options;
  options.default_boundary_layer = false;  // the wrap is no wall: the near field lies inside it
  options.volume.law = volume.law;
  options.volume.own_law = volume.own_law;
  return prepare(host, background.mesh, motion, options);
}

WrapNodes wrap_nodes(Background const& background, PreparedMorph const& prepared) {
  constexpr int wrap_rule = 0;
  auto const& boundary = prepared.plan().boundary_nodes;
  std::vector<char> seen(boundary.size(), 0);
  WrapNodes out;
  for (auto const& request : prepared.planned.boundary.requests) {
    auto const b = std::size_t(request.boundary_node);
    if (request.rule != wrap_rule || seen[b] != 0) continue;
    seen[b] = 1;
    Vec3 p = background.mesh.coordinates[boundary[b]];
    if (background.dimension == 2) p.z = 0;
    out.position.push_back(p);
    out.boundary_node.push_back(Index32(b));
  }
  return out;
}

}  // namespace gridmorph
