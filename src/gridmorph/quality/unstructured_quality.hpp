// Quality of unstructured meshes: the measures, the report and the guarantees of quality.hpp, for elements of all
// types.
//
// Formulas are written beside the device functions in gridmorph/kernels/element_quality.hpp, those of polyhedra in
// polyhedron_quality.hpp. Hexahedra give the same numbers as the cells of a structured mesh.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/quality.hpp>

namespace gridmorph {

/// Elements to be measured by themselves as well, wherever they lie in near and far field.
template <class MemorySpace>
struct NamedElements {
  std::string name;
  Kokkos::View<std::uint8_t const*, MemorySpace> elements;  ///< (n_elements), nonzero: of the region
};

/// What is measured.
template <class MemorySpace>
struct UnstructuredQualityInput {
  CoordinateViews<MemorySpace> coordinates;
  /// The mesh before morphing; left empty, `coordinates` are the baseline.
  CoordinateViews<MemorySpace> baseline;
  /// (n_elements), nonzero: near field. Left empty, every element is in the far field.
  Kokkos::View<std::uint8_t const*, MemorySpace> near_field;
  /// Numbers in Mesh::patches. Heights are measured at their nodes that a column of prisms, hexahedra or (2-D)
  /// quadrilaterals leaves from.
  std::vector<int> walls;
  /// numbering_signs() of the baseline; left empty, they are found again, from the coordinates of the mesh.
  std::vector<signed char> signs;
  CellFields<MemorySpace> fields;
  CellLimits limits = {};  ///< what elements are judged by against the baseline
  bool fast = false;       ///< only a verdict: half the time and no memory per element; no fields
  /// Non-orthogonality and face skewness too, which solvers that work by faces ask for; not where `fast`. A third more
  /// time, 32 bytes per element.
  bool faces = false;
  std::vector<NamedElements<MemorySpace>> regions = {};  ///< each costs as much as all; not looked at where `fast`
};

/// (n_elements) Signs of the elements' volumes in SIDS order, of polyhedra with their faces as they point. Host,
/// parallel.
std::vector<signed char> volume_signs(HostInstance const& host, Mesh const& mesh);
inline std::vector<signed char> volume_signs(Mesh const& mesh) { return volume_signs(HostInstance(), mesh); }

/// (n_elements) +1, or -1 for elements that are numbered inside out. Whether two neighbours are numbered alike
/// follows from the side that they share: seen from one and from the other it must be named in opposite ways. So the
/// signs of elements that hang together are known but for one, which is that of most of their volumes. An element that
/// is inverted among elements numbered like it is told from one that is numbered the other way and sound (hybrid meshes
/// whose triangles run one way and quadrilaterals the other). Linear cost; where all volumes of a zone have one sign,
/// nothing is looked at.
std::vector<signed char> numbering_signs(Mesh const& mesh, ElementSides const& sides,
                                         std::vector<signed char> const& volume_signs);
std::vector<signed char> numbering_signs(HostInstance const& host, Mesh const& mesh, ElementSides const& sides);
inline std::vector<signed char> numbering_signs(Mesh const& mesh, ElementSides const& sides) {
  return numbering_signs(HostInstance(), mesh, sides);
}

/// Elements of one type in one zone whose volume is negative as they are numbered.
struct NegativeElements {
  int zone = -1;
  ElementType type = ElementType::tetrahedron;
  Index count = 0, of = 0;
  Index first = -1;  ///< number in the mesh
};

/// Only where there are any.
std::vector<NegativeElements> negative_elements(Mesh const& mesh, std::vector<signed char> const& volume_signs);
std::vector<NegativeElements> negative_elements(Mesh const& mesh);

/// "zone 'Fluid': 12 of 400 prisms are numbered inside out (negative volume), the first is prism 17".
std::string describe(Mesh const& mesh, NegativeElements const& negative);

/// Measures every element and the walls. Returns numbers, so it fences. Throws MeshError when Views are shorter than
/// the mesh. Memory: 8 bytes per element for volumes and, on devices, the element lists and neighbours.
template <BuiltFor Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                              BoundaryFacePatches const& face_patches,
                              UnstructuredQualityInput<typename Exec::memory_space> const& input);

/// Values of the given measures in every element, (n_elements) each, in the order asked for.
template <BuiltFor Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
    UnstructuredQualityInput<typename Exec::memory_space> const& input, std::span<Measure const> measures);

}  // namespace gridmorph
