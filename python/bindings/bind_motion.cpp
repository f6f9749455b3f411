#include "objects.hpp"

#include <gridmorph/mapping/point_field.hpp>

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <numeric>
#include <span>

namespace gridmorph::python {

namespace {

using Strings = std::vector<std::string>;

PyMotion read(std::string const& path, ParameterValues const& values) {
  PyMotion out{Session::get(), {}};
  Call const call;
  out.file = read_case_file(std::filesystem::path(path), values);
  return out;
}

PyMotion parse(std::string const& text, std::string const& name) {
  PyMotion out{Session::get(), {}};
  Call const call;
  out.file = parse_case_file(text, name);
  return out;
}

ParameterValues parameters_of(PyMotion const& self) {
  ParameterValues out;
  for (Parameter const& p : self.file.parameters) out[p.name] = p.value;
  return out;
}

/// What the rules have, their amplitudes over time too, has one entry per rule.
void add(PyMotion& self, Strings patches, Rule rule, int rank, std::string where) {
  self.file.motion.rules.push_back({std::move(patches), std::move(rule), rank, std::move(where)});
  self.file.timed.emplace_back();
}

/// A Python object in C++ values that come and go without the interpreter's lock.
std::shared_ptr<nb::object> kept(nb::object object) {
  return {new nb::object(std::move(object)), [](nb::object* p) {
            nb::gil_scoped_acquire const held;
            delete p;
          }};
}

void add_function(PyMotion& self, Strings patches, nb::callable function, int rank) {
  auto const call = [f = kept(function)](std::span<Vec3 const> points, std::span<Vec3> displacement) {
    nb::gil_scoped_acquire const held;
    std::vector<Vec3> const copy(points.begin(), points.end());
    auto const u = as_vectors(nb::cast<Vectors>((*f)(as_array(copy))), "what the function of a rule returns");
    if (u.size() != points.size())
      throw MotionError("function of a rule: returns " + std::to_string(u.size()) + " displacements for " +
                        std::to_string(points.size()) + " points; return an array of the shape of its argument");
    std::copy(u.begin(), u.end(), displacement.begin());
  };
  add(self, std::move(patches), FunctionRule{"Python function", call}, rank, "rule of a Python function");
}

void add_field(PyMotion& self, Strings patches, Vectors const& points, Vectors const& displacement, int rank,
               double max_distance) {
  PointCloud cloud;
  cloud.source = "points of a rule";
  cloud.counted_in = ", point ";
  cloud.position = as_vectors(points, "points");
  cloud.displacement = as_vectors(displacement, "displacement");
  if (cloud.position.size() != cloud.displacement.size())
    throw ConfigError("points and displacement: " + std::to_string(cloud.position.size()) + " and " +
                      std::to_string(cloud.displacement.size()) + " rows; give one displacement for each point");
  cloud.line.resize(cloud.size());
  std::iota(cloud.line.begin(), cloud.line.end(), 0);
  FieldOptions options;
  options.max_distance = max_distance;
  auto const field = std::make_shared<PointField>(std::move(cloud), options);
  add(self, std::move(patches),
      FunctionRule{"field of " + std::to_string(field->size()) + " points",
                   [field](std::span<Vec3 const> p, std::span<Vec3> u) { (*field)(p, u); }},
      rank, "rule of points");
}

void add_rigid(PyMotion& self, Strings patches, std::vector<double> const& matrix,
               std::vector<double> const& translation, int rank) {
  if (matrix.size() != 9 || translation.size() != 3)
    throw ConfigError("rigid rule: matrix has 3 x 3 and translation 3 numbers, found " + std::to_string(matrix.size()) +
                      " and " + std::to_string(translation.size()));
  RigidRule rule;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rule.matrix.m[r][c] = matrix[3 * r + c];
  rule.translation = {translation[0], translation[1], translation[2]};
  add(self, std::move(patches), rule, rank, "rigid rule");
}

}  // namespace

void bind_motion(nb::module_& m) {
  nb::class_<PyMotion>(m, "Motion",
                       "Motion rules of a boundary, and how a mesh is planned for them: what a case file says.")
      .def(
          "__init__",
          [](PyMotion* self, nb::object tables, nb::kwargs more) {
            auto const text = nb::module_::import_("gridmorph").attr("_motion_text")(tables, more);
            new (self) PyMotion(parse(nb::cast<std::string>(text), "motion"));
          },
          nb::arg("tables").none() = nb::none(), nb::arg("more"),
          nb::sig(
              "def __init__(self, tables: typing.Mapping[str, typing.Any] | None = None, **more: typing.Any) -> None"),
          "Rules and options with the keys of case files (docs/case_file.md): {\"motion\": [{...}, ...], \"volume\": "
          "{...}, ...}, or tables as "
          "keywords.\n\nValues may be NumPy's. Further rules come by function(), field(), rigid() and prescribed(). "
          "Raises one ConfigError that "
          "lists every problem, by lines of the TOML text of the tables.")
      .def_static("_read", &read)
      .def_prop_ro("parameters", &parameters_of, "[parameters] of the case file, {name: value}.")
      .def("_function", &add_function)
      .def("_field", &add_field)
      .def("_rigid", &add_rigid)
      .def("_prescribed", [](PyMotion& self, Strings patches,
                             int rank) { add(self, std::move(patches), PrescribedRule{}, rank, "prescribed rule"); })
      .def_prop_ro(
          "input", [](PyMotion const& s) { return s.file.input.string(); }, "Mesh that the case file names.")
      .def_prop_ro(
          "output", [](PyMotion const& s) { return s.file.output.string(); }, "Output that it names, or ''.")
      .def(
          "copy", [](PyMotion const& s) { return s; }, "The same rules and options, for further ones to be added.")
      .def("__len__", [](PyMotion const& s) { return s.file.motion.rules.size(); })
      .def("__repr__", [](PyMotion const& s) {
        std::string text = "<gridmorph.Motion";
        for (auto const& rule : s.file.motion.rules) {
          text += "; " + std::string(rule_name(rule.rule)) + ":";
          for (auto const& p : rule.patches) text += " " + p;
        }
        return text + ">";
      });
}

}  // namespace gridmorph::python
