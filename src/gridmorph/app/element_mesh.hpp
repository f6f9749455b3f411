// An unstructured mesh of the application.
#pragma once

#include <gridmorph/app/any_mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <array>

namespace gridmorph::cli {

/// A mesh, in order by position where its file scatters it, with what follows from it.
class ElementMesh final : public AnyMesh {
 public:
  /// As load_mesh() of side_file.hpp.
  ElementMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
              std::vector<std::string> const& leave_out);
  /// Of a mesh as it was read.
  explicit ElementMesh(Mesh as_read);

  Mesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
  std::vector<signed char> signs;     ///< numbering_signs() of the mesh
  std::vector<std::string> problems;  ///< what stops a morph: open faces, ...
  std::vector<std::string> remarks;   ///< what does not: elements that are numbered inside out

  static KindTraits const& traits();
  /// Of the reader and of the boundary faces.
  [[nodiscard]] std::vector<std::string> notes() const;

  [[nodiscard]] KindTraits const& kind() const override { return traits(); }
  [[nodiscard]] Coordinates const& coordinates() const override { return mesh.coordinates; }
  [[nodiscard]] Index n_cells() const override { return mesh.n_elements(); }
  [[nodiscard]] QualityReport measure(QualityWanted const& wanted) const override;
  [[nodiscard]] Coordinates coordinates_of(std::filesystem::path const& path,
                                           std::vector<std::string> const& leave_out) const override;
  void match(MatchOptions const& options) override;
  // element_summary.cpp
  [[nodiscard]] MeshSummary summary() const override;
  [[nodiscard]] std::string text(MeshSummary const& summary, std::string const& quality,
                                 SnippetOptions const& options) const override;
  [[nodiscard]] nlohmann::json json(MeshSummary const& summary, SnippetOptions const& options) const override;
  [[nodiscard]] PatchesAsSurface surface(std::vector<std::string> const& selectors, bool as_facets,
                                         int split) const override;
  [[nodiscard]] Boundary boundary() const override { return Boundary(mesh, topology, face_patches); }
  void write(std::filesystem::path const& input, std::filesystem::path const& output, Coordinates const& morphed,
             OutputFields const& fields) const override {
    write_morphed(input.string(), output.string(), mesh, morphed, fields);
  }
  void write_vtk(std::filesystem::path const& output, Coordinates const& morphed,
                 OutputFields const& fields) const override {
    gridmorph::write_vtk(output.string(), mesh, morphed, fields);
  }
  [[nodiscard]] SeriesWriter series(std::filesystem::path const& input, std::filesystem::path const& output,
                                    std::vector<double> const& times) const override {
    return {input.string(), output.string(), mesh, times};
  }
  [[nodiscard]] std::unique_ptr<page::PictureMesh> pictures() const override {
    return page::picture_mesh(mesh, topology, face_patches, signs);
  }
  void check_fields(CaseFile const& case_file) const override { gridmorph::check_fields(case_file, mesh); }
  [[nodiscard]] std::unique_ptr<AnyPlan> plan(CaseFile const& case_file) const override;

 private:
  /// Whether its solvers work by faces, so that the quality of faces is worth its time: polyhedra, or a file of
  /// OpenFOAM.
  bool by_faces_;
};

/// Near and partially wrapped elements, and the walls that drive them.
NearCells near_elements_of(PreparedUnstructured const& prepared);
/// The plan options of a case file with its background mesh, read where it has one.
PlanOptions with_background(CaseFile const& case_file);

/// What AnyPlan::write_stages() of such a mesh may put into its folder.
inline constexpr std::array stage_names{"regions.cgns", "wrap.cgns", "background.cgns", "background_morphed.cgns"};

}  // namespace gridmorph::cli
