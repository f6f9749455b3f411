// Spacings of background meshes.
#pragma once

#include <vector>

namespace gridmorph::detail {

/// Places from 0 to `length` whose spacing is about `first` at the beginning and grows by `growth` a step.
std::vector<double> growing(double length, double first, double growth);

}  // namespace gridmorph::detail
