// What no rule names moves freely across periodic sides, as a note says. Internal to motion.
#pragma once

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/motion/motion.hpp>

#include <set>
#include <string>
#include <vector>

namespace gridmorph::detail {

/// Names of the periodic connections that move freely because no rule names them, each once.
inline std::vector<std::string> free_by_default(std::vector<AnyConnection> const& connections,
                                                ResolvedMotion const& motion) {
  std::set<std::string> names;
  for (AnyConnection const& c : connections)
    if (motion.interface[c.number].by_default) names.insert(c.families.empty() ? c.name : c.families.front());
  return {names.begin(), names.end()};
}

/// What notes say of `what` that no rule names.
inline std::string default_note(std::string const& what, std::vector<std::string> const& names,
                                std::string const& decision) {
  return what + " " + quote_list(names) + ": no rule names them; default: " + decision;
}

inline constexpr char const* periodics = "periodic interfaces";
inline constexpr char const* move_as_one = "both copies move freely as one";

}  // namespace gridmorph::detail
