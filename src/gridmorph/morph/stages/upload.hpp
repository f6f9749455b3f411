// Host tables of a plan in the memory of an execution space. Copies are enqueued: the host tables must stay until the
// instance has been fenced.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/enqueue_copy.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/layers.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph::stages {

template <class Exec, class T>
using List = Kokkos::View<T*, typename Exec::memory_space>;

/// Workspace, at first zero: nodes of the background's outer box that no boundary moves stay so.
template <class T, class Exec>
List<Exec, T> room_for(Exec const& exec, std::size_t n, std::string const& label) {
  return List<Exec, T>(Kokkos::view_alloc(exec, label), n);
}

template <class Exec, class T>
List<Exec, T> upload(Exec const& exec, std::vector<T> const& host, std::string const& label) {
  return detail::enqueue_copy(exec, host, label);
}

template <class Exec>
kernels::InterpolationTable<typename Exec::memory_space> upload(Exec const& exec, InterpolationOperator const& rows,
                                                                std::string const& label) {
  return {upload(exec, rows.target, label + "::target"), upload(exec, rows.first, label + "::first"),
          upload(exec, rows.item, label + "::item"), upload(exec, rows.weight, label + "::weight")};
}

template <class Exec>
kernels::LayerTable<typename Exec::memory_space> upload(Exec const& exec, LayerRows const& layers,
                                                        std::string const& label) {
  return {upload(exec, layers.rows, label), layers.level};
}

/// Those of `nodes` that rows read, ascending: of boundary layers only the ends of columns. Fences.
template <class Exec>
List<Exec, Index32> upload_sources(Exec const& exec, std::vector<Index32> const& nodes, LayerRows const& layers,
                                   Index n_nodes, std::string const& label) {
  std::vector<std::uint8_t> read(n_nodes, 0);
  for (Index32 const n : layers.rows.item) read[n] = 1;
  std::vector<Index32> sources;
  for (Index32 const n : nodes)
    if (read[n] != 0) sources.push_back(n);
  std::sort(sources.begin(), sources.end());
  auto const out = upload(exec, sources, label);
  compat::fence(exec, "gridmorph::upload_sources (host tables may go)");
  return out;
}

/// Fences.
template <class Exec>
kernels::InverseDistanceTable<typename Exec::memory_space> upload(Exec const& exec, InverseDistanceField const& field,
                                                                  std::string const& label) {
  std::vector<kernels::PackedVec3> centre;
  for (Vec3 const& c : field.centre) centre.push_back({c.x, c.y, c.z});
  kernels::InverseDistanceTable<typename Exec::memory_space> const table{
      upload(exec, field.leaves, label + "::leaves"), upload(exec, field.groups, label + "::groups"),
      upload(exec, field.lattice, label + "::lattice"), upload(exec, centre, label + "::centre"), field.shape};
  compat::fence(exec, "gridmorph::upload (centres of groups may go)");
  return table;
}

}  // namespace gridmorph::stages
