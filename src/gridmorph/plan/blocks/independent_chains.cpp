#include <gridmorph/plan/blocks/independent_chains.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {
namespace {

std::uint64_t hash(std::vector<int> const& numbers) {
  std::uint64_t h = 14695981039346656037ull;
  for (int n : numbers) {
    h ^= std::uint64_t(n) + 1;
    h *= 1099511628211ull;
  }
  return h;
}

}  // namespace

bool IndependentChains::add(Chain const& chain, bool directed) {
  Lattice const& lattice = topology_.lattice;
  ChainLayout const layout = lay_out(topology_, chain);
  std::unordered_map<int, std::uint64_t> fresh;
  // Every line of entities of the cross-section's lattice, from the first end to the last.
  for (int ib = 0; ib <= 2 * layout.n[2]; ++ib)
    for (int ia = 0; ia <= 2 * layout.n[1]; ++ia) {
      int const pa = std::min(ia / 2, layout.n[1] - 1), pb = std::min(ib / 2, layout.n[2] - 1);
      int const ca = ia - 2 * pa, cb = ib - 2 * pb;
      std::vector<int> line;
      for (int is = 0; is <= 2 * layout.n[0]; ++is) {
        int const ps = std::min(is / 2, layout.n[0] - 1);
        line.push_back(lattice.class_of(chain_entity(lattice, layout.at(ps, pa, pb), {is - 2 * ps, ca, cb})));
      }
      std::vector<int> sorted = line;
      if (!directed) std::sort(sorted.begin(), sorted.end());
      std::uint64_t const key = hash(sorted);
      for (int c : line) {
        if (known_(c)) continue;
        if (auto const it = line_of_class_.find(c); it != line_of_class_.end() && it->second != key) return false;
        fresh.try_emplace(c, key);
      }
    }
  line_of_class_.merge(fresh);
  return true;
}

}  // namespace gridmorph
