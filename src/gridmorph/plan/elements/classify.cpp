#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/plan/elements/classify.hpp>

#include <algorithm>
#include <atomic>

namespace gridmorph {

void Classification::count() {
  n_near = n_partial = n_far = n_near_nodes = 0;
  for (Region const region : element)
    ++(region == Region::near ? n_near : region == Region::partial ? n_partial : n_far);
  for (std::uint8_t const n : near) n_near_nodes += n;
}

template <class AnyWrap>
Classification classify(Mesh const& mesh, AnyWrap const& wrap) {
  using Host = Kokkos::DefaultHostExecutionSpace;
  using Range = Kokkos::RangePolicy<Host, Kokkos::IndexType<Index>>;
  Host const exec;
  Classification out;
  std::vector<std::uint8_t>& inside = out.inside;
  inside.resize(std::size_t(mesh.n_nodes()));
  out.near.assign(std::size_t(mesh.n_nodes()), 0);
  out.element.resize(std::size_t(mesh.n_elements()));
  Kokkos::parallel_for("gridmorph::classify::nodes", Range(exec, 0, mesh.n_nodes()),
                       [&](Index n) { inside[std::size_t(n)] = std::uint8_t(wrap.contains(mesh.coordinates[n])); });
  Kokkos::parallel_for("gridmorph::classify::elements", Range(exec, 0, mesh.n_elements()), [&](Index e) {
    auto const corners = mesh.elements.corners(e);
    Region& region = out.element[std::size_t(e)];
    if (std::all_of(corners.begin(), corners.end(), [&](Index32 n) { return inside[std::size_t(n)] != 0; })) {
      region = Region::near;
    } else {
      LatticeBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
      for (Index32 const n : corners) {
        Vec3 const p = mesh.coordinates[n];
        std::array<double, 3> const x{p.x, p.y, p.z};
        for (std::size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], x[a]);
          box.high[a] = std::max(box.high[a], x[a]);
        }
      }
      region = wrap.meets(box) ? Region::partial : Region::far;
    }
    if (region == Region::far) return;
    // Several elements may mark a node: all of them with the same value.
    for (Index32 const n : mesh.elements.nodes[e])
      std::atomic_ref<std::uint8_t>(out.near[std::size_t(n)]).store(1, std::memory_order_relaxed);
  });
  compat::fence(exec, "gridmorph::classify (read by the host)");
  out.count();
  return out;
}

template Classification classify(Mesh const&, Wrap const&);

}  // namespace gridmorph
