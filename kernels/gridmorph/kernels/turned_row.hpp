// What line ends that turn add to a row of nodes inside a chain: turned_line.hpp, as terms that loops over rows sum up.
#pragma once

#include <gridmorph/kernels/fused_row.hpp>
#include <gridmorph/kernels/turned_line.hpp>

#include <type_traits>

namespace gridmorph::kernels {

/// The ends of a row's lines on one side: that of node w is `first` + w step; one for all, read once, where the
/// compiler knows that the step is none.
template <class Step>
struct RowOfTurns {
  TurnedEnds<double const> ends;
  Index first;
  Step step;
  KOKKOS_FORCEINLINE_FUNCTION TurnedEnd<Vec3> at(int w) const { return ends[first + w * step]; }
};
template <>
struct RowOfTurns<Constant<0>> {
  TurnedEnd<Vec3> end;
  KOKKOS_INLINE_FUNCTION RowOfTurns(TurnedEnds<double const> const& ends, Index first, Constant<0>)
      : end(ends[first]) {}
  KOKKOS_FORCEINLINE_FUNCTION TurnedEnd<Vec3> const& at(int) const { return end; }
};

/// What one rotation for both ends adds to node w, which is at x in the frame of the chain. outer: whether the upper
/// ends turn too.
template <bool outer, class Weight, class Step>
struct TurnAsOne {
  RowOfTurns<Step> wall, edge;
  double const* t;
  Weight weight;
  KOKKOS_FORCEINLINE_FUNCTION Vec3 at(int w, Vec3 const& x) const {
    using Q = Quaternion<Vec3>;
    double const f = weight(t[w]);
    auto const& from = wall.at(w);
    return turned_as_one(outer ? Q::between(edge.at(w).q, from.q, f) : Q::share(from.q, f), from, f, x);
  }
};

/// What one of two ends adds that turn each by itself.
template <class Weight, class Step>
struct TurnOfEnd {
  RowOfTurns<Step> end;
  double const* t;
  Weight weight;
  KOKKOS_FORCEINLINE_FUNCTION Vec3 at(int w, Vec3 const& x) const {
    auto const& e = end.at(w);
    return Quaternion<Vec3>::share(e.q, weight(t[w])).turned(x - e.pivot);
  }
};

/// The rate of what both ends add.
template <class Step>
struct TurnRate {
  TurnedEndsWithRates ends;
  Chain const& chain;
  Index lower;
  double const* t;
  Step step;
  GRIDMORPH_CALLED_ON_HOST KOKKOS_FUNCTION Vec3 at(int w, Vec3 const& x) const {
    Index const at = lower + w * step;
    return turned_between<DualVec3>(ends, chain, at, at + chain.section_size(), t[w], x).rate;
  }
};

/// Calls body(term) with the turn of lines that have one for both ends, by a law.
template <class Weight, class Step, class Body>
KOKKOS_FORCEINLINE_FUNCTION void with_turn_as_one(TurnedEnds<double const> const& ends, Chain const& chain,
                                                  RowEnds const& row, Weight const& weight, Step step,
                                                  Body const& body) {
  RowOfTurns<Step> const wall{ends, row.lower, step}, edge{ends, row.lower + row.section, step};
  if (chain.turned_ends & 2u)
    body(TurnAsOne<true, Weight, Step>{wall, edge, row.t, weight});
  else
    body(TurnAsOne<false, Weight, Step>{wall, edge, row.t, weight});
}
/// The same of lines of the near field.
template <class Step, class Body>
KOKKOS_FORCEINLINE_FUNCTION void with_turn_near_wall(TurnedEnds<double const> const& ends, Chain const& chain,
                                                     RowEnds const& row, Step step, Body const& body) {
  with_turn_as_one(
      ends, chain, row, [](double t) { return near_field_weight(t); }, step, body);
}

/// Calls body(law) with how the turn of an end fades where the other end has its own, and of the first end where they
/// have one in common: law(t). All laws of two rotations are the same from both ends.
template <class Body>
KOKKOS_FORCEINLINE_FUNCTION void with_turn_law(Chain const& chain, unsigned end, Body const& body) {
  double const from = end, sign = end == 0 ? 1 : -1;
  if (chain.turn == TurnLaw::far)
    body([law = FarLaw(chain), from, sign](double t) { return law(from + sign * t); });
  else if (chain.turn == TurnLaw::square)
    body([from, sign](double t) { return (1 - from - sign * t) * (1 - from - sign * t); });
  else
    body([from, sign](double t) { return 1 - law_weight(LineLaw::c1, from + sign * t); });
}

/// Calls body(term) for each term that the ends of a row's lines add by their turns, in the order of the sum: a loop
/// per law, so that none has a choice in it. Step: RowEnds::step.
template <class Step, class Body>
KOKKOS_INLINE_FUNCTION void with_turns(TurnedEndsWithRates const& ends, Chain const& chain, RowEnds const& row,
                                       Step step, Body const& body) {
  if (ends.has_rates()) {
    body(TurnRate<Step>{ends, chain, row.lower, row.t, step});
  } else if (turns_as_one(chain)) {
    if (chain.turn == TurnLaw::near_field)
      with_turn_near_wall(ends.values, chain, row, step, body);
    else
      with_turn_as_one(
          ends.values, chain, row, [](double t) { return 1 - law_weight(LineLaw::c1, t); }, step, body);
  } else {
    for (unsigned end = 0; end < 2; ++end) {
      if ((chain.turned_ends & (1u + end)) == 0) continue;
      with_turn_law(chain, end, [&](auto const& law) {
        RowOfTurns<Step> const turned{ends.values, row.lower + Index(end) * row.section, step};
        body(TurnOfEnd<std::decay_t<decltype(law)>, Step>{turned, row.t, law});
      });
    }
  }
}

}  // namespace gridmorph::kernels
