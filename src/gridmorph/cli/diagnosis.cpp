#include <gridmorph/cli/diagnosis.hpp>
#include <gridmorph/cli/mesh_summary.hpp>
#include <gridmorph/motion/selectors.hpp>
#include <gridmorph/report/measure_text.hpp>

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
  for (Number const n : static_cast<UnstructuredMesh const*>(mesh)->elements.corners(cell.number)) out.push_back(at[n]);
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
    for (Index const n : mesh.patch_nodes.at(std::size_t(p))) {
      out.box.add(mesh.baseline[n]);
      out.largest = std::max(out.largest, distance(mesh.baseline[n], morphed[n]));
    }
  if (out.box.low.x <= out.box.high.x) out.size = distance(out.box.low, out.box.high);
  return out;
}

struct FoundTurn {
  Vec3 direction;  ///< unit vector, its largest component positive
  double angle;    ///< [rad]
};

/// Axis and angle of a rotation; nothing for the identity, half a turn and matrices that are no rotation.
std::optional<FoundTurn> turn_of(Mat3 const& m) {
  Vec3 const x = m * Vec3{1, 0, 0}, y = m * Vec3{0, 1, 0}, z = m * Vec3{0, 0, 1};
  constexpr double tolerance = 1e-9;
  if (std::abs(norm(x) - 1) + std::abs(norm(y) - 1) + std::abs(norm(z) - 1) > tolerance) return {};
  // Trace: 1 + 2 cos(angle); the antisymmetric part: 2 sin(angle) times the axis.
  double const angle = std::acos(std::clamp((x.x + y.y + z.z - 1) / 2, -1.0, 1.0));
  Vec3 const axial{y.z - z.y, z.x - x.z, x.y - y.x};
  if (!(angle > 1e-6) || !(norm(axial) > 1e-9)) return {};
  double const low = std::min({axial.x, axial.y, axial.z}), high = std::max({axial.x, axial.y, axial.z});
  return FoundTurn{((-low > high ? -1 : 1) / norm(axial)) * axial, angle};
}

/// Distance of a point from the axis of the rotation in x' = M x + t; nothing where M is no rotation.
std::optional<double> distance_from_axis(RigidRule const& rule, Vec3 const& point) {
  auto const turn = turn_of(rule.matrix);
  if (!turn) return {};
  Vec3 const step = rule.matrix * point + rule.translation - point;
  Vec3 const across = step - dot(step, turn->direction) * turn->direction;
  return norm(across) / (2 * std::sin(turn->angle / 2));
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
    Zone const& zone = mesh.zones[std::size_t(patch.zone)];
    auto const& r = patch.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) nodes.push_back(zone.node({i, j, k}));
  }
  return out;
}

MeshForMessages for_messages(UnstructuredMesh const& mesh, BoundaryConditions const& boundary) {
  MeshForMessages out{boundary.outline, mesh.coordinates, mesh.size(), {}, {}, element_corners, &mesh};
  for (std::size_t p = 0; p < boundary.outline.patches.size(); ++p) {
    out.patch_names.push_back(name_of(boundary.outline.patches[p]));
    auto const& nodes = boundary.nodes_of_patch.at(p);
    out.patch_nodes.emplace_back(nodes.begin(), nodes.end());
  }
  return out;
}

std::string describe_worst_inverted(MeshForMessages const& mesh, QualityReport const& quality,
                                    Coordinates const& morphed) {
  FallenCells const* worst = nullptr;
  for (auto const* region : {&quality.near_field, &quality.far_field}) {
    FallenCells const& fallen = (*region)[Fall::inverted];
    if (fallen.cells > 0 && (worst == nullptr || fallen.worst < worst->worst)) worst = &fallen;
  }
  if (worst == nullptr) return "";
  Vec3 const now = mean(mesh.corners(mesh.mesh, *worst, morphed));
  Vec3 const before = mean(mesh.corners(mesh.mesh, *worst, mesh.baseline));
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t patch = 0;
  for (std::size_t p = 0; p < mesh.patch_nodes.size(); ++p)
    for (Index const n : mesh.patch_nodes[p])
      if (double const d = distance(before, mesh.baseline[n]); d < nearest) {
        nearest = d;
        patch = p;
      }
  MeasureStatistics at;
  at.worst_zone = worst->worst_zone;
  at.worst_cell = worst->worst_cell;
  std::string text = fmt::format("the worst is {}, now at {}", worst_place(quality, at), point_text(now));
  if (std::isfinite(nearest))
    text += fmt::format(", in the baseline at {}, {:.3g} from patch '{}'", point_text(before), nearest,
                        mesh.patch_names[patch]);
  return text +
         fmt::format("; its smallest corner Jacobian is {} times the largest it had", format_value(worst->worst));
}

std::vector<std::string> likely_causes(CaseFile const& case_file, MeshForMessages const& mesh,
                                       Coordinates const& morphed) {
  std::vector<std::string> causes;
  for (auto const& rule : case_file.motion.rules) {
    auto const* rigid = std::get_if<RigidRule>(&rule.rule);
    if (rigid == nullptr && !std::holds_alternative<FunctionRule>(rule.rule)) continue;
    Moved const moved = moved_by(mesh, rule, morphed);
    if (!(moved.size > 0) || !(moved.largest > 0)) continue;
    auto const from_axis =
        rigid != nullptr ? distance_from_axis(*rigid, 0.5 * (moved.box.low + moved.box.high)) : std::nullopt;
    if (from_axis && *from_axis > moved.size)
      causes.push_back(fmt::format(
          "{}: the patches turn about a line {:.3g} from their middle, {:.3g} times their size; look at axis and "
          "origin of the rotation (without axis it is about the axis of [mesh])",
          rule.where, *from_axis, *from_axis / moved.size));
    else
      add_unit_causes(case_file, rule, moved, causes);
  }
  return causes;
}

std::optional<std::string> axis_mismatch(Mesh const& mesh, Axis const& axis) {
  Vec3 const wanted = (1 / norm(axis.direction)) * axis.direction;
  std::optional<Vec3> other;
  for (auto const& interface : mesh.interfaces) {
    auto const turn = interface.periodic ? turn_of(interface.periodic->declared.rotation) : std::nullopt;
    if (!turn) continue;
    if (norm(cross(turn->direction, wanted)) < 1e-3) return {};
    if (!other) other = turn->direction;
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
