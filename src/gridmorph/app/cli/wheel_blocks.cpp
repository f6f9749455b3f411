#include <gridmorph/app/block_mesh.hpp>
#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/wheel_passage.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/quality/certificate.hpp>
#include <gridmorph/wheel/wheel_motion.hpp>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

class BlockPassagePlan final : public PassagePlan {
 public:
  BlockPassagePlan(Mesh const& mesh, PassageLinks const& links, WheelRows const& rows, WheelSetup const& setup,
                   CaseFile const& case_file)
      : mesh_(mesh),
        case_(case_file),
        motion_(mesh, links, rows, setup.at(setup.moments.front()), setup.same_rules(), case_file.plan, setup.blades),
        morpher_(exec_, motion_.plan(), mesh.coordinates) {}

  [[nodiscard]] PassageMotions const& passages() const override { return motion_.passages(); }
  void move(std::vector<Motion> const& motions) override { motion_.move(motions); }
  [[nodiscard]] std::vector<Vec3> displacement(int m, Motion const& motion) const override {
    return motion_.displacement(m, motion);
  }
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary) const override {
    return motion_.trims(boundary);
  }
  [[nodiscard]] std::vector<std::string> const& notes() const override { return motion_.notes(); }
  [[nodiscard]] NearCells near() const override { return near_cells_of(mesh_, motion_.plan(), case_); }
  RelaxReport morph(std::vector<Vec3> const& boundary, Coordinates& morphed) override {
    Kokkos::View<Vec3 const*, Exec::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const given(boundary.data(),
                                                                                                       boundary.size());
    morpher_.positions(exec_, given, morphed);
    exec_.fence();
    return {};
  }
  [[nodiscard]] MeshForMessages for_messages() const override { return cli::for_messages(mesh_); }

 private:
  Exec exec_;
  Mesh const& mesh_;
  CaseFile const& case_;
  WheelMotion motion_;
  Morpher<Exec> morpher_;
};

class BlockPassage final : public PassageMesh {
 public:
  explicit BlockPassage(CaseFile const& case_file)
      : BlockPassage(load_mesh(case_file.input, case_file.side_file, case_file.leave_out), case_file.plan.topology) {}

  [[nodiscard]] KindTraits const& kind() const override { return BlockMesh::traits(); }
  [[nodiscard]] Mesh const& mesh() const override { return mesh_.mesh(); }
  [[nodiscard]] Index n_cells() const override { return mesh_.n_cells(); }
  [[nodiscard]] PassageLinks const& links() const override { return links_; }
  [[nodiscard]] WheelMesh wheel(WheelRows const& rows, std::vector<int> const& passages,
                                WheelFamilies families) const override {
    return make_wheel_mesh(mesh(), links_, rows, passages, families);
  }
  [[nodiscard]] std::unique_ptr<page::PictureMesh> pictures() const override { return mesh_.pictures(); }
  [[nodiscard]] QualityReport measure(QualityWanted const& wanted) const override { return mesh_.measure(wanted); }
  [[nodiscard]] Boundary boundary() const override { return mesh_.boundary(); }
  [[nodiscard]] Certificate certify(Coordinates const& placed, std::vector<int> const& zones) const override {
    CertificateInput<Kokkos::HostSpace> input{views(placed), views(mesh().coordinates), mesh_.handedness()};
    input.zones = zones;
    return gridmorph::certify(Exec(), mesh(), input);
  }
  [[nodiscard]] std::unique_ptr<PassagePlan> plan(CaseFile const& case_file, WheelRows const& rows,
                                                  WheelSetup const& setup) const override {
    return std::make_unique<BlockPassagePlan>(mesh(), links_, rows, setup, case_file);
  }

 private:
  BlockPassage(Mesh mesh, TopologyOptions const& options)
      : links_(passage_links(mesh, connect_and_check(mesh, options), options)), mesh_(std::move(mesh)) {}

  PassageLinks links_;
  BlockMesh mesh_;
};

}  // namespace

std::unique_ptr<PassageMesh> block_passage(CaseFile const& case_file) {
  return std::make_unique<BlockPassage>(case_file);
}

}  // namespace gridmorph::cli
