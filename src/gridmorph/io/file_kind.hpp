// What a file is, by its first bytes and its name: formats that are read, and those that others use.
#pragma once

#include <string>
#include <string_view>

namespace gridmorph {

/// Formats of meshes that are read and written.
enum class MeshFormat { cgns, plot3d, su2, openfoam, gmsh, vtk, ugrid };

/// The name of a format: "CGNS", "PLOT3D", "SU2", "OpenFOAM", "Gmsh", "VTK", "UGRID".
std::string_view to_string(MeshFormat format);

/// Whether files of a format have a place for fields of the nodes and cells.
constexpr bool holds_fields(MeshFormat format) { return format == MeshFormat::cgns || format == MeshFormat::vtk; }

/// Whether a series of meshes over time goes into one output of a format.
constexpr bool holds_series(MeshFormat format) { return format == MeshFormat::cgns || format == MeshFormat::openfoam; }

/// The format of a file by its first bytes, of UGRID by the ending, of a folder by what is in it; what is none of the
/// others counts as PLOT3D. Throws IoError as refuse_other_format() does.
MeshFormat mesh_format(std::string const& path);

/// Whether there is a file or folder of that name, or an OpenFOAM case whose .foam file nobody made or whose latest
/// time is meant.
bool is_there(std::string const& path);

/// Throws IoError that names the format of a file or folder of another program (Fluent, Exodus, STL,
/// ...) and says how to convert it. What is recognised as nothing of the kind passes. Reads at most 256 kB.
void refuse_other_format(std::string const& path);

/// The format that the ending of a file name stands for ("VTK", "STL", "CGNS", ...); empty where it says nothing
/// certain.
std::string_view format_of_ending(std::string_view path);

}  // namespace gridmorph
