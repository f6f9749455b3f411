#include <gridmorph/boundary/regions.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

/// Boxes are divided while cells inside fill less than this of them, and a division leaves out at least a share of what
/// they hold: every box has planes that cut the mesh.
constexpr double full_enough = 0.7, worth_a_plane = 0.15;

/// A box of cells, begin <= c < end; empty where it holds none.
struct Extent {
  Index3 begin{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  Index3 end{0, 0, 0};

  void include(Extent const& other) {
    for (int a = 0; a < 3; ++a) {
      begin[a] = std::min(begin[a], other.begin[a]);
      end[a] = std::max(end[a], other.end[a]);
    }
  }
  [[nodiscard]] Index volume() const {
    Index out = 1;
    for (int a = 0; a < 3; ++a) out *= std::max(0, end[a] - begin[a]);
    return out;
  }
};

class BoxesOfCells {
 public:
  BoxesOfCells(Index3 const& cells, std::vector<char> const& inside) : cells_(cells), inside_(inside) {}

  std::vector<IndexRange> run() {
    divide({{0, 0, 0}, cells_});
    return std::move(out_);
  }

 private:
  /// The box that holds the cells inside, or those of its parts.
  void divide(Extent const& box) {
    std::array<std::vector<Extent>, 3> layer;  // along each axis, what each layer holds
    for (int a = 0; a < 3; ++a) layer[a].resize(box.end[a] - box.begin[a]);
    Index held = 0;
    Extent whole;
    Index3 c{};
    for (c[2] = box.begin[2]; c[2] < box.end[2]; ++c[2])
      for (c[1] = box.begin[1]; c[1] < box.end[1]; ++c[1])
        for (c[0] = box.begin[0]; c[0] < box.end[0]; ++c[0]) {
          if (inside_[c[0] + cells_[0] * (c[1] + Index(cells_[1]) * c[2])] == 0) continue;
          Extent const one{c, {c[0] + 1, c[1] + 1, c[2] + 1}};
          for (int a = 0; a < 3; ++a) layer[a][c[a] - box.begin[a]].include(one);
          whole.include(one);
          ++held;
        }
    if (held == 0) return;
    int axis = -1;
    Extent lower, upper;
    bool const full = double(held) >= full_enough * double(whole.volume());
    auto const worth = Index((1 - worth_a_plane) * double(whole.volume()));
    Index least = std::numeric_limits<Index>::max();
    for (int a = 0; a < 3; ++a) {
      auto const& of = layer[a];
      std::vector<Extent> above(of.size() + 1);
      for (std::size_t n = of.size(); n-- > 0;) {
        above[n] = above[n + 1];
        above[n].include(of[n]);
      }
      Extent below;
      for (std::size_t n = 0; n + 1 < of.size(); ++n) {
        below.include(of[n]);
        if (below.volume() == 0 || above[n + 1].volume() == 0) continue;
        Index const volume = below.volume() + above[n + 1].volume();
        bool const gap = below.end[a] < above[n + 1].begin[a];
        if (volume >= least || (!gap && (full || volume > worth))) continue;
        least = volume;
        axis = a;
        lower = below;
        upper = above[n + 1];
      }
    }
    if (axis < 0) {
      out_.push_back({whole.begin, whole.end});
      return;
    }
    divide(lower);
    divide(upper);
  }

  Index3 cells_;
  std::vector<char> const& inside_;
  std::vector<IndexRange> out_;
};

Vec3 middle(Mesh const& mesh, Zone const& zone, Index3 const& cell) {
  Vec3 sum;
  for (int c = 0; c < 8; ++c)
    sum += mesh.coordinates[zone.node({cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)})];
  return 0.125 * sum;
}

/// Calls look(number of the cell in its zone, its indices), i fastest.
template <class Look>
void each_cell(Zone const& zone, Look const& look) {
  Index c = 0;
  Index3 at{};
  for (at[2] = 0; at[2] + 1 < zone.extent[2]; ++at[2])
    for (at[1] = 0; at[1] + 1 < zone.extent[1]; ++at[1])
      for (at[0] = 0; at[0] + 1 < zone.extent[0]; ++at[0]) look(c++, at);
}

Index first_cell(Mesh const& mesh, int zone) {
  Index out = 0;
  for (int z = 0; z < zone; ++z) {
    Index3 const& n = mesh.zones[z].extent;
    out += Index(n[0] - 1) * (n[1] - 1) * (n[2] - 1);
  }
  return out;
}

/// Names of regions, each once and none of a patch.
class RegionNames {
 public:
  explicit RegionNames(Mesh const& mesh) {
    for (Patch const& patch : mesh.patches) {
      taken_.insert(patch.name);
      taken_.insert(patch.families.begin(), patch.families.end());
    }
  }
  static std::string label(InnerRegion const& region) {
    return "region '" + region.name + "'" + (region.where.empty() ? "" : " (" + region.where + ")");
  }
  bool take(InnerRegion const& region, Problems& problems) {
    if (region.name.empty())
      problems.add(label(region) + " has no name; give one, for rules to name it by");
    else if (!taken_.insert(region.name).second)
      problems.add(label(region) +
                   ": the name is that of a patch, of a family or of another region; choose another one");
    else
      return true;
    return false;
  }

 private:
  std::set<std::string> taken_;
};

std::string no_such_zone(std::string const& label, std::string const& zone, std::vector<std::string> const& zones) {
  constexpr std::size_t most = 12;
  return label + ": there is no zone '" + zone + "'; the zones are " + quote_list(zones, most);
}

class Finder {
 public:
  explicit Finder(Mesh& mesh) : mesh_(mesh), names_(mesh) {}

  void add(InnerRegion const& region) {
    std::string const label = RegionNames::label(region);
    if (!names_.take(region, problems_)) return;
    std::optional<std::vector<int>> const zones = zones_of(region, label);
    if (!zones) return;
    region.nodes ? add_nodes(region, *zones, label) : add_cells(region, *zones, label);
  }

  void finish() { problems_.throw_if_any<MotionError>(); }

 private:
  std::optional<std::vector<int>> zones_of(InnerRegion const& region, std::string const& label) {
    std::set<int> out;
    for (std::string const& name : region.zones) {
      bool found = false;
      for (int z = 0; z < int(mesh_.zones.size()); ++z)
        if (glob_match(name, mesh_.zones[z].name)) {
          out.insert(z);
          found = true;
        }
      if (found) continue;
      std::vector<std::string> names;
      for (Zone const& zone : mesh_.zones) names.push_back(zone.name);
      problems_.add(no_such_zone(label, name, names));
      return std::nullopt;
    }
    if (region.zones.empty())
      for (int z = 0; z < int(mesh_.zones.size()); ++z) out.insert(z);
    return std::vector<int>(out.begin(), out.end());
  }

  void add_nodes(InnerRegion const& region, std::vector<int> const& zones, std::string const& label) {
    if (zones.size() != 1)
      return problems_.add(label + ": its nodes are those of one zone, and it names " + std::to_string(zones.size()) +
                           "; name the zone");
    Zone const& zone = mesh_.zones[zones.front()];
    IndexRange const all{{0, 0, 0}, zone.extent}, &range = *region.nodes;
    int flat = 0;
    bool inside = true, on_face = false;
    for (int a = 0; a < 3; ++a) {
      inside = inside && range.begin[a] >= 0 && range.end[a] <= zone.extent[a] && range.extent(a) > 0;
      if (range.extent(a) != 1) continue;
      ++flat;
      on_face = on_face || range.begin[a] == 0 || range.end[a] == zone.extent[a];
    }
    if (!inside)
      problems_.add(label + ": its nodes " + to_string(range) + " are not all in zone '" + zone.name + "' " +
                    to_string(all));
    else if (flat > 1)
      problems_.add(label + ": its nodes " + to_string(range) +
                    " are a line or a point; give a box of nodes, or a surface of the grid");
    else if (on_face)
      problems_.add(label + ": its nodes " + to_string(range) + " are on the boundary of zone '" + zone.name + "' " +
                    to_string(all) + ", where patches and interfaces are moved by rules of their own");
    else
      append(region.name, zones.front(), range);
  }

  void add_cells(InnerRegion const& region, std::vector<int> const& zones, std::string const& label) {
    if (region.cells && Index(region.cells->size()) != mesh_.n_cells())
      return problems_.add(label + ": it says of " + std::to_string(region.cells->size()) +
                           " cells whether they lie in it, and the mesh has " + std::to_string(mesh_.n_cells()));
    Index held = 0, taken = 0, looked_at = 0;
    std::size_t boxes = 0;
    std::set<int> in;
    for (int const z : zones) {
      Zone const& zone = mesh_.zones[z];
      Index3 const cells{zone.extent[0] - 1, zone.extent[1] - 1, zone.extent[2] - 1};
      std::vector<char> inside(Index(cells[0]) * cells[1] * cells[2], 1);
      looked_at += Index(inside.size());
      Index const first = first_cell(mesh_, z);
      each_cell(zone, [&](Index c, Index3 const& at) {
        bool const in = !region.cells || (*region.cells)[first + c] != 0;
        inside[c] = in && (!region.holds || region.holds(middle(mesh_, zone, at))) ? 1 : 0;
      });
      held += std::count(inside.begin(), inside.end(), 1);
      for (IndexRange const& box : boxes_of_cells(cells, inside)) {
        append(region.name, z, box);
        Index n = 1;
        for (int a = 0; a < 3; ++a) n *= box.extent(a) - 1;
        taken += n;
        ++boxes;
        in.insert(z);
      }
    }
    if (held == 0)
      return problems_.add(label + " holds none of the " + std::to_string(looked_at) + " cells that it looks at, in " +
                           std::to_string(zones.size()) + " zones; correct where it lies");
    std::vector<std::string> names;
    for (int const z : in) names.push_back(mesh_.zones[z].name);
    constexpr std::size_t most = 4;
    mesh_.notes.push_back("region '" + region.name + "': " + std::to_string(taken) + " cells in " +
                          std::to_string(boxes) + (boxes == 1 ? " box" : " boxes") + " of zones " +
                          quote_list(names, most) +
                          (taken == held ? "" : ", of which " + std::to_string(held) + " were asked for"));
  }

  void append(std::string const& name, int zone, IndexRange const& range) {
    mesh_.patches.push_back({name, "", PatchKind::region, {}, zone, range, {}, {}});
  }

  Mesh& mesh_;
  RegionNames names_;
  Problems problems_;
};

void keep_those(std::vector<std::uint8_t> const& kept, std::vector<std::uint8_t>& of) {
  for (std::size_t n = 0; n < of.size(); ++n)
    if (kept[n] == 0) of[n] = 0;
}

class ElementFinder {
 public:
  ElementFinder(Mesh const& mesh, std::vector<std::string>& notes) : mesh_(mesh), notes_(notes), names_(mesh) {}

  void add(InnerRegion const& region) {
    std::string const label = RegionNames::label(region);
    if (!names_.take(region, problems_)) return;
    if (region.nodes)
      return problems_.add(label +
                           ": its nodes are i, j and k of a block, and the mesh is one of elements; say which zones "
                           "it lies in, or where");
    if (region.cells && Index(region.cells->size()) != mesh_.n_elements())
      return problems_.add(label + ": it says of " + std::to_string(region.cells->size()) +
                           " elements whether they lie in it, and the mesh has " + std::to_string(mesh_.n_elements()));
    std::vector<std::uint8_t> named(mesh_.n_elements(), region.zones.empty() ? 1 : 0);
    std::vector<int> subsets;
    for (std::string const& name : region.zones)
      if (!name_zone(name, named, subsets)) return problems_.add(no_such_zone(label, name, names_of_zones()));
    if (region.cells) {
      keep_those(*region.cells, named);
      subsets.clear();  // faces are no cells
    }
    Patch patch{region.name, "", PatchKind::region, {}, 0, {}, {}, {}};
    Index elements = 0, faces = 0;
    auto const take = [&](std::span<Index32 const> nodes) {
      patch.nodes.insert(patch.nodes.end(), nodes.begin(), nodes.end());
    };
    for (Index e = 0; e < mesh_.n_elements(); ++e) {
      if (named[e] == 0 || !holds(region, mesh_.elements.corners(e))) continue;
      take(mesh_.elements.nodes[e]);
      patch.zone = elements++ == 0 ? mesh_.zone_of_element(e) : patch.zone;
    }
    for (int const s : subsets) {
      CsrGraph const& of = mesh_.subsets[s].faces;
      for (Index f = 0; f < of.size(); ++f) {
        if (!holds(region, of[f])) continue;
        take(of[f]);
        patch.zone = elements == 0 && faces == 0 ? mesh_.zone_of(of[f].front()) : patch.zone;
        ++faces;
      }
    }
    if (patch.nodes.empty())
      return problems_.add(label + " holds no element and no face of what it names; correct where it lies");
    std::sort(patch.nodes.begin(), patch.nodes.end());
    patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
    notes_.push_back("region '" + region.name +
                     "': " + (elements > 0 || faces == 0 ? std::to_string(elements) + " elements" : "") +
                     (elements > 0 && faces > 0 ? " and " : "") + (faces > 0 ? std::to_string(faces) + " faces" : "") +
                     ", " + std::to_string(patch.nodes.size()) + " nodes");
    found_.push_back(std::move(patch));
  }

  /// Whether each element is in the region.
  std::vector<std::uint8_t> elements(InnerRegion const& region) {
    std::vector<std::uint8_t> in(mesh_.n_elements(), region.zones.empty() ? 1 : 0);
    std::string const label = RegionNames::label(region);
    std::vector<int> subsets;
    if (region.nodes) problems_.add(label + ": its nodes are i, j and k of a block, and the mesh is one of elements");
    for (std::string const& name : region.zones)
      if (!name_zone(name, in, subsets)) problems_.add(no_such_zone(label, name, names_of_zones()));
    problems_.throw_if_any<MotionError>();
    if (region.cells) keep_those(*region.cells, in);
    for (Index e = 0; e < mesh_.n_elements(); ++e)
      if (in[e] != 0 && !holds(region, mesh_.elements.corners(e))) in[e] = 0;
    if (region.only_measured && std::count(in.begin(), in.end(), 1) == 0)
      throw MotionError(label + " holds no element of what it names; correct where it lies");
    return in;
  }

  std::vector<Patch> finish() {
    problems_.throw_if_any<MotionError>();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool holds(InnerRegion const& region, std::span<Index32 const> corners) const {
    if (!region.holds) return true;
    Vec3 sum;
    for (Index32 const n : corners) sum += mesh_.coordinates[n];
    return region.holds((1.0 / double(corners.size())) * sum);
  }
  [[nodiscard]] std::vector<std::string> names_of_zones() const {
    std::vector<std::string> names;
    for (Zone const& zone : mesh_.zones) names.push_back(zone.name);
    for (Subset const& subset : mesh_.subsets) names.push_back(subset.name);
    return names;
  }
  bool name_zone(std::string const& name, std::vector<std::uint8_t>& named, std::vector<int>& subsets) const {
    bool found = false;
    for (Zone const& zone : mesh_.zones)
      if (glob_match(name, zone.name)) {
        found = true;
        std::fill_n(named.begin() + zone.first_element, zone.n_elements, std::uint8_t(1));
      }
    for (std::size_t s = 0; s < mesh_.subsets.size(); ++s)
      if (glob_match(name, mesh_.subsets[s].name)) {
        found = true;
        subsets.push_back(int(s));
        for (Index32 const e : mesh_.subsets[s].elements) named[e] = 1;
      }
    return found;
  }

  Mesh const& mesh_;
  std::vector<std::string>& notes_;
  RegionNames names_;
  std::vector<Patch> found_;
  Problems problems_;
};

}  // namespace

std::vector<IndexRange> boxes_of_cells(Index3 const& cells, std::vector<char> const& inside) {
  std::vector<IndexRange> out = BoxesOfCells(cells, inside).run();
  for (IndexRange& box : out)
    for (int& end : box.end) ++end;
  return out;
}

void add_regions(Mesh& mesh, std::span<InnerRegion const> regions) {
  if (regions.empty()) return;
  Finder finder(mesh);
  for (InnerRegion const& region : regions) finder.add(region);
  finder.finish();
}

std::vector<std::uint8_t> cells_of_region(Mesh const& mesh, InnerRegion const& region) {
  std::vector<std::uint8_t> out;
  for (Zone const& zone : mesh.zones) {
    bool const named = region.zones.empty() || std::any_of(region.zones.begin(), region.zones.end(),
                                                           [&](auto const& z) { return glob_match(z, zone.name); });
    each_cell(zone, [&](Index, Index3 const& at) {
      out.push_back(named && (!region.holds || region.holds(middle(mesh, zone, at))) ? 1 : 0);
    });
  }
  return out;
}

std::vector<std::uint8_t> elements_of_region(Mesh const& mesh, InnerRegion const& region) {
  std::vector<std::string> notes;
  return ElementFinder(mesh, notes).elements(region);
}

std::vector<Patch> regions_of_elements(Mesh const& mesh, std::span<InnerRegion const> regions,
                                       std::vector<std::string>& notes) {
  ElementFinder finder(mesh, notes);
  for (InnerRegion const& region : regions) finder.add(region);
  return finder.finish();
}

}  // namespace gridmorph
