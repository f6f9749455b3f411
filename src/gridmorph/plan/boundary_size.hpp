// A boundary displacement has as many entries as the plan has boundary nodes.
#pragma once

#include <gridmorph/core/error.hpp>

#include <cstddef>
#include <string>

namespace gridmorph {

/// Throws ConfigError unless a boundary displacement of `given` entries fits a plan that wants `needed` of them, in the
/// order of `list`: a shorter one would be read past its end, a longer one is in some other order.
inline void require_boundary_size(char const* who, std::size_t given, std::size_t needed, char const* list) {
  if (given == needed) return;
  throw ConfigError(std::string(who) + ": the boundary displacement has " + std::to_string(given) +
                    " entries and the plan has " + std::to_string(needed) +
                    " boundary nodes; give one entry for each node of " + list + ", in that order");
}

}  // namespace gridmorph
