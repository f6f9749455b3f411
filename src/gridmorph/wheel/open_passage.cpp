#include <gridmorph/wheel/open_passage.hpp>

#include <gridmorph/core/error.hpp>

#include <set>

namespace gridmorph {

namespace {

bool is_explicit(Rule const& rule) {
  return !std::holds_alternative<SlipRule>(rule) && !std::holds_alternative<FreeRule>(rule);
}

}  // namespace

OpenedPassage open_passage(Mesh const& sector, Links const& links, WheelRows const& rows, ResolvedMotion const& motion,
                           std::vector<char> const& open) {
  OpenedPassage out{sector, motion};
  auto const opened = [&](int zone) { return open[rows.row_of_zone[zone]] != 0; };

  out.mesh.interfaces.clear();
  out.motion.interface.clear();
  for (std::size_t f = 0; f < sector.interfaces.size(); ++f) {
    if (sector.interfaces[f].periodic && opened(sector.interfaces[f].zone)) continue;
    out.mesh.interfaces.push_back(sector.interfaces[f]);
    out.motion.interface.push_back(motion.interface[f]);
  }

  Problems problems;
  std::set<int> reported;
  for (Link const& link : links.all) {
    if (!link.periodic || !opened(link.zone)) continue;
    Interface1to1 const& face = sector.interfaces[link.interface];
    int const rule = motion.interface[link.interface].rule;
    if (rule < 0 || !is_explicit(motion.rules[rule].rule)) {
      if (reported.insert(link.interface).second)
        problems.add("periodic interface '" + face.name + "' (" + describe_range(sector, face.zone, face.range) +
                     ") lies between passages with different blades, and no rule says how it moves; give it the rule "
                     "follow (patches = [\"type:periodic\"], rule = \"follow\", of = the blade) or fixed");
      continue;
    }
    out.mesh.patches.push_back({face.name, "UserDefined", PatchKind::periodic, face.families, link.zone, link.range});
    out.motion.patch.push_back(motion.interface[link.interface]);
  }
  problems.throw_if_any<MotionError>();

  for (MotionRule& rule : out.motion.rules)
    if (std::holds_alternative<FollowRule>(rule.rule) || std::holds_alternative<CircumferentialSlideRule>(rule.rule))
      rule.rule = FunctionRule{std::string(rule_name(rule.rule)), {}};
  return out;
}

}  // namespace gridmorph
