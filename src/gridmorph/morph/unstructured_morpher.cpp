#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/morph/detail/morph_kernels.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/unstructured_morpher.hpp>
#include <gridmorph/plan/boundary_size.hpp>

#include <string>

namespace gridmorph {

namespace {

using namespace detail;

}  // namespace

template <class Exec>
struct UnstructuredMorpher<Exec>::State {
  using Space = MemorySpace;

  State(Exec const& exec, UnstructuredPlan const& plan)
      : n_nodes(plan.n_nodes),
        known(list(plan.known, "known")),
        driving_slots(list(plan.driving_slots, "driving_slots")),
        column_node(list(plan.columns.node, "column_node")),
        column_root(list(plan.columns.root, "column_root")),
        column_turn(list(plan.columns.turn, "column_turn")),
        driving(list(plan.driving, "driving")),
        turns(list(plan.turns, "turns")),
        normals{driving, Lists<Space>(plan.fans, "gridmorph::fans"), plan.dimension == 2, plan.plane_normal},
        turn("gridmorph::UnstructuredMorpher::turn", plan.driving.size()),
        frame("gridmorph::UnstructuredMorpher::frame", plan.driving.size()),
        walls(plan.walls),
        near(plan.near),
        near_fade(list(plan.near_fade, "near_fade")),
        wrap(plan.wrap),
        outer(plan.outer),
        far(plan.far),
        other(list(plan.other, "other")),
        other_slot(list(plan.other_slot, "other_slot")),
        other_surfaces(plan.other_surfaces, "gridmorph::other_surfaces"),
        surfaces(exec, plan.surfaces),
        given(list(plan.start.given, "given")),
        given_slot(list(plan.start.given_slot, "given_slot")),
        given_residual(plan.start.residual),
        given_missing("gridmorph::UnstructuredMorpher::given_missing", plan.start.given.size()),
        given_detail(plan.start.detail),
        start(list(plan.start.node, "start")),
        start_fade(list(plan.start.fade, "start_fade")),
        start_detail_fade(list(plan.start.detail_fade, "start_detail_fade")),
        image_owners(list(plan.image_owners, "image_owners")),
        images_of_owner(plan.images_of_owner, "gridmorph::images_of_owner"),
        rotations(list(plan.rotations, "rotations")),
        residual(plan.residual),
        asked("gridmorph::UnstructuredMorpher::asked", plan.other.size()),
        residual_detail(plan.residual_detail),
        detail_fade(list(plan.detail_fade, "detail_fade")),
        fade(list(plan.fade, "fade")),
        copies(list(plan.copies, "copies")),
        copied(list(plan.copied, "copied")),
        middle(plan.middle),
        u("gridmorph::UnstructuredMorpher::u", std::size_t(plan.n_nodes)),
        work("gridmorph::UnstructuredMorpher::work", std::size_t(plan.n_nodes)) {
    std::vector<Index32> nodes;
    std::vector<std::int32_t> turns;
    for (PeriodicImage const& image : plan.images) {
      nodes.push_back(image.node);
      turns.push_back(image.rotation);
    }
    image_node = list(nodes, "image_node");
    image_rotation = list(turns, "image_rotation");
    std::vector<std::uint8_t> is_known(std::size_t(plan.n_nodes), 0), owner_is_known;
    for (Index32 const n : plan.known) is_known[std::size_t(n)] = 1;
    for (Index32 const n : plan.image_owners) owner_is_known.push_back(is_known[std::size_t(n)]);
    owner_known = list(owner_is_known, "owner_known");
    if (plan.background) make_background(exec, plan);
  }

  template <class T>
  static View<Space, T> list(std::vector<T> const& from, char const* label) {
    return copy_of<Space>(from, (std::string("gridmorph::UnstructuredMorpher::") + label).c_str());
  }

  void make_background(Exec const& exec, UnstructuredPlan const& plan) {
    Coordinates const& c = plan.background->mesh.coordinates;
    background_x = Kokkos::View<double*, Space>("gridmorph::background_x", std::size_t(3 * c.size()));
    background_u = Kokkos::View<double*, Space>("gridmorph::background_u", std::size_t(3 * c.size()));
    n_background = c.size();
    Index component = 0;
    for (auto const& from : {c.x, c.y, c.z}) {
      auto const part =
          Kokkos::subview(background_x, std::pair(component * n_background, (component + 1) * n_background));
      Kokkos::deep_copy(exec, part, from);
      ++component;
    }
    background_boundary =
        View<Space, Vec3>("gridmorph::background_boundary", plan.background_morph->plan().boundary_nodes.size());
    background.emplace(exec, plan.background_morph->plan(), components(background_x));
    compat::fence(exec, "gridmorph::UnstructuredMorpher (background uploaded)");
  }
  [[nodiscard]] VectorView<Space> components(Kokkos::View<double*, Space> const& v) const {
    auto const part = [&](Index c) { return Kokkos::subview(v, std::pair(c * n_background, (c + 1) * n_background)); };
    return {part(0), part(1), part(2)};
  }
  [[nodiscard]] kernels::Field<double const> read(Kokkos::View<double*, Space> const& v) const {
    return {v.data(), v.data() + n_background, v.data() + 2 * n_background, 1};
  }

  template <class Kernel>
  static void launch(char const* label, Exec const& exec, std::size_t n, Kernel const& kernel) {
    detail::launch(label, exec, 0, Index(n), kernel);
  }

  void require_boundary(std::size_t given, char const* what) const {
    require_boundary_size(what, given, known.extent(0), "UnstructuredPlan::known");
  }

  void displacement(Exec const& exec, Boundary const& boundary, kernels::Field<double const> const& x) const {
    // Whatever is read is written before in every call.
    launch("gridmorph::rest", exec, u.extent(0), RestNodes<Space>{u});
    launch("gridmorph::moving_walls", exec, driving_slots.extent(0),
           ScatterSlots<Space>{driving_slots, known, boundary, u});
    launch("gridmorph::wall_turn", exec, turn.extent(0),
           WallTurn<Space>{normals, turns, Positions{x, nullptr}, Positions{x, u.data()}, turn});
    launch("gridmorph::wall_frames", exec, turn.extent(0), WallFrames<Space>{driving, turn, u, frame});
    launch("gridmorph::columns", exec, column_node.extent(0),
           MoveColumns<Space>{column_node, column_root, driving, column_turn, turn, x, u});
    near_field(exec, x);
    if (background) far_field(exec, boundary);
    others(exec, boundary, x);
    gather(exec, middle, 0, middle.size(), u, u);
    launch("gridmorph::copies", exec, copies.extent(0), CopyNodes<Space>{copies, copied, u});
  }

  void near_field(Exec const& exec, kernels::Field<double const> const& x) const {
    walls.run(exec, frame);
    for (auto const& seeds : {driving, column_node})
      launch("gridmorph::near::missing", exec, seeds.extent(0),
             SmoothMisses<Space>{seeds, walls.shape, walls.value, x, u, work});
    near.run(exec, work);
    launch("gridmorph::near", exec, near_fade.extent(0),
           SmoothAndMissing<Space>{near.rows.target, near_fade, walls.shape, walls.value, x, work, u});
  }

  void far_field(Exec const& exec, Boundary const& boundary) const {
    gather(exec, outer, 0, outer.size(), boundary, background_boundary);
    gather(exec, wrap, 0, wrap.size(), u, background_boundary);
    background->displacements(exec, background_boundary, components(background_u));
    gather(exec, far, read(background_u), u);
  }

  /// Where nodes that slide or have images begin.
  void start_others(Exec const& exec, Boundary const& boundary, kernels::Field<double const> const& x) const {
    if (!given_residual.empty()) {
      launch("gridmorph::start::given", exec, given.extent(0),
             GivenMisses<Space>{given, given_slot, boundary, u, work, given_missing});
      given_residual.run(exec, given_missing);
      launch("gridmorph::start::missing", exec, given.extent(0),
             SmoothMisses<Space>{given, given_residual.shape, given_residual.value, x, work, work});
      given_detail.run(exec, work);
    }
    launch("gridmorph::start", exec, start.extent(0),
           StartOthers<Space>{start, start_fade, start_detail_fade, given_residual.shape, given_residual.value, x, u,
                              work});
  }

  void others(Exec const& exec, Boundary const& boundary, kernels::Field<double const> const& x) const {
    start_others(exec, boundary, x);
    launch("gridmorph::others", exec, other.extent(0),
           AskOthers<Space>{other, other_slot, other_surfaces, surfaces.surfaces, boundary, x, work});
    launch(
        "gridmorph::periodic", exec, image_owners.extent(0),
        PeriodicMean<Space>{image_owners, image_node, image_rotation, owner_known, images_of_owner, rotations, work});
    launch("gridmorph::others::take", exec, other.extent(0), TakeOthers<Space>{other, u, work});
    if (residual.empty()) return;
    launch("gridmorph::residual::values", exec, other.extent(0), PickNodes<Space>{other, work, asked});
    residual.run(exec, asked);
    launch("gridmorph::residual", exec, std::size_t(n_nodes),
           AddResidual<Space>{fade, residual.shape, residual.value, x, u});
    launch("gridmorph::residual::missing", exec, other.extent(0),
           SmoothMisses<Space>{other, residual.shape, residual.value, x, work, work});
    residual_detail.run(exec, work);
    launch("gridmorph::residual::detail", exec, detail_fade.extent(0),
           AddFaded<Space>{residual_detail.rows.target, detail_fade, work, u});
  }

  Index n_nodes = 0, n_background = 0;
  View<Space, Index32> known, driving_slots, column_node, column_root;
  View<Space, float> column_turn;
  View<Space, Index32> driving;
  View<Space, std::uint8_t> turns;
  WallNormal<Space> normals;
  View<Space, Vec3> turn;
  View<Space, AffineMotion> frame;
  InverseDistanceViews<Space, AffineMotion> walls;
  LayerViews<Space> near;
  View<Space, float> near_fade;
  InterpolationViews<Space> wrap, outer, far;
  View<Space, Index32> other, other_slot;
  Lists<Space> other_surfaces;
  SlipSurfaceTable<Space> surfaces;
  View<Space, Index32> given, given_slot;
  InverseDistanceViews<Space, Vec3> given_residual;
  View<Space, Vec3> given_missing;
  LayerViews<Space> given_detail;
  View<Space, Index32> start;
  View<Space, float> start_fade, start_detail_fade;
  View<Space, Index32> image_owners, image_node;
  View<Space, std::int32_t> image_rotation;
  View<Space, std::uint8_t> owner_known;
  Lists<Space> images_of_owner;
  View<Space, Mat3> rotations;
  InverseDistanceViews<Space, Vec3> residual;
  View<Space, Vec3> asked;
  LayerViews<Space> residual_detail;
  View<Space, float> detail_fade;
  View<Space, float> fade;
  View<Space, Index32> copies, copied;
  InterpolationViews<Space> middle;
  Kokkos::View<double*, Space> background_x, background_u;
  View<Space, Vec3> background_boundary;
  std::optional<Morpher<Exec>> background;
  View<Space, Vec3> u, work;
};

template <class Exec>
UnstructuredMorpher<Exec>::UnstructuredMorpher(Exec const& exec, UnstructuredPlan const& plan)
    : state_(std::make_shared<State>(exec, plan)) {}

template <class Exec>
void UnstructuredMorpher<Exec>::apply(Exec const& exec, Boundary boundary, kernels::Field<double const> x,
                                      kernels::Field<double> moved) const {
  state_->require_boundary(boundary.extent(0), "gridmorph::UnstructuredMorpher::apply");
  state_->displacement(exec, boundary, x);
  State::launch("gridmorph::move", exec, std::size_t(state_->n_nodes),
                WriteNodes<MemorySpace, true>{state_->u, x, moved});
}

template <class Exec>
void UnstructuredMorpher<Exec>::displace(Exec const& exec, Boundary boundary, kernels::Field<double const> x,
                                         kernels::Field<double> u) const {
  state_->require_boundary(boundary.extent(0), "gridmorph::UnstructuredMorpher::displace");
  state_->displacement(exec, boundary, x);
  State::launch("gridmorph::write", exec, std::size_t(state_->n_nodes),
                WriteNodes<MemorySpace, false>{state_->u, x, u});
}

template <class Exec>
kernels::Field<double const> UnstructuredMorpher<Exec>::background_displacement() const {
  if (!state_->background) return {nullptr, nullptr, nullptr};
  return state_->read(state_->background_u);
}

void apply_on_host(UnstructuredMorpher<Kokkos::DefaultHostExecutionSpace> const& morpher,
                   std::span<Vec3 const> boundary, Coordinates const& x, Coordinates const& moved) {
  Kokkos::DefaultHostExecutionSpace const exec;
  Kokkos::View<Vec3 const*, Kokkos::HostSpace> const given(boundary.data(), boundary.size());
  morpher.apply(exec, given, {x.x.data(), x.y.data(), x.z.data()}, {moved.x.data(), moved.y.data(), moved.z.data()});
  compat::fence(exec, "gridmorph::apply_on_host (read by the host)");
}

#define GRIDMORPH_INSTANTIATE(Exec) template class UnstructuredMorpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
