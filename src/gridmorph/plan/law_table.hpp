// Laws of the user's own as kernels read them: cubics between evenly spaced knots.
#pragma once

#include <gridmorph/plan/options.hpp>

#include <vector>

namespace gridmorph {

/// w and (dw/dt) / n at the n + 1 knots t = m / n, one after another (kernels::table_weight()).
struct LawTable {
  std::vector<double> knots;
  int n_intervals = 0;
  double error = 0;  ///< largest distance from the law itself at the three quarters of every interval
};

/// The table of a law: between knots the cubic with the law's values and slopes there (Hermite); slopes by differences
/// of fourth order over a quarter of an interval. n is doubled from 64 until the table is within 1e-12 of the law, up
/// to 4096: laws without kinks are met to max |d4w/dt4| / (384 n^4), cubics to round-off; around a kink the error falls
/// as 1 / n. Throws PlanError where w is not finite, where w(0) is not 0 or w(1) not 1 to 1e-12, and where there is no
/// function. Cost: 4 n calls of the law.
LawTable tabulate(OwnLaw const& law);

}  // namespace gridmorph
