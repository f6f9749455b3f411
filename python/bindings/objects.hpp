// What the Python classes hold.
#pragma once

#include "session.hpp"

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <nanobind/ndarray.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph::python {

namespace nb = nanobind;

/// A mesh, alive as long as a plan or an array of its coordinates.
struct PyMesh {
  std::shared_ptr<Session> session;  // ends after what is below
  std::shared_ptr<Mesh> mesh;
};

struct PyMotion {
  std::shared_ptr<Session> session;
  CaseFile file;
};

/// (n, 3) of the caller: double or float, any strides, read or written in place.
using Vectors = nb::ndarray<nb::ndim<2>, nb::device::cpu>;

/// A new (n, 3) array of doubles, its memory Python's.
inline nb::ndarray<nb::numpy, double, nb::ndim<2>> new_vectors(Index n) {
  auto* const data = new double[3 * n];
  nb::capsule const owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::ndarray<nb::numpy, double, nb::ndim<2>>(data, {std::size_t(n), 3}, owner);
}

template <class T>
nb::ndarray<nb::numpy, T, nb::ndim<1>> new_numbers(std::vector<T> values) {
  auto* const kept = new std::vector<T>(std::move(values));
  nb::capsule const owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::ndarray<nb::numpy, T, nb::ndim<1>>(kept->data(), {kept->size()}, owner);
}

inline nb::ndarray<nb::numpy, double, nb::ndim<2>> as_array(std::vector<Vec3> const& values) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  auto out = new_vectors(Index(values.size()));
  if (!values.empty()) std::memcpy(out.data(), values.data(), values.size() * sizeof(Vec3));
  return out;
}

void check_vectors(Vectors const& v, Index n, char const* name, bool written = false);
/// Throws ConfigError that names the first row which is not finite. Cost: one pass.
void check_finite(Vectors const& v, char const* name);
/// Copies, in double; all of them finite.
std::vector<Vec3> as_vectors(Vectors const& v, char const* name);

void bind_elements(nb::class_<PyMesh>& mesh);
void bind_mesh(nb::module_& m);
void bind_motion(nb::module_& m);
void bind_plan(nb::module_& m);

}  // namespace gridmorph::python
