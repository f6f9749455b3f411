#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

namespace gridmorph {

void InterpolationOperator::add(Index32 row_target, std::span<Index32 const> items, std::span<double const> weights) {
  double sum = 0;
  for (double const w : weights) sum += w;
  target.push_back(row_target);
  item.insert(item.end(), items.begin(), items.end());
  for (double const w : weights) weight.push_back(float(w / sum));
  first.push_back(Index(item.size()));
}

namespace {

template <class MemorySpace, class Source>
struct GatherRow {
  InterpolationViews<MemorySpace> rows;
  Source source;
  Kokkos::View<Vec3*, MemorySpace> value;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    Vec3 const base = source[rows.item(from)];
    Vec3 sum;
    for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (source[rows.item(k)] - base);
    value(rows.target(r)) = base + sum;
  }
};

template <class Exec, class Source>
void launch(Exec const& exec, InterpolationViews<typename Exec::memory_space> const& rows, Index begin, Index end,
            Source const& source, Kokkos::View<Vec3*, typename Exec::memory_space> const& value) {
  if (begin < end)
    Kokkos::parallel_for("gridmorph::gather", Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, begin, end),
                         GatherRow<typename Exec::memory_space, Source>{rows, source, value});
}

}  // namespace

template <class Exec>
void gather(Exec const& exec, InterpolationViews<typename Exec::memory_space> const& rows, Index begin, Index end,
            Kokkos::View<Vec3 const*, typename Exec::memory_space> source,
            Kokkos::View<Vec3*, typename Exec::memory_space> value) {
  launch(exec, rows, begin, end, source.data(), value);
}

template <class Exec>
void gather(Exec const& exec, InterpolationViews<typename Exec::memory_space> const& rows,
            kernels::Field<double const> source, Kokkos::View<Vec3*, typename Exec::memory_space> value) {
  launch(exec, rows, 0, rows.size(), source, value);
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                              \
  template void gather(Exec const&, InterpolationViews<Exec::memory_space> const&, Index, Index,                 \
                       Kokkos::View<Vec3 const*, Exec::memory_space>, Kokkos::View<Vec3*, Exec::memory_space>);  \
  template void gather(Exec const&, InterpolationViews<Exec::memory_space> const&, kernels::Field<double const>, \
                       Kokkos::View<Vec3*, Exec::memory_space>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
