// Coordinates and displacements where their owner keeps them: what solvers hand over as Kokkos Views.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <Kokkos_Core.hpp>

#include <array>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph {

namespace detail {

/// Three Views x, y, z: Coordinates, or a solver's own.
template <class S>
concept ComponentViews = Kokkos::is_view<std::remove_cvref_t<decltype(S::x)>>::value &&
    Kokkos::is_view<std::remove_cvref_t<decltype(S::y)>>::value &&
    Kokkos::is_view<std::remove_cvref_t<decltype(S::z)>>::value;

/// Vectors at a list of nodes (Rank 1) or at those of a block (Rank 3).
template <std::size_t Rank>
struct VectorLayout {
  void *x, *y, *z;
  bool single;
  std::array<Index, Rank> extent, stride;
};

[[noreturn]] inline void refuse_vectors(std::string const& why) { throw ConfigError("gridmorph::VectorView: " + why); }

}  // namespace detail

/// Vectors of the caller's, read and (without ReadOnly) written in place. Made from
///
///   View<T*[3]> or View<T**> (n, 3), any layout; View<Vec3*>
///   three View<T*> of one stride, or a struct of such Views x, y, z, as Coordinates is
///   per zone of blocks a View<T****> (i, j, k, 3), or a struct of three View<T***> (i, j, k) of the same strides
///
/// with T double or float. Zones may be allocated apart; ghost layers and padding are left out by subviews, which keep
/// their strides. Nothing is copied but, once, a table with 80 bytes per zone. The caller's Views must outlive what is
/// made from them. Extents that do not fit are a ConfigError with both numbers; Views out of reach of the memory space,
/// or of other types, do not compile.
template <class MemorySpace, bool ReadOnly>
class BasicVectorView {
 public:
  template <class D, class... P>
  BasicVectorView(Kokkos::View<D, P...> const& v) : BasicVectorView(layout<1>(v)) {}

  template <class D, class... P>
  requires std::is_same_v<typename Kokkos::View<D, P...>::non_const_value_type, Vec3> BasicVectorView(
      Kokkos::View<D, P...> const& v)
      : BasicVectorView({pointer(v.data()),
                         pointer(v.data(), 1),
                         pointer(v.data(), 2),
                         false,
                         {Index(v.extent(0))},
                         {3 * Index(v.stride(0))}}) {
    check<Kokkos::View<D, P...>, 1>();
  }

  template <detail::ComponentViews S>
  BasicVectorView(S const& s) : BasicVectorView(layout<1>(s)) {}

  template <class X, class Y, class Z>
  requires(Kokkos::is_view<X>::value&& Kokkos::is_view<Y>::value&& Kokkos::is_view<Z>::value)
      BasicVectorView(X const& x, Y const& y, Z const& z)
      : BasicVectorView(layout<1>(Three<X, Y, Z>{x, y, z})) {}

  /// Vectors that lie in one View, or struct of Views, per zone of the mesh. Fences `exec`.
  template <class ExecutionSpace, class ZoneViews>
  BasicVectorView(ExecutionSpace const& exec, Mesh const& mesh, std::vector<ZoneViews> const& views)
      : size_(mesh.n_nodes()) {
    if (views.size() != mesh.zones.size())
      detail::refuse_vectors("the mesh has " + std::to_string(mesh.zones.size()) + " zones and there are Views for " +
                             std::to_string(views.size()));
    std::vector<kernels::ZoneArray> host;
    for (std::size_t z = 0; z < views.size(); ++z) {
      Zone const& zone = mesh.zones[z];
      detail::VectorLayout<3> const l = layout<3>(views[z]);
      if (l.extent != std::array<Index, 3>{zone.extent[0], zone.extent[1], zone.extent[2]})
        detail::refuse_vectors("zone '" + zone.name + "' has " + text(zone.extent) + " nodes and its View " +
                               text(l.extent));
      host.push_back(
          {zone.first_node, l.extent[0], l.extent[1], {l.stride[0], l.stride[1], l.stride[2]}, l.x, l.y, l.z});
      array_.single = l.single;
    }
    zones_ = Kokkos::View<kernels::ZoneArray*, MemorySpace>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::VectorView::zones"), host.size());
    Kokkos::View<kernels::ZoneArray const*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const from(
        host.data(), host.size());
    Kokkos::deep_copy(exec, zones_, from);
    compat::fence(exec, "gridmorph::VectorView (the host's table ends here)");
    array_.zones = zones_.data();
    array_.n_zones = int(host.size());
  }

  /// A read-only view of vectors that may be written.
  template <bool Other>
  requires(ReadOnly && !Other) BasicVectorView(BasicVectorView<MemorySpace, Other> const& v)
      : size_(v.size_), array_(v.array_), zones_(v.zones_) {}

  /// Number of vectors.
  [[nodiscard]] Index size() const { return size_; }
  /// The vectors as kernels take them, valid while this object lives.
  [[nodiscard]] kernels::VectorArray const& array() const { return array_; }

 private:
  friend class BasicVectorView<MemorySpace, true>;
  template <class X, class Y, class Z>
  struct Three {
    X const& x;
    Y const& y;
    Z const& z;
  };

  explicit BasicVectorView(detail::VectorLayout<1> const& l)
      : size_(l.extent[0]), array_{l.x, l.y, l.z, l.stride[0], nullptr, 0, l.single} {}

  template <class View, std::size_t rank>
  static constexpr void check() {
    static_assert(
        std::size_t(View::rank) == rank,
        "vectors come as (n, 3) or three times (n); those of a zone as (i, j, k, 3) or three times (i, j, k)");
    static_assert(Kokkos::SpaceAccessibility<MemorySpace, typename View::memory_space>::accessible,
                  "the execution space does not reach this View's memory");
    static_assert(ReadOnly || !std::is_const_v<typename View::value_type>, "written vectors need Views of non-const");
  }
  template <class View, std::size_t rank>
  static constexpr bool is_single() {
    check<View, rank>();
    using T = typename View::non_const_value_type;
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, float>, "components are double or float");
    return std::is_same_v<T, float>;
  }

  template <class T>
  static void* pointer(T const* p, std::size_t offset = 0) {
    using Number = std::conditional_t<std::is_same_v<T, Vec3>, double, T>;
    return const_cast<Number*>(reinterpret_cast<Number const*>(p) + offset);
  }

  template <std::size_t Rank, class D, class... P>
  static detail::VectorLayout<Rank> layout(Kokkos::View<D, P...> const& v) {
    detail::VectorLayout<Rank> l;
    l.single = is_single<Kokkos::View<D, P...>, Rank + 1>();
    if (v.extent(Rank) != 3)
      detail::refuse_vectors("vectors have 3 components, and the last extent is " + std::to_string(v.extent(Rank)));
    for (std::size_t d = 0; d < Rank; ++d) {
      l.extent[d] = Index(v.extent(d));
      l.stride[d] = Index(v.stride(d));
    }
    auto const step = std::size_t(v.stride(Rank));
    l.x = pointer(v.data());
    l.y = pointer(v.data(), step);
    l.z = pointer(v.data(), 2 * step);
    return l;
  }

  template <std::size_t Rank, detail::ComponentViews S>
  static detail::VectorLayout<Rank> layout(S const& s) {
    detail::VectorLayout<Rank> l{pointer(s.x.data()), pointer(s.y.data()), pointer(s.z.data()), false, {}, {}};
    using X = std::remove_cvref_t<decltype(s.x)>;
    l.single = is_single<X, Rank>();
    for (std::size_t d = 0; d < Rank; ++d) {
      l.extent[d] = Index(s.x.extent(d));
      l.stride[d] = Index(s.x.stride(d));
    }
    auto const like_x = [&]<class View>(View const& v) {
      static_assert(std::is_same_v<typename View::non_const_value_type, typename X::non_const_value_type>);
      is_single<View, Rank>();
      for (std::size_t d = 0; d < Rank; ++d) {
        if (Index(v.extent(d)) != l.extent[d])
          detail::refuse_vectors("x has extent " + std::to_string(l.extent[d]) + " and another component " +
                                 std::to_string(v.extent(d)));
        if (Index(v.stride(d)) != l.stride[d])
          detail::refuse_vectors("x has stride " + std::to_string(l.stride[d]) + " and another component " +
                                 std::to_string(v.stride(d)));
      }
    };
    like_x(s.y);
    like_x(s.z);
    return l;
  }

  template <class T>
  static std::string text(std::array<T, 3> const& n) {
    return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
  }

  Index size_ = 0;
  kernels::VectorArray array_;
  Kokkos::View<kernels::ZoneArray*, MemorySpace> zones_;
};

template <class MemorySpace>
using VectorView = BasicVectorView<MemorySpace, false>;
template <class MemorySpace>
using ConstVectorView = BasicVectorView<MemorySpace, true>;

}  // namespace gridmorph
