// Lists of stages, run forwards, for rates and in reverse.
#pragma once

#include <gridmorph/morph/detail/baseline.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace gridmorph::stages {

/// Calls run(stage) for each stage in a profiling region of its own.
template <class Any, class Run>
void for_each_stage(std::vector<Any> const& list, Run const& run) {
  for (auto const& any : list)
    std::visit(
        [&](auto const& stage) {
          gridmorph::detail::ProfilingRegion const region(stage.region);
          run(stage);
        },
        any);
}

template <class Exec, class Any>
void enqueue_all(std::vector<Any> const& list, Exec const& exec, Baseline const& x, StageField<Exec> const& f) {
  for_each_stage(list, [&](auto const& stage) { stage.enqueue(exec, x, f); });
}

template <class Exec, class Any>
void enqueue_rates(std::vector<Any> const& list, Exec const& exec, Baseline const& x, StageField<Exec> const& f,
                   StageField<Exec> const& r) {
  for_each_stage(list, [&](auto const& stage) {
    if constexpr (requires { stage.rate(exec, x, f, r); }) {
      stage.rate(exec, x, f, r);
    } else {
      stage.enqueue(exec, x, f);
      stage.enqueue(exec, x, r);
    }
  });
}

/// How many stages come up to the last one whose derivative depends on where the mesh is.
template <class Any>
std::size_t n_that_bend(std::vector<Any> const& list) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < list.size(); ++k)
    std::visit(
        [&](auto const& stage) {
          if constexpr (requires { stage.bends(); })
            if (stage.bends()) n = k + 1;
        },
        list[k]);
  return n;
}

/// What transposes of the first n stages are taken at, forwards. Of the last one only that, unless others run after it.
template <class Exec, class Any>
void linearise(std::vector<Any> const& list, std::size_t n, bool others_follow, Exec const& exec, Baseline const& x,
               StageField<Exec> const& f) {
  for (std::size_t k = 0; k < n; ++k)
    std::visit(
        [&](auto const& stage) {
          gridmorph::detail::ProfilingRegion const region(stage.region);
          constexpr bool keeps = requires { stage.keep(exec, x, f); };
          if (keeps && k + 1 == n && !others_follow) {
            if constexpr (keeps) stage.keep(exec, x, f);
          } else if constexpr (requires { stage.enqueue_kept(exec, x, f); }) {
            stage.enqueue_kept(exec, x, f);
          } else {
            stage.enqueue(exec, x, f);
          }
        },
        list[k]);
}

template <class Exec, class Any>
void transpose_all(std::vector<Any> const& list, Exec const& exec, Baseline const& x, StageField<Exec> const& f,
                   StageField<Exec> const& g) {
  for (auto any = list.rbegin(); any != list.rend(); ++any)
    std::visit(
        [&](auto const& stage) {
          gridmorph::detail::ProfilingRegion const region("transposed " + stage.region);
          stage.transpose(exec, x, f, g);
        },
        *any);
}

}  // namespace gridmorph::stages
