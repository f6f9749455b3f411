#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/wall_turn.hpp>
#include <gridmorph/unstructured/unstructured_morpher.hpp>
#include <gridmorph/volume/morpher.hpp>

#include <string>

namespace gridmorph {

namespace {

template <class MemorySpace, class T>
using View = Kokkos::View<T*, MemorySpace>;

/// Layers of rows, as many launches: the host keeps where each begins.
template <class MemorySpace>
struct LayerViews {
  GatherViews<MemorySpace> rows;
  std::vector<Index> level;

  LayerViews() = default;
  explicit LayerViews(LayerRows const& from) : rows(from.rows), level(from.level) {}

  template <class Exec>
  void run(Exec const& exec, View<MemorySpace, Vec3> const& value) const {
    for (std::size_t l = 0; l + 1 < level.size(); ++l) gather(exec, rows, level[l], level[l + 1], value, value);
  }
};

template <class MemorySpace>
struct Lists {
  View<MemorySpace, Index> first;
  View<MemorySpace, Number> item;

  Lists() = default;
  Lists(NumberLists const& lists, char const* label)
      : first(detail::copy_of<MemorySpace>(lists.first, label)),
        item(detail::copy_of<MemorySpace>(lists.item, label)) {}
};

/// Position of a node: of the baseline, or moved by what it is displaced by so far.
struct Positions {
  kernels::Field<double const> x;
  Vec3 const* u = nullptr;
  KOKKOS_INLINE_FUNCTION Vec3 operator[](Index n) const { return u == nullptr ? x[n] : x[n] + u[n]; }
};

/// Area-weighted normal of the wall around a node: sum of (a - x) x (b - x) over its faces; in 2-D of (b - a) x plane normal
/// over its edges.
template <class MemorySpace>
struct WallNormal {
  View<MemorySpace, Number> roots;
  Lists<MemorySpace> fans;
  bool flat;
  Vec3 across;

  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index r, Positions const& at) const {
    Vec3 const x = at[roots(r)];
    Vec3 sum;
    for (Index k = fans.first(r); k < fans.first(r + 1); k += 2) {
      Vec3 const a = at[fans.item(k)], b = at[fans.item(k + 1)];
      sum += flat ? cross(b - a, across) : cross(a - x, b - x);
    }
    return sum;
  }
};

template <class MemorySpace>
struct WallTurn {
  WallNormal<MemorySpace> normal;
  Positions baseline, moved;
  View<MemorySpace, Vec3> turn;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    turn(r) = kernels::turn_between(normal(r, baseline), normal(r, moved));
  }
};

template <class MemorySpace>
struct MoveColumns {
  View<MemorySpace, Number> node, root, turned_roots;
  View<MemorySpace, float> share;
  View<MemorySpace, Vec3> turn;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    double const s = share(k);
    if (s == 0) {
      u(node(k)) = u(root(k));
      return;
    }
    Number const wall = turned_roots(root(k));
    u(node(k)) = u(wall) + kernels::turned_by(turn(root(k)), s, x[node(k)] - x[wall]);
  }
};

template <class MemorySpace>
struct ScatterSlots {
  View<MemorySpace, Number> slots, nodes;
  Kokkos::View<Vec3 const*, MemorySpace> boundary;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(nodes(slots(k))) = boundary(slots(k)); }
};

/// What the near field says at fence nodes minus what the background mesh says.
template <class MemorySpace>
struct FenceDifference {
  View<MemorySpace, Number> node;
  View<MemorySpace, Vec3> near, background;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { background(node(k)) = near(node(k)) - background(node(k)); }
};

template <class MemorySpace>
struct AddFaded {
  View<MemorySpace, Number> node;
  View<MemorySpace, float> fade;
  View<MemorySpace, Vec3> add, u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(node(k)) += double(fade(k)) * add(node(k)); }
};

/// What boundaries beyond the moving walls ask for, by rule or by the surface they slide on.
template <class MemorySpace>
struct AskOthers {
  View<MemorySpace, Number> node, slot;
  Lists<MemorySpace> surfaces_of;
  View<MemorySpace, SlipSurfaceView> surfaces;
  Kokkos::View<Vec3 const*, MemorySpace> boundary;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u, asked;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Number const n = node(k);
    if (slot(k) >= 0) {
      asked(n) = boundary(slot(k));
      return;
    }
    Index const from = surfaces_of.first(k), to = surfaces_of.first(k + 1);
    // Alternating corrections come to the edge where surfaces meet; planes at right angles need one round.
    int const rounds = to - from > 1 ? 20 : 1;
    Vec3 v = u(n);
    Vec3 const p = x[n];
    for (int round = 0; round < rounds; ++round)
      for (Index s = from; s < to; ++s) v = surfaces(surfaces_of.item(s)).constrain(p, v);
    asked(n) = v;
  }
};

/// Nodes behind periodic boundaries move by the mean over their class, or as the one whose displacement a rule gives.
template <class MemorySpace>
struct PeriodicMean {
  View<MemorySpace, Number> owner, image_node;
  View<MemorySpace, std::int32_t> image_rotation;
  View<MemorySpace, std::uint8_t> owner_known;
  Lists<MemorySpace> images_of;
  View<MemorySpace, Mat3> rotations;
  View<MemorySpace, Vec3> asked;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 mean = asked(owner(k));
    Index const from = images_of.first(k), to = images_of.first(k + 1);
    if (owner_known(k) == 0) {
      Vec3 const base = mean;
      Vec3 sum;
      for (Index i = from; i < to; ++i) {
        Number const image = images_of.item(i);
        Vec3 const v = asked(image_node(image));
        sum += (image_rotation(image) < 0 ? v : transpose(rotations(image_rotation(image))) * v) - base;
      }
      mean = base + (1.0 / double(to - from + 1)) * sum;
      asked(owner(k)) = mean;
    }
    for (Index i = from; i < to; ++i) {
      Number const image = images_of.item(i);
      asked(image_node(image)) = image_rotation(image) < 0 ? mean : rotations(image_rotation(image)) * mean;
    }
  }
};

/// u becomes what is asked for; what it lacked is left in `asked` to spread.
template <class MemorySpace>
struct TakeOthers {
  View<MemorySpace, Number> node;
  View<MemorySpace, Vec3> u, asked;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const before = u(node(k));
    u(node(k)) = asked(node(k));
    asked(node(k)) = asked(node(k)) - before;
  }
};

/// What the lattice misses of the residual at the boundaries themselves.
template <class MemorySpace>
struct LatticeError {
  View<MemorySpace, Number> node;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> residual;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Number const n = node(k);
    residual(n) = residual(n) - shape.at(lattice.data(), x[n]);
  }
};

template <class MemorySpace>
struct AddResidual {
  View<MemorySpace, float> fade;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    double const f = fade(n);
    if (f != 0) u(n) += f * shape.at(lattice.data(), x[n]);
  }
};

template <class MemorySpace>
struct CopyNodes {
  View<MemorySpace, Number> to, from;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(to(k)) = u(from(k)); }
};

template <class MemorySpace, bool Move>
struct WriteNodes {
  View<MemorySpace, Vec3> u;
  kernels::Field<double const> x;
  kernels::Field<double> out;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out.set(n, Move ? x[n] + u(n) : u(n)); }
};

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
        normals{list(plan.columns.turned_roots, "turned_roots"), Lists<Space>(plan.columns.fans, "gridmorph::fans"),
                plan.dimension == 2, plan.plane_normal},
        turn("gridmorph::UnstructuredMorpher::turn", plan.columns.turned_roots.size()),
        near(plan.near),
        wrap(plan.wrap),
        outer(plan.outer),
        far(plan.far),
        fence(plan.fence),
        fence_spread(plan.fence_spread),
        fence_fade(list(plan.fence_fade, "fence_fade")),
        other(list(plan.other, "other")),
        other_slot(list(plan.other_slot, "other_slot")),
        other_surfaces(plan.other_surfaces, "gridmorph::other_surfaces"),
        surfaces(exec, plan.surfaces),
        image_owners(list(plan.image_owners, "image_owners")),
        images_of_owner(plan.images_of_owner, "gridmorph::images_of_owner"),
        rotations(list(plan.rotations, "rotations")),
        residual_leaves(plan.residual.leaves),
        residual_groups(plan.residual.groups),
        residual_lattice(plan.residual.lattice),
        residual_shape(plan.residual.shape),
        groups("gridmorph::UnstructuredMorpher::groups", std::size_t(plan.residual.n_groups)),
        lattice("gridmorph::UnstructuredMorpher::lattice", std::size_t(plan.residual.lattice.size())),
        residual_detail(plan.residual_detail),
        detail_fade(list(plan.detail_fade, "detail_fade")),
        fade(list(plan.fade, "fade")),
        copies(list(plan.copies, "copies")),
        copied(list(plan.copied, "copied")),
        middle(plan.middle),
        u("gridmorph::UnstructuredMorpher::u", std::size_t(plan.n_nodes)),
        work("gridmorph::UnstructuredMorpher::work", std::size_t(plan.n_nodes)) {
    std::vector<Number> nodes;
    std::vector<std::int32_t> turns;
    for (PeriodicImage const& image : plan.images) {
      nodes.push_back(image.node);
      turns.push_back(image.rotation);
    }
    image_node = list(nodes, "image_node");
    image_rotation = list(turns, "image_rotation");
    std::vector<std::uint8_t> is_known(std::size_t(plan.n_nodes), 0), owner_is_known;
    for (Number const n : plan.known) is_known[std::size_t(n)] = 1;
    for (Number const n : plan.image_owners) owner_is_known.push_back(is_known[std::size_t(n)]);
    owner_known = list(owner_is_known, "owner_known");
    if (plan.background) make_background(exec, plan);
  }

  template <class T>
  static View<Space, T> list(std::vector<T> const& from, char const* label) {
    return detail::copy_of<Space>(from, (std::string("gridmorph::UnstructuredMorpher::") + label).c_str());
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
    background.emplace(exec, plan.background_morph->plan(), read(background_x));
    compat::fence(exec, "gridmorph::UnstructuredMorpher (background uploaded)");
  }
  [[nodiscard]] kernels::Field<double const> read(Kokkos::View<double*, Space> const& v) const {
    return {v.data(), v.data() + n_background, v.data() + 2 * n_background, 1};
  }

  template <class Kernel>
  static void launch(char const* label, Exec const& exec, std::size_t n, Kernel const& kernel) {
    if (n > 0)
      Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, Index(n)), kernel);
  }

  void displacement(Exec const& exec, Boundary const& boundary, kernels::Field<double const> const& x) const {
    // Nodes that nothing reaches stay; whatever is read is written before in every call.
    Kokkos::deep_copy(exec, u, Vec3{});
    launch("gridmorph::moving_walls", exec, driving_slots.extent(0),
           ScatterSlots<Space>{driving_slots, known, boundary, u});
    launch("gridmorph::wall_turn", exec, turn.extent(0),
           WallTurn<Space>{normals, Positions{x, nullptr}, Positions{x, u.data()}, turn});
    launch("gridmorph::columns", exec, column_node.extent(0),
           MoveColumns<Space>{column_node, column_root, normals.roots, column_turn, turn, x, u});
    near.run(exec, u);
    if (background) far_field(exec, boundary);
    others(exec, boundary, x);
    gather(exec, middle, 0, middle.size(), u, u);
    launch("gridmorph::copies", exec, copies.extent(0), CopyNodes<Space>{copies, copied, u});
  }

  void far_field(Exec const& exec, Boundary const& boundary) const {
    gather(exec, outer, 0, outer.size(), boundary, background_boundary);
    gather(exec, wrap, 0, wrap.size(), u, background_boundary);
    background->displace(exec, background_boundary,
                         kernels::Field<double>{background_u.data(), background_u.data() + n_background,
                                                background_u.data() + 2 * n_background, 1});
    gather(exec, far, read(background_u), u);
    gather(exec, fence, read(background_u), work);
    launch("gridmorph::fence", exec, fence.target.extent(0), FenceDifference<Space>{fence.target, u, work});
    fence_spread.run(exec, work);
    launch("gridmorph::fence::spread", exec, fence_fade.extent(0),
           AddFaded<Space>{fence_spread.rows.target, fence_fade, work, u});
  }

  void others(Exec const& exec, Boundary const& boundary, kernels::Field<double const> const& x) const {
    launch("gridmorph::others", exec, other.extent(0),
           AskOthers<Space>{other, other_slot, other_surfaces, surfaces.surfaces, boundary, x, u, work});
    launch(
        "gridmorph::periodic", exec, image_owners.extent(0),
        PeriodicMean<Space>{image_owners, image_node, image_rotation, owner_known, images_of_owner, rotations, work});
    launch("gridmorph::others::take", exec, other.extent(0), TakeOthers<Space>{other, u, work});
    if (lattice.extent(0) == 0) return;
    gather(exec, residual_leaves, 0, residual_leaves.size(), work, groups);
    residual_groups.run(exec, groups);
    gather(exec, residual_lattice, 0, residual_lattice.size(), groups, lattice);
    launch("gridmorph::residual", exec, std::size_t(n_nodes), AddResidual<Space>{fade, residual_shape, lattice, x, u});
    launch("gridmorph::residual::error", exec, other.extent(0),
           LatticeError<Space>{other, residual_shape, lattice, x, work});
    residual_detail.run(exec, work);
    launch("gridmorph::residual::detail", exec, detail_fade.extent(0),
           AddFaded<Space>{residual_detail.rows.target, detail_fade, work, u});
  }

  Index n_nodes = 0, n_background = 0;
  View<Space, Number> known, driving_slots, column_node, column_root;
  View<Space, float> column_turn;
  WallNormal<Space> normals;
  View<Space, Vec3> turn;
  LayerViews<Space> near;
  GatherViews<Space> wrap, outer, far, fence;
  LayerViews<Space> fence_spread;
  View<Space, float> fence_fade;
  View<Space, Number> other, other_slot;
  Lists<Space> other_surfaces;
  SlipSurfaceTable<Space> surfaces;
  View<Space, Number> image_owners, image_node;
  View<Space, std::int32_t> image_rotation;
  View<Space, std::uint8_t> owner_known;
  Lists<Space> images_of_owner;
  View<Space, Mat3> rotations;
  GatherViews<Space> residual_leaves;
  LayerViews<Space> residual_groups;
  GatherViews<Space> residual_lattice;
  UniformLattice residual_shape;
  View<Space, Vec3> groups, lattice;
  LayerViews<Space> residual_detail;
  View<Space, float> detail_fade;
  View<Space, float> fade;
  View<Space, Number> copies, copied;
  GatherViews<Space> middle;
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
  state_->displacement(exec, boundary, x);
  State::launch("gridmorph::move", exec, std::size_t(state_->n_nodes),
                WriteNodes<MemorySpace, true>{state_->u, x, moved});
}

template <class Exec>
void UnstructuredMorpher<Exec>::displace(Exec const& exec, Boundary boundary, kernels::Field<double const> x,
                                         kernels::Field<double> u) const {
  state_->displacement(exec, boundary, x);
  State::launch("gridmorph::write", exec, std::size_t(state_->n_nodes),
                WriteNodes<MemorySpace, false>{state_->u, x, u});
}

template <class Exec>
kernels::Field<double const> UnstructuredMorpher<Exec>::background_displacement() const {
  if (!state_->background) return {nullptr, nullptr, nullptr};
  return state_->read(state_->background_u);
}

#define GRIDMORPH_INSTANTIATE(Exec) template class UnstructuredMorpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
