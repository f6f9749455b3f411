#include <gridmorph/boundary/joined_sides.hpp>

#include <gridmorph/core/disjoint_sets.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr double same_point = 1e-7;  // of the size

/// Number of the piece that each grid belongs to, from 0.
std::vector<int> pieces_of(PatchSurface const& surface) {
  std::vector<int> holds(surface.points.size(), -1);
  DisjointSets<int> pieces(surface.grids.size());
  for (std::size_t g = 0; g < surface.grids.size(); ++g)
    for (int const v : surface.grids[g].vertex) {
      if (holds[v] >= 0) pieces.join(holds[v], int(g));
      holds[v] = int(g);
    }
  return pieces.set_numbers();
}

class Joiner {
 public:
  Joiner(Boundary const& boundary, PatchSurface const& surface)
      : surface_(surface), piece_(pieces_of(surface)), members_(1 + *std::max_element(piece_.begin(), piece_.end())) {
    for (std::size_t g = 0; g < surface.grids.size(); ++g) {
      auto& members = members_[piece_[g]];
      members.insert(surface.grids[g].vertex.begin(), surface.grids[g].vertex.end());
    }
    if (members_.size() == 1) return;
    for (RigidTransform const& transform : boundary.periodic_transforms()) {
      transforms_.push_back(transform);
      transforms_.push_back(transform.inverse());
    }
  }

  [[nodiscard]] int n_pieces() const { return int(members_.size()); }

  /// Where each piece goes when piece `home` stays.
  [[nodiscard]] std::vector<std::optional<RigidTransform>> places(int home) const {
    std::vector<std::optional<RigidTransform>> place(members_.size());
    PointNumbers placed(same_point * surface_.size);
    auto const put = [&](int piece, RigidTransform const* transform) {
      for (int const v : members_[piece])
        placed.add(transform ? (*transform)(surface_.points[v]) : surface_.points[v], v);
      place[piece] = transform ? *transform : RigidTransform{};
    };
    put(home, nullptr);
    for (bool found = true; found;) {
      found = false;
      for (int p = 0; p < n_pieces(); ++p) {
        if (place[p]) continue;
        RigidTransform const* best = nullptr;
        int most = 1;  // a common edge has two vertices
        for (RigidTransform const& transform : transforms_) {
          int common = 0;
          for (int const v : members_[p]) common += placed.find(transform(surface_.points[v])) >= 0 ? 1 : 0;
          if (common > most) {
            most = common;
            best = &transform;
          }
        }
        if (!best) continue;
        put(p, best);
        found = true;
      }
    }
    return place;
  }

  [[nodiscard]] Vec3 middle(std::vector<std::optional<RigidTransform>> const& place) const {
    Vec3 sum;
    double count = 0;
    for (int p = 0; p < n_pieces(); ++p) {
      if (!place[p]) continue;
      for (int const v : members_[p]) sum += (*place[p])(surface_.points[v]);
      count += double(members_[p].size());
    }
    return (1 / count) * sum;
  }

  [[nodiscard]] JoinedSides join(int home, std::vector<std::optional<RigidTransform>> const& place) const {
    JoinedSides out{surface_, {}, {}, {}};
    out.surface.points.clear();
    out.surface.numbers = PointNumbers(same_point * surface_.size);
    out.vertex.assign(surface_.points.size(), -1);
    auto const number = [&](int v, RigidTransform const* transform) {
      Vec3 const x = transform ? (*transform)(surface_.points[v]) : surface_.points[v];
      // What was apart before stays apart, however close: only what comes from another piece is looked for.
      int n = transform ? out.surface.numbers.find(x) : -1;
      if (n < 0) {
        n = int(out.surface.points.size());
        out.surface.points.push_back(x);
      }
      out.vertex[v] = n;
    };
    std::vector<int> order{home};
    for (int p = 0; p < n_pieces(); ++p)
      if (p != home) order.push_back(p);
    for (int const p : order) {
      bool const turned = p != home && place[p].has_value();
      for (int const v : members_[p]) number(v, turned ? &*place[p] : nullptr);
      for (int const v : members_[p]) out.surface.numbers.add(out.surface.points[out.vertex[v]], out.vertex[v]);
    }
    for (std::size_t g = 0; g < out.surface.grids.size(); ++g) {
      int const p = piece_[g];
      for (int& v : out.surface.grids[g].vertex) v = out.vertex[v];
      for (GridFacet& face : out.surface.grids[g].faces)
        for (int& v : face)
          if (v >= 0) v = out.vertex[v];
      out.turned.push_back(p != home && place[p].has_value() ? 1 : 0);
      out.turn.push_back(out.turned.back() != 0 ? *place[p] : RigidTransform{});
    }
    return out;
  }

 private:
  PatchSurface const& surface_;
  std::vector<int> piece_;              ///< per grid
  std::vector<std::set<int>> members_;  ///< vertices per piece
  std::vector<RigidTransform> transforms_;
};

}  // namespace

JoinedSides join_sides(Boundary const& boundary, PatchSurface const& surface, Vec3 const& near) {
  Joiner const joiner(boundary, surface);
  int home = 0;
  auto place = joiner.places(home);
  for (int p = 1; p < joiner.n_pieces(); ++p) {
    if (!place[p]) continue;
    auto other = joiner.places(p);
    if (distance(joiner.middle(other), near) < distance(joiner.middle(place), near)) {
      place = std::move(other);
      home = p;
    }
  }
  return joiner.join(home, place);
}

}  // namespace gridmorph
