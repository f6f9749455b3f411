#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/quality.hpp>

namespace gridmorph {

template <BuiltFor Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input,
    std::span<Measure const> measures) {
  using Field = Kokkos::View<double*, typename Exec::memory_space>;
  auto with_fields = input;
  with_fields.fast = false;
  std::vector<Field> result;
  for (Measure const m : measures) {
    auto& field = with_fields.fields[m];
    if (field.extent(0) == 0)
      field = Field(Kokkos::view_alloc(exec, "gridmorph::cell_fields::" + std::string(to_string(m))),
                    first_cells(mesh).back());
    result.push_back(field);
  }
  (void)measure_quality(exec, mesh, with_fields);
  return result;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                            \
  template std::vector<Kokkos::View<double*, Exec::memory_space>> cell_fields( \
      Exec const&, Mesh const&, QualityInput<Exec::memory_space> const&, std::span<Measure const>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
