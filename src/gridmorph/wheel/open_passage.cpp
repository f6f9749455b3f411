#include <gridmorph/wheel/open_passage.hpp>

#include <gridmorph/core/error.hpp>

#include <set>

namespace gridmorph {

namespace {

bool is_explicit(Rule const& rule) {
  return !std::holds_alternative<SlipRule>(rule) && !std::holds_alternative<FreeRule>(rule);
}

/// Whether a rule looks at the row that its patches are in: the passage has lost the pitch of straight ones.
bool needs_row(Rule const& rule) {
  return std::holds_alternative<FollowRule>(rule) || std::holds_alternative<CircumferentialSlideRule>(rule) ||
         std::holds_alternative<SectionsRule>(rule) || std::holds_alternative<TargetRule>(rule);
}

}  // namespace

std::string no_rule_for_side(Mesh const& sector, PassageLink const& link) {
  return describe(sector, link) +
         " lies between passages with different blades, and no rule says how it moves; give it the rule follow "
         "(patches "
         "= [\"type:periodic\"], rule = \"follow\", of = the blade) or fixed";
}

OpenedPassage open_passage(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                           ResolvedMotion const& motion, std::vector<char> const& open) {
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
  for (PassageLink const& link : links.all) {
    if (!link.periodic || !opened(link.zone)) continue;
    Interface1to1 const& face = sector.interfaces[link.connection];
    int const rule = motion.interface[link.connection].rule;
    if (rule < 0 || !is_explicit(motion.rules[rule].rule)) {
      if (reported.insert(link.connection).second) problems.add(no_rule_for_side(sector, link));
      continue;
    }
    out.mesh.patches.push_back({face.name, "UserDefined", PatchKind::periodic, face.families, link.zone, link.range});
    out.motion.patch.push_back(motion.interface[link.connection]);
  }
  problems.throw_if_any<MotionError>();

  for (MotionRule& rule : out.motion.rules)
    if (needs_row(rule.rule)) rule.rule = FunctionRule{std::string(rule_name(rule.rule)), {}};
  return out;
}

}  // namespace gridmorph
