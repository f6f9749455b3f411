#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/distribution.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

constexpr char const* who = "gridmorph::Distribution: ";

IndexRange all_nodes(Zone const& zone) { return {{0, 0, 0}, zone.extent}; }

IndexRange cells_between(IndexRange nodes) {
  for (int& end : nodes.end) --end;
  return nodes;
}

/// A number that lists of parts, and extents, hardly share: FNV-1a, as far as a double is exact.
double checksum(BoundaryMesh const& mesh, std::span<Part const> parts) {
  std::uint64_t sum = 14695981039346656037u;
  auto const add = [&](int value) { sum = (sum ^ std::uint64_t(std::uint32_t(value))) * 1099511628211u; };
  auto const add_triple = [&](Index3 const& p) { std::for_each(p.begin(), p.end(), add); };
  for (Zone const& z : mesh.zones) add_triple(z.extent);
  for (Part const& p : parts) {
    add(p.zone);
    add(p.rank);
    add_triple(p.nodes.begin);
    add_triple(p.nodes.end);
  }
  return double(sum >> 12);
}

}  // namespace

Distribution::Distribution(std::shared_ptr<Ranks const> ranks, BoundaryMesh const& mesh, std::vector<Part> parts)
    : ranks_(std::move(ranks)), parts_(std::move(parts)) {
  mesh_.zones = mesh.zones;
  check_lists();
  std::vector<Index> end(ranks_->size(), 0);
  for (Part& p : parts_) {
    check_part(p);
    p.first_node = std::exchange(end[p.rank], end[p.rank] + p.nodes.size());
    if (p.rank == ranks_->rank()) own_.push_back(p);
  }
  n_nodes_ = end[ranks_->rank()];
  auto by_zone = parts_by_zone();
  for (int z = 0; z < int(mesh_.zones.size()); ++z) {
    zones_.push_back(zone_parts(z, std::move(by_zone[z])));
    check_covered(z);
  }
}

/// Ranks that worked on different lists would wait for one another for ever.
void Distribution::check_lists() const {
  double const own = checksum(mesh_, parts_);
  std::array<double, 2> limits{own, -own};
  ranks_->largest(limits);
  if (limits[0] != -limits[1])
    throw MeshError(std::string(who) +
                    "the ranks were given different zones or parts; all of them take the whole list, "
                    "in one order");
}

void Distribution::check_part(Part const& part) const {
  check_inside({part.zone, part.nodes});
  if (part.rank < 0 || part.rank >= ranks_->size())
    throw MeshError(who + describe_range(mesh_, part.zone, part.nodes) + " is given to rank " +
                    std::to_string(part.rank) + ", and there are " + std::to_string(ranks_->size()));
  if (part.nodes.size() == 0)
    throw MeshError(who + describe_range(mesh_, part.zone, part.nodes) + " of rank " + std::to_string(part.rank) +
                    " has no node; leave such parts out");
}

void Distribution::check_inside(NodeBox const& box) const {
  if (box.zone < 0 || box.zone >= int(mesh_.zones.size()))
    throw MeshError(who + ("nodes are of zone number " + std::to_string(box.zone)) + ", and there are " +
                    std::to_string(mesh_.zones.size()));
  Zone const& zone = mesh_.zones[box.zone];
  for (int a = 0; a < 3; ++a)
    if (box.nodes.begin[a] < 0 || box.nodes.end[a] > zone.extent[a] || box.nodes.extent(a) < 0)
      throw MeshError(who + describe_range(mesh_, box.zone, box.nodes) + " is no range of a zone with " +
                      std::to_string(zone.extent[0]) + " x " + std::to_string(zone.extent[1]) + " x " +
                      std::to_string(zone.extent[2]) + " nodes");
}

std::vector<std::vector<int>> Distribution::parts_by_zone() const {
  std::vector<std::vector<int>> out(mesh_.zones.size());
  for (int n = 0; n < int(parts_.size()); ++n) out[parts_[n].zone].push_back(n);
  return out;
}

Distribution::ZoneParts Distribution::zone_parts(int zone, std::vector<int> parts) const {
  std::vector<IndexRange> nodes, cells;
  for (int const n : parts) {
    nodes.push_back(parts_[n].nodes);
    cells.push_back(cells_between(parts_[n].nodes));
  }
  IndexRange const all = all_nodes(mesh_.zones[zone]);
  return {std::move(parts), {all, nodes}, {cells_between(all), cells}};
}

void Distribution::check_covered(int zone) const {
  Zone const& z = mesh_.zones[zone];
  if (z.size() == 0) return;
  if (!z.is_block()) throw MeshError(who + ("zone '" + z.name) + "' has elements; parts are boxes of nodes (i, j, k)");
  zones_[zone].nodes.visit(all_nodes(z), [&](int part, IndexRange const& nodes) {
    if (part == detail::FirstBox::none)
      throw MeshError(who + describe_node(mesh_, z.node(nodes.begin)) + " is in no part; give it, and the others of " +
                      to_string(nodes) + ", to a rank");
  });
}

Part const& Distribution::home(int zone, Index3 const& node) const {
  check_inside({zone, {node, {node[0] + 1, node[1] + 1, node[2] + 1}}});
  return parts_[zones_[zone].parts[zones_[zone].nodes(node)]];
}

Part const& Distribution::home_of_cell(int zone, Index3 const& cell) const {
  check_inside({zone, {cell, {cell[0] + 2, cell[1] + 2, cell[2] + 2}}});
  int const first = zones_[zone].cells(cell);
  return first == detail::FirstBox::none ? home(zone, cell) : parts_[zones_[zone].parts[first]];
}

std::vector<Distribution::HomeBox> Distribution::homes(NodeBox const& box) const {
  check_inside(box);
  std::vector<HomeBox> out;
  ZoneParts const& zone = zones_[box.zone];
  zone.nodes.visit(box.nodes, [&](int part, IndexRange const& nodes) { out.push_back({zone.parts[part], nodes}); });
  return out;
}

}  // namespace gridmorph
