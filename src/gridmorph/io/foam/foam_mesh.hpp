// Meshes of OpenFOAM: folders polyMesh with points, faces, owner, neighbour and boundary. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::foam {

/// Where the files of a mesh are: all but the points, and the points, which may be those of a later time.
struct Folders {
  std::filesystem::path mesh, points;
};

/// The polyMesh folders that a path stands for: a case, a folder above polyMesh, polyMesh itself, an empty file
/// case.foam in a case; the folder of a time of a case, `case/0.5`, or its latest one, `case/latestTime`: its points
/// with the mesh in constant, where it has no mesh of its own. Nothing where there is none.
std::optional<Folders> poly_mesh(std::filesystem::path const& path);

/// What a mesh consists of: one folder polyMesh, or those of the processors that it was cut up for.
struct Part {
  Folders folders;
  int number = -1;               ///< of the processor
  std::filesystem::path folder;  ///< processor<number>
};

/// The parts of the mesh of a path, by number: the one that poly_mesh() finds, or, where a case has none, those of its
/// folders processor0, processor1, ...; by the path of such a folder all of them, whatever the case has. Of a
/// decomposed case too a time, `case/0.5`, or `case/latestTime`. None where there is no mesh.
std::vector<Part> parts_of(std::filesystem::path const& path);

/// All files that the mesh of a path consists of, its folders among them, up to that of the case.
std::vector<std::filesystem::path> files_of(std::string const& path);
/// All files and folders that write_morphed(), or TimeFolders where there are times, would write.
std::vector<std::filesystem::path> files_to_write(std::string const& input, std::string const& output,
                                                  std::vector<double> const& times);

/// Reads the mesh of a path as parts_of() takes it, parts as one mesh (foam_parts.hpp). Cells with the faces of a usual
/// shape become one, the others polyhedra. Patches keep their names, and their type as BC type; groups beside that of
/// the type are families. Matching cyclics become connections; planes of type `empty` are symmetry planes, one patch
/// for each. Throws IoError and MeshError.
Mesh read(std::string const& path);

/// Copies the polyMesh folder of `input` to that of `output`, which is made and must not hold another mesh, and
/// replaces the points that changed, in their format and precision; text reads back to the same bits. points go into
/// place last. Of a decomposed mesh each part goes to processor<number>/constant/polyMesh of `output`.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

/// A case with a mesh that moves: constant/polyMesh as it is in `input`, and for each time a folder `<time>/polyMesh`
/// with its points.
class TimeFolders {
 public:
  /// Copies the mesh. Throws IoError, also for times that have one name.
  TimeFolders(std::string const& input, std::string const& output, Mesh const& mesh, std::vector<double> const& times);
  ~TimeFolders();
  TimeFolders(TimeFolders const&) = delete;
  TimeFolders& operator=(TimeFolders const&) = delete;

  /// Writes the folder of the next time. `morphed`: in the order of the file.
  void add(Coordinates const& morphed);
  /// Makes what was written stay from now on.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridmorph::foam
