#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {
namespace {

bool within(Zone const& zone, IndexRange const& r) {
  for (int a = 0; a < 3; ++a)
    if (r.begin[a] < 0 || r.end[a] > zone.extent[a] || r.begin[a] >= r.end[a]) return false;
  return true;
}

bool on_one_face(Zone const& zone, IndexRange const& r) {
  int flat = 0;
  for (int a = 0; a < 3; ++a)
    if (r.extent(a) == 1 && (r.begin[a] == 0 || r.begin[a] == zone.extent[a] - 1)) ++flat;
  return flat >= 1;
}

RigidTransform fitted_periodic(Mesh const& mesh, Interface1to1 const& face, double size) {
  std::vector<Vec3> own, donor;
  for_each_pair(mesh, face, [&](Index p, Index q) {
    own.push_back(mesh.coordinates[p]);
    donor.push_back(mesh.coordinates[q]);
  });
  return fit_periodic(*face.periodic, own, donor, size);
}

struct WorstPair {
  double distance = 0;
  Index own = 0, donor = 0;
};

WorstPair worst_pair(Mesh const& mesh, Interface1to1 const& face, RigidTransform const& t, bool periodic) {
  WorstPair worst;
  for_each_pair(mesh, face, [&](Index p, Index q) {
    Vec3 const own = periodic ? t(mesh.coordinates[p]) : mesh.coordinates[p];
    double const d = distance(own, mesh.coordinates[q]);
    if (!(d <= worst.distance)) worst = {d, p, q};
  });
  return worst;
}

std::string describe_interface(Mesh const& mesh, Interface1to1 const& face) {
  return "interface '" + face.name + "' (" + describe_range(mesh, face.zone, face.range) + " to zone '" +
         (face.donor_zone >= 0 && face.donor_zone < int(mesh.zones.size()) ? mesh.zones[face.donor_zone].name : "?") +
         "')";
}

}  // namespace

Links connect(Mesh const& mesh, TopologyOptions const& options) {
  Problems problems;
  Links links = connect(mesh, options, problems);
  problems.throw_if_any<MeshError>();
  return links;
}

Links connect(HostInstance const& host, Mesh const& mesh, TopologyOptions const& options, Problems& problems) {
  Links links;
  links.of_zone.resize(mesh.zones.size());
  MeshExtent const extent = extent_of(host, mesh.coordinates);
  links.mesh_size = extent.size();
  for (Index n = 0; !extent.finite && n < mesh.coordinates.size(); ++n)
    if (Vec3 const p = mesh.coordinates[n]; !std::isfinite(p.x + p.y + p.z))
      throw MeshError(mesh.source + ": " + describe_node(mesh, n) + " is not finite; repair the mesh first");

  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) {
    Interface1to1 const& face = mesh.interfaces[f];
    auto const name = [&] { return describe_interface(mesh, face); };
    if (face.donor_zone < 0 || face.donor_zone >= int(mesh.zones.size())) {
      problems.add(name() + ": its donor zone does not exist; correct the connection");
      continue;
    }
    if (!within(mesh.zones[face.zone], face.range) || !on_one_face(mesh.zones[face.zone], face.range)) {
      problems.add(name() + ": the range is not on a face of its zone; correct the connection");
      continue;
    }
    IndexRange const image = face.to_donor(face.range);
    if (!within(mesh.zones[face.donor_zone], image) || !on_one_face(mesh.zones[face.donor_zone], image)) {
      problems.add(name() + ": the donor range " + to_string(image) + " is not on a face of zone '" +
                   mesh.zones[face.donor_zone].name + "'; correct the connection");
      continue;
    }
    // The other side of a connection that is stored twice gets exactly the inverse of the transform fitted first, and is
    // not reported a second time.
    auto const same = [&](Link const& l) {
      return l.interface != int(f) && l.zone == face.zone && l.donor_zone == face.donor_zone && l.range == face.range &&
             l.to_donor(face.range) == image && l.to_donor.orientation == face.to_donor.orientation;
    };
    auto const stored = std::find_if(links.of_zone[face.zone].begin(), links.of_zone[face.zone].end(),
                                     [&](int l) { return same(links.all[l]); });
    if (stored != links.of_zone[face.zone].end()) {
      links.all[*stored].interface = int(f);
      continue;
    }
    Link link{int(f), face.zone, face.donor_zone, face.range, face.to_donor, face.periodic.has_value(), {}, 0};
    if (link.periodic) link.transform = fitted_periodic(mesh, face, links.mesh_size);
    WorstPair const worst = worst_pair(mesh, face, link.transform, link.periodic);
    link.mismatch = worst.distance;
    bool const single = mesh.zones[face.zone].single_precision || mesh.zones[face.donor_zone].single_precision;
    double const tolerance =
        options.matching_tolerance > 0 ? options.matching_tolerance : (single ? 1e-6 : 1e-8) * links.mesh_size;
    if (!(worst.distance <= tolerance))
      problems.add(name() + ": its points do not coincide with the donor's: " + describe_node(mesh, worst.own) +
                   " and " + describe_node(mesh, worst.donor) + " are " + to_text(worst.distance, 3) +
                   " apart (tolerance " + to_text(tolerance, 3) +
                   "); raise matching_tolerance if that is how the mesh was made");
    int const forward = int(links.all.size());
    links.all.push_back(link);
    links.of_zone[link.zone].push_back(forward);
    Link back = link;
    back.zone = link.donor_zone;
    back.donor_zone = link.zone;
    back.range = image;
    back.to_donor = link.to_donor.inverse();
    back.transform = link.transform.inverse();
    links.of_zone[back.zone].push_back(forward + 1);
    links.all.push_back(back);
  }
  return links;
}

}  // namespace gridmorph
