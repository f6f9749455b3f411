// A mesh as it stands in a file: zones of blocks or of elements, boundary patches, connections, coordinates.
//
// Nothing here is cut, interpreted or repaired: what follows from it is found by `boundary` and `plan` (blocks) and by
// unstructured_topology.hpp (elements). Readers fill a Mesh, writers take one, generators make one, and solvers can
// build one from their own arrays without touching files. All numbers are 0-based; those of nodes and elements run
// through all zones.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/element_shape.hpp>

#include <Kokkos_Core.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// The name of a type of element: "triangle", "tetrahedron", ...
std::string_view to_string(ElementType type);

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
    ElementType const t = type[e];
    return t == ElementType::polyhedron ? all : all.first(std::size_t(n_corners(t)));
  }
};

/// Faces of the elements of type polyhedron, in element order.
struct Polyhedra {
  std::vector<Index32> element;   ///< ascending
  std::vector<Index> first_face;  ///< (element.size() + 1) in `faces`; empty when there are none
  CsrGraph faces;                 ///< nodes in order around each face, the normal pointing outwards
};

/// Where in its file each node and element stands, counted from 0 through all zones; empty: where it stands in the
/// mesh. See file_order.hpp.
struct FileOrder {
  std::vector<Index32> node;     ///< (n_nodes) or empty
  std::vector<Index32> element;  ///< (n_elements) or empty
  Index left_out = 0;            ///< nodes that the file has and the mesh does not, see leave_out_unused_nodes()
};

/// Compressed element lists in a memory space, for kernels.
template <class MemorySpace>
struct ElementViews {
  Kokkos::View<ElementType const*, MemorySpace> type;  ///< (n_elements)
  Kokkos::View<Index const*, MemorySpace> first;       ///< (n_elements + 1)
  Kokkos::View<Index32 const*, MemorySpace> node;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index size() const { return Index(type.extent(0)); }
};

/// The element lists of a mesh in the memory space of `exec`.
template <class Exec>
ElementViews<typename Exec::memory_space> views(Exec const& exec, Elements const& elements) {
  return {detail::view_of(exec, elements.type, "gridmorph::Elements::type"),
          detail::view_of(exec, elements.nodes.first, "gridmorph::Elements::first"),
          detail::view_of(exec, elements.nodes.item, "gridmorph::Elements::node")};
}

/// What a boundary is, as far as morphing cares. One per CGNS BCType_t group.
enum class PatchKind {
  wall,        ///< BCWall, BCWallViscous, BCWallInviscid, BCWallViscousHeatFlux, BCWallViscousIsothermal
  inflow,      ///< BCInflow*, BCTunnelInflow
  outflow,     ///< BCOutflow*, BCTunnelOutflow
  symmetry,    ///< BCSymmetryPlane, BCSymmetryPolar (the planes of a 2-D mesh too)
  farfield,    ///< BCFarfield
  degenerate,  ///< BCDegenerateLine, BCDegeneratePoint, BCAxisymmetricWedge: a face collapsed to a line or point
  connection,  ///< a connection that does not match node to node: abutting, overset, mixing plane
  other,       ///< BCGeneral, BCDirichlet, BCNeumann, BCExtrapolate, UserDefined, Null, none at all
  periodic,    ///< one side of a periodic pair whose two sides move independently (passages of a wheel); never from a
               ///< file
  region  ///< no boundary: cells or a grid surface inside the domain that a rule moves (regions.hpp); never from a file
};

/// "wall", "inflow", ... as used by `type:` selectors and in messages. Periodic interfaces are "periodic".
std::string_view to_string(PatchKind kind);

/// One boundary condition of one zone: a range on a face of a block, a list of faces of elements, or only a list of
/// nodes where the file says no more.
struct Patch {
  std::string name;     ///< BC_t or GridConnectivity_t node name, SU2 marker
  std::string bc_type;  ///< CGNS BCType_t name as in the file, resolved through the family if FamilySpecified
  PatchKind kind = PatchKind::other;
  std::vector<std::string> families;  ///< FamilyName_t first, then AdditionalFamilyName_t; may be empty
  int zone = -1;                      ///< number in Mesh::zones
  IndexRange
      range{};       ///< blocks: nodes; extent 1 along exactly one axis (the face normal), of regions along one or none
  CsrGraph faces{};  ///< elements: corner nodes of each face (each edge in 2-D), in any order around it
  std::vector<Index32> nodes{};  ///< instead of faces, where the file lists nodes; ascending, each once
  std::string zone_in_file{};    ///< where `zone` is a block found among elements, the name that selectors know
};

/// Periodicity as declared in the file (CGNS SIDS Periodic_t). `declared` maps this side's nodes onto the donor's
/// nodes. Files carry the angle in single precision: fit the transform to the matched nodes before use.
struct Periodic {
  Vec3 rotation_center;
  Vec3 rotation_angle_rad;  ///< about x, y, z
  Vec3 translation;
  RigidTransform declared;
};

/// Rotation about the line through `center` along `direction` (any length): own nodes onto the donor's. The three
/// angles are those of the CGNS convention (about x, then y, then z).
Periodic periodic_rotation(Vec3 const& center, Vec3 const& direction, double angle_rad);
Periodic periodic_translation(Vec3 const& translation);

/// GridConnectivity1to1_t: two node ranges that coincide. Most files store each connection twice, once per side.
struct Interface1to1 {
  std::string name;
  std::vector<std::string> families;
  int zone = -1;
  int donor_zone = -1;
  IndexRange range;   ///< own nodes, ascending
  IndexMap to_donor;  ///< own node index -> donor node index; also continues through the face into the donor
  std::optional<Periodic> periodic;
  std::string zone_in_file{};  ///< as that of a patch
};

/// Two lists of nodes that coincide one by one, the donor's after `periodic` where there is one: GridConnectivity_t of
/// elements.
struct Connection {
  std::string name;
  std::vector<std::string> families;
  int zone = -1;
  int donor_zone = -1;
  std::vector<Index32> nodes;        ///< of zone
  std::vector<Index32> donor_nodes;  ///< of donor_zone, as many
  std::optional<Periodic> periodic;
};

/// A part of a mesh of elements that its file names, for regions: a cellZone or a faceZone of OpenFOAM.
struct Subset {
  std::string name;
  std::vector<Index32> elements;  ///< ascending
  CsrGraph faces{};               ///< or corner nodes of faces, inside or on the boundary
};

/// A CGNS Zone_t: a block of nodes (i, j, k), or elements. An SU2 file is one zone of elements.
struct Zone {
  std::string name;  ///< unique in the mesh; "Base/Zone" when the file has several bases
  /// Blocks: nodes along i, j, k, each at least 2 (readers extrude 2-D zones to two planes, but not beside elements).
  /// Elements: 0.
  Index3 extent{0, 0, 0};
  Index first_node = 0;           ///< number of the zone's first node, (0, 0, 0) of a block, in the coordinate arrays
  bool single_precision = false;  ///< the file keeps this zone's coordinates in single precision
  Index n_nodes = 0;              ///< of elements; size() is what both kinds have
  Index first_element = 0, n_elements = 0;  ///< in Mesh::elements; of a block beside elements its cells, i fastest

  [[nodiscard]] bool is_block() const { return extent[0] > 0; }
  /// Number of nodes.
  [[nodiscard]] Index size() const { return is_block() ? Index(extent[0]) * extent[1] * extent[2] : n_nodes; }
  // Blocks:
  [[nodiscard]] Index node(Index3 const& p) const {
    return first_node + p[0] + Index(extent[0]) * (p[1] + Index(extent[1]) * p[2]);
  }
  [[nodiscard]] std::array<Index, 3> strides() const { return {1, Index(extent[0]), Index(extent[0]) * extent[1]}; }
  [[nodiscard]] Index3 index(Index node) const {
    Index const local = node - first_node;
    return {int(local % extent[0]), int((local / extent[0]) % extent[1]), int(local / (Index(extent[0]) * extent[1]))};
  }
};

/// Cells of one zone: cells.begin <= (i, j, k) < cells.end in cell indices (cell i lies between nodes i and i + 1).
struct CellBox {
  int zone = -1;
  IndexRange cells;
};

/// Nodes of one zone: nodes.begin <= (i, j, k) < nodes.end.
struct NodeBox {
  int zone = -1;
  IndexRange nodes;
};

/// Node coordinates of all zones one after another, each component on its own (structure of arrays).
struct Coordinates {
  using View = Kokkos::View<double*, Kokkos::HostSpace>;
  View x, y, z;

  Coordinates() = default;
  explicit Coordinates(Index n_nodes);
  [[nodiscard]] Index size() const { return Index(x.extent(0)); }
  [[nodiscard]] Vec3 operator[](Index n) const { return {x(n), y(n), z(n)}; }
  void set(Index n, Vec3 const& p) {
    x(n) = p.x;
    y(n) = p.y;
    z(n) = p.z;
  }
};

/// The name of the patches on the two node planes that blocks of 2-D meshes are given.
inline constexpr std::string_view plane_patch_name = "2-D plane";

/// A mesh without its cells: zones and their nodes, patches and connections, as rules and messages see them.
struct BoundaryMesh {
  /// The dimension of the cells in the file, 3 or 2. Blocks of a 2-D mesh are extruded by one cell, and writers put
  /// back plane k = 0 only; elements of a 2-D mesh are surfaces.
  int dimension = 3;
  std::vector<Zone> zones;
  std::vector<Patch> patches;             ///< of all zones, in file order
  std::vector<Interface1to1> interfaces;  ///< of blocks, in file order
  std::vector<Connection> connections;    ///< of elements, in file order
  std::vector<std::string> families;      ///< Family_t names
  Coordinates coordinates;                ///< all three components, z = 0 where a file of elements has two
  std::string source;                     ///< file name or what made it, for messages
  int first_number = 1;                   ///< of nodes of elements in messages: 1 in CGNS, 0 in SU2 files
  FileOrder file_order;  ///< set by reorder() and leave_out_unused_nodes(); empty where nothing is to be said

  [[nodiscard]] Index n_nodes() const { return zones.empty() ? 0 : zones.back().first_node + zones.back().size(); }
  /// The zone that holds a node.
  [[nodiscard]] int zone_of(Index node) const;
  /// Diagonal of the bounding box: the size that relative tolerances refer to.
  [[nodiscard]] double size() const;
};

/// A mesh as its file has it.
struct Mesh : BoundaryMesh {
  Elements elements;            ///< of all zones; of a mesh of blocks alone none
  Polyhedra polyhedra;          ///< among them
  std::vector<Subset> subsets;  ///< of elements, in file order; writers leave them to the file
  /// How the file is stored where the file itself does not say so (PLOT3D: "unformatted, little-endian, ..."), for the
  /// writer; empty otherwise.
  std::string file_variant;
  std::vector<std::string> notes;  ///< what the reader skipped or assumed, for `inspect` and logs

  /// Whether all cells are those of blocks. Blocks beside zones of elements have theirs among these.
  [[nodiscard]] bool is_structured() const;
  /// The number of cells of all blocks.
  [[nodiscard]] Index n_cells() const;
  [[nodiscard]] Index n_elements() const { return elements.size(); }
  /// Appends a block and sets its first_node. The coordinates are allocated by the caller afterwards.
  int add_zone(std::string name, Index3 extent);
  /// Appends a zone of elements that begins after all nodes and elements so far.
  int add_zone(std::string name, Index n_nodes);
  /// Appends an element of the last zone.
  void add_element(ElementType type, std::span<Index32 const> nodes);
  /// The zone that holds an element.
  [[nodiscard]] int zone_of_element(Index element) const;
};

/// The name of a node in messages: "zone 'Zone 1' node (i 3, j 1, k 7)", 1-based as users count; of elements "zone
/// 'Fluid' node 17", as the file counts.
std::string describe_node(BoundaryMesh const& mesh, Index node);
/// The name of a range of nodes in messages: "zone 'Zone 1' i_min [1:1, 1:33, 1:9]".
std::string describe_range(BoundaryMesh const& mesh, int zone, IndexRange const& range);
/// The name of a face: "i_min" ... "k_max" for axis 0..2 and side 0 or 1.
std::string_view face_name(int axis, int side);
/// Patch name for messages: "'blade' (BC 'blade_ss', zone 'Zone 1')".
std::string describe_patch(BoundaryMesh const& mesh, Patch const& patch);

}  // namespace gridmorph
