#include <gridmorph/core/error.hpp>
#include <gridmorph/io/extrude.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/plot3d/plot3d.hpp>
#include <gridmorph/io/plot3d/plot3d_layout.hpp>
#include <gridmorph/io/plot3d/plot3d_text.hpp>
#include <gridmorph/io/read_file.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <type_traits>
#include <utility>

namespace gridmorph::plot3d {

namespace {

constexpr Index values_at_once = 1 << 16;

/// What a file holds, and its text when it is one.
struct File {
  FileLayout layout;
  std::string text;
  TextLayout numbers;

  [[nodiscard]] bool formatted() const { return layout.variant.storage == Storage::formatted; }
};

bool begins_as_text(std::string const& path) {
  Bytes file(path);
  std::string head(std::size_t(std::min<std::uint64_t>(file.size(), 4096)), '\0');
  return file.read(0, head.data(), head.size()) && looks_like_numbers(head);
}

File open(std::string const& path, std::string const& stated_words) {
  File out;
  Stated const stated = parse_variant(stated_words, path + ": format");
  bool const text = stated.storage ? *stated.storage == Storage::formatted : begins_as_text(path);
  if (!text) {
    out.layout = detect_binary(path, stated);
    return out;
  }
  out.text = io::read_file(path);
  out.numbers = read_text(out.text, path, stated);
  out.layout = out.numbers.file;
  return out;
}

/// The direction in which a zone has one node: k in 2-D files; -1 for a 3-D zone.
int flat_axis(ZoneData const& zone, Variant const& v) {
  if (v.dimensions == 2) return 2;
  for (int a = 2; a >= 0; --a)
    if (zone.extent[a] == 1) return a;
  return -1;
}

/// The zones as the mesh sees them; problems for those that are no zones of a mesh.
cgns::Layout zone_layouts(FileLayout const& file, std::string const& path) {
  Problems problems;
  cgns::Layout out;
  for (std::size_t z = 0; z < file.zones.size(); ++z) {
    cgns::ZoneLayout zone;
    zone.name = "zone " + std::to_string(z + 1);
    zone.extent = file.zones[z].extent;
    zone.index_dimension = file.variant.dimensions;
    zone.flat_axis = flat_axis(file.zones[z], file.variant);
    zone.single_precision.fill(!file.variant.double_precision);
    int thin = 0;
    for (int a = 0; a < 3; ++a) thin += zone.extent[a] < 2 ? 1 : 0;
    if (thin > 1)
      problems.add(path + ": " + zone.name + " has " + std::to_string(zone.extent[0]) + " x " +
                   std::to_string(zone.extent[1]) + " x " + std::to_string(zone.extent[2]) +
                   " nodes, a line or a point; remove it from the mesh");
    else if (!out.zones.empty() && (zone.flat_axis >= 0) != (out.zones.front().flat_axis >= 0))
      problems.add(path + ": " + zone.name + " is " + (zone.flat_axis >= 0 ? "2-D" : "3-D") +
                   " and the zones before it are not; 2-D and 3-D zones cannot be mixed");
    out.zones.push_back(std::move(zone));
  }
  problems.throw_if_any<IoError>();
  return out;
}

template <class Word>
void decode(unsigned char const* bytes, bool big_endian, Index count, double* to) {
  using Real = std::conditional_t<sizeof(Word) == 8, double, float>;
  bool const swap = big_endian != (std::endian::native == std::endian::big);
  for (Index n = 0; n < count; ++n) {
    std::array<unsigned char, sizeof(Word)> b;
    std::memcpy(b.data(), bytes + std::size_t(n) * sizeof(Word), sizeof(Word));
    if (swap) std::reverse(b.begin(), b.end());
    to[n] = double(std::bit_cast<Real>(b));
  }
}

template <class Word>
void encode(double const* from, bool big_endian, Index count, unsigned char* bytes) {
  using Real = std::conditional_t<sizeof(Word) == 8, double, float>;
  bool const swap = big_endian != (std::endian::native == std::endian::big);
  for (Index n = 0; n < count; ++n) {
    auto b = std::bit_cast<std::array<unsigned char, sizeof(Word)>>(Real(from[n]));
    if (swap) std::reverse(b.begin(), b.end());
    std::memcpy(bytes + std::size_t(n) * sizeof(Word), b.data(), sizeof(Word));
  }
}

/// Calls visit(bytes of the zone's data, their number, first value, values) for pieces of one component.
template <class Visit>
void in_pieces(FileLayout const& layout, ZoneData const& zone, int component, Visit visit) {
  auto const width = std::uint64_t(layout.variant.coordinate_bytes());
  for (Index first = 0; first < zone.nodes(); first += values_at_once) {
    Index const count = std::min(values_at_once, zone.nodes() - first);
    visit((std::uint64_t(component) * std::uint64_t(zone.nodes()) + std::uint64_t(first)) * width,
          std::uint64_t(count) * width, first, count);
  }
}

void read_binary_component(Bytes& bytes, std::string const& path, FileLayout const& layout, ZoneData const& zone,
                           int component, double* to) {
  std::vector<unsigned char> buffer(std::size_t(values_at_once) * 8);
  auto const& v = layout.variant;
  in_pieces(layout, zone, component, [&](std::uint64_t begin, std::uint64_t size, Index first, Index count) {
    for_each_piece(zone, begin, size, [&](std::uint64_t at, std::uint64_t before, std::uint64_t n) {
      if (!bytes.read(at, buffer.data() + before, n))
        throw IoError(path + ": cannot be read at byte " + std::to_string(at) + "; has it changed meanwhile?");
    });
    if (v.double_precision)
      decode<std::uint64_t>(buffer.data(), v.big_endian, count, to + first);
    else
      decode<std::uint32_t>(buffer.data(), v.big_endian, count, to + first);
  });
}

std::array<double*, 3> components(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

void read_coordinates(std::string const& path, File const& file, cgns::Layout const& zones, Mesh& mesh) {
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const flat = components(mesh.coordinates);
  for (auto* array : flat) std::fill(array, array + mesh.n_nodes(), 0.0);
  auto const& v = file.layout.variant;
  std::optional<Bytes> bytes;
  if (!file.formatted()) bytes.emplace(path);
  std::size_t value = 0;
  std::vector<double> plane;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    auto const& data = file.layout.zones[z];
    auto const& zone = mesh.zones[z];
    int const axis = zones.zones[z].flat_axis;
    for (int c = 0; c < v.dimensions; ++c) {
      double* const dest = flat[c] + zone.first_node;
      double* to = dest;
      if (axis >= 0) {
        plane.resize(data.nodes());
        to = plane.data();
      }
      if (file.formatted()) {
        for_each_run(data, v, [&](Index in_file, Index in_zone, Index count) {
          if (in_zone / data.nodes() == c)
            std::copy_n(file.numbers.values.begin() + std::ptrdiff_t(value) + in_file, count,
                        to + in_zone % data.nodes());
        });
      } else {
        read_binary_component(*bytes, path, file.layout, data, c, to);
      }
      if (axis < 0) continue;
      auto const p = cgns::plane_steps(zone, axis);
      auto from = plane.begin();
      for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
        for (int a = 0; a < zone.extent[p.axis[0]]; ++a) {
          Index const n = a * p.step[0] + b * p.step[1];
          dest[n] = dest[n + p.across] = *from++;
        }
    }
    value += std::size_t(data.nodes()) * std::size_t(v.dimensions + (v.iblank ? 1 : 0));
  }
}

/// One component of a zone in the order of the file.
void gather(Mesh const& mesh, std::size_t z, int axis, double const* source, std::vector<double>& out) {
  auto const& zone = mesh.zones[z];
  out.clear();
  if (axis < 0) {
    out.assign(source + zone.first_node, source + zone.first_node + zone.size());
    return;
  }
  auto const p = cgns::plane_steps(zone, axis);
  for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
    for (int a = 0; a < zone.extent[p.axis[0]]; ++a)
      out.push_back(source[zone.first_node + a * p.step[0] + b * p.step[1]]);
}

void write_binary(std::string const& path, std::string const& output, File const& file, cgns::Layout const& zones,
                  Mesh const& mesh, Coordinates const& morphed) {
  errno = 0;
  std::fstream out(path, std::ios::binary | std::ios::in | std::ios::out);
  std::vector<double> values;
  std::vector<unsigned char> buffer(std::size_t(values_at_once) * 8);
  auto const& v = file.layout.variant;
  for (std::size_t z = 0; z < mesh.zones.size() && out; ++z)
    for (int c = 0; c < v.dimensions; ++c) {
      gather(mesh, z, zones.zones[z].flat_axis, components(morphed)[c], values);
      auto const& data = file.layout.zones[z];
      in_pieces(file.layout, data, c, [&](std::uint64_t begin, std::uint64_t size, Index first, Index count) {
        if (v.double_precision)
          encode<std::uint64_t>(values.data() + first, v.big_endian, count, buffer.data());
        else
          encode<std::uint32_t>(values.data() + first, v.big_endian, count, buffer.data());
        for_each_piece(data, begin, size, [&](std::uint64_t at, std::uint64_t before, std::uint64_t n) {
          out.seekp(std::streamoff(at));
          out.write(reinterpret_cast<char const*>(buffer.data() + before), std::streamsize(n));
        });
      });
    }
  out.close();
  if (!out) throw MachineError(output + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

Mesh read(std::string const& path, ReadOptions const& options) {
  File const file = open(path, options.plot3d_format);
  auto const zones = zone_layouts(file.layout, path);
  Mesh mesh;
  mesh.source = path;
  mesh.file_variant = to_string(file.layout.variant);
  mesh.notes.push_back(path + ": PLOT3D, " + mesh.file_variant);
  mesh.dimension = zones.zones.front().flat_axis >= 0 ? 2 : 3;
  for (auto const& zone : zones.zones) {
    int const z = mesh.add_zone(zone.name, zone.mesh_extent());
    mesh.zones[z].single_precision = zone.single_precision[0];
  }
  Problems problems;
  if (options.coordinates) {
    read_coordinates(path, file, zones, mesh);
    io::check_places(mesh, path, problems);
  }
  if (mesh.dimension == 2 && problems.empty()) add_second_planes(zones, mesh, problems);
  problems.throw_if_any<MeshError>();
  return mesh;
}

void write(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  File const file = open(input, mesh.file_variant);
  auto const zones = zone_layouts(file.layout, input);
  bool same = zones.zones.size() == mesh.zones.size();
  for (std::size_t z = 0; same && z < mesh.zones.size(); ++z)
    same = zones.zones[z].mesh_extent() == mesh.zones[z].extent;
  if (!same) throw IoError(input + ": does not hold the zones of the mesh; give the file that the mesh was read from");

  io::OutputFile target(output);
  if (file.formatted()) {
    std::vector<std::vector<double>> coordinates(mesh.zones.size());
    std::vector<double> values;
    for (std::size_t z = 0; z < mesh.zones.size(); ++z)
      for (int c = 0; c < file.layout.variant.dimensions; ++c) {
        gather(mesh, z, zones.zones[z].flat_axis, components(morphed)[c], values);
        coordinates[z].insert(coordinates[z].end(), values.begin(), values.end());
      }
    target.write(replace_coordinates(file.text, input, file.numbers, coordinates));
  } else {
    target.copy_from(input);
    write_binary(target.path(), output, file, zones, mesh, morphed);
  }
  target.commit();
}

}  // namespace gridmorph::plot3d
