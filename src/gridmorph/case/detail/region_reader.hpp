// Reads the [[region]] tables of a case file. Internal to casefile.
#pragma once

#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/geometry/axis.hpp>

#include <optional>

namespace gridmorph::casefile {

/// One region; what it lacks is noted as a problem.
InnerRegion read_region(TableReader& table, std::optional<Axis> const& axis);

}  // namespace gridmorph::casefile
