#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/passage_motions.hpp>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace gridmorph {

SameRules all_differ(std::size_t motions) {
  SameRules out(motions);
  std::iota(out.begin(), out.end(), 0);
  return out;
}

void refuse_regions(std::vector<Motion> const& motions) {
  for (Motion const& motion : motions)
    if (!motion.regions.empty())
      throw MotionError("region '" + motion.regions.front().name +
                        "': passages of a wheel are morphed without regions; remove it");
}

std::vector<int> used_motions(std::vector<WheelRowBlades> const& blades) {
  std::set<int> used;
  for (auto const& row : blades) used.insert(row.blades.begin(), row.blades.end());
  return {used.begin(), used.end()};
}

std::vector<char> open_rows(std::vector<WheelRowBlades> const& blades) {
  std::vector<char> open;
  for (auto const& row : blades)
    open.push_back(
        std::any_of(row.blades.begin(), row.blades.end(), [&](int b) { return b != row.blades.front(); }) ? 1 : 0);
  return open;
}

PassageMotions::PassageMotions(WheelRows const& rows, std::vector<WheelRowBlades> blades, std::vector<Node> nodes,
                               std::vector<std::vector<Vec3>> values)
    : blades_(std::move(blades)), nodes_(std::move(nodes)), values_(std::move(values)) {
  for (auto const& row : rows.rows) pitches_.push_back(row.pitch);
}

int PassageMotions::motion_of(int row, int passage) const {
  auto const& blades = blades_[row].blades;
  int const n = int(blades.size());
  return blades[((passage % n) + n) % n];
}

std::vector<Vec3> PassageMotions::boundary(int passage) const {
  std::vector<Vec3> out(nodes_.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    auto const& [place, row, share] = nodes_[n];
    RowPitch const& pitch = pitches_[row];
    if (share.on_axis) {
      Vec3 const& direction = pitch.direction();
      double along = 0;
      for (int const m : blades_[row].blades) along += dot(values_[m][n], direction);
      out[n] = (along / double(blades_[row].blades.size())) * direction;
      continue;
    }
    int const lower = passage + share.lower();
    out[n] = pitch.share_motion(place, values_[motion_of(row, lower)][n], values_[motion_of(row, lower + 1)][n],
                                share.weight_of_upper());
  }
  return out;
}

bool PassageMotions::alike(int passage, int other) const {
  for (int row = 0; row < int(blades_.size()); ++row)
    for (int beside = -1; beside <= 1; ++beside)
      if (motion_of(row, passage + beside) != motion_of(row, other + beside)) return false;
  return true;
}

int PassageMotions::first_alike(int passage) const {
  int same = 0;
  while (same < passage && !alike(passage, same)) ++same;
  return same;
}

int PassageMotions::n_passages() const {
  int most = 0;
  for (auto const& row : blades_) most = std::max(most, row.passages);
  return most;
}

}  // namespace gridmorph
