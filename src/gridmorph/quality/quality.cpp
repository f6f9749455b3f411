#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/quality.hpp>

namespace gridmorph {

std::string_view to_string(Measure measure) {
  switch (measure) {
    case Measure::aspect_ratio: return "aspect_ratio";
    case Measure::determinant_2x2x2: return "determinant_2x2x2";
    case Measure::determinant_3x3x3: return "determinant_3x3x3";
    case Measure::minimum_angle_deg: return "minimum_angle_deg";
    case Measure::equiangle_skewness: return "equiangle_skewness";
    case Measure::volume: return "volume";
    case Measure::volume_ratio: return "volume_ratio";
    case Measure::relative_displacement: return "relative_displacement";
    case Measure::non_orthogonality_deg: return "non_orthogonality_deg";
    case Measure::face_skewness: return "face_skewness";
    case Measure::relative_displacement_i: return "relative_displacement_i";
    case Measure::relative_displacement_j: return "relative_displacement_j";
    case Measure::relative_displacement_k: return "relative_displacement_k";
    case Measure::growth_ratio: return "growth_ratio";
    case Measure::face_area_ratio: return "face_area_ratio";
    case Measure::count: break;
  }
  return "unknown";
}

std::string_view to_string(Fall fall) {
  switch (fall) {
    case Fall::inverted: return "inverted";
    case Fall::determinant: return "determinant";
    case Fall::angle: return "angle";
    case Fall::skewness: return "skewness";
    case Fall::loss: return "loss";
    case Fall::collapsed: return "collapsed";
    case Fall::flat_before: return "flat_before";
    case Fall::count: break;
  }
  return "unknown";
}

std::vector<Index> first_cells(Mesh const& mesh) {
  std::vector<Index> first(1, 0);
  first.reserve(mesh.zones.size() + 1);
  for (Zone const& z : mesh.zones)
    first.push_back(first.back() + Index(z.extent[0] - 1) * (z.extent[1] - 1) * (z.extent[2] - 1));
  return first;
}

std::vector<WallFace> wall_faces(Mesh const& mesh, std::span<int const> patches) {
  std::vector<WallFace> faces;
  for (int const p : patches) {
    Patch const& patch = mesh.patches.at(p);
    int axis = -1, thin = 0;
    for (int a = 0; a < 3; ++a)
      if (patch.range.extent(a) == 1) {
        axis = a;
        ++thin;
      }
    if (thin != 1) continue;
    int const last = mesh.zones[patch.zone].extent[axis] - 1, at = patch.range.begin[axis];
    if (at == 0 || at == last)
      faces.push_back({patch.zone, patch.range, axis, at == 0 ? 0 : 1,
                       patch.families.empty() ? patch.name : patch.families.front()});
  }
  return faces;
}

std::string describe_cell(std::string_view zone_name, Index3 const& cell) {
  return "zone '" + std::string(zone_name) + "' cell (i " + std::to_string(cell[0] + 1) + ", j " +
         std::to_string(cell[1] + 1) + ", k " + std::to_string(cell[2] + 1) + ")";
}

}  // namespace gridmorph
