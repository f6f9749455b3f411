// Cell quality of structured meshes, baseline against morphed, near and far field apart.
//
// Formulas are written beside the device functions in gridmorph/kernels/cell_quality.hpp, and what the statistics mean
// in docs/quality.md. Results are bit-identical for Serial and for OpenMP with any number of threads: extremes take the
// first cell in mesh order, sums are made in chunks of fixed size and added in mesh order.
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <Kokkos_Core.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Which measures are reported; the order is that of QualityRegion::measure.
enum class Measure {
  aspect_ratio,        ///< longest edge / shortest edge of the cell
  determinant_2x2x2,   ///< smallest / largest Jacobian determinant over the 8 corners
  determinant_3x3x3,   ///< the same over 27 points
  minimum_angle_deg,   ///< smallest angle between adjacent edges of the six faces
  equiangle_skewness,  ///< max((amax - 90)/90, (90 - amin)/90)
  volume,
  volume_ratio,           ///< largest volume ratio (>= 1) to a face neighbour, across 1-to-1 interfaces too
  relative_displacement,  ///< paper, section 3.2: largest relative displacement / mean edge length, worst direction
  non_orthogonality_deg,  ///< elements, on request: largest angle between face normals and lines between centres
  face_skewness,  ///< elements, on request: largest distance of face centres from these lines / size of the face
  relative_displacement_i,  ///< blocks: relative_displacement along each index direction of the zone by itself
  relative_displacement_j,
  relative_displacement_k,
  growth_ratio,  ///< blocks: largest ratio (>= 1) of neighbouring edges along a grid line, across 1-to-1 interfaces too
  face_area_ratio,  ///< blocks: largest ratio (>= 1) of the areas of faces that continue one another from cell to cell
  count
};

inline constexpr std::size_t n_measures = std::size_t(Measure::count);

/// "aspect_ratio", ...: names in JSON files.
std::string_view to_string(Measure measure);

/// Whether the worst cell is the one with the largest value (aspect ratio, skewness, ratios) or with the smallest one.
KOKKOS_INLINE_FUNCTION constexpr bool larger_is_worse(Measure m) {
  return m != Measure::determinant_2x2x2 && m != Measure::determinant_3x3x3 && m != Measure::minimum_angle_deg &&
         m != Measure::volume;
}

/// Statistics of one measure over one region.
struct MeasureStatistics {
  double min = 0, mean = 0, max = 0;
  /// The cell with the worst value (largest aspect ratio, smallest determinant, ...): zone and 0-based i, j, k.
  int worst_zone = -1;
  Index3 worst_cell{0, 0, 0};
  double worst = 0;
};

/// What a cell must not fall short of by a morph, [guard] of case files. A cell that was short of a limit in the
/// baseline is no shortfall of the morph, unless it lost more than max_loss.
struct CellLimits {
  double min_determinant = 0.05;  ///< smallest 3x3x3 determinant
  double min_angle_deg = 2;       ///< smallest angle
  double max_skewness = 0.98;     ///< largest equiangle skewness
  /// Largest loss, (before - after) / max(|before|, floor), of determinant 3x3x3 (floor 0.05) and of smallest angle
  /// (floor 1 degree): the floors keep small values that change by little from counting.
  double max_loss = 0.9;
};

/// Ways in which cells can come out of a morph as they should not.
enum class Fall {
  inverted,     ///< a corner's Jacobian is negative that was not, or zero that was positive; value: it / the largest
                ///< before
  determinant,  ///< below min_determinant; value: the 3x3x3 determinant
  angle,        ///< below min_angle_deg; value: the angle
  skewness,     ///< above max_skewness; value: the skewness
  loss,         ///< not inverted, but above max_loss; value: the loss
  collapsed,    ///< an edge has no length that had one; no value
  flat_before,  ///< no shortfall: no volume in the baseline, and little of the wrong sign now (kernels/flat_cells.hpp);
                ///< value: the scaled Jacobian
  count
};

/// "inverted", ...: names in JSON files.
std::string_view to_string(Fall fall);

inline constexpr std::size_t n_falls = std::size_t(Fall::count);

/// The cells that fell in one way, and the worst of them.
struct FallenCells {
  Index cells = 0;
  int worst_zone = -1;
  Index3 worst_cell{0, 0, 0};
  Index number = -1;  ///< of the worst cell in the mesh (first_cells()), or of the element
  double worst = 0;
};

struct QualityRegion {
  Index cells = 0;
  Index inverted =
      0;  ///< smallest of the 8 corner determinants (with the zone's handedness) negative, but for Fall::flat_before
  Index newly_inverted = 0;  ///< Fall::inverted: those that lost their volume by the morph (0 for the baseline itself)
  Index flat = 0;  ///< smallest of the 8 corner determinants zero, as far as coordinates can tell, or Fall::flat_before
  Index collapsed = 0;  ///< cells with an edge of length zero (poles, wedges)
  std::array<MeasureStatistics, n_measures> measure{};
  std::array<FallenCells, n_falls> fallen{};  ///< against the baseline

  [[nodiscard]] MeasureStatistics const& operator[](Measure m) const { return measure[std::size_t(m)]; }
  [[nodiscard]] FallenCells const& operator[](Fall f) const { return fallen[std::size_t(f)]; }
};

/// Along index direction 0, 1 or 2 (i, j, k).
KOKKOS_INLINE_FUNCTION constexpr Measure relative_displacement_along(int direction) {
  return Measure(int(Measure::relative_displacement_i) + direction);
}

/// Cells that an engineer knows by a name: a wake, a refinement.
struct NamedRegion {
  std::string name;
  QualityRegion quality;
};

/// A node of the mesh for messages: zone and 0-based i, j, k.
struct NodeLocation {
  int zone = -1;
  Index3 node{0, 0, 0};
};

/// First cell height and angle between wall-leaving grid line and wall normal, over the nodes of the walls.
struct WallQuality {
  Index nodes = 0;
  double first_height_min = 0, first_height_mean = 0, first_height_max = 0;
  double orthogonality_deg_mean = 0, orthogonality_deg_max = 0;
  NodeLocation orthogonality_worst;
  /// Against the baseline (zero for the baseline itself).
  double height_change_max = 0;  ///< largest |h / h_baseline - 1|
  NodeLocation height_change_worst;
  double orthogonality_change_deg_max = 0;
  NodeLocation orthogonality_change_worst;
};

/// The walls that an engineer knows by one name: a family or, without one, a BC name.
struct WallGroup {
  std::string name;
  WallQuality quality;
};

/// Cells by the sign of their Jacobian, taken everywhere in them (kernels/jacobian_bounds.hpp).
struct Certificate {
  Index cells = 0;  ///< that were looked at
  Index zero =
      0;  ///< negative nowhere, but somewhere zero, as far as coordinates can tell: collapsed, flat; or flat_before
  Index flat_before = 0;  ///< negative somewhere by little, and without volume in the baseline: as Fall::flat_before
  Index negative = 0;     ///< somewhere inside out, or with a corner that is no number
  Index undecided = 0;    ///< too close to zero to tell; none in any mesh so far
  /// Of those that are negative or undecided: those that were neither in the baseline (all without one), and the first
  /// of them in mesh order; FallenCells::worst has no value.
  FallenCells broken;

  [[nodiscard]] bool holds() const { return broken.cells == 0; }
};

struct QualityReport {
  QualityRegion near_field, far_field;
  std::vector<NamedRegion> regions;     ///< QualityInput::regions once more by themselves; not where `fast`
  WallQuality wall;                     ///< all walls together
  std::vector<WallGroup> wall_groups;   ///< the same walls by group, in the order of QualityInput::walls
  std::vector<std::string> zone_names;  ///< for messages: MeasureStatistics::worst_zone is a number in it
  int left_handed_zones = 0;
  bool against_baseline = false;  ///< relative displacement and changes at walls were measured
  /// A verdict: only the numbers of cells, what fell, and smallest determinant and angle (without mean) were measured.
  bool fast = false;
  /// Cells are elements: worst_cell[0] and NodeLocation::node[0] are one less than the number in the file, the rest is
  /// 0.
  bool unstructured = false;
  std::optional<Certificate> certificate;  ///< where somebody asked for one

  [[nodiscard]] Index cells() const { return near_field.cells + far_field.cells; }
};

/// Node coordinates to read, one View per component, numbered as in Mesh (Zone::first_node). Converts from
/// Coordinates on the host and from any three Views in MemorySpace.
template <class MemorySpace>
struct CoordinateViews {
  Kokkos::View<double const*, MemorySpace> x, y, z;  ///< (n_nodes) [length]
};

/// Coordinates of the mesh itself.
inline CoordinateViews<Kokkos::HostSpace> views(Coordinates const& c) { return {c.x, c.y, c.z}; }

/// One wall for WallQuality: a patch range on one face of a zone; the wall is at node index 0 (side 0) or at the last
/// one (side 1) along axis.
struct WallFace {
  int zone = -1;
  IndexRange range;
  int axis = 0;
  int side = 0;
  std::string group = {};  ///< WallGroup::name it counts for
};

/// Faces of the given patches (numbers in Mesh::patches). Patches that lie on no zone face or are no wider than one
/// node have no surface normal and are left out. They are grouped by the first family of a patch, or its BC name
/// without one.
std::vector<WallFace> wall_faces(Mesh const& mesh, std::span<int const> patches);

/// Number of the first cell of each zone, and of all cells at the end: cells are numbered zone after zone, i fastest.
/// Masks and fields per cell are numbered this way.
std::vector<Index> first_cells(Mesh const& mesh);

/// Values in single cells, written on the way: (n_cells) for each measure that is wanted, empty Views for the others.
/// The relative displacement is left alone where there is no baseline.
template <class MemorySpace>
struct CellFields {
  Kokkos::View<double*, MemorySpace> of[n_measures];

  [[nodiscard]] Kokkos::View<double*, MemorySpace>& operator[](Measure m) { return of[int(m)]; }
};

/// Cells to be measured by themselves as well, wherever they lie in near and far field. Boxes of one region do not
/// overlap.
struct NamedCells {
  std::string name;
  std::vector<CellBox> boxes;
};

/// What is measured.
template <class MemorySpace>
struct QualityInput {
  CoordinateViews<MemorySpace> coordinates;
  /// The mesh before morphing; left empty, `coordinates` are the baseline.
  CoordinateViews<MemorySpace> baseline;
  /// (n_cells), nonzero: near field. Left empty, every cell is in the far field.
  Kokkos::View<std::uint8_t const*, MemorySpace> near_field;
  std::vector<WallFace> walls;
  CellLimits limits = {};            ///< what cells are judged by against the baseline
  bool fast = false;                 ///< only a verdict: a third of the time and no memory per cell; no fields
  std::vector<int> handedness = {};  ///< zone_handedness() of the baseline; left empty, it is found again
  CellFields<MemorySpace> fields = {};
  std::vector<NamedCells> regions = {};  ///< not looked at where `fast`
};

/// +1 or -1 per zone: the sign that makes most corner Jacobians of a zone positive. Left-handed zones are valid CGNS;
/// decide from the baseline, so that a zone that morphing turned inside out does not pass as left-handed.
/// Returns numbers, so it fences.
template <BuiltFor Exec>
std::vector<int> zone_handedness(Exec const& exec, Mesh const& mesh,
                                 CoordinateViews<typename Exec::memory_space> const& baseline);

/// Measures every cell and the walls. Returns numbers, so it fences. Cells that may have fallen short of the limits are
/// compared with their baseline one by one; the rest of the baseline is read for relative displacements and walls only.
///
/// Throws MeshError when Views are shorter than the mesh, or a wall or interface lies outside its zone.
/// Memory: 8 bytes per cell for volumes (that field, where it is wanted), below 2 bytes per cell for partial sums, 48
/// bytes per node of the walls. Cost: one pass over the cells (about 1000 flops each, as many cells at once as the
/// registers hold), one over the volumes, one each for growth and face area ratios (500 flops and 48 comparisons
/// together); of regions once more.
template <BuiltFor Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh,
                              QualityInput<typename Exec::memory_space> const& input);

/// Values of the given measures in every cell, (n_cells) each, in the order asked for, and nothing else:
/// measure_quality() with fields.
template <BuiltFor Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input,
    std::span<Measure const> measures);

/// A value and the cell it was found in; zone -1 when there was no cell to look at.
struct CellValue {
  double value = 1;
  int zone = -1;
  Index3 cell{0, 0, 0};
};

/// The smallest 3x3x3 determinant over the boxes (the first one in the order of the boxes if several are equal), as the
/// report after each stage needs it. `handedness`: zone_handedness of the baseline. Fences. Throws MeshError for boxes
/// outside their zone.
template <BuiltFor Exec>
CellValue min_determinant(Exec const& exec, Mesh const& mesh,
                          CoordinateViews<typename Exec::memory_space> const& coordinates,
                          std::span<int const> handedness, std::span<CellBox const> boxes);

/// "zone 'Zone 1' cell (i 3, j 1, k 7)", 1-based as users count.
std::string describe_cell(std::string_view zone_name, Index3 const& cell);

}  // namespace gridmorph
