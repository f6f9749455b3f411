#include <generators/passage_section.hpp>
#include <generators/spacing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace gridmorph::passage {

namespace {

/// How far the core starts behind the corners of the ring, in thicknesses of the blade there.
constexpr double behind_corners = 1;

double along_camber(double phi) { return 0.5 * (1 - std::cos(phi)); }

/// Where the core begins and ends along the camber line.
std::array<double, 2> core_ends(Airfoil const& airfoil, std::array<std::vector<double>, 4> const& ring_phi) {
  auto const& up = ring_phi[ring_upper];
  auto const& low = ring_phi[ring_lower];  // from trailing to leading edge
  auto const behind = [&](double phi) {
    return 2 * behind_corners * std::abs(airfoil.half_thickness(phi)) / airfoil.chord();
  };
  return {std::max(along_camber(up.front()) + behind(up.front()), along_camber(low.back()) + behind(low.back())),
          std::min(along_camber(up.back()) - behind(up.back()), along_camber(low.front()) - behind(low.front()))};
}

}  // namespace

void fill_tip(PassageOptions const& options, Airfoil const& airfoil, std::array<std::vector<double>, 4> const& ring_phi,
              std::array<PieceNodes, n_pieces>& pieces) {
  PieceNodes& core = pieces[tip_core];
  auto const ends = core_ends(airfoil, ring_phi);
  double const begin = ends[0], end = ends[1];
  // A side of the core: the contour, drawn towards the camber line and off the edges.
  auto const side = [&](std::vector<double> const& phi, int i, int last) {
    double const first_u = along_camber(phi.front()), last_u = along_camber(phi.back());
    bool const forward = last_u > first_u;
    double const share = (along_camber(phi[i]) - first_u) / (last_u - first_u);
    double const u = i == 0      ? (forward ? begin : end)
                     : i == last ? (forward ? end : begin)
                     : forward   ? begin + share * (end - begin)
                                 : end + share * (begin - end);
    return airfoil.off_camber(u, options.tip_core * airfoil.half_thickness(phi[i]));
  };
  int const ni = core.ni, nk = core.nk;
  for (int i = 0; i < ni; ++i) {
    Point2 const low = side(ring_phi[ring_lower], ni - 1 - i, ni - 1), up = side(ring_phi[ring_upper], i, ni - 1);
    for (int k = 0; k < nk; ++k) core.at(i, k) = low + (double(k) / (nk - 1)) * (up - low);
  }

  PieceNodes const& widest = pieces[tip_upper];
  double const width = (1 - options.tip_core) * std::abs(airfoil.half_thickness(ring_phi[ring_upper][ni / 2]));
  double const first = std::max(options.first_cell * airfoil.chord() / width,
                                demo::first_of_geometric(widest.nk - 1, options.max_growth));
  std::vector<double> const off_contour = demo::geometric_spacing(widest.nk - 1, first);
  auto const rim = [&](Piece ring, auto const& core_node) {
    PieceNodes& nodes = pieces[over_tip(ring)];
    for (int i = 0; i < nodes.ni; ++i) {
      Point2 const inside = core_node(i), contour = pieces[ring].at(i, 0);
      for (int k = 0; k < nodes.nk; ++k) nodes.at(i, k) = contour + off_contour[nodes.nk - 1 - k] * (inside - contour);
      nodes.at(i, 0) = inside;
    }
  };
  rim(ring_le, [&](int i) { return core.at(0, i); });
  rim(ring_upper, [&](int i) { return core.at(i, nk - 1); });
  rim(ring_te, [&](int i) { return core.at(ni - 1, nk - 1 - i); });
  rim(ring_lower, [&](int i) { return core.at(ni - 1 - i, 0); });
}

}  // namespace gridmorph::passage
