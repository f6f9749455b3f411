#include <gridmorph/core/error.hpp>
#include <gridmorph/unstructured/detail/box_distance.hpp>
#include <gridmorph/unstructured/detail/wrap_fill.hpp>
#include <gridmorph/unstructured/detail/wrap_lattice.hpp>
#include <gridmorph/unstructured/wrap.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gridmorph {
namespace {

std::array<double, 3> array_of(Vec3 const& p) { return {p.x, p.y, p.z}; }

/// Marks the cells that come closer to a wall face than the offset.
void mark(UnstructuredMesh const& mesh, std::span<NumberLists const> walls, Wrap& wrap) {
  std::vector<std::array<double, 3>> p;
  for (NumberLists const& faces : walls)
    for (Index f = 0; f < faces.size(); ++f) {
      p.clear();
      LatticeBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
      for (Number const n : faces[f]) {
        p.push_back(array_of(mesh.coordinates[n]));
        if (wrap.dimension == 2) p.back()[2] = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], p.back()[a] - wrap.offset);
          box.high[a] = std::max(box.high[a], p.back()[a] + wrap.offset);
        }
      }
      Index3 first{}, last{};
      for (int a = 0; a < 3; ++a) {
        // The outermost cells stay free.
        int const rim = a < wrap.dimension ? 1 : 0, end = wrap.cells(a) - 1 - rim;
        first[std::size_t(a)] = std::clamp(wrap.interval(a, box.low[std::size_t(a)]), rim, end);
        last[std::size_t(a)] = std::clamp(wrap.interval(a, box.high[std::size_t(a)]), rim, end);
      }
      for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
          for (int i = first[0]; i <= last[0]; ++i) {
            std::uint8_t& inside = wrap.inside[std::size_t(wrap.cell({i, j, k}))];
            if (inside == 0 && detail::polygon_meets_box(p, wrap.box({i, j, k}), wrap.offset)) inside = 1;
          }
    }
}

/// sum(i, j, k): inside cells with indices below i, j and k.
void add_up(Wrap& wrap) {
  Index const ni = wrap.cells(0) + 1, nj = wrap.cells(1) + 1, nk = wrap.cells(2) + 1;
  wrap.sum.assign(std::size_t(ni * nj * nk), 0);
  auto at = [&](Index i, Index j, Index k) -> std::int32_t& { return wrap.sum[std::size_t(i + ni * (j + nj * k))]; };
  for (Index k = 1; k < nk; ++k)
    for (Index j = 1; j < nj; ++j)
      for (Index i = 1; i < ni; ++i)
        at(i, j, k) = std::int32_t(wrap.is_inside({int(i - 1), int(j - 1), int(k - 1)})) + at(i - 1, j, k) +
                      at(i, j - 1, k) + at(i, j, k - 1) - at(i - 1, j - 1, k) - at(i - 1, j, k - 1) -
                      at(i, j - 1, k - 1) + at(i - 1, j - 1, k - 1);
}

/// A tube with an outer box that leaves room for blocks between them, also where the mesh ends beside the tube.
Wrap around(Tube tube, LatticeBox const& domain, WrapOptions const& options) {
  Wrap wrap;
  wrap.offset = options.offset;
  double const room = 0.5 * tube.largest_radius();
  for (std::size_t a = 0; a < 3; ++a) {
    double low = domain.low[a] - options.margin, high = domain.high[a] + options.margin;
    for (Vec3 const& p : tube.ring) {
      low = std::min(low, array_of(p)[a] - room);
      high = std::max(high, array_of(p)[a] + room);
    }
    wrap.planes[a] = {low, high};
  }
  wrap.spacing = wrap.layer = tube.length() / (tube.sections() - 1);
  wrap.inside.assign(1, 0);
  add_up(wrap);
  wrap.tube = std::move(tube);
  return wrap;
}

}  // namespace

LatticeBox Wrap::box(Index3 const& c) const {
  LatticeBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = planes[a][std::size_t(c[a])];
    box.high[a] = planes[a][std::size_t(c[a]) + 1];
  }
  return box;
}

int Wrap::interval(int axis, double coordinate) const {
  auto const& p = planes[std::size_t(axis)];
  auto const above = std::upper_bound(p.begin() + 1, p.end() - 1, coordinate);
  return int(above - p.begin()) - 1;
}

Index3 Wrap::find(Vec3 const& point) const {
  return {interval(0, point.x), interval(1, point.y), dimension == 2 ? 0 : interval(2, point.z)};
}

bool Wrap::meets(LatticeBox const& box) const {
  if (tube) return tube->meets(box);
  Index3 first{}, last{};
  for (int a = 0; a < 3; ++a) {
    auto const s = std::size_t(a);
    if (a < dimension) {
      first[s] = interval(a, box.low[s]);
      last[s] = interval(a, box.high[s]);
    }
    ++last[s];
  }
  Index const ni = cells(0) + 1, nj = cells(1) + 1;
  auto at = [&](Index i, Index j, Index k) { return sum[std::size_t(i + ni * (j + nj * k))]; };
  auto below = [&](Index k) {
    return at(last[0], last[1], k) - at(first[0], last[1], k) - at(last[0], first[1], k) + at(first[0], first[1], k);
  };
  return below(last[2]) > below(first[2]);
}

Wrap make_wrap(UnstructuredMesh const& mesh, std::span<NumberLists const> walls, WrapOptions const& options) {
  if (!(options.offset > 0) || !std::isfinite(options.offset))
    throw MotionError("the offset of the wrap is " + std::to_string(options.offset) +
                      "; give a positive length, such as twice the height of the boundary layer");
  if (options.resolution < 1)
    throw MotionError("the resolution of the wrap is " + std::to_string(options.resolution) +
                      " cells; give at least 1");
  Index faces = 0;
  for (NumberLists const& list : walls) faces += list.size();
  if (faces == 0) throw MeshError("there is nothing to wrap: the moving walls have no faces");

  MeshExtent const domain = extent_of(mesh.coordinates);
  std::string note;
  if (options.tube)
    if (auto tube = fit_tube(mesh, walls, options.offset, note))
      return around(std::move(*tube), {array_of(domain.low), array_of(domain.high)}, options);
  Wrap wrap = detail::make_lattice(mesh, walls, {array_of(domain.low), array_of(domain.high)}, options);
  mark(mesh, walls, wrap);
  detail::fill(mesh, {array_of(domain.low), array_of(domain.high)}, wrap);
  add_up(wrap);
  wrap.note = std::move(note);
  return wrap;
}

double suggest_offset(OffsetHints const& hints) {
  double offset = std::max({2 * hints.layer_height, 3 * hints.wall_edge, hints.motion / 4, hints.body / 25});
  if (hints.gap > 0) offset = std::min(offset, hints.gap / 3);
  return std::max(offset, hints.layer_height);
}

UnstructuredMesh wrap_mesh(Wrap const& wrap) {
  UnstructuredMesh mesh;
  mesh.dimension = wrap.dimension;
  mesh.source = "wrap";
  bool const flat = wrap.dimension == 2;
  Index const ni = wrap.cells(0) + 1, nj = wrap.cells(1) + 1, nk = flat ? 1 : wrap.cells(2) + 1;
  std::vector<Number> number(std::size_t(ni * nj * nk), -1);
  std::vector<Vec3> points;
  auto node = [&](int i, int j, int k) {
    Number& n = number[std::size_t(i + ni * (j + nj * k))];
    if (n < 0) {
      n = Number(points.size());
      points.push_back({wrap.planes[0][std::size_t(i)], wrap.planes[1][std::size_t(j)],
                        flat ? 0.0 : wrap.planes[2][std::size_t(k)]});
    }
    return n;
  };
  UnstructuredPatch surface;
  surface.name = "wrap";
  surface.bc_type = "BCWall";
  surface.kind = PatchKind::wall;
  surface.zone = 0;
  std::vector<std::array<Number, 8>> hexahedra;
  for (Index c = 0; c < wrap.n_cells(); ++c) {
    if (wrap.inside[std::size_t(c)] == 0) continue;
    Index3 const at = wrap.index(c);
    auto const [i, j, k] = at;
    // Corner (a, b, c) of the cell at 4 c + 2 b + a.
    std::array<Number, 8> corner{};
    for (int n = 0; n < (flat ? 4 : 8); ++n) corner[std::size_t(n)] = node(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
    hexahedra.push_back({corner[0], corner[1], corner[3], corner[2], corner[4], corner[5], corner[7], corner[6]});
    for (int axis = 0; axis < wrap.dimension; ++axis)
      for (int const side : {0, 1}) {
        Index3 beyond = at;
        beyond[std::size_t(axis)] += 2 * side - 1;
        if (wrap.is_inside(beyond)) continue;
        std::size_t const fixed = std::size_t(side) << axis, u = std::size_t(axis == 0 ? 2 : 1),
                          v = std::size_t(axis == 2 ? 2 : 4);
        std::array<Number, 4> const face{corner[fixed], corner[fixed + u], corner[flat ? fixed : fixed + u + v],
                                         corner[flat ? fixed : fixed + v]};
        surface.faces.add(std::span(face).first(flat ? 2 : 4));
      }
  }
  mesh.add_zone("wrap", Index(points.size()));
  for (auto const& corners : hexahedra)
    mesh.add_element(flat ? ElementType::quadrilateral : ElementType::hexahedron,
                     std::span(corners).first(flat ? 4 : 8));
  mesh.patches.push_back(std::move(surface));
  mesh.coordinates = Coordinates(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) mesh.coordinates.set(Index(n), points[n]);
  return mesh;
}

}  // namespace gridmorph
