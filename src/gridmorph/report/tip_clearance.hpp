// How far the tips of blades are from the case, before and after, and the walls that clearances are measured to.
#pragma once

#include <gridmorph/geometry/facet_surface.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Distance of tip nodes from a wall, the shortest one. Negative where a node is on the other side of the wall than the
/// mesh is: there it rubs.
struct Clearance {
  double smallest = 0;
  double mean = 0;  ///< over the nodes
  Vec3 at{};        ///< the node of the smallest
};

/// What a distance is the shortest one to: the profile of a wall of revolution, in the meridional plane; or the wall's
/// surface.
enum class ClearanceMeasure { meridional, surface };
std::string name_of(ClearanceMeasure measure);

/// A wall at one time.
class ClearanceWall {
 public:
  virtual ~ClearanceWall() = default;

  [[nodiscard]] virtual ClearanceMeasure measure() const = 0;
  /// The distance of one point from it; signed.
  [[nodiscard]] virtual double distance(Vec3 const& point) const = 0;
  /// Largest distance of the wall's nodes from what is measured to.
  [[nodiscard]] virtual double scatter() const = 0;
  /// Smallest and mean distance of nodes, times `side`: -1 where the mesh is on the side of negative distances.
  [[nodiscard]] Clearance of(std::vector<Vec3> const& nodes, double side = 1) const;
};

/// A wall of revolution.
class RevolutionWall final : public ClearanceWall {
 public:
  /// Null where the nodes are not on a surface of revolution that is a radius over the axial position.
  static std::shared_ptr<RevolutionWall const> through(Axis const& axis, std::vector<Vec3> const& nodes);

  [[nodiscard]] ClearanceMeasure measure() const override { return ClearanceMeasure::meridional; }
  /// Positive towards the axis. Cost: O(log n) in the stations of the wall.
  [[nodiscard]] double distance(Vec3 const& point) const override;
  [[nodiscard]] double scatter() const override { return scatter_; }

 private:
  explicit RevolutionWall(Axis const& axis) : axis_(axis) {}
  bool fit(std::vector<Vec3> const& nodes);
  [[nodiscard]] std::pair<double, double> meridional(Vec3 const& point) const;

  Axis axis_;
  std::vector<std::pair<double, double>> points_;  ///< (axial, radius) of the profile, ascending
  double scatter_ = 0;
};

/// A wall of any shape: the smooth surface through its nodes.
class SurfaceWall final : public ClearanceWall {
 public:
  /// `inward`: facets right-handed about normals into the mesh. Where blades stand on the wall it has holes: `standing`
  /// are their nodes there, of whose rims the tangent planes go on. Throws MotionError where no facet has an area.
  /// Cost: O(n log n) in the facets.
  explicit SurfaceWall(FacetList const& inward, std::vector<Vec3> const& standing = {});

  [[nodiscard]] ClearanceMeasure measure() const override { return ClearanceMeasure::surface; }
  /// Positive on the side of the mesh. Cost: O(log n) near the wall.
  [[nodiscard]] double distance(Vec3 const& point) const override;
  /// The surface goes through the nodes.
  [[nodiscard]] double scatter() const override { return 0; }

 private:
  void find_sides(FacetList const& inward);
  void find_holes(std::vector<Vec3> const& standing);
  [[nodiscard]] bool at_hole(kernels::FacetFoot const& foot) const;

  FacetSurface surface_;
  std::vector<signed char> side_;  ///< per facet: 1 where its normals point into the mesh, -1 where out of it
  std::vector<char> on_blade_;     ///< per point, whether a blade has it; empty: none has
};

/// Numbers, in `blade`, of the nodes within a share of the blade's height of its end towards the wall; all of them for
/// share 1.
std::vector<std::size_t> tip_nodes(ClearanceWall const& wall, std::vector<Vec3> const& blade, double share);

/// One tip.
struct TipClearance {
  std::string name;
  std::size_t nodes = 0;
  Clearance before;
  std::optional<Clearance>
      by_rule;         ///< where the blade's rule alone takes the tip, whether or not the mesh keeps it on the wall
  Clearance after;     ///< in the morphed mesh
  double scatter = 0;  ///< ClearanceWall::scatter(), the larger one of before and after
  ClearanceMeasure measure = ClearanceMeasure::meridional;  ///< of all three
};

/// Of many steps: a line per tip with the smallest clearance of all steps by the rule and in the mesh, and the steps
/// they are in (from 1 on); the largest mean in the mesh beside the smallest. Precondition: every step has the same
/// tips.
std::string clearance_steps_table(std::vector<std::vector<TipClearance>> const& steps);

/// A table with one line per tip, under its header.
std::string clearance_table(std::vector<TipClearance> const& tips);
nlohmann::json clearance_json(std::vector<TipClearance> const& tips);

}  // namespace gridmorph
