#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/run/diagnosis.hpp>
#include <gridmorph/run/mesh_summary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::cli {

namespace {

std::string name_of(Patch const& patch) { return patch.families.empty() ? patch.name : patch.families.front(); }

std::vector<Vec3> cell_corners(void const* mesh, FallenCells const& cell, Coordinates const& at) {
  Zone const& zone = static_cast<Mesh const*>(mesh)->zones.at(std::size_t(cell.worst_zone));
  std::vector<Vec3> out;
  for (int n = 0; n < 8; ++n)
    out.push_back(at[zone.node(
        {cell.worst_cell[0] + (n & 1), cell.worst_cell[1] + (n >> 1 & 1), cell.worst_cell[2] + (n >> 2)})]);
  return out;
}

std::vector<Vec3> element_corners(void const* mesh, FallenCells const& cell, Coordinates const& at) {
  std::vector<Vec3> out;
  for (Index32 const n : static_cast<Mesh const*>(mesh)->elements.corners(cell.number)) out.push_back(at[n]);
  return out;
}

Vec3 mean(std::vector<Vec3> const& points) {
  Vec3 sum;
  for (Vec3 const& p : points) sum += p;
  return (1 / double(points.size())) * sum;
}

std::string point_text(Vec3 const& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x + 0.0, p.y + 0.0, p.z + 0.0);
}

/// Patches that the selectors of a rule name; interfaces have none.
std::vector<int> patches_of(MeshForMessages const& mesh, MotionRule const& rule) {
  std::vector<int> out;
  for (auto const& selector : rule.patches)
    for (int const p : select(mesh.selectable, selector).patches) out.push_back(p);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// What a rule moves, and how far.
struct Moved {
  Box box;
  double size = 0, largest = 0;
};

Moved moved_by(MeshForMessages const& mesh, MotionRule const& rule, Coordinates const& morphed) {
  Moved out;
  for (int const p : patches_of(mesh, rule))
    for (Index const n : mesh.patch_nodes.at(p)) {
      out.box.add(mesh.baseline[n]);
      out.largest = std::max(out.largest, distance(mesh.baseline[n], morphed[n]));
    }
  if (out.box.low.x <= out.box.high.x) out.size = distance(out.box.low, out.box.high);
  return out;
}

/// The line that x' = M x + t turns points about; nothing where M is no rotation.
std::optional<AxisTurn> turn_of(Mat3 const& m, Vec3 const& t) {
  constexpr double tolerance = 1e-9;
  double change = 0;
  for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) change += std::abs(norm(m * e) - 1);
  if (change > tolerance) return {};
  return as_turn({m, t}, std::numeric_limits<double>::infinity());
}

void add_unit_causes(CaseFile const& case_file, MotionRule const& rule, Moved const& moved,
                     std::vector<std::string>& causes) {
  for (auto const& use : case_file.fields) {
    if (use.where != rule.where) continue;
    auto const mapping = use.field->mapping();
    if (mapping.max > 0.5 * moved.size)
      causes.push_back(fmt::format(
          "{}: the points of {} are up to {:.3g} from the patches, which are {:.3g} large; they may be in another unit "
          "(length_scale = 0.001 for millimetres in a mesh in metres) or of another place",
          rule.where, use.field->source(), mapping.max, moved.size));
    else if (moved.largest > moved.size)
      causes.push_back(fmt::format(
          "{}: {} moves its patches by up to {:.3g}, {:.3g} times their size; its displacements may be in another unit "
          "than its points, or factor too large",
          rule.where, use.field->source(), moved.largest, moved.largest / moved.size));
    return;
  }
  if (moved.largest > moved.size)
    causes.push_back(
        fmt::format("{}: the rule moves its patches by up to {:.3g}, {:.3g} times their size; its numbers may be in "
                    "another unit than the mesh",
                    rule.where, moved.largest, moved.largest / moved.size));
}

}  // namespace

MeshForMessages for_messages(Mesh const& mesh) {
  MeshForMessages out{mesh, mesh.coordinates, mesh.size(), {}, {}, cell_corners, &mesh};
  for (Patch const& patch : mesh.patches) {
    out.patch_names.push_back(name_of(patch));
    auto& nodes = out.patch_nodes.emplace_back();
    for_each_node(mesh.zones[patch.zone], patch.range, [&](Index n) { nodes.push_back(n); });
  }
  return out;
}

MeshForMessages for_messages(Mesh const& mesh, Boundary const& boundary) {
  MeshForMessages out{mesh, mesh.coordinates, mesh.size(), {}, {}, element_corners, &mesh};
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    out.patch_names.push_back(name_of(mesh.patches[p]));
    auto const& nodes = boundary.surface(int(p)).nodes;
    out.patch_nodes.emplace_back(nodes.begin(), nodes.end());
  }
  return out;
}

namespace {

FallenCells const* worst_inverted(QualityReport const& quality) {
  FallenCells const* worst = nullptr;
  for (auto const* region : {&quality.near_field, &quality.far_field}) {
    FallenCells const& fallen = (*region)[Fall::inverted];
    if (fallen.cells > 0 && (worst == nullptr || fallen.worst < worst->worst)) worst = &fallen;
  }
  return worst;
}

/// The broken cells of the certificate, or null.
FallenCells const* broken_cells(QualityReport const& quality) {
  return quality.certificate && !quality.certificate->holds() ? &quality.certificate->broken : nullptr;
}

/// "zone 'A' cell (i 3, j 1, k 7)", a verb, where it is now and was, and near what.
std::string place_of(MeshForMessages const& mesh, QualityReport const& quality, FallenCells const& cell,
                     std::string const& verb, Coordinates const& morphed) {
  Vec3 const now = mean(mesh.corners(mesh.mesh, cell, morphed));
  Vec3 const before = mean(mesh.corners(mesh.mesh, cell, mesh.baseline));
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t patch = 0;
  for (std::size_t p = 0; p < mesh.patch_nodes.size(); ++p)
    for (Index const n : mesh.patch_nodes[p])
      if (double const d = distance(before, mesh.baseline[n]); d < nearest) {
        nearest = d;
        patch = p;
      }
  MeasureStatistics at;
  at.worst_zone = cell.worst_zone;
  at.worst_cell = cell.worst_cell;
  std::string const text = worst_place(quality, at) + verb + ", now at " + point_text(now);
  if (!std::isfinite(nearest)) return text;
  return text + fmt::format(", in the baseline at {}, {:.3g} from patch '{}'", point_text(before), nearest,
                            mesh.patch_names[patch]);
}

}  // namespace

std::string describe_worst_inverted(MeshForMessages const& mesh, QualityReport const& quality,
                                    Coordinates const& morphed) {
  if (auto const* worst = worst_inverted(quality))
    return "the worst is " + place_of(mesh, quality, *worst, "", morphed) +
           fmt::format("; its smallest corner Jacobian is {} times the largest it had", format_value(worst->worst));
  if (auto const* broken = broken_cells(quality))
    return "the first is " + place_of(mesh, quality, *broken, "", morphed) +
           "; its Jacobian is positive at the corners and negative between them";
  return "";
}

std::string describe_first_broken(MeshForMessages const& mesh, QualityReport const& quality,
                                  Coordinates const& morphed) {
  auto const* cell = broken_cells(quality);
  if (cell == nullptr) cell = worst_inverted(quality);
  return cell == nullptr ? "" : place_of(mesh, quality, *cell, " is inside out", morphed);
}

std::vector<std::string> likely_causes(CaseFile const& case_file, MeshForMessages const& mesh,
                                       Coordinates const& morphed) {
  std::vector<std::string> causes;
  for (auto const& rule : case_file.motion.rules) {
    auto const* rigid = std::get_if<RigidRule>(&rule.rule);
    if (rigid == nullptr && !std::holds_alternative<FunctionRule>(rule.rule)) continue;
    Moved const moved = moved_by(mesh, rule, morphed);
    if (!(moved.size > 0) || !(moved.largest > 0)) continue;
    auto const turn = rigid != nullptr ? turn_of(rigid->matrix, rigid->translation) : std::nullopt;
    Vec3 const middle = 0.5 * (moved.box.low + moved.box.high);
    double const from_axis = turn ? norm(cross(middle - turn->origin, turn->direction)) : 0;
    if (from_axis > moved.size)
      causes.push_back(fmt::format(
          "{}: the patches turn about a line {:.3g} from their middle, {:.3g} times their size; look at axis and "
          "origin of the rotation (without axis it is about the axis of [mesh])",
          rule.where, from_axis, from_axis / moved.size));
    else
      add_unit_causes(case_file, rule, moved, causes);
  }
  return causes;
}

std::optional<std::string> axis_mismatch(Mesh const& mesh, Axis const& axis) {
  Vec3 const wanted = (1 / norm(axis.direction)) * axis.direction;
  std::optional<Vec3> other;
  for (auto const& interface : mesh.interfaces) {
    auto const turn = interface.periodic ? turn_of(interface.periodic->declared.rotation, {}) : std::nullopt;
    if (!turn) continue;
    Vec3 const& d = turn->direction;
    if (norm(cross(d, wanted)) < 1e-3) return {};
    bool const backward = -std::min({d.x, d.y, d.z}) > std::max({d.x, d.y, d.z});
    if (!other) other = backward ? -d : d;
  }
  if (!other) return {};
  return fmt::format("the axis of [mesh] is {}, but the periodic interfaces turn about {}: is it the right axis?",
                     point_text(wanted), point_text(*other));
}

Diagnosis diagnose(CaseFile const& case_file, MeshForMessages const& mesh, QualityReport const& quality,
                   Coordinates const& morphed) {
  return {describe_worst_inverted(mesh, quality, morphed), likely_causes(case_file, mesh, morphed)};
}

std::string refusal(std::string const& output, std::string const& what, Diagnosis const& diagnosis,
                    std::string const& what_to_do) {
  std::string text = fmt::format("'{}' is not written, because {}", output, what);
  if (!diagnosis.worst.empty()) text += "; " + diagnosis.worst;
  text += "\n  " + what_to_do + ", or set write_inverted = true in [guard]";
  for (auto const& cause : diagnosis.causes) text += "\n  likely cause: " + cause;
  return text;
}

}  // namespace gridmorph::cli
