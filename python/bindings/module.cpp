#include "objects.hpp"

#include <gridmorph/core/text.hpp>
#include <gridmorph/version.hpp>

#include <Kokkos_Core.hpp>

#include <nanobind/stl/string.h>

#include <cmath>

namespace gridmorph::python {

void check_vectors(Vectors const& v, Index n, char const* name, bool written) {
  auto const refuse = [&](std::string const& found) {
    throw ConfigError(std::string(name) + ": must be an array of " +
                      (n < 0 ? "(n, 3)" : "(" + std::to_string(n) + ", 3)") + " of float64 or float32, found " + found);
  };
  if (v.shape(1) != 3 || (n >= 0 && Index(v.shape(0)) != n))
    refuse("(" + std::to_string(v.shape(0)) + ", " + std::to_string(v.shape(1)) + ")");
  if (v.dtype() != nb::dtype<double>() && v.dtype() != nb::dtype<float>()) refuse("another type of number");
  if (written && v.dtype() != nb::dtype<double>()) refuse("float32, which results are not written to");
  for (std::size_t d = 0; d < 2; ++d)
    if (v.shape(0) > 1 && v.stride(d) < 0) refuse("a negative stride; pass numpy.ascontiguousarray(...) of it");
}

void check_finite(Vectors const& v, char const* name) {
  auto const look = [&]<class T>(T const* data) {
    for (std::size_t n = 0; n < v.shape(0); ++n) {
      T const* const p = data + std::int64_t(n) * v.stride(0);
      Vec3 const x{double(p[0]), double(p[v.stride(1)]), double(p[2 * v.stride(1)])};
      if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z))
        throw ConfigError(std::string(name) + ": row " + std::to_string(n) + " is " + to_text(x, 6) +
                          "; all numbers must be finite");
    }
  };
  if (v.dtype() == nb::dtype<double>())
    look(static_cast<double const*>(v.data()));
  else
    look(static_cast<float const*>(v.data()));
}

std::vector<Vec3> as_vectors(Vectors const& v, char const* name) {
  check_vectors(v, -1, name);
  check_finite(v, name);
  std::vector<Vec3> out(v.shape(0));
  auto const fill = [&]<class T>(T const* data) {
    for (std::size_t n = 0; n < out.size(); ++n) {
      T const* const p = data + std::int64_t(n) * v.stride(0);
      out[n] = {double(p[0]), double(p[v.stride(1)]), double(p[2 * v.stride(1)])};
    }
  };
  if (v.dtype() == nb::dtype<double>())
    fill(static_cast<double const*>(v.data()));
  else
    fill(static_cast<float const*>(v.data()));
  return out;
}

}  // namespace gridmorph::python

NB_MODULE(_core, m) {
  using namespace gridmorph;
  namespace nb = nanobind;
  nb::set_leak_warnings(false);  // objects that live as long as the interpreter are no fault of their users
  m.doc() = "Explicit, interpolation-based morphing of CFD meshes: the compiled part of the package gridmorph.";
  m.attr("__version__") = gridmorph::version;
  m.attr("kokkos_version") = std::to_string(KOKKOS_VERSION / 10000) + "." + std::to_string(KOKKOS_VERSION / 100 % 100) +
                             "." + std::to_string(KOKKOS_VERSION % 100);
  auto const error = nb::exception<Error>(m, "Error", PyExc_RuntimeError);
  // The last one registered is asked first.
  nb::exception<MeshError>(m, "MeshError", error.ptr());
  nb::exception<MotionError>(m, "MotionError", error.ptr());
  nb::exception<PlanError>(m, "PlanError", error.ptr());
  nb::exception<ConfigError>(m, "ConfigError", error.ptr());
  nb::exception<IoError>(m, "IoError", error.ptr());
  nb::exception<MachineError>(m, "MachineError", error.ptr());
  m.def(
      "set_threads", [](int threads) { python::Session::get(threads); }, nb::arg("threads"),
      "Threads for all calls; before anything else is called. Default: OMP_NUM_THREADS, else all cores.\n\n"
      "Raises ConfigError where gridmorph runs on another number already.");
  python::bind_mesh(m);
  python::bind_motion(m);
  python::bind_plan(m);
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { python::Session::leave(); }));
}
