// What the mapping of a displacement field found, for the terminal and for JSON.
#pragma once

#include <gridmorph/mapping/inverse_field.hpp>
#include <gridmorph/mapping/point_field.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph {

/// "blade.csv: all 2112 node positions coincide with points of the file", or how many do, mapping distance, nodes
/// beyond the edge of the model, and the leave-one-out error.
std::string describe_mapping(PointField const& field);

/// What of that is to be looked at: nodes beyond the edge by more than two spacings, or farther away than
/// MappingLimits::notable; empty otherwise.
std::string far_from_model(PointField const& field);

/// {"file", "nodes", "elements", "fields", "evaluated", "coincident", "extrapolated", "far_beyond", "far_off",
/// "patches_size", "mapping_distance": {"mean", "max"}, "largest_extrapolation", "leave_one_out": {"tried", "max",
/// "rms"}}. Lengths in units of the mesh, leave-one-out as share of the largest displacement; null where every position
/// coincides with a node and nothing is interpolated.
nlohmann::json mapping_json(PointField const& field);

/// A line for people and an object for the report of a field that is taken back.
std::string describe_inverse(InverseField const& inverse);
nlohmann::json inverse_json(InverseField const& inverse);

}  // namespace gridmorph
