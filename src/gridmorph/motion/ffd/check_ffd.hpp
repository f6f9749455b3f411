// Whether the numbers of an ffd rule make a lattice.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/ffd_rule.hpp>

#include <cstddef>
#include <string>

namespace gridmorph {

/// The number of control points that a lattice may have.
inline constexpr std::size_t most_control_points = 1'000'000;

/// Adds what is wrong with a rule before any mesh is looked at; `name` begins every message.
void check_ffd(FfdRule const& rule, std::string const& name, Problems& problems);

}  // namespace gridmorph
