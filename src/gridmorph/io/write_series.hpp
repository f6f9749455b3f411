// Meshes over time in one CGNS file, or in one case of OpenFOAM.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

/// Copies the file that `mesh` was read from and adds the coordinates of every step, as the CGNS standard (SIDS, "Time-
/// Dependent Flow") says: in each zone one GridCoordinates_t per step beside the original GridCoordinates, which stays
/// the baseline, and a ZoneIterativeData_t whose GridCoordinatesPointers names them in order; in the base a
/// BaseIterativeData_t with TimeValues and IterationValues (1, 2, ...), and SimulationType TimeAccurate where the file
/// says nothing else; iterative data of a single step, as solvers write them, are replaced. Everything else comes
/// through unchanged. Precision is that of the zone's coordinates; of a 2-D mesh plane 0 is written. The file appears
/// whole on commit(), or not at all.
///
/// A mesh of OpenFOAM becomes a case: the mesh in constant/polyMesh, and its points at each time in `<time>/polyMesh`;
/// in a mesh one cell thick both planes move. Each file appears whole, and what was made is taken away again where
/// commit() is not reached.
///
/// Memory: nothing that grows with the number of steps. While one is open, no other function of the library may read or
/// write CGNS files from another thread.
class SeriesWriter {
 public:
  /// `times`: of all steps, ascending. `output` may not be the input. Throws IoError when the input is not the file of
  /// the mesh, holds a series of several steps, or is no CGNS file or mesh of OpenFOAM; MachineError when there is no
  /// room for all steps.
  SeriesWriter(std::string const& input, std::string const& output, Mesh const& mesh, std::vector<double> const& times);
  ~SeriesWriter();
  SeriesWriter(SeriesWriter&&) noexcept;
  SeriesWriter& operator=(SeriesWriter&&) = delete;

  /// Writes the next step. Throws MeshError for sizes that do not fit, more steps than times, and coordinates that are
  /// not finite, MachineError when writing fails.
  void add(Coordinates const& morphed);
  /// The next step zone by zone, for meshes that never are in memory as a whole: zones in any order, each once per
  /// step, Zone::size() values each, in the order of the file. The mesh's zones may share nodes. CGNS alone. Errors as
  /// above.
  void add_zone(int zone, double const* x, double const* y, double const* z);
  /// Puts the file in place. Throws MeshError when steps are missing.
  void commit();

  struct Impl;  ///< internal

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace gridmorph
