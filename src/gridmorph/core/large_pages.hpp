// Large arrays on large pages.
#pragma once

#include <cstddef>

namespace gridmorph {

/// Asks for 2 MiB pages where the system offers them: first touches of a large host array then cost a third, and passes
/// along k, whose steps leave the page each time, miss the translation buffers less often. Only a hint, to be given
/// before the first touch; what is too small for a large page stays as it is.
void prefer_large_pages(void* data, std::size_t bytes);

}  // namespace gridmorph
