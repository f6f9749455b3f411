#include <gridmorph/command/command_line.hpp>
#include <gridmorph/command/help.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/run/version.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

std::vector<std::string> const command_names{"morph",  "inspect",   "plan",    "certify", "quality", "wheel", "fillet",
                                             "blocks", "hexahedra", "surface", "view",    "keys",    "demo"};

constexpr char const* exit_statuses =
    "Exit status: 0 done; 1 written, but the mesh falls short of the thresholds; 2 bad input; 3 failure of the "
    "machine; "
    "4 not written, because cells are inverted.";

void add_quality(CLI::App& command, CommandLine& out, char const* text) {
  command.add_option("--quality", out.quality, text)->check(CLI::IsMember({"auto", "full", "fast"}));
}

/// What every command understands, before its name and after it.
void add_common(CLI::App& app, CommandLine& out) {
  app.add_flag("-q,--quiet", out.quiet,
               "Print errors and warnings only, and what inspect, plan, quality and keys are asked for");
  app.add_flag("--json", out.json, "Print the result as JSON on standard output, and nothing else there");
  app.add_option(
         "-t,--threads", out.threads,
         "Threads to compute with (default: OMP_NUM_THREADS, else what the machine and the size of the mesh allow)")
      ->check(CLI::Range(1, 4096));
}

/// Words as a shell reads them again: quoted where they hold more than letters, digits and what is harmless.
std::string quoted_words(int argc, char const* const* argv) {
  std::string out;
  for (int a = 0; a < argc; ++a) {
    std::string word = argv[a];
    if (a == 0) word = word.substr(word.find_last_of('/') + 1);
    if (a > 0) out += ' ';
    constexpr char const* harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+.,:/@%";
    if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) {
      out += word;
      continue;
    }
    out += '\'';
    for (char const c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    out += '\'';
  }
  return out;
}

/// 0 to 1. What is too much for a share may be meant as per cent.
CLI::Validator const& share() {
  static CLI::Validator const between(
      [](std::string& text) -> std::string {
        auto const value = finite_number(text);
        if (!value) return "expected a number from 0 to 1, found " + text;
        if (*value >= 0 && *value <= 1) return {};
        return "a share is a number from 0 to 1, found " + text +
               (*value > 1 && *value <= 100 ? ", did you mean " + to_text(*value / 100, 6) + "?" : "");
      },
      "FLOAT in [0 - 1]");
  return between;
}

/// "stagger=2.5" into a parameter and its value.
void add_value(std::string const& text, ParameterValues& out) {
  auto const sign = text.find('=');
  auto const value = sign == std::string::npos ? std::nullopt : finite_number(text.substr(sign + 1));
  if (sign == 0 || !value)
    throw CLI::ValidationError("--set " + text, "write it as name=value, a parameter and a number: --set stagger=2.5");
  out[text.substr(0, sign)] = *value;
}

void add_parameters(CLI::App& command, CommandLine& out) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&out](std::vector<std::string> const& all) {
            for (std::string const& text : all) add_value(text, out.parameters);
          },
          "Value of a parameter, instead of the case file's; may be repeated")
      ->allow_extra_args(false)
      ->option_text("NAME=VALUE");
}

CLI::App* add_morph(CLI::App& app, CommandLine& out) {
  auto* morph = app.add_subcommand("morph", "Morph a mesh as a case file says");
  morph->add_option("case", out.input, "Case file (TOML)")->required();
  morph->add_option("-o,--output", out.output, "Morphed mesh, instead of the case file's output");
  morph->add_option("-r,--report", out.report, "Report (JSON), instead of the case file's");
  morph->add_option("--html", out.page, "Report as one page with pictures (HTML), instead of the case file's html");
  add_quality(*morph, out, "How much is measured, instead of the case file's: full, fast (a verdict), auto");
  morph->add_option("--fraction", out.fraction, "Share of the motion: every rule at that share of its amplitude")
      ->check(share());
  add_parameters(*morph, out);
  morph->add_flag("--dry-run", out.dry_run, "Check everything and print the plan; write nothing");
  return morph;
}

CLI::App* add_wheel(CLI::App& app, CommandLine& out) {
  auto* wheel = app.add_subcommand("wheel", "Make a wheel of passages, each with its own blade, as a case file says");
  wheel->add_option("case", out.input, "Case file (TOML) with [wheel]")->required();
  wheel->add_option("-o,--output", out.output, "Mesh of the wheel, instead of the case file's output");
  wheel->add_option("-r,--report", out.report, "Report (JSON), instead of the case file's");
  wheel->add_option("--html", out.page, "Report as one page with pictures (HTML), instead of the case file's html");
  add_quality(*wheel, out, "How much is measured, instead of the case file's: full, fast (a verdict), auto");
  add_parameters(*wheel, out);
  return wheel;
}

void add_leave_out(CLI::App& command, CommandLine& out) {
  command
      .add_option("--leave-out", out.leave_out,
                  "A base or zone of a CGNS file that is no part of the mesh; may be repeated")
      ->allow_extra_args(false);
}

/// What [mesh] of a case file says of boundaries.
void add_topology(CLI::App& command, CommandLine& out) {
  command
      .add_option("--matching-tolerance", out.topology.matching_tolerance,
                  "Largest distance of nodes that an interface joins (default: 1e-8 of the mesh size)")
      ->check(CLI::PositiveNumber);
  command.add_option("--open-faces", out.topology.open_faces,
                     "Name of the patch that faces get which nothing claims (default: they are an error)");
  add_leave_out(command, out);
}

CLI::App* add_inspect(CLI::App& app, CommandLine& out) {
  auto* inspect = app.add_subcommand("inspect", "Say what a mesh consists of and what a case file could name");
  inspect->add_option("mesh", out.input, "Mesh (CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK or UGRID)")->required();
  inspect->add_option("--side-file", out.side_file,
                      "Patches and interfaces (TOML), instead of the file beside the mesh");
  add_leave_out(*inspect, out);
  inspect->add_flag("--match", out.match, "Look for interfaces and periodicity where nothing is declared");
  inspect->add_flag("!--no-periodic", out.match_periodic, "Look for interfaces only, not for periodicity");
  inspect->add_option("--match-tolerance", out.match_tolerance, "Distance of points that match, of the smallest edge")
      ->check(CLI::Range(1e-9, 0.25));
  inspect->add_option("--write-side-file", out.write_side_file,
                      "Look for interfaces and write them, and patches for what is left, to this file (TOML)");
  inspect->add_option("--suggest", out.suggest, "Only a case file to start from, printed or written to a file")
      ->expected(0, 1)
      ->default_str("");
  return inspect;
}

CLI::App* add_surface(CLI::App& app, CommandLine& out) {
  auto* surface = app.add_subcommand(
      "surface", "Write patches of a mesh as facets (STL) or as nodes (CSV, as a rule \"field\" reads them)");
  surface->add_option("mesh", out.input, "Mesh (CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK or UGRID)")->required();
  surface->add_option("-p,--patches", out.patches, "Patches, named as in case files (blade, type:wall, row1/per*)")
      ->required();
  surface->add_option("-o,--output", out.output, "NAME.stl or NAME.csv")->required();
  surface->add_option("--split", out.split, "Cut each facet into N x N")->check(CLI::Range(1, 1000));
  add_leave_out(*surface, out);
  surface->add_flag("--ascii", out.ascii, "Text with all digits; binary STL has single precision");
  return surface;
}

CLI::App* add_blocks(CLI::App& app, CommandLine& out) {
  auto* blocks = app.add_subcommand("blocks", "Find the blocks of grid lines in a mesh of hexahedra, and write them");
  blocks->add_option("mesh", out.input, "Mesh of hexahedra (CGNS, SU2, OpenFOAM, Gmsh, VTK or UGRID)")->required();
  blocks->add_option("-o,--output", out.output, "NAME.cgns")->required();
  add_leave_out(*blocks, out);
  return blocks;
}

CLI::App* add_hexahedra(CLI::App& app, CommandLine& out) {
  auto* hexahedra =
      app.add_subcommand("hexahedra", "Write a mesh of blocks as one of elements, its cells as hexahedra");
  hexahedra->add_option("mesh", out.input, "Mesh of blocks (CGNS, PLOT3D)")->required();
  hexahedra->add_option("-o,--output", out.output, "NAME.cgns or NAME.vtu")->required();
  add_topology(*hexahedra, out);
  return hexahedra;
}

CLI::App* add_fillet(CLI::App& app, CommandLine& out) {
  auto* fillet = app.add_subcommand(
      "fillet", "Round the corner between a blade and an end wall, with blocks or elements that suit it");
  fillet->add_option("mesh", out.input, "Mesh of blocks or of elements")->required();
  fillet->add_option("-b,--blade", out.patches, "Patches of the blade, named as in case files")->required();
  fillet->add_option("-w,--wall", out.end_walls, "Patches of the end wall: hub, case, or both")->required();
  fillet->add_option("--radius", out.radius, "Radius: a number, or an expression of x, y, z along the corner")
      ->required();
  fillet->add_option("-o,--output", out.output, "Mesh with the fillet (CGNS)")->required();
  fillet
      ->add_option("--blade-layers", out.blade_layers,
                   "Layers off the blade that the corner takes (default: by the radius)")
      ->check(CLI::Range(1, 10000));
  fillet
      ->add_option("--wall-layers", out.end_wall_layers,
                   "Layers off the end wall that it takes (default: by the radius)")
      ->check(CLI::Range(1, 10000));
  fillet
      ->add_option("--run-out", out.run_out,
                   "H meshes: radii over which the fillet runs out before the blade's edges (default 8)")
      ->check(CLI::Range(0.0, 1000.0));
  add_topology(*fillet, out);
  return fillet;
}

/// "x=0.5": a coordinate and its value.
std::pair<int, double> plane_of(std::string const& text) {
  auto const sign = text.find('=');
  auto const letter = std::string("xyz").find(text.substr(0, sign));
  auto const value = sign == std::string::npos ? std::nullopt : finite_number(text.substr(sign + 1));
  if (sign != 1 || letter > 2 || !value)
    throw CLI::ValidationError("--plane " + text, "write it as x=0.5, y=0.5 or z=0.5");
  return {int(letter), *value};
}

/// Where meshes are cut: one of several options.
void add_places(CLI::App& view, ViewRequest& out) {
  std::vector<CLI::Option*> places{
      view.add_option_function<std::string>(
              "--plane", [&out](std::string const& text) { out.plane = plane_of(text); },
              "Cut where a coordinate has a value; if no place is given: a plane mesh as it is, a machine with "
              "periodic "
              "sides at half span, else the plane through what moves, or the walls, that meets most of it")
          ->option_text("x=V"),
      view.add_option("--span", out.span, "Cut at a span fraction between hub (0) and case (1)")
          ->check(CLI::Range(0.0, 1.0))
          ->option_text("S")};
  for (int axis = 0; axis < 3; ++axis) {
    std::string const letter(1, "ijk"[axis]);
    places.push_back(view.add_option_function<int>(
                             "--" + letter,
                             [&out, axis](int n) {
                               out.index = {axis, n};
                             },
                             "Blocks: index plane " + letter + " = N of every zone that has it, 1-based")
                         ->check(CLI::Range(1, 2'000'000'000))
                         ->option_text("N"));
  }
  for (auto* a : places)
    for (auto* b : places)
      if (a != b) a->excludes(b);
}

CLI::App* add_view(CLI::App& app, CommandLine& out) {
  auto* view = app.add_subcommand(
      "view", "Draw pictures of one mesh, or of a baseline and its morphed mesh side by side: sections and close-ups");
  view->add_option("mesh", out.input, "Mesh, or the baseline (CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK or UGRID)")
      ->required();
  view->add_option("morphed", out.second, "Morphed mesh, or another one");
  view->add_option("-o,--out", out.output, "Folder for the pictures and view.html, a page of them; made if missing")
      ->required()
      ->option_text("DIR REQUIRED");
  add_places(*view, out.view);
  view->add_option_function<std::string>(
          "--axis", [&out](std::string const& letter) { out.view.axis = letter[0] - 'x'; },
          "Axis of the machine; taken from the periodic interfaces, else x")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->option_text("x|y|z");
  view->add_option("--wall", out.view.wall, "Wall of the close-ups; the first one met if not given")
      ->option_text("FAMILY");
  // Through a vector: of an optional array nvcc finds several conversions.
  view->add_option_function<std::vector<double>>(
          "--box",
          [&out](std::vector<double> const& of) {
            out.view.box = {of[0], of[1], of[2], of[3]};
          },
          "One more close-up, box.png")
      ->expected(4)
      ->option_text("X0 X1 Y0 Y1");
  view->add_option("--color", out.view.color,
                   "determinant (default for blocks), type (of element; default for elements), displacement, none, or "
                   "a variable of the flow solution")
      ->option_text("WHAT");
  view->add_option("--moved", out.view.moved, "Outline cells that move by at least this")
      ->check(CLI::NonNegativeNumber)
      ->option_text("LENGTH");
  view->add_option("--stages", out.view.stages, "Folder that [output] stages names: pictures of them too")
      ->option_text("DIR");
  view->add_option("--dpi", out.view.dpi, "Dots per inch; a mesh is 6.4 inches wide (default 150)")
      ->check(CLI::Range(10, 600))
      ->option_text("N");
  return view;
}

CLI::App* add_keys(CLI::App& app, CommandLine& out) {
  auto* keys = app.add_subcommand("keys", "List the keys of case files: type, unit, default, meaning");
  keys->add_option("name", out.names, "Keys, tables or rules (offset, volume, rigid); all of them if none is given");
  return keys;
}

CLI::App* add_demo(CLI::App& app, CommandLine& out) {
  auto* demo = app.add_subcommand("demo", "Write a built-in mesh and its case files, and morph it");
  demo->add_option(
          "name", out.demo_name,
          "passage: one airfoil passage of a turbomachine (O4H); ball: a ball on a rope under a crane (hybrid); "
          "turbine, slat, coil, aircraft: "
          "only the mesh of an example (water turbine in 7 zones, airfoil with slat and flap, heated tube in a duct, "
          "aircraft in several "
          "hundred zones)")
      ->required();
  demo->add_option("-n,--nodes", out.demo_nodes, "passage, aircraft: nodes of the mesh (default 200000, 500000)")
      ->check(CLI::Range(Index(10'000), Index(400'000'000)));
  demo->add_option("-m,--motion", out.demo_motion, "passage: rotation, chord, gap (with --tip), or all (default)");
  demo->add_option(
      "--tip", out.demo_tip,
      "passage: flat, squealer or groove: the end of the blade below a gap; none (default): it reaches the case");
  demo->add_option("--gap", out.demo_gap, "passage with --tip: height of the gap, in span (default 0.015)");
  demo->add_option(
      "--first-cell", out.demo_first_cell,
      "passage: height of the first cells off the blade and the end walls, in span (default: some 1e-5, more "
      "where cells would grow too fast)");
  demo->add_flag("--single", out.demo_single, "passage: coordinates in single precision");
  demo->add_option("--axis", out.demo_axis,
                   "passage: direction of the machine's axis: x (default), y, z or three numbers \"1,2,3\"");
  demo->add_option("-e,--elements", out.demo_elements, "ball: elements of the mesh (default 500000)")
      ->check(CLI::Range(Index(50'000), Index(50'000'000)));
  demo->add_option("-a,--angle", out.demo_angle_deg,
                   "ball: how far it swings towards the mast, in degrees (default 30)");
  demo->add_option("-d,--directory", out.demo_folder, "Folder for the files (default demo_<name>)");
  return demo;
}

/// Why a word is no command, and what was meant; `next`: the word after it, or nothing.
std::string no_command(std::string const& word, std::string const& next) {
  std::string const text = "unknown command '" + word + "'";
  bool const of_command = std::find(command_names.begin(), command_names.end(), next) != command_names.end();
  if (word == "help") return text + "; did you mean 'gridmorph " + (of_command ? next + " " : "") + "--help'?";
  if (word == "version") return text + "; did you mean 'gridmorph --version'?";
  std::error_code error;
  if (std::filesystem::exists(word, error))
    return text + "; did you mean 'gridmorph " + (word.ends_with(".toml") ? "morph " : "inspect ") + word + "'?";
  return text + suggestion(word, command_names);
}

/// The option that was meant by one that there is not; empty where nothing is near.
std::string option_like(std::string const& word, std::vector<std::string> const& long_names,
                        std::vector<std::string> const& short_names) {
  auto const has = [](std::vector<std::string> const& names, std::string const& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (word == "-V" || word == "-v") return "--version";
  if (word == "-?") return "--help";
  std::string const name = word.substr(word.starts_with("--") ? 2 : 1);
  if (name.size() > 1) {
    std::string const near = has(long_names, name) ? name : nearest_word(name, long_names);
    return near.empty() ? "" : "--" + near;
  }
  char const letter = name.empty() ? ' ' : name.front();
  std::string const other(1, char(std::isupper(letter) != 0 ? std::tolower(letter) : std::toupper(letter)));
  return has(short_names, other) ? "-" + other : "";
}

/// "unknown option '-V'; did you mean '--version'?" for the first option that neither the program nor the command has;
/// empty where all are known.
std::string unknown_option(CLI::App const& app, CLI::App const* command, int argc, char const* const* argv) {
  std::vector<std::string> long_names, short_names;
  for (CLI::App const* one : {&app, command}) {
    if (one == nullptr) continue;
    for (CLI::Option const* option : one->get_options()) {
      for (auto const& name : option->get_lnames()) long_names.push_back(name);
      for (auto const& name : option->get_snames()) short_names.push_back(name);
    }
  }
  for (int a = 1; a < argc && std::string(argv[a]) != "--"; ++a) {
    std::string const word = std::string(argv[a]).substr(0, std::string(argv[a]).find('='));
    if (word.size() < 2 || word.front() != '-' || to_number(word)) continue;
    bool const whole = word.starts_with("--");
    auto const& names = whole ? long_names : short_names;
    if (std::find(names.begin(), names.end(), whole ? word.substr(2) : word.substr(1, 1)) != names.end()) continue;
    std::string const near = option_like(word, long_names, short_names);
    return "unknown option '" + word + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?");
  }
  return {};
}

}  // namespace

std::variant<CommandLine, Stop> parse_command_line(int argc, char const* const* argv) {
  using Command = CommandLine::Command;
  CommandLine out;
  out.typed = quoted_words(argc, argv);
  CLI::App app("gridmorph moves an existing CFD mesh to a new boundary shape and keeps its connectivity and quality.",
               "gridmorph");
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(exit_statuses);
  app.set_version_flag("--version", version_text, "Print the versions of gridmorph, Kokkos and CGNS, and stop");
  add_common(app, out);
  app.require_subcommand(1);
  app.fallthrough();

  std::vector<std::pair<CLI::App*, Command>> commands;
  commands.emplace_back(add_morph(app, out), Command::morph);
  commands.emplace_back(add_inspect(app, out), Command::inspect);
  auto* plan = app.add_subcommand("plan", "Print stages and chains in order, with the reason for each rank");
  plan->add_option("case", out.input, "Case file (TOML)")->required();
  add_parameters(*plan, out);
  plan->add_flag("--optimise", out.optimise,
                 "Look for the order of chains of which the best is predicted, as order in [volume]");
  plan->add_flag("--all", out.all,
                 "List every chain; otherwise, where there are more than 60, an overview and the first of each stage");
  plan->add_option("--graph", out.graph, "Draw blocks, interfaces and chains: NAME.svg, or NAME.dot for Graphviz");
  commands.emplace_back(plan, Command::plan);
  auto* certify = app.add_subcommand("certify", "Show in how much of the ranges of [parameters] every design is valid");
  certify->add_option("case", out.input, "Case file (TOML) with ranges in [parameters]")->required();
  add_parameters(*certify, out);
  certify->add_option("--limit", out.limit, "Look at boxes up to so many times the ranges (default 1)")
      ->check(CLI::Range(1e-3, 1e3));
  certify->add_option("-r,--report", out.report, "Report (JSON)");
  commands.emplace_back(certify, Command::certify);
  auto* quality = app.add_subcommand("quality", "Measure one mesh, or compare a morphed mesh with its baseline");
  quality->add_option("mesh", out.input, "Mesh, or the baseline (CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK or UGRID)")
      ->required();
  quality->add_option("morphed", out.second, "Morphed mesh");
  add_quality(*quality, out, "full (default) or fast: a verdict in a fraction of the time");
  add_leave_out(*quality, out);
  commands.emplace_back(quality, Command::quality);
  commands.emplace_back(add_wheel(app, out), Command::wheel);
  commands.emplace_back(add_fillet(app, out), Command::fillet);
  commands.emplace_back(add_blocks(app, out), Command::blocks);
  commands.emplace_back(add_hexahedra(app, out), Command::hexahedra);
  commands.emplace_back(add_surface(app, out), Command::surface);
  commands.emplace_back(add_view(app, out), Command::view);
  commands.emplace_back(add_keys(app, out), Command::keys);
  commands.emplace_back(add_demo(app, out), Command::demo);
  for (auto const& [subcommand, command] : commands) {
    add_common(*subcommand, out);
    subcommand->footer(exit_statuses);
  }

  // CLI11 takes a misspelt command for a stray argument; say what it is.
  for (int a = 1; a < argc; ++a) {
    std::string const word = argv[a];
    if (word.empty() || word.front() == '-') continue;
    if (a > 1 && (std::string(argv[a - 1]) == "-t" || std::string(argv[a - 1]) == "--threads")) continue;
    if (std::find(command_names.begin(), command_names.end(), word) == command_names.end())
      return Stop{2, no_command(word, a + 1 < argc ? argv[a + 1] : "")};
    break;
  }

  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& e) {
    if (e.get_exit_code() == 0) {
      std::ostringstream text, errors;
      app.exit(e, text, errors);
      return Stop{0, text.str()};
    }
    CLI::App const* chosen = nullptr;
    for (auto const& command : commands)
      if (std::any_of(argv + 1, argv + argc, [&](char const* word) { return command.first->get_name() == word; }))
        chosen = command.first;
    std::string const help = "; see gridmorph " + (chosen != nullptr ? chosen->get_name() + " " : "") + "--help";
    if (std::string const text = unknown_option(app, chosen, argc, argv); !text.empty()) return Stop{2, text + help};
    return Stop{2, std::string(e.what()) + help};
  }
  for (auto const& [subcommand, command] : commands)
    if (subcommand->parsed()) out.command = command;
  if (out.json && out.suggest)
    return Stop{2, "inspect: --suggest prints a case file and --json prints JSON; leave out one of them"};
  return out;
}

}  // namespace gridmorph::cli
