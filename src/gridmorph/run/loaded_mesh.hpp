// A mesh of either kind as it was read, as commands and runs see it.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface/surface_io.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/page/picture_mesh.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/run/elements_as_blocks.hpp>
#include <gridmorph/run/inspect_text.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

/// Regions that are measured by themselves, of either kind of mesh.
struct MeasuredRegions {
  std::vector<NamedCells> cells = {};
  std::vector<NamedElements<Kokkos::HostSpace>> elements = {};
};

/// What of a mesh is measured, and against what.
struct QualityWanted {
  Coordinates const* morphed = nullptr;  ///< measured against the mesh, or the mesh itself where there is none
  NearCells near = {};
  MeasuredRegions regions = {};
  CellLimits limits = {};
  bool fast = false;                         ///< a verdict is enough
  std::vector<CellField>* fields = nullptr;  ///< those that go into output meshes, filled on the way
  std::vector<Measure> measures = {};        ///< these as fields; empty: all that a kind of mesh has for output meshes
};

/// Facets of patches, or their nodes.
struct PatchesAsSurface {
  std::vector<Vec3> nodes;
  SurfaceTriangles facets;
  std::size_t patches = 0;
};

/// What to look for where a mesh lacks interfaces.
struct MatchOptions {
  double tolerance = 0.01;
  bool periodic = true;
  std::optional<std::filesystem::path> side_file;  ///< where what was found goes: after `present`, its text so far
  std::string present;
};

/// "determinant_2x2x2" -> "Determinant2x2x2", as solution fields of CGNS files are called.
std::string field_name(Measure measure);

/// Words and shares of time that differ by kind.
struct KindTraits {
  std::string cells;        ///< "cells" or "elements"
  std::string planning;     ///< what is said while planning
  std::string lost;         ///< what a guard finds: "elements had lost ..."
  std::string change;       ///< what helps where cells are inverted: in one morph
  std::string change_many;  ///< and in a sequence
  std::vector<double>
      costs;  ///< of reading, planning, boundary, volume, (guard,) quality, writing: measured with millions of nodes
};

KindTraits const& traits_of(MeshKind kind);

/// A mesh, elements in order by position where their file scatters them, with what follows from it.
class LoadedMesh {
 public:
  /// As load_mesh() of side_file.hpp. find_blocks: hexahedra are taken as the blocks found among them where all lie in
  /// one; where they do not, and are all hexahedra, a note says why.
  LoadedMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
             std::vector<std::string> const& leave_out, bool find_blocks = false);
  /// Takes a mesh as it was read.
  explicit LoadedMesh(Mesh as_read);
  /// Takes hexahedra as blocks, as with find_blocks.
  void take_blocks();
  /// (zones) the zones of the file that blocks found in its elements lie in; empty where the mesh is as in the file.
  [[nodiscard]] std::vector<int> zones_in_file() const {
    return as_elements_ ? as_elements_->zone_of_block() : std::vector<int>();
  }
  /// Puts in its place the same mesh with more patches and interfaces.
  void complete(Mesh completed) { indexed_ = IndexedMesh(std::move(completed)); }

  [[nodiscard]] IndexedMesh const& indexed() const { return indexed_; }
  [[nodiscard]] Mesh const& mesh() const { return indexed_.mesh(); }
  [[nodiscard]] bool is_structured() const { return indexed_.is_structured(); }
  [[nodiscard]] KindTraits const& kind() const {
    return traits_of(is_structured() ? MeshKind::structured : MeshKind::unstructured);
  }
  [[nodiscard]] Coordinates const& coordinates() const { return mesh().coordinates; }
  [[nodiscard]] Index n_nodes() const { return mesh().n_nodes(); }
  [[nodiscard]] Index n_cells() const { return indexed_.n_cells(); }

  /// What stops a morph of elements: open faces, ...; blocks are checked where their zones are connected.
  [[nodiscard]] std::vector<std::string> const& problems() const { return problems_; }
  /// What does not: elements that are numbered inside out. Cost: their volumes.
  [[nodiscard]] std::vector<std::string> remarks() const;
  /// The notes of the reader and of the boundary faces.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// Adds one to the notes of elements.
  void remark(std::string note) { added_notes_.push_back(std::move(note)); }

  [[nodiscard]] QualityReport measure(QualityWanted const& wanted) const { return measure(wanted, mesh()); }
  /// The same with the patches of `patched`, this mesh with more of them.
  [[nodiscard]] QualityReport measure(QualityWanted const& wanted, Mesh const& patched) const;
  /// Those of another file of this mesh, as this one numbers them. Throws MeshError where it holds another mesh.
  [[nodiscard]] Coordinates coordinates_of(std::filesystem::path const& path,
                                           std::vector<std::string> const& leave_out) const;
  /// Adds interfaces that points say. Throws MeshError for elements, which have none.
  void match(MatchOptions const& options);

  [[nodiscard]] MeshSummary summary() const;
  /// What inspect shows; `quality`: a table in it.
  [[nodiscard]] std::string text(MeshSummary const& summary, std::string const& quality,
                                 SnippetOptions const& options) const;
  [[nodiscard]] nlohmann::json json(MeshSummary const& summary, SnippetOptions const& options) const;
  /// Facets with normals into the mesh, `split` pieces along each side; or nodes, each once.
  [[nodiscard]] PatchesAsSurface surface(std::vector<std::string> const& selectors, bool as_facets, int split) const;

  /// Its patches with nodes and facets.
  [[nodiscard]] Boundary boundary() const { return indexed_.boundary(); }

  /// The file `input`, which this was read from, with other coordinates: write_morphed(), SeriesWriter.
  void write(std::filesystem::path const& input, std::filesystem::path const& output, Coordinates const& morphed,
             OutputFields const& fields) const {
    write_morphed(input.string(), output.string(), in_file(), in_file(morphed), in_file(fields));
  }
  /// For viewers: write_vtk().
  void write_vtk(std::filesystem::path const& output, Coordinates const& morphed, OutputFields const& fields) const {
    gridmorph::write_vtk(output.string(), in_file(), in_file(morphed), in_file(fields));
  }
  [[nodiscard]] SeriesWriter series(std::filesystem::path const& input, std::filesystem::path const& output,
                                    std::vector<double> const& times) const {
    return {input.string(), output.string(), in_file(), times};
  }
  /// The coordinates that a file gets: those of the elements where the mesh is blocks found among them.
  [[nodiscard]] Coordinates in_file(Coordinates const& morphed) const {
    return as_elements_ ? as_elements_->coordinates(morphed) : morphed;
  }

  /// As pictures see it; the mesh must outlive it.
  [[nodiscard]] std::unique_ptr<page::PictureMesh> pictures() const;

 private:
  /// The mesh as its file has it.
  [[nodiscard]] Mesh const& in_file() const { return as_elements_ ? as_elements_->elements() : mesh(); }
  [[nodiscard]] OutputFields in_file(OutputFields const& fields) const {
    return as_elements_ ? as_elements_->fields(fields) : fields;
  }

  std::shared_ptr<ElementsAsBlocks const> as_elements_;  ///< where the mesh is blocks found among elements
  IndexedMesh indexed_;
  std::vector<std::string> problems_;
  std::vector<std::string> added_notes_;  ///< beside those of the reader
  /// Whether its solvers work by faces, so that the quality of faces is worth its time: polyhedra, or a file of
  /// OpenFOAM.
  bool by_faces_;
};

// element_summary.cpp: what inspect says of a mesh of elements.
MeshSummary summarize_elements(LoadedMesh const& loaded);
std::string inspect_elements_text(LoadedMesh const& loaded, MeshSummary const& summary, std::string const& quality,
                                  SnippetOptions const& options);
nlohmann::json inspect_elements_json(LoadedMesh const& loaded, MeshSummary const& summary,
                                     SnippetOptions const& options);

/// What is known of a mesh file before it is read.
struct MeshSource : MeshFileFacts {
  std::filesystem::path path;
  std::vector<std::string> leave_out;
  bool find_blocks = false;  ///< elements may turn out to be blocks when the mesh is read

  [[nodiscard]] KindTraits const& traits() const { return traits_of(kind); }
};

/// Throws IoError.
MeshSource look_at(std::filesystem::path const& path, std::vector<std::string> const& leave_out);

}  // namespace gridmorph::cli
