// The transpose of what boundaries ask of their nodes (kernels/slip_nodes.hpp), with what it is linearised at.
#pragma once

#include <gridmorph/morph/stages/transposed_tables.hpp>

#include <string>
#include <vector>

namespace gridmorph::stages {

template <class Exec>
class AskedBack {
 public:
  using Memory = typename Exec::memory_space;

  AskedBack() = default;
  /// slot: of each entry of the table, -1: none. bends: whether there are surfaces in it.
  AskedBack(Exec const& exec, std::vector<Index32> const& slot, bool bends, std::string const& label)
      : bends_(bends),
        of_slots_(transposed(exec, slot, nullptr, label)),
        kept_(room_for<Vec3>(exec, slot.size(), label + "::kept")),
        listed_(room_for<Vec3>(exec, slot.size(), label + "::listed")) {}

  [[nodiscard]] bool bends() const { return bends_; }
  void keep(Exec const& exec, kernels::SlipNodeTable<Memory> const& table, kernels::VectorArray const& boundary,
            List<Exec, Vec3> const& asked) const {
    kernels::launch("gridmorph::transposed::keep_asked", exec,
                    kernels::KeepAsked<Memory>{table, boundary, asked.data(), kept_.data()});
  }
  /// asked: gradients of what nodes were asked for, then of their own displacement before; given: += those of slots.
  void enqueue(Exec const& exec, kernels::SlipNodeTable<Memory> const& table, Baseline const& x,
               List<Exec, Vec3> const& asked, List<Exec, Vec3> const& given) const {
    kernels::AskNodes<Memory, false> const ask{table, {}, {}, x, nullptr, nullptr};
    kernels::launch("gridmorph::transposed::asked", exec,
                    kernels::AskNodesBack<Memory>{ask, kept_.data(), asked.data(), listed_.data()});
    kernels::gather_rows("gridmorph::transposed::asked::slots", exec, of_slots_, listed_.data(), given.data());
  }

 private:
  bool bends_ = false;
  kernels::TransposedRows<Memory> of_slots_;
  List<Exec, Vec3> kept_, listed_;
};

}  // namespace gridmorph::stages
