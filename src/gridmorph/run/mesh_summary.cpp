#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/contradicted_periodics.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/run/boundary_guess.hpp>
#include <gridmorph/run/mesh_summary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

namespace gridmorph::cli {

namespace {

constexpr double gross = 1e-3;  // of the mesh size: larger gaps of an interface are no inaccuracy

template <class T>
void add_once(std::vector<T>& list, T const& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

using Source = BoundarySummary::Source;

BoundarySummary& entry(std::vector<BoundarySummary>& list, std::string const& selector, Source source) {
  auto const found = std::find_if(
      list.begin(), list.end(), [&](BoundarySummary const& b) { return b.selector == selector && b.source == source; });
  if (found != list.end()) return *found;
  list.push_back({});
  list.back().selector = selector;
  list.back().source = source;
  return list.back();
}

std::vector<BoundarySummary> group_patches(Mesh const& mesh) {
  std::vector<BoundarySummary> out;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    Patch const& patch = mesh.patches[p];
    auto const add = [&](std::string const& selector, Source source) {
      auto& b = entry(out, selector, source);
      b.patches.push_back(p);
      add_once(b.kinds, patch.kind);
      add_once(b.names, patch.name);
      if (!patch.bc_type.empty()) add_once(b.bc_types, patch.bc_type);
      b.nodes += patch.range.size();
    };
    for (auto const& family : patch.families) add(family, Source::family);
    if (patch.families.empty())
      add(patch.name, patch.kind == PatchKind::connection ? Source::connection : Source::boundary_condition);
  }
  return out;
}

/// Extents and the distance to the next node off the face.
void measure(Mesh const& mesh, BoundarySummary& b) {
  double sum = 0, smallest = Box::inf;
  Index count = 0;
  for (int const p : b.patches) {
    Patch const& patch = mesh.patches[p];
    Zone const& zone = mesh.zones[patch.zone];
    int axis = -1;
    for (int a = 0; a < 3; ++a)
      if (patch.range.extent(a) == 1) axis = a;
    bool inside = true;  // what is not is among the problems
    for (int a = 0; a < 3; ++a)
      inside = inside && patch.range.begin[a] >= 0 && patch.range.begin[a] < patch.range.end[a] &&
               patch.range.end[a] <= zone.extent[a];
    if (!inside) continue;
    Index step = 0;
    if (axis >= 0) {
      int const across = zone.extent[axis] - 1;
      b.cells_across = b.cells_across == 0 ? across : std::min(b.cells_across, across);
    }
    if (axis >= 0 && zone.extent[axis] > 1) step = (patch.range.begin[axis] == 0 ? 1 : -1) * zone.strides()[axis];
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const node = zone.node({i, j, k});
          Vec3 const x = mesh.coordinates[node];
          b.box.add(x);
          if (step == 0) continue;
          double const height = distance(x, mesh.coordinates[node + step]);
          sum += height;
          smallest = std::min(smallest, height);
          ++count;
        }
  }
  if (count == 0) return;
  b.first_height_min = smallest;
  b.first_height_mean = sum / double(count);
}

bool same_transform(PeriodicSummary const& a, PeriodicSummary const& b, double size) {
  // File angles are in single precision; the two directions of a translation are one and the same pair.
  return std::fabs(a.angle_deg - b.angle_deg) < 1e-4 && distance(a.axis.direction, b.axis.direction) < 1e-5 &&
         distance(a.axis.origin, b.axis.origin) < 1e-6 * size &&
         std::min(distance(a.translation, b.translation), norm(a.translation + b.translation)) < 1e-6 * size;
}

void collect_interfaces(Mesh const& mesh, double size, MeshSummary& out) {
  out.interfaces = int(mesh.interfaces.size());
  TopologyOptions any;
  any.matching_tolerance = size;
  Problems ignored;
  Links const links = connect(mesh, any, ignored);
  auto const describe = [&](int number) {
    auto const& interface = mesh.interfaces[number];
    for (auto const& link : links.all)
      if (link.interface == number && link.zone == interface.zone && link.range == interface.range)
        return describe_periodic(*interface.periodic, link.mismatch < gross * size ? &link.transform : nullptr, size);
    return describe_periodic(*interface.periodic, nullptr, size);
  };
  for (int n = 0; n < out.interfaces; ++n) {
    auto const& interface = mesh.interfaces[n];
    if (!interface.periodic) {
      if (interface.zone == interface.donor_zone) ++out.self_interfaces;
      continue;
    }
    auto described = describe(n);
    auto found = std::find_if(out.periodics.begin(), out.periodics.end(),
                              [&](PeriodicSummary const& p) { return same_transform(p, described, size); });
    if (found == out.periodics.end()) found = out.periodics.insert(out.periodics.end(), std::move(described));
    ++found->interfaces;
    add_once(found->names, interface.families.empty() ? interface.name : interface.families.front());
    std::string const a = mesh.zones[interface.zone].name, b = mesh.zones[interface.donor_zone].name;
    add_once(found->zones, std::min(a, b) + " - " + std::max(a, b));
  }
  for (auto const& p : out.periodics) {
    if (p.angle_deg == 0) continue;
    if (!out.axis)
      out.axis = p.axis;
    else if (norm(cross(out.axis->direction, p.axis.direction)) > 1e-5 ||
             norm(cross(p.axis.origin - out.axis->origin, p.axis.direction)) > 1e-6 * size) {
      out.axis.reset();
      return;
    }
  }
}

/// The settings with which a mesh with problems could be morphed, if they are of that kind.
void look_for_remedies(Mesh const& mesh, MeshSummary& summary) {
  TopologyOptions options;
  options.matching_tolerance = mesh.size();
  Problems ignored;
  double worst = 0;
  for (auto const& link : connect(mesh, options, ignored).all) worst = std::max(worst, link.mismatch);
  if (worst > coincidence_tolerance(mesh.size(), coordinate_resolution(mesh)) && worst < gross * mesh.size())
    summary.needed_tolerance = 1.1 * worst;
  options.matching_tolerance = summary.needed_tolerance;
  for (bool const open : {false, true}) {
    options.open_faces = open ? "open" : "";
    Mesh completed = mesh;
    try {
      (void)connect_and_check(completed, options);
      summary.open_faces = open;
      summary.remedied = true;
      return;
    } catch (MeshError const&) {  // said already
    }
  }
}

std::vector<std::vector<Index>> nodes_of(Mesh const& mesh, std::vector<BoundarySummary> const& boundaries,
                                         std::vector<Index> const& number) {
  std::vector<std::vector<Index>> out;
  for (auto const& b : boundaries) {
    auto& nodes = out.emplace_back();
    for (int const p : b.patches) {
      Patch const& patch = mesh.patches[p];
      Zone const& zone = mesh.zones[patch.zone];
      bool inside = true;
      for (int a = 0; a < 3; ++a) inside = inside && patch.range.begin[a] >= 0 && patch.range.end[a] <= zone.extent[a];
      if (inside) for_each_node(zone, patch.range, [&](Index n) { nodes.push_back(number[n]); });
    }
  }
  return out;
}

/// What the topology says to this mesh: its problems, or its blocks.
void look_at_topology(Mesh const& mesh, MeshSummary& summary) {
  std::vector<std::string>& out = summary.problems;
  auto const add_lines = [&](std::string const& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) out.push_back(line);
  };
  Mesh completed = mesh;  // shares the coordinates
  try {
    Links const links = connect_and_check(completed, {});
    // Patches that one selector names stay together; patches that completion added have labels of their own.
    std::vector<int> label(completed.patches.size(), -1);
    for (std::size_t b = 0; b < summary.boundaries.size(); ++b)
      for (int const p : summary.boundaries[b].patches) label[p] = int(b);
    for (std::size_t p = mesh.patches.size(); p < completed.patches.size(); ++p)
      label[p] = int(summary.boundaries.size());
    summary.blocks = summarize_blocks(completed, links, label);
  } catch (MeshError const& e) {
    add_lines(e.what());
    if (summary.box.low.x <= summary.box.high.x) look_for_remedies(mesh, summary);
  }
}

}  // namespace

void Box::add(Vec3 const& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

void Box::add(Box const& other) {
  add(other.low);
  add(other.high);
}

PeriodicSummary describe_periodic(Periodic const& declared, RigidTransform const* fitted, double size) {
  PeriodicSummary out;
  auto const turn = as_turn(fitted ? *fitted : declared.declared, fitted ? gross * size : Box::inf);
  if (!turn) {
    Vec3 const t = fitted ? fitted->translation : declared.translation;
    out.translation = {t.x + 0.0, t.y + 0.0, t.z + 0.0};
    return out;
  }
  out.angle_deg = turn->angle_rad * 180 / std::numbers::pi;
  double const sectors = 2 * std::numbers::pi / turn->angle_rad;
  if (std::fabs(sectors - std::round(sectors)) < 1e-3 * sectors) out.sectors = int(std::lround(sectors));
  auto const without_round_off = [](Vec3 const& v, double scale) {
    auto const tidy = [&](double c) { return std::fabs(c) < 1e-9 * scale ? 0.0 : c; };
    return Vec3{tidy(v.x), tidy(v.y), tidy(v.z)};
  };
  Vec3 const direction = without_round_off(turn->direction, 1);
  double const parts[3] = {direction.x, direction.y, direction.z};
  double const dominant =
      *std::max_element(parts, parts + 3, [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  Vec3 const unit = ((dominant > 0 ? 1.0 : -1.0) / norm(direction)) * direction;
  // The point of the axis next to the centre that the file names, which is the better number where it is on the axis.
  Vec3 const along = dot(declared.rotation_center - turn->origin, turn->direction) * turn->direction;
  Vec3 const near = turn->origin + along;
  bool const named = distance(near, declared.rotation_center) < 1e-12 * size;
  Vec3 const origin = named ? declared.rotation_center : without_round_off(near, size);
  out.axis = {{origin.x + 0.0, origin.y + 0.0, origin.z + 0.0}, {unit.x + 0.0, unit.y + 0.0, unit.z + 0.0}};
  return out;
}

void find_touching(std::vector<BoundarySummary>& boundaries, std::vector<std::vector<Index>> const& nodes,
                   Index n_nodes) {
  std::vector<std::pair<Index, int>> places;
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for (Index const n : nodes[b])
      if (n >= 0 && n < n_nodes) places.emplace_back(n, int(b));
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<std::set<int>> touches(boundaries.size());
  for (auto begin = places.begin(); begin != places.end();) {
    auto const end = std::find_if(begin, places.end(), [&](auto const& p) { return p.first != begin->first; });
    for (auto a = begin; a != end; ++a)
      for (auto b = begin; b != end; ++b)
        if (a != b) touches[a->second].insert(b->second);
    begin = end;
  }
  for (std::size_t b = 0; b < boundaries.size(); ++b)
    boundaries[b].touches.assign(touches[b].begin(), touches[b].end());
}

MeshSummary summarize(Mesh const& mesh) {
  MeshSummary out;
  out.source = mesh.source;
  out.file_variant = mesh.file_variant;
  out.families = mesh.families;
  out.nodes = mesh.n_nodes();
  out.cells = mesh.n_cells();
  out.two_dimensional = mesh.dimension == 2;
  out.notes = mesh.notes;
  for (auto& line : contradicted_periodics(mesh, mesh.size())) out.notes.push_back(std::move(line));
  for (auto const& zone : mesh.zones) {
    ZoneSummary z{zone.name, zone.extent, zone.size(), {}};
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) z.box.add(mesh.coordinates[n]);
    out.box.add(z.box);
    out.zones.push_back(std::move(z));
  }
  double const size = distance(out.box.low, out.box.high);
  collect_interfaces(mesh, size, out);
  out.boundaries = group_patches(mesh);
  for (auto& b : out.boundaries) measure(mesh, b);
  guess_roles(mesh.coordinates, shapes_of(mesh, out), out);
  find_touching(out.boundaries, nodes_of(mesh, out.boundaries, coincident_block_nodes(mesh)), mesh.n_nodes());
  for (auto const& family : mesh.families) {
    bool const used = std::any_of(mesh.patches.begin(), mesh.patches.end(),
                                  [&](Patch const& p) {
                                    return std::find(p.families.begin(), p.families.end(), family) != p.families.end();
                                  }) ||
                      std::any_of(mesh.interfaces.begin(), mesh.interfaces.end(), [&](Interface1to1 const& i) {
                        return std::find(i.families.begin(), i.families.end(), family) != i.families.end();
                      });
    if (!used) out.unused_families.push_back(family);
  }
  look_at_topology(mesh, out);
  return out;
}

}  // namespace gridmorph::cli
