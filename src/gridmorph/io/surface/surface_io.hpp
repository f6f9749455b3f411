// Surfaces in and out of files: targets of the rule `target`. What is read and refused: docs/formats.md.
//
// Readers throw IoError where a file cannot be opened, is damaged or holds something else, with the place in the file
// and what was found; they never read beyond what a file declares and holds.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// STL, binary or ASCII. A binary file is one whose size is what its number of facets says (84 + 50 n bytes), whatever
/// it begins with. Every facet keeps its own three points. Cost O(size of the file).
TargetGeometry read_stl(std::string const& path);

/// ASCII STL from text; `source` names it in messages.
TargetGeometry parse_ascii_stl(std::string_view text, std::string const& source);

/// Surfaces of a CGNS file: structured zones with one node plane become grids, unstructured zones give the triangles
/// and quadrilaterals of their sections (TRI_*, QUAD_*, MIXED, NGON_n in bases of cell dimension 2; corners only, each
/// quadrilateral as two triangles). Other elements are passed over. Structured volume zones are an error.
TargetGeometry read_cgns_surface(std::string const& path);

/// Patches of a mesh as grids, each direction 0 fastest.
TargetGeometry surface_of(Mesh const& mesh, std::vector<int> const& patches);

/// Triangles; every number names a point.
struct SurfaceTriangles {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};

/// The patches' quadrilaterals, each cut into split x split bilinear pieces of two triangles. Normals point into the
/// mesh, out of the body that it surrounds. Nodes of different patches stay apart.
SurfaceTriangles triangulate(Mesh const& mesh, std::vector<int> const& patches, int split = 1);

enum class StlFormat { binary, ascii };

/// Writes an STL file; binary files hold single precision, ASCII ones 17 digits. The file appears whole or not at all.
/// Throws MachineError.
void write_stl(std::string const& path, SurfaceTriangles const& surface, StlFormat format = StlFormat::binary);

}  // namespace gridmorph
