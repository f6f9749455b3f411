// gridmorph: morph, inspect, plan, quality, wheel, fillet, blocks, hexahedra, surface, view, keys, demo.
//
//   gridmorph inspect passage.cgns
//   gridmorph plan case.toml
//   gridmorph morph case.toml --report report.json
//   gridmorph quality passage.cgns passage_morphed.cgns
//   gridmorph wheel case.toml
//   gridmorph demo passage --nodes 1000000
//
// Parses the command line, runs one command, and turns errors into messages and exit statuses.
#include <gridmorph/command/command_line.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/command/kokkos_session.hpp>
#include <gridmorph/command/terminal.hpp>
#include <gridmorph/command/threads.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/output_file.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <variant>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using namespace gridmorph::cli;

int run(CommandLine const& options, Terminal& terminal) {
  using Command = CommandLine::Command;
  switch (options.command) {
    case Command::morph: return run_morph_command(options, terminal);
    case Command::inspect: return run_inspect_command(options, terminal);
    case Command::plan: return run_plan_command(options, terminal);
    case Command::certify: return run_certify_command(options, terminal);
    case Command::quality: return run_quality_command(options, terminal);
    case Command::wheel: return run_wheel_command(options, terminal);
    case Command::fillet: return run_fillet_command(options, terminal);
    case Command::blocks: return run_blocks_command(options, terminal);
    case Command::hexahedra: return run_hexahedra_command(options, terminal);
    case Command::surface: return run_surface_command(options, terminal);
    case Command::view: return run_view_command(options, terminal);
    case Command::keys: return run_keys_command(options, terminal);
    case Command::demo: return run_demo_command(options, terminal);
  }
  return bad_input;
}

bool names_case_file(CommandLine const& options) {
  using Command = CommandLine::Command;
  return options.command == Command::morph || options.command == Command::plan || options.command == Command::wheel ||
         options.command == Command::certify;
}

/// The exit status of work that prints through the terminal; errors become messages.
template <class Work>
int report_errors(Terminal& terminal, Work const& work) {
  try {
    int const status = work();
    terminal.finish();
    return status;
  } catch (gridmorph::MachineError const& e) {
    terminal.error(e.what());
    return machine_failure;
  } catch (gridmorph::Error const& e) {
    terminal.error(e.what());
    return bad_input;
  } catch (std::bad_alloc const&) {
    terminal.error("out of memory; use a machine with more memory, or a smaller mesh");
    return machine_failure;
  } catch (std::filesystem::filesystem_error const& e) {
    terminal.error(e.what());
    return machine_failure;
  } catch (std::exception const& e) {
    std::string const what = e.what();
    bool const memory =
        what.find("allocat") != std::string::npos;  // Kokkos reports failed allocations as runtime errors
    terminal.error((memory ? "out of memory: " : "internal failure: ") + what);
    return machine_failure;
  }
}

/// Libraries throw on threads of their own, where nobody can catch it: Kokkos, when memory runs out while it starts.
/// The status is then what it would be otherwise, and nothing half-written is left.
[[noreturn]] void end_with_status() {
  bool memory = false;
  if (auto const thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (std::bad_alloc const&) {
      memory = true;
    } catch (std::exception const& e) {
      memory = std::strstr(e.what(), "llocation") != nullptr;
    } catch (...) {
    }
  }
  std::fputs(memory ? "gridmorph: error: out of memory; use a machine with more memory, or a smaller mesh\n"
                    : "gridmorph: error: internal failure\n",
             stderr);
  gridmorph::io::remove_pending_files();
  std::_Exit(machine_failure);
}

/// Memory that was freed is kept and used again. Large arrays come and go from stage to stage; fresh pages, which the
/// system clears first, cost as much as most stages do (a quarter of the time with 10 million elements, for an eighth
/// more memory).
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);  // what is mapped on its own goes back to the system at once
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_TOP_PAD, 1 << 26);
#endif
}

}  // namespace

int main(int argc, char** argv) try {
  keep_freed_memory();
  std::set_terminate(end_with_status);
  // A reader that goes away, or a file that may not grow, is an error to report, not a reason to die.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  gridmorph::io::remove_pending_on_signals();
  auto parsed = parse_command_line(argc, argv);
  if (auto const* stop = std::get_if<Stop>(&parsed)) {
    Terminal terminal(false);
    if (stop->status != 0) {
      terminal.error(stop->text);
      return stop->status;
    }
    return report_errors(terminal, [&] {
      terminal.result(stop->text);
      return int(done);
    });
  }
  auto& options = std::get<CommandLine>(parsed);
  gridmorph::io::FilesRead const read;  // whatever is read from here on is not written over
  using Command = CommandLine::Command;
  bool const computes = options.command != Command::keys;
  if (computes) wait_passively(argv);
  Terminal terminal(options.quiet, options.json);
  return report_errors(terminal, [&] {
    if (!computes) return run(options, terminal);
    if (names_case_file(options)) options.case_document.emplace(options.input);
    KokkosSession const session(choose_threads(options, terminal));
    return run(options, terminal);
  });
} catch (...) {  // what fails in reporting a failure, when memory has run out
  std::fputs("gridmorph: error: internal failure\n", stderr);
  return machine_failure;
}
