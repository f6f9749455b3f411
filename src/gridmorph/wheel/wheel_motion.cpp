#include <gridmorph/wheel/wheel_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/open_passage.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

void append(std::vector<std::string>& to, std::vector<std::string> const& from) {
  for (auto const& text : from)
    if (std::find(to.begin(), to.end(), text) == to.end()) to.push_back(text);
}

}  // namespace

WheelMotion::WheelMotion(Mesh const& sector, Links const& links, WheelRows const& rows,
                         std::vector<Motion> const& motions, PlanOptions const& options,
                         std::vector<WheelRowBlades> const& blades)
    : sector_(sector), rows_(rows), blades_(blades), axis_(motions.front().axis) {
  for (Motion const& motion : motions)
    if (!motion.regions.empty())
      throw MotionError("region '" + motion.regions.front().name +
                        "': passages of a wheel are morphed without regions; remove it");
  std::vector<char> open;
  std::set<int> used;
  for (auto const& row : blades) {
    used.insert(row.blades.begin(), row.blades.end());
    open.push_back(std::any_of(row.blades.begin(), row.blades.end(), [&](int b) { return b != row.blades.front(); }));
  }

  ResolvedMotion const resolved = resolve(sector, motions[*used.begin()]);
  append(notes_, resolved.notes);
  OpenedPassage const opened = open_passage(sector, links, rows, resolved, open);
  Links const opened_links = connect(opened.mesh, options.topology);
  planned_ = make_plan({}, opened.mesh, opened_links, BoundaryMotion(opened.mesh, opened.motion), options);
  append(notes_, planned_.plan.notes);
  shares_ = blade_shares(sector, links, rows, resolved, open, planned_.boundary, planned_.plan.boundary_nodes);
  for (Index const n : planned_.plan.boundary_nodes) row_of_node_.push_back(rows.row_of_zone[sector.zone_of(n)]);

  values_.resize(motions.size());
  for (int const m : used) {
    ResolvedMotion const own = resolve(sector, motions[m]);
    BoundaryMotion const surface(sector, own);
    append(notes_, surface.notes());
    values_[m] = evaluate(opened.mesh, planned_.boundary, surface, planned_.plan.rotations);
  }
}

int WheelMotion::motion_of(int row, int passage) const {
  auto const& blades = blades_[row].blades;
  int const n = int(blades.size());
  return blades[((passage % n) + n) % n];
}

std::vector<Vec3> WheelMotion::boundary(int passage) const {
  std::vector<Vec3> out(shares_.size());
  Vec3 const direction = (1 / norm(axis_.direction)) * axis_.direction;
  for (std::size_t n = 0; n < out.size(); ++n) {
    BladeShare const& share = shares_[n];
    int const row = row_of_node_[n];
    if (share.on_axis) {
      double along = 0;
      for (int const m : blades_[row].blades) along += dot(values_[m][n], direction);
      out[n] = (along / double(blades_[row].blades.size())) * direction;
      continue;
    }
    int const lower = passage + share.lower();
    out[n] =
        share_motion(axis_, sector_.coordinates[planned_.plan.boundary_nodes[n]], values_[motion_of(row, lower)][n],
                     values_[motion_of(row, lower + 1)][n], share.weight_of_upper());
  }
  return out;
}

bool WheelMotion::alike(int passage, int other) const {
  for (int row = 0; row < int(blades_.size()); ++row)
    for (int beside = -1; beside <= 1; ++beside)
      if (motion_of(row, passage + beside) != motion_of(row, other + beside)) return false;
  return true;
}

}  // namespace gridmorph
