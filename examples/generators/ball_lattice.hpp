// The graded lattice around the tube and the crane. Internal to the ball demo; lengths as in ball_counts.hpp.
#pragma once

#include <generators/ball_tube.hpp>

#include <array>
#include <vector>

namespace gridmorph::demo {

class BallLattice {
 public:
  /// first_node: number of the first node of the lattice.
  BallLattice(BallOptions const& options, BallCounts const& counts, BallTube const& tube, Index32 first_node);

  [[nodiscard]] Index32 n_nodes() const { return n_nodes_; }
  /// Number of the node at these lattice lines of the tube's sides.
  [[nodiscard]] Index32 at_tube(int ix, int iy, int iz) const {
    return node(tube_[0].begin + ix, tube_[1].begin + iy, tube_[2].begin + iz);
  }
  /// Of the nodes that a cell has, in order of their numbers.
  [[nodiscard]] std::vector<Vec3> nodes() const;
  /// All cells outside tube and crane, the faces on the crane, and those on the box as patches of their own.
  void add_to(HybridMesh& mesh, BallPatches const& patches) const;

 private:
  struct Range {
    int begin = 0, end = 0;
    [[nodiscard]] bool holds(int i) const { return i >= begin && i < end; }
  };
  using Box = std::array<Range, 3>;
  enum class Cell { fluid, tube, crane, outside };

  [[nodiscard]] Cell cell(int i, int j, int k) const;
  [[nodiscard]] int n(int axis) const { return int(lines_[std::size_t(axis)].size()) - 1; }
  [[nodiscard]] std::size_t place(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(n(0) + 1) * (std::size_t(j) + std::size_t(n(1) + 1) * std::size_t(k));
  }
  [[nodiscard]] Index32 node(int i, int j, int k) const { return number_[place(i, j, k)]; }
  [[nodiscard]] Hex corners(int i, int j, int k) const;
  template <class Function>
  void each_fluid_cell(Function const& function) const;

  std::array<std::vector<double>, 3> lines_;
  Box tube_, jib_, mast_;
  std::vector<Index32> number_;  ///< of the node at each place; -1: none
  Index32 n_nodes_ = 0;
};

}  // namespace gridmorph::demo
