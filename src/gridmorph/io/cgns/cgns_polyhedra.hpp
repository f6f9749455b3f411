// Elements given by their faces: NFACE_n, or NGON_n with ParentElements.
#pragma once

#include <gridmorph/io/cgns/cgns_sections.hpp>

namespace gridmorph::cgns {

/// Appends the volume elements that the sections describe by faces. Those with the faces of a tetrahedron, pyramid,
/// prism or hexahedron become one, in SIDS order; the others become polyhedra.
void add_polyhedra(std::vector<Section> const& sections, ListedFaces const& faces, std::string const& where, Mesh& mesh,
                   Problems& problems);

}  // namespace gridmorph::cgns
