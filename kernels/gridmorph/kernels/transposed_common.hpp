// What the nodes inside pieces of blocks hand to the motion in common: the moments of their gradients at x + v
// (common_motion.hpp).
//
// One item per plane of nodes of a box, so that sums come in one order whatever the number of threads.
//
// Cost per node: 72 bytes read.
#pragma once

#include <gridmorph/kernels/volume_pass.hpp>

namespace gridmorph::kernels {

template <class MemorySpace>
struct CommonMomentsOfBoxes {
  TileList<VolumeBox, MemorySpace> boxes;  ///< of one part, items by planes
  CommonFrame frame;
  CommonMove const* move;
  VectorArray x, gradient;
  Vec3 const* before;  ///< v by node
  CommonMap* partial;

  static Index items(VolumeBox const& box) { return box.n[2]; }

  [[nodiscard]] Index size() const { return boxes.n_items; }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(boxes.first_item, item);
    VolumeBox const& box = boxes.entries(entry);
    Index const plane = box.first + (item - boxes.first_item(entry)) * box.stride_k;
    CommonMap sum;
    for (int j = 0; j < box.n[1]; ++j)
      for (int i = 0; i < box.n[0]; ++i) {
        Index const n = plane + i + j * box.stride_j;
        sum.add(frame, x[n] + move->share * before[n], gradient[n]);
      }
    partial[item] = sum;
  }
};

}  // namespace gridmorph::kernels
