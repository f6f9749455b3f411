// Node distributions on [0, 1]. Internal to the demo meshes.
#pragma once

#include <vector>

namespace gridmorph::demo {

/// n cells in geometric progression, the first one `first` long; uniform when first >= 1/n. Nodes 0 ... n.
std::vector<double> geometric_spacing(int n, double first);

/// n cells, symmetric, clustered at both ends: (1 + tanh(b (2 t - 1)) / tanh(b)) / 2 with b such that the first and
/// last cell are `first` long; uniform when first >= 1/n.
std::vector<double> tanh_spacing(int n, double first);

/// n cells, the first and the last one nearly this long (Vinokur 1983): u / (A + (1 - A) u) of an odd tanh u about the
/// middle, with A^2 = last / first; without the tanh when n cells of the mean of both, sqrt(first last), are longer
/// than the interval.
std::vector<double> two_sided_spacing(int n, double first, double last);

/// Length of the first of n cells in geometric progression with this growth ratio.
double first_of_geometric(int n, double growth);

}  // namespace gridmorph::demo
