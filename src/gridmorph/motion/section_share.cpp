#include <gridmorph/motion/section_share.hpp>

namespace gridmorph {

SectionsRule share_of(SectionsRule rule, double share) {
  for (SpanwiseTable* table : {&rule.chord, &rule.scale, &rule.thickness, &rule.twist_rad, &rule.stagger_rad,
                               &rule.sweep, &rule.lean, &rule.bow_rad})
    for (auto& [span, value] : table->stations) value *= share;
  return rule;
}

}  // namespace gridmorph
