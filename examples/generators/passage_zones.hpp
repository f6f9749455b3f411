// Zones, patches and interfaces of the demo passage: which piece of the section lies where. Internal to the demo.
#pragma once

#include <generators/passage.hpp>
#include <generators/passage_section.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <string>
#include <vector>

namespace gridmorph::passage {

/// A piece of the section in its zone: index of its first node along i and k.
struct PiecePlace {
  Piece piece;
  int i = 0, k = 0;
};

struct ZoneLayout {
  std::string name;
  std::vector<PiecePlace> pieces;
  std::array<int, 2> cells{0, 0};  ///< along i and k
  int bottom = 0, top = 0;         ///< its stations along the span

  [[nodiscard]] int n_span() const { return top - bottom + 1; }
};

/// Which zones there are, and which stations of the span they have.
struct PassageLayout {
  PassageLayout(PassageOptions const& options, PassageCounts const& counts);

  PassageCounts counts;
  bool left_handed;
  std::string cavity;       ///< family of what is cut into the tip
  std::vector<int> levels;  ///< stations where pieces begin or end: hub, floor of the cavity, tip, case
  std::vector<ZoneLayout> zones;

  /// Station where a piece begins: the hub, or over the tip the tip itself or the floor; `top` where there is none.
  [[nodiscard]] int bottom_of(Piece piece) const;
  /// Index j of a station in a zone.
  [[nodiscard]] int j_of(ZoneLayout const& zone, int station) const {
    return left_handed ? zone.top - station : station - zone.bottom;
  }
  [[nodiscard]] Index n_nodes() const;

 private:
  BladeTip tip_;
};

void add_zones(Mesh& mesh, PassageLayout const& layout);
/// One patch per family and zone face, or rectangle of one.
void add_patches(Mesh& mesh, PassageLayout const& layout);
/// Every interface from both sides. `turn` takes the lower periodic onto the upper one; `center` is a point on its
/// axis.
void add_interfaces(Mesh& mesh, PassageLayout const& layout, RigidTransform const& turn, Vec3 const& center);

}  // namespace gridmorph::passage
