#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/core/sort_keys.hpp>
#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/locate.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

namespace gridmorph {

using kernels::BoxGroup;

namespace detail {

namespace {

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Vec3 node_at(LocatorTables<MemorySpace> const& t, Index node) {
  return {t.x(node), t.y(node), t.z(node)};
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::ElementCorners corners_at(LocatorTables<MemorySpace> const& t, ElementType type,
                                                          Index e) {
  kernels::ElementCorners c;
  Index const first = t.elements.first(e);
  int const n = n_corners(type);
  for (int k = 0; k < n; ++k) c.at[k] = node_at(t, t.elements.node(first + k));
  return c;
}

/// Calls visit(part, corners) for the tetrahedra of a polyhedron until it says true: mean of the nodes, mean of the
/// face, and the two ends of an edge.
template <class MemorySpace, class Visit>
KOKKOS_INLINE_FUNCTION void for_each_part(LocatorTables<MemorySpace> const& t, Index32 element, Visit const& visit) {
  kernels::ElementCorners c;
  Index const begin = t.elements.first(element), end = t.elements.first(element + 1);
  for (Index n = begin; n < end; ++n) c.at[0] += node_at(t, t.elements.node(n));
  c.at[0] = (1.0 / double(end - begin)) * c.at[0];
  Index const polyhedron = t.polyhedra.number_of(element);
  Index32 part = 0;
  for (Index f = t.polyhedra.first_face(polyhedron); f < t.polyhedra.first_face(polyhedron + 1); ++f) {
    Index const first = t.polyhedra.faces.first(f), last = t.polyhedra.faces.first(f + 1);
    c.at[1] = {};
    for (Index n = first; n < last; ++n) c.at[1] += node_at(t, t.polyhedra.faces.item(n));
    c.at[1] = (1.0 / double(last - first)) * c.at[1];
    for (Index n = first; n < last; ++n, ++part) {
      c.at[2] = node_at(t, t.polyhedra.faces.item(n));
      c.at[3] = node_at(t, t.polyhedra.faces.item(n + 1 < last ? n + 1 : first));
      if (visit(part, c)) return;
    }
  }
}

/// Whether an element contains the point; then the place in it.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION bool contains(LocatorTables<MemorySpace> const& t, Index32 element, Vec3 const& p,
                                     Location& place) {
  ElementType const type = t.elements.type(element);
  bool found = false;
  if (type == ElementType::polyhedron) {
    for_each_part(t, element, [&](Index32 part, kernels::ElementCorners const& c) {
      found = element_contains(ElementType::tetrahedron, c, p, t.tolerance, place.local);
      if (found) place.part = part;
      return found;
    });
  } else {
    found = element_contains(type, corners_at(t, type, element), p, t.tolerance, place.local);
    place.part = 0;
  }
  if (!found) return false;
  place.element = element;
  place.distance = 0;
  return true;
}

/// The place of an element nearest to a point, and the way there.
struct NearestPlace {
  Location place;
  Vec3 towards;
};

/// The nearest place of an element that does not contain the point; no element when that is further than `limit`.
/// `towards`: from the point to the best place so far.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION NearestPlace nearest(LocatorTables<MemorySpace> const& t, Index32 element, Vec3 const& p,
                                            Vec3 const& towards, double limit) {
  NearestPlace best;
  best.place.distance = kernels::unbounded;
  auto const look = [&](ElementType type, kernels::ElementCorners const& c, Index32 part) {
    if (!may_be_nearer(type, c, p, towards, limit)) return;
    kernels::ElementPlace const found = nearest_in_element(type, c, p);
    if (!(found.distance < best.place.distance)) return;
    best.place.element = element;
    best.place.part = part;
    best.place.local = found.local;
    best.place.distance = found.distance;
    best.towards = element_position(type, c, found.local) - p;
  };
  ElementType const type = t.elements.type(element);
  if (type == ElementType::polyhedron) {
    for_each_part(t, element, [&](Index32 part, kernels::ElementCorners const& c) {
      look(ElementType::tetrahedron, c, part);
      return false;
    });
  } else {
    look(type, corners_at(t, type, element), 0);
  }
  if (best.place.distance <= t.tolerance) best.place.distance = 0;
  return best;
}

/// Distances that differ by round-off are the same: then the direction decides, so that the choice does not depend on
/// numbers (a point on the axis of a round wall has many nearest places), and where that is the same, the number.
KOKKOS_INLINE_FUNCTION bool is_nearer(NearestPlace const& a, NearestPlace const& b) {
  float const da = float(a.place.distance), db = float(b.place.distance);
  if (da != db) return da < db;
  // In whole steps: comparing with a tolerance would depend on the order of comparisons. Shifted, since components that
  // are 0, 1 or 1/2 are common.
  auto const step = [&](double component) {
    return da > 0 ? std::int64_t((component / double(da) + 2) * 1e6 + 0.37) : 0;
  };
  std::int64_t const ways[3][2] = {{step(a.towards.x), step(b.towards.x)},
                                   {step(a.towards.y), step(b.towards.y)},
                                   {step(a.towards.z), step(b.towards.z)}};
  for (auto const& way : ways)
    if (way[0] != way[1]) return way[0] < way[1];
  return a.place.element < b.place.element;
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Location locate_point(LocatorTables<MemorySpace> const& t, Vec3 p) {
  Location holding;
  holding.distance = kernels::unbounded;
  if (!kernels::is_finite(p.x) || !kernels::is_finite(p.y) || !kernels::is_finite(p.z)) return holding;
  if (t.two_dimensional) p = p - dot(t.normal, p - t.plane_point) * t.normal;
  t.tree.for_each_holding(p, [&](Index thing) {
    Index32 const element = t.element(thing);
    if (holding.element >= 0 && element > holding.element) return;
    contains(t, element, p, holding);
  });
  if (holding.element >= 0) return holding;
  // A plane across the way to the best place rules out most elements behind that.
  NearestPlace best;
  best.place.distance = kernels::unbounded;
  t.tree.for_each_nearer(
      p,
      [&](Index thing) {
        NearestPlace const found = nearest(t, t.element(thing), p, best.towards, best.place.distance);
        if (found.place.element < 0 || !kernels::is_finite(found.place.distance)) return;
        if (best.place.element < 0 || is_nearer(found, best)) best = found;
      },
      [&] { return best.place.distance * best.place.distance * (1 + 1e-6); });
  return best.place;
}

template <class Exec>
using Range = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>;

/// The box of an element's corners, further out by `tolerance`; empty where a corner is not a number.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Box box_of(LocatorTables<MemorySpace> const& t, Index32 element) {
  Box box;
  Index const first = t.elements.first(element);
  ElementType const type = t.elements.type(element);
  Index const last = type == ElementType::polyhedron ? t.elements.first(element + 1) : first + n_corners(type);
  for (Index n = first; n < last; ++n) {
    Vec3 const x = node_at(t, t.elements.node(n));
    if (!kernels::is_finite(x.x + x.y + x.z)) return {};
    box.include(x);
  }
  if (first == last) return box;
  Vec3 const more{t.tolerance, t.tolerance, t.tolerance};
  return {box.low - more, box.high + more};
}

/// Sorts the candidates along the curve.
template <class Exec>
Kokkos::View<Index32*, typename Exec::memory_space> order_candidates(
    Exec const& exec, LocatorTables<typename Exec::memory_space> const& tables,
    Kokkos::View<Index32*, typename Exec::memory_space> const& candidates) {
  KeyedIndices<typename Exec::memory_space> const list(candidates.extent(0), "gridmorph::ElementLocator::order");
  Kokkos::parallel_for(
      "gridmorph::ElementLocator::codes", Range<Exec>(exec, 0, Index(candidates.extent(0))),
      KOKKOS_LAMBDA(Index const n) {
        Index32 const element = candidates(n);
        Box const box = box_of(tables, element);
        list.key(n) = kernels::hilbert_code({0.5 * (box.low + box.high), tables.low, tables.steps});
        list.number(n) = element;
      });
  return sort_keys(exec, list).number;
}

/// First group of each level, and of the one after the last.
std::vector<Index> levels_of(Index n_things) {
  std::vector<Index> first{0};
  for (Index n = n_things; n > 0;) {
    n = (n + BoxGroup::width - 1) / BoxGroup::width;
    first.push_back(first.back() + n);
    if (n == 1) break;
  }
  return first;
}

template <class Exec>
void fill_tree(Exec const& exec, LocatorTables<typename Exec::memory_space>& tables) {
  constexpr int width = BoxGroup::width;
  Index const n = Index(tables.element.extent(0));
  std::vector<Index> const first = levels_of(n);
  tables.groups = Kokkos::View<BoxGroup*, typename Exec::memory_space>(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::ElementLocator::groups"), first.back());
  tables.tree.groups = tables.groups.data();
  tables.tree.n_levels = int(first.size()) - 1;
  for (int l = 0; l < tables.tree.n_levels; ++l) tables.tree.first[l] = first[l];
  auto const t = tables;
  for (int level = 0; level < tables.tree.n_levels; ++level) {
    Index const begin = first[level], end = first[level + 1];
    Index const below = level == 0 ? 0 : first[level - 1];
    Index const n_below = level == 0 ? n : begin - below;
    Kokkos::parallel_for(
        "gridmorph::ElementLocator::boxes", Range<Exec>(exec, 0, end - begin), KOKKOS_LAMBDA(Index const g) {
          BoxGroup& group = t.groups(begin + g);
          for (int k = 0; k < width; ++k) {
            Index const child = g * width + k;
            if (child >= n_below) {
              group.set_empty(k);
              continue;
            }
            if (level > 0) {
              group.set(k, t.groups(below + child));
              continue;
            }
            Box const box = box_of(t, t.element(child));
            if (box.low.x <= box.high.x)
              group.set(k, box);
            else
              group.set_empty(k);
          }
        });
  }
}

/// Points in Z order: neighbours look at the same boxes and elements.
template <class Exec>
Kokkos::View<Index32*, typename Exec::memory_space> order_points(
    Exec const& exec, LocatorTables<typename Exec::memory_space> const& tables,
    Kokkos::View<Vec3 const*, typename Exec::memory_space> const& points) {
  KeyedIndices<typename Exec::memory_space> const list(points.extent(0), "gridmorph::ElementLocator::points");
  Vec3 const low = tables.low, steps = tables.steps;
  Kokkos::parallel_for(
      "gridmorph::ElementLocator::codes", Range<Exec>(exec, 0, Index(points.extent(0))), KOKKOS_LAMBDA(Index const n) {
        list.key(n) = kernels::z_code({points(n), low, steps});
        list.number(n) = Index32(n);
      });
  return sort_keys(exec, list).number;
}

template <class Exec>
void locate_points(Exec const& exec, LocatorTables<typename Exec::memory_space> const& tables,
                   Kokkos::View<Vec3 const*, typename Exec::memory_space> const& points,
                   Kokkos::View<Location*, typename Exec::memory_space> const& out) {
  Index const n_points = Index(points.extent(0));
  auto const order = order_points(exec, tables, points);
  // Side by side first: a search waits for its point, a copy does not.
  Kokkos::View<Vec3*, typename Exec::memory_space> const sorted(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::ElementLocator::sorted"), points.extent(0));
  Kokkos::parallel_for(
      "gridmorph::ElementLocator::sorted", Range<Exec>(exec, 0, n_points),
      KOKKOS_LAMBDA(Index const n) { sorted(n) = points(order(n)); });
  // In small parts: points outside take longer, and stand together.
  Kokkos::parallel_for(
      "gridmorph::locate",
      Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Dynamic>>(exec, 0, n_points,
                                                                                             Kokkos::ChunkSize(256)),
      KOKKOS_LAMBDA(Index const n) { out(order(n)) = locate_point(tables, sorted(n)); });
}

template <class Exec>
Kokkos::View<double const*, typename Exec::memory_space> in_space(Exec const& exec,
                                                                  Coordinates::View const& component) {
  if constexpr (std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>) {
    return component;
  } else {
    Kokkos::View<double*, typename Exec::memory_space> copy(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::ElementLocator::coordinates"),
        component.extent(0));
    Kokkos::deep_copy(exec, copy, component);
    return copy;
  }
}

template <class Exec>
LocatorTables<typename Exec::memory_space> make_tables(Exec const& exec, Mesh const& mesh,
                                                       std::span<Index32 const> elements) {
  using MemorySpace = typename Exec::memory_space;
  for (Index32 const e : elements)
    if (e < 0 || e >= mesh.n_elements())
      throw MeshError("element locator: there is no element " + std::to_string(e) + " in '" + mesh.source +
                      "', which has " + std::to_string(mesh.n_elements()) + "; name elements by their number from 0");
  if (mesh.coordinates.size() < mesh.n_nodes())
    throw MeshError("element locator: '" + mesh.source + "' has " + std::to_string(mesh.n_nodes()) +
                    " nodes, but coordinates of only " + std::to_string(mesh.coordinates.size()));
  LocatorTables<MemorySpace> t;
  t.elements = views(exec, mesh.elements);
  t.x = in_space(exec, mesh.coordinates.x);
  t.y = in_space(exec, mesh.coordinates.y);
  t.z = in_space(exec, mesh.coordinates.z);
  t.polyhedra = views(exec, mesh.polyhedra);

  MeshExtent const box = extent_of(host_instance(exec), mesh.coordinates);
  Vec3 const size = box.high - box.low;
  double largest = 0;
  for (double const a : {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z})
    largest = std::max(largest, std::abs(a));
  t.tolerance = 1e-12 * box.size() + 16 * std::numeric_limits<double>::epsilon() * largest;
  // Cubes, so that neighbours on the curve are neighbours in space.
  double const longest = std::max({size.x, size.y, size.z});
  double const steps = longest > 0 ? double(1 << 21) / longest : 0;
  t.low = box.low;
  t.steps = {steps, steps, steps};
  t.two_dimensional = mesh.dimension == 2;
  if (t.two_dimensional) {
    t.normal = plane_normal(mesh);
    t.plane_point = mesh.coordinates.size() > 0 ? mesh.coordinates[0] : Vec3{};
  }

  Kokkos::View<Index32 const*, Kokkos::HostSpace> const candidates_h(elements.data(), elements.size());
  Kokkos::View<Index32*, MemorySpace> const candidates(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::ElementLocator::candidates"), elements.size());
  Kokkos::deep_copy(exec, candidates, candidates_h);
  t.element = order_candidates(exec, t, candidates);
  fill_tree(exec, t);
  compat::fence(exec, "gridmorph::ElementLocator (built)");
  return t;
}

std::vector<Index32> all_elements(Mesh const& mesh) {
  std::vector<Index32> all(mesh.n_elements());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

}  // namespace detail

template <class Exec>
ElementLocator<Exec>::ElementLocator(Exec const& exec, Mesh const& mesh, std::span<Index32 const> elements)
    : tables_(detail::make_tables(exec, mesh, elements)) {}

template <class Exec>
ElementLocator<Exec>::ElementLocator(Exec const& exec, Mesh const& mesh)
    : tables_(detail::make_tables(exec, mesh, detail::all_elements(mesh))) {}

template <class Exec>
void ElementLocator<Exec>::locate(Exec const& exec, Kokkos::View<Vec3 const*, MemorySpace> points,
                                  Kokkos::View<Location*, MemorySpace> out) const {
  if (out.extent(0) < points.extent(0))
    throw MeshError("element locator: " + std::to_string(points.extent(0)) + " points, but room for only " +
                    std::to_string(out.extent(0)) + " locations");
  detail::locate_points(exec, tables_, points, out);
}

std::vector<Location> locate(HostInstance const& host, Mesh const& mesh, std::span<Index32 const> elements,
                             std::span<Vec3 const> points) {
  std::vector<Location> found(points.size());
  host.visit([&](auto const& exec) {
    Kokkos::View<Vec3 const*, Kokkos::HostSpace> const at(points.data(), points.size());
    Kokkos::View<Location*, Kokkos::HostSpace> const to(found.data(), found.size());
    ElementLocator<std::decay_t<decltype(exec)>> const locator(exec, mesh, elements);
    locator.locate(exec, at, to);
    compat::fence(exec, "gridmorph::locate (read by the host)");
  });
  return found;
}

std::vector<Location> locate(HostInstance const& host, Mesh const& mesh, std::span<Vec3 const> points) {
  return locate(host, mesh, detail::all_elements(mesh), points);
}

#define GRIDMORPH_INSTANTIATE(Exec) template class ElementLocator<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
