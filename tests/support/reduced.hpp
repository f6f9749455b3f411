// Whether tests that offer it take smaller meshes or fewer cases: set for sanitizer runs.
#pragma once

#include <cstdlib>

namespace gridmorph::test {

/// What takes tens of seconds and is not run every day: scripts/test --all asks for it.
inline bool everything() { return std::getenv("GRIDMORPH_TEST_ALL") != nullptr; }
inline bool reduced() { return std::getenv("GRIDMORPH_TEST_REDUCED") != nullptr; }

}  // namespace gridmorph::test
