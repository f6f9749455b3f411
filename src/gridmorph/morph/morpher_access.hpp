// A Morpher of the plan of one kind of mesh, for the library itself.
#pragma once

#include <gridmorph/morph/morpher.hpp>

namespace gridmorph {

struct MorpherAccess {
  /// AnyPlan: Plan, UnstructuredPlan or MorphPlan. All else is as the public constructor of Morpher says.
  template <class Exec, class AnyPlan>
  static Morpher<Exec> of(Exec const& exec, AnyPlan const& plan, typename Morpher<Exec>::In const& baseline,
                          MorpherOptions const& options = {}) {
    return Morpher<Exec>(exec, plan, baseline, options);
  }
};

}  // namespace gridmorph
