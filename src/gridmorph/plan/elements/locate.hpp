// Which element of an unstructured mesh contains a point, and where in it: interpolation from one mesh to the nodes of
// another.
//
// A tree over the elements' boxes (kernels/box_tree.hpp) leads to the few that can contain a point; those are asked by
// the inverse of their map (kernels/element_map.hpp). A point that none contains belongs to the nearest element
// (kernels/element_place.hpp). Nothing depends on the number of threads, on how the tree came out, or on the other
// points.
//
//   Location where = ...;  // of a point, by ElementLocator
//   // The displacement of `nodes` from that of the mesh's nodes.
//   InterpolationOperator rows = interpolation_rows(exec, mesh, where, nodes);
//
// Polyhedra are cut into tetrahedra between the mean of their nodes, the mean of the nodes of a face, and an edge of
// that face. The weights of both means are handed on to their nodes in equal parts: never negative, sum one, linear
// fields exact, and continuous across faces.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/polyhedron_views.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

#include <span>
#include <string>

namespace gridmorph {

/// A place in an element.
struct Location {
  Index32 element = -1;  ///< -1: there is no element, or the point is not a number
  Index32 part = 0;      ///< of a polyhedron: which of its tetrahedra, counting the edges of all its faces
  Vec3 local;            ///< coordinates of kernels/element_map.hpp, within the element (or the tetrahedron)
  double distance = 0;   ///< of the point from there [length]; 0: inside
};

namespace detail {

/// What a kernel has to know of the mesh.
template <class MemorySpace>
struct LocatorTables {
  ElementViews<MemorySpace> elements;
  Kokkos::View<double const*, MemorySpace> x, y, z;  ///< (n_nodes)
  PolyhedronViews<MemorySpace> polyhedra;
  Kokkos::View<Index32*, MemorySpace> element;           ///< (candidates) in tree order
  Kokkos::View<kernels::BoxGroup*, MemorySpace> groups;  ///< of the tree
  kernels::BoxTreeView tree;
  Vec3 low, steps;           ///< of the lattice, see LatticePlace
  Vec3 plane_point, normal;  ///< of a 2-D mesh
  bool two_dimensional = false;
  double tolerance = 0;
};

}  // namespace detail

/// Finds points in some elements of a mesh.
///
/// "Contains" allows for round-off: 1e-12 of the mesh's size. Of several elements that contain a point (on faces, edges
/// and nodes, or where elements overlap) the one with the smallest number is taken; of several that are equally near
/// (to single precision) the one towards the least x, then y, then z, and only where they share that place the smallest
/// number. Elements without volume and inside-out ones are found like others as far as their maps have an inverse; else
/// they count as what their faces enclose. In 2-D meshes points are projected on the mesh's plane first, and distances
/// are measured in it.
///
/// Cost, linear: building sorts the candidates (a key of 8 and a number of 4 bytes each, moved eight times) and keeps
/// 31 bytes for each, 0.2 microseconds; a point inside costs about 1 microsecond, a point far outside of flat elements
/// 20 times that (one core of an AMD EPYC at 2.6 GHz, a million elements, points in no order). While they are being
/// located, points take 48 bytes each.
template <class Exec>
class ElementLocator {
 public:
  using MemorySpace = typename Exec::memory_space;

  /// `elements`: the candidates, each once, in any order. On the host the mesh must outlive the locator. Throws
  /// MeshError for numbers of elements that the mesh does not have. Fences.
  ElementLocator(Exec const& exec, Mesh const& mesh, std::span<Index32 const> elements);
  /// A locator in all elements of the mesh.
  ElementLocator(Exec const& exec, Mesh const& mesh);

  /// out(n): where points(n) is. `out` is at least as long as `points`.
  void locate(Exec const& exec, Kokkos::View<Vec3 const*, MemorySpace> points,
              Kokkos::View<Location*, MemorySpace> out) const;

  [[nodiscard]] Index n_candidates() const { return Index(tables_.element.extent(0)); }
  /// Distance up to which a point counts as inside.
  [[nodiscard]] double tolerance() const { return tables_.tolerance; }

 private:
  detail::LocatorTables<MemorySpace> tables_;
};

/// Where the points are among the elements, all of them or `elements`.
std::vector<Location> locate(HostInstance const& host, Mesh const& mesh, std::span<Index32 const> elements,
                             std::span<Vec3 const> points);
std::vector<Location> locate(HostInstance const& host, Mesh const& mesh, std::span<Vec3 const> points);

/// Weights of an element's corner nodes at a place: as many as Elements::corners() has. Without gaps: also those that
/// are zero.
std::vector<double> corner_weights(Mesh const& mesh, Location const& location);

/// Position of a place, from the mesh's coordinates.
Vec3 position(Mesh const& mesh, Location const& location);

/// One row for each location: target n is the weighted mean of the corner nodes of the element there. Points outside
/// take the weights of the nearest place: nothing is extrapolated. Weights below 1e-9 are left out, so that a point on
/// a node is a copy of that node. `targets`: as many as locations. Throws MeshError for a location without an element.
InterpolationOperator interpolation_rows(HostInstance const& host, Mesh const& mesh,
                                         std::span<Location const> locations, std::span<Index32 const> targets);

/// Summary of many locations.
struct LocateReport {
  Index inside = 0, outside = 0;
  double largest_distance = 0;  ///< [length]
  Index worst = -1;             ///< which location has it, the first of equals; -1: none is outside
};

/// Locations without an element count as outside, at an infinite distance.
LocateReport summarise(std::span<Location const> locations);

}  // namespace gridmorph
