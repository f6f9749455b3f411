#include <gridmorph/plan/blocks/line_walk.hpp>

namespace gridmorph {

int normal_axis(IndexRange const& range) {
  for (int a = 0; a < 3; ++a)
    if (range.extent(a) == 1) return a;
  return 0;
}

bool advance(Mesh const& mesh, Links const& links, LinePlace& place, double& length) {
  LinePlace p = place;
  // Interfaces of no thickness may follow one another; none is passed twice.
  for (Index turn = 0; turn <= Index(links.all.size()); ++turn) {
    int const next = p.at[p.axis] + p.step;
    if (next >= 0 && next < mesh.zones[p.zone].extent[p.axis]) {
      Vec3 const here = mesh.coordinates[mesh.zones[p.zone].node(p.at)];
      p.at[p.axis] = next;
      length += distance(here, mesh.coordinates[mesh.zones[p.zone].node(p.at)]);
      place = p;
      return true;
    }
    int through = -1;
    for (int l : links.of_zone[p.zone]) {
      Link const& link = links.all[l];
      if (link.range.extent(p.axis) == 1 && link.range.contains(p.at)) through = l;
    }
    if (through < 0) return false;
    Link const& link = links.all[through];
    p.zone = link.donor_zone;
    p.at = link.to_donor(p.at);
    p.step *= link.to_donor.orientation.sign[p.axis];
    p.axis = link.to_donor.orientation.axis[p.axis];
  }
  return false;
}

}  // namespace gridmorph
