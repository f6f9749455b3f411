// What of a flow solution is a shock.
#pragma once

#include <optional>
#include <string>

namespace gridmorph {

/// Cells of a shock by one of two sensors, of the values at the corners of a cell (those of a solution in cells: the
/// mean of the cells around each corner):
///
///     normal_mach   M_n = v . grad p / (a |grad p|) >= threshold,  where (p_max - p_min) / p_mean >= compression too
///     jump          (q_max - q_min) / |q_mean| >= threshold
///
/// normal_mach: the Mach number of the flow along the pressure gradient, at least 1 ahead of and within a shock that
/// stands (Lovely & Haimes, Shock detection from computational fluid dynamics results, AIAA 99-3285, 1999); a is the
/// speed of sound, grad p the gradient of the linear function that fits the corners best. Compression leaves out what
/// is smooth. jump: the relative rise of any variable over one cell, whichever way it goes.
struct ShockSearch {
  enum class Sensor { normal_mach, jump };

  std::string file;      ///< with the solution; empty: the file of the mesh
  std::string solution;  ///< FlowSolution_t; empty: as SolutionWanted has it
  Sensor sensor = Sensor::normal_mach;
  std::string variable = "Pressure";  ///< of `jump`
  std::optional<double> threshold{};  ///< absent: 1 of normal_mach, 0.1 of jump
  double compression = 0.05;
  double heat_ratio = 1.4;  ///< of the gas, where the solution has no speed of sound
  int smallest = 8;         ///< connected cells; groups of fewer are dropped
  int grow = 0;             ///< layers of cells around that come along

  [[nodiscard]] double least() const { return threshold.value_or(sensor == Sensor::jump ? 0.1 : 1.0); }
};

}  // namespace gridmorph
