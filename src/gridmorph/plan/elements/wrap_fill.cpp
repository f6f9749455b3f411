#include <gridmorph/plan/elements/wrap_cells.hpp>

#include <algorithm>

namespace gridmorph::detail {
namespace {

class Filler {
 public:
  Filler(Coordinates const& coordinates, LatticeBox const& domain, Wrap& wrap)
      : coordinates_(coordinates), wrap_(wrap) {
    for (int a = 0; a < 3; ++a) {
      auto const s = std::size_t(a);
      first_[s] = a < wrap.dimension ? wrap.interval(a, domain.low[s]) : 0;
      last_[s] = a < wrap.dimension ? wrap.interval(a, domain.high[s]) : 0;
    }
  }

  void run() {
    close_gaps();
    for (bool more = true; more;) {
      more = fill_dents();
      more = join_contacts() || more;
      more = fill_hollows() || more;
    }
  }

 private:
  /// Ends of the mesh that the wrap reaches count as wrapped: what is left between them and the wrap is a gap or a dent
  /// too.
  [[nodiscard]] bool wrapped(Index3 const& c) const {
    for (std::size_t a = 0; a < std::size_t(wrap_.dimension); ++a)
      if ((c[a] < 0 && wrap_.reaches[a][0]) || (c[a] >= wrap_.cells(int(a)) && wrap_.reaches[a][1])) return true;
    return wrap_.is_inside(c);
  }
  bool add(Index3 const& c) {
    if (wrap_.is_outermost(c) || wrap_.is_inside(c)) return false;
    wrap_.inside[wrap_.cell(c)] = 1;
    return true;
  }
  static Index3 shifted(Index3 c, int axis, int by) {
    c[axis] += by;
    return c;
  }

  /// Cells with the wrap on both sides along an axis, all at once: the result does not depend on their order.
  void close_gaps() {
    std::vector<Index3> gaps;
    for (Index n = 0; n < wrap_.n_cells(); ++n) {
      Index3 const c = wrap_.index(n);
      if (wrap_.is_outermost(c) || wrap_.is_inside(c)) continue;
      for (int a = 0; a < wrap_.dimension; ++a)
        if (wrapped(shifted(c, a, -1)) && wrapped(shifted(c, a, 1)) && size(c, a) < 1.6 * wrap_.spacing) {
          gaps.push_back(c);
          break;
        }
    }
    for (Index3 const& c : gaps) add(c);
  }

  [[nodiscard]] double size(Index3 const& c, int axis) const {
    LatticeBox const box = wrap_.box(c);
    return box.high[axis] - box.low[axis];
  }

  /// Cells with the wrap on all sides but two (one in 2-D), in rounds.
  bool fill_dents() {
    bool changed = false;
    std::vector<Index3> dents;
    do {
      dents.clear();
      for (Index n = 0; n < wrap_.n_cells(); ++n) {
        Index3 const c = wrap_.index(n);
        if (wrap_.is_outermost(c) || wrap_.is_inside(c)) continue;
        int sides = 0;
        for (int a = 0; a < wrap_.dimension; ++a)
          sides += int(wrapped(shifted(c, a, -1))) + int(wrapped(shifted(c, a, 1)));
        if (sides > wrap_.dimension) dents.push_back(c);
      }
      for (Index3 const& c : dents) changed = add(c) || changed;
    } while (!dents.empty());
    return changed;
  }

  /// Around every inner node of the lattice the cells inside must hang together through faces, and so must those
  /// outside.
  bool join_contacts() {
    bool changed = false;
    int const top = wrap_.dimension == 2 ? 0 : wrap_.cells(2) - 1, height = wrap_.dimension == 2 ? 1 : 2;
    for (int k = 0; k <= (height == 1 ? top : top - 1); ++k)
      for (int j = 0; j + 1 < wrap_.cells(1); ++j)
        for (int i = 0; i + 1 < wrap_.cells(0); ++i) {
          unsigned inside = 0;
          for (int n = 0; n < 4 * height; ++n)
            inside |= unsigned(wrap_.is_inside({i + (n & 1), j + (n >> 1 & 1), k + (n >> 2)})) << n;
          unsigned const all = height == 1 ? 0xFu : 0xFFu;
          if (connected(inside) && connected(all & ~inside)) continue;
          for (int n = 0; n < 4 * height; ++n)
            if (joins(inside, n)) changed = add({i + (n & 1), j + (n >> 1 & 1), k + (n >> 2)}) || changed;
        }
    return changed;
  }

  /// Cell n of the eight around a node (bits of n: place along x, y, z): neighbours differ in one bit.
  static bool connected(unsigned cells) {
    if (cells == 0) return true;
    unsigned seen = cells & (~cells + 1u);
    for (unsigned before = 0; before != seen;) {
      before = seen;
      for (unsigned n = 0; n < 8; ++n)
        if ((seen >> n & 1u) != 0)
          for (unsigned const step : {1u, 2u, 4u}) seen |= cells & (1u << (n ^ step));
    }
    return seen == cells;
  }
  /// Which cells to add: those with two neighbours inside, which join contacts along edges; all of them where there are
  /// none.
  static bool joins(unsigned inside, int cell) {
    auto neighbours = [&](unsigned n) {
      return (inside >> (n ^ 1u) & 1u) + (inside >> (n ^ 2u) & 1u) + (inside >> (n ^ 4u) & 1u);
    };
    bool any = false;
    for (unsigned n = 0; n < 8; ++n) any = any || ((inside >> n & 1u) == 0 && neighbours(n) >= 2);
    return !any || neighbours(unsigned(cell)) >= 2;
  }

  /// Parts of the outside, within the limits of the mesh, that are closed off.
  bool fill_hollows() {
    std::vector<int> part(wrap_.n_cells(), -1);
    std::vector<char> open, at_limit;
    std::vector<Index> stack;
    for (Index seed = 0; seed < wrap_.n_cells(); ++seed) {
      if (!takes_part(wrap_.index(seed)) || part[seed] >= 0) continue;
      int const number = int(open.size());
      open.push_back(0);
      at_limit.push_back(0);
      part[seed] = number;
      stack.push_back(seed);
      while (!stack.empty()) {
        Index3 const c = wrap_.index(stack.back());
        stack.pop_back();
        // Outermost cells stay free: what reaches them is no hollow.
        if (wrap_.is_outermost(c)) open.back() = 1;
        for (int a = 0; a < wrap_.dimension; ++a)
          for (int const by : {-1, 1}) {
            auto const s = std::size_t(a);
            Index3 const next = shifted(c, a, by);
            if (next[s] < first_[s] || next[s] > last_[s]) {
              at_limit.back() = 1;
              continue;
            }
            Index const n = wrap_.cell(next);
            if (wrap_.is_inside(next) || part[n] >= 0) continue;
            part[n] = number;
            stack.push_back(n);
          }
      }
    }
    find_nodes(part, at_limit, open);
    bool changed = false;
    for (Index n = 0; n < wrap_.n_cells(); ++n)
      if (part[n] >= 0 && open[part[n]] == 0) changed = add(wrap_.index(n)) || changed;
    return changed;
  }

  [[nodiscard]] bool takes_part(Index3 const& c) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (c[a] < first_[a] || c[a] > last_[a]) return false;
    return !wrap_.is_inside(c);
  }

  /// Opens the parts at the limits of the mesh that nodes lie in.
  void find_nodes(std::vector<int> const& part, std::vector<char> const& at_limit, std::vector<char>& open) const {
    Index missing = 0;
    for (std::size_t p = 0; p < open.size(); ++p) missing += at_limit[p] != 0 && open[p] == 0 ? 1 : 0;
    for (Index n = 0; n < coordinates_.size() && missing > 0; ++n) {
      int const p = part[wrap_.cell(wrap_.find(coordinates_[n]))];
      if (p < 0 || at_limit[p] == 0 || open[p] != 0) continue;
      open[p] = 1;
      --missing;
    }
  }

  Coordinates const& coordinates_;
  Wrap& wrap_;
  Index3 first_{}, last_{};  ///< cells that the box of the mesh meets
};

}  // namespace

void fill(Coordinates const& coordinates, LatticeBox const& domain, Wrap& wrap) {
  Filler(coordinates, domain, wrap).run();
}

}  // namespace gridmorph::detail
