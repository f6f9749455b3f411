// Displacement at arbitrary positions from the nodes of a file: exact on them, mapped from the elements of the model
// where it has them, and a local interpolation between points otherwise.
#pragma once

#include <gridmorph/mapping/point_cloud.hpp>
#include <gridmorph/mapping/stencil.hpp>
#include <gridmorph/mapping/structural_model.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// How far the positions asked for were from the model, over all evaluations so far (each position once where stencils
/// are kept).
struct MappingDistance {
  std::int64_t evaluated = 0;
  std::int64_t coincident = 0;    ///< took the displacement of a node as it stands in the file
  double max = 0, mean = 0;       ///< distance to the nearest point, or to the elements [length]
  Vec3 farthest;                  ///< where max was found
  std::int64_t extrapolated = 0;  ///< beyond the edge of the model
  double max_beyond = 0;          ///< largest distance from that edge [length]
  Vec3 farthest_beyond;           ///< where max_beyond was found
  std::int64_t far_beyond = 0;    ///< beyond it by more than two spacings of the points, or two elements, there
  std::int64_t far_off = 0;       ///< farther than two spacings from the nearest point
  double patches_size =
      0;  ///< diagonal of the patches that take their displacement from the field, by expect(); 0: not known
};

/// How far models may lie from the patches that take their displacement from them, where FieldOptions::max_distance
/// says nothing.
struct MappingLimits {
  static constexpr double distance = 0.05;    ///< share of the patches' size
  static constexpr double far_beyond = 0.05;  ///< share of the nodes that lie beyond the edge by more than two spacings
  static constexpr double notable = 0.01;     ///< distances above this share are a warning
  /// The share of nodes that coincide with points from which on the file is a table of the mesh's own nodes: those that
  /// are far from any point count as if they were beyond the edge. On thin blades, rows of one side alone leave the
  /// other side without an edge between.
  static constexpr double own_nodes = 0.2;
  static constexpr double whole_parts =
      0.25;  ///< and that share of its other nodes: a table that is thinned leaves few so far
};

/// Nodes that are where the model says nothing, MappingLimits::far_beyond of which are too many.
[[nodiscard]] std::int64_t left_out(MappingDistance const& mapping);
/// Whether the points are nodes of the mesh itself, and whole parts of it have none.
[[nodiscard]] bool lacks_own_nodes(MappingDistance const& mapping);

/// Leave-one-out: the displacement of nodes of the model, interpolated from the others, against their own. Neighbours
/// are twice as far apart as between nodes, so that on smooth fields this is about four times the error of the mapping.
struct MappingError {
  std::int64_t tried = 0;   ///< nodes; a sample of large models
  double max = 0, rms = 0;  ///< share of the largest displacement of the field
  std::size_t worst = 0;    ///< node number of max
};

/// Options of a field; lengths in units of the mesh.
struct FieldOptions {
  double length_scale = 1;  ///< multiplies positions and displacements: 1e-3 for a file in mm and a mesh in m
  double factor = 1;        ///< multiplies displacements: the amplitude of a mode shape
  double max_distance = 0;  ///< a position farther than this from every point or element is an error; 0: no limit
  Extrapolation extrapolation = Extrapolation::linear;
  double max_extrapolation = -1;  ///< a position farther than this beyond the edge is an error; negative: no limit
  bool turn_offset = true;        ///< elements: the offset from their surface turns with them
  bool keep = false;  ///< keep the stencil of every position, for evaluation of the same ones again and again
};

/// One or more displacement fields on the nodes of one model. A position within coincidence() of a node takes that
/// node's displacement, bit for bit; else FacetMap maps it where the model has elements, and PointMap where it has
/// none. Evaluations may come from several threads.
class PointField {
 public:
  /// Throws ConfigError when two lines give one point different displacements (more than 1e-6 of the largest), when
  /// points or displacements are not finite, or when elements have no area. Points given twice alike are kept once.
  PointField(PointCloud cloud, FieldOptions const& options);
  /// `further`: (fields)(nodes), more displacement fields on the nodes of the model, in units of the file.
  PointField(StructuralModel model, FieldOptions const& options, std::vector<std::vector<Vec3>> further = {});
  ~PointField();
  PointField(PointField&&) noexcept;
  PointField& operator=(PointField&&) noexcept;

  /// Fills displacement[n] for points[n] from the first field. Throws MotionError beyond FieldOptions::max_distance and
  /// max_extrapolation, naming the position.
  void operator()(std::span<Vec3 const> points, std::span<Vec3> displacement) const;
  /// Fills displacement[n] for points[n] from the sum of factors[f] * field f; fields whose factor is zero do not count
  /// at all. `iterates`: the points are no nodes but on the way to some; they are neither kept nor counted in
  /// mapping().
  void evaluate(std::span<double const> factors, std::span<Vec3 const> points, std::span<Vec3> displacement,
                bool iterates = false) const;
  /// Fills displacement[n] for points that are no nodes, each by the element or the points that its anchor, a place
  /// nearby, is mapped from.
  void held(std::span<double const> factors, std::span<Vec3 const> points, std::span<Vec3 const> anchors,
            std::span<Vec3> displacement) const;

  [[nodiscard]] std::size_t size() const;        ///< nodes kept
  [[nodiscard]] std::size_t n_elements() const;  ///< 0: a cloud of points
  [[nodiscard]] std::size_t n_fields() const;
  [[nodiscard]] double coincidence() const;  ///< 1e-7 of the size of the cloud or of its largest coordinate
  [[nodiscard]] std::string const& source() const;
  [[nodiscard]] std::string where(std::size_t node) const;  ///< "blade.csv:14"
  [[nodiscard]] std::vector<std::string> const& notes() const;
  [[nodiscard]] MappingDistance mapping() const;
  /// Says which nodes will ask for their displacement: throws MotionError where the model lies elsewhere
  /// (MappingLimits), before any search of theirs takes its time. `slack`: so much farther they may be [length]. Looks
  /// at 4000 of them, evenly; judge() knows all.
  void expect(std::span<Vec3 const> nodes, double slack = 0) const;
  /// Throws as expect() does, by all positions that were evaluated. Nothing where that was not called.
  void judge() const;
  [[nodiscard]] double largest_displacement() const;
  [[nodiscard]] bool has_max_distance() const;
  /// The error by leave-one-out of the worst of the fields. Cost O(m log n) for a sample of m <= 2000 nodes.
  [[nodiscard]] MappingError leave_one_out() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gridmorph
