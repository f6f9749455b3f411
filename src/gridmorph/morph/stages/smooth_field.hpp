// A smooth field between boundary values: its tables and its workspace.
#pragma once

#include <gridmorph/kernels/lattice_field.hpp>
#include <gridmorph/morph/stages/upload.hpp>

namespace gridmorph::stages {

/// Value: Vec3, or kernels::AffineMotion where boundaries turn.
template <class Exec, class Value>
class SmoothField {
 public:
  SmoothField(Exec const& exec, InverseDistanceField const& plan, std::string const& label)
      : table_(upload(exec, plan, label)),
        group_(room_for<kernels::PackedValue<Value>>(exec, plan.n_groups, label + "::groups")),
        value_(room_for<kernels::PackedVec3>(exec, plan.empty() ? 0 : plan.shape.size(), label + "::values")) {}

  [[nodiscard]] bool empty() const { return table_.empty(); }
  /// given: what the boundary nodes say, in the order of the plan.
  void enqueue(Exec const& exec, Value const* given) const {
    kernels::spread_to_lattice(exec, table_, given, group_.data(), value_.data());
  }
  /// The last one enqueued.
  [[nodiscard]] kernels::LatticeField field() const { return {table_.shape, value_.data()}; }
  [[nodiscard]] List<Exec, kernels::PackedVec3> const& values() const { return value_; }

 private:
  kernels::InverseDistanceTable<typename Exec::memory_space> table_;
  List<Exec, kernels::PackedValue<Value>> group_;
  List<Exec, kernels::PackedVec3> value_;  ///< zero at nodes that nobody reads
};

}  // namespace gridmorph::stages
