#include "session.hpp"

#include <gridmorph/core/error.hpp>

#include <Kokkos_Core.hpp>

#ifdef _OPENMP
#include <omp.h>
#endif

#include <string>
#include <thread>

namespace gridmorph::python {

namespace {

// Both under the interpreter's lock.
std::shared_ptr<Session> held;
std::weak_ptr<Session> running;
std::thread::id starter;

std::recursive_mutex& one_call() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// Since 4.0 threads of a host program may call one after another; before, tables of OpenMP's threads belong to the one that started it.
constexpr bool any_thread_may_call = KOKKOS_VERSION >= 40000;

/// Kokkos sets how many threads the calling thread's OpenMP regions have, for the whole process where libraries share one OpenMP.
/// Its own regions name theirs, so that the number can go back to what others of the program had.
class OthersThreads {
 public:
  OthersThreads() = default;
  OthersThreads(OthersThreads const&) = delete;
  OthersThreads& operator=(OthersThreads const&) = delete;
#ifdef _OPENMP
  ~OthersThreads() { omp_set_num_threads(number_); }

 private:
  int number_ = omp_get_max_threads();
#endif
};

}  // namespace

Session::Session(int threads) {
  OthersThreads const kept;
  if (!Kokkos::is_initialized()) own_.emplace(threads);
}

Session::~Session() {
  OthersThreads const kept;
  own_.reset();
}

std::shared_ptr<Session> Session::get(int threads) {
  auto session = running.lock();
  if (threads > cli::most_threads)
    throw ConfigError(std::to_string(threads) + " threads are asked for, and at most " +
                      std::to_string(cli::most_threads) + " can be had; ask for fewer");
  if (!session) {
    session.reset(new Session(threads));
    running = held = session;
    starter = std::this_thread::get_id();
  }
  int const has = Kokkos::DefaultHostExecutionSpace().concurrency();
  if (threads > 0 && threads != has)
    throw ConfigError("gridmorph runs on " + std::to_string(has) + " threads already, and " + std::to_string(threads) +
                      " were asked for; call set_threads() before anything else, or set OMP_NUM_THREADS");
  if (!any_thread_may_call && starter != std::this_thread::get_id())
    throw ConfigError("gridmorph was built with Kokkos " + std::to_string(KOKKOS_VERSION / 10000) + "." +
                      std::to_string(KOKKOS_VERSION / 100 % 100) +
                      ", which takes calls from the thread alone that called first; call from there, or build with "
                      "Kokkos 4 or newer");
  return session;
}

void Session::leave() { held.reset(); }

Call::Call() : session_(Session::get()), lock_(one_call()) {}

}  // namespace gridmorph::python
