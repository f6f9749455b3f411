#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/guarded_elements.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/wheel_passage.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

LinkedSector linked(LoadedMesh const& loaded, PassageLinks links, Axis const& axis) {
  LinkedSector out{loaded.indexed(), std::move(links), {}};
  out.rows = find_rows(out.mesh(), out.links, axis);
  return out;
}

/// A sector of elements, whose connections pair their nodes.
LinkedSector linked_elements(LoadedMesh const& loaded, Axis const& axis) {
  Problems problems;
  for (auto const& problem : loaded.problems()) problems.add(problem);
  problems.throw_if_any<MeshError>();
  return linked(loaded, passage_links(loaded.boundary()), axis);
}

/// A sector of blocks; to connect them completes their patches.
LinkedSector linked_blocks(LoadedMesh& loaded, TopologyOptions const& options, Axis const& axis) {
  Mesh mesh = loaded.mesh();
  PassageLinks links = passage_links(mesh, connect_and_check(mesh, options), options);
  loaded.complete(std::move(mesh));
  return linked(loaded, std::move(links), axis);
}

/// The rows of blocks with the numbers of those that the elements make; nothing where they are not the same rows, as
/// where one zone of the file holds two.
std::optional<WheelRows> numbered_as(WheelRows const& rows, WheelRows const& of_elements,
                                     std::vector<int> const& zone_of_block) {
  if (rows.rows.size() != of_elements.rows.size()) return {};
  std::vector<int> number(rows.rows.size(), -1);
  for (std::size_t z = 0; z < zone_of_block.size(); ++z) {
    int const theirs = of_elements.row_of_zone[zone_of_block[z]];
    int& own = number[rows.row_of_zone[z]];
    if (own >= 0 && own != theirs) return {};
    own = theirs;
  }
  WheelRows out = rows;
  std::vector<bool> taken(number.size(), false);
  for (std::size_t r = 0; r < number.size(); ++r) {
    auto const at = std::size_t(number[r]);
    if (taken[at] || rows.rows[r].passages != of_elements.rows[at].passages) return {};
    taken[at] = true;
    out.rows[at] = rows.rows[r];
  }
  for (int& row : out.row_of_zone) row = number[row];
  return out;
}

/// Passages that overlap would be no wheel.
Mesh read_sector(CaseFile const& case_file) {
  Mesh mesh = load_mesh(case_file.input, case_file.side_file, case_file.leave_out);
  if (!mesh.is_structured()) leave_out_repeated_elements(mesh);
  return mesh;
}

LinkedSector linked_as_read(LoadedMesh& loaded, CaseFile const& case_file) {
  Axis const& axis = case_file.motion.axis;
  return loaded.is_structured() ? linked_blocks(loaded, case_file.plan.topology, axis) : linked_elements(loaded, axis);
}

}  // namespace

WheelPassage::WheelPassage(CaseFile const& case_file, MeshSource const& file)
    : loaded_(read_sector(case_file)), planned_(linked_as_read(loaded_, case_file)) {
  if (file.find_blocks && !loaded_.is_structured()) {
    LoadedMesh blocks = loaded_;
    blocks.take_blocks();
    if (blocks.is_structured()) {
      LinkedSector found = linked_blocks(blocks, case_file.plan.topology, case_file.motion.axis);
      if (auto rows = numbered_as(found.rows, planned_.rows, blocks.zones_in_file())) {
        found.rows = std::move(*rows);
        as_elements_ = std::exchange(planned_, std::move(found));
      } else {
        blocks = loaded_;
        blocks.remark(loaded_.mesh().source +
                      ": zones hold parts of several rows of blades, so that the wheel is one of elements");
      }
    }
    loaded_ = std::move(blocks);
  }
  check_keys_of_kind(case_file, file, CaseUse::Run::wheel, loaded_);
}

WheelMesh WheelPassage::wheel(std::vector<int> const& passages, WheelFamilies families) const {
  LinkedSector const& sector = in_file();
  if (sector.mesh().file_order.node.empty())
    return make_wheel_mesh(sector.mesh(), sector.links, sector.rows, passages, families);
  Mesh const ordered = gridmorph::in_file_order(sector.mesh());
  PassageLinks links = sector.links;
  auto const place = node_places(sector.mesh());
  for (PassageLink& link : links.all)
    for (auto& pair : link.pairs)
      for (Index& n : pair) n = place[n];
  return make_wheel_mesh(ordered, links, sector.rows, passages, families);
}

Coordinates WheelPassage::in_file_order(Coordinates const& x) const {
  return in_file().mesh().is_structured() ? x : gridmorph::in_file_order(in_file().mesh(), x);
}

PassagePlan::PassagePlan(WheelPassage const& passage, CaseFile const& case_file, WheelSetup const& setup)
    : mesh_(passage.loaded()),
      rows_(passage.planned().rows),
      smooth_(case_file.guard.smooth),
      motion_(mesh_.indexed(), passage.planned().links, rows_, setup.at(setup.moments.front()), setup.same_rules(),
              with_background(case_file, mesh_.mesh()), setup.blades,
              {case_file.sequence ? int(setup.moments.size()) : 0,
               [&](int step) { return setup.at(setup.moments[step]); }}),
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
  auto const row_of = [&](Index n) { return rows_.row_of_zone[mesh_.mesh().zone_of(n)]; };
  std::vector<int> out;
  for (Index n = 0; n < mesh_.n_nodes(); ++n) out.push_back(row_of(n));
  if (auto const elements = PlanAccess::guarded_elements(motion_.plan()))
    for (std::size_t n = 0; n < out.size(); ++n) parts.join(out[n], out[elements->graph.representative[n]]);
  for (int& part : out) part = parts.root(part);
  return out;
}

MeshForMessages PassagePlan::for_messages() const {
  return mesh_.is_structured() ? cli::for_messages(mesh_.mesh())
                               : cli::for_messages(mesh_.mesh(), motion_.plan().rules().boundary());
}

}  // namespace gridmorph::cli
