#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/disagreements.hpp>

#include <cmath>
#include <numbers>

namespace gridmorph {

namespace {

/// What to do about torn copies: a rule whose displacement would be the same in every pitch.
std::string remedy(double turn_rad) {
  std::string text = "; the motion has to be the same in every pitch";
  if (turn_rad > 0) {
    std::string const waves = to_text(std::round(2 * std::numbers::pi / turn_rad), 6);
    text += " of " + to_text(turn_rad * 180 / std::numbers::pi, 6) +
            " degrees: waves around the axis fit where there are " + waves + " of them in a turn, cos(" + waves +
            " * theta), or a multiple of that";
  }
  text += "; where the sides of a blade stand a pitch apart, as in H meshes, ";
  if (turn_rad > 0)
    return text +
           "no lattice and no motion in x, y, z moves both alike: give such blades the rule sections, or a formula in "
           "dr, dtheta and daxial";
  return text +
         "only what is the same all along the pitch moves both alike: give such blades a lattice with one control "
         "point along it, a formula without its coordinate, or the rule sections";
}

}  // namespace

void TornCopies::add(std::string const& rule, std::string const& name, std::string const& patch, Copies const& copies) {
  double const gap = distance(copies.displacement, copies.of_copy);
  Found& found = found_[rule];
  ++found.count;
  if (!(gap > found.gap)) return;
  found.name = name;
  found.patch = patch;
  found.worst = copies;
  found.gap = gap;
}

std::vector<std::string> TornCopies::messages(Boundary const& boundary) const {
  std::vector<std::string> out;
  for (auto const& [rule, f] : found_)
    out.push_back(rule + " (" + f.name + ") gives " + std::to_string(f.count) + " nodes of " + f.patch +
                  " and their periodic copies different displacements, most at " +
                  boundary.describe_node(f.worst.node) + ": " + to_text(f.worst.displacement, 6) + " there, and " +
                  to_text(f.worst.of_copy, 6) + " in its place from " + boundary.describe_node(f.worst.copy) +
                  ", apart by " + to_text(f.gap, 6) + remedy(f.worst.turn_rad));
  return out;
}

}  // namespace gridmorph
