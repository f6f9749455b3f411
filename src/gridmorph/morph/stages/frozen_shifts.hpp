// After the nodes are written: what a guard moved them by, where the plan carries that (plan/smoothing_map.hpp).
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/frozen_shifts.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/smoothing_map.hpp>

#include <string>

namespace gridmorph::stages {

template <class Exec>
class FrozenShifts {
 public:
  using Out = VectorView<typename Exec::memory_space>;
  static inline std::string const region = "gridmorph::FrozenShifts";

  /// n_boundary, n_nodes: of the plan. rotations: Plan::rotations, none for elements. Throws ConfigError where the map is another plan's.
  FrozenShifts(Exec const& exec, SmoothingMap const& map, Index n_boundary, Index n_nodes,
               Kokkos::View<Mat3*, typename Exec::memory_space> const& rotations)
      : n_modes_(map.n_modes),
        n_boundary_(checked(map, n_boundary, n_nodes)),
        n_chunks_((n_boundary + kernels::amplitude_chunk - 1) / kernels::amplitude_chunk),
        rotations_(rotations),
        gauge_(upload(exec, map.gauge, name("gauge"))),
        shift_(upload(exec, map.shift, name("shift"))),
        slide_shift_(upload(exec, map.slide_shift, name("slide_shift"))),
        node_(upload(exec, map.node, name("node"))),
        slides_(upload(exec, map.slides, name("slides"))),
        slide_nodes_(upload(exec, map.slide_nodes, name("slide_nodes"))),
        surfaces_(exec, map.surfaces),
        partial_(room_for<double>(exec, std::size_t(n_modes_ * n_chunks_), name("partial"))),
        amplitude_(room_for<double>(exec, std::size_t(2 * n_modes_), name("amplitude"))) {
    compat::fence(exec, "gridmorph::FrozenShifts (host tables may go)");
  }

  /// out: positions or displacements as they were written.
  void add(Exec const& exec, StageField<Exec> const& f, Out const& out) const {
    measure(exec, f, amplitude_.data());
    kernels::launch("gridmorph::frozen_shifts::add", exec,
                    kernels::AddShifts<Memory>{node_, of(shift_, 0), out.array()});
    slide<false>(exec, f, f, out);
  }
  /// out: rates.
  void add_rate(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& r, Out const& out) const {
    measure(exec, f, amplitude_.data());
    measure(exec, r, amplitude_.data() + n_modes_);
    kernels::launch("gridmorph::frozen_shifts::add", exec,
                    kernels::AddShifts<Memory>{node_, of(shift_, n_modes_), out.array()});
    slide<true>(exec, f, r, out);
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  static Index checked(SmoothingMap const& map, Index n_boundary, Index n_nodes) {
    if (map.n_boundary == n_boundary && map.n_nodes == n_nodes) return n_boundary;
    throw ConfigError("gridmorph::Morpher: the smoothing was recorded with a plan of " +
                      std::to_string(map.n_boundary) + " boundary nodes and " + std::to_string(map.n_nodes) +
                      " nodes, and this plan has " + std::to_string(n_boundary) + " and " + std::to_string(n_nodes) +
                      "; record it with this plan");
  }

  void measure(Exec const& exec, StageField<Exec> const& f, double* amplitude) const {
    kernels::launch("gridmorph::frozen_shifts::partial", exec,
                    kernels::PartialAmplitudes<Memory>{gauge_, f.boundary, n_boundary_, n_chunks_, partial_.data()});
    kernels::launch("gridmorph::frozen_shifts::sum", exec, 0, n_modes_,
                    kernels::SumAmplitudes{partial_.data(), n_chunks_, amplitude});
  }
  [[nodiscard]] kernels::ShiftOf<Memory> of(List<Exec, Vec3> const& shift, int first) const {
    return {shift, amplitude_.data() + first, n_modes_};
  }
  template <bool Rate>
  void slide(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& r, Out const& out) const {
    auto const read = [](kernels::Field<double> const& of) { return Baseline{of.x, of.y, of.z, of.stride}; };
    kernels::launch("gridmorph::frozen_shifts::slide", exec,
                    kernels::AddSlidingShifts<Memory, Rate>{slide_nodes_, slides_, surfaces_.surfaces, rotations_,
                                                            of(slide_shift_, 0), of(slide_shift_, Rate ? n_modes_ : 0),
                                                            read(f.skeleton), read(r.skeleton), out.array()});
  }

  int n_modes_;
  Index n_boundary_, n_chunks_;
  Kokkos::View<Mat3*, Memory> rotations_;
  List<Exec, Vec3> gauge_, shift_, slide_shift_;
  List<Exec, Index> node_;
  List<Exec, kernels::SlidingShift> slides_;
  List<Exec, kernels::SlidingNode> slide_nodes_;
  SlipSurfaceTable<Memory> surfaces_;
  List<Exec, double> partial_, amplitude_;  ///< the latter: of the field, of the rate
};

}  // namespace gridmorph::stages
