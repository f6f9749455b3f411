#include <gridmorph/wheel/passage_links.hpp>

#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace gridmorph {

namespace {

using Pairs = std::vector<std::array<Index, 2>>;

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs reversed(Pairs pairs) {
  for (auto& pair : pairs) std::swap(pair[0], pair[1]);
  return pairs;
}

PassageLinks by_zone(std::size_t n_zones, std::vector<PassageLink> all, double mesh_size) {
  PassageLinks out{std::move(all), std::vector<std::vector<int>>(n_zones), mesh_size};
  for (std::size_t l = 0; l < out.all.size(); ++l) out.of_zone[out.all[l].zone].push_back(int(l));
  return out;
}

}  // namespace

PassageLinks passage_links(Mesh const& mesh, Links const& links, TopologyOptions const& options) {
  auto const precision = coordinate_precisions(mesh);
  std::vector<PassageLink> all;
  for (Link const& link : links.all) {
    double const tolerance =
        options.matching_tolerance > 0
            ? options.matching_tolerance
            : coincidence_tolerance(links.mesh_size, std::max(precision[link.zone].resolution(),
                                                              precision[link.donor_zone].resolution()));
    PassageLink own{link.interface, link.zone, link.donor_zone, link.periodic, link.transform, link.mismatch,
                    tolerance,      {},        link.range,      link.to_donor};
    for_each_pair(mesh, link, [&](Index from, Index to) { own.pairs.push_back({from, to}); });
    all.push_back(std::move(own));
  }
  return by_zone(mesh.zones.size(), std::move(all), links.mesh_size);
}

PassageLinks passage_links(Boundary const& boundary) {
  // As far apart as readers pair nodes.
  double const coincident = place_tolerance(1e-6, boundary.size(), boundary.precision().resolution());
  std::vector<PassageLink> all;
  for (auto const& c : boundary.connections()) {
    PassageLink link{c.number, c.zone, c.donor_zone, c.periodic.has_value(),
                     {},       0,      coincident,   boundary.pairs(c.number)};
    if (link.pairs.empty()) continue;
    if (link.periodic) link.transform = boundary.transform(c.number);
    for (auto const& [from, to] : link.pairs) {
      Vec3 const there = link.periodic ? link.transform(boundary.coordinates()[from]) : boundary.coordinates()[from];
      link.mismatch = std::max(link.mismatch, distance(there, boundary.coordinates()[to]));
    }
    all.push_back(std::move(link));
  }
  // Files store a connection from one side or from both.
  using Key = std::tuple<int, int, bool, Pairs>;
  std::map<Key, int> stored;
  for (PassageLink const& link : all) ++stored[{link.zone, link.donor_zone, link.periodic, sorted(link.pairs)}];
  for (std::size_t l = 0, n = all.size(); l < n; ++l) {
    PassageLink back = all[l];
    std::swap(back.zone, back.donor_zone);
    back.pairs = reversed(std::move(back.pairs));
    if (stored.contains({back.zone, back.donor_zone, back.periodic, sorted(back.pairs)})) continue;
    back.transform = back.transform.inverse();
    all.push_back(std::move(back));
  }
  return by_zone(boundary.zones().size(), std::move(all), boundary.size());
}

std::string describe(Mesh const& mesh, PassageLink const& link) {
  auto const all = connections_of(mesh);
  std::string const name = all[link.connection].name;
  return std::size_t(link.connection) < mesh.interfaces.size()
             ? "periodic interface '" + name + "' (" + describe_range(mesh, link.zone, link.range) + ")"
             : "periodic connection '" + name + "' (zone '" + mesh.zones[link.zone].name + "')";
}

}  // namespace gridmorph
