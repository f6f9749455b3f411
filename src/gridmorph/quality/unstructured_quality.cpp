#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/quality/detail/fast_quality.hpp>
#include <gridmorph/quality/detail/judge_cells.hpp>
#include <gridmorph/quality/detail/partial_sums.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {

std::vector<signed char> volume_signs(HostInstance const& host, Mesh const& mesh) {
  detail::check_size(mesh, mesh.coordinates.x.extent(0), mesh.coordinates.y.extent(0), mesh.coordinates.z.extent(0),
                     "coordinates of the mesh");
  std::vector<signed char> sign(mesh.n_elements(), 0);
  host.visit([&](auto const& exec) {
    auto const tables = detail::element_tables(exec, mesh);
    auto const coordinates = detail::pack(exec, views(mesh.coordinates), mesh.n_nodes());
    detail::for_all(exec, "gridmorph::volume_signs", mesh.n_elements(), [&](Index e) {
      double const v = tables.volume(coordinates, e);
      sign[e] = v > 0 ? 1 : v < 0 ? -1 : 0;
    });
  });
  return sign;
}

std::vector<NegativeElements> negative_elements(Mesh const& mesh) {
  return negative_elements(mesh, volume_signs(mesh));
}

std::vector<NegativeElements> negative_elements(Mesh const& mesh, std::vector<signed char> const& sign) {
  std::vector<NegativeElements> out;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    auto const& zone = mesh.zones[z];
    std::array<NegativeElements, n_element_types> types;
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
      auto& entry = types[std::size_t(mesh.elements.type[e])];
      ++entry.of;
      if (sign[e] < 0 && entry.count++ == 0) entry.first = e;
    }
    for (int t = 0; t < n_element_types; ++t) {
      if (types[t].count == 0) continue;
      types[t].zone = z;
      types[t].type = ElementType(t);
      out.push_back(types[t]);
    }
  }
  return out;
}

std::string describe(Mesh const& mesh, NegativeElements const& n) {
  auto const& zone = mesh.zones[n.zone];
  std::string const type(to_string(n.type));
  return "zone '" + zone.name + "': " + std::to_string(n.count) + " of " + std::to_string(n.of) + " elements of type " +
         type + (n.count == 1 ? " is" : " are") + " numbered inside out (negative volume), the first is " + type + " " +
         std::to_string(number_in_file(mesh, n.first));
}

namespace detail {

namespace {

// Non-orthogonality and face skewness of elements, from their centres (kernels/face_geometry.hpp).

/// The worst faces of one element.
struct FaceQuality {
  double non_orthogonality_deg = 0, skewness = 0;
};

/// What the faces of one chunk come to, in both regions.
struct FaceSums {
  PartialMeasure non_orthogonality_deg[2], skewness[2];

  KOKKOS_INLINE_FUNCTION void join(FaceSums const& other) {
    for (int r = 0; r < 2; ++r) {
      non_orthogonality_deg[r].join(other.non_orthogonality_deg[r], true);
      skewness[r].join(other.skewness[r], true);
    }
  }
};

/// What is behind each side, in the order of the sides: LinkedSides.
template <class MemorySpace>
struct SideTables {
  Kokkos::View<Index const*, MemorySpace> first;
  Kokkos::View<Index32 const*, MemorySpace> neighbour;
  Kokkos::View<SideLink const*, MemorySpace> links;
};

/// The face that side `side` of element e is.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::FaceGeometry face_of(ElementTables<MemorySpace> const& tables,
                                                     PackedPoints<MemorySpace> const& points, Index e, int side) {
  return tables.with_faces(points, e, [&](auto const& faces) {
    return kernels::face_geometry(
        faces.n_corners(side), [&](int k) { return faces.at(side, k); }, tables.plane_normal);
  });
}

/// (n_elements) centres.
template <class Exec>
Kokkos::View<kernels::PackedVec3*, typename Exec::memory_space> element_centres(
    Exec const& exec, ElementTables<typename Exec::memory_space> const& tables,
    PackedPoints<typename Exec::memory_space> const& points, bool solid) {
  Index const n = tables.elements.size();
  Kokkos::View<kernels::PackedVec3*, typename Exec::memory_space> const centres(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::centres"), n);
  Kokkos::parallel_for(
      "gridmorph::measure_quality::centres", Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, n),
      KOKKOS_LAMBDA(Index const e) {
        Vec3 const c = tables.with_faces(points, e, [&](auto const& faces) {
          auto const face = [&](int f) {
            return kernels::face_geometry(
                faces.n_corners(f), [&](int k) { return faces.at(f, k); }, tables.plane_normal);
          };
          return kernels::element_centre(faces.n_faces(), face, solid).at;
        });
        centres(e) = {c.x, c.y, c.z};
      });
  return centres;
}

/// Adds the faces of element e; boundary faces have no line between centres, but a skewness. Behind a connection the
/// neighbour lies as far from the face there as its image does from the one here, whatever became of the two sides: d =
/// (f - x) + turn (y
/// - f'), f' the centre of the face there.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION FaceQuality face_quality(ElementTables<MemorySpace> const& tables,
                                                SideTables<MemorySpace> const& sides,
                                                PackedPoints<MemorySpace> const& points,
                                                Kokkos::View<kernels::PackedVec3*, MemorySpace> const& centres,
                                                Index e) {
  return tables.with_faces(points, e, [&](auto const& faces) {
    FaceQuality worst;
    Vec3 const own = point(centres(e));
    for (int f = 0; f < faces.n_faces(); ++f) {
      int const n = faces.n_corners(f);
      auto const at = [&](int k) { return faces.at(f, k); };
      kernels::FaceGeometry const face = kernels::face_geometry(n, at, tables.plane_normal);
      double const square = dot(face.area, face.area);
      if (!(square > 0)) continue;  // a side that is a line or a point
      Index32 const other = sides.neighbour(sides.first(e) + f);
      bool const inside = other >= 0 || other <= first_link;
      Vec3 d;
      if (other >= 0) {
        d = point(centres(other)) - own;
      } else if (inside) {
        SideLink const& link = sides.links(first_link - other);
        Vec3 const there = face_of(tables, points, link.element, link.side).centre;
        d = (face.centre - own) + link.turn * (point(centres(link.element)) - there);
      } else {
        d = (dot(face.area, face.centre - own) / square) * face.area;
      }
      if (inside)
        worst.non_orthogonality_deg =
            kernels::larger(worst.non_orthogonality_deg, kernels::non_orthogonality_deg(face, own, own + d));
      worst.skewness = kernels::larger(worst.skewness, kernels::face_skewness(face, own, d, inside ? 0.2 : 0.4, n, at));
    }
    return worst;
  });
}

}  // namespace

}  // namespace detail

namespace {

template <class MemorySpace>
void check_sizes(Mesh const& mesh, UnstructuredQualityInput<MemorySpace> const& input) {
  auto const& c = input.coordinates;
  auto const& b = input.baseline;
  detail::check_size(mesh, c.x.extent(0), c.y.extent(0), c.z.extent(0), "coordinates to measure");
  if (b.x.extent(0) > 0) detail::check_size(mesh, b.x.extent(0), b.y.extent(0), b.z.extent(0), "baseline coordinates");
  auto const refuse_shorter = [&](std::size_t found, std::string const& what) {
    if (found > 0 && Index(found) < mesh.n_elements())
      throw MeshError(what + ": it holds " + std::to_string(found) + " elements, the mesh '" + mesh.source + "' has " +
                      std::to_string(mesh.n_elements()));
  };
  refuse_shorter(input.near_field.extent(0), "near-field mask");
  for (std::size_t m = 0; m < n_measures; ++m)
    refuse_shorter(input.fields.of[m].extent(0), "field of " + std::string(to_string(Measure(m))));
}

/// Adds non-orthogonality and face skewness to the sums of the chunks.
template <class Exec, class Chunks, class FirstElement>
void measure_faces(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                   UnstructuredQualityInput<typename Exec::memory_space> const& input,
                   detail::ElementTables<typename Exec::memory_space> const& tables,
                   detail::PackedPoints<typename Exec::memory_space> const& points, Chunks const& chunks,
                   FirstElement const& first_element, std::vector<detail::PartialSums>& out) {
  using MemorySpace = typename Exec::memory_space;
  auto const centres = detail::element_centres(exec, tables, points, mesh.dimension == 3);
  detail::LinkedSides const linked = detail::linked_sides(mesh, topology);
  detail::SideTables<MemorySpace> const sides{
      detail::view_of(exec, topology.sides.first, "gridmorph::quality::first_side"),
      detail::view_of(exec, linked.links.empty() ? topology.sides.neighbour : linked.neighbour,
                      "gridmorph::quality::neighbour"),
      detail::upload(exec, "gridmorph::quality::links", linked.links)};
  auto const near_field = input.near_field;
  auto const angles = input.fields.of[int(Measure::non_orthogonality_deg)],
             skewnesses = input.fields.of[int(Measure::face_skewness)];
  Kokkos::View<detail::FaceSums*, MemorySpace> const sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::face_sums"), out.size());
  kernels::visit_chunks(
      exec, "gridmorph::measure_quality::faces", chunks, sums,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::FaceSums& s) {
        for (int n = 0; n < row.count; ++n) {
          Index const e = first_element(row.zone) + row.i + n;
          detail::FaceQuality const q = detail::face_quality(tables, sides, points, centres, e);
          if (angles.extent(0) > 0) angles(e) = q.non_orthogonality_deg;
          if (skewnesses.extent(0) > 0) skewnesses(e) = q.skewness;
          int const region = near_field.extent(0) > 0 && near_field(e) != 0 ? 0 : 1;
          s.non_orthogonality_deg[region].template add<1>(&q.non_orthogonality_deg, 1, e, true);
          s.skewness[region].template add<1>(&q.skewness, 1, e, true);
        }
      });
  auto const sums_h = detail::download(exec, sums);
  for (std::size_t c = 0; c < out.size(); ++c)
    for (int r = 0; r < 2; ++r) {
      out[c].region[r].measure[int(Measure::non_orthogonality_deg)] = sums_h(c).non_orthogonality_deg[r];
      out[c].region[r].measure[int(Measure::face_skewness)] = sums_h(c).skewness[r];
    }
}

/// Measures and sums of all elements, chunk after chunk of detail::element_chunks().
template <class Exec>
std::vector<detail::PartialSums> measure_elements(Exec const& exec, Mesh const& mesh,
                                                  UnstructuredTopology const& topology,
                                                  UnstructuredQualityInput<typename Exec::memory_space> const& input,
                                                  std::vector<signed char> const& sign_of) {
  using MemorySpace = typename Exec::memory_space;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  std::vector<kernels::CellChunk> const table = detail::element_chunks(mesh);
  auto const tables = detail::element_tables(exec, mesh);
  auto const first_element = detail::upload(exec, "gridmorph::quality::zones", detail::first_elements(mesh));
  auto const signs = detail::view_of(exec, sign_of, "gridmorph::quality::signs");
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  bool const fast = input.fast;
  Kokkos::View<double*, MemorySpace> volumes = input.fields.of[int(Measure::volume)];
  if (volumes.extent(0) == 0 && !fast)
    volumes = Kokkos::View<double*, MemorySpace>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volumes"), mesh.n_elements());
  Kokkos::View<detail::PartialSums*, MemorySpace> const sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::sums"), table.size());
  auto const coordinates = detail::pack(exec, input.coordinates, mesh.n_nodes());
  auto const baseline = detail::pack(exec, input.baseline, against_baseline && !fast ? mesh.n_nodes() : 0);
  auto const original = input.baseline;
  auto const near_field = input.near_field;
  bool const has_near_field = near_field.extent(0) > 0;
  auto const fields = input.fields;
  CellLimits const limits = input.limits;
  detail::CellScreen const screen(limits);
  kernels::visit_chunks(
      exec, "gridmorph::measure_quality::elements", chunks, sums,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::PartialSums& s) {
        for (int n = 0; n < row.count; ++n) {
          Index const e = first_element(row.zone) + row.i + n;
          auto const keep = [&](Measure measure, double value) {
            if (fields.of[int(measure)].extent(0) > 0) fields.of[int(measure)](e) = value;
          };
          double const sign = signs(e);
          kernels::CellMeasures const m = tables.measures(coordinates, e, sign);
          auto& region = s.region[has_near_field && near_field(e) != 0 ? 0 : 1];
          auto const add = [&](Measure measure, double value) {
            region.template add<1>(measure, &value, 1, e);
            keep(measure, value);
          };
          add(Measure::determinant_3x3x3, m.determinant_3x3x3);
          add(Measure::minimum_angle_deg, m.minimum_angle_deg);
          region.cells += 1;
          region.collapsed += m.collapsed ? 1 : 0;
          detail::count_state(region, m.smallest_corner_jacobian);
          if (against_baseline &&
              screen.may_fall(m.determinant_3x3x3, m.minimum_angle_deg, m.equiangle_skewness, m.collapsed))
            detail::judge(region, limits, tables.measures(original, e, sign), m, e,
                          [&] { return tables.flat_element(original, coordinates, e, sign); });
          if (fast) continue;
          volumes(e) = m.volume;
          add(Measure::aspect_ratio, m.aspect_ratio);
          add(Measure::determinant_2x2x2, m.determinant_2x2x2);
          add(Measure::equiangle_skewness, m.equiangle_skewness);
          add(Measure::volume, m.volume);
          if (against_baseline)
            add(Measure::relative_displacement, tables.relative_displacement(baseline, coordinates, e));
        }
      });
  auto const sums_on_host = [&] {
    auto const h = detail::download(exec, sums);
    return std::vector<detail::PartialSums>(h.data(), h.data() + table.size());
  };
  if (fast) return sums_on_host();

  std::vector<Index32> const across = detail::neighbours_across(topology);
  CsrViews<MemorySpace> const neighbours{
      detail::view_of(exec, topology.sides.first, "gridmorph::quality::first_side"),
      detail::view_of(exec, across.empty() ? topology.sides.neighbour : across, "gridmorph::quality::neighbour")};
  Kokkos::View<double const*, MemorySpace> const all_volumes = volumes;
  Kokkos::View<detail::NeighbourRatios*, MemorySpace> const ratios(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volume_ratios"), table.size());
  auto const ratio_field = fields.of[int(Measure::volume_ratio)];
  kernels::visit_chunks(
      exec, "gridmorph::measure_quality::volume_ratio", chunks, ratios,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::NeighbourRatios& s) {
        for (int n = 0; n < row.count; ++n) {
          Index const e = first_element(row.zone) + row.i + n;
          double const ratio = detail::worst_ratio(all_volumes, neighbours, e);
          if (ratio_field.extent(0) > 0) ratio_field(e) = ratio;
          s.region[has_near_field && near_field(e) != 0 ? 0 : 1].template add<1>(
              &ratio, 1, e, larger_is_worse(Measure::volume_ratio));
        }
      });
  auto const ratios_h = detail::download(exec, ratios);
  std::vector<detail::PartialSums> out = sums_on_host();
  for (std::size_t k = 0; k < table.size(); ++k)
    for (int r = 0; r < 2; ++r) out[k].region[r].measure[int(Measure::volume_ratio)] = ratios_h(k).region[r];
  auto const asked_for = [&](Measure m) { return input.fields.of[int(m)].extent(0) > 0; };
  if (input.faces || asked_for(Measure::non_orthogonality_deg) || asked_for(Measure::face_skewness))
    measure_faces(exec, mesh, topology, input, tables, detail::PackedPoints<MemorySpace>(coordinates), chunks,
                  first_element, out);
  return out;
}

}  // namespace

template <BuiltFor Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                              BoundaryFacePatches const& face_patches,
                              UnstructuredQualityInput<typename Exec::memory_space> const& input) {
  check_sizes(mesh, input);
  auto const signs = detail::signs_of(host_instance(exec), mesh, topology.sides, input.signs);
  auto const sums = measure_elements(exec, mesh, topology, input, signs);
  QualityReport report;
  detail::combine(sums.size(), sums.data(), report.near_field, report.far_field,
                  [&](Index element) { return detail::place_of_element(mesh, element); });
  if (input.fast) {
    detail::keep_verdict(report);
  } else {
    for (auto const& named : input.regions) {
      auto part = input;
      part.near_field = named.elements;
      part.fields = {};
      check_sizes(mesh, part);
      auto const of_region = measure_elements(exec, mesh, topology, part, signs);
      NamedRegion region{named.name, {}};
      QualityRegion others;
      detail::combine(of_region.size(), of_region.data(), region.quality, others,
                      [&](Index element) { return detail::place_of_element(mesh, element); });
      report.regions.push_back(std::move(region));
    }
    detail::WallQualities walls = detail::wall_quality(exec, mesh, topology, face_patches, input);
    report.wall = walls.all;
    report.wall_groups = std::move(walls.groups);
  }
  for (auto const& zone : mesh.zones) report.zone_names.push_back(zone.name);
  for (auto const& zone : mesh.zones) {
    auto const begin = signs.begin() + zone.first_element, end = begin + zone.n_elements;
    report.left_handed_zones += std::count(begin, end, -1) > std::count(begin, end, 1) ? 1 : 0;
  }
  report.against_baseline = input.baseline.x.extent(0) > 0;
  report.unstructured = true;
  return report;
}

template <BuiltFor Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
    UnstructuredQualityInput<typename Exec::memory_space> const& input, std::span<Measure const> measures) {
  auto with_fields = input;
  std::vector<Kokkos::View<double*, typename Exec::memory_space>> result;
  for (Measure const m : measures) {
    auto& field = with_fields.fields[m];
    if (field.extent(0) == 0)
      field = Kokkos::View<double*, typename Exec::memory_space>(
          Kokkos::view_alloc(exec, "gridmorph::cell_fields::" + std::string(to_string(m))), mesh.n_elements());
    result.push_back(field);
  }
  check_sizes(mesh, with_fields);
  with_fields.fast = false;
  measure_elements(exec, mesh, topology, with_fields,
                   detail::signs_of(host_instance(exec), mesh, topology.sides, input.signs));
  return result;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                               \
  template QualityReport measure_quality(Exec const&, Mesh const&, UnstructuredTopology const&,                   \
                                         BoundaryFacePatches const&,                                              \
                                         UnstructuredQualityInput<Exec::memory_space> const&);                    \
  template std::vector<Kokkos::View<double*, Exec::memory_space>> cell_fields(                                    \
      Exec const&, Mesh const&, UnstructuredTopology const&, UnstructuredQualityInput<Exec::memory_space> const&, \
      std::span<Measure const>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
