// What both kinds of morph do with what they are given.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/mesh/vector_view.hpp>

#include <Kokkos_Core.hpp>

#include <string>

namespace gridmorph::detail {

inline void require_all_nodes(char const* who, Index given, Index needed) {
  if (given != needed)
    throw ConfigError(std::string(who) + ": vectors for " + std::to_string(given) + " nodes, and the plan's mesh has " +
                      std::to_string(needed) + "; give one for each");
}

inline void require_as_many(char const* who, std::size_t boundary, std::size_t fields) {
  if (boundary != fields)
    throw ConfigError(std::string(who) + ": " + std::to_string(boundary) + " boundary displacements and " +
                      std::to_string(fields) + " fields to write; give as many");
}

/// What is launched while this lives shows in profiles under a name of its own.
class ProfilingRegion {
 public:
  explicit ProfilingRegion(std::string const& name) { Kokkos::Profiling::pushRegion(name); }
  ~ProfilingRegion() { Kokkos::Profiling::popRegion(); }
  ProfilingRegion(ProfilingRegion const&) = delete;
  ProfilingRegion& operator=(ProfilingRegion const&) = delete;
};

struct CopyVectors {
  kernels::VectorArray from;
  kernels::Field<double> to;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { to.set(n, from[n]); }
};

/// Component arrays of double: the caller's own, or a copy.
template <class Exec>
struct FlatBaseline {
  using Memory = typename Exec::memory_space;
  Kokkos::View<double*, Memory> copy;
  kernels::Field<double const> field{nullptr, nullptr, nullptr};

  FlatBaseline() = default;
  FlatBaseline(Exec const& exec, ConstVectorView<Memory> const& x) {
    kernels::VectorArray const& from = x.array();
    if (from.zones == nullptr && !from.single) {
      auto const pointer = [](void* p) { return static_cast<double const*>(p); };
      field = {pointer(from.x), pointer(from.y), pointer(from.z), from.stride};
      return;
    }
    Index const n = x.size();
    copy = Kokkos::View<double*, Memory>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::Morpher::baseline"), 3 * n);
    kernels::Field<double> const to{copy.data(), copy.data() + n, copy.data() + 2 * n};
    kernels::launch("gridmorph::baseline", exec, 0, n, CopyVectors{from, to});
    field = {to.x, to.y, to.z, to.stride};
  }
};

}  // namespace gridmorph::detail
