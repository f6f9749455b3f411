#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/wheel_passage.hpp>
#include <gridmorph/app/element_mesh.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/quality/certificate.hpp>
#include <gridmorph/wheel/element_wheel_motion.hpp>

#include <memory>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

class ElementPassagePlan final : public PassagePlan {
 public:
  ElementPassagePlan(ElementMesh const& mesh, PassageLinks const& links, WheelRows const& rows, WheelSetup const& setup,
                     CaseFile const& case_file)
      : mesh_(mesh),
        motion_(mesh.mesh, mesh.topology, mesh.face_patches, links, rows, setup.at(setup.moments.front()),
                setup.same_rules(), with_background(case_file), setup.blades,
                {case_file.sequence ? int(setup.moments.size()) : 0,
                 [&](int step) { return setup.at(setup.moments[std::size_t(step)]); }}),
        morpher_(Exec(), motion_.prepared().plan, mesh.coordinates()) {}

  [[nodiscard]] PassageMotions const& passages() const override { return motion_.passages(); }
  void move(std::vector<Motion> const& motions) override { motion_.move(motions); }
  [[nodiscard]] std::vector<Vec3> displacement(int m, Motion const& motion) const override {
    return motion_.displacement(m, motion);
  }
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary) const override {
    return gridmorph::trims(motion_.prepared().boundary, boundary);
  }
  [[nodiscard]] std::vector<std::string> const& notes() const override { return motion_.notes(); }
  [[nodiscard]] NearCells near() const override { return near_elements_of(motion_.prepared()); }
  RelaxReport morph(std::vector<Vec3> const& boundary, Coordinates& morphed) override {
    apply_on_host(morpher_, boundary, morphed);
    return relax_bad_elements(mesh_.mesh, mesh_.topology, motion_.prepared(), morphed, {.signs = mesh_.signs});
  }
  [[nodiscard]] MeshForMessages for_messages() const override {
    return cli::for_messages(mesh_.mesh, motion_.prepared().boundary);
  }

 private:
  ElementMesh const& mesh_;
  ElementWheelMotion motion_;
  Morpher<Exec> morpher_;
};

/// Passages that overlap would be no wheel.
Mesh without_repeated_elements(Mesh mesh) {
  leave_out_repeated_elements(mesh);
  return mesh;
}

class ElementPassage final : public PassageMesh {
 public:
  explicit ElementPassage(CaseFile const& case_file)
      : mesh_(without_repeated_elements(load_mesh(case_file.input, case_file.side_file, case_file.leave_out))) {
    Problems problems;
    for (auto const& problem : mesh_.problems) problems.add(problem);
    problems.throw_if_any<MeshError>();
    links_ = passage_links(boundary());
  }

  [[nodiscard]] KindTraits const& kind() const override { return ElementMesh::traits(); }
  [[nodiscard]] Mesh const& mesh() const override { return mesh_.mesh; }
  [[nodiscard]] Index n_cells() const override { return mesh_.n_cells(); }
  [[nodiscard]] PassageLinks const& links() const override { return links_; }
  [[nodiscard]] std::vector<std::string> notes() const override { return mesh_.notes(); }
  [[nodiscard]] WheelMesh wheel(WheelRows const& rows, std::vector<int> const& passages,
                                WheelFamilies families) const override {
    if (mesh().file_order.node.empty()) return make_wheel_mesh(mesh(), links_, rows, passages, families);
    Mesh const ordered = gridmorph::in_file_order(mesh());
    PassageLinks links = links_;
    auto const place = node_places(mesh());
    for (PassageLink& link : links.all)
      for (auto& pair : link.pairs)
        for (Index& n : pair) n = place[std::size_t(n)];
    return make_wheel_mesh(ordered, links, rows, passages, families);
  }
  [[nodiscard]] Coordinates in_file_order(Coordinates const& x) const override {
    return gridmorph::in_file_order(mesh(), x);
  }
  [[nodiscard]] std::unique_ptr<page::PictureMesh> pictures() const override { return mesh_.pictures(); }
  [[nodiscard]] QualityReport measure(QualityWanted const& wanted) const override { return mesh_.measure(wanted); }
  [[nodiscard]] Boundary boundary() const override { return mesh_.boundary(); }
  [[nodiscard]] Certificate certify(Coordinates const& placed, std::vector<int> const& zones) const override {
    CertificateInput<Kokkos::HostSpace> input{views(placed), views(mesh_.coordinates())};
    input.signs = mesh_.signs;
    input.zones = zones;
    return gridmorph::certify(Exec(), mesh(), mesh_.topology, input);
  }
  [[nodiscard]] std::unique_ptr<PassagePlan> plan(CaseFile const& case_file, WheelRows const& rows,
                                                  WheelSetup const& setup) const override {
    return std::make_unique<ElementPassagePlan>(mesh_, links_, rows, setup, case_file);
  }

 private:
  ElementMesh mesh_;
  PassageLinks links_;
};

}  // namespace

std::unique_ptr<PassageMesh> element_passage(CaseFile const& case_file) {
  return std::make_unique<ElementPassage>(case_file);
}

}  // namespace gridmorph::cli
