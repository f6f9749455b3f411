// One point in the elements of a mesh; internal to the locator.
#pragma once

#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <cstdint>

namespace gridmorph::detail {

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

}  // namespace gridmorph::detail
