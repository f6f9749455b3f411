// Kokkos for the length of a Python program, and one call at a time.
#pragma once

#include <gridmorph/command/kokkos_session.hpp>

#include <nanobind/nanobind.h>

#include <memory>
#include <mutex>
#include <optional>

namespace gridmorph::python {

/// Kokkos, started by the first object of the package and ended with the last one: arrays and meshes may outlive the
/// interpreter's exit handlers. Where the program runs this Kokkos already it is left alone.
class Session {
 public:
  Session(Session const&) = delete;
  Session& operator=(Session const&) = delete;
  ~Session();

  /// Starts Kokkos where it does not run. `threads` 0: OMP_NUM_THREADS, else all that the machine has. Throws
  /// ConfigError for another number than that of a session that runs, and on a thread that an old Kokkos does not take
  /// calls from.
  static std::shared_ptr<Session> get(int threads = 0);
  /// The interpreter goes: no new object comes.
  static void leave();

 private:
  explicit Session(int threads);
  std::optional<cli::KokkosSession> own_;
};

/// For the length of a call: the interpreter goes on with other threads, other calls wait. A call uses all threads of
/// Kokkos, and the CGNS library takes one at a time.
class Call {
 public:
  Call();

 private:
  std::shared_ptr<Session> session_;
  nanobind::gil_scoped_release released_;  // before the lock: who waits for it must not hold the interpreter
  std::scoped_lock<std::recursive_mutex> lock_;
};

}  // namespace gridmorph::python
