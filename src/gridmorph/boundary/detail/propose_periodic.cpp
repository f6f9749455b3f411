#include <gridmorph/boundary/detail/periodic_faces.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

namespace gridmorph::topology {

namespace {

constexpr std::size_t most_seeds = 1200;
constexpr std::size_t most_proposals = 4096;
constexpr std::size_t most_trials = 48;

/// Open cells on the way from (a, b) along one direction, both ways.
int run_length(SurfaceCells const& cells, ZoneFace const& face, int a, int b, int du, int dv) {
  int n = 1;
  for (int sense : {1, -1})
    for (int k = 1; cells.is_open(face, a + sense * k * du, b + sense * k * dv); ++k) ++n;
  return n;
}

/// Calls visit for all pairs of seeds with smallest edges of equal length.
template <class Visit>
void for_each_pair(SurfaceCells const& cells, std::vector<Seed> const& seeds, double relative, Visit visit) {
  for (std::size_t p = 0; p < seeds.size(); ++p)
    for (std::size_t q = p + 1; q < seeds.size(); ++q) {
      double const e = seeds[p].shape.edge;
      double const slack = 2 * std::max({relative * e, seeds[p].shape.noise, seeds[q].shape.noise});
      if (seeds[q].shape.edge > e + slack) break;
      if (seeds[p].face == seeds[q].face) continue;
      if (!cells.across_one_layer(seeds[p].cell, seeds[q].cell)) visit(seeds[p], seeds[q]);
    }
}

struct Proposal {
  RigidTransform transform;
  int votes = 1;
  double length = 0;  ///< of the way that points go
};

/// Two transforms are one when they, or one and the inverse of the other, take the corners of the mesh to the same
/// places.
class Proposals {
 public:
  explicit Proposals(Box const& box)
      : probe_{box.low,
               {box.high.x, box.low.y, box.low.z},
               {box.low.x, box.high.y, box.low.z},
               {box.low.x, box.low.y, box.high.z}},
        tolerance_(1e-6 * distance(box.low, box.high)) {}

  void add(RigidTransform const& t) {
    Vec3 const centre = 0.5 * (probe_[0] + Vec3{probe_[1].x, probe_[2].y, probe_[3].z});
    for (RigidTransform const& way : {t, t.inverse()})
      if (int const known = find(way, way(centre)); known >= 0) {
        ++all_[known].votes;
        return;
      }
    if (all_.size() >= most_proposals) return;
    places_[key_of(t(centre))].push_back(int(all_.size()));
    all_.push_back({t, 1, distance(t(centre), centre)});
  }
  /// The transforms in order: most votes first, then the shortest way.
  [[nodiscard]] std::vector<RigidTransform> ranked() const {
    auto sorted = all_;
    std::stable_sort(sorted.begin(), sorted.end(), [](Proposal const& a, Proposal const& b) {
      return a.votes != b.votes ? a.votes > b.votes : a.length < b.length;
    });
    std::vector<RigidTransform> out;
    for (Proposal const& p : sorted)
      if (out.size() < most_trials) out.push_back(p.transform);
    return out;
  }

 private:
  using Key = std::array<std::int64_t, 3>;

  [[nodiscard]] Key key_of(Vec3 const& p) const {
    double const width = 16 * tolerance_;
    return {std::int64_t(std::floor(p.x / width)), std::int64_t(std::floor(p.y / width)),
            std::int64_t(std::floor(p.z / width))};
  }
  /// The proposal that is the same as t, which takes the centre of the mesh to `place`; -1 when there is none.
  [[nodiscard]] int find(RigidTransform const& t, Vec3 const& place) const {
    Vec3 const reach{tolerance_, tolerance_, tolerance_};
    Key const low = key_of(place - reach), high = key_of(place + reach);
    for (auto i = low[0]; i <= high[0]; ++i)
      for (auto j = low[1]; j <= high[1]; ++j)
        for (auto k = low[2]; k <= high[2]; ++k)
          if (auto const at = places_.find({i, j, k}); at != places_.end())
            for (int const p : at->second)
              if (same(all_[p].transform, t)) return p;
    return -1;
  }
  [[nodiscard]] bool same(RigidTransform const& a, RigidTransform const& b) const {
    return std::all_of(probe_.begin(), probe_.end(), [&](Vec3 const& p) { return distance(a(p), b(p)) <= tolerance_; });
  }
  std::array<Vec3, 4> probe_;
  double tolerance_;
  std::vector<Proposal> all_;
  std::map<Key, std::vector<int>> places_;  ///< by where the centre of the mesh goes
};

std::optional<RigidTransform> translation_between(CellShape const& p, CellShape const& q, double relative) {
  double const tolerance = corner_tolerance(p, q, relative);
  for (int n = 0; n < 8; ++n) {
    Turn const turn{n};
    Vec3 const shift = q.centre - p.centre;
    bool good = norm(shift) > 10 * tolerance;
    for (int c = 0; c < 4 && good; ++c) good = distance(p.corner[c] + shift, q.corner[turn.image(c)]) <= tolerance;
    if (!good) continue;
    RigidTransform const t{Mat3{}, shift};
    if (on_opposite_sides(transformed(p, t), q)) return t;
  }
  return std::nullopt;
}

/// Whether laying one cell on the other turns its zone to the other side and moves it into the mesh at the start and
/// out of it at the end: the sides of a sector do. Cheap, and true for few of many pairs that are alike.
bool may_turn(CellShape const& p, CellShape const& q, Turn turn) {
  std::vector<Vec3> const from(p.corner.begin(), p.corner.end());
  std::vector<Vec3> to;
  for (int c = 0; c < 4; ++c) to.push_back(q.corner[turn.image(c)]);
  RigidTransform const t = fit_rigid_transform(from, to);
  if (!on_opposite_sides(transformed(p, t), q)) return false;
  auto const axis = as_turn(t, std::numeric_limits<double>::infinity());
  if (!axis) return false;
  Vec3 const start = cross(axis->direction, p.centre - axis->origin),
             end = cross(axis->direction, q.centre - axis->origin);
  return dot(start, p.inward) > 0 && dot(end, q.inward) < 0;
}

}  // namespace

std::vector<Seed> find_seeds(SurfaceCells const& cells, std::vector<std::string>& notes) {
  std::vector<Seed> seeds;
  for (int f = 0; f < int(cells.faces().size()); ++f) {
    ZoneFace const& face = cells.faces()[f];
    for (int b = 0; b < face.nv; ++b)
      for (int a = 0; a < face.nu; ++a) {
        if (!cells.is_open(face, a, b)) continue;
        if (cells.is_open(face, a - 1, b) && cells.is_open(face, a + 1, b)) continue;
        if (cells.is_open(face, a, b - 1) && cells.is_open(face, a, b + 1)) continue;
        Index const cell = face.first + a + Index(face.nu) * b;
        Seed s{cell,
               f,
               a,
               b,
               cells.shape(cell),
               Index(run_length(cells, face, a, b, 1, 0)) * run_length(cells, face, a, b, 0, 1)};
        if (s.shape.edge > 0) seeds.push_back(std::move(s));
      }
  }
  if (seeds.size() > most_seeds) {
    notes.push_back("open faces have " + std::to_string(seeds.size()) + " corners; periodicity was looked for from " +
                    std::to_string(most_seeds) + " of the largest");
    std::stable_sort(seeds.begin(), seeds.end(), [](Seed const& a, Seed const& b) { return a.reach > b.reach; });
    seeds.resize(most_seeds);
  }
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](Seed const& a, Seed const& b) { return a.shape.edge < b.shape.edge; });
  return seeds;
}

std::vector<RigidTransform> propose_translations(SurfaceCells const& cells, std::vector<Seed> const& seeds,
                                                 Box const& box, double relative) {
  Proposals shifts(box);
  for_each_pair(cells, seeds, relative, [&](Seed const& p, Seed const& q) {
    if (auto const t = translation_between(p.shape, q.shape, relative)) shifts.add(*t);
  });
  return shifts.ranked();
}

std::vector<RigidTransform> propose_rotations(SurfaceCells const& cells, std::vector<Seed> const& seeds, Box const& box,
                                              double relative, std::vector<std::string>& notes) {
  Proposals turns(box);
  Index budget = 10 * cells.size() + 100'000;
  for_each_pair(cells, seeds, relative, [&](Seed const& p, Seed const& q) {
    for (int n = 0; n < 8 && budget > 0; ++n) {
      if (!congruent(p.shape, q.shape, Turn{n}, relative) || !may_turn(p.shape, q.shape, Turn{n})) continue;
      auto const t = fit_congruent_piece(cells, p, q, Turn{n}, relative, budget);
      if (t && as_turn(*t, 10 * corner_tolerance(p.shape, q.shape, relative))) turns.add(*t);
    }
  });
  if (budget <= 0) notes.emplace_back("the search for rotational periodicity was cut short: too many faces are alike");
  return turns.ranked();
}

}  // namespace gridmorph::topology
