#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/gmsh/gmsh_mesh.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/ugrid/ugrid_file.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/pieces.hpp>
#include <gridmorph/io/vtk/vtk_mesh.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <initializer_list>

namespace gridmorph {

namespace {

namespace fs = std::filesystem;

struct Ending {
  std::string_view ending, format;
};

/// Endings that stand for one thing. Names of PLOT3D files are free, so that only what is certainly something else
/// counts.
constexpr std::array endings{
    Ending{"cgns", "CGNS"},       Ending{"adf", "CGNS"},       Ending{"h5", "CGNS"},
    Ending{"hdf", "CGNS"},        Ending{"hdf5", "CGNS"},      Ending{"su2", "SU2"},
    Ending{"p3d", "PLOT3D"},      Ending{"p2d", "PLOT3D"},     Ending{"xyz", "PLOT3D"},
    Ending{"x", "PLOT3D"},        Ending{"g", "PLOT3D"},       Ending{"fmt", "PLOT3D"},
    Ending{"ufmt", "PLOT3D"},     Ending{"grd", "PLOT3D"},     Ending{"msh", "Gmsh"},
    Ending{"cas", "Fluent"},      Ending{"vtk", "legacy VTK"}, Ending{"vtu", "VTK"},
    Ending{"vtp", "VTK vtp"},     Ending{"vts", "VTK vts"},    Ending{"vtm", "VTK"},
    Ending{"vtmb", "VTK vtmb"},   Ending{"vti", "VTK vti"},    Ending{"vtr", "VTK vtr"},
    Ending{"pvtu", "VTK"},        Ending{"pvd", "VTK pvd"},    Ending{"vtkhdf", "VTK vtkhdf"},
    Ending{"ugrid", "UGRID"},     Ending{"exo", "Exodus"},     Ending{"exoii", "Exodus"},
    Ending{"gen", "Exodus"},      Ending{"nc", "netCDF"},      Ending{"foam", "OpenFOAM"},
    Ending{"stl", "STL"},         Ending{"obj", "OBJ"},        Ending{"ply", "PLY"},
    Ending{"csv", "CSV"},         Ending{"json", "JSON"},      Ending{"toml", "TOML"},
    Ending{"step", "CAD (STEP)"}, Ending{"stp", "CAD (STEP)"}, Ending{"igs", "CAD (IGES)"},
    Ending{"iges", "CAD (IGES)"}, Ending{"bdf", "Nastran"},    Ending{"nas", "Nastran"},
    Ending{"inp", "Abaqus"},      Ending{"unv", "I-deas"},     Ending{"cdb", "Ansys"},
    Ending{"med", "MED"},         Ending{"ccm", "STAR-CCM+"},  Ending{"plt", "Tecplot"},
    Ending{"tec", "Tecplot"},     Ending{"szplt", "Tecplot"},  Ending{"png", "picture"},
    Ending{"pdf", "PDF"},         Ending{"gz", "gzip"},        Ending{"zip", "zip"},
    Ending{"zst", "zstd"},        Ending{"bz2", "bzip2"},      Ending{"xz", "xz"},
};

std::string ending_of(std::string_view path) {
  auto const name = path.substr(path.find_last_of('/') + 1);
  auto const dot = name.find_last_of('.');
  std::string out(dot == std::string_view::npos ? std::string_view() : name.substr(dot + 1));
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return out;
}

/// What it is and how it becomes a mesh that is read; nothing where it is unknown.
struct Foreign {
  std::string_view is, remedy;
  [[nodiscard]] bool known() const { return !is.empty(); }
};

constexpr std::string_view by_gmsh = "Gmsh converts it: gmsh -save FILE -o mesh.msh";
constexpr std::string_view by_maker = "export CGNS from the program that made it";
constexpr std::string_view by_paraview =
    "open it in ParaView and save a .vtu file, convert it with scripts/convert-mesh, or export CGNS from the program "
    "that made it";
constexpr std::string_view unpack = "unpack it first";

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

bool has_all(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::all_of(parts.begin(), parts.end(), [&](std::string_view part) { return has(text, part); });
}

std::string_view without_blanks(std::string_view text) {
  auto const at = text.find_first_not_of(" \t\r\n");
  return at == std::string_view::npos ? std::string_view() : text.substr(at);
}

Foreign foreign_netcdf(std::string_view head) {
  if (has(head, "num_nod_per_el") || has(head, "coordx") || has(head, "num_el_blk"))
    return {"an Exodus mesh (netCDF)", by_paraview};
  if (has(head, "points_of_")) return {"a TAU mesh (netCDF)", by_maker};
  return {"a netCDF file", by_maker};
}

/// HDF5 files without the marks of CGNS.
Foreign foreign_hdf5(std::string_view head) {
  if (has(head, "CGNSLibraryVersion") || has(head, "CGNSBase_t") || has(head, "hdf5version")) return {};
  if (has(head, "_NCProperties") || has(head, "_Netcdf4")) return foreign_netcdf(head);
  if (has(head, "VTKHDF")) return {"a VTK file (VTKHDF)", by_paraview};
  if (has(head, "ENS_MAA") || has(head, "INFOS_GENERALES")) return {"a MED mesh", by_gmsh};
  if (has_all(head, {"meshes", "settings"})) return {"a Fluent case (HDF5)", "export CGNS from Fluent"};
  return {};
}

bool is_binary_stl(std::string_view head, std::uintmax_t size) {
  if (size < 84 || head.size() < 84) return false;
  std::uint32_t n = 0;
  for (int b = 3; b >= 0; --b) n = 256 * n + static_cast<unsigned char>(head[80 + b]);
  return n > 0 && size == 84 + 50 * std::uintmax_t(n);
}

/// Whether a text begins as a Fluent file does, "(0 ", "(2 3)", "(1 "...: it is a list of sections that begin with
/// their number.
bool is_fluent(std::string_view text) {
  if (!text.starts_with('(')) return false;
  text = without_blanks(text.substr(1));
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

/// The text up to the end of its line, without it and blanks around it.
std::string_view first_line(std::string_view text) {
  auto const line = without_blanks(text.substr(0, text.find('\n')));
  return line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
}

std::string_view after_line(std::string_view text) {
  auto const end = text.find('\n');
  return end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
}

/// The text from the first line on that says something: no blank one, and none that begins as comments do.
std::string_view without_comments(std::string_view text, std::string_view comment) {
  while (!text.empty() && (first_line(text).empty() || first_line(text).starts_with(comment))) text = after_line(text);
  return text;
}

/// Whether a line begins with one of these words, whatever their case, and it ends there.
bool begins_with(std::string_view line, std::initializer_list<std::string_view> words) {
  auto const upper = [](char c) { return char(std::toupper(static_cast<unsigned char>(c))); };
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return line.size() >= word.size() &&
           std::equal(word.begin(), word.end(), line.begin(), [&](char a, char b) { return a == upper(b); }) &&
           (line.size() == word.size() || has(" ,*\t=('", line.substr(word.size(), 1)));
  });
}

/// The first card of a bulk data file, or what comes before them: executive and case control.
bool is_nastran(std::string_view text) {
  return begins_with(first_line(without_comments(text, "$")),
                     {"NASTRAN", "SOL",    "CEND",   "ID",     "ASSIGN", "INIT",   "BEGIN BULK", "INCLUDE", "TITLE",
                      "GRID",    "GRDSET", "CORD2R", "CORD2C", "CTETRA", "CPENTA", "CHEXA",      "CPYRAM",  "CQUAD4",
                      "CQUAD8",  "CTRIA3", "CTRIA6", "PSOLID", "PSHELL", "MAT1",   "PARAM"}) &&
         (text.starts_with('$') || begins_with(first_line(text), {"NASTRAN", "SOL", "CEND", "BEGIN BULK"}) ||
          has_all(text, {"GRID"}));
}

/// Data sets between lines of -1, each beginning with its number.
bool is_unv(std::string_view text) {
  if (first_line(text) != "-1") return false;
  auto const number = first_line(after_line(text));
  return !number.empty() && number.size() <= 6 &&
         std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_abaqus(std::string_view text) {
  return begins_with(first_line(without_comments(text, "**")),
                     {"*HEADING", "*NODE", "*PART", "*PREPRINT", "*ELEMENT", "*INCLUDE", "*PARAMETER"});
}

Foreign foreign_text(std::string_view head) {
  auto const text = without_blanks(head);
  if (text.starts_with("# vtk DataFile")) return {"a legacy VTK file (.vtk)", by_paraview};
  auto const start = text.substr(0, 1024);
  if (has(start, "<VTKFile")) return {"a VTK file (XML)", by_paraview};
  if (has(start, "<Xdmf")) return {"an XDMF file", by_paraview};
  if (is_fluent(text)) return {"a Fluent mesh", "export CGNS from Fluent, or open it in ParaView and save a .vtu file"};
  if (has(text.substr(0, 4096), "FoamFile"))
    return {"one file of an OpenFOAM case", "name the folder of the case, or its constant/polyMesh"};
  if (text.starts_with("solid") && (has(start, "facet") || has(start, "endsolid")))
    return {"an STL surface", "it has no volume to morph; use it as file of a rule \"target\""};
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return {"a PLY surface", by_maker};
  if (text.starts_with("ISO-10303-21")) return {"a CAD file (STEP)", "give the mesh that was made from it"};
  if (text.starts_with("#!TDV") || text.starts_with("#!SZ")) return {"a Tecplot file", "export CGNS from Tecplot"};
  if (has_all(start, {"VARIABLES", "ZONE"}) && (text.starts_with("TITLE") || text.starts_with("VARIABLES")))
    return {"a Tecplot file", "export CGNS from Tecplot"};
  if (is_abaqus(text)) return {"an Abaqus mesh", by_gmsh};
  if (has(start, "BEGIN BULK") || is_nastran(text)) return {"a Nastran mesh", by_gmsh};
  if (is_unv(text)) return {"an I-deas mesh (UNV)", by_gmsh};
  if (text.starts_with("/COM,ANSYS") || text.starts_with("/PREP7") || text.starts_with("NBLOCK,"))
    return {"an Ansys mesh (CDB)", by_maker};
  if (text.starts_with("CONTROL INFO")) return {"a Gambit neutral file", by_maker};
  if (text.starts_with("# vtk") || text.starts_with("<?xml")) return {"an XML file", by_maker};
  if (has(head, "[[motion]]") || has(start, "[mesh]"))
    return {"a case file", "give it to gridmorph morph or plan; here the mesh itself is asked for"};
  return {};
}

Foreign foreign(std::string_view head, std::uintmax_t size, std::string const& ending) {
  using namespace std::string_view_literals;
  if (head.starts_with("\x1f\x8b"sv)) return {"packed (gzip)", unpack};
  if (head.starts_with("PK\x03\x04"sv)) return {"packed (zip)", unpack};
  if (head.starts_with("BZh"sv)) return {"packed (bzip2)", unpack};
  if (head.starts_with("\xfd"
                       "7zXZ"sv))
    return {"packed (xz)", unpack};
  if (head.starts_with("\x28\xb5\x2f\xfd"sv)) return {"packed (zstd)", unpack};
  if (head.starts_with("%PDF"sv) || head.starts_with("\x89PNG"sv))
    return {"a picture or document", "name the mesh file"};
  if (head.starts_with("CDF\x01"sv) || head.starts_with("CDF\x02"sv) || head.starts_with("CDF\x05"sv))
    return foreign_netcdf(head);
  if (head.starts_with("\x89HDF\r\n\x1a\n"sv)) return foreign_hdf5(head);
  if (auto const text = foreign_text(head); text.known()) return text;
  if (ending == "stl" && is_binary_stl(head, size))
    return {"an STL surface", "it has no volume to morph; use it as file of a rule \"target\""};
  return {};
}

/// A folder, or an empty file in it that stands for it, as ParaView wants it.
bool is_openfoam(fs::path const& path) {
  std::error_code ignored;
  // Times of a decomposed case are folders of its parts.
  bool const named = ending_of(path.string()) == "foam" || !fs::exists(path, ignored);
  return (fs::is_directory(path, ignored) || named) && !foam::parts_of(path).empty();
}

Foreign foreign_folder(fs::path const& path) {
  std::error_code ignored;
  for (fs::directory_iterator entry(path, ignored), end; !ignored && entry != end; entry.increment(ignored))
    if (entry->path().filename().string().starts_with("processors"))
      return {"a decomposed OpenFOAM case with the parts of several processors in one file",
              "write a folder for each processor (-fileHandler uncollated), or put the parts together "
              "(reconstructParMesh)"};
  if (fs::exists(path / "constant", ignored) || fs::exists(path / "system", ignored))
    return {"an OpenFOAM case without a mesh", "make it first (blockMesh, snappyHexMesh, reconstructParMesh)"};
  return {};
}

}  // namespace

bool is_there(std::string const& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) || is_openfoam(path);
}

std::string_view to_string(MeshFormat format) {
  switch (format) {
    case MeshFormat::cgns: return "CGNS";
    case MeshFormat::plot3d: return "PLOT3D";
    case MeshFormat::su2: return "SU2";
    case MeshFormat::openfoam: return "OpenFOAM";
    case MeshFormat::gmsh: return "Gmsh";
    case MeshFormat::vtk: return "VTK";
    case MeshFormat::ugrid: return "UGRID";
  }
  return "";
}

void refuse_other_format(std::string const& path) {
  if (is_openfoam(path)) return;
  std::error_code failure;
  auto const status = fs::status(path, failure);
  Foreign found;
  if (fs::is_directory(status))
    found = foreign_folder(path);
  else if (fs::is_regular_file(status))
    found = foreign(io::read_head(path), fs::file_size(path, failure), ending_of(path));
  if (found.known())
    throw IoError(path + ": is " + std::string(found.is) +
                  "; read are CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK (.vtu, .pvtu, .vtm) and UGRID. " +
                  std::string(found.remedy));
}

MeshFormat mesh_format(std::string const& path) {
  if (su2::is_su2(path)) return MeshFormat::su2;
  if (is_openfoam(path)) return MeshFormat::openfoam;
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {
    std::string const head = io::read_head(path);
    if (gmsh::is_gmsh(head)) return MeshFormat::gmsh;
    if (vtk::is_vtu(head) || vtk::is_parallel(head) || vtk::is_blocks(head)) return MeshFormat::vtk;
  }
  if (fs::is_regular_file(path, ignored) && ugrid::is_ugrid(path)) return MeshFormat::ugrid;
  refuse_other_format(path);
  return cgns::is_cgns(path) ? MeshFormat::cgns : MeshFormat::plot3d;
}

std::string_view format_of_ending(std::string_view path) {
  std::string const ending = ending_of(path);
  auto const found = std::find_if(endings.begin(), endings.end(), [&](Ending const& e) { return e.ending == ending; });
  return found == endings.end() ? std::string_view() : found->format;
}

}  // namespace gridmorph
