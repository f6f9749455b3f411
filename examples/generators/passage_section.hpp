// The blade-to-blade mesh of the demo passage at one span fraction. Internal to the demo.
#pragma once

#include <generators/passage.hpp>
#include <generators/passage_geometry.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace gridmorph::passage {

enum Piece {
  ring_le,
  ring_upper,
  ring_te,
  ring_lower,
  inlet_lower,
  inlet_middle,
  inlet_upper,
  lower,
  upper,
  outlet_lower,
  outlet_middle,
  outlet_upper,
  tip_le,  // these five over a tip only
  tip_upper,
  tip_te,
  tip_lower,
  tip_core,
  n_pieces
};
constexpr int n_row_pieces = tip_le;
/// What lies beside a piece of the ring, over the tip.
constexpr Piece over_tip(Piece ring) { return Piece(tip_le + (ring - ring_le)); }

std::string_view name(Piece piece);

/// Cells of a piece along i (streamwise or round the blade) and k (off the wall or along the pitch).
std::array<int, 2> piece_cells(PassageCounts const& counts, Piece piece);

/// Nodes (i, k) of one piece of a section, i fastest.
struct PieceNodes {
  int ni = 0, nk = 0;
  std::vector<Point2> p;

  Point2& at(int i, int k) { return p[i + std::size_t(ni) * k]; }
  [[nodiscard]] Point2 const& at(int i, int k) const { return p[i + std::size_t(ni) * k]; }
};

/// Fills one piece after another for any span fraction; neighbours share the nodes of their common edge bit for bit.
///
/// Ring: straight lines normal to the wall, geometric growth. Around it: edges that leave the ring's corners 60 degrees
/// off the ring (five lines meet there), transfinite interpolation between them by edge arc lengths.
class SectionMesher {
 public:
  SectionMesher(PassageOptions const& options, PassageCounts const& counts);

  [[nodiscard]] std::array<PieceNodes, n_pieces> const& operator()(double span);

 private:
  PassageOptions options_;
  PassageCounts counts_;
  Annulus annulus_;
  std::array<PieceNodes, n_pieces> pieces_;
  std::array<std::vector<double>, 4> ring_phi_;  ///< where the wall's nodes are on the contour, see Airfoil
};

/// Fills the pieces over the tip inside of the ring's, whose wall nodes are at these places of the contour.
void fill_tip(PassageOptions const& options, Airfoil const& airfoil, std::array<std::vector<double>, 4> const& ring_phi,
              std::array<PieceNodes, n_pieces>& pieces);

/// How much of either half of the blade contour, measured as its nodes are spread, lies between leading edge and upper,
/// leading edge and lower, upper corner and trailing edge, lower corner and trailing edge (at mid span).
struct CornerFractions {
  double leading_upper, leading_lower, trailing_upper, trailing_lower;
};
CornerFractions corner_fractions(PassageOptions const& options);

}  // namespace gridmorph::passage
