// What the stages of a morph work on: one displacement field, from the boundary's to that of all nodes.
//
// A stage uploads its part of the plan when it is made, on the instance it is given, and allocates its workspace. Then
//
//   enqueue(exec, x, field)       enqueues its kernels on a field: no allocation, no fence, no copy, no host decision
//   rate(exec, x, field, rate)    the same for a field and for its rate of change; a stage without it is linear
//   region                        its name in profiles
//
// Where its transpose is asked for
//
//   transpose(exec, x, field, g)  gradients g of what it writes become those of what it reads
//   bends()                       whether that depends on the field; a stage without it is linear. Those before one
//                                 that bends run forwards first
//   enqueue_kept(exec, x, field)  enqueue, and what its transpose is linearised at is kept, where enqueue alone does
//                                 not keep it
//   keep(exec, x, field)          that alone: of the last stage that bends nothing else is needed
//
// What comes last writes the nodes: write<Move>(exec, x, baseline, fields, out), with Move baseline + u, otherwise u.
#pragma once

#include <gridmorph/kernels/common_motion.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/morph/stages/upload.hpp>

namespace gridmorph::stages {

template <class Exec>
struct StageField {
  kernels::VectorArray boundary;  ///< displacements of MorphPlan::boundary_nodes()
  kernels::VectorArray nodes;     ///< gradients of all nodes, where a field holds gradients
  kernels::VectorArray baseline;  ///< coordinates, as the caller has them

  // Blocks: parts of the workspaces of DevicePlan.
  int number = 0;                                               ///< which field of theirs
  int of = 0;                                                   ///< itself, or which field it holds the rates of
  kernels::Field<double> skeleton{nullptr, nullptr, nullptr};   ///< per slot
  kernels::Field<double> ends{nullptr, nullptr, nullptr};       ///< at the ends of lines
  kernels::Field<double> residuals{nullptr, nullptr, nullptr};  ///< on known sides of chains

  // Elements.
  List<Exec, Vec3> u;                           ///< (n_nodes)
  List<Exec, Vec3> work;                        ///< (n_nodes)
  List<Exec, Vec3> given;                       ///< of gradients: those of boundary nodes
  List<Exec, Vec3> kept_given;                  ///< `boundary` on slip surfaces, where these hold any of it
  List<Exec, Vec3> read;                        ///< of gradients: those of what nodes read of lattices, (n_nodes)
  kernels::CommonMove const* common = nullptr;  ///< what u has besides what stages have made of it
  kernels::CommonMap* common_parts = nullptr;   ///< of gradients: room for what is handed to that
  List<Exec, kernels::AffineMotion>
      frames;  ///< motions of the moving walls around their nodes, then of what moves beside them
};

/// Coordinates of the baseline as arrays of double.
using Baseline = kernels::Field<double const>;

}  // namespace gridmorph::stages
