// Tables that kernels over unstructured elements need; internal to the quality part.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/kernels/curved_element.hpp>
#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/kernels/polyhedron_quality.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/mesh/polyhedron_views.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <vector>

namespace gridmorph::detail {

template <class MemorySpace>
using PackedPoints = Kokkos::View<kernels::PackedVec3 const*, MemorySpace>;

template <class Exec>
PackedPoints<typename Exec::memory_space> pack(Exec const& exec, CoordinateViews<typename Exec::memory_space> const& c,
                                               Index n_nodes) {
  Kokkos::View<kernels::PackedVec3*, typename Exec::memory_space> const points(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::points"), n_nodes);
  kernels::pack_points(exec, field_of(c), points);
  return points;
}

KOKKOS_INLINE_FUNCTION Vec3 point(kernels::PackedVec3 const& p) { return {p.x, p.y, p.z}; }
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Vec3 point_at(PackedPoints<MemorySpace> const& points, Index32 node) {
  return point(points(node));
}
/// For few elements: x, y and z come from three places.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Vec3 point_at(CoordinateViews<MemorySpace> const& c, Index32 node) {
  return {c.x(node), c.y(node), c.z(node)};
}
KOKKOS_INLINE_FUNCTION Vec3 point_at(kernels::VectorArray const& x, Index32 node) { return x[node]; }

/// A polyhedron as polyhedron_quality.hpp asks for it. Points: anything with point_at().
template <class MemorySpace, class Points>
struct PolyhedronAt {
  PolyhedronViews<MemorySpace> const& tables;
  Points const& points;
  Index first, count;

  KOKKOS_INLINE_FUNCTION int n_faces() const { return int(count); }
  KOKKOS_INLINE_FUNCTION int n_corners(int face) const {
    return int(tables.faces.first(first + face + 1) - tables.faces.first(first + face));
  }
  KOKKOS_INLINE_FUNCTION Vec3 at(int face, int corner) const {
    return point_at(points, tables.faces.item(tables.faces.first(first + face) + corner));
  }
};

/// An element of any other type in the same way; in 2-D its sides have two corners.
struct FacesAt {
  ElementType type;
  kernels::ElementCorners corners;

  KOKKOS_INLINE_FUNCTION int n_faces() const { return gridmorph::n_faces(type); }
  KOKKOS_INLINE_FUNCTION int n_corners(int face) const { return n_face_corners(type, face); }
  KOKKOS_INLINE_FUNCTION Vec3 at(int face, int corner) const { return corners.at[face_corner(type, face, corner)]; }
};

/// Elements of all types, measured at any coordinates that have a point_at().
template <class MemorySpace>
struct ElementTables {
  ElementViews<MemorySpace> elements;
  PolyhedronViews<MemorySpace> polyhedra;
  Vec3 plane_normal;
  /// Whether the mesh has polyhedra; solvers take it by faces then, whatever types its elements have: those with J < 0
  /// are what their pyramids are.
  bool by_faces;

  KOKKOS_INLINE_FUNCTION ElementType type(Index e) const { return elements.type(e); }
  template <class Points>
  KOKKOS_INLINE_FUNCTION PolyhedronAt<MemorySpace, Points> polyhedron(Points const& points, Index e) const {
    Index const p = polyhedra.number_of(e), first = polyhedra.first_face(p);
    return {polyhedra, points, first, polyhedra.first_face(p + 1) - first};
  }
  /// f(faces) with a PolyhedronAt or a FacesAt.
  template <class Points, class Function>
  KOKKOS_INLINE_FUNCTION auto with_faces(Points const& points, Index e, Function const& f) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return f(polyhedron(points, e));
    return f(FacesAt{t, corners(points, e)});
  }
  KOKKOS_INLINE_FUNCTION bool is_curved(Index e) const {
    return kernels::is_second_order(type(e), elements.first(e + 1) - elements.first(e));
  }
  /// An element of second order with all nodes that such an element may have.
  template <class Points>
  KOKKOS_INLINE_FUNCTION kernels::CurvedElement curved(Points const& points, Index e) const {
    kernels::CurvedElement out{type(e), {}};
    Index const first = elements.first(e), n = elements.first(e + 1) - first;
    for (Index k = 0; k < n; ++k) out.at[k] = point_at(points, elements.node(first + k));
    if (n < kernels::n_curved_nodes(out.type)) kernels::curved::complete(out);
    return out;
  }
  /// The pyramids of an element with J < 0 in a mesh that is taken by its faces, if all of them have volume: S . (f -
  /// x_c) > 0, what checkMesh of OpenFOAM asks of every cell (primitiveMeshCheck, checkFacePyramids). take(pyramids)
  template <class Points, class Take>
  KOKKOS_INLINE_FUNCTION bool is_sound_by_faces(Points const& points, Index e, double sign, Take const& take) const {
    if (!by_faces) return false;
    auto const pyramids = kernels::polyhedron::pyramids(FacesAt{type(e), corners(points, e)}, sign);
    if (!kernels::is_finite(pyramids.volume) || !(pyramids.least > 0)) return false;
    take(pyramids);
    return true;
  }
  /// All measures of element e; sign: -1 where it is numbered inside out.
  template <class Points>
  KOKKOS_INLINE_FUNCTION kernels::CellMeasures measures(Points const& points, Index e, double sign) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return kernels::polyhedron_measures(polyhedron(points, e), sign);
    if (is_curved(e)) return kernels::curved_measures(curved(points, e), corners(points, e), sign, plane_normal);
    kernels::CellMeasures m = element_measures(t, corners(points, e), sign, plane_normal);
    if (m.smallest_corner_jacobian < 0 || m.determinant_3x3x3 < 0)
      is_sound_by_faces(points, e, sign, [&](kernels::polyhedron::Pyramids const& pyramids) {
        m.smallest_corner_jacobian = pyramids.least;
        m.largest_corner_jacobian = pyramids.largest;
        m.determinant_2x2x2 = m.determinant_3x3x3 = kernels::smaller(1.0, pyramids.share);
      });
    return m;
  }
  template <class Points>
  KOKKOS_INLINE_FUNCTION double determinant(Points const& points, Index e, double sign) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return kernels::polyhedron_determinant(polyhedron(points, e), sign);
    if (is_curved(e))
      return kernels::curved_measures(curved(points, e), corners(points, e), sign, plane_normal).determinant_3x3x3;
    double out = element_determinant(t, corners(points, e), sign, plane_normal);
    if (out < 0)
      is_sound_by_faces(points, e, sign, [&](kernels::polyhedron::Pyramids const& pyramids) {
        out = kernels::smaller(1.0, pyramids.share);
      });
    return out;
  }
  template <class Points>
  KOKKOS_INLINE_FUNCTION double volume(Points const& points, Index e) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return kernels::polyhedron::centre_of(polyhedron(points, e)).volume;
    return element_volume(t, corners(points, e), 1, plane_normal);
  }
  /// Where its Jacobian is positive; of a polyhedron, whether all of its pyramids are.
  template <class Points>
  KOKKOS_INLINE_FUNCTION kernels::JacobianSign jacobian_sign(Points const& points, Index e, double sign) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return kernels::polyhedron_sign(polyhedron(points, e), sign);
    if (is_curved(e)) return kernels::curved_sign(curved(points, e), corners(points, e), sign, plane_normal);
    kernels::JacobianSign const out = kernels::jacobian_sign(t, corners(points, e), sign, plane_normal);
    bool const sound = out >= kernels::JacobianSign::negative &&
                       is_sound_by_faces(points, e, sign, [](kernels::polyhedron::Pyramids const&) {});
    return sound ? kernels::JacobianSign::positive : out;
  }
  /// The scaled Jacobian: of straight elements kernels::scaled_jacobian(), of polyhedra their determinant, which is
  /// scaled; of curved elements what is smaller, that of their corners or J anywhere against the element with straight
  /// edges.
  template <class Points>
  KOKKOS_INLINE_FUNCTION double scaled_jacobian(Points const& points, Index e, double sign) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron) return determinant(points, e, sign);
    kernels::ElementCorners const straight = corners(points, e);
    double const at_corners = kernels::scaled_jacobian(t, straight, sign, plane_normal);
    if (!is_curved(e)) return at_corners;
    double const scale = kernels::curved::tolerance(t, straight) / kernels::flat_fraction;
    double const anywhere = measures(points, e, sign).smallest_corner_jacobian / scale;
    return kernels::is_finite(anywhere) ? kernels::smaller(at_corners, anywhere) : at_corners;
  }
  template <class From, class To>
  KOKKOS_INLINE_FUNCTION kernels::FlatCell flat_element(From const& from, To const& to, Index e, double sign) const {
    return {scaled_jacobian(from, e, sign), scaled_jacobian(to, e, sign)};
  }
  /// From one place to another.
  template <class From, class To>
  KOKKOS_INLINE_FUNCTION double relative_displacement(From const& from, To const& to, Index e) const {
    ElementType const t = type(e);
    if (t == ElementType::polyhedron)
      return kernels::polyhedron_relative_displacement(polyhedron(from, e), polyhedron(to, e));
    return element_relative_displacement(t, corners(from, e), corners(to, e));
  }

  template <class Points>
  KOKKOS_INLINE_FUNCTION kernels::ElementCorners corners(Points const& points, Index e) const {
    kernels::ElementCorners out;
    Index const first = elements.first(e);
    int const n = n_corners(elements.type(e));
    for (int k = 0; k < n; ++k) out.at[k] = point_at(points, elements.node(first + k));
    return out;
  }
};

template <class Exec>
ElementTables<typename Exec::memory_space> element_tables(Exec const& exec, Mesh const& mesh) {
  return {views(exec, mesh.elements), views(exec, mesh.polyhedra), plane_normal(mesh), !mesh.polyhedra.element.empty()};
}

/// Elements zone after zone in chunks of cells_per_chunk; box_extent[0] counts those of the zone.
inline std::vector<kernels::CellChunk> element_chunks(Mesh const& mesh) {
  std::vector<kernels::CellChunk> chunks;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index const n = mesh.zones[z].n_elements;
    for (Index begin = 0; begin < n; begin += kernels::cells_per_chunk)
      chunks.push_back({z,
                        {0, 0, 0},
                        {int(n), 1, 1},
                        begin,
                        begin + kernels::cells_per_chunk < n ? begin + kernels::cells_per_chunk : n});
  }
  return chunks;
}

inline std::vector<Index> first_elements(Mesh const& mesh) {
  std::vector<Index> first;
  for (auto const& zone : mesh.zones) first.push_back(zone.first_element);
  return first;
}

/// Largest volume ratio of element e to its neighbours (those not below 0); 1 without any, unbounded unless all volumes
/// are positive.
template <class VolumeView, class MemorySpace>
KOKKOS_INLINE_FUNCTION double worst_ratio(VolumeView const& volumes, CsrViews<MemorySpace> const& neighbours, Index e) {
  double least = volumes(e), largest = least;
  for (Index n = neighbours.first(e); n < neighbours.first(e + 1); ++n) {
    Index32 const other = neighbours.item(n);
    if (other < 0) continue;
    least = kernels::smaller(least, volumes(other));
    largest = kernels::larger(largest, volumes(other));
  }
  double const own = volumes(e);
  if (!(least > 0)) return kernels::unbounded;
  return kernels::larger(largest / own, own / least);
}

/// What is on the other side of each side of each element as ElementSides has it, but through connections too; empty
/// where none leads to an element.
std::vector<Index32> neighbours_across(UnstructuredTopology const& topology);

/// What is behind a side that a connection leads from.
struct SideLink {
  Index32 element = -1, side = -1;
  Mat3 turn;  ///< of directions there into those here
};
/// ElementSides::neighbour where link k leads from a side: first_link - k.
inline constexpr Index32 first_link = -4;

struct LinkedSides {
  std::vector<Index32> neighbour;  ///< as ElementSides has it, but for links; empty where there are none
  std::vector<SideLink> links;     ///< in the order of the boundary faces
};
LinkedSides linked_sides(Mesh const& mesh, UnstructuredTopology const& topology);

/// `known` where it has an entry per element, else numbering_signs().
std::vector<signed char> signs_of(HostInstance const& host, Mesh const& mesh, ElementSides const& sides,
                                  std::vector<signed char> const& known);

}  // namespace gridmorph::detail
