// What the stages of a morph work on: one displacement field, from the boundary's to that of all nodes.
//
// A stage uploads its part of the plan when it is made, on the instance it is given, and allocates its workspace. Then
//
//   enqueue(exec, x, field)       enqueues its kernels on a field: no allocation, no fence, no copy, no host decision
//   rate(exec, x, field, rate)    the same for a field and for its rate of change; a stage without it is linear
#pragma once

#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/morph/stages/upload.hpp>

namespace gridmorph::stages {

template <class Exec>
struct StageField {
  kernels::VectorArray boundary;             ///< displacements of UnstructuredPlan::known
  List<Exec, Vec3> u;                        ///< (n_nodes)
  List<Exec, Vec3> work;                     ///< (n_nodes)
  List<Exec, kernels::AffineMotion> frames;  ///< motions of the moving walls around their nodes

  StageField(Exec const& exec, Index n_nodes, std::size_t n_walls, std::string const& label)
      : u(room_for<Vec3>(exec, std::size_t(n_nodes), label + "::u")),
        work(room_for<Vec3>(exec, std::size_t(n_nodes), label + "::work")),
        frames(room_for<kernels::AffineMotion>(exec, n_walls, label + "::frames")) {}
};

using Baseline = kernels::Field<double const>;

}  // namespace gridmorph::stages
