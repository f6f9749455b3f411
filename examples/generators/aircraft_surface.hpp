// Where the nodes of the generated aircraft's surface are, one for each node of the lattice on what is left out of it.
// Internal to it.
#pragma once

#include <generators/aircraft_lattice.hpp>

#include <unordered_map>
#include <vector>

namespace gridmorph::aircraft {

/// A face of a cell left out, towards a cell that is not.
struct WallFace {
  Part part;
  Index3 cell;
  int axis, side;    ///< towards i_min: 0 and 0, towards k_max: 2 and 1
  IndexRange nodes;  ///< of the lattice
};

/// All of them, cells in the order of their numbers.
std::vector<WallFace> wall_faces(Lattice const& lattice);

/// Nodes of the surface by the numbers of the lattice's nodes. Lines from one to the other are straight.
class Surface {
 public:
  Surface(Lattice const& lattice, std::vector<WallFace> const& faces, double first_cell);

  [[nodiscard]] int size() const { return int(on_body_.size()); }
  [[nodiscard]] int number(Index lattice_node) const { return number_.at(lattice_node); }
  /// layer: 0 on the body, Lattice::layers on the lattice.
  [[nodiscard]] Vec3 position(int number, int layer) const;

 private:
  std::unordered_map<Index, int> number_;
  std::vector<Vec3> on_body_, on_lattice_;
  std::vector<double> share_;
  int layers_;
};

}  // namespace gridmorph::aircraft
