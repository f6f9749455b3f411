#include "objects.hpp"

#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/morph/design_modes.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/morph/plan_share.hpp>
#include <gridmorph/quality/design_box.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <set>
#include <utility>

namespace gridmorph::python {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Result = nb::object;

/// Morphs on the host's threads, of a plan or of a share of one. Arrays for boundary displacements are the caller's,
/// read where they lie.
class PyMorphs {
 public:
  [[nodiscard]] Index n_nodes() const { return n_nodes_; }
  [[nodiscard]] Index n_boundary() const { return Index(boundary_nodes_.size()); }
  [[nodiscard]] std::vector<std::int64_t> const& boundary_nodes() const { return boundary_nodes_; }
  [[nodiscard]] virtual std::vector<Vec3> const& rules() const = 0;

  Result positions(std::optional<Vectors> const& u, std::optional<Vectors> const& out) {
    return with_result(out, n_nodes(), [&](Out const& moved) {
      with_boundary(u, [&](In const& b) { morpher_->positions(exec_, b, moved); });
    });
  }
  Result displacements(std::optional<Vectors> const& u, std::optional<Vectors> const& out) {
    return with_result(out, n_nodes(), [&](Out const& d) {
      with_boundary(u, [&](In const& b) { morpher_->displacements(exec_, b, d); });
    });
  }
  Result velocities(Vectors const& rate, std::optional<Vectors> const& u, std::optional<Vectors> const& out) {
    check_vectors(rate, n_boundary(), "rate");
    check_finite(rate, "rate");
    return with_result(out, n_nodes(), [&](Out const& v) {
      with_boundary(u, [&](In const& b) { read(rate, [&](In const& r) { morpher_->velocities(exec_, b, r, v); }); });
    });
  }
  Result transpose(Vectors const& gradient, std::optional<Vectors> const& u, std::optional<Vectors> const& out) {
    check_vectors(gradient, n_nodes(), "gradient");
    check_finite(gradient, "gradient");
    return with_result(out, n_boundary(), [&](Out const& g) {
      with_boundary(u, [&](In const& b) { read(gradient, [&](In const& d) { morpher_->transpose(exec_, b, d, g); }); });
    });
  }

 protected:
  PyMorphs() = default;
  ~PyMorphs() = default;

  using Memory = Exec::memory_space;
  using In = ConstVectorView<Memory>;
  using Out = VectorView<Memory>;
  template <class T>
  using Strided = Kokkos::View<T* [3], Kokkos::LayoutStride, Memory, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

  template <class T>
  static Strided<T> strided(Vectors const& v) {
    return Strided<T>(static_cast<T*>(v.data()),
                      Kokkos::LayoutStride(v.shape(0), std::size_t(v.stride(0)), 3, std::size_t(v.stride(1))));
  }

  template <class Use>
  static void read(Vectors const& v, Use const& use) {
    if (v.dtype() == nb::dtype<double>())
      use(In(strided<double>(v)));
    else
      use(In(strided<float>(v)));
  }

  /// The caller's displacement, or that of the rules.
  template <class Use>
  void with_boundary(std::optional<Vectors> const& u, Use const& use) const {
    if (u) return read(*u, use);
    auto const& given = rules();
    use(In(Kokkos::View<Vec3 const*, Memory, Kokkos::MemoryTraits<Kokkos::Unmanaged>>(given.data(), given.size())));
  }

  /// `out` or a new array, filled without the interpreter's lock.
  template <class Fill>
  Result with_result(std::optional<Vectors> const& given, Index n, Fill const& fill) const {
    if (given) {
      check_vectors(*given, n, "out", true);
      in_call([&] { fill(Out(strided<double>(*given))); });
      return nb::cast(*given);
    }
    auto made = new_vectors(n);
    in_call([&] {
      fill(Out(Kokkos::View<double* [3], Kokkos::LayoutRight, Memory, Kokkos::MemoryTraits<Kokkos::Unmanaged>>(
          made.data(), std::size_t(n))));
    });
    return nb::cast(made);
  }
  template <class Do>
  void in_call(Do const& work) const {
    Call const call;
    work();
    exec_.fence();
  }

  /// How nodes follow: a plan, or a share, and the baseline.
  template <class PlanOrShare>
  void set(PlanOrShare const& plan, Coordinates const& baseline) {
    n_nodes_ = plan.n_nodes();
    for (Index const n : plan.boundary_nodes()) boundary_nodes_.push_back(n);
    morpher_.emplace(exec_, plan, baseline, MorpherOptions{.velocity = true, .transpose = true});
  }

  std::shared_ptr<Session> session_ = Session::get();  // first: the last to go
  Exec exec_;
  std::optional<Morpher<Exec>> morpher_;
  std::vector<std::int64_t> boundary_nodes_;
  Index n_nodes_ = 0;
};

/// The share of some boxes of nodes, with their baseline: what a process of many has of a plan.
class PyShare : public PyMorphs {
 public:
  PyShare(PlanShare share, Coordinates baseline) : share_(std::move(share)), baseline_(std::move(baseline)) {
    Call const call;
    set(share_, baseline_);
  }
  [[nodiscard]] std::vector<Vec3> const& rules() const override { return share_.boundary_displacement(); }

  /// (share, x, y, z) as bytes, for pickle.
  [[nodiscard]] nb::tuple state() const {
    auto const bytes = [](void const* data, std::size_t n) { return nb::bytes(data, n); };
    auto const component = [&](auto const& c) { return bytes(c.data(), c.extent(0) * sizeof(double)); };
    Bytes const share = share_.to_bytes();
    return nb::make_tuple(bytes(share.data(), share.size()), component(baseline_.x), component(baseline_.y),
                          component(baseline_.z));
  }
  static void from_state(PyShare* self, nb::tuple const& state) {
    auto const part = [&](std::size_t k) { return nb::cast<nb::bytes>(state[k]); };
    auto const session = Session::get();  // a process may have nothing else of the package
    nb::bytes const share = part(0);
    Coordinates x(Index(part(1).size() / sizeof(double)));
    for (auto const& [k, to] : {std::pair<std::size_t, double*>{1, x.x.data()}, {2, x.y.data()}, {3, x.z.data()}})
      if (x.size() > 0) std::memcpy(to, part(k).data(), std::size_t(x.size()) * sizeof(double));
    auto const* const first = static_cast<std::byte const*>(share.data());
    new (self) PyShare(PlanShare::from_bytes({first, share.size()}), std::move(x));
  }

 private:
  PlanShare share_;
  Coordinates baseline_;
};

class PyPlan : public PyMorphs {
 public:
  PyPlan(PyMesh const& mesh, PyMotion const& motion, bool freeze) : mesh_(mesh.mesh) {
    Call const call;
    HostInstance const host;
    plan_.emplace(host, *mesh_, motion.file.motion, motion.file.plan);
    if (freeze) {
      std::vector<std::vector<Vec3>> const once{plan_->boundary_displacement()};
      plan_ = freeze_guard(host, IndexedMesh(host, *mesh_), *plan_, once);
    }
    set(*plan_, mesh_->coordinates);
    notes_ = motion.file.notes;
    look_for_missing_rules(motion.file.motion);
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> out = notes_;
    for (auto const& note : plan_->notes()) out.push_back(note);
    return out;
  }
  /// Patches that no rule names and that share nodes with prescribed ones: cells between will be torn.
  [[nodiscard]] std::string const& warning() const { return warning_; }
  /// Row of u, node of the mesh, patch, rotation: one of each for every place.
  [[nodiscard]] nb::tuple places() const {
    auto const found = plan_->boundary_places();
    std::vector<std::int64_t> row, node, patch;
    std::vector<double> rotation;
    for (BoundaryPlace const& place : found) {
      Zone const& zone = mesh_->zones[place.zone];
      row.push_back(place.boundary_node);
      node.push_back(zone.is_block() ? zone.node(place.index) : zone.first_node + place.index[0]);
      patch.push_back(place.patch);
      for (auto const& line : place.rotation.m) rotation.insert(rotation.end(), std::begin(line), std::end(line));
    }
    return nb::make_tuple(new_numbers(std::move(row)), new_numbers(std::move(node)), new_numbers(std::move(patch)),
                          nb::cast(new_numbers(std::move(rotation))).attr("reshape")(-1, 3, 3));
  }
  [[nodiscard]] std::vector<Vec3> const& rules() const override { return plan_->boundary_displacement(); }
  [[nodiscard]] std::vector<Vec3> rules(PyMotion const& motion) const {
    Call const call;
    return plan_->boundary_displacement(motion.file.motion);
  }

  [[nodiscard]] std::vector<Vec3> control_point_gradient(int rule, Vectors const& gradient) const {
    check_vectors(gradient, n_boundary(), "gradient");
    auto const dJ_db = as_vectors(gradient, "gradient");
    Call const call;
    return ffd_gradient(*plan_, rule, dJ_db);
  }

  /// motion(p): a Motion for parameters p.
  [[nodiscard]] nb::dict certify(nb::callable const& motion, std::vector<double> const& low,
                                 std::vector<double> const& high, double limit) const {
    auto const rules = [&](std::span<double const> p) {
      nb::gil_scoped_acquire const held;
      return nb::cast<PyMotion>(motion(nb::cast(new_numbers(std::vector<double>(p.begin(), p.end()))))).file.motion;
    };
    DesignBox found;
    {
      Call const call;
      HostInstance const host;
      DesignModes const modes = design_modes(*plan_, mesh_->coordinates, rules, low, high);
      DesignBoxOptions options;
      options.limit = limit;
      found = certify_designs(host, IndexedMesh(host, *mesh_), modes, options);
    }
    nb::dict out;
    out["holds"] = found.holds();
    out["certified"] = found.certified;
    out["broken"] = found.broken;
    out["design"] = nb::none();
    if (!found.design.empty()) {
      std::vector<double> p;
      for (std::size_t i = 0; i < low.size(); ++i)
        p.push_back(0.5 * (low[i] + high[i]) + 0.5 * found.design[i] * (high[i] - low[i]));
      out["design"] = nb::cast(new_numbers(std::move(p)));
    }
    out["worst"] = nb::none();
    if (found.zone >= 0) out["worst"] = nb::make_tuple(mesh_->zones[found.zone].name, found.cell);
    out["cells"] = found.cells;
    out["negative"] = found.negative;
    out["flat"] = found.flat;
    return out;
  }

  /// Seconds of displacements() as a C++ program calls it, on arrays of its own: what calls from Python are measured
  /// against.
  [[nodiscard]] std::vector<double> native_times(int repeats) const {
    Call const call;
    Kokkos::View<double* [3], Kokkos::LayoutRight, Memory> const u("gridmorph::python::u", std::size_t(n_boundary()));
    Kokkos::View<double* [3], Kokkos::LayoutRight, Memory> const d("gridmorph::python::d", std::size_t(n_nodes()));
    In const in(u);
    Out const out(d);
    std::vector<double> seconds;
    for (int r = 0; r < repeats; ++r) {
      Kokkos::Timer const timer;
      morpher_->displacements(exec_, in, out);
      exec_.fence();
      seconds.push_back(timer.seconds());
    }
    return seconds;
  }

  /// Of boxes of nodes: zone, first and one past the last i, j, k.
  [[nodiscard]] std::unique_ptr<PyShare> share(std::vector<std::array<int, 7>> const& boxes) const {
    std::vector<NodeBox> asked;
    for (auto const& [z, i0, j0, k0, i1, j1, k1] : boxes) asked.push_back({z, {{i0, j0, k0}, {i1, j1, k1}}});
    auto [own, x] = share_and_baseline(asked);
    return std::make_unique<PyShare>(std::move(own), std::move(x));  // a call of its own
  }

 private:
  [[nodiscard]] std::pair<PlanShare, Coordinates> share_and_baseline(std::vector<NodeBox> const& boxes) const {
    Call const call;
    PlanShare own = gridmorph::share({}, *plan_, *mesh_, boxes);
    Coordinates x(own.n_nodes());
    Index n = 0;
    for (NodeBox const& box : boxes)
      for_each_node(mesh_->zones[box.zone], box.nodes, [&](Index node) { x.set(n++, mesh_->coordinates[node]); });
    return {std::move(own), std::move(x)};
  }
  void look_for_missing_rules(Motion const& motion) {
    ResolvedMotion const resolved = resolve(*mesh_, motion);
    std::vector<char> prescribed(boundary_nodes_.size(), 0);
    auto const places = plan_->boundary_places();
    auto const each = [&](auto const& use) {
      for (BoundaryPlace const& place : places)
        if (place.patch >= 0 && std::size_t(place.patch) < resolved.patch.size() &&
            resolved.patch[place.patch].rule >= 0)
          use(place, resolved.patch[place.patch]);
    };
    each([&](BoundaryPlace const& place, Resolution const& own) {
      if (std::holds_alternative<PrescribedRule>(resolved.rules[own.rule].rule)) prescribed[place.boundary_node] = 1;
    });
    std::set<std::string> names;
    each([&](BoundaryPlace const& place, Resolution const& own) {
      Patch const& patch = mesh_->patches[place.patch];
      if (own.by_default && prescribed[place.boundary_node] != 0)
        names.insert(patch.families.empty() ? patch.name : patch.families.front());
    });
    if (names.empty()) return;
    warning_ = "no rule names " + quote_list({names.begin(), names.end()}) +
               ", where prescribed patches end: all their other nodes stay where they are. Give them rules, such as "
               "{\"patches\": ..., \"rule\": \"slip\", \"surface\": \"revolution\"} (or \"plane\", \"baseline\"), or "
               "\"fixed\" where that is meant";
  }

  std::shared_ptr<Mesh> mesh_;
  std::optional<MorphPlan> plan_;
  std::vector<std::string> notes_;  ///< of the rules
  std::string warning_;
};

void check_boundary(PyMorphs const& plan, std::optional<Vectors> const& u) {
  if (!u) return;
  check_vectors(*u, plan.n_boundary(), "u");
  check_finite(*u, "u");
}

using PlanClass = nb::class_<PyPlan>;

/// Binds how a plan is made.
void bind_construction(PlanClass& plan) {
  plan.def(
      "__init__",
      [](PyPlan* self, PyMesh const& mesh, PyMotion const& motion, bool freeze_guard) {
        new (self) PyPlan(mesh, motion, freeze_guard);
        if (self->warning().empty() || PyErr_WarnEx(PyExc_UserWarning, self->warning().c_str(), 1) == 0) return;
        self->~PyPlan();
        throw nb::python_error();
      },
      nb::arg("mesh"), nb::arg("motion"), nb::kw_only(), nb::arg("freeze_guard") = false,
      "Connects the zones, checks boundary and rules, plans. Raises MeshError, MotionError, PlanError; warns "
      "where prescribed patches end on others that no rule names.\n\n"
      "freeze_guard: what smoothing does to the rules' morph becomes a linear part of all morphs.");
}

/// Binds the nodes whose displacement is given, of plans and of shares.
template <class Class>
void bind_nodes(Class& plan) {
  using Self = typename Class::Type;
  plan.def_prop_ro("n_nodes", [](Self const& p) { return p.n_nodes(); })
      .def_prop_ro(
          "boundary_nodes", [](Self const& p) { return new_numbers(p.boundary_nodes()); }, nb::rv_policy::reference,
          "(m,) int64: nodes whose displacement is given, in the order of u.")
      .def_prop_ro(
          "boundary_displacement", [](Self const& p) { return as_array(p.rules()); }, nb::rv_policy::reference,
          "(m, 3): what the rules give them [length].");
}

/// Binds what else a plan says of its boundary.
void bind_boundary(PlanClass& plan) {
  plan.def(
          "_native_times", [](PyPlan const& p, int repeats) { return new_numbers(p.native_times(repeats)); },
          nb::arg("repeats"))
      .def_prop_ro("notes", &PyPlan::notes, "Defaults taken and facts found.")
      .def_prop_ro("boundary_places", &PyPlan::places,
                   nb::sig("def boundary_places(self) -> tuple[numpy.typing.NDArray[numpy.int64], "
                           "numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.int64], "
                           "numpy.typing.NDArray[numpy.float64]]"),
                   "Where the rows of u lie: (row, node, patch, rotation), one entry for each patch that has the node "
                   "and an explicit rule.\n\n"
                   "row, node, patch: (k,) int64; nodes that coincide in several zones are one row and several "
                   "entries. patch: number in Mesh.patches, -1 of a periodic connection. rotation (k, 3, 3): "
                   "displacement of the row -> that of a periodic copy, else the identity.")
      .def(
          "boundary_displacement_of", [](PyPlan const& p, PyMotion const& motion) { return as_array(p.rules(motion)); },
          nb::arg("motion"),
          "(m, 3): what other rules of the same patches give them. Nothing is planned. Raises MotionError.");
}

/// Binds what follows from displacements of the boundary.
template <class Class>
void bind_morphs(Class& plan) {
  using Self = typename Class::Type;
  plan.def(
          "positions",
          [](Self& p, std::optional<Vectors> u, std::optional<Vectors> out) {
            check_boundary(p, u);
            return p.positions(u, out);
          },
          nb::arg("u").none() = nb::none(), nb::kw_only(), nb::arg("out").none() = nb::none(),
          nb::sig(
              "def positions(self, u: numpy.typing.ArrayLike | None = None, *, out: numpy.typing.ArrayLike | None = "
              "None) -> numpy.typing.NDArray[numpy.float64]"),
          "(n, 3): x + displacements(u) of every node [length].")
      .def(
          "displacements",
          [](Self& p, std::optional<Vectors> u, std::optional<Vectors> out) {
            check_boundary(p, u);
            return p.displacements(u, out);
          },
          nb::arg("u").none() = nb::none(), nb::kw_only(), nb::arg("out").none() = nb::none(),
          nb::sig("def displacements(self, u: numpy.typing.ArrayLike | None = None, *, out: numpy.typing.ArrayLike | "
                  "None = None) -> numpy.typing.NDArray[numpy.float64]"),
          "(n, 3): displacement of every node [length].")
      .def(
          "velocities",
          [](Self& p, Vectors rate, std::optional<Vectors> u, std::optional<Vectors> out) {
            check_boundary(p, u);
            return p.velocities(rate, u, out);
          },
          nb::arg("rate"), nb::arg("u").none() = nb::none(), nb::kw_only(), nb::arg("out").none() = nb::none(),
          nb::sig("def velocities(self, rate: numpy.typing.ArrayLike, u: numpy.typing.ArrayLike | None = None, *, out: "
                  "numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]"),
          "(n, 3): derivative of displacements() at u in the direction `rate` [length / time], exact.");
  plan.def(
      "transpose",
      [](Self& p, Vectors gradient, std::optional<Vectors> u, std::optional<Vectors> out) {
        check_boundary(p, u);
        return p.transpose(gradient, u, out);
      },
      nb::arg("gradient"), nb::arg("u").none() = nb::none(), nb::kw_only(), nb::arg("out").none() = nb::none(),
      nb::sig("def transpose(self, gradient: numpy.typing.ArrayLike, u: numpy.typing.ArrayLike | None = None, *, "
              "out: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]"),
      "(m, 3): dJ/du of the boundary nodes from `gradient` = dJ/dx of all nodes (n, 3), at u: the exact transpose "
      "of velocities().");
}

/// Binds derivatives by control points, and boxes of designs.
void bind_gradients(PlanClass& plan) {
  plan.def(
      "certify", &PyPlan::certify, nb::arg("motion"), nb::arg("low"), nb::arg("high"), nb::arg("limit") = 1.0,
      nb::sig("def certify(self, motion: typing.Callable[[numpy.typing.NDArray[numpy.float64]], Motion], low: "
              "typing.Sequence[float], high: typing.Sequence[float], limit: float = 1.0) -> dict[str, typing.Any]"),
      "In how much of the box low <= p <= high every mesh of the motions motion(p) is valid, all of them at once.\n\n"
      "{\"certified\": share of the box about its middle, up to `limit`, in which no cell of any design is inverted "
      "anywhere; \"holds\": whether that is all of it; \"broken\": the share at which a design is known that breaks a "
      "cell, inf: none; \"design\": its parameters; \"worst\": (zone, its cell or (element, 0, 0), from 0); \"cells\"; "
      "\"negative\", \"flat\": cells that are not valid, or without volume, in the mesh itself, and are left out}. Meshes "
      "have "
      "to be linear in p, or a ConfigError says where they are not. Cost: 3 k + 17 morphs, and microseconds per cell.");
  plan.def(
      "ffd_gradient",
      [](PyPlan const& p, int rule, Vectors gradient) { return as_array(p.control_point_gradient(rule, gradient)); },
      nb::arg("rule"), nb::arg("gradient"),
      nb::sig("def ffd_gradient(self, rule: int, gradient: numpy.typing.ArrayLike) -> "
              "numpy.typing.NDArray[numpy.float64]"),
      "(k, 3): dJ/dd of the control points of rule number `rule` of the motion, an ffd rule, from `gradient` = "
      "dJ/du "
      "(m, 3) as transpose() returns it. i fastest: .reshape(n_k, n_j, n_i, 3).\n\n"
      "Exact, as u is linear in d; zero for control points that a face of the lattice holds. Raises ConfigError "
      "where the rule is no ffd rule.");
}

}  // namespace

void bind_plan(nb::module_& m) {
  PlanClass plan(m, "Plan",
                 "How the nodes of a mesh follow its boundary: made once, applied many times.\n\n"
                 "u, rate and what transpose() returns have one row for each of boundary_nodes; u absent: what the "
                 "rules say. Other arrays have one "
                 "row per node of the mesh. float64 or float32, (n, 3), any positive strides, read in place; "
                 "results are float64, new or in `out`.");
  bind_construction(plan);
  bind_nodes(plan);
  bind_boundary(plan);
  bind_morphs(plan);
  bind_gradients(plan);
  plan.def(
      "share", &PyPlan::share, nb::arg("boxes"),
      "The Share of boxes of nodes, each (zone, i0, j0, k0, i1, j1, k1) with i0 <= i < i1, from 0: for programs of "
      "several processes, of meshes of blocks. Raises ConfigError.");

  nb::class_<PyShare> share(
      m, "Share",
      "What a process of several has of a Plan: the nodes of its boxes, box after box, i fastest, "
      "which go to the same bits as by the whole plan. Made by Plan.share(), can be pickled, so "
      "that mpi4py sends it.\n\n"
      "u, rate and what transpose() returns are of all boundary nodes of the whole mesh, other "
      "arrays have one row per node of the boxes. What transpose() returns on all processes adds "
      "up to that of the plan, where copies of a node have gradients of zero.");
  bind_nodes(share);
  bind_morphs(share);
  share.def("__getstate__", &PyShare::state).def("__setstate__", [](PyShare& self, nb::tuple const& state) {
    PyShare::from_state(&self, state);
  });
}

}  // namespace gridmorph::python
