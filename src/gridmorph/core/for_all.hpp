// A loop over an instance of the host, for host code; internal.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#include <exception>
#include <mutex>
#include <string>
#include <type_traits>

namespace gridmorph::detail {

/// Keeps what the body of a loop throws (memory that has run out, most of all), which would end the program where it
/// left a thread: of several numbers what the smallest one threw.
class Thrown {
 public:
  template <class Function, class Number>
  void guard(Function const& f, Number n) {
    try {
      f(n);
    } catch (...) {
      std::lock_guard const lock(turn_);
      if (first_ && number_ < Index(n)) return;
      first_ = std::current_exception();
      number_ = Index(n);
    }
  }
  /// Throws it on the thread that asked for the loop, once the loop has ended.
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::mutex turn_;
  std::exception_ptr first_;
  Index number_ = 0;
};

/// Calls f(n) for 0 <= n < count on the instance, and waits; f writes nothing that another n writes. In equal shares,
/// for small work. What f throws comes out here, once all other calls are made.
template <class Function>
void for_all(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  host.visit([&](auto const& exec) {
    using Exec = std::decay_t<decltype(exec)>;
    Thrown thrown;
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, count),
                         [&](Index n) { thrown.guard(f, n); });
    compat::fence(exec, (label + " (read by the host)").c_str());
    thrown.rethrow();
  });
}

/// Calls f(n) for 0 <= n < count as for_all() does, but one by one as cores become free, for large work.
template <class Function>
void for_all_parts(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  host.visit([&](auto const& exec) {
    using Exec = std::decay_t<decltype(exec)>;
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Dynamic>>;
    Thrown thrown;
    Kokkos::parallel_for(label, Policy(exec, 0, count, Kokkos::ChunkSize(1)), [&](Index n) { thrown.guard(f, n); });
    compat::fence(exec, (label + " (read by the host)").c_str());
    thrown.rethrow();
  });
}

}  // namespace gridmorph::detail
