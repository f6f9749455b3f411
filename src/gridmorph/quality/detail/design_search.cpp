#include <gridmorph/quality/detail/design_search.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace gridmorph::detail {
namespace {

using kernels::CellFrame;
using kernels::CellLengths;
using kernels::Coefficients;
using kernels::ElementCorners;
using kernels::FactorSizes;
using kernels::JacobianFactors;
using kernels::ProductTable;

/// The most branches that are looked into for one piece.
constexpr int most_branches = 20000;

/// A box of designs and a part of the cell, its parameters from `low` to `high`.
struct Piece {
  std::vector<double> centre, half;
  double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
};

/// The element that the given part of an element is: a map that is linear along each direction is so on its parts.
template <ElementType type>
ElementCorners part_of(ElementCorners const& c, double const (&low)[3], double const (&high)[3]) {
  ElementCorners out = c;
  auto const between = [](Vec3 const& a, Vec3 const& b, double t) { return (1 - t) * a + t * b; };
  if constexpr (type == ElementType::prism) {
    for (int k = 0; k < 3; ++k) {
      out.at[k] = between(c.at[k], c.at[k + 3], low[2]);
      out.at[k + 3] = between(c.at[k], c.at[k + 3], high[2]);
    }
  } else if constexpr (type == ElementType::pyramid || type == ElementType::hexahedron) {
    for (int n = 0; n < (type == ElementType::pyramid ? 4 : 8); ++n) {
      double const u = n % 4 == 1 || n % 4 == 2 ? high[0] : low[0], v = n % 4 >= 2 ? high[1] : low[1];
      auto const in_level = [&](int first) {
        return between(between(c.at[first], c.at[first + 1], u), between(c.at[first + 3], c.at[first + 2], u), v);
      };
      if constexpr (type == ElementType::pyramid)
        out.at[n] = in_level(0);
      else
        out.at[n] = between(in_level(0), in_level(4), n >= 4 ? high[2] : low[2]);
    }
  }
  return out;
}

template <ElementType type>
void add(JacobianFactors& to, double times, JacobianFactors const& f) {
  constexpr ProductTable table = kernels::product_table(type);
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < table.count[kind]; ++n) to.of[kind][n] += times * f.of[kind][n];
}

/// What bounds the coefficients of a cell over a piece.
template <ElementType type>
class PieceBounds {
 public:
  static constexpr ProductTable table = kernels::product_table(type);

  PieceBounds(DesignCell const& cell, Piece const& piece) : cell_(cell), piece_(piece), n_(int(piece.centre.size())) {
    ElementCorners const x = part_of<type>(cell.corners(piece.centre), piece.low, piece.high);
    JacobianFactors const at_centre = kernels::jacobian_factors<type>(x, cell.plane_normal);
    frame_ = kernels::cell_frame<type>(at_centre, cell.sign);
    if (!(frame_.size > 0)) return;
    centre_ = kernels::in_frame<type>(frame_, at_centre);
    CellLengths lengths;
    lengths.add<type>(at_centre, x, 1);
    JacobianFactors change, own;
    for (int i = 0; i < n_; ++i) {
      ElementCorners const d = part_of<type>(cell.modes[i], piece.low, piece.high);
      JacobianFactors f = kernels::jacobian_factors<type>(d, Vec3{});
      lengths.add<type>(f, d, piece.half[i]);
      JacobianFactors scaled{};
      add<type>(scaled, piece.half[i], kernels::in_frame<type>(frame_, f));
      kernels::add_sizes<type>(scaled, change);
      modes_.push_back(scaled);
    }
    kernels::add_sizes<type>(centre_, own);
    live_ = kernels::live_coefficients<type>(own, change, 1);
    margin_ = lengths.margin<type>(cell.deviation) / frame_.size;
    FactorSizes const size = kernels::largest_sizes<type>(own), most = kernels::largest_sizes<type>(change);
    at_centre_ = kernels::jacobian_coefficients<type>(centre_);
    Coefficients sum{};
    for (int i = 0; i < n_; ++i) {
      slope_.push_back(kernels::coefficient_slopes<type>(centre_, modes_[i]));
      for (int c = 0; c < table.n_coefficients; ++c) sum.of[c] += std::abs(slope_[i].of[c]);
    }
    double const higher = kernels::first_order(most, size) + kernels::third_order(most);
    valid_ = true;
    for_each_live([&](int c) { valid_ = valid_ && at_centre_.of[c] - sum.of[c] - higher > margin_; });
    if (!valid_) bound_slopes(size, most);
  }

  /// Whether J is positive in the middle of the part at the centre of the box, without which nothing is known.
  [[nodiscard]] bool defined() const { return frame_.size > 0; }
  /// Whether the bounds of the first kind were enough.
  [[nodiscard]] bool valid() const { return valid_; }

  /// Follows branches until one is found where the bounds do not hold.
  DesignAnswer::Kind follow() {
    signs_.assign(n_, 0);
    left_ = most_branches;
    failed_ = -1;
    return branch(0, centre_);
  }
  /// The design of the branch that was looked at last.
  [[nodiscard]] std::vector<double> design() const {
    std::vector<double> t = piece_.centre;
    for (int i = 0; i < n_; ++i) t[i] += signs_[i] * piece_.half[i];
    return t;
  }

  /// Cuts the piece in two where that may help: `piece` becomes one half, the other is returned.
  std::optional<Piece> cut(Piece& piece) const {
    int parameter = failed_ < 0 ? order_[0] : -1;
    double most = 0;
    for (int i = 0; failed_ >= 0 && i < n_; ++i)
      if (sag_[i].of[failed_] > most) {
        most = sag_[i].of[failed_];
        parameter = i;
      }
    if (failed_ >= 0 && !(value_ > margin_)) {  // the coefficient itself, whatever the bounds
      parameter = -1;
      int axis = -1;
      for (int a = 0; a < 3; ++a)
        if ((table.amid[failed_] >> a & 1u) != 0 &&
            (axis < 0 || piece.high[a] - piece.low[a] > piece.high[axis] - piece.low[axis]))
          axis = a;
      if (axis < 0) return std::nullopt;
      Piece upper = piece;
      upper.low[axis] = piece.high[axis] = 0.5 * (piece.low[axis] + piece.high[axis]);
      return upper;
    }
    if (parameter < 0) return std::nullopt;
    Piece upper = piece;
    piece.half[parameter] = upper.half[parameter] = 0.5 * piece.half[parameter];
    upper.centre[parameter] += upper.half[parameter];
    piece.centre[parameter] -= piece.half[parameter];
    return upper;
  }

 private:
  template <class Use>
  void for_each_live(Use const& use) const {
    for (int c = 0; c < table.n_coefficients; ++c)
      if ((live_ >> c & 1u) != 0) use(c);
  }

  /// What slopes change by over the piece, and how far coefficients may lie below what they are in a branch.
  void bound_slopes(FactorSizes const& size, FactorSizes const& most) {
    FactorSizes const all = sum(size, most);
    std::vector<double> influence(n_, 0), change(n_, 0);
    sag_.assign(n_, Coefficients{});
    for (int i = 0; i < n_; ++i) {
      JacobianFactors sizes;
      kernels::add_sizes<type>(modes_[i], sizes);
      FactorSizes const own = kernels::largest_sizes<type>(sizes);
      // One factor of the mode and two of any design, less those of the centre.
      change[i] = kernels::first_order(all, own) - kernels::first_order(size, own);
      Coefficients bends{};
      bool bends_known = false;
      double const rest = kernels::first_order(own, most);
      for_each_live([&](int c) {
        double const slope = std::abs(slope_[i].of[c]);
        influence[i] = std::max(influence[i], slope);
        double const least = std::max(0.0, slope - change[i]);
        if (!bends_known) bends = kernels::coefficient_bends<type>(centre_, modes_[i]);
        bends_known = true;
        double const bend = bends.of[c] + rest;
        if (!(bend > 0) || least >= 2 * bend) return;
        double const beyond = 1 - least / (2 * bend);
        sag_[i].of[c] = bend * beyond * beyond;
      });
    }
    order_.resize(n_);
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return influence[a] > influence[b]; });
    // Between the corners of a branch b is less by what parameters can do that are not set yet, and by what it sags
    // along those that are.
    below_.assign(n_ + 1, Coefficients{});
    for (int c = 0; c < table.n_coefficients; ++c) {
      for (int d = n_ - 1; d >= 0; --d)
        below_[d].of[c] = below_[d + 1].of[c] + std::abs(slope_[order_[d]].of[c]) + change[order_[d]];
      double sags = 0;
      for (int d = 0; d < n_; ++d) {
        sags += sag_[order_[d]].of[c];
        below_[d + 1].of[c] += sags;
      }
    }
  }
  static FactorSizes sum(FactorSizes const& a, FactorSizes const& b) {
    return {{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2]}};
  }
  DesignAnswer::Kind branch(int depth, JacobianFactors const& e) {
    if (left_-- == 0) {
      failed_ = -1;
      return DesignAnswer::Kind::undecided;
    }
    Coefficients const b = kernels::jacobian_coefficients<type>(e);
    int worst = -1;
    double least = 0;
    bool negative = false;
    for_each_live([&](int c) {
      double const above = b.of[c] - below_[depth].of[c] - margin_;
      if (!(above > 0) && (worst < 0 || above < least)) {
        worst = c;
        least = above;
      }
      negative = negative || (table.is_value[c] && b.of[c] < 0);
    });
    if (negative && cell_.broken_at(design())) return DesignAnswer::Kind::broken;
    if (worst < 0) return DesignAnswer::Kind::valid;
    if (depth == n_) {
      failed_ = worst;
      value_ = b.of[worst];
      return DesignAnswer::Kind::undecided;
    }
    int const i = order_[depth];
    signed char const first = slope_[i].of[worst] > 0 ? -1 : 1;
    for (signed char const s : {first, static_cast<signed char>(-first)}) {
      signs_[i] = s;
      JacobianFactors next = e;
      add<type>(next, s, modes_[i]);
      DesignAnswer::Kind const found = branch(depth + 1, next);
      if (found != DesignAnswer::Kind::valid) return found;
    }
    signs_[i] = 0;
    return DesignAnswer::Kind::valid;
  }

  DesignCell const& cell_;
  Piece const& piece_;
  int n_;
  CellFrame frame_;
  JacobianFactors centre_;
  std::vector<JacobianFactors> modes_;  ///< times the half widths
  std::uint32_t live_ = 0;
  double margin_ = 0, value_ = 0;
  Coefficients at_centre_{};
  std::vector<Coefficients> slope_, sag_, below_;  ///< below_[d]: where d parameters are set
  std::vector<int> order_;
  std::vector<signed char> signs_;
  bool valid_ = false;
  int left_ = 0, failed_ = -1;
};

double size_of(std::vector<double> const& t) {
  double size = 0;
  for (double const v : t) size = std::max(size, std::abs(v));
  return size;
}

std::vector<double> times(double s, std::vector<double> t) {
  for (double& v : t) v *= s;
  return t;
}

/// The first broken design along the ray from the centre to `direction`, which has size 1, up to `limit`.
BrokenCell along_ray(DesignCell const& cell, std::vector<double> const& direction, double limit) {
  constexpr int steps = 32, halvings = 40;
  double sound = 0;
  for (int n = 1; n <= steps; ++n) {
    double broken = limit * n / steps;
    if (!cell.broken_at(times(broken, direction))) {
      sound = broken;
      continue;
    }
    for (int h = 0; h < halvings && broken - sound > 1e-9 * broken; ++h) {
      double const middle = 0.5 * (sound + broken);
      (cell.broken_at(times(middle, direction)) ? broken : sound) = middle;
    }
    // A little beyond, where what the certificate says does not hang on the rounding of coordinates.
    double const beyond = std::min(limit, broken * (1 + 1e-6));
    if (cell.broken_at(times(beyond, direction))) broken = beyond;
    return {broken, times(broken, direction)};
  }
  return {};
}

/// The coefficient that is negative first, or smallest, at t, and its slopes there.
template <ElementType type>
std::vector<double> way_down(DesignCell const& cell, std::vector<double> const& t, bool by_slopes) {
  constexpr ProductTable table = kernels::product_table(type);
  JacobianFactors const e = kernels::jacobian_factors<type>(cell.corners(t), cell.plane_normal);
  Coefficients const b = kernels::jacobian_coefficients<type>(e);
  std::vector<Coefficients> slopes;
  Coefficients sum{};
  for (auto const& mode : cell.modes) {
    slopes.push_back(kernels::coefficient_slopes<type>(e, kernels::jacobian_factors<type>(mode, Vec3{})));
    for (int c = 0; c < table.n_coefficients; ++c) sum.of[c] += std::abs(slopes.back().of[c]);
  }
  int worst = 0;
  double least = kernels::unbounded;
  for (int c = 0; c < table.n_coefficients; ++c) {
    double const value =
        by_slopes ? (sum.of[c] > 0 ? cell.sign * b.of[c] / sum.of[c] : kernels::unbounded) : cell.sign * b.of[c];
    if (!table.is_value[c] || !(value < least)) continue;
    worst = c;
    least = value;
  }
  std::vector<double> way(cell.modes.size(), 0);
  for (std::size_t i = 0; i < way.size(); ++i) {
    double const slope = cell.sign * slopes[i].of[worst];
    way[i] = slope > 0 ? -1 : slope < 0 ? 1 : 0;
  }
  return way;
}

template <ElementType type>
BrokenCell look_for_broken(DesignCell const& cell, double limit) {
  constexpr int most_turns = 6;
  BrokenCell best;
  std::vector<double> const centre(cell.modes.size(), 0);
  std::vector<double> way = way_down<type>(cell, centre, true);
  for (int turn = 0; turn < most_turns && size_of(way) > 0; ++turn) {
    double const within = std::min(limit, best.scale);
    BrokenCell const found = along_ray(cell, way, within);
    if (found.found() && found.scale < best.scale) best = found;
    std::vector<double> const next = way_down<type>(cell, times(found.found() ? found.scale : within, way), false);
    if (next == way) break;
    way = next;
  }
  return best;
}

template <ElementType type>
DesignAnswer search(DesignCell const& cell, double scale, int most_pieces) {
  std::size_t const n = cell.modes.size();
  std::vector<Piece> stack{{std::vector<double>(n, 0), std::vector<double>(n, scale), {0, 0, 0}, {1, 1, 1}}};
  DesignAnswer answer;
  while (!stack.empty()) {
    Piece piece = std::move(stack.back());
    stack.pop_back();
    if (++answer.pieces > most_pieces) return answer;
    PieceBounds<type> bounds(cell, piece);
    DesignAnswer::Kind kind = DesignAnswer::Kind::undecided;
    std::vector<double> design = piece.centre;
    if (bounds.defined()) {
      if (bounds.valid()) continue;
      kind = bounds.follow();
      if (kind == DesignAnswer::Kind::valid) continue;
      design = bounds.design();
    } else if (cell.broken_at(design)) {
      kind = DesignAnswer::Kind::broken;
    }
    if (kind == DesignAnswer::Kind::broken) {
      answer.kind = kind;
      double const size = size_of(design);
      answer.broken = {size, design};
      if (size > 0) {
        BrokenCell const nearer = along_ray(cell, times(1 / size, design), size);
        if (nearer.found()) answer.broken = nearer;
      }
      return answer;
    }
    if (!bounds.defined()) return answer;
    Piece lower = piece;
    std::optional<Piece> upper = bounds.cut(lower);
    if (!upper) return answer;
    stack.push_back(std::move(*upper));
    stack.push_back(std::move(lower));
  }
  answer.kind = DesignAnswer::Kind::valid;
  return answer;
}

}  // namespace

ElementCorners DesignCell::corners(std::vector<double> const& t) const {
  ElementCorners out = x;
  for (std::size_t i = 0; i < modes.size(); ++i)
    for (int k = 0; k < n_corners(type); ++k) out.at[k] += t[i] * modes[i].at[k];
  return out;
}

kernels::JacobianSign DesignCell::sign_at(std::vector<double> const& t) const {
  return kernels::jacobian_sign(type, corners(t), sign, plane_normal);
}

BrokenCell look_for_broken_design(DesignCell const& cell, double limit) {
  return kernels::with_element_type(cell.type, [&]<ElementType type>() { return look_for_broken<type>(cell, limit); });
}

DesignAnswer search_designs(DesignCell const& cell, double scale, int most_pieces) {
  return kernels::with_element_type(cell.type,
                                    [&]<ElementType type>() { return search<type>(cell, scale, most_pieces); });
}

}  // namespace gridmorph::detail
