#include <gridmorph/core/for_all.hpp>
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
Classification classify(HostInstance const& host, Mesh const& mesh, AnyWrap const& wrap) {
  Classification out;
  std::vector<std::uint8_t>& inside = out.inside;
  inside.resize(mesh.n_nodes());
  out.near.assign(mesh.n_nodes(), 0);
  out.element.resize(mesh.n_elements());
  Coordinates const coordinates = wrap.domain.chart.mapped(host, mesh.coordinates);
  detail::for_all(host, "gridmorph::classify::nodes", mesh.n_nodes(),
                  [&](Index n) { inside[n] = std::uint8_t(wrap.holds(coordinates[n])); });
  detail::for_all(host, "gridmorph::classify::elements", mesh.n_elements(), [&](Index e) {
    auto const corners = mesh.elements.corners(e);
    Region& region = out.element[e];
    if (std::all_of(corners.begin(), corners.end(), [&](Index32 n) { return inside[n] != 0; })) {
      region = Region::near;
    } else {
      LatticeBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
      for (Index32 const n : corners) {
        Vec3 const p = coordinates[n];
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
      std::atomic_ref<std::uint8_t>(out.near[n]).store(1, std::memory_order_relaxed);
  });
  out.count();
  return out;
}

template Classification classify(HostInstance const&, Mesh const&, Wrap const&);

}  // namespace gridmorph
