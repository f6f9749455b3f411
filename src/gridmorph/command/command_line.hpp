// The command line as a value.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/run/view.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace gridmorph::cli {

struct CommandLine {
  enum class Command {
    morph,
    inspect,
    plan,
    certify,
    quality,
    wheel,
    fillet,
    blocks,
    hexahedra,
    surface,
    view,
    keys,
    demo
  };
  Command command = Command::morph;
  bool quiet = false;
  int threads = 0;  ///< 0: what OMP_NUM_THREADS or the machine says

  std::string typed;                            ///< the command line, as a shell reads it
  std::filesystem::path input;                  ///< case file or mesh
  std::optional<CaseDocument> case_document;    ///< morph, plan, wheel: `input`, once it is read
  std::optional<std::filesystem::path> second;  ///< quality, view: morphed mesh
  std::optional<std::filesystem::path>
      output;  ///< morph, wheel: instead of the case file's; what others write; view: a folder
  std::optional<std::filesystem::path> report;  ///< morph, wheel: instead of the case file's
  std::optional<std::filesystem::path> page;    ///< morph, wheel: the report as a page, instead of the case file's
  std::optional<double> fraction;               ///< morph: of the motion
  ParameterValues parameters;                   ///< morph, plan, wheel: in place of the case file's
  std::optional<double> limit;                  ///< certify: of the ranges
  bool dry_run = false;
  bool all = false;                            ///< plan: every chain of however many
  bool optimise = false;                       ///< plan: order of chains by prediction
  std::optional<std::filesystem::path> graph;  ///< plan: a drawing of its blocks and chains goes there
  std::optional<std::string> quality;          ///< morph, wheel: instead of the case file's; quality: "fast" or "full"
  bool json = false;
  std::optional<std::filesystem::path> side_file;        ///< inspect: of the mesh, instead of the one beside it
  std::optional<std::filesystem::path> write_side_file;  ///< inspect: what was found goes there
  std::optional<std::string> suggest;  ///< inspect: a case file to start from, to this file; empty: printed
  std::vector<std::string> leave_out;  ///< inspect, quality, surface: bases and zones that are no part of the mesh
  bool match = false;                  ///< inspect: look for interfaces
  bool match_periodic = true;          ///< inspect: and for periodicity
  double match_tolerance = 0.01;       ///< inspect: share of the smallest edge

  TopologyOptions topology;                   ///< fillet, hexahedra
  std::vector<std::string> patches;           ///< surface; fillet: of the blade; selectors
  std::vector<std::string> end_walls;         ///< fillet: selectors
  std::string radius;                         ///< fillet: a number or an expression
  int blade_layers = 0, end_wall_layers = 0;  ///< fillet: 0: by the radius
  double run_out = 8;                         ///< fillet: radii
  int split = 1;                              ///< surface: pieces along each side of a facet
  bool ascii = false;                         ///< surface: text, not binary

  ViewRequest view;                ///< view: all but the meshes
  std::vector<std::string> names;  ///< keys: of keys and tables

  std::string demo_name;
  std::optional<std::string> demo_motion;  ///< passage
  std::optional<std::string> demo_tip;     ///< passage
  std::optional<double> demo_gap;          ///< passage, in span
  std::optional<double> demo_first_cell;   ///< passage, in span
  std::optional<std::string> demo_axis;    ///< passage
  bool demo_single = false;                ///< passage
  std::optional<Index> demo_nodes;         ///< passage, aircraft
  std::optional<Index> demo_elements;      ///< ball
  std::optional<double> demo_angle_deg;    ///< ball
  std::filesystem::path demo_folder;       ///< empty: "demo_<name>"
};

/// The program should stop here: help and version texts (status 0, standard output) or a wrong command line (status 2,
/// standard error).
struct Stop {
  int status = 0;
  std::string text;
};

std::variant<CommandLine, Stop> parse_command_line(int argc, char const* const* argv);

}  // namespace gridmorph::cli
