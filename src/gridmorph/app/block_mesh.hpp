// A structured mesh of the application.
#pragma once

#include <gridmorph/app/any_mesh.hpp>
#include <gridmorph/plan/plan.hpp>

namespace gridmorph::cli {

class BlockMesh final : public AnyMesh {
 public:
  /// As load_mesh() of side_file.hpp.
  BlockMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
            std::vector<std::string> const& leave_out);
  explicit BlockMesh(Mesh mesh) : mesh_(std::move(mesh)) {}

  static KindTraits const& traits();
  [[nodiscard]] Mesh const& mesh() const { return mesh_; }
  /// zone_handedness(), found once.
  [[nodiscard]] std::vector<int> const& handedness() const;

  [[nodiscard]] KindTraits const& kind() const override { return traits(); }
  [[nodiscard]] Coordinates const& coordinates() const override { return mesh_.coordinates; }
  [[nodiscard]] Index n_cells() const override { return mesh_.n_cells(); }
  [[nodiscard]] QualityReport measure(QualityWanted const& wanted) const override;
  [[nodiscard]] Coordinates coordinates_of(std::filesystem::path const& path,
                                           std::vector<std::string> const& leave_out) const override;
  void match(MatchOptions const& options) override;
  [[nodiscard]] MeshSummary summary() const override { return summarize(mesh_); }
  [[nodiscard]] std::string text(MeshSummary const& summary, std::string const& quality,
                                 SnippetOptions const& options) const override {
    return inspect_text(summary, quality, options);
  }
  [[nodiscard]] nlohmann::json json(MeshSummary const& summary, SnippetOptions const& options) const override {
    return inspect_json(summary, options);
  }
  [[nodiscard]] PatchesAsSurface surface(std::vector<std::string> const& selectors, bool as_facets,
                                         int split) const override;
  [[nodiscard]] Boundary boundary() const override { return Boundary(mesh_); }
  void write(std::filesystem::path const& input, std::filesystem::path const& output, Coordinates const& morphed,
             OutputFields const& fields) const override {
    write_morphed(input.string(), output.string(), mesh_, morphed, fields);
  }
  void write_vtk(std::filesystem::path const& output, Coordinates const& morphed,
                 OutputFields const& fields) const override {
    gridmorph::write_vtk(output.string(), mesh_, morphed, fields);
  }
  [[nodiscard]] SeriesWriter series(std::filesystem::path const& input, std::filesystem::path const& output,
                                    std::vector<double> const& times) const override {
    return {input.string(), output.string(), mesh_, times};
  }
  [[nodiscard]] std::unique_ptr<page::PictureMesh> pictures() const override {
    return page::picture_mesh(mesh_, handedness());
  }
  void check_fields(CaseFile const& case_file) const override { gridmorph::check_fields(case_file, mesh_); }
  [[nodiscard]] std::unique_ptr<AnyPlan> plan(CaseFile const& case_file) const override;

 private:
  Mesh mesh_;
  mutable std::vector<int> handedness_;
};

/// Near field of the plan and walls of the case file's boundary layers. `mesh`: with the patches of the plan.
NearCells near_cells_of(Mesh const& mesh, Plan const& plan, CaseFile const& case_file);

}  // namespace gridmorph::cli
