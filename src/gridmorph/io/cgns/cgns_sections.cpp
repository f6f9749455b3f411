#include <gridmorph/io/cgns/cgns_sections.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace gridmorph::cgns {

namespace {

constexpr std::int64_t mixed = 20, ngon = 22, nface = 23;

using enum ElementType;

/// The kinds of elements by ElementType_t number (cgnslib.h, since 3.1); nodes 0: no shape.
constexpr std::array<ElementKind, 57> kinds{{
    {},
    {},
    {0, triangle, 1, 1},
    {1, triangle, 2, 2},
    {1, triangle, 3, 2},
    {2, triangle, 3, 3},
    {2, triangle, 6, 3},
    {2, quadrilateral, 4, 4},
    {2, quadrilateral, 8, 4},
    {2, quadrilateral, 9, 4},
    {3, tetrahedron, 4, 4},
    {3, tetrahedron, 10, 4},
    {3, pyramid, 5, 5},
    {3, pyramid, 14, 5},
    {3, prism, 6, 6},
    {3, prism, 15, 6},
    {3, prism, 18, 6},
    {3, hexahedron, 8, 8},
    {3, hexahedron, 20, 8},
    {3, hexahedron, 27, 8},
    {},
    {3, pyramid, 13, 5},
    {},
    {},
    {1, triangle, 4, 2},
    {2, triangle, 9, 3},
    {2, triangle, 10, 3},
    {2, quadrilateral, 12, 4},
    {2, quadrilateral, 16, 4},
    {3, tetrahedron, 16, 4},
    {3, tetrahedron, 20, 4},
    {3, pyramid, 21, 5},
    {3, pyramid, 29, 5},
    {3, pyramid, 30, 5},
    {3, prism, 24, 6},
    {3, prism, 38, 6},
    {3, prism, 40, 6},
    {3, hexahedron, 32, 8},
    {3, hexahedron, 56, 8},
    {3, hexahedron, 64, 8},
    {1, triangle, 5, 2},
    {2, triangle, 12, 3},
    {2, triangle, 15, 3},
    {2, quadrilateral, 16, 4},
    {2, quadrilateral, 25, 4},
    {3, tetrahedron, 22, 4},
    {3, tetrahedron, 34, 4},
    {3, tetrahedron, 35, 4},
    {3, pyramid, 29, 5},
    {3, pyramid, 50, 5},
    {3, pyramid, 55, 5},
    {3, prism, 33, 6},
    {3, prism, 66, 6},
    {3, prism, 75, 6},
    {3, hexahedron, 44, 8},
    {3, hexahedron, 98, 8},
    {3, hexahedron, 125, 8},
}};

class SectionReader {
 public:
  SectionReader(File const& file, ElementTypes const& types, ZoneLayout const& zone, Problems& problems)
      : file_(file), types_(types), zone_(zone), problems_(problems) {}

  std::optional<Section> read(Node const& node) {
    where_ = file_.path() + ": zone '" + zone_.name + "', elements '" + node.name + "'";
    Section out;
    out.name = node.name;
    auto type = file_.integers(node);
    if (!type.empty()) type[0] = types_(type[0]);
    auto const* range_node = node.child("ElementRange");
    auto const range = range_node ? file_.integers(*range_node) : std::vector<std::int64_t>{};
    auto const* connectivity = node.child("ElementConnectivity");
    if (type.empty() || range.size() != 2 || !connectivity)
      return wrong("lacks its type, its ElementRange or its ElementConnectivity");
    if (range[0] < 1 || range[1] < range[0] || range[1] >= std::numeric_limits<Index32>::max())
      return wrong("has the ElementRange [" + std::to_string(range[0]) + ":" + std::to_string(range[1]) + "]");
    out.first = range[0];
    out.last = range[1];
    out.list = file_.integers(*connectivity);
    Index const n = range[1] - range[0] + 1;
    // Every element has a node, so that no more memory is asked for than the connectivity already took.
    if (n > Index(out.list.size()))
      return wrong("declares " + std::to_string(n) + " elements, but lists " + std::to_string(out.list.size()) +
                   " numbers");
    auto const* offsets = node.child("ElementStartOffset");
    auto const start = offsets ? file_.integers(*offsets) : std::vector<std::int64_t>{};
    bool read = false;
    if (type[0] == mixed)
      read = split_mixed(out, n);
    else if (type[0] == ngon || type[0] == nface)
      read = split_polygons(out, n, type[0], start);
    else
      read = split_uniform(out, n, type[0]);
    if (!read) return std::nullopt;
    if (type[0] == ngon)
      if (auto const* parents = node.child("ParentElements")) {
        out.parents = file_.integers(*parents);
        if (Index(out.parents.size()) != 2 * n) return wrong("has ParentElements for another number of faces");
      }
    return check_nodes(out) ? std::optional(std::move(out)) : std::nullopt;
  }

 private:
  std::optional<Section> wrong(std::string const& what) {
    problems_.add(where_ + ": " + what + "; the file is damaged or written by a program with a fault");
    return std::nullopt;
  }

  bool split_uniform(Section& s, Index n, std::int64_t type) {
    auto const kind = element_kind(type);
    if (!kind) return wrong("has the unknown element type " + std::to_string(type)), false;
    if (Index(s.list.size()) != n * kind->nodes)
      return wrong("lists " + std::to_string(s.list.size()) + " nodes for " + std::to_string(n) + " elements of " +
                   std::to_string(kind->nodes)),
             false;
    s.cgns_types.assign(n, static_cast<unsigned char>(type));
    s.start.resize(n + 1);
    for (Index e = 0; e <= n; ++e) s.start[e] = e * kind->nodes;
    return true;
  }

  /// MIXED: type, nodes, type, nodes, ... (with the types in between also where there is an ElementStartOffset).
  bool split_mixed(Section& s, Index n) {
    Index at = 0, to = 0;
    Index const size = Index(s.list.size());
    s.start.push_back(0);
    for (Index e = 0; e < n; ++e) {
      auto const type = at < size ? types_(s.list[at]) : 0;
      auto const kind = element_kind(type);
      if (!kind || at + 1 + kind->nodes > size)
        return wrong("its element " + std::to_string(s.first + e) + " has " +
                     (at >= size ? "no place in the list"
                      : kind     ? "fewer nodes than its type asks for"
                                 : "the unknown type " + std::to_string(type))),
               false;
      s.cgns_types.push_back(static_cast<unsigned char>(type));
      // In place: what is kept is never ahead of what is read.
      std::copy_n(s.list.begin() + at + 1, kind->nodes, s.list.begin() + to);
      to += kind->nodes;
      at += 1 + kind->nodes;
      s.start.push_back(to);
    }
    if (at != size) return wrong("lists more numbers than its elements have"), false;
    s.list.resize(to);
    return true;
  }

  /// NGON_n and NFACE_n: with ElementStartOffset (CGNS 4), or each list behind its length.
  bool split_polygons(Section& s, Index n, std::int64_t type, std::vector<std::int64_t> const& start) {
    s.cgns_types.assign(n, static_cast<unsigned char>(type));
    Index const size = Index(s.list.size());
    if (!start.empty()) {
      bool fits = Index(start.size()) == n + 1 && start.front() == 0 && start.back() == size;
      for (std::size_t e = 1; fits && e < start.size(); ++e) fits = start[e] >= start[e - 1];
      if (!fits) return wrong("has an ElementStartOffset that does not fit its connectivity"), false;
      s.start.assign(start.begin(), start.end());
      return true;
    }
    Index at = 0, to = 0;
    s.start.push_back(0);
    for (Index e = 0; e < n; ++e) {
      auto const count = at < size ? s.list[at] : -1;
      if (count < 0 || count > size - at - 1)
        return wrong("its element " + std::to_string(s.first + e) + " does not fit into the list"), false;
      std::copy_n(s.list.begin() + at + 1, count, s.list.begin() + to);
      to += count;
      at += 1 + count;
      s.start.push_back(to);
    }
    if (at != size) return wrong("lists more numbers than its elements have"), false;
    s.list.resize(to);
    return true;
  }

  bool check_nodes(Section const& s) {
    if (s.cgns_types.front() == nface) return true;  // faces, looked up later
    for (Index e = 0; e < s.size(); ++e)
      for (auto const node : s[e])
        if (node < 1 || node > zone_.extent[0]) {
          problems_.add(where_ + ": its element " + std::to_string(s.first + e) + " has node " + std::to_string(node) +
                        ", but the zone has " + std::to_string(zone_.extent[0]) + " nodes");
          return false;
        }
    return true;
  }

  File const& file_;
  ElementTypes const& types_;
  ZoneLayout const& zone_;
  Problems& problems_;
  std::string where_;
};

}  // namespace

std::optional<ElementKind> element_kind(std::int64_t cgns_type) {
  if (cgns_type < 0 || cgns_type >= std::int64_t(kinds.size()) || kinds[cgns_type].nodes == 0) return std::nullopt;
  return kinds[cgns_type];
}

ElementTypes::ElementTypes(File const& file, Node const& tree) {
  auto const* node = tree.labelled("CGNSLibraryVersion_t");
  auto const version = node ? file.reals(*node) : std::vector<double>{};
  version_3_0_ = !version.empty() && version.front() > 2.995 && version.front() < 3.095;
}

std::int64_t ElementTypes::operator()(std::int64_t stored) const {
  constexpr std::int64_t pyramid_13 = 21, pyramid_13_in_3_0 = 13;
  if (!version_3_0_ || stored < pyramid_13_in_3_0 || stored > pyramid_13) return stored;
  return stored == pyramid_13_in_3_0 ? pyramid_13 : stored - 1;
}

std::vector<Section> read_sections(File const& file, ElementTypes const& types, ZoneLayout const& zone,
                                   Problems& problems) {
  SectionReader reader(file, types, zone, problems);
  std::vector<Section> out;
  for (auto const* node : zone.node->all("Elements_t"))
    if (auto section = reader.read(*node)) out.push_back(std::move(*section));
  std::stable_sort(out.begin(), out.end(), [](Section const& a, Section const& b) { return a.first < b.first; });
  for (std::size_t s = 1; s < out.size(); ++s)
    if (out[s].first <= out[s - 1].last)
      problems.add(file.path() + ": zone '" + zone.name + "': the ElementRanges of '" + out[s - 1].name + "' and '" +
                   out[s].name + "' overlap");
  return out;
}

int dimension_of(std::vector<Section> const& sections) {
  int dimension = 0;
  for (auto const& s : sections)
    for (auto const type : s.cgns_types) {
      if (type == ngon) dimension = std::max(dimension, s.parents.empty() ? 2 : 3);
      if (type == nface) dimension = 3;
      if (auto const kind = element_kind(type)) dimension = std::max(dimension, kind->dimension);
    }
  return dimension;
}

Index ListedFaces::find(std::int64_t file_number) const {
  for (auto const& g : groups) {
    if (g.begin == g.end || file_number < number[g.begin] || file_number > number[std::size_t(g.end) - 1]) continue;
    auto const begin = number.begin() + g.begin, end = number.begin() + g.end;
    auto const at = std::lower_bound(begin, end, file_number);
    if (at != end && *at == file_number) return Index(at - number.begin());
  }
  return -1;
}

bool ListedFaces::is_smaller(std::int64_t file_number) const {
  return std::any_of(smaller.begin(), smaller.end(),
                     [&](auto const& range) { return range[0] <= file_number && file_number <= range[1]; });
}

ListedFaces add_elements(std::vector<Section> const& sections, std::string const& where, Mesh& mesh,
                         Problems& problems) {
  ListedFaces faces;
  Index const offset = mesh.zones.back().first_node - 1;
  std::vector<Index32> nodes;
  auto const add_face = [&](Section const& s, Index e, std::size_t corners) {
    nodes.clear();
    for (auto const n : s[e].first(corners)) nodes.push_back(Index32(n + offset));
    faces.nodes.add(nodes);
    faces.number.push_back(s.first + e);
  };
  for (auto const& s : sections) {
    ListedFaces::Group group{s.name, faces.nodes.size(), 0, s.cgns_types.front() == ngon};
    for (Index e = 0; e < s.size(); ++e) {
      auto const type = s.cgns_types[e];
      if (type == nface) break;
      if (type == ngon && mesh.dimension == 3) {
        if (s[e].size() < 3) {
          problems.add(where + ", elements '" + s.name + "': polygon " + std::to_string(s.first + e) + " has " +
                       std::to_string(s[e].size()) + " corners; 3 are needed");
          break;
        }
        add_face(s, e, s[e].size());
        continue;
      }
      auto kind = element_kind(type);
      if (type == ngon) {
        auto const n = s[e].size();
        if (n != 3 && n != 4) {
          problems.add(where + ", elements '" + s.name + "': element " + std::to_string(s.first + e) +
                       " is a polygon of " + std::to_string(n) +
                       " corners; 2-D meshes of triangles and quadrilaterals are supported");
          break;
        }
        kind = ElementKind{2, n == 3 ? triangle : quadrilateral, int(n), int(n)};
      }
      if (kind->dimension == mesh.dimension) {
        nodes.clear();
        for (auto const n : s[e]) nodes.push_back(Index32(n + offset));
        mesh.add_element(kind->type, nodes);
        mesh.elements.number.push_back(Index32(s.first + e));
      } else if (kind->dimension == mesh.dimension - 1) {
        add_face(s, e, std::size_t(kind->corners));
      } else {
        faces.add_smaller(s.first + e);
      }
    }
    group.end = faces.nodes.size();
    faces.groups.push_back(group);
  }
  faces.claimed.assign(faces.number.size(), 0);
  if (mesh.dimension == 3) add_polyhedra(sections, faces, where, mesh, problems);
  return faces;
}

}  // namespace gridmorph::cgns
