// The end of a morph: displacements or positions of all nodes.
#pragma once

#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/stages/block_volume.hpp>
#include <gridmorph/morph/stages/skeleton.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace gridmorph::stages {

/// Nodes of blocks: those of the skeleton from their slots, those inside pieces by the one pass through the volume.
template <class Exec>
class WriteBlocks {
 public:
  using Out = VectorView<typename Exec::memory_space>;

  explicit WriteBlocks(BlockTables<Exec> tables) : tables_(std::move(tables)) {}

  /// The fields are neighbours in the workspace.
  template <bool Move>
  void write(Exec const& exec, Baseline const&, kernels::VectorArray const& x, std::span<StageField<Exec> const> fields,
             std::span<Out const> out) const {
    for (std::size_t done = 0; done < out.size(); done += kernels::most_fields_at_once) {
      std::size_t const n = std::min<std::size_t>(out.size() - done, kernels::most_fields_at_once);
      write_at_once<Move>(exec, x, fields.subspan(done, n), out.subspan(done, n));
    }
  }

  /// Gradients of the skeleton, from those of its nodes; nodes inside pieces hand theirs to the stages.
  void transpose(Exec const& exec, StageField<Exec> const& g) const {
    using kernels::ClearVectors;
    auto const& plan = *tables_;
    kernels::launch("gridmorph::transposed::clear", exec, 0, plan.skeleton.n, ClearVectors{g.skeleton});
    kernels::copy_back<true>("gridmorph::transposed::skeleton", exec, plan.transposed->skeleton_nodes, plan.rotations,
                             g.nodes, g.skeleton);
    detail::BlockTurnGradients<Exec>(plan, 0, g.number).clear(exec);
  }

 private:
  template <bool Move>
  void write_at_once(Exec const& exec, kernels::VectorArray const& x, std::span<StageField<Exec> const> fields,
                     std::span<Out const> out) const {
    auto const& plan = *tables_;
    auto volume = volume_pass<Move>(plan, x, fields.front());
    for (Out const& field : out) {
      kernels::write_skeleton_nodes<Move>(exec, plan.skeleton_nodes, plan.rotations,
                                          read(fields[std::size_t(volume.n_fields)].skeleton), field.array(), x);
      volume.out[volume.n_fields++] = field.array();
    }
    kernels::pass_volume(exec, plan.boxes.n_items, volume);
  }

  BlockTables<Exec> tables_;
};

/// Nodes of elements, each with its displacement in StageField::u.
template <class Exec>
struct WriteElements {
  using Out = VectorView<typename Exec::memory_space>;

  template <bool Move>
  void write(Exec const& exec, Baseline const& x, kernels::VectorArray const&, std::span<StageField<Exec> const> fields,
             std::span<Out const> out) const {
    for (std::size_t f = 0; f < out.size(); ++f)
      kernels::launch(Move ? "gridmorph::move" : "gridmorph::write", exec, 0, out[f].size(),
                      kernels::WriteNodes<Move>{fields[f].u.data(), x, out[f].array()});
  }

  void transpose(Exec const& exec, StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::nodes", exec, 0, Index(g.u.extent(0)),
                    kernels::ReadNodes{g.nodes, g.u.data()});
    clear<Vec3>(exec, g.given);
    clear<kernels::AffineMotion>(exec, g.frames);
  }
};

}  // namespace gridmorph::stages
