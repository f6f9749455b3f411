// Third stage of an unstructured morph: from the wrap through the background mesh to the nodes outside.
#pragma once

#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <utility>

namespace gridmorph::stages {

template <class Exec>
class FarField {
 public:
  static inline std::string const region = "gridmorph::FarField";

  /// The plan has a background mesh.
  FarField(Exec const& exec, UnstructuredPlan const& plan, bool with_rate, bool back)
      : wrap_(upload(exec, plan.wrap, name("wrap"))),
        outer_(upload(exec, plan.outer, name("outer"))),
        far_(upload(exec, plan.far, name("far"))),
        u_(exec, plan.background->mesh.n_nodes(), name("u")),
        boundary_(room_for<Vec3>(exec, plan.background_morph->plan().boundary_nodes.size(), name("boundary"))),
        rate_(room_for<Vec3>(exec, with_rate ? boundary_.extent(0) : 0, name("rate"))),
        morpher_(MorpherAccess::of(exec, plan.background_morph->plan(),
                                   uploaded(exec, plan.background->mesh.coordinates).vectors(),
                                   {1, with_rate, nullptr, back})) {
    if (!back) return;
    Plan const& background = plan.background_morph->plan();
    bends_ = !background.turns.roots.empty() || !background.spreads.empty();
    wrap_back_ = transposed(exec, plan.wrap, name("wrap_back"));
    outer_back_ = transposed(exec, plan.outer, name("outer_back"));
    far_back_ = transposed(exec, plan.far, name("far_back"));
    node_gradient_ = room_for<Vec3>(exec, std::size_t(plan.background->mesh.n_nodes()), name("node_gradient"));
    boundary_gradient_ = room_for<Vec3>(exec, boundary_.extent(0), name("boundary_gradient"));
  }

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    set_boundary(exec, f, boundary_);
    morpher_.displacements(exec, boundary_, u_.vectors());
    kernels::interpolate("gridmorph::far", exec, far_, u_.read(), f.u.data());
  }

  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    set_boundary(exec, f, boundary_);
    set_boundary(exec, r, rate_);
    morpher_.velocities(exec, boundary_, rate_, u_.vectors());
    kernels::interpolate("gridmorph::far", exec, far_, u_.read(), r.u.data());
    enqueue(exec, x, f);
  }

  [[nodiscard]] bool bends() const { return bends_; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const { set_boundary(exec, f, boundary_); }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    clear<Vec3>(exec, node_gradient_);
    kernels::gather_rows("gridmorph::transposed::far", exec, far_back_, g.u.data(), node_gradient_.data());
    kernels::launch("gridmorph::transposed::far::done", exec, kernels::ClearListed<Memory>{far_.target, g.u.data()});
    morpher_.transpose(exec, boundary_, node_gradient_, boundary_gradient_);
    kernels::gather_rows("gridmorph::transposed::wrap", exec, wrap_back_, boundary_gradient_.data(), g.u.data());
    kernels::gather_rows("gridmorph::transposed::outer_box", exec, outer_back_, boundary_gradient_.data(),
                         g.given.data());
  }

  /// The displacements of the background's nodes, by the last call.
  [[nodiscard]] ConstVectorView<typename Exec::memory_space> displacements() const { return u_.vectors(); }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// Three arrays over the nodes of the background, one after another.
  struct Arrays {
    List<Exec, double> values;
    Index n;

    Arrays(Exec const& exec, Index n_nodes, std::string const& what)
        : values(room_for<double>(exec, std::size_t(3 * n_nodes), what)), n(n_nodes) {}
    [[nodiscard]] List<Exec, double> component(Index c) const {
      return Kokkos::subview(values, std::pair(c * n, (c + 1) * n));
    }
    [[nodiscard]] VectorView<Memory> vectors() const { return {component(0), component(1), component(2)}; }
    [[nodiscard]] kernels::Field<double const> read() const {
      return {values.data(), values.data() + n, values.data() + 2 * n};
    }
  };
  /// displacements() of the Morpher does not read them again.
  static Arrays uploaded(Exec const& exec, Coordinates const& x) {
    Arrays const to(exec, x.size(), name("coordinates"));
    Index c = 0;
    for (auto const& from : {x.x, x.y, x.z}) {
      Kokkos::deep_copy(exec, to.component(c++), from);
    }
    return to;
  }

  void set_boundary(Exec const& exec, StageField<Exec> const& f, List<Exec, Vec3> const& boundary) const {
    kernels::interpolate("gridmorph::outer_box", exec, outer_, f.boundary, boundary.data());
    kernels::interpolate("gridmorph::wrap", exec, wrap_, f.u.data(), boundary.data());
  }

  kernels::InterpolationTable<Memory> wrap_, outer_, far_;
  Arrays u_;
  List<Exec, Vec3> boundary_, rate_;
  Morpher<Exec> morpher_;
  bool bends_ = false;  ///< whether anything of the background turns or slides
  kernels::TransposedRows<Memory> wrap_back_, outer_back_, far_back_;
  List<Exec, Vec3> node_gradient_, boundary_gradient_;
};

}  // namespace gridmorph::stages
