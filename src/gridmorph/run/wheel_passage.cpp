#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/guarded_elements.hpp>
#include <gridmorph/run/wheel_passage.hpp>

#include <algorithm>
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
      rows_(rows),
      smooth_(case_file.guard.smooth),
      motion_(mesh_.indexed(), passage.links(), rows, setup.at(setup.moments.front()), setup.same_rules(),
              with_background(case_file, mesh_.mesh()), setup.blades,
              {case_file.sequence ? int(setup.moments.size()) : 0,
               [&](int step) { return setup.at(setup.moments[std::size_t(step)]); }}),
      morpher_(std::in_place, Exec(), motion_.plan(), mesh_.coordinates()) {}

void PassagePlan::morph(std::vector<Vec3> const& boundary, Coordinates& morphed) {
  apply_on_host(*morpher_, boundary, morphed);
}

GuardReport PassagePlan::relax(Coordinates& morphed) const {
  if (motion_.plan().smoothing()) return {};
  if (!mesh_.is_structured()) return guard({}, mesh_.indexed(), motion_.plan(), morphed);
  GuardReport out;
  if (!smooth_) return out;
  MorphPlan const& plan = motion_.plan();
  for (WheelRow const& row : rows_.rows) {
    ShapeSmoothingOptions const of_row{.zones = row.zones};
    GuardReport const own = report_of(frozen_ ? smooth_frozen({}, mesh_.indexed(), plan, morphed, *frozen_, of_row)
                                              : smooth_shapes({}, mesh_.indexed(), plan, morphed, of_row));
    out.before += own.before;
    out.after += own.after;
    out.rounds = std::max(out.rounds, own.rounds);
    out.inverted_before += own.inverted_before;
    out.inverted_after += own.inverted_after;
  }
  return out;
}

void PassagePlan::freeze(Coordinates const& morphed) {
  if (!frozen_) frozen_.emplace();
  frozen_->join(lost_shapes({}, mesh_.indexed(), morphed));
}

void PassagePlan::record(std::vector<Vec3> const& boundary, Coordinates const& plain, Coordinates const& guarded) {
  if (!record_) record_.emplace(motion_.plan());
  record_->add(boundary, plain, guarded);
}

SmoothingMap const& PassagePlan::freeze_recorded() {
  motion_.freeze(record_->map({.part_of_node = part_of_nodes()}));
  record_.reset();
  morpher_.emplace(Exec(), motion_.plan(), mesh_.coordinates());
  return *motion_.plan().smoothing();
}

/// The row of each node; rows of elements that touch, whose nodes at one place move as one, are one part.
std::vector<int> PassagePlan::part_of_nodes() const {
  DisjointSets<int> parts(rows_.rows.size());
  auto const row_of = [&](Index n) { return rows_.row_of_zone[std::size_t(mesh_.mesh().zone_of(n))]; };
  std::vector<int> out;
  for (Index n = 0; n < mesh_.n_nodes(); ++n) out.push_back(row_of(n));
  if (auto const elements = PlanAccess::guarded_elements(motion_.plan()))
    for (std::size_t n = 0; n < out.size(); ++n)
      parts.join(out[n], out[std::size_t(elements->graph.representative[n])]);
  for (int& part : out) part = parts.root(part);
  return out;
}

MeshForMessages PassagePlan::for_messages() const {
  return mesh_.is_structured() ? cli::for_messages(mesh_.mesh())
                               : cli::for_messages(mesh_.mesh(), motion_.plan().rules().boundary());
}

}  // namespace gridmorph::cli
