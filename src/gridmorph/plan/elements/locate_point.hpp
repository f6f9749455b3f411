// One point in the elements of a mesh; internal to the locator.
#pragma once

#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/plan/elements/locate.hpp>

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

/// Calls visit(part, corners) for the tetrahedra of a polyhedron until it says true: mean of the nodes, mean of the face, and
/// the two ends of an edge.
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

/// Position of a place; that of the element's first corner in a polyhedron.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Vec3 position_at(LocatorTables<MemorySpace> const& t, Location const& place) {
  ElementType const type = t.elements.type(place.element);
  if (type == ElementType::polyhedron) return node_at(t, t.elements.node(t.elements.first(place.element)));
  return element_position(type, corners_at(t, type, place.element), place.local);
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

/// The place of an element nearest to a point that it does not contain; nothing when that is further than `limit`. `towards`:
/// from the point to the best place so far.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Location nearest(LocatorTables<MemorySpace> const& t, Index32 element, Vec3 const& p,
                                        Vec3 const& towards, double limit) {
  Location place;
  place.distance = kernels::unbounded;
  auto const look = [&](ElementType type, kernels::ElementCorners const& c, Index32 part) {
    if (!may_be_nearer(type, c, p, towards, limit)) return;
    kernels::ElementPlace const found = nearest_in_element(type, c, p);
    if (!(found.distance < place.distance)) return;
    place.element = element;
    place.part = part;
    place.local = found.local;
    place.distance = found.distance;
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
  if (place.distance <= t.tolerance) place.distance = 0;
  return place;
}

/// Distances that differ by round-off are the same.
KOKKOS_INLINE_FUNCTION bool is_nearer(Location const& a, Location const& b) {
  float const da = float(a.distance), db = float(b.distance);
  return da < db || (da == db && a.element < b.element);
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Location locate_point(LocatorTables<MemorySpace> const& t, Vec3 p) {
  Location best;
  best.distance = kernels::unbounded;
  if (!kernels::is_finite(p.x) || !kernels::is_finite(p.y) || !kernels::is_finite(p.z)) return best;
  if (t.two_dimensional) p = p - dot(t.normal, p - t.plane_point) * t.normal;
  t.tree.for_each_holding(p, [&](Index thing) {
    Index32 const element = t.element(thing);
    if (best.element >= 0 && element > best.element) return;
    contains(t, element, p, best);
  });
  if (best.element >= 0) return best;
  // A plane across the way to the best place rules out most elements behind that.
  Vec3 towards;
  t.tree.for_each_nearer(
      p,
      [&](Index thing) {
        Location const place = nearest(t, t.element(thing), p, towards, best.distance);
        if (place.element < 0 || !kernels::is_finite(place.distance)) return;
        if (best.element >= 0 && !is_nearer(place, best)) return;
        best = place;
        towards = position_at(t, place) - p;
      },
      [&] { return best.distance * best.distance * (1 + 1e-6); });
  return best;
}

}  // namespace gridmorph::detail
