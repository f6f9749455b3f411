#include "objects.hpp"

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/quality/newly_inverted.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>
#include <gridmorph/report/quality_json.hpp>

#include <nlohmann/json.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

namespace gridmorph::python {

namespace {

using Strings = std::vector<std::string>;
using View1 = nb::ndarray<nb::numpy, double, nb::ndim<1>>;
using Owner = std::pair<std::shared_ptr<Session>, std::shared_ptr<Mesh>>;

/// Keeps the mesh, and Kokkos for it, as long as an array reads it.
nb::capsule owner_of(PyMesh const& self) {
  return nb::capsule(new Owner(self.session, self.mesh), [](void* p) noexcept {
    Owner* const owner = static_cast<Owner*>(p);
    owner->second.reset();
    delete owner;
  });
}

Coordinates::View const& component(Mesh const& mesh, int c) {
  return c == 0 ? mesh.coordinates.x : c == 1 ? mesh.coordinates.y : mesh.coordinates.z;
}

View1 component_array(PyMesh const& self, int c) {
  return View1(component(*self.mesh, c).data(), {std::size_t(self.mesh->n_nodes())}, owner_of(self));
}

PyMesh read(std::string const& path, std::optional<std::string> const& side_file, Strings const& leave_out) {
  PyMesh out{Session::get(), nullptr};
  Call const call;
  std::optional<std::filesystem::path> side;
  if (side_file) side = *side_file;
  out.mesh = std::make_shared<Mesh>(load_mesh(path, side, leave_out));
  return out;
}

Coordinates coordinates_from(Mesh const& mesh, Vectors const& v) {
  check_vectors(v, mesh.n_nodes(), "coordinates");
  auto const values = as_vectors(v, "coordinates");
  Coordinates out(mesh.n_nodes());
  for (Index n = 0; n < out.size(); ++n) out.set(n, values[n]);
  return out;
}

/// Throws ConfigError where a file cannot be written: one that the mesh was read from, one that is there already, or
/// one whose ending says something else than what it will be.
void check_output(PyMesh const& self, std::string const& path, bool overwrite, std::string const& format) {
  namespace fs = std::filesystem;
  Mesh const& mesh = *self.mesh;
  Call const call;
  std::error_code error;
  auto const refuse = [&](std::string const& why) { throw ConfigError("'" + path + "': " + why); };
  if (fs::exists(mesh.source, error)) {
    std::vector<std::string> inputs = look_at_mesh(mesh.source).linked;
    inputs.push_back(mesh.source);
    for (std::string const& input : inputs)
      if (fs::equivalent(input, path, error))
        refuse("the mesh was read from it; give another name, inputs are never overwritten");
  }
  if (auto const ending = format_of_ending(path); !ending.empty() && ending != format)
    refuse("its ending stands for " + std::string(ending) + ", and it is written as " + format +
           "; give it another ending");
  auto const folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::exists(folder, error)) refuse("the folder does not exist; make it first");
  if (!overwrite && fs::exists(path, error)) refuse("exists already; give another name, or overwrite=True");
}

/// As what write() writes a mesh.
std::string format_of(PyMesh const& self) {
  std::error_code error;
  Mesh const& mesh = *self.mesh;
  return std::string(
      to_string(std::filesystem::exists(mesh.source, error) ? mesh_format(mesh.source) : MeshFormat::cgns));
}

void write(PyMesh const& self, std::string const& path, std::optional<Vectors> const& coordinates) {
  Mesh const& mesh = *self.mesh;
  Call const call;
  Coordinates const moved = coordinates ? coordinates_from(mesh, *coordinates) : mesh.coordinates;
  if (std::filesystem::exists(mesh.source))
    write_morphed(mesh.source, path, mesh, moved);
  else
    write_mesh(path, mesh, moved, {});
}

void write_vtk_file(PyMesh const& self, std::string const& path, std::optional<Vectors> const& coordinates) {
  Call const call;
  OutputFields fields;
  fields.displacement = coordinates.has_value();
  write_vtk(path, *self.mesh, coordinates ? coordinates_from(*self.mesh, *coordinates) : self.mesh->coordinates,
            fields);
}

nb::list zones(PyMesh const& self) {
  nb::list out;
  Index first_cell = 0;
  for (Zone const& zone : self.mesh->zones) {
    nb::dict d;
    d["name"] = zone.name;
    d["shape"] =
        zone.is_block() ? nb::object(nb::make_tuple(zone.extent[0], zone.extent[1], zone.extent[2])) : nb::none();
    d["first_node"] = zone.first_node;
    d["n_nodes"] = zone.size();
    Index const n_cells = self.mesh->is_structured()
                              ? Index(zone.extent[0] - 1) * (zone.extent[1] - 1) * (zone.extent[2] - 1)
                              : zone.n_elements;
    d["first_cell"] = first_cell;
    d["n_cells"] = n_cells;
    first_cell += n_cells;
    out.append(d);
  }
  return out;
}

/// x, y and z of one block as (ni, nj, nk), of elements as (n,): the mesh's own numbers.
nb::tuple zone_coordinates(PyMesh const& self, int number) {
  Mesh const& mesh = *self.mesh;
  if (number < 0 || number >= int(mesh.zones.size()))
    throw nb::index_error(
        ("zone " + std::to_string(number) + ": the mesh has " + std::to_string(mesh.zones.size())).c_str());
  Zone const& zone = mesh.zones[number];
  auto const one = [&](int c) -> nb::object {
    double* const data = component(mesh, c).data() + zone.first_node;
    if (!zone.is_block()) return nb::cast(View1(data, {std::size_t(zone.size())}, owner_of(self)));
    std::size_t const shape[3] = {std::size_t(zone.extent[0]), std::size_t(zone.extent[1]),
                                  std::size_t(zone.extent[2])};
    std::int64_t const strides[3] = {1, zone.extent[0], std::int64_t(zone.extent[0]) * zone.extent[1]};
    return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<3>>(data, 3, shape, owner_of(self), strides));
  };
  return nb::make_tuple(one(0), one(1), one(2));
}

nb::list patches(PyMesh const& self) {
  nb::list out;
  for (Patch const& patch : self.mesh->patches) {
    nb::dict d;
    d["name"] = patch.name;
    d["bc_type"] = patch.bc_type;
    d["kind"] = std::string(to_string(patch.kind));
    d["families"] = patch.families;
    d["zone"] = patch.zone;
    out.append(d);
  }
  return out;
}

/// Corner nodes of the faces of a patch.
template <class Use>
void each_face(Mesh const& mesh, Patch const& patch, Use const& use) {
  if (!mesh.zones[patch.zone].is_block() || patch.faces.size() > 0) {
    for (Index f = 0; f < patch.faces.size(); ++f) {
      auto const face = patch.faces[f];
      use(std::vector<std::int64_t>(face.begin(), face.end()));
    }
    return;
  }
  Zone const& zone = mesh.zones[patch.zone];
  int normal = 0;
  while (normal < 2 && patch.range.end[normal] - patch.range.begin[normal] != 1) ++normal;
  int const a = (normal + 1) % 3, b = (normal + 2) % 3;
  for (int q = patch.range.begin[b]; q + 1 < patch.range.end[b]; ++q)
    for (int p = patch.range.begin[a]; p + 1 < patch.range.end[a]; ++p) {
      std::vector<std::int64_t> face;
      for (auto const& [dp, dq] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        Index3 at = patch.range.begin;
        at[a] = p + dp;
        at[b] = q + dq;
        face.push_back(zone.node(at));
      }
      use(face);
    }
}

std::vector<std::int64_t> nodes_of(Mesh const& mesh, Strings const& selectors) {
  std::set<std::int64_t> found;
  for (int const p : select_patches(mesh, selectors)) {
    Patch const& patch = mesh.patches[p];
    found.insert(patch.nodes.begin(), patch.nodes.end());
    if (patch.faces.size() == 0 && patch.nodes.empty()) {  // blocks: of faces collapsed to lines too
      Zone const& zone = mesh.zones[patch.zone];
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) found.insert(zone.node({i, j, k}));
    }
    each_face(mesh, patch, [&](std::vector<std::int64_t> const& face) { found.insert(face.begin(), face.end()); });
  }
  return {found.begin(), found.end()};
}

nb::tuple facets(PyMesh const& self, Strings const& selectors) {
  std::vector<std::int64_t> offsets{0}, nodes;
  for (int const p : select_patches(*self.mesh, selectors))
    each_face(*self.mesh, self.mesh->patches[p], [&](std::vector<std::int64_t> const& face) {
      nodes.insert(nodes.end(), face.begin(), face.end());
      offsets.push_back(std::int64_t(nodes.size()));
    });
  return nb::make_tuple(new_numbers(std::move(offsets)), new_numbers(std::move(nodes)));
}

/// Of other coordinates, against the mesh, where there are any.
QualityReport measured(Mesh const& mesh, std::optional<Coordinates> const& moved, bool fast,
                       CellFields<Kokkos::HostSpace> const& fields) {
  Kokkos::DefaultHostExecutionSpace const exec;
  std::vector<int> walls;
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (mesh.patches[p].kind == PatchKind::wall) walls.push_back(p);
  QualityReport report;
  auto const measure = [&](auto input, auto const& of) {
    input.coordinates = views(moved ? *moved : mesh.coordinates);
    if (moved) input.baseline = views(mesh.coordinates);
    input.fast = fast;
    input.fields = fields;
    report = of(input);
  };
  if (mesh.is_structured()) {
    QualityInput<Kokkos::HostSpace> input;
    input.walls = wall_faces(mesh, walls);
    measure(input, [&](auto const& i) { return measure_quality(exec, mesh, i); });
    if (moved) report.certificate = certify(exec, mesh, {views(*moved), views(mesh.coordinates)});
  } else {
    auto const topology = make_topology(mesh);
    auto const face_patches = find_face_patches(mesh, topology);
    UnstructuredQualityInput<Kokkos::HostSpace> input;
    input.walls = walls;
    measure(input, [&](auto const& i) { return measure_quality(exec, mesh, topology, face_patches, i); });
    if (moved) report.certificate = certify(exec, mesh, topology, {views(*moved), views(mesh.coordinates)});
  }
  return report;
}

/// Cells of other coordinates that are inverted and were not in the mesh.
Index newly_inverted_by(PyMesh const& self, Vectors const& coordinates) {
  Call const call;
  return newly_inverted(measured(*self.mesh, coordinates_from(*self.mesh, coordinates), true, {}));
}

/// The report as JSON text, which the package reads; and the measures cell by cell.
std::pair<std::string, nb::dict> quality(PyMesh const& self, std::optional<Vectors> const& coordinates, bool fast,
                                         bool cells) {
  constexpr std::array wanted{Measure::aspect_ratio, Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                              Measure::equiangle_skewness};
  Mesh const& mesh = *self.mesh;
  nlohmann::json json;
  std::vector<std::vector<double>> values;
  {
    Call const call;
    std::optional<Coordinates> moved;
    if (coordinates) moved = coordinates_from(mesh, *coordinates);
    CellFields<Kokkos::HostSpace> fields;
    Index const n_cells = mesh.is_structured() ? mesh.n_cells() : mesh.n_elements();
    if (cells)
      for (Measure const m : wanted) {
        values.emplace_back(std::size_t(n_cells));
        fields[m] = Kokkos::View<double*, Kokkos::HostSpace>("gridmorph::quality", std::size_t(n_cells));
      }
    QualityReport const report = measured(mesh, moved, fast && !cells, fields);
    json = report;
    json["cells"] = report.cells();
    json["inverted"] = report.near_field.inverted + report.far_field.inverted;
    if (report.certificate) json["certificate"] = certificate_json(report);
    for (std::size_t m = 0; m < values.size(); ++m)
      std::copy_n(fields[wanted[m]].data(), values[m].size(), values[m].begin());
  }
  nb::dict arrays;
  for (std::size_t m = 0; m < values.size(); ++m)
    arrays[std::string(to_string(wanted[m])).c_str()] = new_numbers(std::move(values[m]));
  return {json.dump(), arrays};
}

/// Zones of nodes as they come: first index fastest in the mesh, whatever the strides of the array are.
PyMesh from_blocks(
    std::vector<std::pair<std::string, nb::ndarray<double, nb::ndim<4>, nb::device::cpu>>> const& blocks) {
  PyMesh out{Session::get(), std::make_shared<Mesh>()};
  Mesh& mesh = *out.mesh;
  mesh.source = "NumPy arrays";
  for (auto const& [name, a] : blocks) {
    if (a.shape(3) != 3 || a.shape(0) < 2 || a.shape(1) < 2 || a.shape(2) < 2)
      throw MeshError("block '" + name +
                      "': must be an array of (ni, nj, nk, 3), at least 2 nodes along i, j and k, found (" +
                      std::to_string(a.shape(0)) + ", " + std::to_string(a.shape(1)) + ", " +
                      std::to_string(a.shape(2)) + ", " + std::to_string(a.shape(3)) + ")");
    mesh.add_zone(name, {int(a.shape(0)), int(a.shape(1)), int(a.shape(2))});
  }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t z = 0; z < blocks.size(); ++z) {
    auto const& a = blocks[z].second;
    Zone const& zone = mesh.zones[z];
    for (Index n = 0; n < zone.size(); ++n) {
      Index3 const p = zone.index(zone.first_node + n);
      double const* const at = a.data() + p[0] * a.stride(0) + p[1] * a.stride(1) + p[2] * a.stride(2);
      Vec3 const x{at[0], at[a.stride(3)], at[2 * a.stride(3)]};
      if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z))
        throw MeshError("block '" + blocks[z].first + "': node [" + std::to_string(p[0]) + ", " + std::to_string(p[1]) +
                        ", " + std::to_string(p[2]) + "] is at " + to_text(x, 6) + "; all numbers must be finite");
      mesh.coordinates.set(zone.first_node + n, x);
    }
  }
  return out;
}

void add_side_text(PyMesh& self, std::string const& text, std::string const& name) {
  Call const call;
  add_side_file(text, name, *self.mesh);
}

std::vector<std::string> match(PyMesh& self, double tolerance, bool periodic) {
  Call const call;
  auto found = find_interfaces(*self.mesh, {.tolerance = tolerance, .periodic = periodic});
  self.mesh->interfaces.insert(self.mesh->interfaces.end(), found.interfaces.begin(), found.interfaces.end());
  return found.notes;
}

}  // namespace

void bind_mesh(nb::module_& m) {
  nb::class_<PyMesh> mesh(
      m, "Mesh", "A mesh of blocks or of elements as it stands in a file, numbered as the file numbers it, from 0.");
  mesh.def_static("_read", &read)
      .def_static("_from_blocks", &from_blocks)
      .def("_add_side_text", &add_side_text)
      .def("_check_output", &check_output, nb::arg("path"), nb::arg("overwrite"), nb::arg("format"))
      .def("_format", &format_of)
      .def("_newly_inverted", &newly_inverted_by, nb::arg("coordinates"))
      .def("_write", &write, nb::arg("path"), nb::arg("coordinates").none())
      .def("_write_vtk", &write_vtk_file, nb::arg("path"), nb::arg("coordinates").none())
      .def("_quality", &quality, nb::arg("coordinates").none(), nb::arg("fast"), nb::arg("cells"))
      .def("match", &match, nb::arg("tolerance") = 0.01, nb::arg("periodic") = true,
           "Adds the interfaces of blocks, periodic ones too, that coincident nodes say. Returns what was decided on "
           "the way.\n\n"
           "tolerance: share of the smallest edge. Cost: O(surface cells).")
      .def_prop_ro("n_nodes", [](PyMesh const& s) { return s.mesh->n_nodes(); })
      .def_prop_ro("n_cells",
                   [](PyMesh const& s) { return s.mesh->is_structured() ? s.mesh->n_cells() : s.mesh->n_elements(); })
      .def_prop_ro("is_structured", [](PyMesh const& s) { return s.mesh->is_structured(); })
      .def_prop_ro("dimension", [](PyMesh const& s) { return s.mesh->dimension; })
      .def_prop_ro("source", [](PyMesh const& s) { return s.mesh->source; })
      .def_prop_ro(
          "notes", [](PyMesh const& s) { return s.mesh->notes; }, "What the reader skipped or assumed.")
      .def_prop_ro("families", [](PyMesh const& s) { return s.mesh->families; })
      .def_prop_ro("zones", &zones, nb::sig("def zones(self) -> list[dict[str, typing.Any]]"),
                   "One dict per zone: name, shape (ni, nj, nk; None for elements), first_node, "
                   "n_nodes, first_cell, n_cells.")
      .def_prop_ro("patches", &patches, nb::sig("def patches(self) -> list[dict[str, typing.Any]]"),
                   "One dict per boundary condition: name, bc_type, kind, families, zone.")
      .def_prop_ro(
          "x", [](PyMesh const& s) { return component_array(s, 0); }, nb::rv_policy::reference,
          "(n_nodes,) [length], no copy.")
      .def_prop_ro(
          "y", [](PyMesh const& s) { return component_array(s, 1); }, nb::rv_policy::reference,
          "(n_nodes,) [length], no copy.")
      .def_prop_ro(
          "z", [](PyMesh const& s) { return component_array(s, 2); }, nb::rv_policy::reference,
          "(n_nodes,) [length], no copy.")
      .def("zone_coordinates", &zone_coordinates, nb::arg("zone"),
           nb::sig("def zone_coordinates(self, zone: int) -> tuple[numpy.typing.NDArray[numpy.float64], "
                   "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]"),
           "x, y, z of a zone without a copy: (ni, nj, nk) of a block, (n,) of elements.")
      .def(
          "nodes_of",
          [](PyMesh const& s, Strings const& selectors) { return new_numbers(nodes_of(*s.mesh, selectors)); },
          nb::arg("patches"),
          "Nodes of the patches that selectors name, ascending, (n,) int64. Raises MotionError where one names none.")
      .def(
          "patch_numbers",
          [](PyMesh const& s, Strings const& selectors) {
            auto const numbers = select_patches(*s.mesh, selectors);
            return new_numbers(std::vector<std::int64_t>(numbers.begin(), numbers.end()));
          },
          nb::arg("patches"),
          "(k,) int64: places in `patches` of those that selectors name, ascending. Raises MotionError where one names "
          "none.")
      .def("facets", &facets, nb::arg("patches"),
           nb::sig("def facets(self, patches: typing.Sequence[str]) -> tuple[numpy.typing.NDArray[numpy.int64], "
                   "numpy.typing.NDArray[numpy.int64]]"),
           "Faces of patches: (offsets, nodes), face f having nodes[offsets[f]:offsets[f + 1]] around it.")
      .def("__repr__", [](PyMesh const& s) {
        return "<gridmorph.Mesh '" + s.mesh->source + "': " + std::to_string(s.mesh->zones.size()) + " zones, " +
               std::to_string(s.mesh->n_nodes()) + " nodes>";
      });
  bind_elements(mesh);
}

}  // namespace gridmorph::python
