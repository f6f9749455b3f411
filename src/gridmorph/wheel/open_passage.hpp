// A passage of blocks whose periodic sides move independently of each other.
#pragma once

#include <gridmorph/motion/motion.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// The sector mesh with the periodic interfaces of some rows turned into patches of kind `periodic`, and the resolution
/// that goes with it: patch and rule numbers stay, the new patches follow with the rule of their interface. Rules that
/// look at their row (slide, follow, sections, target) are there as functions without a value: plans ask only whether a
/// rule is explicit. Coordinates are shared with the sector mesh.
struct OpenedPassage {
  Mesh mesh;
  ResolvedMotion motion;
};

/// open: per row. Throws MotionError naming the periodic interfaces of such rows that no rule moves beforehand.
OpenedPassage open_passage(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                           ResolvedMotion const& motion, std::vector<char> const& open);

/// What is said of a periodic side between passages with different blades that no rule moves.
std::string no_rule_for_side(Mesh const& sector, PassageLink const& link);

}  // namespace gridmorph
