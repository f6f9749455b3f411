// An unstructured mesh as it stands in a file: zones, elements, boundary patches, connections, coordinates.
//
// The counterpart of mesh.hpp, with the same words: zone, patch, PatchKind, families, periodic, notes. Nothing here is
// interpreted or repaired; what follows from it (neighbours, boundary faces, coincident nodes) is derived by the functions
// of unstructured_topology.hpp. Node numbers are 0-based and run through all zones.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/kernels/element_shape.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gridmorph {

/// "triangle", "tetrahedron", ...
std::string_view to_string(ElementType type);

/// A CGNS Zone_t of type Unstructured, or the one zone of an SU2 file.
struct UnstructuredZone {
  std::string name;  ///< unique in the mesh; "Base/Zone" when the file has several bases
  Index first_node = 0, n_nodes = 0;
  Index first_element = 0, n_elements = 0;
  bool single_precision = false;  ///< the file keeps this zone's coordinates in single precision
};

/// Elements of the mesh's own dimension (volumes in 3-D, surfaces in 2-D), zone after zone in file order.
struct Elements {
  std::vector<ElementType> type;  ///< (n_elements)
  CsrGraph nodes;                 ///< SIDS order: corners first, then the further nodes of second-order elements
  std::vector<Index32>
      number;  ///< as the file counts them, for messages; empty: first_number + place in the file's zone

  [[nodiscard]] Index size() const { return Index(type.size()); }
  /// Corner nodes of element e.
  [[nodiscard]] std::span<Index32 const> corners(Index e) const {
    auto const all = nodes[e];
    ElementType const t = type[std::size_t(e)];
    return t == ElementType::polyhedron ? all : all.first(std::size_t(n_corners(t)));
  }
};

/// One boundary condition of one zone: a list of faces, or only of nodes where the file says no more.
struct UnstructuredPatch {
  std::string name;     ///< BC_t or GridConnectivity_t node name, SU2 marker
  std::string bc_type;  ///< CGNS BCType_t name as in the file, resolved through the family if FamilySpecified
  PatchKind kind = PatchKind::other;
  std::vector<std::string> families;  ///< FamilyName_t first, then AdditionalFamilyName_t; may be empty
  int zone = -1;                      ///< number in UnstructuredMesh::zones
  CsrGraph faces;                     ///< corner nodes of each face (each edge in 2-D), in any order around it
  std::vector<Index32> nodes;         ///< instead of faces, where the file lists nodes; ascending, each once
};

/// Two lists of nodes that coincide one by one, the donor's after `periodic` where there is one.
struct UnstructuredConnection {
  std::string name;
  std::vector<std::string> families;
  int zone = -1;
  int donor_zone = -1;
  std::vector<Index32> nodes;        ///< of zone
  std::vector<Index32> donor_nodes;  ///< of donor_zone, as many
  std::optional<Periodic> periodic;
};

/// Faces of the elements of type polyhedron, in element order.
struct Polyhedra {
  std::vector<Index32> element;   ///< ascending
  std::vector<Index> first_face;  ///< (element.size() + 1) in `faces`; empty when there are none
  CsrGraph faces;                 ///< nodes in order around each face, the normal pointing outwards
};

/// Where in its file each node and element stands, counted from 0 through all zones; empty: where it stands in the mesh. See
/// file_order.hpp.
struct FileOrder {
  std::vector<Index32> node;     ///< (n_nodes) or empty
  std::vector<Index32> element;  ///< (n_elements) or empty
};

struct UnstructuredMesh {
  int dimension = 3;  ///< of the elements: 3 (volumes) or 2 (surfaces)
  std::vector<UnstructuredZone> zones;
  Elements elements;
  Polyhedra polyhedra;
  std::vector<UnstructuredPatch> patches;           ///< of all zones, in file order
  std::vector<UnstructuredConnection> connections;  ///< of all zones, in file order
  std::vector<std::string> families;                ///< Family_t names
  Coordinates coordinates;                          ///< all three components, z = 0 where a file has two
  std::string source;                               ///< file name or what made it, for messages
  std::vector<std::string> notes;                   ///< what the reader skipped or assumed, for `inspect` and logs
  int first_number = 1;                             ///< of nodes in messages: 1 in CGNS, 0 in SU2 files
  FileOrder file_order;                             ///< set by reorder(); readers leave it empty

  [[nodiscard]] Index n_nodes() const { return zones.empty() ? 0 : zones.back().first_node + zones.back().n_nodes; }
  [[nodiscard]] Index n_elements() const { return elements.size(); }
  /// Appends a zone that begins after all nodes and elements so far; its elements are appended by the caller, who counts
  /// them in n_elements.
  int add_zone(std::string name, Index n_nodes);
  /// Appends an element of the last zone.
  void add_element(ElementType type, std::span<Index32 const> nodes);
  [[nodiscard]] int zone_of_node(Index node) const;
  [[nodiscard]] int zone_of_element(Index element) const;
  /// Diagonal of the bounding box: the size that relative tolerances refer to.
  [[nodiscard]] double size() const;
};

/// Number of sides of an element: faces in 3-D, edges in 2-D.
int n_sides(UnstructuredMesh const& mesh, Index element);
/// Corner nodes of one side, the normal pointing outwards; each once, so that collapsed sides have fewer. `room` holds them
/// unless the element is a polyhedron.
std::span<Index32 const> side_nodes(UnstructuredMesh const& mesh, Index element, int side,
                                    std::array<Index32, max_face_corners>& room);

/// Unit normal along which the elements of a 2-D mesh are positive: the axis along which it is constant, otherwise the mean
/// normal of its elements. (0, 0, 1) for a 3-D mesh.
Vec3 plane_normal(UnstructuredMesh const& mesh);

/// All nodes of a patch, ascending, each once.
std::vector<Index32> patch_nodes(UnstructuredPatch const& patch);

/// Elements of each type, in all zones or in one.
std::array<Index, n_element_types> count_types(UnstructuredMesh const& mesh, int zone = -1);

/// "zone 'Fluid' node 17", as the file counts.
std::string describe_node(UnstructuredMesh const& mesh, Index node);
/// "zone 'Fluid' tetrahedron 4711", as the file counts.
std::string describe_element(UnstructuredMesh const& mesh, Index element);
/// The numbers by which the file knows a node and an element of its zone.
Index node_number_in_file(UnstructuredMesh const& mesh, Index node);
Index number_in_file(UnstructuredMesh const& mesh, Index element);
/// Patch name for messages: "'blade' (BC 'blade_ss', zone 'Zone 1')".
std::string describe_patch(UnstructuredMesh const& mesh, UnstructuredPatch const& patch);

/// Checks what readers and generators must guarantee: node and element ranges, node numbers inside their zone, as many
/// nodes as a type asks for, no node twice in a corner list of patches. Throws MeshError that lists all problems. Linear cost.
void check_mesh(UnstructuredMesh const& mesh);

/// Compressed element lists in a memory space, for kernels.
template <class MemorySpace>
struct ElementViews {
  Kokkos::View<ElementType const*, MemorySpace> type;  ///< (n_elements)
  Kokkos::View<Index const*, MemorySpace> first;       ///< (n_elements + 1)
  Kokkos::View<Index32 const*, MemorySpace> node;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index size() const { return Index(type.extent(0)); }
};

/// The same for elements.
template <class Exec>
ElementViews<typename Exec::memory_space> views(Exec const& exec, Elements const& elements) {
  return {detail::view_of(exec, elements.type, "gridmorph::Elements::type"),
          detail::view_of(exec, elements.nodes.first, "gridmorph::Elements::first"),
          detail::view_of(exec, elements.nodes.item, "gridmorph::Elements::node")};
}

}  // namespace gridmorph
