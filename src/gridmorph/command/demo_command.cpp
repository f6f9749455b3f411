#include <generators/aircraft.hpp>
#include <generators/ball_demo.hpp>
#include <generators/passage_demo.hpp>
#include <generators/stand_ins.hpp>
#include <generators/text_file.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

/// The report of a demo, beside the morphed mesh.
std::filesystem::path report_of(std::filesystem::path morphed) { return morphed.replace_extension(".json"); }

/// A folder that is there may hold links, devices, ... of the names that the demo writes.
void check_demo_files(std::vector<std::filesystem::path> const& paths) {
  RunFiles files;
  for (auto const& path : paths) files.push_back({"demo file", path, true});
  check_run_files({}, files);
}

/// Morphs the case file of a demo; its report goes beside the morphed mesh.
int morph_demo(std::filesystem::path const& path, std::filesystem::path const& morphed, Terminal& terminal) {
  CaseFile case_file = read_case_file(path);
  case_file.output_options.report = report_of(morphed);
  return morph_once(case_file, checked_mesh_file(case_file, CaseUse::Run::morph), terminal);
}

/// "x", "y", "z" or "1,2,3".
Vec3 direction_of(std::string const& text) {
  if (text == "x") return {1, 0, 0};
  if (text == "y") return {0, 1, 0};
  if (text == "z") return {0, 0, 1};
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Vec3 v;
  char first = 0, second = 0, more = 0;
  bool const read = in >> v.x >> first >> v.y >> second >> v.z && first == ',' && second == ',' && !(in >> more);
  if (!read || !(norm(v) > 0) || !std::isfinite(norm(v)))
    throw ConfigError(
        fmt::format("--axis '{}' is no direction: give x, y, z or three numbers as 1,2,3, not all 0", text));
  return (1 / norm(v)) * v;
}

/// Machines about x are turned to it the short way.
RigidTransform placed_along(Vec3 const& direction) {
  Vec3 const x{1, 0, 0}, about = cross(x, direction);
  double const sine = norm(about), cosine = dot(x, direction);
  Vec3 const across = sine > 0 ? (1 / sine) * about : Vec3{0, 0, 1};
  return {rotation_matrix(across, std::atan2(sine, cosine)), {}};
}

void round_to_single(Mesh& mesh) {
  for (Zone& zone : mesh.zones) zone.single_precision = true;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const x = mesh.coordinates[n];
    mesh.coordinates.set(n, {double(float(x.x)), double(float(x.y)), double(float(x.z))});
  }
}

int demo_passage(CommandLine const& options, std::filesystem::path const& folder, Terminal& terminal) {
  PassageOptions passage;
  passage.nodes = options.demo_nodes.value_or(passage.nodes);
  passage.tip = blade_tip(options.demo_tip.value_or("none"));
  bool const has_gap = passage.tip != BladeTip::none;
  if (options.demo_gap && !has_gap) throw ConfigError("--gap goes with --tip flat, squealer or groove");
  passage.tip_gap = options.demo_gap.value_or(passage.tip_gap);
  if (options.demo_first_cell) set_first_cells(passage, *options.demo_first_cell);
  if (options.demo_axis) passage.placement = placed_along(direction_of(*options.demo_axis));
  std::vector<PassageMotion> motions;
  std::string const motion = options.demo_motion.value_or("all");
  if (motion == "all")
    motions = {rotated_sections(), chord_redesign()};
  else
    motions = {passage_motion(motion)};
  if (motion == "all" && has_gap) motions.push_back(gap_halved());
  if (motion == gap_halved().name && !has_gap)
    throw ConfigError("motion 'gap' goes with --tip flat, squealer or groove");

  std::vector<std::filesystem::path> outputs{folder / "passage.cgns"};
  for (auto const& m : motions) {
    PassageFiles const f = passage_files(folder, m);
    outputs.insert(outputs.end(), {f.displacement, f.case_file, f.morphed, report_of(f.morphed)});
  }
  check_demo_files(outputs);
  int status = done;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    terminal.progress(fmt::format("making the passage mesh with {} nodes", passage.nodes));
    // The mesh is dropped before the morph reads it from its file: large demos need the memory.
    PassageFiles const files = [&] {
      Mesh mesh = make_passage(passage);
      if (options.demo_single) round_to_single(mesh);
      return write_passage_demo(folder, passage, motions[m], mesh, m == 0 ? MeshFile::write : MeshFile::keep);
    }();
    terminal.say(fmt::format("{}\n== {} ==\n", m == 0 ? "" : "\n", files.case_file.string()));
    status = std::max(status, morph_demo(files.case_file, files.morphed, terminal));
  }
  return status;
}

int demo_ball(CommandLine const& options, std::filesystem::path const& folder, Terminal& terminal) {
  BallFiles const places = ball_files(folder);
  check_demo_files({places.mesh, places.case_file, places.morphed, report_of(places.morphed)});
  BallOptions ball;
  ball.elements = options.demo_elements.value_or(ball.elements);
  BallSwing swing;
  swing.angle_deg = options.demo_angle_deg.value_or(swing.angle_deg);
  terminal.progress(fmt::format("making the ball mesh with {} elements", ball.elements));
  BallFiles const files = write_ball_demo(folder, ball, swing);
  terminal.say(fmt::format("\n== {} ==\n", files.case_file.string()));
  return morph_demo(files.case_file, files.morphed, terminal);
}

int demo_aircraft(CommandLine const& options, std::filesystem::path const& folder, Terminal& terminal) {
  AircraftOptions aircraft;
  aircraft.nodes = options.demo_nodes.value_or(aircraft.nodes);
  terminal.progress(fmt::format("making the aircraft mesh with about {} nodes", aircraft.nodes));
  Mesh const mesh = make_aircraft(aircraft);
  make_folder(folder);
  auto const path = folder / "aircraft.cgns";
  check_demo_files({path});
  write_mesh(path.string(), mesh);
  terminal.say(fmt::format("mesh       {}: {} zones, {} nodes\n", path.string(), mesh.zones.size(), mesh.n_nodes()));
  return done;
}

/// Meshes of examples, whose case files are not the command's to write.
int demo_stand_in(CommandLine const& options, std::filesystem::path const& folder, Terminal& terminal) {
  terminal.progress(fmt::format("making the mesh of the {}", options.demo_name));
  auto const path = write_stand_in(options.demo_name, folder);
  terminal.say(fmt::format("mesh       {}\n", path.string()));
  return done;
}

/// Options of the other demo would be ignored in silence.
void refuse_options_of(char const* other, std::string const& chosen,
                       std::vector<std::pair<char const*, bool>> const& given) {
  for (auto const& [option, is_given] : given)
    if (is_given)
      throw ConfigError(fmt::format("{} is an option of the demo '{}', not of '{}'", option, other, chosen));
}

}  // namespace

namespace {

int run_demo(CommandLine const& options, std::filesystem::path const& folder, Terminal& terminal) {
  std::string const& name = options.demo_name;
  std::vector<std::pair<char const*, bool>> const passage_options{{"--motion", options.demo_motion.has_value()},
                                                                  {"--tip", options.demo_tip.has_value()},
                                                                  {"--gap", options.demo_gap.has_value()},
                                                                  {"--first-cell", options.demo_first_cell.has_value()},
                                                                  {"--single", options.demo_single},
                                                                  {"--axis", options.demo_axis.has_value()}};
  if (name == "passage") {
    refuse_options_of(
        "ball", name,
        {{"--elements", options.demo_elements.has_value()}, {"--angle", options.demo_angle_deg.has_value()}});
    return demo_passage(options, folder, terminal);
  }
  if (name == "ball") {
    refuse_options_of("passage", name, {{"--nodes", options.demo_nodes.has_value()}});
    refuse_options_of("passage", name, passage_options);
    return demo_ball(options, folder, terminal);
  }
  if (name == "aircraft") {
    refuse_options_of("passage", name, passage_options);
    refuse_options_of(
        "ball", name,
        {{"--elements", options.demo_elements.has_value()}, {"--angle", options.demo_angle_deg.has_value()}});
    return demo_aircraft(options, folder, terminal);
  }
  if (auto const& meshes = stand_in_names(); std::find(meshes.begin(), meshes.end(), name) != meshes.end()) {
    refuse_options_of("passage", name, {{"--nodes", options.demo_nodes.has_value()}});
    refuse_options_of("passage", name, passage_options);
    refuse_options_of(
        "ball", name,
        {{"--elements", options.demo_elements.has_value()}, {"--angle", options.demo_angle_deg.has_value()}});
    return demo_stand_in(options, folder, terminal);
  }
  throw ConfigError(fmt::format("there is no demo '{}'{}", name,
                                suggestion(name, {"passage", "ball", "turbine", "slat", "coil", "aircraft"})));
}

}  // namespace

int run_demo_command(CommandLine const& options, Terminal& terminal) {
  auto const folder =
      options.demo_folder.empty() ? std::filesystem::path("demo_" + options.demo_name) : options.demo_folder;
  int const status = run_demo(options, folder, terminal);
  terminal.document({{"gridmorph", GRIDMORPH_VERSION},
                     {"demo", options.demo_name},
                     {"folder", folder.string()},
                     {"morphs", terminal.take_documents()}});
  return status;
}

}  // namespace gridmorph::cli
