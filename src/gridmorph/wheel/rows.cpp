#include <gridmorph/wheel/rows.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/wheel/turn.hpp>

#include <cmath>
#include <numbers>

namespace gridmorph {

namespace {

/// Angle of a rotation about the unit direction d, in (-pi, pi]; meaningful when d is its axis.
double angle_about(Vec3 const& d, Mat3 const& r) {
  Vec3 const twice_sine{r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
  return std::atan2(dot(d, twice_sine), r.m[0][0] + r.m[1][1] + r.m[2][2] - 1);
}

WheelRows connected_zones(Mesh const& mesh, PassageLinks const& links) {
  DisjointSets<int> sets(mesh.zones.size());
  for (PassageLink const& l : links.all) sets.join(l.zone, l.donor_zone);
  WheelRows out;
  out.row_of_zone = sets.set_numbers();
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    std::size_t const row = std::size_t(out.row_of_zone[z]);
    if (row == out.rows.size()) out.rows.emplace_back();
    out.rows[row].zones.push_back(z);
  }
  return out;
}

}  // namespace

WheelRows find_rows(Mesh const& mesh, PassageLinks const& links, Axis const& axis) {
  WheelRows out = connected_zones(mesh, links);
  Vec3 const direction = (1 / norm(axis.direction)) * axis.direction;
  out.pitches_of_link.assign(links.all.size(), 0);
  Problems problems;
  for (std::size_t l = 0; l < links.all.size(); ++l) {
    PassageLink const& link = links.all[l];
    if (!link.periodic) continue;
    double const angle = angle_about(direction, link.transform.rotation);
    // A whole turn is a wheel already; no turn about this axis is a translation, or a rotation about another one.
    double const count = 2 * std::numbers::pi / std::abs(angle);
    int const passages = count < 1e6 ? int(std::lround(count)) : 0;
    int& row_passages = out.rows[out.row_of_zone[link.zone]].passages;
    double worst = 0;
    Index at = -1;
    if (passages > 1) {
      Turn const turn(axis, angle > 0 ? 1 : -1, passages);
      for (auto const& [own, donor] : link.pairs) {
        double const gap = distance(turn(mesh.coordinates[own]), mesh.coordinates[donor]);
        if (gap > worst) {
          worst = gap;
          at = own;
        }
      }
    }
    if (passages < 2)
      problems.add(describe(mesh, link) +
                   " does not turn about the axis of [mesh]; a wheel needs rotational periodicity about it");
    else if (worst > link.tolerance)
      problems.add(describe(mesh, link) + " turns by " + to_text(angle * 180 / std::numbers::pi, 6) + " degrees, and " +
                   std::to_string(passages) + " passages do not make a whole wheel about the axis: a turn by 360 / " +
                   std::to_string(passages) + " degrees leaves " + describe_node(mesh, at) + " " + to_text(worst, 6) +
                   " from its periodic partner (tolerance " + to_text(link.tolerance, 6) +
                   "); check the axis of [mesh]");
    else if (row_passages > 1 && row_passages != passages)
      problems.add(describe(mesh, link) + " turns by 360 / " + std::to_string(passages) +
                   " degrees, another one of its row by 360 / " + std::to_string(row_passages) +
                   "; one row has one pitch");
    else
      row_passages = passages;
    out.pitches_of_link[l] = angle > 0 ? 1 : -1;
  }
  problems.throw_if_any<MeshError>();
  return out;
}

}  // namespace gridmorph
