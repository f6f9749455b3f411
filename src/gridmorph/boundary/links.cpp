#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace gridmorph {
namespace {

/// Calls visit(own node, donor node) for all nodes of a link, i fastest.
template <class Visit>
void for_each_pair(Mesh const& mesh, IndexRange const& range, IndexMap const& to_donor, int zone, int donor_zone,
                   Visit&& visit) {
  Zone const& own = mesh.zones[zone];
  Zone const& donor = mesh.zones[donor_zone];
  for (int k = range.begin[2]; k < range.end[2]; ++k)
    for (int j = range.begin[1]; j < range.end[1]; ++j)
      for (int i = range.begin[0]; i < range.end[0]; ++i)
        visit(own.node({i, j, k}), donor.node(to_donor(Index3{i, j, k})));
}

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

std::string format_length(double v) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", v);
  return text.data();
}

/// Eigenvector of the largest eigenvalue of a symmetric 4x4 matrix, by cyclic Jacobi rotations.
std::array<double, 4> dominant_eigenvector(std::array<std::array<double, 4>, 4> a) {
  std::array<std::array<double, 4>, 4> v{};
  for (int i = 0; i < 4; ++i) v[i][i] = 1;
  for (int sweep = 0; sweep < 60; ++sweep) {
    double off = 0, diagonal = 0;
    for (int p = 0; p < 4; ++p) {
      diagonal += a[p][p] * a[p][p];
      for (int q = p + 1; q < 4; ++q) off += a[p][q] * a[p][q];
    }
    if (off <= 1e-40 * diagonal) break;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) {
        if (a[p][q] == 0) continue;
        double const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        double const t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        double const c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 4; ++k) {
          double const kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 4; ++k) {
          double const pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        for (int k = 0; k < 4; ++k) {
          double const kp = v[k][p], kq = v[k][q];
          v[k][p] = c * kp - s * kq;
          v[k][q] = s * kp + c * kq;
        }
      }
  }
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (a[i][i] > a[best][best]) best = i;
  return {v[0][best], v[1][best], v[2][best], v[3][best]};
}

}  // namespace

RigidTransform fit_rigid_transform(std::vector<Vec3> const& from, std::vector<Vec3> const& to) {
  double const n = double(from.size());
  Vec3 cf, ct;
  for (auto const& p : from) cf += p;
  for (auto const& p : to) ct += p;
  cf = (1 / n) * cf;
  ct = (1 / n) * ct;
  double s[3][3] = {};
  for (std::size_t i = 0; i < from.size(); ++i) {
    Vec3 const f = from[i] - cf, t = to[i] - ct;
    double const fv[3] = {f.x, f.y, f.z}, tv[3] = {t.x, t.y, t.z};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) s[a][b] += fv[a] * tv[b];
  }
  // Horn, "Closed-form solution of absolute orientation using unit quaternions", JOSA A 4 (1987).
  auto const q =
      dominant_eigenvector({{{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
                             {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
                             {s[2][0] - s[0][2], s[0][1] + s[1][0], -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1]},
                             {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], -s[0][0] - s[1][1] + s[2][2]}}});
  double const w = q[0], x = q[1], y = q[2], z = q[3];
  double const l = w * w + x * x + y * y + z * z;
  Mat3 const r{{{(w * w + x * x - y * y - z * z) / l, 2 * (x * y - w * z) / l, 2 * (x * z + w * y) / l},
                {2 * (x * y + w * z) / l, (w * w - x * x + y * y - z * z) / l, 2 * (y * z - w * x) / l},
                {2 * (x * z - w * y) / l, 2 * (y * z + w * x) / l, (w * w - x * x - y * y + z * z) / l}}};
  return {r, ct - r * cf};
}

namespace {

RigidTransform fitted_periodic(Mesh const& mesh, Interface1to1 const& face, double size) {
  std::vector<Vec3> own, donor;
  for_each_pair(mesh, face.range, face.to_donor, face.zone, face.donor_zone, [&](Index p, Index q) {
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
  for_each_pair(mesh, face.range, face.to_donor, face.zone, face.donor_zone, [&](Index p, Index q) {
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

Links connect(Mesh const& mesh, TopologyOptions const& options, Problems& problems) {
  Links links;
  links.of_zone.resize(mesh.zones.size());
  MeshExtent const extent = extent_of(mesh.coordinates);
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
                   " and " + describe_node(mesh, worst.donor) + " are " + format_length(worst.distance) +
                   " apart (tolerance " + format_length(tolerance) +
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
