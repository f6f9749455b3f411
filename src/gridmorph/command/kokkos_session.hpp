// Kokkos for the length of main, on every supported version.
#pragma once

#include <Kokkos_Core.hpp>

namespace gridmorph::cli {

/// Kokkos' OpenMP has places for so many threads, and writes beyond them without a word.
inline constexpr int most_threads = 512;

class KokkosSession {
 public:
  /// threads 0: Kokkos' own choice. Its warnings about thread binding are not for users of a command.
  explicit KokkosSession(int threads) {
#if KOKKOS_VERSION >= 30700
    Kokkos::InitializationSettings settings;
    settings.set_disable_warnings(true);
    if (threads > 0) settings.set_num_threads(threads);
#else
    Kokkos::InitArguments settings;
    settings.disable_warnings = true;
    if (threads > 0) settings.num_threads = threads;
#endif
    Kokkos::initialize(settings);
  }
  ~KokkosSession() { Kokkos::finalize(); }
  KokkosSession(KokkosSession const&) = delete;
  KokkosSession& operator=(KokkosSession const&) = delete;
};

}  // namespace gridmorph::cli
