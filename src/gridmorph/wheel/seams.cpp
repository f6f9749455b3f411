#include <gridmorph/wheel/seams.hpp>

#include <algorithm>

namespace gridmorph {

Seams::Seams(Mesh const& mesh, SharedNodes const& shared, WheelRows const& rows, int row, int passages)
    : pitch_(rows.rows[row].pitch), passages_(passages) {
  std::map<int, int> number;
  for (auto const& m : shared.members()) {
    if (rows.row_of_zone[mesh.zone_of(m.node)] != row) continue;
    auto const [at, fresh] = number.try_emplace(m.group, int(on_axis_.size()));
    if (fresh) on_axis_.push_back(shared.on_axis(m.group) ? 1 : 0);
    members_.push_back({m.node, at->second, shared.on_axis(m.group) ? 0 : m.offset});
    lowest_ = std::min(lowest_, members_.back().offset);
    highest_ = std::max(highest_, members_.back().offset);
  }
}

void Seams::close(int passage, Coordinates& x) {
  for (auto const& m : members_) {
    int const count = on_axis_[m.group] != 0 ? 0 : passage + m.offset;
    Points& points = points_at(count);
    if (points.known[m.group] == 0) {
      points.known[m.group] = 1;
      points.position[m.group] = round_the_end(count, m.group).value_or(x[m.node]);
    }
    // As it is kept, with no turn in between: all nodes at one place have the same bits, where the ends of a part meet
    // too.
    Vec3 const decided = points.position[m.group];
    double const gap = distance(decided, x[m.node]);
    if (gap > gap_.distance) gap_ = {gap, m.node, passage};
    x.set(m.node, decided);
  }
  // Forget what no later passage meets: later ones reach down to passage + 1 + lowest_, and round the end to the first
  // ones.
  std::erase_if(open_, [&](auto const& entry) {
    int const count = entry.first;
    bool const met_ahead = count >= passage + 1 + lowest_;
    bool const met_round = count <= highest_ - 1 || count >= passages_ + lowest_ || count == 0;
    return !met_ahead && !met_round;
  });
}

Seams::Points& Seams::points_at(int count) {
  Points& points = open_[count];
  if (points.known.empty()) {
    points.known.assign(on_axis_.size(), 0);
    points.position.resize(on_axis_.size());
  }
  return points;
}

std::optional<Vec3> Seams::round_the_end(int count, int group) const {
  for (auto const& [other, points] : open_)
    if (other != count && (count - other) % passages_ == 0 && points.known[group] != 0)
      return pitch_.times(count - other)(points.position[group]);
  return std::nullopt;
}

}  // namespace gridmorph
