#include <gridmorph/plan/blocks/cuts.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <deque>
#include <set>

namespace gridmorph {

std::vector<CutPlane> planes_of(Mesh const& mesh, std::vector<BlockCut> const& cuts) {
  std::vector<CutPlane> out;
  Problems problems;
  for (BlockCut const& cut : cuts) {
    std::string const label = std::string("cut at ") + "ijk"[cut.axis] + " = " + std::to_string(cut.node + 1) +
                              " of zone '" + cut.zone + "'" + (cut.where.empty() ? "" : " (" + cut.where + ")") + ": ";
    auto const zone =
        std::find_if(mesh.zones.begin(), mesh.zones.end(), [&](Zone const& z) { return z.name == cut.zone; });
    if (zone == mesh.zones.end()) {
      std::vector<std::string> names;
      for (Zone const& z : mesh.zones) names.push_back(z.name);
      constexpr std::size_t most = 12;
      problems.add(label + "there is no such zone; the zones are " + quote_list(names, most));
    } else if (int const last = zone->extent[cut.axis]; cut.node < 1 || cut.node > last - 2) {
      problems.add(label + (last < 3 ? std::string("the zone is one cell wide there, and has no plane inside")
                                     : "planes inside are 2 to " + std::to_string(last - 1)));
    } else {
      out.push_back({int(zone - mesh.zones.begin()), cut.axis, cut.node});
    }
  }
  problems.throw_if_any<PlanError>();
  return out;
}

std::vector<ZoneCuts> cut_zones(Mesh const& mesh, Links const& links, std::vector<CutPlane> const& asked,
                                Index max_pieces) {
  std::vector<std::array<std::set<int>, 3>> cuts(mesh.zones.size());
  std::deque<CutPlane> fresh;
  auto cut = [&](CutPlane const& plane) {
    if (cuts[plane.zone][plane.axis].insert(plane.index).second) fresh.push_back(plane);
  };
  auto cut_at_limits = [&](int zone, IndexRange const& r) {
    for (int a = 0; a < 3; ++a) {
      cut({zone, a, r.begin[a]});
      cut({zone, a, r.end[a] - 1});
    }
  };

  for (int z = 0; z < int(mesh.zones.size()); ++z) cut_at_limits(z, {{0, 0, 0}, mesh.zones[z].extent});
  for (Patch const& p : mesh.patches) cut_at_limits(p.zone, p.range);
  for (Link const& l : links.all) cut_at_limits(l.zone, l.range);
  for (CutPlane const& plane : asked) cut(plane);

  while (!fresh.empty()) {
    CutPlane const plane = fresh.front();
    fresh.pop_front();
    for (int l : links.of_zone[plane.zone]) {
      Link const& link = links.all[l];
      // A cut along the face normal of the link is the face itself; one at the range's limits is there already.
      if (plane.index <= link.range.begin[plane.axis] || plane.index >= link.range.end[plane.axis] - 1) continue;
      Index3 p = link.range.begin;
      p[plane.axis] = plane.index;
      int const axis = link.to_donor.orientation.axis[plane.axis];
      cut({link.donor_zone, axis, link.to_donor(p)[axis]});
    }
  }

  std::vector<ZoneCuts> result(cuts.size());
  Index pieces = 0;
  for (std::size_t z = 0; z < cuts.size(); ++z) {
    Index n = 1;
    for (int a = 0; a < 3; ++a) {
      result[z][a].assign(cuts[z][a].begin(), cuts[z][a].end());
      n *= Index(result[z][a].size()) - 1;
    }
    pieces += n;
    if (pieces > max_pieces)
      throw MeshError(mesh.source + ": carrying cuts through the interfaces gives more than " +
                      std::to_string(max_pieces) + " blocks (first in zone '" + mesh.zones[z].name +
                      "'); check for interfaces that shift their indices at every turn");
  }
  return result;
}

namespace {

void follow_layers(Mesh const& mesh, Links const& links, int zone, IndexRange const& range, int axis, int side,
                   int n_layers, LayerLimit& limit) {
  int const cells = mesh.zones[zone].extent[axis] - 1;
  if (n_layers <= cells) {
    limit.planes.push_back({zone, axis, side == 0 ? n_layers : cells - n_layers});
    return;
  }
  int const opposite = side == 0 ? cells : 0;
  IndexRange far = range;
  far.begin[axis] = opposite;
  far.end[axis] = opposite + 1;
  Index covered = 0;
  auto face_cells = [axis](IndexRange const& r) {
    Index n = 1;
    for (int a = 0; a < 3; ++a)
      if (a != axis) n *= r.extent(a) - 1;
    return n;
  };
  for (int l : links.of_zone[zone]) {
    Link const& link = links.all[l];
    if (link.range.extent(axis) != 1 || link.range.begin[axis] != opposite) continue;
    IndexRange common;
    bool empty = false;
    for (int a = 0; a < 3; ++a) {
      common.begin[a] = std::max(far.begin[a], link.range.begin[a]);
      common.end[a] = std::min(far.end[a], link.range.end[a]);
      empty = empty || common.extent(a) < (a == axis ? 1 : 2);
    }
    if (empty) continue;
    covered += face_cells(common);
    IndexRange const image = link.to_donor(common);
    int const donor_axis = link.to_donor.orientation.axis[axis];
    follow_layers(mesh, links, link.donor_zone, image, donor_axis, image.begin[donor_axis] == 0 ? 0 : 1,
                  n_layers - cells, limit);
  }
  if (covered < face_cells(far)) {
    limit.hit_patches.push_back(far);
    limit.hit_zones.push_back(zone);
  }
}

}  // namespace

LayerLimit layer_limit(Mesh const& mesh, Links const& links, int zone, IndexRange const& wall, int n_layers) {
  LayerLimit limit;
  for (int a = 0; a < 3; ++a)
    if (wall.extent(a) == 1) {
      follow_layers(mesh, links, zone, wall, a, wall.begin[a] == 0 ? 0 : 1, n_layers, limit);
      break;
    }
  return limit;
}

}  // namespace gridmorph
