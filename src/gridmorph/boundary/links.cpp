#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <array>
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

bool lies_on_faces(Mesh const& mesh, Interface1to1 const& face) {
  if (face.donor_zone < 0 || face.donor_zone >= int(mesh.zones.size())) return false;
  Zone const &own = mesh.zones[face.zone], &donor = mesh.zones[face.donor_zone];
  if (!within(own, face.range) || !on_one_face(own, face.range)) return false;
  IndexRange const image = face.to_donor(face.range);
  return within(donor, image) && on_one_face(donor, image);
}

/// Periodic transforms fitted to the nodes of all interfaces that are declared alike, there or back: what a strip over
/// a tip or in a boundary layer leaves uncertain, the others know. The order of the interfaces, and whether a file has
/// both sides of them, does not change a bit.
class PeriodicFits {
 public:
  PeriodicFits(Mesh const& mesh, double size) : mesh_(mesh), size_(size), group_(mesh.interfaces.size(), -1) {
    back_.resize(group_.size(), 0);
    for (std::size_t f = 0; f < group_.size(); ++f)
      if (mesh.interfaces[f].periodic && lies_on_faces(mesh, mesh.interfaces[f])) add(f);
    for (Group& group : groups_) {
      if (group.members > 1) group.fit = fitted(group.declared, group.pairs);
      group.pairs = {};
    }
  }

  /// The transform of interface f: that of its group, or its own where its nodes know better: files declare one angle
  /// for pitches that differ.
  [[nodiscard]] RigidTransform of(std::size_t f) const {
    Interface1to1 const& face = mesh_.interfaces[f];
    Group const& group = groups_[group_[f]];
    std::vector<Vec3> own, donor;
    for_each_pair(mesh_, face, [&](Index p, Index q) {
      own.push_back(mesh_.coordinates[p]);
      donor.push_back(mesh_.coordinates[q]);
    });
    RigidTransform const alone = fit_periodic(*face.periodic, own, donor, size_);
    if (group.members == 1) return alone;
    RigidTransform const joint = back_[f] != 0 ? group.fit.inverse() : group.fit;
    constexpr double scatter = 2, round_off = 1e-13;
    double const allowed = scatter * worst_pair(mesh_, face, alone, true).distance + round_off * size_;
    return worst_pair(mesh_, face, joint, true).distance <= allowed ? joint : alone;
  }

 private:
  using Pair = std::array<double, 6>;  // from, to
  struct Group {
    Periodic declared;  ///< forwards
    std::vector<Pair> pairs;
    int members = 0;
    RigidTransform fit;
  };

  void add(std::size_t f) {
    Interface1to1 const& face = mesh_.interfaces[f];
    Periodic declared = *face.periodic;
    if (!forwards(declared.declared)) {
      back_[f] = 1;
      declared.rotation_angle_rad = -declared.rotation_angle_rad;
      declared.translation = -declared.translation;
      declared.declared = declared.declared.inverse();
    }
    for (int g = 0; g < int(groups_.size()) && group_[f] < 0; ++g)
      if (alike(declared.declared, groups_[g].declared.declared)) group_[f] = g;
    if (group_[f] < 0) {
      group_[f] = int(groups_.size());
      groups_.push_back({declared, {}, 0, {}});
    }
    Group& group = groups_[group_[f]];
    ++group.members;
    for_each_pair(mesh_, face, [&](Index p, Index q) {
      Vec3 const a = mesh_.coordinates[back_[f] != 0 ? q : p], b = mesh_.coordinates[back_[f] != 0 ? p : q];
      group.pairs.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
    });
  }

  /// Whether this is the one of a transform and its inverse that stands for both, whichever a file declares.
  [[nodiscard]] bool forwards(RigidTransform const& t) const {
    constexpr double single = 1e-6;
    auto const& m = t.rotation.m;
    double const length = size_ > 0 ? size_ : 1;
    for (double const v : {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], t.translation.x / length,
                           t.translation.y / length, t.translation.z / length})
      if (std::abs(v) > single) return v > 0;
    return true;
  }

  [[nodiscard]] RigidTransform fitted(Periodic const& declared, std::vector<Pair>& pairs) const {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::vector<Vec3> from, to;
    for (Pair const& p : pairs) {
      from.push_back({p[0], p[1], p[2]});
      to.push_back({p[3], p[4], p[5]});
    }
    return fit_periodic(declared, from, to, size_);
  }

  /// Whether two transforms are the same to what files say in single precision.
  [[nodiscard]] bool alike(RigidTransform const& a, RigidTransform const& b) const {
    constexpr double single = 1e-6;
    double apart = distance(a.translation, b.translation) / (size_ > 0 ? size_ : 1);
    for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      apart = std::max(apart, distance(a.rotation * e, b.rotation * e));
    return apart < single;
  }

  Mesh const& mesh_;
  double size_;
  std::vector<int> group_;  ///< by interface; -1: not periodic
  std::vector<char> back_;  ///< declared backwards
  std::vector<Group> groups_;
};

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

  auto const precision = coordinate_precisions(mesh);
  PeriodicFits const fits(mesh, links.mesh_size);
  std::vector<std::string> said(mesh.interfaces.size());  // of each, so that they come in order
  struct Made {
    std::size_t interface;
    int forward;  ///< link, the way back follows it
  };
  std::vector<Made> made;
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) {
    Interface1to1 const& face = mesh.interfaces[f];
    auto const name = [&] { return describe_interface(mesh, face); };
    if (face.donor_zone < 0 || face.donor_zone >= int(mesh.zones.size())) {
      said[f] = name() + ": its donor zone does not exist; correct the connection";
      continue;
    }
    if (!within(mesh.zones[face.zone], face.range) || !on_one_face(mesh.zones[face.zone], face.range)) {
      said[f] = name() + ": the range is not on a face of its zone; correct the connection";
      continue;
    }
    IndexRange const image = face.to_donor(face.range);
    if (!within(mesh.zones[face.donor_zone], image) || !on_one_face(mesh.zones[face.donor_zone], image)) {
      said[f] = name() + ": the donor range " + to_string(image) + " is not on a face of zone '" +
                mesh.zones[face.donor_zone].name + "'; correct the connection";
      continue;
    }
    // The other side of a connection that is stored twice gets exactly the inverse of the transform fitted first, and
    // is not reported a second time.
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
    Link const link{int(f), face.zone, face.donor_zone, face.range, face.to_donor, face.periodic.has_value(), {}, 0};
    int const forward = int(links.all.size());
    made.push_back({f, forward});
    links.all.push_back(link);
    links.of_zone[link.zone].push_back(forward);
    Link back = link;
    back.zone = link.donor_zone;
    back.donor_zone = link.zone;
    back.range = image;
    back.to_donor = link.to_donor.inverse();
    links.of_zone[back.zone].push_back(forward + 1);
    links.all.push_back(back);
  }
  // Their points are looked at side by side.
  detail::for_all_parts(host, "gridmorph::connect", Index(made.size()), [&](Index n) {
    auto const [f, forward] = made[n];
    Interface1to1 const& face = mesh.interfaces[f];
    Link& link = links.all[forward];
    Link& back = links.all[forward + 1];
    if (link.periodic) link.transform = fits.of(f);
    back.transform = link.transform.inverse();
    WorstPair const worst = worst_pair(mesh, face, link.transform, link.periodic);
    link.mismatch = back.mismatch = worst.distance;
    double const tolerance =
        options.matching_tolerance > 0
            ? options.matching_tolerance
            : coincidence_tolerance(links.mesh_size, std::max(precision[face.zone].resolution(),
                                                              precision[face.donor_zone].resolution()));
    if (!(worst.distance <= tolerance))
      said[f] = describe_interface(mesh, face) +
                ": its points do not coincide with the donor's: " + describe_node(mesh, worst.own) + " and " +
                describe_node(mesh, worst.donor) + " are " + to_text(worst.distance, 3) + " apart (tolerance " +
                to_text(tolerance, 3) + "); raise matching_tolerance if that is how the mesh was made";
  });
  for (std::string& problem : said)
    if (!problem.empty()) problems.add(std::move(problem));
  return links;
}

}  // namespace gridmorph
