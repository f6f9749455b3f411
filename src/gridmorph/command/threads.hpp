// Threads that share a machine with others: how they wait, and how many they are.
#pragma once

#include <gridmorph/command/command_line.hpp>
#include <gridmorph/command/terminal.hpp>

namespace gridmorph::cli {

/// Starts the program itself anew with OMP_WAIT_POLICY=passive where nobody has said how OpenMP's threads wait, and
/// returns where somebody has, or where that cannot be done. At a barrier threads would otherwise spin for milliseconds
/// while the thread they wait for has no processor: five to ten times the time on a machine with other work. The
/// runtime reads the variable once, when it is loaded, so that setting it in main is too late. Same arguments, process
/// and exit status; costs some milliseconds.
void wait_passively(char** argv);

/// Threads for Kokkos: what --threads says; 0, Kokkos' own choice, where the environment says it (OMP_NUM_THREADS,
/// KOKKOS_NUM_THREADS); else as many as the process may use (affinity, quota of a container), and fewer for small
/// meshes, judged by the size of the file: a thread with less than some 20,000 nodes waits more than it works. More
/// than Kokkos has places for are cut down, with a warning.
int choose_threads(CommandLine const& options, Terminal& terminal);

}  // namespace gridmorph::cli
