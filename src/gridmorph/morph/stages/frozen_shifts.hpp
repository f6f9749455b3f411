// After the nodes are written: what a guard moved them by, where the plan carries that (plan/smoothing_map.hpp).
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/frozen_shifts.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/transposed_shifts.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/smoothing_map.hpp>

#include <string>

namespace gridmorph::stages {

template <class Exec>
class FrozenShifts {
 public:
  using Out = VectorView<typename Exec::memory_space>;
  static inline std::string const region = "gridmorph::FrozenShifts";

  /// n_boundary, n_nodes: of the plan. rotations: Plan::rotations, none for elements. Throws ConfigError where the map
  /// is another plan's.
  FrozenShifts(Exec const& exec, SmoothingMap const& map, Index n_boundary, Index n_nodes,
               Kokkos::View<Mat3*, typename Exec::memory_space> const& rotations, bool back)
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
    if (back) {
      n_moved_chunks_ = (map.n_moved() + kernels::amplitude_chunk - 1) / kernels::amplitude_chunk;
      partial_gradient_ = room_for<double>(exec, std::size_t(n_modes_ * n_moved_chunks_), name("partial_gradient"));
      of_shift_ = room_for<Vec3>(exec, map.slide_nodes.size(), name("of_shift"));
      of_slot_ = room_for<Vec3>(exec, map.slide_nodes.size(), name("of_slot"));
      TransposedEntries of_slots;
      for (std::size_t k = 0; k < map.slide_nodes.size(); ++k)
        of_slots.add(Index32(map.slides[map.slide_nodes[k].slide].slot), Index32(k), 1);
      slots_ = upload(exec, of_slots, {}, name("slots")).rows;
    }
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

  /// Whether its transpose depends on where the stages have put the nodes.
  [[nodiscard]] bool bends() const { return slide_nodes_.extent(0) > 0; }
  /// Before the stages: gradients of nodes, to slots where nodes slide, and to the amplitudes.
  void transpose_nodes(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& g) const {
    using kernels::launch;
    measure(exec, f, amplitude_.data());
    kernels::AddSlidingShifts<Memory, true> const sliding{slide_nodes_,
                                                          slides_,
                                                          surfaces_.surfaces,
                                                          rotations_,
                                                          of(slide_shift_, 0),
                                                          of(slide_shift_, 0),
                                                          as_read(f.skeleton),
                                                          as_read(f.skeleton),
                                                          {}};
    if (slide_nodes_.extent(0) > 0) {
      launch("gridmorph::transposed::shifts::slide", exec,
             kernels::SlidingShiftsBack<Memory>{sliding, g.nodes, of_shift_.data(), as_field(of_slot_.data())});
      launch("gridmorph::transposed::shifts::slots", exec, 0, slots_.size(),
             kernels::AddToField<Memory>{slots_, of_slot_.data(), g.skeleton});
    }
    launch("gridmorph::transposed::shifts::partial", exec,
           kernels::PartialShiftGradients<Memory>{node_, shift_, slide_nodes_, slide_shift_, g.nodes, of_shift_.data(),
                                                  n_modes_, n_moved_chunks_, partial_gradient_.data()});
    launch("gridmorph::transposed::shifts::sum", exec, 0, n_modes_,
           kernels::SumAmplitudes{partial_gradient_.data(), n_moved_chunks_, amplitude_.data() + n_modes_});
  }
  /// After them: from the amplitudes to the boundary.
  void transpose_boundary(Exec const& exec, StageField<Exec> const& g) const {
    kernels::launch(
        "gridmorph::transposed::shifts::gauges", exec, 0, n_boundary_,
        kernels::AddGauges<Memory>{gauge_, amplitude_.data() + n_modes_, n_boundary_, n_modes_, g.boundary});
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
    kernels::launch("gridmorph::frozen_shifts::slide", exec,
                    kernels::AddSlidingShifts<Memory, Rate>{slide_nodes_, slides_, surfaces_.surfaces, rotations_,
                                                            of(slide_shift_, 0), of(slide_shift_, Rate ? n_modes_ : 0),
                                                            as_read(f.skeleton), as_read(r.skeleton), out.array()});
  }
  static Baseline as_read(kernels::Field<double> const& of) { return {of.x, of.y, of.z, of.stride}; }

  int n_modes_;
  Index n_boundary_, n_chunks_;
  Kokkos::View<Mat3*, Memory> rotations_;
  List<Exec, Vec3> gauge_, shift_, slide_shift_;
  List<Exec, Index> node_;
  List<Exec, kernels::SlidingShift> slides_;
  List<Exec, kernels::SlidingNode> slide_nodes_;
  SlipSurfaceTable<Memory> surfaces_;
  List<Exec, double> partial_, amplitude_;  ///< the latter: of the field, of the rate or the gradient
  // Of transposes.
  Index n_moved_chunks_ = 0;
  List<Exec, double> partial_gradient_;
  List<Exec, Vec3> of_shift_, of_slot_;  ///< per node that slides
  kernels::TransposedRows<Memory> slots_;
};

}  // namespace gridmorph::stages
