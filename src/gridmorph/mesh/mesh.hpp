// A multi-block structured mesh as it stands in a file: zones, boundary patches, 1-to-1 interfaces, coordinates.
//
// Nothing here is cut or interpreted; that is the topology's work. Readers fill a Mesh, writers take one, generators
// make one, and solvers can build one from their own arrays without touching files.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <Kokkos_Core.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

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
  periodic  ///< one side of a periodic pair whose two sides move independently (passages of a wheel); never from a file
};

/// "wall", "inflow", ... as used by `type:` selectors and in messages. Periodic interfaces are "periodic".
std::string_view to_string(PatchKind kind);

/// One boundary range on one face of one zone.
struct Patch {
  std::string name;     ///< BC_t or GridConnectivity_t node name
  std::string bc_type;  ///< CGNS BCType_t name as in the file, resolved through the family if FamilySpecified
  PatchKind kind = PatchKind::other;
  std::vector<std::string> families;  ///< FamilyName_t first, then AdditionalFamilyName_t; may be empty
  int zone = -1;                      ///< number in Mesh::zones
  IndexRange range;                   ///< nodes; extent 1 along exactly one axis (the face normal)
};

/// Periodicity as declared in the file (CGNS SIDS Periodic_t). `declared` maps this side's nodes onto the donor's nodes.
/// Files carry the angle in single precision: fit the transform to the matched nodes before use.
struct Periodic {
  Vec3 rotation_center;
  Vec3 rotation_angle_rad;  ///< about x, y, z
  Vec3 translation;
  RigidTransform declared;
};

/// Rotation about the line through `center` along `direction` (any length): own nodes onto the donor's. The three angles are those
/// of the CGNS convention (about x, then y, then z).
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
};

/// A CGNS Zone_t.
struct Zone {
  std::string name;        ///< unique in the mesh; "Base/Zone" when the file has several bases
  Index3 extent{0, 0, 0};  ///< nodes along i, j, k; each at least 2 (2-D zones are extruded to two planes by readers)
  Index first_node = 0;    ///< number of node (0, 0, 0) in the flat coordinate arrays
  bool single_precision = false;  ///< the file keeps this zone's coordinates in single precision

  [[nodiscard]] Index size() const { return Index(extent[0]) * extent[1] * extent[2]; }
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

struct Mesh {
  std::vector<Zone> zones;
  std::vector<Patch> patches;             ///< of all zones, in file order
  std::vector<Interface1to1> interfaces;  ///< of all zones, in file order
  std::vector<std::string> families;      ///< Family_t names
  Coordinates coordinates;
  std::string source;  ///< file name or what made it, for messages
  /// How the file is stored where the file itself does not say so (PLOT3D: "unformatted, little-endian, ..."), for the writer;
  /// empty otherwise.
  std::string file_variant;
  std::vector<std::string> notes;  ///< what the reader skipped or assumed, for `inspect` and logs
  /// A 2-D mesh that the reader extruded by one cell; writers put back plane k = 0 only.
  bool two_dimensional = false;

  [[nodiscard]] Index n_nodes() const { return zones.empty() ? 0 : zones.back().first_node + zones.back().size(); }
  [[nodiscard]] Index n_cells() const;
  /// Appends a zone and sets its first_node. The coordinates are allocated by the caller afterwards.
  int add_zone(std::string name, Index3 extent);
  /// Zone that holds a flat node number.
  [[nodiscard]] int zone_of(Index node) const;
  /// Diagonal of the bounding box: the size that relative tolerances refer to.
  [[nodiscard]] double size() const;
};

/// "zone 'Zone 1' node (i 3, j 1, k 7)", 1-based as users count.
std::string describe_node(Mesh const& mesh, Index node);
/// "zone 'Zone 1' i_min [1:1, 1:33, 1:9]".
std::string describe_range(Mesh const& mesh, int zone, IndexRange const& range);
/// "i_min" ... "k_max" for axis 0..2 and side 0 or 1.
std::string_view face_name(int axis, int side);
/// Patch name for messages: "'blade' (BC 'blade_ss', zone 'Zone 1')".
std::string describe_patch(Mesh const& mesh, Patch const& patch);

}  // namespace gridmorph
