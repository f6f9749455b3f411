#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace gridmorph {

MeasureText text_of(Measure measure) {
  switch (measure) {
    case Measure::aspect_ratio:
      return {"aspect ratio", "longest / shortest of the 12 edges of a cell (collapsed edges left out); best 1"};
    case Measure::determinant_2x2x2:
      return {
          "determinant 2x2x2",
          "smallest / largest Jacobian determinant of the trilinear cell over its 8 corners; best 1, negative when any "
          "is negative, never below -1; -1 when none is positive"};
    case Measure::determinant_3x3x3:
      return {
          "determinant 3x3x3",
          "smallest / largest Jacobian determinant of the trilinear cell over the 27 points with parameters 0, 1/2, 1; "
          "best 1, negative when any is negative, never below -1; -1 when none is positive"};
    case Measure::minimum_angle_deg:
      return {"minimum angle [deg]",
              "smallest angle between the two edges in the corners of the 6 faces, in degrees; best 90"};
    case Measure::equiangle_skewness:
      return {"equiangle skewness",
              "max((amax - 90) / 90, (90 - amin) / 90) over the face angles in degrees; best 0, worst 1"};
    case Measure::volume:
      return {"volume",
              "integral of the Jacobian determinant (Simpson's rule over 27 points, exact), in length units cubed"};
    case Measure::volume_ratio:
      return {
          "volume ratio",
          "largest of larger / smaller volume of a cell and each face neighbour, across 1-to-1 interfaces too; best 1, "
          "unbounded (null) unless both volumes are positive"};
    case Measure::relative_displacement:
      return {
          "relative displacement",
          "per grid direction the largest |u_p - u_q| over the 4 edges pq of a cell along it, divided by their mean "
          "baseline length (u: displacement of a node); the largest of the three directions"};
    case Measure::non_orthogonality_deg: return {"non-orthogonality [deg]", "of elements alone, in degrees; best 0"};
    case Measure::face_skewness: return {"face skewness", "of elements alone; best 0"};
    case Measure::relative_displacement_i:
      return {"relative displacement i", "the same along index direction i of the cell's zone alone"};
    case Measure::relative_displacement_j:
      return {"relative displacement j", "the same along index direction j of the cell's zone alone"};
    case Measure::relative_displacement_k:
      return {"relative displacement k", "the same along index direction k of the cell's zone alone"};
    case Measure::growth_ratio:
      return {
          "growth ratio",
          "largest of longer / shorter of an edge of a cell and the edge that continues it along its grid line, across "
          "1-to-1 interfaces too (collapsed edges left out); best 1"};
    case Measure::face_area_ratio:
      return {"face area ratio",
              "largest of larger / smaller area of a face of a cell and each face that continues it in its grid "
              "surface, in "
              "the cell next to it, across 1-to-1 interfaces too (collapsed faces left out); area: half the cross "
              "product of "
              "the diagonals; best 1"};
    case Measure::count: break;
  }
  return {"unknown", ""};
}

std::string_view element_formula(Measure measure) {
  switch (measure) {
    case Measure::aspect_ratio: return "longest / shortest edge of an element (collapsed edges left out); best 1";
    case Measure::determinant_2x2x2:
      return "hexahedra, prisms, pyramids, quadrilaterals: smallest / largest Jacobian determinant over the corners "
             "(pyramids: of the base, without the factor that vanishes at the apex); tetrahedra: sqrt(2) J / largest "
             "product of the 3 edge lengths of a corner; triangles: 2/sqrt(3) J / largest product of 2; polyhedra: "
             "smallest "
             "S . d / (A |d|) over the faces, S and A vector and size of a face's area, d from the element's centre to "
             "that of the "
             "face; best 1, negative when any J or S . d is negative, never below -1";
    case Measure::determinant_3x3x3:
      return "the same over the corners and the points half way between them; for tetrahedra, triangles and polyhedra "
             "equal to determinant_2x2x2";
    case Measure::minimum_angle_deg:
      return "smallest angle between the two edges in the corners of the faces, in degrees; best 60 in triangles, 90 "
             "in quadrilaterals";
    case Measure::equiangle_skewness:
      return "max((amax - a) / (180 - a), (a - amin) / a) over the face angles in degrees, a = 60 in triangles, 90 in "
             "quadrilaterals, 180 - 360 / n in faces of polyhedra with n corners, where for n > 4 angles count as too "
             "large "
             "above 180 alone; best 0, worst 1";
    case Measure::volume:
      return "integral of the Jacobian determinant, of polyhedra the sum of the pyramids from their centre to their "
             "faces, "
             "in length units cubed; in 2-D the area";
    case Measure::volume_ratio:
      return "largest of larger / smaller volume of an element and each neighbour across a side, through connections "
             "too; "
             "best 1, unbounded (null) unless all volumes are positive";
    case Measure::relative_displacement:
      return "for each set of edges that run along one direction of the element (a tetrahedron's edges each alone) the "
             "largest |u_p - u_q| over its edges pq, divided by their mean baseline length (u: displacement of a "
             "node); "
             "the largest of them; of a polyhedron all edges together";
    case Measure::non_orthogonality_deg:
      return "largest angle over the inner faces of an element between the normal of the face and the line between the "
             "centres of the elements on both sides, in degrees, as OpenFOAM's checkMesh measures it; best 0";
    case Measure::face_skewness:
      return "largest distance over the faces of an element from where the line between the centres on both sides "
             "crosses the face to the face's centre, against the reach of the face in that direction, as OpenFOAM's "
             "checkMesh measures it; best 0";
    case Measure::relative_displacement_i:
    case Measure::relative_displacement_j:
    case Measure::relative_displacement_k:
    case Measure::growth_ratio:
    case Measure::face_area_ratio: return "of blocks alone, whose cells lie along grid lines";
    case Measure::count: break;
  }
  return "";
}

std::string format_value(double value) {
  if (std::isinf(value)) return value > 0 ? "unbounded" : "-unbounded";
  return fmt::format("{:.4g}", value);
}

nlohmann::json finite_or_null(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); }

std::string worst_place(QualityReport const& report, MeasureStatistics const& statistics) {
  if (statistics.worst_zone < 0) return "-";
  if (report.unstructured)
    return fmt::format("zone '{}' element {}", report.zone_names.at(std::size_t(statistics.worst_zone)),
                       statistics.worst_cell[0] + 1);
  return describe_cell(report.zone_names.at(std::size_t(statistics.worst_zone)), statistics.worst_cell);
}

std::string node_place(QualityReport const& report, NodeLocation const& location) {
  if (location.zone < 0) return "-";
  if (report.unstructured)
    return fmt::format("zone '{}' node {}", report.zone_names.at(std::size_t(location.zone)), location.node[0] + 1);
  return fmt::format("zone '{}' node (i {}, j {}, k {})", report.zone_names.at(std::size_t(location.zone)),
                     location.node[0] + 1, location.node[1] + 1, location.node[2] + 1);
}

}  // namespace gridmorph
