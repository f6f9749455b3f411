#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/periodic_transform.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/su2/su2_parser.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

namespace gridmorph::su2 {

namespace {

ElementType element_type(int vtk) {
  switch (vtk) {
    case 5: return ElementType::triangle;
    case 9: return ElementType::quadrilateral;
    case 10: return ElementType::tetrahedron;
    case 12: return ElementType::hexahedron;
    case 13: return ElementType::prism;
    default: return ElementType::pyramid;
  }
}

class Builder {
 public:
  Builder(std::string const& path, std::vector<ZoneText> zones, std::vector<std::string> notes)
      : path_(path), zones_(std::move(zones)) {
    mesh_.source = path;
    mesh_.notes = std::move(notes);
    mesh_.first_number = 0;
    mesh_.dimension = zones_.front().dimension;
  }

  Mesh run() {
    Problems problems;
    Index nodes = 0;
    for (auto const& z : zones_) nodes += Index(z.coordinates.size()) / z.dimension;
    if (nodes > std::numeric_limits<Index32>::max())
      throw MeshError(path_ + ": has " + std::to_string(nodes) + " points, more than can be handled");
    for (auto const& z : zones_) zone(z, problems);
    problems.throw_if_any<MeshError>();
    coordinates();
    io::check_places(mesh_, path_, problems);
    problems.throw_if_any<MeshError>();
    if (io::orient_prisms(mesh_))
      mesh_.notes.push_back(path_ + ": the prisms are numbered as VTK does, bottom triangles outwards; taken so");
    for (std::size_t z = 0; z < zones_.size(); ++z) {
      markers(int(z), problems);
      periodic(int(z), problems);
    }
    problems.throw_if_any<MeshError>();
    check_mesh(mesh_);
    return std::move(mesh_);
  }

 private:
  void zone(ZoneText const& z, Problems& problems) {
    std::string const where = path_ + ": " + z.name;
    if (z.dimension != mesh_.dimension) return problems.add(where + " has another dimension than the zone before it");
    Index const n = Index(z.coordinates.size()) / z.dimension;
    if (n == 0 || z.vtk.empty()) return problems.add(where + " has no points or no elements");
    int const number = mesh_.add_zone(z.name, n);
    Index const first = mesh_.zones[number].first_node;
    std::array<Index32, max_corners> list{};
    for (std::size_t e = 0; e < z.vtk.size(); ++e) {
      int const size = int(z.start[e + 1] - z.start[e]);
      for (int k = 0; k < size; ++k) {
        auto const node = z.nodes[z.start[e] + k];
        if (node < 0 || node >= n)
          return problems.add(where + ": element " + std::to_string(e) + " has node " + std::to_string(node) +
                              ", but there are " + std::to_string(n) + " points, numbered from 0");
        list[k] = Index32(node + first);
      }
      mesh_.add_element(element_type(z.vtk[e]), std::span<Index32 const>(list.data(), std::size_t(size)));
    }
    if (z.index_differs)
      mesh_.notes.push_back(where +
                            ": the index column of the points is not 0, 1, 2, ...; the order of the lines counts");
  }

  void coordinates() {
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    Index n = 0;
    for (auto const& z : zones_)
      for (std::size_t at = 0; at < z.coordinates.size(); at += std::size_t(z.dimension), ++n)
        mesh_.coordinates.set(n,
                              {z.coordinates[at], z.coordinates[at + 1], z.dimension == 3 ? z.coordinates[at + 2] : 0});
  }

  /// Node of a marker in the mesh; -1 and a problem where it is none.
  Index32 node_of(int z, Marker const& m, std::int64_t node, Problems& problems) {
    auto const& zone = mesh_.zones[z];
    if (node >= 0 && node < zone.size()) return Index32(node + zone.first_node);
    problems.add(path_ + ":" + std::to_string(m.line) + ": marker '" + m.name + "' has node " + std::to_string(node) +
                 ", but there are " + std::to_string(zone.size()) + " points, numbered from 0");
    return -1;
  }

  void markers(int z, Problems& problems) {
    bool by_name = false;
    for (auto const& m : zones_[z].markers) {
      if (m.name == "SEND_RECEIVE") continue;
      Patch patch;
      patch.name = m.name;
      patch.zone = z;
      patch.kind = io::kind_by_name(m.name);
      by_name = by_name || patch.kind != PatchKind::other;
      std::vector<Index32> face;
      for (std::size_t e = 0; e < m.vtk.size(); ++e) {
        face.clear();
        for (Index k = m.start[e]; k < m.start[e + 1]; ++k) {
          Index32 const node = node_of(z, m, m.nodes[k], problems);
          if (node < 0) return;
          face.push_back(node);
        }
        if (m.vtk[e] == 1)
          patch.nodes.push_back(face.front());
        else
          patch.faces.add(face);
      }
      if (patch.faces.size() > 0) patch.nodes.clear();
      std::sort(patch.nodes.begin(), patch.nodes.end());
      patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
      if (patch.faces.size() == 0 && patch.nodes.empty()) {
        mesh_.notes.push_back(path_ + ":" + std::to_string(m.line) + ": marker '" + m.name + "' is empty; skipped");
        continue;
      }
      mesh_.patches.push_back(std::move(patch));
    }
    if (by_name)
      mesh_.notes.push_back(path_ + ": SU2 files do not say what a marker is; kinds are taken from the names");
  }

  /// SEND_RECEIVE markers: the k-th node of the one that sends to a rank pairs with the k-th of the one that receives
  /// from it. Those of one PERIODIC_INDEX become a connection.
  void periodic(int z, Problems& problems) {
    auto const& text = zones_[z];
    std::map<int, Connection> by_transform;
    for (auto const& send : text.markers) {
      if (send.name != "SEND_RECEIVE" || send.send_to <= 0) continue;
      auto const receive = std::find_if(text.markers.begin(), text.markers.end(), [&](Marker const& m) {
        return m.name == "SEND_RECEIVE" && m.send_to == -send.send_to;
      });
      std::string const where = path_ + ":" + std::to_string(send.line) + ": SEND_RECEIVE marker";
      if (receive == text.markers.end() || receive->nodes.size() != send.nodes.size()) {
        mesh_.notes.push_back(where + " has no counterpart of as many nodes; skipped");
        continue;
      }
      if (send.transform.size() != send.nodes.size() || receive->transform.size() != receive->nodes.size()) {
        mesh_.notes.push_back(where + " or its counterpart has elements that are no vertices; skipped");
        continue;
      }
      for (std::size_t k = 0; k < send.nodes.size(); ++k) {
        int const index = receive->transform[k];
        Index32 const own = node_of(z, send, send.nodes[k], problems);
        Index32 const donor = node_of(z, *receive, receive->nodes[k], problems);
        if (own < 0 || donor < 0) return;
        if (index < 0 || (index > 0 && index >= int(text.periodic.size())))
          return problems.add(where + " has PERIODIC_INDEX " + std::to_string(index) + ", which is not given");
        auto& c = by_transform[index];
        c.nodes.push_back(own);
        c.donor_nodes.push_back(donor);
      }
    }
    for (auto& [index, c] : by_transform) {
      c.name = "PERIODIC_INDEX " + std::to_string(index);
      c.zone = c.donor_zone = z;
      if (index > 0) c.periodic = transform(text.periodic[index]);
      double const tolerance = place_tolerance(1e-6, mesh_.size(), coordinate_resolution(mesh_));
      double const mismatch = largest_mismatch(mesh_, c);
      if (mismatch > tolerance) std::swap(c.nodes, c.donor_nodes);
      if (mismatch > tolerance && largest_mismatch(mesh_, c) > tolerance) {
        mesh_.notes.push_back(path_ + ": SEND_RECEIVE nodes of " + c.name + " are up to " + std::to_string(mismatch) +
                              " from where the transform takes them; skipped");
        continue;
      }
      mesh_.connections.push_back(std::move(c));
    }
  }

  static std::optional<Periodic> transform(PeriodicEntry const& e) {
    Periodic p;
    p.rotation_center = {e.center[0], e.center[1], e.center[2]};
    p.rotation_angle_rad = {e.angle[0], e.angle[1], e.angle[2]};
    p.translation = {e.translation[0], e.translation[1], e.translation[2]};
    io::set_declared(p);
    return p;
  }

  std::string const& path_;
  std::vector<ZoneText> zones_;
  Mesh mesh_;
};

}  // namespace

bool is_su2(std::string const& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  constexpr int most_lines = 200;  // of comments at the head
  constexpr std::streamsize longest = 4096;
  for (int n = 0; n < most_lines; ++n) {
    line.assign(longest, '\0');
    if (!file.getline(line.data(), longest)) return false;
    line.resize(std::strlen(line.c_str()));
    auto const first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '%') continue;
    auto const key = std::string_view(line).substr(first);
    constexpr std::array keywords{"NDIME", "NZONE", "IZONE", "NELEM", "NPOIN", "NMARK"};
    return std::any_of(keywords.begin(), keywords.end(),
                       [&](char const* k) { return key.starts_with(k) && key.find('=') != std::string_view::npos; });
  }
  return false;
}

Mesh read(std::string const& path) {
  std::string const text = io::read_file(path);
  std::vector<std::string> notes;
  auto zones = parse(path, text, notes);
  return Builder(path, std::move(zones), std::move(notes)).run();
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  std::string const text = io::read_file(input);
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  std::size_t copied = 0;
  std::vector<std::string> notes;
  std::array<double const*, 3> const arrays{morphed.x.data(), morphed.y.data(), morphed.z.data()};
  bool same = true;
  auto const zones = parse(input, text, notes, [&](CoordinateText const& c) {
    same = same && c.zone < mesh.zones.size() && c.point < mesh.zones[c.zone].size();
    if (!same) return;
    double const value = arrays[c.component][mesh.zones[c.zone].first_node + c.point];
    if (std::memcmp(&value, &c.value, sizeof value) == 0) return;
    std::array<char, 32> digits{};
    auto const end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::scientific).ptr;
    out.append(text, copied, c.begin - copied);
    out.append(digits.data(), end);
    copied = c.end;
  });
  same = same && zones.size() == mesh.zones.size();
  for (std::size_t z = 0; same && z < zones.size(); ++z)
    same = Index(zones[z].coordinates.size()) == zones[z].dimension * mesh.zones[z].size();
  if (!same)
    throw IoError(input + ": holds other zones or points than the mesh; give the file that the mesh was read from");
  out.append(text, copied);
  io::OutputFile target(output);
  target.write(out);
  target.commit();
}

}  // namespace gridmorph::su2
