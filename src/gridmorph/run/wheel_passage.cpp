#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/run/wheel_passage.hpp>

#include <utility>

namespace gridmorph::cli {

namespace {

/// Of elements later, once they are in order; passages that overlap would be no wheel.
PassageLinks links_of_blocks(Mesh& mesh, TopologyOptions const& options) {
  if (mesh.is_structured()) return passage_links(mesh, connect_and_check(mesh, options), options);
  leave_out_repeated_elements(mesh);
  return {};
}

}  // namespace

WheelPassage::WheelPassage(CaseFile const& case_file)
    : WheelPassage(case_file, load_mesh(case_file.input, case_file.side_file, case_file.leave_out)) {}

WheelPassage::WheelPassage(CaseFile const& case_file, Mesh mesh)
    : links_(links_of_blocks(mesh, case_file.plan.topology)), loaded_(std::move(mesh)) {
  if (loaded_.is_structured()) return;
  Problems problems;
  for (auto const& problem : loaded_.problems()) problems.add(problem);
  problems.throw_if_any<MeshError>();
  links_ = passage_links(loaded_.boundary());
}

WheelMesh WheelPassage::wheel(WheelRows const& rows, std::vector<int> const& passages, WheelFamilies families) const {
  if (mesh().file_order.node.empty()) return make_wheel_mesh(mesh(), links_, rows, passages, families);
  Mesh const ordered = gridmorph::in_file_order(mesh());
  PassageLinks links = links_;
  auto const place = node_places(mesh());
  for (PassageLink& link : links.all)
    for (auto& pair : link.pairs)
      for (Index& n : pair) n = place[std::size_t(n)];
  return make_wheel_mesh(ordered, links, rows, passages, families);
}

Coordinates WheelPassage::in_file_order(Coordinates const& x) const {
  return loaded_.is_structured() ? x : gridmorph::in_file_order(mesh(), x);
}

PassagePlan::PassagePlan(WheelPassage const& passage, CaseFile const& case_file, WheelRows const& rows,
                         WheelSetup const& setup)
    : mesh_(passage.loaded()),
      motion_(mesh_.indexed(), passage.links(), rows, setup.at(setup.moments.front()), setup.same_rules(),
              with_background(case_file, mesh_.mesh()), setup.blades,
              {case_file.sequence ? int(setup.moments.size()) : 0,
               [&](int step) { return setup.at(setup.moments[std::size_t(step)]); }}),
      morpher_({}, motion_.plan(), mesh_.coordinates()) {}

GuardReport PassagePlan::morph(std::vector<Vec3> const& boundary, Coordinates& morphed) {
  apply_on_host(morpher_, boundary, morphed);
  if (mesh_.is_structured()) return {};
  return guard({}, mesh_.indexed(), motion_.plan(), morphed);
}

MeshForMessages PassagePlan::for_messages() const {
  return mesh_.is_structured() ? cli::for_messages(mesh_.mesh())
                               : cli::for_messages(mesh_.mesh(), motion_.plan().rules().boundary());
}

}  // namespace gridmorph::cli
