#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/plan/law_table.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gridmorph {
namespace {

constexpr int per_interval = 4;

/// The values of a law at n + 1 evenly spaced places.
std::vector<double> samples(OwnLaw const& law, int n) {
  std::vector<double> w;
  for (int m = 0; m <= n; ++m) {
    double const t = double(m) / n;
    w.push_back(law.weight(t));
    if (!std::isfinite(w.back()))
      throw PlanError("law " + law.name + " is not finite at t = " + to_text(t, 6) + "; it is asked for from 0 to 1");
  }
  return w;
}

void check_ends(OwnLaw const& law) {
  constexpr double tolerance = 1e-12;
  for (double const end : {0.0, 1.0})
    if (double const w = law.weight(end); !(std::abs(w - end) <= tolerance))
      throw PlanError("law " + law.name + " is " + to_text(w, 6) + " at t = " + to_text(end, 1) +
                      "; a law is 0 at t = 0 and 1 at t = 1, so that the ends of lines are met");
}

/// Slopes times the distance between samples, by differences of fourth order.
double difference(std::vector<double> const& w, std::size_t m) {
  auto const one_sided = [&](auto const& at) {
    return (-25 * at(0) + 48 * at(1) - 36 * at(2) + 16 * at(3) - 3 * at(4)) / 12;
  };
  if (m == 0) return one_sided([&](std::size_t k) { return w[k]; });
  if (m == w.size() - 1) return -one_sided([&](std::size_t k) { return w[m - k]; });
  return (w[m - 2] - 8 * w[m - 1] + 8 * w[m + 1] - w[m + 2]) / 12;
}

LawTable table_of(std::vector<double> const& w) {
  LawTable table;
  for (std::size_t m = 0; m < w.size(); m += per_interval) {
    table.knots.push_back(w[m]);
    table.knots.push_back(per_interval * difference(w, m));
  }
  table.knots[0] = 0;
  table.knots[table.knots.size() - 2] = 1;
  table.n_intervals = int(w.size() - 1) / per_interval;
  for (std::size_t m = 0; m < w.size(); ++m) {
    double const t = double(m) / double(w.size() - 1);
    table.error =
        std::max(table.error, std::abs(kernels::table_weight(table.knots.data(), table.n_intervals, t) - w[m]));
  }
  return table;
}

}  // namespace

LawTable tabulate(OwnLaw const& law) {
  constexpr int fewest = 64, most = 4096;
  constexpr double enough = 1e-12;
  if (!law.weight) throw PlanError("a law of the user's own is asked for, and there is no function; set its weight");
  check_ends(law);
  LawTable table;
  for (int n = fewest; n <= most; n *= 2) {
    table = table_of(samples(law, per_interval * n));
    if (table.error <= enough) break;
  }
  return table;
}

}  // namespace gridmorph
