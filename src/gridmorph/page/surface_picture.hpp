// Pictures of a surface as the flow sees it, coloured by displacement.
#pragma once

#include <gridmorph/page/canvas.hpp>
#include <gridmorph/page/picture_mesh.hpp>

#include <optional>
#include <vector>

namespace gridmorph::page {

/// What of a boundary is looked at: its facets with their nodes numbered anew.
struct Surface {
  std::vector<Facet> facets;   ///< `node`: places in `nodes`
  std::vector<Index32> nodes;  ///< of the mesh
  std::vector<Vec3> baseline;  ///< (nodes)
  std::vector<char> focus;     ///< (nodes) whether a picture is to show them
  std::vector<Edge> rims;      ///< edges where what is in focus ends; places in `nodes`
};

/// Facets of the patches whose role is not negative; those of patches whose role is 1 are in focus.
Surface make_surface(std::vector<Facet> const& facets, std::vector<signed char> const& role,
                     Coordinates const& baseline);
/// A plane mesh with all of its cells; its sides on such patches are the rims.
Surface make_surface(PictureMesh::Plane const& plane, std::vector<signed char> const& role,
                     Coordinates const& baseline);

/// A parallel view: what lies along `towards` is in front.
struct View {
  Vec3 right, up, towards;  ///< unit, right x up = towards
  Vec3 centre;
  double pixels = 1;  ///< per length
};

/// From above onto a plane.
View plane_view(Surface const& surface, std::vector<Vec3> const& displacement, int width, int height);

/// Two views onto what moves most, nearly opposite: of directions oblique to the axes those from which most of the
/// moved surface is seen, of the whole where nothing moves. `up`: of the picture where it can be. displacement: (nodes)
/// of the surface.
std::array<View, 2> find_views(Surface const& surface, std::vector<Vec3> const& displacement, Vec3 const& up, int width,
                               int height);

/// The displaced surface; what turns its back on the viewer is left out, rims of the baseline are blue lines. most:
/// displacement at the end of the scale. Cost: facets and the pixels they cover.
io::Picture surface_picture(Surface const& surface, std::vector<Vec3> const& displacement, double most,
                            View const& view, int width, int height);

}  // namespace gridmorph::page
