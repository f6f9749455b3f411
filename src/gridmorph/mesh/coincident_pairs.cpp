#include <gridmorph/core/for_many.hpp>
#include <gridmorph/core/sort_keys.hpp>
#include <gridmorph/mesh/coincident_pairs.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace gridmorph {

namespace {

/// Keys that are in the order of the numbers.
std::uint64_t ordered(double v) {
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  auto const bits = std::bit_cast<std::uint64_t>(v);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

}  // namespace

std::vector<std::pair<Index, Index>> coincident_pairs(Coordinates const& coordinates, std::vector<Index> const& nodes,
                                                      std::function<int(Index node)> const& zone, double tolerance) {
  // Along an oblique line few points of a mesh lie side by side, even where it is a lattice.
  constexpr Vec3 line{0.5318, 0.6173, 0.5797};
  struct Placed {
    double along;
    Index node;
    int zone;
  };
  HostInstance const host;
  std::vector<Placed> placed(nodes.size());
  detail::KeyedIndices<Kokkos::HostSpace> list(nodes.size(), "gridmorph::coincident_pairs");
  detail::for_many(host, "gridmorph::coincident_pairs::place", Index(nodes.size()), [&](Index n) {
    placed[n] = {dot(line, coordinates[nodes[n]]), nodes[n], zone(nodes[n])};
    list.key(n) = ordered(placed[n].along);
    list.number(n) = Index32(n);
  });
  host.visit([&](auto const& exec) {
    list = detail::sort_keys(exec, list);
    compat::fence(exec, "gridmorph::coincident_pairs (read by the host)");
  });
  auto const sorted = [&](std::size_t k) -> Placed const& { return placed[list.number(k)]; };
  std::vector<std::pair<Index, Index>> out;
  for (std::size_t a = 0; a < placed.size(); ++a) {
    Placed const& one = sorted(a);
    for (std::size_t b = a + 1; b < placed.size() && sorted(b).along - one.along <= tolerance; ++b)
      if (Placed const& other = sorted(b);
          one.zone != other.zone && distance(coordinates[one.node], coordinates[other.node]) <= tolerance)
        out.push_back(std::minmax(one.node, other.node));
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace gridmorph
