// Classes of periodic images of a plan on an execution space.
#pragma once

#include <gridmorph/kernels/periodic_mean.hpp>
#include <gridmorph/morph/stages/upload.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph::stages {

/// Of the classes of `owners`, whose images are entries of UnstructuredPlan::images. Fences.
template <class Exec>
kernels::PeriodicTable<typename Exec::memory_space> periodic_table(Exec const& exec, UnstructuredPlan const& plan,
                                                                   std::vector<Index32> const& owners,
                                                                   CsrGraph const& images_of_owner) {
  auto const name = [](char const* what) { return std::string("gridmorph::periodic::") + what; };
  std::vector<Index32> nodes;
  std::vector<std::int32_t> rotations;
  for (PeriodicImage const& image : plan.images) {
    nodes.push_back(image.node);
    rotations.push_back(image.rotation);
  }
  std::vector<std::uint8_t> is_known(std::size_t(plan.n_nodes), 0), owner_known;
  for (Index32 const n : plan.known) is_known[std::size_t(n)] = 1;
  for (Index32 const n : owners) owner_known.push_back(is_known[std::size_t(n)]);
  kernels::PeriodicTable<typename Exec::memory_space> const table{upload(exec, owners, name("owner")),
                                                                  upload(exec, owner_known, name("owner_known")),
                                                                  upload(exec, images_of_owner.first, name("first")),
                                                                  upload(exec, images_of_owner.item, name("image")),
                                                                  upload(exec, nodes, name("node")),
                                                                  upload(exec, rotations, name("rotation")),
                                                                  upload(exec, plan.rotations, name("rotations"))};
  compat::fence(exec, "gridmorph::stages::periodic_table (host tables may go)");
  return table;
}

}  // namespace gridmorph::stages
