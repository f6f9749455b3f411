#include <gridmorph/plan/coarse_plan.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace gridmorph {

std::vector<ZoneCuts> sampled_planes(Mesh const& mesh, Links const& links, std::vector<CutPlane> const& planes,
                                     int every) {
  std::vector<ZoneCuts> const cuts = cut_zones(mesh, links, planes);
  std::vector<CutPlane> asked = planes;
  for (int z = 0; z < int(cuts.size()); ++z)
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n + 1 < cuts[z][axis].size(); ++n) {
        int const begin = cuts[z][axis][n], cells = cuts[z][axis][n + 1] - begin;
        auto const keep = [&](int cell) {
          asked.push_back({z, axis, begin + cell});
          asked.push_back({z, axis, begin + cell + 1});
        };
        keep(0);
        keep(cells - 1);
        // As many on both sides of the middle, whichever way the axis runs.
        int const samples = cells / every;
        for (int m = 0; 2 * m + 1 < samples; ++m) {
          int const cell = int((2 * std::int64_t(m) + 1) * cells / (2 * std::int64_t(samples)));
          keep(cell);
          keep(cells - 1 - cell);
        }
        if (samples % 2 == 1) {
          keep((cells - 1) / 2);
          keep(cells / 2);
        }
      }
  return cut_zones(mesh, links, asked, std::numeric_limits<Index>::max());
}

Index count_nodes(std::vector<ZoneCuts> const& planes) {
  Index n = 0;
  for (ZoneCuts const& zone : planes) n += Index(zone[0].size()) * Index(zone[1].size()) * Index(zone[2].size());
  return n;
}

Index3 CoarseMesh::fine_index(int zone, Index3 const& p) const {
  ZoneCuts const& kept = planes[zone];
  return {kept[0][p[0]], kept[1][p[1]], kept[2][p[2]]};
}

bool CoarseMesh::is_cell(int zone, Index3 const& cell) const {
  for (int a = 0; a < 3; ++a) {
    std::vector<int> const& kept = planes[zone][a];
    if (kept[std::size_t(cell[a]) + 1] != kept[cell[a]] + 1) return false;
  }
  return true;
}

int CoarseMesh::place(int zone, int axis, int fine_index) const {
  std::vector<int> const& kept = planes[zone][axis];
  return int(std::lower_bound(kept.begin(), kept.end(), fine_index) - kept.begin());
}

namespace {

Index3 places(CoarseMesh const& coarse, int zone, Index3 const& fine) {
  return {coarse.place(zone, 0, fine[0]), coarse.place(zone, 1, fine[1]), coarse.place(zone, 2, fine[2])};
}

IndexRange places(CoarseMesh const& coarse, int zone, IndexRange const& fine) {
  Index3 const last{fine.end[0] - 1, fine.end[1] - 1, fine.end[2] - 1};
  IndexRange out{places(coarse, zone, fine.begin), places(coarse, zone, last)};
  for (int& end : out.end) ++end;
  return out;
}

/// The map between the places of the nodes of a range, which both sides keep.
IndexMap places(CoarseMesh const& coarse, int zone, IndexRange const& range, int donor_zone, IndexMap const& map) {
  return {map.orientation, places(coarse, zone, range.begin), places(coarse, donor_zone, map(range.begin))};
}

/// Positions of the nodes kept of a zone, and along each axis how far they are from its lower face.
void take_lines(Mesh const& mesh, int zone, CoarseMesh& coarse) {
  Zone const &fine = mesh.zones[zone], &own = coarse.mesh.zones[zone];
  Index3 p{};
  for (p[2] = 0; p[2] < own.extent[2]; ++p[2])
    for (p[1] = 0; p[1] < own.extent[1]; ++p[1])
      for (p[0] = 0; p[0] < own.extent[0]; ++p[0])
        coarse.mesh.coordinates.set(own.node(p), mesh.coordinates[fine.node(coarse.fine_index(zone, p))]);
  for (int axis = 0; axis < 3; ++axis) {
    Index3 extent = own.extent;
    extent[axis] = 1;
    for (p[2] = 0; p[2] < extent[2]; ++p[2])
      for (p[1] = 0; p[1] < extent[1]; ++p[1])
        for (p[0] = 0; p[0] < extent[0]; ++p[0]) {
          Index const fine_step = fine.strides()[axis], step = own.strides()[axis];
          Index node = fine.node(coarse.fine_index(zone, p)), to = own.node(p);
          double length = 0;
          int at = 0;
          for (int const kept : coarse.planes[zone][axis]) {
            for (; at < kept; ++at, node += fine_step)
              length += distance(mesh.coordinates[node], mesh.coordinates[node + fine_step]);
            coarse.lengths[axis][to] = length;
            to += step;
          }
        }
  }
}

}  // namespace

CoarseMesh coarsen(Mesh const& mesh, Links const& links, std::vector<ZoneCuts> planes) {
  CoarseMesh coarse;
  coarse.planes = std::move(planes);
  Mesh& out = coarse.mesh;
  out.dimension = mesh.dimension;
  out.source = mesh.source;
  out.families = mesh.families;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    ZoneCuts const& kept = coarse.planes[z];
    out.add_zone(mesh.zones[z].name, {int(kept[0].size()), int(kept[1].size()), int(kept[2].size())});
    out.zones.back().single_precision = mesh.zones[z].single_precision;
  }
  out.patches = mesh.patches;
  for (Patch& patch : out.patches) patch.range = places(coarse, patch.zone, patch.range);
  out.interfaces = mesh.interfaces;
  for (Interface1to1& i : out.interfaces) {
    i.to_donor = places(coarse, i.zone, i.range, i.donor_zone, i.to_donor);
    i.range = places(coarse, i.zone, i.range);
  }
  coarse.links = links;
  for (Link& link : coarse.links.all) {
    link.to_donor = places(coarse, link.zone, link.range, link.donor_zone, link.to_donor);
    link.range = places(coarse, link.zone, link.range);
  }
  out.coordinates = Coordinates(out.n_nodes());
  for (auto& lengths : coarse.lengths) lengths.resize(out.n_nodes());
  for (int z = 0; z < int(mesh.zones.size()); ++z) take_lines(mesh, z, coarse);
  return coarse;
}

}  // namespace gridmorph
