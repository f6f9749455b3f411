// Names, formulas and formats of the quality measures, for tables and JSON alike.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace gridmorph {

struct MeasureText {
  std::string_view title;    ///< "aspect ratio"
  std::string_view formula;  ///< written down where the number is reported
};

MeasureText text_of(Measure measure);

/// The formula for the elements of unstructured meshes.
std::string_view element_formula(Measure measure);

/// A value as tables and messages show it: four significant digits, "unbounded" for infinity.
std::string format_value(double value);

/// As JSON, which has no infinity: null for what is not finite.
nlohmann::json finite_or_null(double value);

/// "zone 'Zone 1' cell (i 3, j 1, k 7)" for the worst cell of one measure; "-" where nothing was measured.
std::string worst_place(QualityReport const& report, MeasureStatistics const& statistics);

/// "zone 'Zone 1' node (i 3, j 1, k 7)", or "-".
std::string node_place(QualityReport const& report, NodeLocation const& location);

}  // namespace gridmorph
