// What the exit status of a run says.
#pragma once

namespace gridmorph::cli {

enum ExitStatus : int {
  done = 0,
  falls_short = 1,  ///< the mesh was morphed and written, but misses the thresholds
  bad_input = 2,
  machine_failure = 3,
  not_written = 4  ///< the mesh was morphed and has inverted cells that were not in the baseline
};

inline int status_of_morph(bool written, bool short_of_thresholds) {
  return !written ? not_written : short_of_thresholds ? falls_short : done;
}

}  // namespace gridmorph::cli
