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
    bool const axis = on_axis_[m.group] != 0;
    int const count = axis ? 0 : passage + m.offset;
    int const around = count < 0 ? -((passages_ - 1 - count) / passages_) : count / passages_;
    Points& points = open_[count - around * passages_];
    if (points.known.empty()) {
      points.known.assign(on_axis_.size(), 0);
      points.position.resize(on_axis_.size());
    }
    if (points.known[m.group] == 0) {
      points.known[m.group] = 1;
      points.position[m.group] = pitch_.times(-around * passages_)(x[m.node]);
      continue;
    }
    Vec3 const decided = pitch_.times(around * passages_)(points.position[m.group]);
    double const gap = distance(decided, x[m.node]);
    if (gap > gap_.distance) gap_ = {gap, m.node, passage};
    x.set(m.node, decided);
  }
  // Forget what no later passage meets: later ones reach down to passage + 1 + lowest_, and round the end to the first ones.
  std::erase_if(open_, [&](auto const& entry) {
    int const count = entry.first;
    bool const met_ahead = count >= passage + 1 + lowest_;
    bool const met_round = count <= highest_ - 1 || count >= passages_ + lowest_ || count == 0;
    return !met_ahead && !met_round;
  });
}

}  // namespace gridmorph
