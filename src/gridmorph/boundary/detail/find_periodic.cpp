#include <gridmorph/boundary/detail/find_periodic.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace gridmorph::topology {

namespace {

constexpr std::size_t most_seeds = 1200;
constexpr std::size_t most_proposals = 4096;
constexpr int most_trials = 48;
constexpr Index sampled = 1500;              // cells by which a proposal is first judged
constexpr std::size_t fewest_of_sample = 6;  // of them, for a look at all cells
constexpr int most_fits = 5;
constexpr double tidy_direction = 1e-6, tidy_angle = 1e-6;

/// A corner of what is open, as the place to start comparing from.
struct Seed {
  Index cell;
  int face, a, b;
  CellShape shape;
  Index reach = 0;  ///< cells of the open rectangle that it is the corner of, along both directions
};

/// Open cells on the way from (a, b) along one direction, both ways.
int run_length(SurfaceCells const& cells, ZoneFace const& face, int a, int b, int du, int dv) {
  int n = 1;
  for (int sense : {1, -1})
    for (int k = 1; cells.is_open(face, a + sense * k * du, b + sense * k * dv); ++k) ++n;
  return n;
}

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

/// Two transforms are one when they, or one and the inverse of the other, take the corners of the mesh to the same places.
class Proposals {
 public:
  Proposals(Vec3 const& low, Vec3 const& high, double tolerance)
      : probe_{low, {high.x, low.y, low.z}, {low.x, high.y, low.z}, {low.x, low.y, high.z}}, tolerance_(tolerance) {}

  void add(RigidTransform const& t) {
    Vec3 const centre = 0.5 * (probe_[0] + Vec3{probe_[1].x, probe_[2].y, probe_[3].z});
    for (RigidTransform const& way : {t, t.inverse()})
      if (int const known = find(way, way(centre)); known >= 0) {
        ++all_[std::size_t(known)].votes;
        return;
      }
    if (all_.size() >= most_proposals) return;
    places_[key_of(t(centre))].push_back(int(all_.size()));
    all_.push_back({t, 1, distance(t(centre), centre)});
  }
  /// Most votes first, then the shortest way.
  [[nodiscard]] std::vector<Proposal> ranked() const {
    auto out = all_;
    std::stable_sort(out.begin(), out.end(), [](Proposal const& a, Proposal const& b) {
      return a.votes != b.votes ? a.votes > b.votes : a.length < b.length;
    });
    if (out.size() > std::size_t(most_trials)) out.resize(std::size_t(most_trials));
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
              if (same(all_[std::size_t(p)].transform, t)) return p;
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

/// All six distances between corners agree.
bool congruent(CellShape const& p, CellShape const& q, Turn turn, double relative) {
  double const tolerance = 2 * corner_tolerance(p, q, relative);
  for (int c = 0; c < 4; ++c)
    for (int d = c + 1; d < 4; ++d)
      if (std::fabs(distance(p.corner[c], p.corner[d]) - distance(q.corner[turn.image(c)], q.corner[turn.image(d)])) >
          tolerance)
        return false;
  return true;
}

/// Whether laying one cell on the other turns its zone to the other side and moves it into the mesh at the start and out of it at
/// the end: the sides of a sector do. Cheap, and true for few of many pairs that are alike.
bool may_turn(CellShape const& p, CellShape const& q, Turn turn) {
  std::vector<Vec3> const from(p.corner.begin(), p.corner.end());
  std::vector<Vec3> to;
  for (int c = 0; c < 4; ++c) to.push_back(q.corner[std::size_t(turn.image(c))]);
  RigidTransform const t = fit_rigid_transform(from, to);
  if (!on_opposite_sides(transformed(p, t), q)) return false;
  auto const axis = as_turn(t, std::numeric_limits<double>::infinity());
  if (!axis) return false;
  Vec3 const start = cross(axis->direction, p.centre - axis->origin),
             end = cross(axis->direction, q.centre - axis->origin);
  return dot(start, p.inward) > 0 && dot(end, q.inward) < 0;
}

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

/// Numbers that a person would have chosen, where the cells allow them: an axis through the origin along x, y or z, a whole
/// number of sectors.
PeriodicMatch tidied(PeriodicMatch const& found, double size) {
  PeriodicMatch out = found;
  double* const d[3] = {&out.direction.x, &out.direction.y, &out.direction.z};
  for (auto* c : d)
    if (std::fabs(*c) < tidy_direction) *c = 0;
  out.direction = (1 / norm(out.direction)) * out.direction;
  double* const o[3] = {&out.origin.x, &out.origin.y, &out.origin.z};
  for (auto* c : o)
    if (std::fabs(*c) < tidy_direction * size) *c = 0;
  double const sectors = std::round(2 * std::numbers::pi / out.angle_rad);
  if (double const whole = 2 * std::numbers::pi / sectors; std::fabs(whole - out.angle_rad) < tidy_angle)
    out.angle_rad = whole;
  out.transform = rotation_about(out.origin, out.direction, out.angle_rad);
  return out;
}

/// Fitted to all cells that matched.
RigidTransform refitted(SurfaceCells const& cells, std::vector<CellPair> const& pairs, bool rotation) {
  std::vector<Vec3> from, to;
  Vec3 sum;
  for (auto const& pair : pairs) {
    CellShape const p = cells.shape(pair.cell), q = cells.shape(pair.other);
    for (int c = 0; c < 4; ++c) {
      from.push_back(p.corner[c]);
      to.push_back(q.corner[pair.turn.image(c)]);
      sum += to.back() - from.back();
    }
  }
  if (rotation) return fit_rigid_transform(from, to);
  return {Mat3{}, (1 / double(from.size())) * sum};
}

void bounds(SurfaceCells const& cells, Vec3& low, Vec3& high) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  low = {inf, inf, inf};
  high = {-inf, -inf, -inf};
  for (Index c = 0; c < cells.size(); ++c)
    for (auto const& p : cells.shape(c).corner) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
}

}  // namespace

std::optional<PeriodicMatch> as_rotation(RigidTransform const& t, double tolerance) {
  auto const turn = as_turn(t, tolerance);
  if (!turn) return std::nullopt;
  PeriodicMatch out;
  out.rotation = true;
  out.angle_rad = turn->angle_rad;
  out.direction = turn->direction;
  out.origin = turn->origin;
  out.transform = rotation_about(out.origin, out.direction, out.angle_rad);
  return out;
}

std::vector<PeriodicMatch> find_periodic(SurfaceCells& cells, double relative, std::vector<std::string>& notes) {
  std::vector<PeriodicMatch> out;
  auto seeds = find_seeds(cells, notes);
  if (seeds.empty()) return out;
  Vec3 low, high;
  bounds(cells, low, high);
  double const size = distance(low, high), alike = 1e-6 * size;
  CellBins const bins(cells, relative);

  auto const set_open = [&](std::vector<CellPair> const& pairs, bool open) {
    for (auto const& pair : pairs)
      for (Index const c : {pair.cell, pair.other}) open ? cells.release(c) : cells.claim(c);
  };
  // A look at the corners alone: what maps none of them has been taken by others before.
  auto const maps_a_seed = [&](RigidTransform const& t) {
    return std::any_of(seeds.begin(), seeds.end(), [&](Seed const& s) {
      int hits = 0;
      if (cells.is_open(s.cell)) (void)bins.partner(s.cell, t, false, hits);
      return hits > 0;
    });
  };
  // A few cells from everywhere show whether a sizeable part is mapped; most proposals map next to nothing.
  std::vector<Index> sample;
  {
    std::vector<Index> open;
    for (Index c = 0; c < cells.size(); ++c)
      if (cells.is_open(c)) open.push_back(c);
    Index const stride = std::max<Index>(1, Index(open.size()) / sampled);
    for (std::size_t n = 0; n < open.size(); n += std::size_t(stride)) sample.push_back(open[n]);
  }
  auto const worth_a_look = [&](RigidTransform const& t) {
    std::size_t found = 0, tried = 0;
    for (Index const c : sample) {
      if (!cells.is_open(c)) continue;
      ++tried;
      int hits = 0;
      (void)bins.partner(c, t, false, hits);
      if (hits > 0 && ++found >= fewest_of_sample) return true;
    }
    return tried < std::size_t(sampled) / 2 && found > 0;
  };
  auto const matched = [&](RigidTransform const& t) {
    Index ambiguous = 0;
    return worth_a_look(t) && (maps_a_seed(t) || maps_a_seed(t.inverse())) ? bins.match(t, false, ambiguous)
                                                                           : std::vector<CellPair>{};
  };
  // Those that map the most cells come first: a small piece can be like others in many ways.
  auto const by_count = [&](std::vector<Proposal> const& proposals) {
    std::vector<std::pair<std::size_t, RigidTransform>> counted;
    for (auto const& p : proposals) counted.emplace_back(matched(p.transform).size(), p.transform);
    std::stable_sort(counted.begin(), counted.end(), [](auto const& a, auto const& b) { return a.first > b.first; });
    return counted;
  };
  auto const try_out = [&](PeriodicMatch match) {
    match.pairs = matched(match.transform);
    if (match.pairs.empty()) return;
    Index ambiguous = 0;
    // All cells together know the transform better than the piece that proposed it, and a better one may find more.
    for (int attempt = 0; attempt < most_fits; ++attempt) {
      PeriodicMatch better = match;
      better.transform = refitted(cells, match.pairs, match.rotation);
      if (match.rotation) {
        auto const turn = as_rotation(better.transform, 1e-6 * size);
        if (!turn) break;
        better = tidied(*turn, size);
      }
      better.pairs = bins.match(better.transform, false, ambiguous);
      if (better.pairs.size() < match.pairs.size()) break;
      bool const more = better.pairs.size() > match.pairs.size();
      match = std::move(better);
      if (!more) break;
    }
    set_open(match.pairs, false);
    out.push_back(std::move(match));
  };

  Proposals shifts(low, high, alike);
  for_each_pair(cells, seeds, relative, [&](Seed const& p, Seed const& q) {
    if (auto const t = translation_between(p.shape, q.shape, relative)) shifts.add(*t);
  });
  for (auto const& [count, transform] : by_count(shifts.ranked())) {
    PeriodicMatch match;
    match.transform = transform;
    try_out(std::move(match));
  }

  // Rotations may take cells that translations have, but are proposed by others: those of a box are of no interest.
  std::erase_if(seeds, [&](Seed const& s) { return !cells.is_open(s.cell); });
  std::vector<std::uint8_t> shifted(std::size_t(cells.size()), 0);
  for (auto const& match : out) {
    for (auto const& pair : match.pairs) shifted[pair.cell] = shifted[pair.other] = 1;
    set_open(match.pairs, true);
  }
  std::vector<PeriodicMatch> translations = std::exchange(out, {});
  Proposals turns(low, high, alike);
  Index budget = 10 * cells.size() + 100'000;
  for_each_pair(cells, seeds, relative, [&](Seed const& p, Seed const& q) {
    for (int n = 0; n < 8 && budget > 0; ++n) {
      if (!congruent(p.shape, q.shape, Turn{n}, relative) || !may_turn(p.shape, q.shape, Turn{n})) continue;
      auto const t = Grower(cells, p, q, Turn{n}, relative, budget).fit();
      if (t && as_rotation(*t, 10 * corner_tolerance(p.shape, q.shape, relative))) turns.add(*t);
    }
  });
  if (budget <= 0) notes.emplace_back("the search for rotational periodicity was cut short: too many faces are alike");
  for (auto const& [count, transform] : by_count(turns.ranked())) {
    auto match = as_rotation(transform, size);
    if (!match) continue;
    std::size_t const before = out.size();
    try_out(std::move(*match));
    if (out.size() == before) continue;
    auto const& pairs = out.back().pairs;
    auto const also_shifted =
        std::count_if(pairs.begin(), pairs.end(), [&](CellPair const& p) { return shifted[p.cell] != 0; });
    if (2 * std::size_t(also_shifted) < pairs.size()) continue;
    set_open(pairs, true);
    out.pop_back();
  }
  out.insert(out.begin(), translations.begin(), translations.end());
  return out;
}

}  // namespace gridmorph::topology
