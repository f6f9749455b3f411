#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/guard/motion_path.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {

MotionPath::MotionPath(Coordinates const& coordinates, NodeGraph const& graph, BoundaryConditions const& boundary,
                       std::vector<Vec3> displacement)
    : displacement_(std::move(displacement)) {
  auto const& known = boundary.known;
  std::vector<std::uint8_t> seen(known.size(), 0);
  std::vector<std::size_t> body;
  for (std::size_t start = 0; start < known.size(); ++start) {
    if (seen[start] != 0 || !boundary.drives[start]) continue;
    seen[start] = 1;
    body = {start};
    for (std::size_t at = 0; at < body.size(); ++at)
      for (Index32 const n : graph.neighbours[known[body[at]]]) {
        auto const found = std::lower_bound(known.begin(), known.end(), n);
        std::size_t const slot = std::size_t(found - known.begin());
        if (found == known.end() || *found != n || seen[slot] != 0 || !boundary.drives[slot]) continue;
        seen[slot] = 1;
        body.push_back(slot);
      }
    add_body(coordinates, known, body);
  }
}

void MotionPath::add_body(Coordinates const& coordinates, std::vector<Index32> const& known,
                          std::vector<std::size_t> const& slots) {
  std::vector<Vec3> before, after;
  for (std::size_t const slot : slots) {
    before.push_back(coordinates[known[slot]]);
    after.push_back(before.back() + displacement_[slot]);
  }
  auto const fit = rigid_fit(before, after);
  if (!fit) return;
  Vec3 const turn = rotation_vector(fit->rotation);
  if (!(norm(turn) > 0)) return;
  double size = 0, beyond = 0;
  for (std::size_t n = 0; n < slots.size(); ++n) {
    Vec3 const arm = before[n] - fit->from;
    size = std::max(size, norm(arm));
    beyond = std::max(beyond, distance(fit->rotation * arm, after[n] - fit->to));
  }
  // What bends (a rope that hangs from something at rest, a blade on its root) would leave its ends on the way.
  constexpr double rigid = 0.01;
  if (beyond > rigid * size) return;
  Mat3 const back = transpose(fit->rotation);
  for (std::size_t n = 0; n < slots.size(); ++n) {
    Vec3 const arm = before[n] - fit->from;
    followers_.push_back({slots[n], int(bodies_.size()), arm, back * (after[n] - fit->to) - arm});
  }
  bodies_.push_back({fit->from, fit->to - fit->from, turn});
}

std::vector<Vec3> MotionPath::at(double share) const {
  if (share == 1) return displacement_;
  std::vector<Vec3> out;
  for (Vec3 const& u : displacement_) out.push_back(share * u);
  std::vector<Mat3> rotations;
  for (Body const& b : bodies_) rotations.push_back(rotation_by(share * b.turn));
  for (Follower const& f : followers_) {
    Vec3 const turned = rotations[f.body] * (f.arm + share * f.rest);
    out[f.slot] = share * bodies_[f.body].shift + (turned - f.arm);
  }
  return out;
}

}  // namespace gridmorph
