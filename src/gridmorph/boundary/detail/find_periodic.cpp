#include <gridmorph/boundary/detail/periodic_faces.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace gridmorph::topology {

namespace {

constexpr Index sampled = 1500;              // cells by which a proposal is first judged
constexpr std::size_t fewest_of_sample = 6;  // of them, for a look at all cells
constexpr int most_fits = 5;
constexpr double tidy_direction = 1e-6, tidy_angle = 1e-6;

/// Numbers that a person would have chosen, where the cells allow them: an axis through the origin along x, y or z, a
/// whole number of sectors.
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

/// The transform fitted to all cells that matched.
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

Box box_of(SurfaceCells const& cells) {
  Box box;
  for (Index c = 0; c < cells.size(); ++c)
    for (Vec3 const& p : cells.shape(c).corner) box.include(p);
  return box;
}

void set_open(SurfaceCells& cells, std::vector<CellPair> const& pairs, bool open) {
  for (auto const& pair : pairs)
    for (Index const c : {pair.cell, pair.other}) open ? cells.release(c) : cells.claim(c);
}

/// Tries transforms on the cells that are open.
class Trials {
 public:
  /// Seeds may be taken out of the list meanwhile.
  Trials(SurfaceCells& cells, std::vector<Seed> const& seeds, double size, double relative)
      : cells_(cells), seeds_(seeds), bins_(cells, relative), size_(size) {
    std::vector<Index> open;
    for (Index c = 0; c < cells.size(); ++c)
      if (cells.is_open(c)) open.push_back(c);
    Index const stride = std::max<Index>(1, Index(open.size()) / sampled);
    for (std::size_t n = 0; n < open.size(); n += std::size_t(stride)) sample_.push_back(open[n]);
  }

  /// The proposals in the order in which they are tried: those that map the most cells come first: a small piece can be
  /// like others in many ways.
  [[nodiscard]] std::vector<RigidTransform> by_count(std::vector<RigidTransform> const& proposals) const {
    std::vector<std::pair<std::size_t, RigidTransform>> counted;
    for (auto const& t : proposals) counted.emplace_back(matched(t).size(), t);
    std::stable_sort(counted.begin(), counted.end(), [](auto const& a, auto const& b) { return a.first > b.first; });
    std::vector<RigidTransform> out;
    for (auto const& [count, t] : counted) out.push_back(t);
    return out;
  }

  /// Finds the cells that the transform maps, fits it to them, and claims them; none: they stay open.
  PeriodicMatch claim(PeriodicMatch match) {
    match.pairs = matched(match.transform);
    // All cells together know the transform better than the piece that proposed it, and a better one may find more.
    for (int attempt = 0; attempt < most_fits && !match.pairs.empty(); ++attempt) {
      PeriodicMatch better = match;
      better.transform = refitted(cells_, match.pairs, match.rotation);
      if (match.rotation) {
        auto const turn = as_rotation(better.transform, 1e-6 * size_);
        if (!turn) break;
        better = tidied(*turn, size_);
      }
      Index ambiguous = 0;
      better.pairs = bins_.match(better.transform, false, ambiguous);
      if (better.pairs.size() < match.pairs.size()) break;
      bool const more = better.pairs.size() > match.pairs.size();
      match = std::move(better);
      if (!more) break;
    }
    set_open(cells_, match.pairs, false);
    return match;
  }

 private:
  [[nodiscard]] bool maps(Index cell, RigidTransform const& t) const {
    int hits = 0;
    (void)bins_.partner(cell, t, false, hits);
    return hits > 0;
  }
  /// A look at the corners alone: what maps none of them has been taken by others before.
  [[nodiscard]] bool maps_a_seed(RigidTransform const& t) const {
    return std::any_of(seeds_.begin(), seeds_.end(),
                       [&](Seed const& s) { return cells_.is_open(s.cell) && maps(s.cell, t); });
  }
  /// A few cells from everywhere show whether a sizeable part is mapped; most proposals map next to nothing.
  [[nodiscard]] bool worth_a_look(RigidTransform const& t) const {
    std::size_t found = 0, tried = 0;
    for (Index const c : sample_) {
      if (!cells_.is_open(c)) continue;
      ++tried;
      if (maps(c, t) && ++found >= fewest_of_sample) return true;
    }
    return tried < std::size_t(sampled) / 2 && found > 0;
  }
  [[nodiscard]] std::vector<CellPair> matched(RigidTransform const& t) const {
    Index ambiguous = 0;
    return worth_a_look(t) && (maps_a_seed(t) || maps_a_seed(t.inverse())) ? bins_.match(t, false, ambiguous)
                                                                           : std::vector<CellPair>{};
  }

  SurfaceCells& cells_;
  std::vector<Seed> const& seeds_;
  CellBins bins_;
  double size_;
  std::vector<Index> sample_;
};

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
  Box const box = box_of(cells);
  double const size = distance(box.low, box.high);
  Trials trials(cells, seeds, size, relative);
  for (auto const& transform : trials.by_count(propose_translations(cells, seeds, box, relative))) {
    PeriodicMatch match;
    match.transform = transform;
    match = trials.claim(std::move(match));
    if (!match.pairs.empty()) out.push_back(std::move(match));
  }

  // Rotations may take cells that translations have, but are proposed by others: those of a box are of no interest.
  std::erase_if(seeds, [&](Seed const& s) { return !cells.is_open(s.cell); });
  std::vector<std::uint8_t> shifted(cells.size(), 0);
  for (auto const& match : out) {
    for (auto const& pair : match.pairs) shifted[pair.cell] = shifted[pair.other] = 1;
    set_open(cells, match.pairs, true);
  }
  for (auto const& transform : trials.by_count(propose_rotations(cells, seeds, box, relative, notes))) {
    auto rotation = as_rotation(transform, size);
    if (!rotation) continue;
    PeriodicMatch match = trials.claim(std::move(*rotation));
    auto const also_shifted =
        std::count_if(match.pairs.begin(), match.pairs.end(), [&](CellPair const& p) { return shifted[p.cell] != 0; });
    if (2 * std::size_t(also_shifted) < match.pairs.size())
      out.push_back(std::move(match));
    else
      set_open(cells, match.pairs, true);
  }
  return out;
}

}  // namespace gridmorph::topology
