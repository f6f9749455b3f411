#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/io/cgns/cgns_layout.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

namespace gridmorph::cgns {

namespace {

constexpr std::array<char const*, 3> coordinate_names{"CoordinateX", "CoordinateY", "CoordinateZ"};

std::string list_names(std::vector<Node> const& nodes, std::string_view label) {
  std::string out;
  for (auto const& n : nodes)
    if (n.label == label) out += (out.empty() ? "'" : ", '") + n.name + "'";
  return out.empty() ? "none" : out;
}

/// Reads Zone_t: vertex sizes, and whether it is structured at all.
bool read_extent(File const& file, ZoneLayout& zone, std::string const& where, Problems& problems) {
  std::string const type = zone_type(file, *zone.node);
  if (type != "Structured") {
    problems.add(
        where + ": is of type " + (type.empty() ? "(none)" : type) +
        "; a structured mesh is needed here (gridmorph morph, plan, quality and inspect take unstructured ones)");
    return false;
  }
  auto const dimensions = file.dimensions(*zone.node);
  auto const sizes = file.integers(*zone.node);
  int const n = dimensions.empty() ? 0 : int(std::min<Index>(dimensions[0], 4));
  if (n == 1) {
    problems.add(
        where +
        ": has one index dimension; only surfaces (2) and volumes (3) of structured nodes can be morphed; name "
        "the zone in leave_out if the others are the mesh");
    return false;
  }
  if ((n != 2 && n != 3) || Index(sizes.size()) < n) {
    problems.add(where + ": its size is not that of a structured zone (" + std::to_string(sizes.size()) +
                 " numbers found, 6 or 9 expected)");
    return false;
  }
  zone.index_dimension = n;
  for (int a = 0; a < n; ++a) {
    if (sizes[a] < 1 || sizes[a] >= std::numeric_limits<int>::max()) {
      problems.add(where + ": has " + std::to_string(sizes[a]) + " nodes along " + "ijk"[a] +
                   "; at least 2 are needed");
      return false;
    }
    zone.extent[a] = int(sizes[a]);
  }
  int flat = 0;
  for (int a = 0; a < 3; ++a)
    if (zone.extent[a] == 1) {
      zone.flat_axis = a;
      ++flat;
    }
  if (flat > 1) {
    problems.add(where + ": has one node along two or three directions; only surfaces and volumes can be morphed");
    return false;
  }
  return true;
}

bool read_rind(File const& file, ZoneLayout& zone, std::string const& where, Problems& problems) {
  auto const* rind = zone.grid->labelled("Rind_t");
  if (!rind) return true;
  auto const planes = file.integers(*rind);
  bool good = Index(planes.size()) == 2 * zone.index_dimension;
  for (auto const p : planes) good = good && p >= 0 && p < 1000;
  if (!good) {
    problems.add(where + ": Rind of '" + zone.grid->name + "' is not one pair of plane counts per direction");
    return false;
  }
  for (int a = 0; a < zone.index_dimension; ++a) {
    zone.rind_low[a] = int(planes[2 * a]);
    zone.rind_high[a] = int(planes[2 * a + 1]);
  }
  return true;
}

void find_coordinates(File const& file, ZoneLayout& zone, std::string const& where, Problems& problems,
                      std::vector<std::string>& notes) {
  auto const grids = zone.node->all("GridCoordinates_t");
  if (grids.empty()) return problems.add(where + ": has no GridCoordinates_t node, so no coordinates");
  auto const original =
      std::find_if(grids.begin(), grids.end(), [](Node const* g) { return g->name == "GridCoordinates"; });
  zone.grid = original == grids.end() ? grids.front() : *original;
  for (auto const* g : grids)
    if (g != zone.grid)
      notes.push_back(where + ": grid '" + g->name + "' left alone; '" + zone.grid->name + "' is used");
  if (!read_rind(file, zone, where, problems)) return;

  for (int c = 0; c < 3; ++c) {
    zone.array[c] = zone.grid->child(coordinate_names[c]);
    if (!zone.array[c]) {
      if (zone.flat_axis >= 0) continue;
      bool const cylindrical = zone.grid->child("CoordinateR") || zone.grid->child("CoordinateTheta");
      return problems.add(where + ": " + coordinate_names[c] + " is missing (found " +
                          list_names(zone.grid->children, "DataArray_t") + "); " +
                          (cylindrical ? "cylindrical coordinates are not supported, convert the file to Cartesian ones"
                                       : "three Cartesian coordinates are needed"));
    }
    std::string const type = file.type(*zone.array[c]);
    if (type != "R4" && type != "R8")
      return problems.add(where + ": " + coordinate_names[c] + " has type " + type + "; R4 or R8 is needed");
    zone.single_precision[c] = type == "R4";
    auto const sizes = file.dimensions(*zone.array[c]);
    bool fits = Index(sizes.size()) >= zone.index_dimension;
    std::string found, expected;
    for (std::size_t a = 0; a < sizes.size(); ++a) {
      Index const wanted = a < 3 ? zone.extent[a] + zone.rind_low[a] + zone.rind_high[a] : 1;
      fits = fits && sizes[a] == wanted;
      found += (a ? " x " : "") + std::to_string(sizes[a]);
    }
    for (int a = 0; a < zone.index_dimension; ++a)
      expected += (a ? " x " : "") + std::to_string(zone.extent[a] + zone.rind_low[a] + zone.rind_high[a]);
    if (!fits)
      return problems.add(where + ": " + coordinate_names[c] + " has " + found +
                          " values, but zone size and rind planes ask for " + expected);
  }
  for (auto const* a : zone.array)
    if (a) static_cast<void>(file.count(*a));  // throws before memory is asked for on the word of a damaged file
  int present = 0;
  for (auto const* a : zone.array) present += a != nullptr;
  if (present < 2)
    problems.add(where + ": has fewer than two of CoordinateX, CoordinateY, CoordinateZ (found " +
                 list_names(zone.grid->children, "DataArray_t") + ")");
}

/// Reads n floats as doubles without memory of its own: they come into the upper half of `dest` and are widened from
/// there, lowest first, block by block. Double m ends where float 2 m + 1 was, and that one has been read by then (m <
/// n).
void read_widened(File const& file, Node const& array, Index n, double* dest) {
  auto* const bytes = reinterpret_cast<char*>(dest);
  char const* const stored = bytes + std::size_t(n) * sizeof(float);
  file.read(array, "R4", bytes + std::size_t(n) * sizeof(float));
  constexpr Index block = 1024;
  std::array<float, block> buffer;
  for (Index at = 0; at < n; at += block) {
    Index const m = std::min(block, n - at);
    std::memcpy(buffer.data(), stored + std::size_t(at) * sizeof(float), std::size_t(m) * sizeof(float));
    std::copy(buffer.begin(), buffer.begin() + m, dest + at);
  }
}

}  // namespace

std::string zone_type(File const& file, Node const& zone) {
  auto const* type = zone.labelled("ZoneType_t");
  return type ? file.text(*type) : "Structured";
}

Index ZoneLayout::stored_size() const {
  Index n = 1;
  for (int a = 0; a < 3; ++a) n *= extent[a] + rind_low[a] + rind_high[a];
  return n;
}

Index ZoneLayout::stored_line(int j, int k) const {
  Index const ni = extent[0] + rind_low[0] + rind_high[0];
  Index const nj = extent[1] + rind_low[1] + rind_high[1];
  return rind_low[0] + ni * (j + rind_low[1] + nj * Index(k + rind_low[2]));
}

namespace {

/// The zones of all bases, named, those that are left out too.
std::vector<ZoneLayout> named_zones(Node const& tree) {
  auto const bases = tree.all("CGNSBase_t");
  auto const with_zones =
      std::count_if(bases.begin(), bases.end(), [](Node const* b) { return b->labelled("Zone_t") != nullptr; });
  std::vector<ZoneLayout> out;
  for (auto const* base : bases)
    for (auto const* node : base->all("Zone_t")) {
      ZoneLayout zone;
      zone.base = base;
      zone.node = node;
      zone.name = with_zones > 1 ? base->name + "/" + node->name : node->name;
      out.push_back(std::move(zone));
    }
  return out;
}

/// Donors that connections of the zone name.
std::vector<std::string> donors_of(File const& file, Node const& zone) {
  std::vector<std::string> out;
  for (auto const* connectivity : zone.all("ZoneGridConnectivity_t"))
    for (auto const& node : connectivity->children)
      if (node.label == "GridConnectivity1to1_t" || node.label == "GridConnectivity_t") out.push_back(file.text(node));
  return out;
}

/// The zones that are wanted. Adds to problems: names of `leave_out` that the file does not know, and nothing left.
std::vector<ZoneLayout> wanted_zones(File const& file, Node const& tree, Problems& problems,
                                     std::vector<std::string> const& leave_out) {
  auto zones = named_zones(tree);
  if (zones.empty()) problems.add(file.path() + ": holds no Zone_t node; there is no mesh in it");
  for (auto const& name : leave_out) {
    bool known = std::any_of(zones.begin(), zones.end(),
                             [&](ZoneLayout const& z) { return is_left_out({name}, z.base->name, z.node->name); });
    // A zone that connections lead to and the file does not have can be left out as well.
    for (std::size_t z = 0; z < zones.size() && !known; ++z) {
      auto const donors = donors_of(file, *zones[z].node);
      known = std::find(donors.begin(), donors.end(), name) != donors.end();
    }
    if (known) continue;
    std::string there;
    for (auto const& z : zones)
      if (there.size() < 200) there += (there.empty() ? "'" : ", '") + z.base->name + "/" + z.node->name + "'";
    problems.add(file.path() + ": leave_out names '" + name +
                 "', which is no base or zone of the file (base/zone: " + there + ")");
  }
  bool const any = !zones.empty();
  std::erase_if(zones, [&](ZoneLayout const& z) { return is_left_out(leave_out, z.base->name, z.node->name); });
  if (any && zones.empty()) problems.add(file.path() + ": leave_out names every zone; leave one in");
  return zones;
}

}  // namespace

bool is_left_out(std::vector<std::string> const& leave_out, std::string const& base, std::string const& zone) {
  return std::any_of(leave_out.begin(), leave_out.end(), [&](std::string const& name) {
    return glob_match(name, base) || glob_match(name, zone) || glob_match(name, base + "/" + zone);
  });
}

std::vector<std::string> all_but(Node const& tree, std::vector<std::string> const& zones) {
  auto const there = named_zones(tree);
  auto const has = [](auto const& list, auto const& test) { return std::any_of(list.begin(), list.end(), test); };
  for (auto const& wanted : zones)
    if (!has(there, [&](ZoneLayout const& z) { return z.name == wanted; })) return {};
  std::vector<std::string> out;
  for (auto const& z : there)
    if (!has(zones, [&](std::string const& name) { return name == z.name; }))
      out.push_back(z.base->name + "/" + z.node->name);
  return out;
}

Layout find_unstructured_zones(File const& file, Node const& tree, Problems& problems,
                               std::vector<std::string> const& leave_out) {
  Layout layout;
  layout.leave_out = leave_out;
  for (auto& zone : wanted_zones(file, tree, problems, leave_out)) {
    auto const* node = zone.node;
    std::string const where = file.path() + ": zone '" + zone.name + "'";
    if (zone_type(file, *node) != "Unstructured") {
      if (!read_extent(file, zone, where, problems)) continue;
      find_coordinates(file, zone, where, problems, layout.notes);
      layout.zones.push_back(std::move(zone));
      continue;
    }
    zone.index_dimension = 1;
    auto const sizes = file.integers(*node);
    if (sizes.size() < 2 || sizes[0] < 1 || sizes[0] >= std::numeric_limits<int>::max()) {
      problems.add(where + ": its size is not that of an unstructured zone" +
                   (sizes.empty() ? std::string() : " (" + std::to_string(sizes[0]) + " nodes)"));
      continue;
    }
    zone.extent = {int(sizes[0]), 1, 1};
    auto const* grid = node->labelled("GridCoordinates_t");
    if (grid && !grid->child(coordinate_names[2]) && grid->child(coordinate_names[0]) &&
        grid->child(coordinate_names[1]))
      zone.flat_axis = 2;
    find_coordinates(file, zone, where, problems, layout.notes);
    layout.zones.push_back(std::move(zone));
  }
  return layout;
}

Layout find_zones(File const& file, Node const& tree, Problems& problems, std::vector<std::string> const& leave_out) {
  Layout layout;
  if (tree.labelled("CGNSBase_t") == nullptr) {
    problems.add(file.path() + ": holds no CGNSBase_t node; it is not a CGNS mesh");
    return layout;
  }
  int flat = 0;
  layout.leave_out = leave_out;
  for (auto& zone : wanted_zones(file, tree, problems, leave_out)) {
    std::string const where = file.path() + ": zone '" + zone.name + "'";
    if (!read_extent(file, zone, where, problems)) continue;
    find_coordinates(file, zone, where, problems, layout.notes);
    flat += zone.flat_axis >= 0;
    layout.zones.push_back(std::move(zone));
  }
  if (flat > 0 && flat < int(layout.zones.size())) {
    std::string names;
    for (auto const& z : layout.zones)
      if (z.flat_axis >= 0) names += " '" + z.name + "'";
    problems.add(file.path() + ": mixes 2-D zones (one node plane:" + names +
                 ") with 3-D zones; they cannot be one mesh");
  }
  return layout;
}

void read_component(File const& file, ZoneLayout const& zone, int component, double* dest) {
  Node const* array = zone.array[component];
  if (!array) {
    std::fill(dest, dest + zone.nodes_in_file(), 0.0);
    return;
  }
  bool const rind = zone.stored_size() != zone.nodes_in_file();
  if (!rind) {
    if (!zone.single_precision[component]) return file.read(*array, "R8", dest);
    return read_widened(file, *array, zone.nodes_in_file(), dest);
  }
  auto const copy_nodes = [&](auto const* stored) {
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j) {
        auto const* line = stored + zone.stored_line(j, k);
        dest = std::copy(line, line + zone.extent[0], dest);
      }
  };
  auto const n = static_cast<std::size_t>(zone.stored_size());
  if (zone.single_precision[component]) {
    auto const stored = std::make_unique_for_overwrite<float[]>(n);
    file.read(*array, "R4", stored.get());
    copy_nodes(stored.get());
  } else {
    auto const stored = std::make_unique_for_overwrite<double[]>(n);
    file.read(*array, "R8", stored.get());
    copy_nodes(stored.get());
  }
}

void write_component(File& file, ZoneLayout const& zone, int component, double const* source) {
  Node const* array = zone.array[component];
  if (!array) return;
  bool const rind = zone.stored_size() != zone.nodes_in_file();
  if (!zone.single_precision[component] && !rind) {
    file.write(*array, source);
    return;
  }
  auto const replace = [&](auto* stored, char const* type) {
    using Stored = std::remove_pointer_t<decltype(stored)>;
    if (rind) file.read(*array, type, stored);
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j) {
        std::transform(source, source + zone.extent[0], stored + zone.stored_line(j, k),
                       [](double v) { return Stored(v); });
        source += zone.extent[0];
      }
    file.write(*array, stored);
  };
  auto const n = static_cast<std::size_t>(zone.stored_size());
  if (zone.single_precision[component])
    replace(std::make_unique_for_overwrite<float[]>(n).get(), "R4");
  else
    replace(std::make_unique_for_overwrite<double[]>(n).get(), "R8");
}

}  // namespace gridmorph::cgns
