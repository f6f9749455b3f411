// What a mesh falls short of: inverted cells, cells beyond the limits of [guard], large relative displacements.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

struct QualityThresholds {
  CellLimits cells;                         ///< [guard] of case files
  double max_relative_displacement = 0.25;  ///< paper, section 3.2: what is known to be handled well; a warning only
};

struct Shortfall {
  enum class Severity {
    warning,  ///< worth a look; the mesh may well be usable
    failure   ///< the mesh falls short of what was asked for (exit status 1 of the command line)
  };
  Severity severity;
  std::string message;  ///< what, value, threshold, worst cell with zone and 1-based i, j, k
};

/// Shortfalls of the morphed mesh, or of the baseline when there is no morphed one. Cells that were inverted, or beyond
/// a limit, in the baseline already are warnings; how much they may lose is limited like that of all others
/// (CellLimits::max_loss). The baseline is looked at for what it had and may be empty (a verdict knows by itself what
/// fell).
std::vector<Shortfall> shortfalls(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                                  QualityThresholds const& thresholds);

/// Whether any of them is a failure.
bool any_failure(std::vector<Shortfall> const& list);

}  // namespace gridmorph
