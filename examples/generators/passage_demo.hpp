// The passage demo as files: mesh, displacement of the blade, case file.
#pragma once

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>

#include <filesystem>

namespace gridmorph {

struct PassageFiles {
  std::filesystem::path mesh;          ///< CGNS
  std::filesystem::path displacement;  ///< CSV
  std::filesystem::path case_file;     ///< TOML: the workflow of the paper's Figure 11
  std::filesystem::path morphed;       ///< CGNS that the case file will write; not there yet
};

/// Where the demo puts its files.
PassageFiles passage_files(std::filesystem::path const& folder, PassageMotion const& motion);

/// Makes the folder if it is missing and writes passage.cgns, <motion>.csv and <motion>.toml into it. Paths inside the
/// case file are relative to it. Throws ConfigError (options), IoError or MachineError (writing).
PassageFiles write_passage_demo(std::filesystem::path const& folder, PassageOptions const& options,
                                PassageMotion const& motion);

/// The same for a mesh that make_passage(options) made before, so that several motions share one mesh file; the file is
/// written only if `mesh_file` says so.
enum class MeshFile { write, keep };
PassageFiles write_passage_demo(std::filesystem::path const& folder, PassageOptions const& options,
                                PassageMotion const& motion, Mesh const& mesh, MeshFile mesh_file);

/// Text of the case file; the axis of the machine is the one that options.placement gives.
std::string passage_case_file(PassageOptions const& options, PassageFiles const& files);

}  // namespace gridmorph
