// Nodes behind periodic boundaries move as one: together they are held on the surfaces of all of them, and where
// periodic sides meet in their axis, on that. Internal to motion.
#pragma once

#include <gridmorph/motion/boundary_conditions.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// Rotations by number, with those that they make one after another; -1 is none.
class RotationNumbers {
 public:
  std::int32_t add(Mat3 const& rotation) {
    rotations_.push_back(rotation);
    return std::int32_t(rotations_.size()) - 1;
  }
  [[nodiscard]] std::int32_t then(std::int32_t first, std::int32_t next);
  [[nodiscard]] std::int32_t back(std::int32_t number);
  /// The least angle of all rotations so far that turn anything; pi where there are none [rad].
  [[nodiscard]] double least_angle() const;
  [[nodiscard]] Mat3 operator[](std::int32_t number) const { return number < 0 ? Mat3() : rotations_[number]; }
  [[nodiscard]] std::vector<Mat3> const& all() const { return rotations_; }

 private:
  std::vector<Mat3> rotations_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> composed_;
  std::map<std::int32_t, std::int32_t> inverse_;
};

/// Nodes that move as one: u(node) = rotation * u(first one).
struct ClassMember {
  Index32 node = -1;
  std::int32_t turned = -1;
};

/// Finds the surfaces that classes of nodes which move as one are held on.
class JointSlipFinder {
 public:
  /// rotations: of the connections; what is a small share of their angles is how far fits of several differ, and turns
  /// nothing. surfaces_of: numbers in `surfaces` of those that a node lies on; size: of the mesh.
  JointSlipFinder(Coordinates const& x, std::vector<SlipSurface> const& surfaces, double size,
                  std::function<std::span<Index32 const>(Index32 node)> surfaces_of, RotationNumbers& rotations)
      : x_(x),
        surfaces_(surfaces),
        size_(size),
        least_turn_(0.05 * rotations.least_angle()),
        surfaces_of_(std::move(surfaces_of)),
        rotations_(rotations) {}

  /// Adds an entry for member k of a class to `to`, unless nothing holds it. around: rotations that ways around
  /// periodic sides lead back to the first member by; what moves has to be the same after them: it goes along their
  /// axis, or stays where there are several.
  void add(std::vector<ClassMember> const& members, std::size_t k, std::span<Mat3 const> around, Index32 of,
           JointSlip& to);

  /// What becomes BoundaryConditions::across_axes.
  [[nodiscard]] std::vector<SlipSurface> across_axes() && { return std::move(across_axes_); }

 private:
  struct Held {
    Index32 surface, place;
    std::int32_t turned;
    Vec3 across;  ///< unit, in the frame of the entry
  };
  [[nodiscard]] Held held(Index32 surface, Index32 node, std::int32_t turned) const;
  [[nodiscard]] bool has_a_way_back(Index32 surface, Index32 node) const;
  [[nodiscard]] Index32 across(Vec3 const& direction);

  Coordinates const& x_;
  std::vector<SlipSurface> const& surfaces_;
  double size_, least_turn_;
  std::function<std::span<Index32 const>(Index32 node)> surfaces_of_;
  RotationNumbers& rotations_;
  std::vector<SlipSurface> across_axes_;
};

}  // namespace gridmorph::detail
