// JSON as it stands in files and on standard output.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph {

/// Indented, with what is no UTF-8 replaced, and a line feed at the end: reports and --json.
std::string json_text(nlohmann::json const& json);

}  // namespace gridmorph
