#include <gridmorph/wheel/rows.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

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

/// What a link shifts its nodes by where it does so to its tolerance: the mean over them.
std::optional<Vec3> shift_of(Mesh const& mesh, PassageLink const& link) {
  Vec3 mean{};
  for (auto const& [own, donor] : link.pairs)
    mean = mean + (1 / double(link.pairs.size())) * (mesh.coordinates[donor] - mesh.coordinates[own]);
  bool const shifts = std::all_of(link.pairs.begin(), link.pairs.end(), [&](auto const& pair) {
    return distance(mesh.coordinates[pair[0]] + mean, mesh.coordinates[pair[1]]) <= link.tolerance;
  });
  if (!shifts || norm(mean) <= link.tolerance) return {};
  return mean;
}

/// 1 where the largest component is positive, so that both sides of a file agree which way a straight row goes.
int way_of(Vec3 const& shift) {
  double largest = shift.x;
  for (double const c : {shift.y, shift.z})
    if (std::abs(c) > std::abs(largest)) largest = c;
  return largest > 0 ? 1 : -1;
}

/// Finds what periodic links do, one after the other.
class RowFinder {
 public:
  RowFinder(Mesh const& mesh, PassageLinks const& links, Axis const& axis)
      : mesh_(mesh),
        links_(links),
        axis_(axis),
        direction_((1 / norm(axis.direction)) * axis.direction),
        out_(connected_zones(mesh, links)),
        shifts_(out_.rows.size()) {
    out_.pitches_of_link.assign(links.all.size(), 0);
  }

  WheelRows run() {
    for (std::size_t l = 0; l < links_.all.size(); ++l) {
      PassageLink const& link = links_.all[l];
      if (!link.periodic) continue;
      double const angle = angle_about(direction_, link.transform.rotation);
      // A whole turn is a wheel already; no turn about this axis is a translation, or a rotation about another one.
      double const count = 2 * std::numbers::pi / std::abs(angle);
      int const passages = count < 1e6 ? int(std::lround(count)) : 0;
      if (passages > 1)
        turns(l, angle, passages);
      else if (auto const shift = shift_of(mesh_, link))
        shifts(l, *shift);
      else
        problems_.add(describe(mesh_, link) +
                      " does not turn about the axis of [mesh], and no shift "
                      "brings all of its nodes onto their "
                      "partners; a wheel needs rotational periodicity about "
                      "it, a straight row translational one");
    }
    straighten();
    problems_.throw_if_any<MeshError>();
    return std::move(out_);
  }

 private:
  WheelRow& row_of(PassageLink const& link) { return out_.rows[out_.row_of_zone[link.zone]]; }

  void turns(std::size_t l, double angle, int passages) {
    PassageLink const& link = links_.all[l];
    out_.pitches_of_link[l] = angle > 0 ? 1 : -1;
    RowPitch const pitch(axis_, passages);
    Pitches const turn = pitch.times(out_.pitches_of_link[l]);
    double worst = 0;
    Index at = -1;
    for (auto const& [own, donor] : link.pairs) {
      double const gap = distance(turn(mesh_.coordinates[own]), mesh_.coordinates[donor]);
      if (gap > worst) {
        worst = gap;
        at = own;
      }
    }
    int& row_passages = row_of(link).passages;
    if (worst > link.tolerance) {
      problems_.add(describe(mesh_, link) + " turns by " + to_text(angle * 180 / std::numbers::pi, 6) +
                    " degrees, and " + std::to_string(passages) +
                    " passages do not make a whole wheel about the axis: a "
                    "turn by 360 / " +
                    std::to_string(passages) + " degrees leaves " + describe_node(mesh_, at) + " " + to_text(worst, 6) +
                    " from its periodic partner (tolerance " + to_text(link.tolerance, 6) +
                    "); check the axis of [mesh]");
    } else if (row_passages > 1 && row_passages != passages) {
      problems_.add(describe(mesh_, link) + " turns by 360 / " + std::to_string(passages) +
                    " degrees, another one of its row by 360 / " + std::to_string(row_passages) +
                    "; one row has one pitch");
    } else {
      row_passages = passages;
      row_of(link).pitch = pitch;
      any_wheel_ = true;
    }
  }

  void shifts(std::size_t l, Vec3 const& shift) {
    PassageLink const& link = links_.all[l];
    Shifts& row = shifts_[out_.row_of_zone[link.zone]];
    // As the first of the row: of two components that are as large round-off would choose anew for each.
    int const way = row.links == 0 ? way_of(shift) : (dot(shift, row.first) > 0 ? 1 : -1);
    out_.pitches_of_link[l] = way;
    Vec3 const pitch = double(way) * shift;
    if (row.links == 0) row.first = pitch;
    if (distance(pitch, row.first) > 2 * link.tolerance)
      problems_.add(describe(mesh_, link) + " shifts by " + to_text(shift, 6) + ", another one of its row by " +
                    to_text(row.first, 6) + "; one row has one pitch, and no second periodic direction");
    row.sum = row.sum + pitch;
    ++row.links;
  }

  /// Rows whose links shift.
  void straighten() {
    for (std::size_t r = 0; r < shifts_.size(); ++r) {
      Shifts const& shifts = shifts_[r];
      if (shifts.links == 0) continue;
      if (any_wheel_)
        problems_.add("the row of zone '" + mesh_.zones[out_.rows[r].zones.front()].name +
                      "' has periodic sides a shift by " + to_text(shifts.first, 6) +
                      " apart, and others of this mesh turn about the axis; make wheels "
                      "and straight rows of meshes of "
                      "their own");
      out_.rows[r].passages = 0;
      out_.rows[r].pitch = RowPitch((1 / double(shifts.links)) * shifts.sum);
    }
  }

  struct Shifts {
    Vec3 first, sum;
    int links = 0;
  };

  Mesh const& mesh_;
  PassageLinks const& links_;
  Axis const& axis_;
  Vec3 direction_;
  WheelRows out_;
  std::vector<Shifts> shifts_;  ///< per row
  bool any_wheel_ = false;
  Problems problems_;
};

}  // namespace

RowPitch WheelRows::any_pitch(Axis const& axis) const {
  auto const at = std::find_if(rows.begin(), rows.end(), [](WheelRow const& row) { return row.periodic(); });
  return at == rows.end() ? RowPitch(axis, 1) : at->pitch;
}

WheelRows find_rows(Mesh const& mesh, PassageLinks const& links, Axis const& axis) {
  return RowFinder(mesh, links, axis).run();
}

}  // namespace gridmorph
