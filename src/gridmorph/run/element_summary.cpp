// What inspect says of unstructured meshes.
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/run/boundary_guess.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/mesh_summary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::cli {

namespace {

constexpr std::size_t most_rows = 60, most_problems = 12;

std::string range_text(double low, double high) {
  if (!(low <= high)) return "-";
  return fmt::format("{:.5g} .. {:.5g}", low == 0 ? 0.0 : low, high == 0 ? 0.0 : high);
}

std::string types_text(Mesh const& mesh, int zone) {
  auto const count = count_types(mesh, zone);
  std::string out;
  for (int t = 0; t < n_element_types; ++t) {
    if (count[t] == 0) continue;
    std::string name(to_string(ElementType(t)));
    if (count[t] != 1)
      name = name == "prism" || name == "pyramid" ? name + "s"
             : name.ends_with("hedron")           ? name.substr(0, name.size() - 2) + "a"
                                                  : name + "s";
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count[t], name);
  }
  return out;
}

Index n_blocks(Mesh const& mesh) {
  return std::count_if(mesh.zones.begin(), mesh.zones.end(), [](Zone const& zone) { return zone.is_block(); });
}

std::string block_text(Zone const& zone) {
  if (!zone.is_block()) return "";
  return fmt::format("block {} x {} x {}, ", zone.extent[0], zone.extent[1], zone.extent[2]);
}

std::string subset_text(Subset const& subset) {
  return subset.faces.size() > 0 ? fmt::format("  {}: {} faces\n", subset.name, subset.faces.size())
                                 : fmt::format("  {}: {} elements\n", subset.name, subset.elements.size());
}

Box box_of(Mesh const& mesh, std::vector<Index32> const& nodes) {
  Box box;
  for (Index32 const n : nodes) box.add(mesh.coordinates[n]);
  return box;
}

Box box_of(Mesh const& mesh, Zone const& zone) {
  Box box;
  for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) box.add(mesh.coordinates[n]);
  return box;
}

std::string list_text(std::string const& title, std::vector<std::string> const& lines) {
  if (lines.empty()) return "";
  std::string text = "\n" + title + "\n";
  for (std::size_t n = 0; n < std::min(lines.size(), most_problems); ++n) text += "  " + lines[n] + "\n";
  if (lines.size() > most_problems)
    text += fmt::format("  ... and {} more (--json lists all)\n", lines.size() - most_problems);
  return text;
}

PeriodicSummary describe_connection(Mesh const& mesh, Connection const& c) {
  double const size = mesh.size();
  std::vector<Vec3> from, to;
  for (std::size_t n = 0; n < c.nodes.size(); ++n) {
    from.push_back(mesh.coordinates[c.nodes[n]]);
    to.push_back(mesh.coordinates[c.donor_nodes[n]]);
  }
  RigidTransform const fitted = fit_periodic(*c.periodic, from, to, size);
  return describe_periodic(*c.periodic, &fitted, size);
}

std::string periodic_text(PeriodicSummary const& p) {
  if (p.angle_deg > 0)
    return fmt::format(
        "periodic by a rotation of {:.6g} degrees about ({:.4g}, {:.4g}, {:.4g}) through ({:.4g}, {:.4g}, {:.4g})",
        p.angle_deg, p.axis.direction.x, p.axis.direction.y, p.axis.direction.z, p.axis.origin.x, p.axis.origin.y,
        p.axis.origin.z);
  return fmt::format("periodic by the translation ({:.6g}, {:.6g}, {:.6g})", p.translation.x, p.translation.y,
                     p.translation.z);
}

}  // namespace

std::string inspect_elements_text(LoadedMesh const& loaded, MeshSummary const& summary, std::string const& quality,
                                  SnippetOptions const& options) {
  Mesh const& mesh = loaded.mesh();
  bool const hybrid = n_blocks(mesh) > 0;
  std::string text =
      fmt::format("{}: {}, {}-D, {} zone{}, {} nodes, {} elements ({})\n", mesh.source,
                  hybrid ? "hybrid (blocks and unstructured zones)" : "unstructured", mesh.dimension, mesh.zones.size(),
                  mesh.zones.size() == 1 ? "" : "s", mesh.n_nodes(), mesh.n_elements(), types_text(mesh, -1));
  text += "\nZones\n";
  for (std::size_t z = 0; z < std::min(mesh.zones.size(), most_rows); ++z) {
    auto const& zone = mesh.zones[z];
    Box const box = box_of(mesh, zone);
    text += fmt::format("  {}: {}{} nodes, {}; x {}, y {}, z {}\n", zone.name, block_text(zone), zone.size(),
                        types_text(mesh, int(z)), range_text(box.low.x, box.high.x), range_text(box.low.y, box.high.y),
                        range_text(box.low.z, box.high.z));
  }
  if (mesh.zones.size() > most_rows)
    text += fmt::format("  ... and {} more (--json lists all)\n", mesh.zones.size() - most_rows);
  if (!mesh.subsets.empty()) {
    text += "\nParts of zones that a [[region]] can name\n";
    for (std::size_t s = 0; s < std::min(mesh.subsets.size(), most_rows); ++s) text += subset_text(mesh.subsets[s]);
    if (mesh.subsets.size() > most_rows)
      text += fmt::format("  ... and {} more (--json lists all)\n", mesh.subsets.size() - most_rows);
  }
  text += "\nBoundaries that a case file can name\n" + boundaries_text(summary);
  text += "\nConnections\n";
  if (mesh.connections.empty()) text += "  none\n";
  for (auto const& c : mesh.connections)
    text +=
        fmt::format("  {} (zone {} to zone {}): {} pairs of nodes, at most {:.3g} apart{}\n", c.name,
                    mesh.zones[c.zone].name, mesh.zones[c.donor_zone].name, c.nodes.size(), largest_mismatch(mesh, c),
                    c.periodic ? "; " + periodic_text(describe_connection(mesh, c)) : "");
  text += list_text("Notes of the reader", loaded.notes());
  text += list_text("Remarks", loaded.remarks());
  text += list_text("Problems that stop a morph", loaded.problems());
  return text + "\n" + quality + "\nA case file to start from\n\n" + case_snippet(summary, options);
}

nlohmann::json inspect_elements_json(LoadedMesh const& loaded, MeshSummary const& summary,
                                     SnippetOptions const& options) {
  Mesh const& mesh = loaded.mesh();
  auto const vector = [](Vec3 const& v) { return nlohmann::json{v.x, v.y, v.z}; };
  auto const box_json = [&](Box const& box) {
    return box.low.x <= box.high.x ? nlohmann::json{{"min", vector(box.low)}, {"max", vector(box.high)}}
                                   : nlohmann::json();
  };
  auto const types_json = [&](int zone) {
    auto const count = count_types(mesh, zone);
    nlohmann::json out = nlohmann::json::object();
    for (int t = 0; t < n_element_types; ++t)
      if (count[t] > 0) out[std::string(to_string(ElementType(t)))] = count[t];
    return out;
  };
  nlohmann::json json{
      {"source", mesh.source},         {"unstructured", true},        {"hybrid", n_blocks(mesh) > 0},
      {"dimension", mesh.dimension},   {"nodes", mesh.n_nodes()},     {"elements", mesh.n_elements()},
      {"types", types_json(-1)},       {"families", mesh.families},   {"notes", loaded.notes()},
      {"problems", loaded.problems()}, {"remarks", loaded.remarks()}, {"case_file", case_snippet(summary, options)}};
  json["subsets"] = nlohmann::json::array();
  for (Subset const& subset : mesh.subsets)
    json["subsets"].push_back(
        {{"name", subset.name}, {"elements", subset.elements.size()}, {"faces", subset.faces.size()}});
  json["zones"] = nlohmann::json::array();
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    auto const& zone = mesh.zones[z];
    nlohmann::json entry{{"name", zone.name},
                         {"nodes", zone.size()},
                         {"elements", zone.n_elements},
                         {"types", types_json(int(z))},
                         {"box", box_json(box_of(mesh, zone))}};
    if (zone.is_block()) entry["extent"] = zone.extent;
    json["zones"].push_back(std::move(entry));
  }
  json["boundaries"] = nlohmann::json::array();
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    auto const& patch = mesh.patches[p];
    auto const nodes = patch_nodes(patch);
    auto const& selector = patch.families.empty() ? patch.name : patch.families.front();
    auto const b = std::find_if(summary.boundaries.begin(), summary.boundaries.end(),
                                [&](BoundarySummary const& s) { return s.selector == selector; });
    json["boundaries"].push_back({{"name", patch.name},
                                  {"guess", b->guess},
                                  {"first_height", {{"min", b->first_height_min}, {"mean", b->first_height_mean}}},
                                  {"families", patch.families},
                                  {"kind", to_string(patch.kind)},
                                  {"bc_type", patch.bc_type},
                                  {"zone", mesh.zones[patch.zone].name},
                                  {"faces", loaded.indexed().face_patches().faces_of_patch[p]},
                                  {"nodes", nodes.size()},
                                  {"box", box_json(box_of(mesh, nodes))}});
  }
  json["connections"] = nlohmann::json::array();
  for (auto const& c : mesh.connections) {
    nlohmann::json entry{{"name", c.name},
                         {"zone", mesh.zones[c.zone].name},
                         {"donor_zone", mesh.zones[c.donor_zone].name},
                         {"pairs", c.nodes.size()},
                         {"largest_mismatch", largest_mismatch(mesh, c)}};
    if (c.periodic)
      entry["periodic"] = {{"rotation_center", vector(c.periodic->rotation_center)},
                           {"rotation_angle_rad", vector(c.periodic->rotation_angle_rad)},
                           {"translation", vector(c.periodic->translation)}};
    json["connections"].push_back(std::move(entry));
  }
  return json;
}

namespace {

/// Mean and smallest distance of the corners opposite a boundary face from it: the height of the first cell.
void measure_heights(IndexedMesh const& loaded, std::vector<int> const& boundary_of_patch,
                     std::vector<BoundarySummary>& boundaries) {
  Mesh const& mesh = loaded.mesh();
  auto const& faces = loaded.topology().boundary;
  std::vector<double> sum(boundaries.size(), 0), smallest(boundaries.size(), Box::inf);
  std::vector<Index> count(boundaries.size(), 0);
  Vec3 const up = plane_normal(mesh);
  for (Index f = 0; f < faces.size(); ++f) {
    int const patch = loaded.face_patches().patch[f];
    if (patch < 0) continue;
    auto const b = std::size_t(boundary_of_patch[patch]);
    auto const face = faces.nodes[f];
    Vec3 const origin = mesh.coordinates[face[0]];
    Vec3 normal = mesh.dimension == 2 ? cross(mesh.coordinates[face[1]] - origin, up) : Vec3{};
    for (std::size_t k = 2; k < face.size(); ++k)
      normal += cross(mesh.coordinates[face[k - 1]] - origin, mesh.coordinates[face[k]] - origin);
    double const length = norm(normal);
    if (!(length > 0)) continue;
    double height = 0;
    int opposite = 0;
    for (Index32 const n : mesh.elements.corners(faces.element[f])) {
      if (std::find(face.begin(), face.end(), n) != face.end()) continue;
      height += std::fabs(dot(mesh.coordinates[n] - origin, normal)) / length;
      ++opposite;
    }
    if (opposite == 0) continue;
    sum[b] += height / opposite;
    smallest[b] = std::min(smallest[b], height / opposite);
    ++count[b];
  }
  for (std::size_t b = 0; b < boundaries.size(); ++b)
    if (count[b] > 0) {
      boundaries[b].first_height_mean = sum[b] / double(count[b]);
      boundaries[b].first_height_min = smallest[b];
    }
}

/// The axis that all periodic rotations share, its largest component positive.
std::optional<Axis> common_axis(Mesh const& mesh) {
  std::optional<Axis> axis;
  for (auto const& c : mesh.connections) {
    if (!c.periodic || !(norm(c.periodic->rotation_angle_rad) > 0)) continue;
    Axis const own = describe_connection(mesh, c).axis;
    if (axis && (distance(axis->direction, own.direction) > 1e-5 ||
                 norm(cross(own.origin - axis->origin, own.direction)) > 1e-6 * mesh.size()))
      return {};
    if (!axis) axis = own;
  }
  return axis;
}

/// Sides of one wall in two zones may coincide without a connection that says so: their nodes get one number.
void join_by_position(Mesh const& mesh, std::vector<BoundarySummary> const& boundaries,
                      std::vector<std::vector<Index>>& nodes) {
  // As for connections of a file.
  double const tolerance = place_tolerance(1e-6, mesh.size(), coordinate_resolution(mesh));
  auto const apart = [&](Box const& a, Box const& b) {
    return a.low.x > b.high.x + tolerance || b.low.x > a.high.x + tolerance || a.low.y > b.high.y + tolerance ||
           b.low.y > a.high.y + tolerance || a.low.z > b.high.z + tolerance || b.low.z > a.high.z + tolerance;
  };
  auto const zone_of = [&](std::size_t b) { return mesh.patches[boundaries[b].patches.front()].zone; };
  constexpr std::size_t most = 64;  // pairs of boundaries are looked at
  for (std::size_t a = 0; a < std::min(most, nodes.size()); ++a)
    for (std::size_t b = a + 1; b < std::min(most, nodes.size()); ++b) {
      if (zone_of(a) == zone_of(b) || apart(boundaries[a].box, boundaries[b].box)) continue;
      std::vector<Index32> const own(nodes[b].begin(), nodes[b].end()), others(nodes[a].begin(), nodes[a].end());
      auto const partner = match_points(mesh.coordinates, own, others, tolerance);
      for (std::size_t n = 0; n < partner.size(); ++n)
        if (partner[n] >= 0) nodes[b][n] = partner[n];
    }
}

}  // namespace

MeshSummary summarize_elements(LoadedMesh const& loaded) {
  Mesh const& mesh = loaded.mesh();
  MeshSummary out;
  out.unstructured = true;
  out.source = mesh.source;
  out.two_dimensional = mesh.dimension == 2;
  out.axis = common_axis(mesh);
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.box.add(mesh.coordinates[n]);
  auto const periodic = periodic_nodes(mesh);
  auto const representative = coincident_nodes(mesh);
  std::vector<BoundaryShape> shapes;
  std::vector<std::vector<Index>> nodes_of_boundary;
  std::vector<int> boundary_of_patch;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    auto const& patch = mesh.patches[p];
    using Source = BoundarySummary::Source;
    std::string const& selector = patch.families.empty() ? patch.name : patch.families.front();
    Source const source = !patch.families.empty()               ? Source::family
                          : patch.kind == PatchKind::connection ? Source::connection
                                                                : Source::boundary_condition;
    auto found = std::find_if(out.boundaries.begin(), out.boundaries.end(),
                              [&](BoundarySummary const& b) { return b.selector == selector; });
    if (found == out.boundaries.end()) {
      found = out.boundaries.insert(out.boundaries.end(), BoundarySummary{});
      found->selector = selector;
      found->source = source;
      found->paired = true;
      shapes.emplace_back();
      nodes_of_boundary.emplace_back();
    }
    auto const b = std::size_t(found - out.boundaries.begin());
    boundary_of_patch.push_back(int(b));
    auto const once = [](auto& list, auto const& value) {
      if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
    };
    once(found->kinds, patch.kind);
    once(found->names, patch.name);
    if (!patch.bc_type.empty()) once(found->bc_types, patch.bc_type);
    found->patches.push_back(p);
    found->faces += loaded.indexed().face_patches().faces_of_patch[p];
    auto const nodes = patch_nodes(patch);
    found->nodes += Index(nodes.size());
    auto& points = shapes[b].patches.emplace_back();
    for (Index32 const n : nodes) {
      points.push_back(mesh.coordinates[n]);
      found->box.add(points.back());
      nodes_of_boundary[b].push_back(representative[n]);
      found->paired = found->paired && periodic[n] != 0;
    }
  }
  join_by_position(mesh, out.boundaries, nodes_of_boundary);
  measure_heights(loaded.indexed(), boundary_of_patch, out.boundaries);
  guess_roles(mesh.coordinates, shapes, out);
  find_touching(out.boundaries, nodes_of_boundary, mesh.n_nodes());
  return out;
}

}  // namespace gridmorph::cli
