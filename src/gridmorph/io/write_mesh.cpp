#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/cgns/new_names.hpp>
#include <gridmorph/io/element_zones.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/output_file.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <variant>

namespace gridmorph {

namespace {

class MeshWriter {
 public:
  MeshWriter(cgns::File& file, Mesh const& mesh, WriteOptions const& options) : file_(file), mesh_(mesh) {
    dimension_ = mesh.dimension == 2 ? 2 : 3;
    physical_dimension_ = mesh.dimension == 2 ? options.physical_dimension : 3;
    for (auto const& patch : mesh.patches)
      if (!patch.families.empty()) family_types_[patch.families.front()].insert(cgns::bc_type_of(patch));
  }

  void begin() {
    float const version = cgns::library_version;
    file_.create(file_.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", {1}, &version);
  }

  /// Writes zone z. values: x, y, z of its nodes.
  void zone(int z, std::array<double const*, 3> const& values) {
    auto const& zone = mesh_.zones[z];
    if (mesh_.dimension == 2 && zone.extent[2] != 2)
      throw IoError(mesh_.source + ": zone '" + zone.name + "' of a 2-D mesh has " + std::to_string(zone.extent[2]) +
                    " planes along k; 2-D meshes are written from two planes along k");
    auto const [base_name, zone_name] = split(zone.name);
    std::vector<std::int32_t> sizes(3 * std::size_t(dimension_),
                                    0);  // nodes, cells, boundary nodes (none when structured)
    for (int a = 0; a < dimension_; ++a) {
      sizes[a] = zone.extent[a];
      sizes[dimension_ + a] = zone.extent[a] - 1;
    }
    double const id = file_.create(base(base_name), zone_name, "Zone_t", "I4", {dimension_, 3}, sizes.data());
    file_.create_text(id, "ZoneType", "ZoneType_t", "Structured");
    coordinates(zone, id, values);
    boundary(z, id);
    interfaces(z, id);
  }

 private:
  /// The names of base and zone: "Base/Zone" in a mesh of several bases, otherwise "Zone" in a base called "Base".
  static std::pair<std::string, std::string> split(std::string const& zone_name) {
    auto const slash = zone_name.find('/');
    if (slash == std::string::npos) return {"Base", zone_name};
    return {zone_name.substr(0, slash), zone_name.substr(slash + 1)};
  }

  double base(std::string const& name) {
    if (auto const known = bases_.find(name); known != bases_.end()) return known->second;
    std::array<std::int32_t, 2> const dimensions{dimension_, physical_dimension_};
    double const id = file_.create(file_.root(), name, "CGNSBase_t", "I4", {2}, dimensions.data());
    bases_.emplace(name, id);
    std::map<std::string, double> families;
    for (auto const& family : mesh_.families) add_family(id, family, families);
    for (auto const& patch : mesh_.patches)
      for (auto const& family : patch.families) add_family(id, family, families);
    return id;
  }

  /// Families of a tree ("Parent/Child") are nodes in nodes.
  double add_family(double base, std::string const& path, std::map<std::string, double>& known) {
    if (auto const found = known.find(path); found != known.end()) return found->second;
    auto const slash = path.rfind('/');
    double const parent = slash == std::string::npos ? base : add_family(base, path.substr(0, slash), known);
    double const id = file_.create(parent, slash == std::string::npos ? path : path.substr(slash + 1), "Family_t");
    known.emplace(path, id);
    if (auto const types = family_types_.find(path); types != family_types_.end() && types->second.size() == 1)
      file_.create_text(id, "FamilyBC", "FamilyBC_t", *types->second.begin());
    return id;
  }

  void coordinates(Zone const& zone, double zone_id, std::array<double const*, 3> const& values) {
    double const grid = file_.create(zone_id, "GridCoordinates", "GridCoordinates_t");
    std::vector<Index> dimensions(zone.extent.begin(), zone.extent.begin() + dimension_);
    Index const n = dimension_ == 2 ? zone.size() / 2 : zone.size();
    static constexpr std::array names{"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (int c = 0; c < physical_dimension_; ++c) {
      double const* source = values[c];
      if (zone.single_precision) {
        std::vector<float> const rounded(source, source + n);
        file_.create(grid, names[c], "DataArray_t", "R4", dimensions, rounded.data());
      } else {
        file_.create(grid, names[c], "DataArray_t", "R8", dimensions, source);
      }
    }
  }

  void range(double parent, char const* name, Index3 const& first, Index3 const& last) {
    std::vector<std::int32_t> corners;
    for (auto const* p : {&first, &last})
      for (int a = 0; a < dimension_; ++a) corners.push_back((*p)[a] + 1);
    file_.create(parent, name, "IndexRange_t", "I4", {dimension_, 2}, corners.data());
  }

  static Index3 last_of(IndexRange const& r) { return {r.end[0] - 1, r.end[1] - 1, r.end[2] - 1}; }

  void family_names(double parent, std::vector<std::string> const& families) {
    for (std::size_t f = 0; f < families.size(); ++f)
      if (f == 0)
        file_.create_text(parent, "FamilyName", "FamilyName_t", families[f]);
      else
        file_.create_text(parent, "AdditionalFamilyName" + std::to_string(f), "AdditionalFamilyName_t", families[f]);
  }

  void boundary(int z, double zone_id) {
    double zone_bc = 0;
    std::set<std::string> taken;
    for (auto const& patch : mesh_.patches) {
      // The two planes of a 2-D mesh are not in the file.
      if (patch.zone != z || (dimension_ == 2 && patch.range.extent(2) == 1)) continue;
      if (taken.empty()) zone_bc = file_.create(zone_id, "ZoneBC", "ZoneBC_t");
      bool const by_family = !patch.families.empty() && family_types_.at(patch.families.front()).size() == 1;
      double const id = file_.create_text(zone_bc, cgns::unique_name(taken, patch.name), "BC_t",
                                          by_family ? "FamilySpecified" : cgns::bc_type_of(patch));
      range(id, "PointRange", patch.range.begin, last_of(patch.range));
      family_names(id, patch.families);
    }
  }

  void interfaces(int z, double zone_id) {
    double connectivity = 0;
    std::set<std::string> taken;
    for (auto const& face : mesh_.interfaces) {
      if (face.zone != z) continue;
      if (taken.empty()) connectivity = file_.create(zone_id, "ZoneGridConnectivity", "ZoneGridConnectivity_t");
      auto const [own_base, own_name] = split(mesh_.zones[z].name);
      auto const [donor_base, donor_name] = split(mesh_.zones[face.donor_zone].name);
      double const id = file_.create_text(connectivity, cgns::unique_name(taken, face.name), "GridConnectivity1to1_t",
                                          own_base == donor_base ? donor_name : donor_base + "/" + donor_name);
      Index3 const last = last_of(face.range);
      range(id, "PointRange", face.range.begin, last);
      range(id, "PointRangeDonor", face.to_donor(face.range.begin), face.to_donor(last));
      std::vector<std::int32_t> transform;
      auto const& o = face.to_donor.orientation;
      for (int a = 0; a < dimension_; ++a) transform.push_back(o.sign[a] * (o.axis[a] + 1));
      file_.create(id, "Transform", "\"int[IndexDimension]\"", "I4", {dimension_}, transform.data());
      family_names(id, face.families);
      if (face.periodic) periodic(id, *face.periodic);
    }
  }

  void periodic(double connection, Periodic const& p) {
    double const property = file_.create(connection, "GridConnectivityProperty", "GridConnectivityProperty_t");
    double const id = file_.create(property, "Periodic", "Periodic_t");
    auto const vector = [&](char const* name, Vec3 const& v) {
      std::array<float, 3> const values{float(v.x), float(v.y), float(v.z)};
      file_.create(id, name, "DataArray_t", "R4", {physical_dimension_}, values.data());
    };
    vector("RotationCenter", p.rotation_center);
    vector("RotationAngle", p.rotation_angle_rad);
    vector("Translation", p.translation);
  }

  cgns::File& file_;
  Mesh const& mesh_;
  int dimension_ = 3;
  int physical_dimension_ = 3;
  std::map<std::string, double> bases_;
  std::map<std::string, std::set<std::string>> family_types_;  ///< BC types of the patches a family comes first for
};

/// The bytes that a file needs, more than it will take: both formats spend one to three kilobytes on a node and its
/// little data.
std::uint64_t bytes_needed(Mesh const& mesh) {
  std::uint64_t nodes = 16 + 3 * mesh.families.size();
  for (auto const& patch : mesh.patches) nodes += 4 + 3 * patch.families.size();
  for (auto const& face : mesh.interfaces) nodes += 9 + face.families.size();
  nodes += 9 * mesh.zones.size();
  return cgns::File::bytes_per_node * nodes + 3 * sizeof(double) * std::uint64_t(mesh.n_nodes());
}

}  // namespace

struct MeshFileWriter::State {
  std::string path;
  Mesh const& mesh;
  io::OutputFile target;
  cgns::File file;
  std::variant<MeshWriter, io::ElementZoneWriter> writer;
  std::vector<char> written;

  State(std::string const& p, Mesh const& m, WriteOptions const& options)
      : path(p),
        mesh(m),
        target(p),
        file(reserved(target, m), cgns::File::Mode::create, options.format),
        writer(writer_of(file, m, options)),
        written(m.zones.size(), 0) {
    std::visit([](auto& w) { w.begin(); }, writer);
  }

 private:
  static std::string const& reserved(io::OutputFile const& target, Mesh const& mesh) {
    target.reserve(mesh.is_structured() ? bytes_needed(mesh) : io::bytes_of_elements(mesh));
    return target.path();
  }
  static std::variant<MeshWriter, io::ElementZoneWriter> writer_of(cgns::File& file, Mesh const& mesh,
                                                                   WriteOptions const& options) {
    if (mesh.is_structured()) return MeshWriter(file, mesh, options);
    return io::ElementZoneWriter(file, mesh, options);
  }
};

MeshFileWriter::MeshFileWriter(std::string const& path, Mesh const& mesh, WriteOptions const& options) {
  if (options.physical_dimension != 2 && options.physical_dimension != 3)
    throw IoError(path + ": physical dimension " + std::to_string(options.physical_dimension) +
                  " cannot be written; choose 2 or 3");
  state_ = std::make_unique<State>(path, mesh, options);
}
MeshFileWriter::~MeshFileWriter() = default;

void MeshFileWriter::write_zone(int zone, double const* x, double const* y, double const* z) {
  if (std::exchange(state_->written.at(zone), 1) != 0)
    throw MeshError(state_->path + ": zone '" + state_->mesh.zones[zone].name + "' is written twice");
  std::visit([&](auto& writer) { writer.zone(zone, {x, y, z}); }, state_->writer);
}

void MeshFileWriter::commit() {
  for (std::size_t z = 0; z < state_->written.size(); ++z)
    if (state_->written[z] == 0)
      throw MeshError(state_->path + ": zone '" + state_->mesh.zones[z].name + "' is missing");
  state_->file.close();
  state_->target.commit();
}

void io::write_blocks(std::string const& path, Mesh const& mesh, WriteOptions const& options) {
  if (mesh.coordinates.size() != mesh.n_nodes())
    throw MeshError(path + ": the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, but coordinates of " +
                    std::to_string(mesh.coordinates.size()));
  MeshFileWriter writer(path, mesh, options);
  auto const& x = mesh.coordinates;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    Index const first = mesh.zones[z].first_node;
    writer.write_zone(int(z), x.x.data() + first, x.y.data() + first, x.z.data() + first);
  }
  writer.commit();
}

void write_mesh(std::string const& path, Mesh const& mesh, WriteOptions const& options) {
  if (mesh.is_structured()) return io::write_blocks(path, mesh, options);
  write_mesh(path, mesh, mesh.coordinates, {}, options);
}

}  // namespace gridmorph
