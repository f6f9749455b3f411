#include <generators/passage_demo.hpp>
#include <generators/text_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

/// A TOML array of floats that read back as the same numbers.
std::string vector_text(Vec3 const& v) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "[%.17g, %.17g, %.17g]", v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text.data();
}

std::string list_text(std::vector<std::string> const& names) {
  std::string text;
  for (std::string const& n : names) text += (text.empty() ? "[\"" : ", \"") + n + "\"";
  return text + "]";
}

constexpr char const* clearance_text =
    "\n"
    "[[clearance]]                       # between tip and case, in the table and the report\n"
    "tips  = [\"tip\"]\n"
    "walls = [\"case\"]\n";

}  // namespace

std::string passage_case_file(PassageOptions const& options, PassageFiles const& files) {
  return "# Morphing of one airfoil passage: the workflow of the paper's Figure 11. Paths are relative to this file.\n"
         "\n"
         "[mesh]\n"
         "input  = \"" +
         files.mesh.filename().string() +
         "\"\n"
         "output = \"" +
         files.morphed.filename().string() +
         "\"\n"
         "axis   = { origin = " +
         vector_text(options.placement.translation) +
         ", direction = " + vector_text(options.placement.rotation * Vec3{1, 0, 0}) +
         " }\n"
         "\n"
         "[[motion]]                          # airfoil: given node by node\n"
         "patches = " +
         list_text(blade_families(options.tip)) +
         "\n"
         "rule    = \"field\"\n"
         "file    = \"" +
         files.displacement.filename().string() +
         "\"\n"
         "\n"
         "[[motion]]                          # inlet and outlet: turn with the leading and trailing edge\n"
         "patches = [\"inlet\", \"outlet\"]\n"
         "rule    = \"circumferential-slide\"\n"
         "of      = \"blade\"\n"
         "\n"
         "[[motion]]                          # periodics: follow the mid-camber line, taper to inlet and outlet\n"
         "patches = [\"type:periodic\"]\n"
         "rule    = \"follow\"\n"
         "of      = \"blade\"\n"
         "\n"
         "[[motion]]                          # hub and case: nodes slide on the surface of revolution\n"
         "patches = [\"hub\", \"case\"]\n"
         "rule    = \"slip\"\n"
         "surface = \"revolution\"\n"
         "\n"
         "[boundary_layer]                    # the ring round the blade moves with it\n"
         "walls  = [\"blade\"]\n"
         "extent = \"block\"\n"
         "mode   = \"rotate\"\n"
         "\n"
         "[volume]\n"
         "law = \"linear\"\n"
         "priority = [ { rule = \"boundary\", order = [\"wall\", \"periodic\", \"inflow\", \"outflow\"] },\n"
         "             { rule = \"quality\" },\n"
         "             { rule = \"aspect-ratio\" } ]\n" +
         (options.tip == BladeTip::none ? "" : clearance_text);
}

PassageFiles passage_files(std::filesystem::path const& folder, PassageMotion const& motion) {
  return {folder / "passage.cgns", folder / (motion.name + ".csv"), folder / (motion.name + ".toml"),
          folder / ("passage_" + motion.name + ".cgns")};
}

PassageFiles write_passage_demo(std::filesystem::path const& folder, PassageOptions const& options,
                                PassageMotion const& motion) {
  return write_passage_demo(folder, options, motion, make_passage(options), MeshFile::write);
}

PassageFiles write_passage_demo(std::filesystem::path const& folder, PassageOptions const& options,
                                PassageMotion const& motion, Mesh const& mesh, MeshFile mesh_file) {
  make_folder(folder);
  PassageFiles files = passage_files(folder, motion);
  if (mesh_file == MeshFile::write) write_mesh(files.mesh.string(), mesh);
  write_displacement_csv(files.displacement.string(), mesh, blade_families(options.tip),
                         [&](Vec3 const& p) { return passage_displacement(options, motion, p); });
  write_text_file(files.case_file, passage_case_file(options, files), "case file");
  return files;
}

}  // namespace gridmorph
