// One ffd rule, evaluated: where the nodes of its patches stand in the lattice, and where they go with it.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/point_numbers.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class FfdMotion {
 public:
  /// Finds the box of a rule without one, the nodes inside, and the faces through which the patches run out of the
  /// lattice. Throws MotionError where no node is inside, or where control points move that such a face holds. `name`
  /// begins its messages and notes. Cost O(nodes (degree + 1)^3).
  FfdMotion(Boundary const& boundary, std::vector<int> const& patches, FfdRule const& rule, std::string const& name,
            std::vector<std::string>& notes);
  /// The motion by other displacements of the same control points. Cost O(control points).
  FfdMotion(FfdMotion const& other, FfdRule const& rule, std::string const& name);

  /// Displacement of points, nodes or others; exactly zero outside of the lattice, exactly that of the control points
  /// where they are all displaced alike.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;
  /// Adds share * B_i B_j B_k dJ_du to the control points around a point: the transpose of displacement(). Nothing for
  /// those that are held.
  void add_gradient(Vec3 const& point, Vec3 const& dJ_du, std::span<Vec3> dJ_dd) const;

  [[nodiscard]] FfdLattice const& lattice() const { return ground_->lattice; }
  /// Faces i-min, i-max, j-min, ... through which the patches run out.
  [[nodiscard]] std::array<bool, 6> const& cut() const { return ground_->cut; }
  /// Whether control point n is in a layer that such a face holds.
  [[nodiscard]] bool is_held(int i, int j, int k) const;
  [[nodiscard]] std::size_t size() const { return rule_.displacement.size(); }

 private:
  /// What does not depend on the displacements: the lattice, and where nodes are in it.
  struct Ground {
    FfdLattice lattice;
    std::array<bool, 6> cut{};
    PointNumbers numbers{0};                  ///< nodes of lattices that are no boxes
    std::vector<std::optional<Vec3>> places;  ///< in the lattice, of these nodes
  };
  [[nodiscard]] std::optional<Vec3> place(Vec3 const& point) const;
  void check_held(std::string const& name) const;

  FfdRule rule_;
  std::shared_ptr<Ground const> ground_;
};

/// The name of a face of a lattice: "i-min", "i-max", "j-min", ...
std::string const& ffd_face_name(std::size_t face);

}  // namespace gridmorph
