// Whether the models of `field` rules lie where the patches are that take their displacement from them.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Shows every field the nodes that will ask it: PointField::expect(). Throws MotionError where a model lies elsewhere:
/// in other units, with columns in another order, cut off. Cost: a search for 4000 nodes each.
void check_fields(CaseFile const& case_file, Mesh const& mesh);

}  // namespace gridmorph
