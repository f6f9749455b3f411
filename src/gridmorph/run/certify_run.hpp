// `gridmorph certify`: whether every design of a case file's [parameters] is valid.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/run/console.hpp>

#include <optional>

namespace gridmorph::cli {

struct CertifyOptions {
  ParameterValues values{};  ///< of parameters, in place of the case file's; those without a range keep them
  double limit = 1;          ///< the largest box that is looked at, of the ranges
  std::optional<std::filesystem::path> report{};  ///< JSON
};

/// Looks at all designs of the ranges of [parameters] at once: the plan of the middle of the box, the meshes of its
/// ends, bounds in between (certify_designs()). Returns whether all of the ranges are certified. Throws ConfigError for
/// case files without ranges, with [sequence], and where meshes are not linear in the parameters (design_modes()).
bool certify_case(CaseDocument const& document, CertifyOptions const& options, Console& console);

}  // namespace gridmorph::cli
