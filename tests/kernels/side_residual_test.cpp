// Known sides of chains, node by node: in any order, and on edges against a scan for the nearest known nodes.
#include "kernels/tables.hpp"

#include <gridmorph/kernels/side_residual.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::Chain;
using kernels::Junction;
using kernels::Side;

/// A chain of blocks with displacements at random on its sides, of which it is known at random where they count. Its
/// ends are at rest, so that residuals of known nodes are their displacements.
class RandomSides {
 public:
  explicit RandomSides(unsigned seed) : random_(seed) {
    chain_.n_blocks = number(1, 4);
    int position = 0;
    for (int m = 0; m <= chain_.n_blocks; ++m) {
      junctions_.push_back({position, bits(), bits()});
      if (m < chain_.n_blocks) position += number(1, number(0, 3) == 0 ? 150 : 7);
    }
    chain_.n_s = position + 1;
    chain_.n_a = number(2, 6);
    chain_.n_b = number(2, 6);
    chain_.open_end = number(0, 1);
    chain_.first_side = 0;
    unsigned const mask = std::array<unsigned, 3>{0xffu, ~12u, ~3u}[std::size_t(number(0, 2))];
    for (Junction& j : junctions_) {
      j.known_across &= mask;
      j.known_along &= mask;
      chain_.known_sides |= j.known_across | j.known_along;
    }
    for (int q = 0; q < 4; ++q) {
      sides_.push_back({0, n_w(q), kernels::Index(t_.size())});
      for (int w = 0; w < n_w(q); ++w)
        for (int p = 0; p < chain_.n_s; ++p) t_.push_back(p == 0 ? 0 : t_.back() + 0.1 + share());
    }
    for (int m = 0; m < 4 * chain_.n_a * chain_.n_b; ++m) section_.push_back(share());
    for (std::size_t n = 0; n < t_.size(); ++n) given_.push_back({share(), share(), share()});
  }

  /// Residuals of all sides, by rows of at most `Width` nodes in an order of their own.
  template <int Width>
  std::vector<Vec3> residuals(unsigned order) const {
    std::size_t const n = t_.size(), n_ends = std::size_t(2 * chain_.section_size());
    Arrays ends(n_ends), known(n), c(n);
    for (std::size_t k = 0; k < n; ++k) known.field().set(kernels::Index(k), given_[k]);
    std::vector<kernels::SideNodes> nodes;
    std::vector<kernels::Index> first{0};
    std::vector<double> per_t(t_.size(), 1);  // of lookups between nodes
    for (std::size_t k = 0; k + 1 < t_.size(); ++k)
      if (t_[k + 1] > t_[k]) per_t[k] = 1 / (t_[k + 1] - t_[k]);
    for (int q = 0; q < 4; ++q) {
      nodes.push_back({q, chain_.n_s, n_w(q)});
      first.push_back(first.back() + kernels::SideResidual<Host, Width>::items(nodes.back()));
    }
    auto const chains = view<Chain>({chain_});
    kernels::SideTable<Host> const table{view(sides_), view(junctions_), view(t_),
                                         view(per_t),  view(section_),   c.read()};
    kernels::SideResidual<Host, Width> const residual{view(nodes), view(first),   chains,   table,
                                                      ends.read(), known.field(), c.field()};
    kernels::SideFill<Host, Width> const fill{view(nodes), view(first), chains, table, known.read(), c.field()};
    in_order(first.back(), order, residual);
    in_order(first.back(), order + 1, fill);
    std::vector<Vec3> out;
    for (std::size_t k = 0; k < n; ++k) out.push_back(c.read()[kernels::Index(k)]);
    return out;
  }

  /// Calls visit(edge, node of its first side, nodes of the edge that are known) for the four edges along s.
  template <class Visit>
  void each_edge(Visit const& visit) const {
    for (int e = 0; e < 4; ++e) {
      std::vector<char> known(std::size_t(chain_.n_s), 0);
      for (std::size_t m = 0; m < junctions_.size(); ++m) {
        Junction const& j = junctions_[m];
        known[std::size_t(j.position)] = char((j.known_across >> (4 + e)) & 1u);
        if (m + 1 == junctions_.size()) continue;
        for (int p = j.position + 1; p < junctions_[m + 1].position; ++p)
          known[std::size_t(p)] = char((j.known_along >> (4 + e)) & 1u);
      }
      known.front() = 1;
      if (chain_.open_end == 0) known.back() = 1;
      visit(std::size_t(sides_[std::size_t(e % 2)].first) + std::size_t(e < 2 ? 0 : (chain_.n_b - 1) * chain_.n_s),
            known);
    }
  }
  /// The displacement that is given at a known node of the chain; none at its ends.
  Vec3 given(std::size_t first, std::size_t p) const {
    bool const end = p == 0 || (int(p) == chain_.n_s - 1 && chain_.open_end == 0);
    return end ? Vec3{} : given_[first + p];
  }
  double t(std::size_t n) const { return t_[n]; }

 private:
  int number(int low, int high) { return std::uniform_int_distribution<>(low, high)(random_); }
  double share() { return std::uniform_real_distribution<>(0, 1)(random_); }
  std::uint32_t bits() { return std::uint32_t(number(0, 255) & number(0, 255)); }
  int n_w(int q) const { return q < 2 ? chain_.n_b : chain_.n_a; }

  template <class Kernel>
  static void in_order(kernels::Index n, unsigned order, Kernel const& kernel) {
    std::vector<kernels::Index> items;
    for (kernels::Index item = 0; item < n; ++item) items.push_back(item);
    std::shuffle(items.begin(), items.end(), std::mt19937(order));
    for (kernels::Index const item : items) kernel(item);
  }

  std::mt19937 random_;
  Chain chain_{};
  std::vector<Junction> junctions_;
  std::vector<Side> sides_;
  std::vector<double> t_, section_;
  std::vector<Vec3> given_;
};

TEST(SideResiduals, AreTheSameBitsNodeByNodeInAnyOrder) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomSides const sides(seed);
    auto const rows = sides.residuals<128>(1), nodes = sides.residuals<1>(seed + 2);
    for (std::size_t n = 0; n < rows.size(); ++n) ASSERT_TRUE(rows[n] == nodes[n]) << seed << " " << n;
  }
}

TEST(SideResiduals, AreLinearBetweenTheNearestKnownNodesOfAnEdge) {
  int n_filled = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomSides const sides(seed);
    auto const c = sides.residuals<128>(seed);
    sides.each_edge([&](std::size_t first, std::vector<char> const& known) {
      for (std::size_t p = 0; p < known.size(); ++p) {
        std::size_t below = p, above = p;
        while (known[below] == 0) --below;
        while (above < known.size() && known[above] == 0) ++above;
        Vec3 wanted = sides.given(first, below);
        if (above < known.size() && above > below) {
          double const f =
              (sides.t(first + p) - sides.t(first + below)) / (sides.t(first + above) - sides.t(first + below));
          wanted = (1 - f) * wanted + f * sides.given(first, above);
        }
        n_filled += below < p ? 1 : 0;
        ASSERT_LE(norm(c[first + p] - wanted), 1e-14) << seed << " " << p;
      }
    });
  }
  EXPECT_GT(n_filled, 1000);
}

}  // namespace
}  // namespace gridmorph::test
