#include <gridmorph/plan/elements/fit_domain.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <array>

namespace gridmorph::detail {

ChartedDomain UnstructuredPlanner::find_domain() const {
  BoundaryConditions const& b = out_.boundary;
  Mask moves(std::size_t(topology_.boundary.size()), 0);
  for (Index32 const f : driving_faces_) moves[f] = 1;
  Axis const& axis = b.motion->motion().axis;
  std::vector<Axis> axes{{along_axes(out_.plan.axes, axis.origin), along_axes(out_.plan.axes, axis.direction)}};
  for (SlipSurface const& s : out_.plan.surfaces)
    if (s.kind == SlipKind::revolution || s.kind == SlipKind::meridional) axes.push_back({s.origin, s.direction});
  FittedDomain fitted = fit_domain(host_, mesh_, topology_.boundary, moves, axes);

  // What most of a side does, by area.
  enum What : std::uint8_t { nothing, stands, slips, is_image };
  std::vector<std::uint8_t> what(mesh_.n_nodes(), nothing);
  for (Index32 const n : b.slip_nodes) what[n] = slips;
  for (auto const& image : b.images) what[image.node] = what[image.owner] = is_image;
  for (Index32 const n : b.known) what[n] = stands;
  std::array<std::array<double, 4>, 6> area{};
  for (Index f = 0; f < topology_.boundary.size(); ++f) {
    int const side = fitted.side_of_face[f];
    if (side < 0 || moves[f] != 0) continue;
    auto const face = topology_.boundary.nodes[f];
    std::array<int, 4> count{};
    for (Index32 const n : face) ++count[what[owner(n)]];
    // Edges and corners belong to several sides, and stand where one of them does.
    std::size_t const kind = count[slips] > 0      ? slips
                             : count[is_image] > 0 ? is_image
                             : count[stands] > 0   ? stands
                                                   : nothing;
    area[side][kind] += boundary_face_size(mesh_, topology_.boundary, f);
  }
  using Side = ChartedDomain::Side;
  for (std::size_t s = 0; s < 6; ++s) {
    Side& side = fitted.domain.side[s / 2][s % 2];
    auto const& a = area[s];
    if (side == Side::open) continue;
    double const most = std::max(a[stands], a[nothing]);
    if (a[slips] > most && a[slips] >= a[is_image])
      side = Side::slips;
    else if (a[is_image] > most)
      side = Side::free;
  }
  return std::move(fitted.domain);
}

}  // namespace gridmorph::detail
