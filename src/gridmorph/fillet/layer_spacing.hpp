// How layers of cells are spaced between a wall and where they end.
#pragma once

#include <vector>

namespace gridmorph {

/// Distances 0 ... `length` of n cells that begin with `first` and grow geometrically; evenly spaced where `first` is
/// too large for that.
std::vector<double> grown_spacing(int n, double first, double length);

/// Shares 0 ... 1 of a line: the weighted geometric means of those of two others, weight w of `b`. Ascending where both
/// are.
std::vector<double> mean_shares(std::vector<double> const& a, std::vector<double> const& b, double w);

/// Shares t as distances a t / (1 + k t) that end at `length` and begin with `first`. Ascending for any 0 < first <
/// length; multiples of the shares where `first` is not less.
std::vector<double> stretched(std::vector<double> const& shares, double first, double length);

}  // namespace gridmorph
