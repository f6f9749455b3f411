// Whether tests that offer it take smaller meshes or fewer cases: set for sanitizer runs.
#pragma once

#include <cstdlib>

namespace gridmorph::test {

inline bool reduced() { return std::getenv("GRIDMORPH_TEST_REDUCED") != nullptr; }

}  // namespace gridmorph::test
