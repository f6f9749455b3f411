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
};

std::vector<ZoneLayout> zone_layouts(PassageOptions::Layout layout, PassageCounts const& counts);

void add_zones(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts);
/// One patch per family and zone face.
void add_patches(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts, bool left_handed);
/// Every interface from both sides. `turn` takes the lower periodic onto the upper one; `center` is a point on its axis.
void add_interfaces(Mesh& mesh, std::vector<ZoneLayout> const& layouts, PassageCounts const& counts,
                    RigidTransform const& turn, Vec3 const& center);

}  // namespace gridmorph::passage
