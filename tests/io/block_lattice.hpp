// Meshes for tests of files: a curved brick cut into a lattice of blocks, each in a random orientation, with every
// contact between blocks as a pair of 1-to-1 interfaces. Where nodes coincide is known from the lattice, not from the
// code under test.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace gridmorph::test {

/// One of the 48 signed permutations of three axes.
inline Orientation random_orientation(std::mt19937& random, bool keep_k = false) {
  Orientation o;
  std::shuffle(o.axis.begin(), o.axis.begin() + (keep_k ? 2 : 3), random);
  for (int a = 0; a < (keep_k ? 2 : 3); ++a) o.sign[a] = random() % 2 == 0 ? 1 : -1;
  return o;
}

struct Lattice {
  std::array<std::vector<int>, 3> cuts;  ///< global node numbers of the block limits, first and last included
  bool two_dimensional = false;
  bool single_precision = false;
  /// The brick closes on itself along x: the first and last planes become rotational periodics about z.
  bool periodic = false;
};

class LatticeBuilder {
 public:
  LatticeBuilder(Lattice lattice, unsigned seed) : lattice_(std::move(lattice)), random_(seed) {}

  Mesh build() {
    mesh_.source = "lattice";
    mesh_.dimension = lattice_.two_dimensional ? 2 : 3;
    for_each_block([&](Index3 const& b) { add_block(b); });
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    for (std::size_t z = 0; z < blocks_.size(); ++z) place_nodes(int(z));
    for_each_block([&](Index3 const& b) {
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) add_face(b, axis, side);
    });
    return mesh_;
  }

  /// The curved brick: an annulus piece of angle `angle` when periodic, a wavy brick otherwise.
  Vec3 position(Index3 const& g) const {
    double const s = double(g[0]) / lattice_.cuts[0].back(), t = double(g[1]) / lattice_.cuts[1].back();
    double const u = lattice_.two_dimensional ? 0.0 : double(g[2]) / lattice_.cuts[2].back();
    if (lattice_.periodic) {
      double const r = 1 + t + 0.05 * std::sin(3 * u), theta = angle * s + 0.1 * t;
      return round({r * std::cos(theta), r * std::sin(theta), 2 * u});
    }
    return round({2 * s + 0.1 * std::sin(2 * t), t + 0.1 * s * s, lattice_.two_dimensional ? 0.0 : u + 0.05 * s * t});
  }
  static constexpr double angle = 0.3;

 private:
  struct Block {
    Index3 lattice;
    IndexMap to_global;  ///< own node -> global node
  };

  Vec3 round(Vec3 const& p) const {
    if (!lattice_.single_precision) return p;
    return {double(float(p.x)), double(float(p.y)), double(float(p.z))};
  }

  template <class F>
  void for_each_block(F f) const {
    for (int k = 0; k + 1 < int(lattice_.cuts[2].size()); ++k)
      for (int j = 0; j + 1 < int(lattice_.cuts[1].size()); ++j)
        for (int i = 0; i + 1 < int(lattice_.cuts[0].size()); ++i) f(Index3{i, j, k});
  }

  int number(Index3 const& b) const {
    int const ni = int(lattice_.cuts[0].size()) - 1, nj = int(lattice_.cuts[1].size()) - 1;
    return b[0] + ni * (b[1] + nj * b[2]);
  }

  void add_block(Index3 const& b) {
    Block block{b, {random_orientation(random_, lattice_.two_dimensional), {0, 0, 0}, {0, 0, 0}}};
    auto const& o = block.to_global.orientation;
    Index3 extent{};
    for (int a = 0; a < 3; ++a) {
      int const g = o.axis[a];
      int const low = lattice_.cuts[g][b[g]], high = lattice_.cuts[g][b[g] + 1];
      extent[a] = high - low + 1;
      block.to_global.donor_origin[g] = o.sign[a] > 0 ? low : high;
    }
    int const z = mesh_.add_zone("Zone " + std::to_string(number(b) + 1), extent);
    mesh_.zones[z].single_precision = lattice_.single_precision;
    blocks_.push_back(block);
  }

  void place_nodes(int z) {
    auto const& zone = mesh_.zones[z];
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          Index3 const own{i, j, k};
          Vec3 p = position(blocks_[z].to_global(own));
          if (lattice_.two_dimensional) p.z = k;
          mesh_.coordinates.set(zone.node(own), p);
        }
  }

  /// Global node range of one side of a block.
  IndexRange side_range(Index3 const& b, int axis, int side) const {
    IndexRange r;
    for (int g = 0; g < 3; ++g) {
      r.begin[g] = lattice_.cuts[g][b[g]];
      r.end[g] = lattice_.cuts[g][b[g] + 1] + 1;
    }
    r.begin[axis] = lattice_.cuts[axis][b[axis] + side];
    r.end[axis] = r.begin[axis] + 1;
    return r;
  }

  void add_face(Index3 const& b, int axis, int side) {
    int const z = number(b);
    IndexMap const from_global = blocks_[z].to_global.inverse();
    IndexRange const global = side_range(b, axis, side);
    IndexRange const range = from_global(global);
    Index3 other = b;
    other[axis] += side == 0 ? -1 : 1;
    int const count = int(lattice_.cuts[axis].size()) - 1;
    bool const wraps = lattice_.periodic && axis == 0 && (other[0] < 0 || other[0] >= count);
    std::string const name = std::string("xyz").substr(axis, 1) + (side == 0 ? "_low" : "_high");
    if (!wraps && (other[axis] < 0 || other[axis] >= count)) {
      if (lattice_.two_dimensional && axis == 2) {
        mesh_.patches.push_back({"2-D plane", "BCSymmetryPlane", PatchKind::symmetry, {}, z, range});
      } else {
        bool const wall = axis == 1;
        mesh_.patches.push_back(
            {name, wall ? "BCWallViscous" : "BCFarfield", wall ? PatchKind::wall : PatchKind::farfield,
             wall ? std::vector<std::string>{"Walls", name + " wall"} : std::vector<std::string>{}, z, range});
      }
      return;
    }
    Interface1to1 face;
    face.name = "to " + name;
    face.zone = z;
    face.range = range;
    IndexMap shift;  // along the brick once round
    if (wraps) {
      other[0] = side == 0 ? count - 1 : 0;
      shift.donor_origin[0] = (side == 0 ? 1 : -1) * lattice_.cuts[0].back();
      double const turn = side == 0 ? angle : -angle;
      face.periodic = Periodic{{0, 0, 0}, {0, 0, turn}, {0, 0, 0}, rotation_about({0, 0, 0}, {0, 0, 1}, turn)};
    }
    face.donor_zone = number(other);
    IndexMap const whole = blocks_[z].to_global.then(shift).then(blocks_[face.donor_zone].to_global.inverse());
    face.to_donor = {whole.orientation, range.begin, whole(range.begin)};
    mesh_.interfaces.push_back(face);
  }

  Lattice lattice_;
  std::mt19937 random_;
  Mesh mesh_;
  std::vector<Block> blocks_;
};

}  // namespace gridmorph::test
