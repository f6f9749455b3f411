// The steps between an unstructured mesh with motion rules and morphed coordinates.
#include <gridmorph/app/element_mesh.hpp>
#include <gridmorph/app/shocks.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/guard/stepped_morph.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/element_prediction.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>
#include <gridmorph/plan/plane_axes.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/report/element_prediction_text.hpp>
#include <gridmorph/report/target_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

class ElementPlan final : public AnyPlan {
 public:
  ElementPlan(ElementMesh const& mesh, CaseFile const& case_file)
      : mesh_(mesh),
        shocks_(locate_shocks(case_file, mesh.mesh)),
        case_file_(shocks_.case_file),
        options_(with_background(case_file_)) {
    Problems problems;
    for (auto const& problem : mesh.face_patches.problems) problems.add(problem);
    problems.throw_if_any<MeshError>();
    Stopwatch watch;
    NodeGraph graph =
        make_node_graph(mesh.mesh, mesh.topology.elements_of_nodes, row_of_nodes(mesh.mesh, case_file_.motion));
    bool const any = case_file_.sequence || options_.elements.motion >= 0;
    auto boundary =
        boundary_conditions(mesh.mesh, mesh.topology, mesh.face_patches, graph, case_file_.motion,
                            options_.elements.walls, any ? Displacements::any : Displacements::of_the_rules);
    if (auto const& sequence =
            case_file_.sequence) {  // the offset of the wrap reckons with all steps, of very many with some
      constexpr int most_steps = 1000;
      options_.elements.motion = 0;
      for (int const step : sequence->some_steps(most_steps))
        options_.elements.motion = std::max(
            options_.elements.motion, largest_norm(evaluate(boundary, motion_at(case_file_, sequence->moment(step)))));
    }
    double const seconds = watch.lap();
    prepared_ =
        prepare({}, mesh.mesh, mesh.topology, mesh.face_patches, std::move(graph), std::move(boundary), options_);
    prepared_.report.seconds.boundary += seconds;
    near_ = near_elements_of(prepared_);
    BoundaryMotion const& rules = *prepared_.boundary.motion;
    std::vector<std::string> notes;  // those of the rules come again
    for (auto const* regions : {&case_file_.motion.regions, &case_file_.measured_regions})
      for (InnerRegion const& region : locate_wakes(rules.shared_boundary(), rules.motion(), *regions, notes))
        add_measured(region);
    planning_ = seconds + watch.lap();
  }

  std::vector<Vec3> displacement(Moment const* when) override {
    auto out = when == nullptr ? prepared_.boundary_displacement(mesh_.mesh)
                               : evaluate(prepared_.boundary, motion_at(case_file_, *when));
    take_trims(trims(prepared_.boundary, out), case_file_.guard.max_trim);
    return out;
  }

  std::vector<Vec3> displacement(double share) const override {
    return evaluate(prepared_.boundary, fraction_of(case_file_, share));
  }

  void morph(std::vector<Vec3> const& displacement, Coordinates& morphed, StepTimes* times) override {
    Stopwatch watch;
    if (!morpher_) {
      morpher_.emplace(Exec(), prepared_.plan, mesh_.coordinates(), MorpherOptions{.smoothing = frozen_map()});
      if (times != nullptr) times->push_back({"upload", watch.lap(), true});
    }
    apply_on_host(*morpher_, displacement, morphed);
    if (times != nullptr) times->push_back({"morph", watch.lap(), true});
  }

  [[nodiscard]] bool guards() const override { return !frozen_map(); }
  RelaxReport relax(Coordinates& morphed) const override {
    return relax_bad_elements(mesh_.mesh, mesh_.topology, prepared_, morphed, {.signs = mesh_.signs});
  }

  [[nodiscard]] std::optional<Coordinates> morph_in_steps(
      std::vector<Vec3> const& displacement, int steps, std::function<void(int step)> const& progress) const override {
    if (options_.elements.background) return {};
    StepOptions options;
    options.steps = steps;
    options.plan = options_;
    options.relax.signs = mesh_.signs;
    options.progress = progress;
    return gridmorph::morph_in_steps(mesh_.mesh, mesh_.topology, mesh_.face_patches, prepared_, displacement, options);
  }

  [[nodiscard]] QualityReport measure(QualityWanted wanted) const override {
    wanted.near = near_;
    wanted.regions = regions_;
    return mesh_.measure(wanted);
  }

  [[nodiscard]] PlanOutcome outcome(Coordinates const& morphed, bool /*verdict*/, bool at_once) const override {
    PlanOutcome out{{}, {}, json()};
    auto const targets = at_once ? prepared_.boundary.motion->target_reach(morphed) : std::vector<TargetReach>();
    for (auto const& target : targets) out.notes.push_back(describe_reach(mesh_.mesh, target));
    out.json["targets"] = targets_json(mesh_.mesh, targets);
    return out;
  }

  void write_stages(std::filesystem::path const& folder, std::vector<Vec3> const& /*displacement*/,
                    Coordinates const& morphed) const override {
    make_stage_folder(folder);
    auto const path = [&](std::size_t n) { return (folder / stage_names[n]).string(); };
    write_regions(path(0), morphed);
    // Of several parts the first one with moving walls.
    auto const parts = planned_parts();
    auto const part = std::find_if(parts.begin(), parts.end(),
                                   [](PlannedPart const& p) { return p.report.wrap || p.plan.background; });
    if (part == parts.end()) return;
    auto const& axes = prepared_.plan.axes;
    auto const write_stage = [&](std::size_t n, Mesh stage) {
      stage.coordinates = back_from_axes(axes, stage.coordinates);
      write_mesh(path(n), stage);
    };
    if (part->report.wrap) write_stage(1, wrap_mesh(*part->report.wrap));
    if (!part->plan.background) return;
    Mesh background = part->plan.background->mesh;
    write_stage(2, background);
    Coordinates moved(background.n_nodes());
    auto const u = morpher_->background_displacements(part->number);
    for (Index n = 0; n < moved.size(); ++n) moved.set(n, background.coordinates[n] + u.array()[n]);
    background.coordinates = moved;
    write_stage(3, background);
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    auto out = mesh_.notes();
    for (auto const& more : {shocks_.notes, prepared_.notes, trim_notes(), mapping_notes(case_file_)})
      out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  [[nodiscard]] PlanPrediction predict() override {
    ElementPrediction worst;
    int worst_step = 0;
    Coordinates displaced(mesh_.n_nodes());
    std::vector<int> const steps = predicted_steps(case_file_);
    for (int const step : steps) {
      Moment const when = case_file_.sequence ? case_file_.sequence->moment(step) : Moment{};
      morph(displacement(case_file_.sequence ? &when : nullptr), displaced, nullptr);
      ElementPrediction now = gridmorph::predict({}, mesh_.mesh, prepared_, displaced, mesh_.signs);
      if (step > 0 && !(now.all.kept.value < worst.all.kept.value)) continue;
      worst = std::move(now);
      worst_step = step;
    }
    PlanPrediction out{describe(mesh_.mesh, worst), prediction_warnings(mesh_.mesh, worst),
                       prediction_json(mesh_.mesh, worst)};
    if (!case_file_.sequence) return out;
    out.text = worst_step_text(case_file_, worst_step) + out.text;
    out.json["step"] = worst_step + 1;
    return out;
  }
  [[nodiscard]] StepTimes times() const override { return {{"plan", planning_, true}}; }

  [[nodiscard]] std::string text(bool /*all*/) const override {
    std::string text;
    for (auto const& note : notes()) text += "note: " + note + "\n";
    return text + headline();
  }

  [[nodiscard]] nlohmann::json json() const override {
    nlohmann::json plan = json(prepared_.report, prepared_.plan);
    if (!prepared_.plan.parts.empty()) {
      nlohmann::json parts = nlohmann::json::array();
      for (PlannedPart const& part : planned_parts()) {
        parts.push_back(json(part.report, part.plan));
        parts.back()["nodes"] = part.plan.n_nodes;
        parts.back()["common_motion"] = prepared_.plan.parts[part.number].common.has_value();
      }
      plan["parts"] = std::move(parts);
    }
    return {{"elements", mesh_.mesh.n_elements()}, {"plan", std::move(plan)}};
  }

  [[nodiscard]] std::string headline() const override {
    if (prepared_.plan.parts.empty()) return headline(prepared_.report, prepared_.plan);
    std::string text;
    Index at_rest = 0, n_at_rest = 0;
    for (PlannedPart const& part : planned_parts()) {
      bool const common = prepared_.plan.parts[part.number].common.has_value();
      if (part.plan.driving.empty() && !common) {
        ++at_rest;
        n_at_rest += part.plan.n_nodes;
        continue;
      }
      text +=
          fmt::format("part {} of {}, {} nodes{}\n", part.number + 1, prepared_.plan.parts.size(), part.plan.n_nodes,
                      common ? ": the motion that its boundaries have in common, and what is left of theirs" : "");
      if (!part.plan.driving.empty()) text += headline(part.report, part.plan);
    }
    if (at_rest > 0)
      text += fmt::format("{} part{} without moving walls, {} nodes: the motions of other boundaries alone\n", at_rest,
                          at_rest == 1 ? "" : "s", n_at_rest);
    return text;
  }

  [[nodiscard]] MeshForMessages for_messages() const override {
    return cli::for_messages(mesh_.mesh, prepared_.boundary);
  }
  [[nodiscard]] BoundaryMotion const& rules() const override { return *prepared_.boundary.motion; }
  [[nodiscard]] NearCells const& near() const override { return near_; }

 private:
  /// A plan without parts, with what was found on the way.
  struct PlannedPart {
    UnstructuredReport const& report;
    UnstructuredPlan const& plan;
    std::size_t number;
  };
  [[nodiscard]] std::vector<PlannedPart> planned_parts() const {
    if (prepared_.plan.parts.empty()) return {{prepared_.report, prepared_.plan, 0}};
    std::vector<PlannedPart> out;
    for (std::size_t n = 0; n < prepared_.plan.parts.size(); ++n)
      out.push_back({prepared_.part_reports[n], *prepared_.plan.parts[n].plan, n});
    return out;
  }

  static nlohmann::json json(UnstructuredReport const& r, UnstructuredPlan const& p) {
    return {{"offset", r.offset},
            {"columns", r.n_columns},
            {"layer_height", r.layer_height},
            {"elements",
             {{"near", r.regions.n_near}, {"partially_wrapped", r.regions.n_partial}, {"far", r.regions.n_far}}},
            {"layers", r.n_layers},
            {"background",
             {{"shape", shape(r)},
              {"zones", p.background ? p.background->mesh.zones.size() : 0},
              {"nodes", p.background ? p.background->mesh.n_nodes() : 0}}},
            {"wrap_nodes", r.wrap_nodes},
            {"wrap_nodes_outside", r.wrap_outside},
            {"wrap_largest_distance", r.wrap_distance},
            {"far_nodes", r.far_nodes},
            {"far_nodes_outside", r.far_outside},
            {"unreached_nodes", r.unreached},
            {"seconds",
             {{"boundary", r.seconds.boundary},
              {"columns", r.seconds.columns},
              {"distances", r.seconds.distances},
              {"wrap", r.seconds.wrap},
              {"layers", r.seconds.layers},
              {"background", r.seconds.background},
              {"location", r.seconds.location},
              {"residual", r.seconds.residual}}}};
  }

  static std::string headline(UnstructuredReport const& r, UnstructuredPlan const& p) {
    std::string text = fmt::format(
        "near field: {}, {} columns up to {:.4g} high, {} near elements, {} partially wrapped, {} far; {} layers\n",
        r.wrap ? fmt::format("offset {:.4g}", r.offset) : std::string("the hole of the background mesh"), r.n_columns,
        r.layer_height, r.regions.n_near, r.regions.n_partial, r.regions.n_far, r.n_layers);
    if (p.background)
      text += fmt::format(
          "background mesh: {}, {} zones, {} nodes; {} on the wrap; {} nodes of the mesh take their displacement from "
          "it\n",
          shape(r), p.background->mesh.zones.size(), p.background->mesh.n_nodes(), r.wrap_nodes, r.far_nodes);
    return text;
  }

  /// What the background mesh fills.
  static std::string shape(UnstructuredReport const& r) {
    if (!r.wrap) return "read from a file";
    if (r.wrap->tube) return "O-type around a tube";
    std::string text = r.wrap->domain.chart.name();
    int sliding = 0, along = 0;
    for (int axis = 0; axis < r.wrap->dimension; ++axis)
      for (int const side : {0, 1}) {
        auto const is = r.wrap->domain.side[std::size_t(axis)][std::size_t(side)];
        bool const slides = r.wrap->slides(axis, side);
        sliding += slides ? 1 : 0;
        bool const reached = r.wrap->reaches[std::size_t(axis)][std::size_t(side)];
        along += !slides && is != ChartedDomain::Side::open && (is != ChartedDomain::Side::stands || reached) ? 1 : 0;
      }
    for (auto const& [count, what] : {std::pair(sliding, "on which nodes slide"), std::pair(along, "that go along")})
      if (count > 0) text += fmt::format(", {} {} {}", count, count == 1 ? "side" : "sides", what);
    return text;
  }

  void add_measured(InnerRegion const& region) {
    auto const in = elements_of_region(mesh_.mesh, region);
    if (std::none_of(in.begin(), in.end(), [](std::uint8_t n) { return n != 0; })) return;
    Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const mask("gridmorph::cli::region", in.size());
    std::copy(in.begin(), in.end(), mask.data());
    regions_.elements.push_back({region.name, mask});
  }

  [[nodiscard]] SmoothingRecord new_record() const override { return SmoothingRecord(prepared_); }
  void drop_morpher() override { morpher_.reset(); }

  /// The morphed mesh with its regions (0 near, 1 partially wrapped, 2 far), layers and displacements.
  void write_regions(std::string const& path, Coordinates const& morphed) const {
    OutputFields fields;
    fields.displacement = true;
    CellField region{"Region", {}};
    for (Region const r : prepared_.report.regions.element) region.values.push_back(double(2 - int(r)));
    fields.cells.push_back(std::move(region));
    auto const& layer = prepared_.report.layer;
    fields.nodes.push_back({"Layer", std::vector<double>(layer.begin(), layer.end())});
    write_mesh(path, mesh_.mesh, morphed, fields);
  }

  ElementMesh const& mesh_;
  LocatedShocks shocks_;
  CaseFile const& case_file_;
  PlanOptions options_;
  PreparedUnstructured prepared_;
  NearCells near_;
  MeasuredRegions regions_;
  std::optional<Morpher<Exec>> morpher_;
  double planning_ = 0;
};

}  // namespace

NearCells near_elements_of(PreparedUnstructured const& prepared) {
  auto const& regions = prepared.report.regions.element;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const near("gridmorph::cli::near_field", regions.size());
  for (std::size_t e = 0; e < regions.size(); ++e) near(e) = regions[e] == Region::far ? 0 : 1;
  return {near, prepared.boundary.driving_patches};
}

PlanOptions with_background(CaseFile const& case_file) {
  PlanOptions options = case_file.plan;
  if (auto const& own = case_file.background)
    options.elements.background =
        std::make_shared<Background const>(make_background(read_mesh(own->path.string()), own->wrap, own->outer));
  return options;
}

std::unique_ptr<AnyPlan> ElementMesh::plan(CaseFile const& case_file) const {
  return std::make_unique<ElementPlan>(*this, case_file);
}

}  // namespace gridmorph::cli
