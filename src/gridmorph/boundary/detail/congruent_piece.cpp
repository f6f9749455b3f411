#include <gridmorph/boundary/detail/periodic_faces.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gridmorph::topology {

bool congruent(CellShape const& p, CellShape const& q, Turn turn, double relative) {
  double const tolerance = 2 * corner_tolerance(p, q, relative);
  for (int c = 0; c < 4; ++c)
    for (int d = c + 1; d < 4; ++d)
      if (std::fabs(distance(p.corner[c], p.corner[d]) - distance(q.corner[turn.image(c)], q.corner[turn.image(d)])) >
          tolerance)
        return false;
  return true;
}

namespace {

/// Where cells go when one goes on another: (a, b) -> matrix (a, b) + shift, in nodes.
struct FaceMap {
  std::array<std::array<int, 2>, 2> column;  ///< images of the steps along u and v
  std::array<int, 2> shift;

  FaceMap(int a, int b, int other_a, int other_b, Turn turn) {
    auto const& at = corner_offset;
    for (int x = 0; x < 2; ++x) {
      int const origin = at[turn.image(0)][x];
      column[0][x] = at[turn.image(1)][x] - origin;
      column[1][x] = at[turn.image(3)][x] - origin;
      shift[x] = (x == 0 ? other_a : other_b) + origin - column[0][x] * a - column[1][x] * b;
    }
  }
  [[nodiscard]] std::array<int, 2> node(int p, int q) const {
    return {column[0][0] * p + column[1][0] * q + shift[0], column[0][1] * p + column[1][1] * q + shift[1]};
  }
  /// The cell that cell (a, b) goes on.
  [[nodiscard]] std::array<int, 2> cell(int a, int b) const {
    auto const low = node(a, b), high = node(a + 1, b + 1);
    return {std::min(low[0], high[0]), std::min(low[1], high[1])};
  }
};

/// The largest congruent piece around a pair of seeds, grown along u, then v.
class Grower {
 public:
  Grower(SurfaceCells const& cells, Seed const& p, Seed const& q, Turn turn, double relative, Index& budget)
      : cells_(cells),
        own_(cells.faces()[p.face]),
        other_(cells.faces()[q.face]),
        map_(p.a, p.b, q.a, q.b, turn),
        turn_(turn),
        relative_(relative),
        budget_(budget),
        low_{p.a, p.b},
        high_{p.a + 1, p.b + 1} {}

  std::optional<RigidTransform> fit() {
    for (int axis = 0; axis < 2; ++axis)
      for (int side = 0; side < 2; ++side)
        while (extend(axis, side)) {
        }
    // Congruent cell by cell is not yet congruent: less of it may be.
    for (int attempt = 0; attempt < 4; ++attempt) {
      if (auto const t = fit_all()) return t;
      for (int x = 0; x < 2; ++x) {
        bool const forward = seed_is_low(x);
        int const half = std::max((high_[x] - low_[x]) / 2, 1);
        (forward ? high_[x] : low_[x]) = forward ? low_[x] + half : high_[x] - half;
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool seed_is_low(int x) const {
    return x == 0 ? grown_[0][1] > 0 || grown_[0][0] == 0 : grown_[1][1] > 0 || grown_[1][0] == 0;
  }
  bool extend(int axis, int side) {
    int const at = side == 0 ? low_[axis] - 1 : high_[axis];
    int const across = 1 - axis;
    for (int n = low_[across]; n < high_[across]; ++n) {
      int const a = axis == 0 ? at : n, b = axis == 0 ? n : at;
      if (--budget_ < 0 || !cells_.is_open(own_, a, b)) return false;
      auto const image = map_.cell(a, b);
      if (!cells_.is_open(other_, image[0], image[1])) return false;
      CellShape const p = cells_.shape(own_.first + a + Index(own_.nu) * b);
      CellShape const q = cells_.shape(other_.first + image[0] + Index(other_.nu) * image[1]);
      if (p.edge > 0 && q.edge > 0 ? !congruent(p, q, turn_, relative_) : (p.edge > 0) != (q.edge > 0)) return false;
    }
    (side == 0 ? low_ : high_)[axis] += side == 0 ? -1 : 1;
    ++grown_[axis][side];
    return true;
  }
  [[nodiscard]] std::optional<RigidTransform> fit_all() {
    Mesh const& mesh = cells_.mesh();
    std::vector<Vec3> from, to;
    for (int q = low_[1]; q <= high_[1]; ++q)
      for (int p = low_[0]; p <= high_[0]; ++p) {
        auto const image = map_.node(p, q);
        from.push_back(mesh.coordinates[cells_.node(own_, p, q)]);
        to.push_back(mesh.coordinates[cells_.node(other_, image[0], image[1])]);
      }
    budget_ -= Index(from.size());
    RigidTransform const t = fit_rigid_transform(from, to);
    for (int b = low_[1]; b < high_[1]; ++b)
      for (int a = low_[0]; a < high_[0]; ++a) {
        auto const image = map_.cell(a, b);
        CellShape const p = transformed(cells_.shape(own_.first + a + Index(own_.nu) * b), t);
        CellShape const q = cells_.shape(other_.first + image[0] + Index(other_.nu) * image[1]);
        if (p.edge == 0) continue;
        double const tolerance = corner_tolerance(p, q, relative_);
        for (int c = 0; c < 4; ++c)
          if (!(distance(p.corner[c], q.corner[turn_.image(c)]) <= tolerance)) return std::nullopt;
        if (!on_opposite_sides(p, q)) return std::nullopt;
      }
    return t;
  }

  SurfaceCells const& cells_;
  ZoneFace const& own_;
  ZoneFace const& other_;
  FaceMap map_;
  Turn turn_;
  double relative_;
  Index& budget_;
  std::array<int, 2> low_, high_;
  std::array<std::array<int, 2>, 2> grown_{};
};

}  // namespace

std::optional<RigidTransform> fit_congruent_piece(SurfaceCells const& cells, Seed const& p, Seed const& q, Turn turn,
                                                  double relative, Index& budget) {
  return Grower(cells, p, q, turn, relative, budget).fit();
}

}  // namespace gridmorph::topology
