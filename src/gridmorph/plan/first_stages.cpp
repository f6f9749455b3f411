#include <gridmorph/plan/first_stages.hpp>
#include <gridmorph/quality/quality.hpp>

#include <utility>

namespace gridmorph {

namespace {

/// The name of a stage: "1" of the plan is the paper's first iteration; near fields and poles have names.
std::string name_of(Stage const& stage) {
  bool const numbered = stage.name.find_first_not_of("0123456789") == std::string::npos;
  return numbered ? "iteration " + stage.name : stage.name;
}

/// Slots that are given, or that some stage sweeps.
std::vector<char> reached_slots(Plan const& plan) {
  std::vector<char> out(plan.n_slots, 0);
  for (Index const slot : plan.boundary_slots) out[slot] = 1;
  for (Stage const& stage : plan.stages)
    for (kernels::SkeletonSweep const& sweep : stage.sweeps)
      for (Index q = 0; q < sweep.n_q; ++q)
        for (Index p = 0; p < sweep.n_p; ++p) out[sweep.slot + p + q * sweep.slot_q] = 1;
  return out;
}

/// Leaves nodes that nothing has reached where they are.
void keep_reached(std::vector<char> const& reached, CommonPart& part) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < part.slots.size(); ++k) {
    if (reached[part.slots[k]] == 0) continue;
    part.slots[n] = part.slots[k];
    part.position[n++] = part.position[k];
  }
  part.slots.resize(n);
  part.position.resize(n);
}

/// Keeps the boxes that some chain adds to: nodes of the others are not to be written.
class KeptBoxes {
 public:
  explicit KeptBoxes(Plan& plan) : plan_(plan), number_(plan.boxes.size(), -1) {}

  void renumber(std::vector<VolumePart>& parts) {
    for (VolumePart& part : parts) {
      int& number = number_[part.box];
      if (number < 0) {
        number = int(boxes_.size());
        boxes_.push_back(plan_.boxes[part.box]);
      }
      part.box = number;
    }
  }
  void finish() { plan_.boxes = std::move(boxes_); }

 private:
  Plan& plan_;
  std::vector<int> number_;
  std::vector<kernels::VolumeBox> boxes_;
};

}  // namespace

std::vector<StagesDone> stages_of(Plan const& plan) {
  std::vector<StagesDone> out{{"boundary", 0, 0}};
  for (Stage const& stage : plan.stages) out.push_back({name_of(stage), out.size(), 0});
  for (std::size_t n = 1; n <= plan.spreads.size(); ++n)
    out.push_back({n == 1 ? "slip surfaces" : "slip surfaces " + std::to_string(n), plan.stages.size(), n});
  return out;
}

Plan first_stages(Plan const& plan, StagesDone const& done) {
  Plan out = plan;
  out.stages.erase(out.stages.begin() + std::ptrdiff_t(done.stages), out.stages.end());
  out.spreads.erase(out.spreads.begin() + std::ptrdiff_t(done.spreads), out.spreads.end());
  KeptBoxes boxes(out);
  Index n_parameters = 0;
  for (Stage& stage : out.stages) {
    boxes.renumber(stage.volume);
    n_parameters += stage.lines.n_parameters;
  }
  for (SpreadPass& pass : out.spreads) {
    boxes.renumber(pass.volume);
    n_parameters += pass.lines.n_parameters;
  }
  boxes.finish();
  auto const reached = reached_slots(out);
  for (CommonPart& part : out.common) keep_reached(reached, part);
  if (!out.line_parameters.empty()) out.line_parameters.resize(n_parameters);
  std::vector<char> given(plan.n_slots, 0);
  for (Index const slot : plan.boundary_slots) given[slot] = 1;
  for (Index slot = 0; slot < plan.n_slots; ++slot) {
    if (given[slot] != 0) continue;
    out.boundary_slots.push_back(slot);
    out.boundary_nodes.push_back(-1);
  }
  return out;
}

StagesOfCells stages_of_cells(Mesh const& mesh, Plan const& plan) {
  std::vector<Index> const first = first_cells(mesh);
  std::size_t const n = std::size_t(first.back());
  StagesOfCells out{std::vector<int>(n, 0), std::vector<int>(n, 0), std::vector<int>(n, 0)};
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    Stage const& stage = plan.stages[s];
    for (std::size_t b = 0; b < stage.cells.size(); ++b) {
      CellBox const& box = stage.cells[b];
      Zone const& zone = mesh.zones[box.zone];
      Index const ni = zone.extent[0] - 1, nj = zone.extent[1] - 1;
      for (int k = box.cells.begin[2]; k < box.cells.end[2]; ++k)
        for (int j = box.cells.begin[1]; j < box.cells.end[1]; ++j)
          for (int i = box.cells.begin[0]; i < box.cells.end[0]; ++i) {
            auto const cell = std::size_t(first[box.zone] + i + ni * (j + nj * k));
            out.stage[cell] = int(s) + 1;
            out.chain[cell] = stage.chain_of_cells[b] + 1;
            out.direction[cell] = stage.axis_of_cells[b] + 1;
          }
    }
  }
  return out;
}

}  // namespace gridmorph
