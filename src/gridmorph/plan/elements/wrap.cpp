#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/column_heights.hpp>
#include <gridmorph/plan/elements/wrap.hpp>
#include <gridmorph/plan/elements/wrap_cells.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gridmorph {
namespace {

std::array<double, 3> array_of(Vec3 const& p) { return {p.x, p.y, p.z}; }

/// Marks the cells that come closer to a wall face than the offset.
void mark(Coordinates const& coordinates, std::span<CsrGraph const> walls, detail::Reaches const& reaches, Wrap& wrap) {
  std::vector<std::array<double, 3>> p;
  // Cells as far as the offset are common on even meshes: round-off must not decide.
  std::size_t face = 0;
  for (CsrGraph const& faces : walls)
    for (Index f = 0; f < faces.size(); ++f) {
      p.clear();
      auto const& offset = reaches[face++];
      std::array<double, 3> reach{};
      for (std::size_t a = 0; a < 3; ++a) reach[a] = offset[a] * (1 - 1e-6);
      LatticeBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
      for (Index32 const n : faces[f]) {
        p.push_back(array_of(coordinates[n]));
        if (wrap.dimension == 2) p.back()[2] = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], p.back()[a] - offset[a]);
          box.high[a] = std::max(box.high[a], p.back()[a] + offset[a]);
        }
      }
      Index3 first{}, last{};
      for (int a = 0; a < 3; ++a) {
        // The outermost cells stay free.
        auto const s = std::size_t(a);
        int const begin = a < wrap.dimension && !wrap.reaches[s][0] ? 1 : 0,
                  end = wrap.cells(a) - (a < wrap.dimension && !wrap.reaches[s][1] ? 2 : 1);
        first[s] = std::clamp(wrap.interval(a, box.low[s]), begin, end);
        last[s] = std::clamp(wrap.interval(a, box.high[s]), begin, end);
      }
      for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
          for (int i = first[0]; i <= last[0]; ++i) {
            std::uint8_t& inside = wrap.inside[wrap.cell({i, j, k})];
            if (inside == 0 && detail::polygon_meets_box(p, wrap.box({i, j, k}), reach)) inside = 1;
          }
    }
}

/// sum(i, j, k): inside cells with indices below i, j and k.
void add_up(Wrap& wrap) {
  Index const ni = wrap.cells(0) + 1, nj = wrap.cells(1) + 1, nk = wrap.cells(2) + 1;
  wrap.sum.assign(ni * nj * nk, 0);
  auto at = [&](Index i, Index j, Index k) -> std::int32_t& { return wrap.sum[i + ni * (j + nj * k)]; };
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
    box.low[a] = planes[a][c[a]];
    box.high[a] = planes[a][std::size_t(c[a]) + 1];
  }
  return box;
}

int Wrap::interval(int axis, double coordinate) const {
  auto const& p = planes[axis];
  auto const above = std::upper_bound(p.begin() + 1, p.end() - 1, coordinate);
  return int(above - p.begin()) - 1;
}

Index3 Wrap::find(Vec3 const& q) const {
  return {interval(0, q.x), interval(1, q.y), dimension == 2 ? 0 : interval(2, q.z)};
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
  auto at = [&](Index i, Index j, Index k) { return sum[i + ni * (j + nj * k)]; };
  auto below = [&](Index k) {
    return at(last[0], last[1], k) - at(first[0], last[1], k) - at(last[0], first[1], k) + at(first[0], first[1], k);
  };
  return below(last[2]) > below(first[2]);
}

Wrap make_wrap(HostInstance const& host, Mesh const& mesh, std::span<CsrGraph const> walls,
               WrapOptions const& options) {
  if (!(options.offset > 0) || !std::isfinite(options.offset))
    throw MotionError("the offset of the wrap is " + std::to_string(options.offset) +
                      "; give a positive length, such as twice the height of the boundary layer");
  if (options.resolution < 1)
    throw MotionError("the resolution of the wrap is " + std::to_string(options.resolution) +
                      " cells; give at least 1");
  Index faces = 0;
  for (CsrGraph const& list : walls) faces += list.size();
  if (faces == 0) throw MeshError("there is nothing to wrap: the moving walls have no faces");

  auto const box_of = [&](Coordinates const& coordinates) {
    MeshExtent const extent = extent_of(host, coordinates);
    return LatticeBox{array_of(extent.low), array_of(extent.high)};
  };
  std::string note;
  if (options.tube)
    if (auto tube = fit_tube(mesh, walls, options.offset, note)) {
      Wrap wrap = around(std::move(*tube), box_of(mesh.coordinates), options);
      try {
        (void)make_background(wrap);
        return wrap;
      } catch (MeshError const& e) {
        note = e.what();
      }
    }
  ChartedDomain const domain = options.domain.value_or(ChartedDomain{});
  Coordinates const coordinates = domain.chart.mapped(host, mesh.coordinates);
  detail::Reaches const reach = detail::reaches_of(mesh.coordinates, domain.chart, walls, options.offset);
  LatticeBox box = box_of(coordinates);
  for (std::size_t a = 0; a < 3; ++a) {
    if (domain.ends(int(a), 0)) box.low[a] = domain.box.low[a];
    if (domain.ends(int(a), 1)) box.high[a] = domain.box.high[a];
  }
  Wrap wrap = detail::make_lattice(mesh, coordinates, walls, reach, box, options);
  wrap.domain = domain;
  mark(coordinates, walls, reach, wrap);
  detail::fill(coordinates, box, wrap);
  add_up(wrap);
  wrap.note = std::move(note);
  return wrap;
}

double suggest_offset(OffsetHints const& hints) {
  double offset = std::max({2 * hints.layer_height, 2 * hints.wall_edge, hints.motion / 8, hints.body / 25});
  // What is wrapped moves as a whole: enough of the gap must be left to take the motion up.
  if (hints.gap > 0) offset = std::min(offset, room_in_gap(hints.gap, hints.motion));
  return std::max(offset, hints.layer_height);
}

}  // namespace gridmorph
