#include <gridmorph/boundary/inward_facets.hpp>

#include <gridmorph/boundary/patch_surface.hpp>

namespace gridmorph {

InwardFacets::InwardFacets(Boundary const& boundary, std::vector<int> const& patches) {
  PatchSurface const surface(boundary, patches);
  nodes_.resize(surface.points.size());
  for (PatchGrid const& grid : surface.grids)
    for (std::size_t n = 0; n < grid.nodes.size(); ++n) nodes_[grid.vertex[n]] = grid.nodes[n];
  if (!surface.lines) {
    facets_ = surface.facets();
    return;
  }
  across_ = (surface.size / norm(boundary.across())) * boundary.across();
  for (PatchGrid const& grid : surface.grids)
    for (GridFacet const& line : grid.faces)
      if (line[0] != line[1]) facets_.push_back(line);
}

FacetList InwardFacets::at(Coordinates const& x) const {
  FacetList list;
  for (Index const n : nodes_) list.points.push_back(x[n]);
  auto const beside = std::int32_t(nodes_.size());
  bool const strips = !facets_.empty() && facets_.front()[2] < 0;
  if (strips)
    for (std::int32_t n = 0; n < beside; ++n) {
      Vec3 const middle = list.points[n];
      list.points[n] = middle - across_;
      list.points.push_back(middle + across_);
    }
  // Of a line a to b the normal into the mesh is across x (b - a).
  for (GridFacet const& f : facets_)
    list.facets.push_back(strips ? std::array{f[1], f[0], f[0] + beside, f[1] + beside}
                                 : std::array{f[0], f[1], f[2], f[3]});
  return list;
}

}  // namespace gridmorph
