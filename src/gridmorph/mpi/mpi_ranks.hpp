// Ranks of MPI: gridmorph::mpi, the only part of the library that knows of it.
#pragma once

#include <gridmorph/core/ranks.hpp>

#include <mpi.h>

#include <cstddef>
#include <memory>

namespace gridmorph {

struct MpiOptions {
  std::size_t largest_message = std::size_t(1) << 30;  ///< bytes, below 2^31; what is longer goes in pieces
};

/// The processes of an intracommunicator as Ranks, in its order. Collective over `comm`.
///
/// They talk on a duplicate of `comm`, so their messages never meet those of the program or of other Ranks. Duplicates
/// belong to `comm`, as an attribute of it: they are freed with it, in the collective MPI_Comm_free() of the program,
/// and the ends of Ranks and Channels are local. Ranks that are made when earlier ones are gone on every rank take
/// their duplicate. Used after `comm` was freed Ranks throw MachineError.
///
/// The program initialises and finalises MPI; the library never does. Ranks and their Channels are called by one thread
/// at a time and call MPI on that thread; those of Kokkos never do. With MPI_THREAD_SINGLE, as after MPI_Init(), and
/// MPI_THREAD_FUNNELED it is the thread that initialised MPI; any thread with MPI_THREAD_SERIALIZED, while no other of
/// the process is within MPI, and with MPI_THREAD_MULTIPLE. More than FUNNELED is never needed.
///
/// Throws ConfigError: MPI is not initialised, or is finalised; a thread that MPI does not expect; a communicator that
/// is none, or has two groups; largest_message out of range. What MPI itself reports ends the program, as it does
/// unless the program has set another error handler of `comm`; then it is a MachineError, on that rank alone.
[[nodiscard]] std::shared_ptr<Ranks const> mpi_ranks(MPI_Comm comm, MpiOptions const& options = {});

}  // namespace gridmorph
