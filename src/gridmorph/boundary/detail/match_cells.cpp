#include <gridmorph/boundary/detail/match_cells.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace gridmorph::topology {

namespace {

/// Edges shorter than this many times the round-off count as that long, so that bins are wider than the tolerance.
constexpr double noise_to_size = 4;

double size_of(CellShape const& s) { return std::max(s.edge, noise_to_size * s.noise); }

}  // namespace

double corner_tolerance(CellShape const& a, CellShape const& b, double relative) {
  return std::max({relative * std::min(a.edge, b.edge), a.noise, b.noise});
}

bool lies_on(CellShape const& moved, CellShape const& other, double relative, Turn& turn, double& mismatch) {
  double const tolerance = corner_tolerance(moved, other, relative);
  bool found = false;
  for (int n = 0; n < 8; ++n) {
    Turn const t{n};
    double worst = 0;
    for (int c = 0; c < 4 && worst <= tolerance; ++c)
      worst = std::max(worst, distance(moved.corner[c], other.corner[t.image(c)]));
    if (worst > tolerance || (found && worst >= mismatch)) continue;
    found = true;
    turn = t;
    mismatch = worst;
  }
  return found;
}

bool on_opposite_sides(CellShape const& moved, CellShape const& other) {
  Vec3 const normal = cross(moved.corner[2] - moved.corner[0], moved.corner[3] - moved.corner[1]);
  return dot(moved.inward, normal) * dot(other.inward, normal) <= 0;
}

CellShape transformed(CellShape const& shape, RigidTransform const& t) {
  CellShape out = shape;
  for (auto& p : out.corner) p = t(p);
  out.centre = t(shape.centre);
  out.inward = t.rotation * shape.inward;
  return out;
}

int CellBins::level(double size) const { return std::ilogb(size); }

std::uint64_t CellBins::key(int level, std::int64_t i, std::int64_t j, std::int64_t k) const {
  // Fibonacci hashing of each number in turn.
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15u;
  std::uint64_t h = std::uint64_t(std::int64_t(level)) * golden;
  for (auto const n : {i, j, k}) h = (std::rotl(h, 29) ^ std::uint64_t(n)) * golden;
  return h ^ (h >> 31);
}

namespace {

/// Bin of a coordinate; far outside of what integers hold, all share one.
std::int64_t bin(double x, double width) { return std::int64_t(std::clamp(std::floor(x / width), -9e15, 9e15)); }

}  // namespace

CellBins::CellBins(SurfaceCells const& cells, double relative) : cells_(&cells), relative_(relative) {
  for (Index c = 0; c < cells.size(); ++c) {
    if (!cells.is_open(c)) continue;
    CellShape const s = cells.shape(c);
    if (s.edge == 0) continue;
    int const l = level(size_of(s));
    double const width = std::ldexp(1.0, l);
    number_.push_back(c);
    key_.push_back(key(l, bin(s.centre.x, width), bin(s.centre.y, width), bin(s.centre.z, width)));
  }
  mask_ = std::bit_ceil(std::max<std::uint64_t>(2 * number_.size(), 2)) - 1;
  head_.assign(mask_ + 1, -1);
  next_.assign(number_.size(), -1);
  for (Index n = Index(number_.size()) - 1; n >= 0; --n) {  // chains in ascending order
    next_[n] = head_[key_[n] & mask_];
    head_[key_[n] & mask_] = n;
  }
}

CellPair CellBins::partner(Index cell, RigidTransform const& t, bool identity, int& hits) const {
  CellPair best;
  hits = 0;
  CellShape const own = identity ? cells_->shape(cell) : transformed(cells_->shape(cell), t);
  double const size = size_of(own);
  // The edges of two coincident cells may fall on different sides of a power of two.
  int const low = level(size * (1 - 2 * relative_)), high = level(size * (1 + 2 * relative_));
  for (int l = low; l <= high; ++l) {
    double const width = std::ldexp(1.0, l), reach = 0.5 * width;
    auto const lo = [&](double x) { return bin(x - reach, width); };
    auto const hi = [&](double x) { return bin(x + reach, width); };
    for (std::int64_t k = lo(own.centre.z); k <= hi(own.centre.z); ++k)
      for (std::int64_t j = lo(own.centre.y); j <= hi(own.centre.y); ++j)
        for (std::int64_t i = lo(own.centre.x); i <= hi(own.centre.x); ++i) {
          std::uint64_t const wanted = key(l, i, j, k);
          for (Index n = head_[wanted & mask_]; n >= 0; n = next_[n]) {
            Index const other = number_[n];
            if (key_[n] != wanted || other == cell || !cells_->is_open(other)) continue;
            CellShape const s = cells_->shape(other);
            Turn turn;
            double mismatch = 0;
            if (!lies_on(own, s, relative_, turn, mismatch) || !on_opposite_sides(own, s)) continue;
            if (!identity && cells_->across_one_layer(cell, other)) continue;
            if (hits++ == 0 || mismatch < best.mismatch || (mismatch == best.mismatch && other < best.other))
              best = {cell, other, turn, mismatch};
          }
        }
  }
  return best;
}

std::vector<CellPair> CellBins::match(RigidTransform const& t, bool identity, Index& ambiguous) const {
  std::vector<CellPair> found;
  for (Index const c : number_) {
    if (!cells_->is_open(c)) continue;
    int hits = 0;
    CellPair const best = partner(c, t, identity, hits);
    if (hits > 1) ++ambiguous;
    if (hits > 0) found.push_back(best);
  }
  // One partner each: the nearest pairs first.
  std::vector<std::size_t> order(found.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return found[a].mismatch < found[b].mismatch; });
  std::vector<std::uint8_t> used(cells_->size(), 0);
  std::vector<CellPair> out;
  for (auto const n : order) {
    CellPair const& p = found[n];
    if (used[p.cell] || used[p.other]) continue;
    if (identity && p.cell > p.other)
      out.push_back({p.other, p.cell, p.turn.inverse(), p.mismatch});
    else
      out.push_back(p);
    used[p.cell] = used[p.other] = 1;
  }
  std::sort(out.begin(), out.end(), [](CellPair const& a, CellPair const& b) { return a.cell < b.cell; });
  return out;
}

}  // namespace gridmorph::topology
