#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/middle_nodes.hpp>
#include <gridmorph/kernels/curved_margin.hpp>
#include <gridmorph/kernels/slip_edge.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gridmorph::detail {

namespace {

void sort_unique(std::vector<Index32>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Mean of the corners of the edge, face or element amid which node `at` of an element is.
Vec3 mean_of_corners(Mesh const& mesh, Index32 element, int at, Coordinates const& x) {
  ElementType const type = mesh.elements.type[element];
  auto const corners = mesh.elements.corners(element);
  int const edge = at - n_corners(type);
  if (edge < n_edges(type))
    return 0.5 * (x[corners[edge_corner(type, edge, 0)]] + x[corners[edge_corner(type, edge, 1)]]);
  auto const mean = [&](std::span<Index32 const> nodes) {
    Vec3 sum;
    for (Index32 const n : nodes) sum += x[n];
    return (1.0 / double(nodes.size())) * sum;
  };
  int square = edge - n_edges(type);
  if (!is_surface(type))
    for (int f = 0; f < n_faces(type); ++f) {
      if (n_face_corners(type, f) != 4 || square-- > 0) continue;
      std::array<Index32, max_face_corners> room;
      return mean(side_nodes(mesh, element, f, room));
    }
  return mean(corners);
}

}  // namespace

MiddleNodes::MiddleNodes(Mesh const& mesh, GuardedElements const& plan, ElementTables<Kokkos::HostSpace> const& tables,
                         std::vector<signed char> const& signs)
    : mesh_(mesh), plan_(plan), tables_(tables), signs_(signs) {
  auto const rows = std::size_t(plan_.middle.size());
  std::vector<Index32> row_of_node(mesh.n_nodes(), -1);
  for (std::size_t r = 0; r < rows; ++r) row_of_node[plan_.middle.target[r]] = Index32(r);
  row_of_.resize(mesh.n_nodes());
  for (std::size_t n = 0; n < row_of_.size(); ++n) row_of_[n] = row_of_node[plan_.graph.representative[n]];
  margin_before_.assign(mesh.n_elements(), std::numeric_limits<double>::quiet_NaN());
  movable_.assign(rows, 1);
  slides_.assign(rows, -1);
  for (std::size_t k = 0; k < plan_.middle_on_boundary.size(); ++k) {
    Index32 const row = row_of_node[plan_.middle_on_boundary[k]];
    if (row < 0) continue;
    if (plan_.middle_slots[k] >= 0)
      movable_[row] = 0;
    else
      slides_[row] = Index32(k);
  }
  for (PeriodicImage const& image : plan_.images)
    for (Index32 const n : {image.node, image.owner})
      if (Index32 const row = row_of_node[n]; row >= 0) movable_[row] = 0;
  find_places();
}

void MiddleNodes::find_places() {
  for (Index e = 0; e < mesh_.n_elements(); ++e) {
    if (!tables_.is_curved(e)) continue;
    auto const nodes = mesh_.elements.nodes[e];
    for (std::size_t k = mesh_.elements.corners(e).size(); k < nodes.size(); ++k)
      if (Index32 const row = row_of_[nodes[k]]; row >= 0) places_.push_back({row, Index32(e), std::int8_t(k)});
  }
  std::stable_sort(places_.begin(), places_.end(), [](Place const& a, Place const& b) { return a.row < b.row; });
  first_place_.assign(movable_.size() + 1, 0);
  for (Place const& p : places_) ++first_place_[std::size_t(p.row) + 1];
  for (std::size_t r = 0; r < movable_.size(); ++r) first_place_[r + 1] += first_place_[r];
  std::vector<std::pair<Index32, Index32>> copies;
  for (std::size_t k = 0; k < plan_.copies.size(); ++k)
    if (Index32 const row = row_of_[plan_.copied[k]]; row >= 0) copies.emplace_back(row, plan_.copies[k]);
  std::sort(copies.begin(), copies.end());
  std::vector<Index32> list;
  for (std::size_t r = 0, at = 0; r < movable_.size(); ++r) {
    list.clear();
    for (; at < copies.size() && std::size_t(copies[at].first) == r; ++at) list.push_back(copies[at].second);
    copies_.add(list);
  }
}

double MiddleNodes::margin_at(CoordinateViews<Kokkos::HostSpace> const& x, Index32 e) const {
  return kernels::curved_margin(tables_.curved(x, e), signs_[e], tables_.plane_normal);
}

bool MiddleNodes::straight_one_is_valid(CoordinateViews<Kokkos::HostSpace> const& x, Index32 e) const {
  return kernels::jacobian_sign(tables_.type(e), tables_.corners(x, e), signs_[e], tables_.plane_normal) ==
         kernels::JacobianSign::positive;
}

MiddleNodes::Verdict MiddleNodes::judge(std::vector<Index32> const& elements, double share, Coordinates const& x) {
  struct One {
    double margin = 1;
    bool broken = false;
  };
  std::vector<One> found(elements.size());
  auto const now = views(x), before = views(mesh_.coordinates);
  for_all({}, "gridmorph::middle_nodes::margins", Index(elements.size()), [&](Index k) {
    Index32 const e = elements[k];
    if (!tables_.is_curved(e)) return;
    One& one = found[k];
    one.margin = margin_at(now, e);
    double& was = margin_before_[e];
    if (std::isnan(was)) was = margin_at(before, e);
    one.broken = one.margin < (was > 0 ? share * was : was) && straight_one_is_valid(now, e);
  });
  Verdict out;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k].broken) continue;
    out.broken.push_back(elements[k]);
    out.invalid += found[k].margin > 0 ? 0 : 1;
    out.smallest = std::min(out.smallest, found[k].margin);
  }
  return out;
}

std::vector<Index32> MiddleNodes::rows_of(std::vector<Index32> const& elements) const {
  std::vector<Index32> out;
  for (Index32 const e : elements) {
    if (!tables_.is_curved(e)) continue;
    for (Index32 const n : mesh_.elements.nodes[e].subspan(mesh_.elements.corners(e).size()))
      if (Index32 const row = row_of_[n]; row >= 0 && movable_[row] != 0) out.push_back(row);
  }
  sort_unique(out);
  return out;
}

std::vector<Index32> MiddleNodes::elements_of(std::vector<Index32> const& rows) const {
  std::vector<Index32> out;
  for (Index32 const r : rows)
    for (Index p = first_place_[r]; p < first_place_[r + 1]; ++p) out.push_back(places_[p].element);
  sort_unique(out);
  return out;
}

Vec3 MiddleNodes::on_surfaces(Index32 row, Vec3 const& place) const {
  Index32 const k = slides_[row];
  if (k < 0) return place;
  auto const surfaces = plan_.middle_surfaces[k];
  Vec3 const baseline = mesh_.coordinates[plan_.middle.target[row]];
  std::vector<kernels::SlipSurfaceView> views;
  std::vector<double> own_offsets;
  for (Index32 const surface : surfaces) {
    views.push_back(plan_.surfaces[surface].view());
    own_offsets.push_back(views.back().own_offset(baseline));
  }
  Vec3 u = place - baseline, unused;
  kernels::constrain_to_all<false>(int(views.size()), kernels::Listed<kernels::SlipSurfaceView>{views.data()},
                                   kernels::Listed<double>{own_offsets.data()}, baseline, u, unused);
  return baseline + u;
}

void MiddleNodes::set(Index32 row, Vec3 const& place, Coordinates& x) const {
  Index32 const n = plan_.middle.target[row];
  x.set(n, place);
  for (Index32 const copy : copies_[row]) x.set(copy, mesh_.coordinates[copy] + (place - mesh_.coordinates[n]));
}

std::vector<Vec3> MiddleNodes::straight(std::vector<Index32> const& rows, Coordinates const& x) const {
  std::vector<Vec3> out;
  for (Index32 const r : rows) {
    Place const& p = places_[first_place_[r]];
    out.push_back(on_surfaces(r, mean_of_corners(mesh_, p.element, p.at, x)));
  }
  return out;
}

/// Offsets of nodes amid edges from their straight places, and of those amid faces from where their edges put them,
/// between what stays.
class MiddleNodes::Interpolation {
 public:
  Interpolation(MiddleNodes const& of, std::vector<Index32> const& region, Coordinates const& x)
      : of_(of), region_(region), x_(x), place_of_(of.movable_.size(), -1) {
    for (std::size_t k = 0; k < region.size(); ++k) place_of_[region[k]] = Index32(k);
    offset_.resize(region.size());
    each("gridmorph::middle_nodes::offsets", [&](Index k) {
      if (edge_of(first(k)) >= 0) offset_[k] = own_offset(first(k));
    });
    next_ = offset_;
  }

  /// Jacobi sweeps over edges, then over faces.
  std::vector<Vec3> run(int sweeps) {
    for (bool const faces : {false, true})
      for (int sweep = 0; sweep < sweeps; ++sweep) {
        each("gridmorph::middle_nodes::sweep", [&](Index k) {
          if ((edge_of(first(k)) < 0) == faces) next_[k] = mean_around(region_[k]);
        });
        std::swap(offset_, next_);
      }
    std::vector<Vec3> out(region_.size());
    each("gridmorph::middle_nodes::places", [&](Index k) {
      Index32 const row = region_[k];
      out[k] = of_.on_surfaces(row, place(first(k), row));
    });
    return out;
  }

 private:
  template <class Function>
  void each(char const* label, Function const& f) const {
    for_all({}, label, Index(region_.size()), f);
  }
  [[nodiscard]] Place const& first(Index k) const { return of_.places_[of_.first_place_[region_[k]]]; }
  [[nodiscard]] ElementType type(Place const& p) const { return of_.tables_.type(p.element); }
  /// Number of the edge amid which a node is, or -1.
  [[nodiscard]] int edge_of(Place const& p) const {
    int const edge = p.at - n_corners(type(p));
    return edge < n_edges(type(p)) ? edge : -1;
  }
  [[nodiscard]] Index32 node(Place const& p) const { return of_.mesh_.elements.nodes[p.element][p.at]; }
  /// In the region, or -1.
  [[nodiscard]] Index32 within(Place const& p) const {
    Index32 const row = of_.row_of_[node(p)];
    return row < 0 ? -1 : place_of_[row];
  }
  /// Where the nodes amid the edges put a node amid a face or the element; now: as they are, else where they go.
  [[nodiscard]] Vec3 completed(Place const& p, bool now) const {
    kernels::CurvedElement c{type(p), {}};
    for (int k = 0; k < n_corners(c.type) + n_edges(c.type); ++k) {
      Place const at{-1, p.element, std::int8_t(k)};
      Index32 const moved = now || k < n_corners(c.type) ? -1 : within(at);
      c.at[k] = moved < 0 ? x_[node(at)] : mean_of_corners(of_.mesh_, p.element, k, x_) + offset_[moved];
    }
    kernels::curved::complete(c);
    return c.at[p.at];
  }
  [[nodiscard]] Vec3 own_offset(Place const& p) const {
    return x_[node(p)] - (edge_of(p) >= 0 ? mean_of_corners(of_.mesh_, p.element, p.at, x_) : completed(p, true));
  }
  [[nodiscard]] Vec3 offset(Place const& p) const {
    Index32 const k = within(p);
    return k >= 0 ? offset_[k] : own_offset(p);
  }
  [[nodiscard]] Vec3 place(Place const& p, Index32 row) const {
    Vec3 const own = offset_[place_of_[row]];
    if (edge_of(p) >= 0) return mean_of_corners(of_.mesh_, p.element, p.at, x_) + own;
    Vec3 out = completed(p, false);
    if (type(p) != ElementType::hexahedron) return out;
    if (p.at < 26) return out + own;
    for (int f = 20; f < 26; ++f) out += 0.5 * offset({-1, p.element, std::int8_t(f)});
    return out;
  }

  [[nodiscard]] Vec3 mean_around(Index32 row) const {
    Coordinates const& x = of_.mesh_.coordinates;
    kernels::OffsetMean out;
    for (Index at = of_.first_place_[row]; at < of_.first_place_[row + 1]; ++at) {
      Place const& p = of_.places_[at];
      ElementType const t = type(p);
      auto const add = [&](int other, double share) {
        Place const there{-1, p.element, std::int8_t(other)};
        out.add(offset(there), share, distance(x[node(p)], x[node(there)]));
      };
      if (int const edge = edge_of(p); edge >= 0) {
        auto const way = [&](int e) {
          auto const corners = of_.mesh_.elements.corners(p.element);
          return x[corners[edge_corner(t, e, 1)]] - x[corners[edge_corner(t, e, 0)]];
        };
        for (int other = 0; other < n_edges(t); ++other)
          if (double const share = kernels::offset_share(t, edge, other, way(edge), way(other)); share > 0)
            add(n_corners(t) + other, share);
      } else if (t == ElementType::hexahedron && p.at < 26) {
        constexpr std::int8_t opposite[6] = {5, 3, 4, 1, 2, 0};
        add(20 + opposite[p.at - 20], 1);
      }
    }
    return out.value();
  }

  MiddleNodes const& of_;
  std::vector<Index32> const& region_;
  Coordinates const& x_;
  std::vector<Index32> place_of_;  ///< (rows) in region_, or -1
  std::vector<Vec3> offset_, next_;
};

std::vector<Vec3> MiddleNodes::interpolated(std::vector<Index32> const& region, int sweeps,
                                            Coordinates const& x) const {
  return Interpolation(*this, region, x).run(sweeps);
}

void MiddleNodes::pull_to(std::vector<Index32> const& rows, std::vector<Vec3> const& goals, double share, Verdict& now,
                          std::vector<Index32>& touched, Coordinates& x) {
  constexpr int steps = 8;
  std::vector<Vec3> from;
  for (Index32 const r : rows) from.push_back(x[plan_.middle.target[r]]);
  std::vector<std::uint8_t> gone(rows.size(), 0);
  std::vector<Index32> const around = elements_of(rows);
  Verdict const before = judge(around, share, x);
  Verdict at = before;
  while (!at.broken.empty()) {
    bool moved = false;
    for (Index32 const r : rows_of(at.broken)) {
      auto const found = std::lower_bound(rows.begin(), rows.end(), r);
      if (found == rows.end() || *found != r) continue;
      auto const k = std::size_t(found - rows.begin());
      if (gone[k] == steps) continue;
      double const s = double(++gone[k]) / steps;
      set(r, on_surfaces(r, gone[k] == steps ? goals[k] : from[k] + s * (goals[k] - from[k])), x);
      moved = true;
    }
    if (!moved) break;
    at = judge(around, share, x);
  }
  bool const better = at.better_than(before);
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!better)
      set(rows[k], from[k], x);
    else if (!(x[plan_.middle.target[rows[k]]] == from[k]))
      touched.push_back(rows[k]);
  now = better ? at : before;
}

std::vector<Index> MiddleNodes::pull(std::vector<Index32> const& suspects, double share, Coordinates& x) {
  Verdict now = judge(suspects, share, x);
  std::vector<Index32> touched;
  for (int rings = rings_at_first; rings <= rings_at_most && !now.broken.empty(); rings *= 2)
    for (bool const to_straight : {false, true}) {
      if (now.broken.empty()) break;
      // What is around the broken ones may have to move with them.
      std::vector<Index32> rows = rows_of(now.broken);
      for (int ring = 1; ring < rings; ++ring) rows = rows_of(elements_of(rows));
      if (rows.empty()) break;
      pull_to(rows, to_straight ? straight(rows, x) : interpolated(rows, 2 * rings * rings, x), share, now, touched, x);
    }
  sort_unique(touched);
  return {touched.begin(), touched.end()};
}

}  // namespace gridmorph::detail
