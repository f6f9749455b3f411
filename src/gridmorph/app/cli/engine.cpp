#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/engine.hpp>
#include <gridmorph/app/cli/near_field_mask.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/quality/quality.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

template <class T>
void append(std::vector<T>& to, std::vector<T> const& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

struct Engine::Impl {
  Mesh& mesh;
  PreparedMorph prepared;
  std::vector<std::string> morph_notes;  ///< of the last morph()
  StepTimes times;
  std::optional<Morpher<Exec>> kept_morpher;

  /// Made once: tables, workspace and line parameters serve every displacement.
  Morpher<Exec> const& morpher(Exec const& exec) {
    if (!kept_morpher) kept_morpher.emplace(exec, plan(), mesh.coordinates);
    return *kept_morpher;
  }
  void apply(Exec const& exec, std::vector<Vec3> const& boundary, Coordinates const& morphed) {
    Kokkos::View<Vec3 const*, Exec::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const given(boundary.data(),
                                                                                                       boundary.size());
    morpher(exec).positions(exec, given, morphed);
    exec.fence();
  }

  Impl(Mesh& m, CaseFile const& c) : mesh(m), prepared(prepare(m, c.motion, c.plan)) {
    times = {
        {"topology", prepared.seconds.topology}, {"rules", prepared.seconds.rules}, {"plan", prepared.seconds.plan}};
  }
  [[nodiscard]] Plan const& plan() const { return prepared.plan(); }
};

Engine::Engine(Mesh& mesh, CaseFile const& case_file, Terminal& terminal) {
  terminal.progress("connecting zones, applying rules, planning");
  try {
    impl_ = std::make_unique<Impl>(mesh, case_file);
  } catch (MotionError const& e) {  // rules about an axis fail in many ways when it is not the machine's
    auto const cause = axis_mismatch(mesh, case_file.motion.axis);
    if (!cause) throw;
    throw MotionError(fmt::format("{}\n  likely cause: {}", e.what(), *cause));
  }
}
Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;

std::string Engine::plan_text() const { return describe(impl_->plan()); }

nlohmann::json Engine::plan_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (auto const& stage : impl_->plan().stages) {
    Index cells = 0;
    for (CellBox const& box : stage.cells) {
      Index inside = 1;
      for (int a = 0; a < 3; ++a) inside *= box.cells.extent(a);
      cells += inside;
    }
    list.push_back({{"name", stage.name}, {"chains", stage.description}, {"cells", cells}});
  }
  for (auto const& pass : impl_->plan().spreads)
    list.push_back({{"name", "slip surfaces"}, {"chains", pass.description}, {"cells", 0}});
  return list;
}

std::vector<std::string> Engine::notes() const {
  std::vector<std::string> out = impl_->mesh.notes;
  append(out, impl_->prepared.motion.notes);
  append(out, impl_->prepared.surface.notes());
  append(out, impl_->plan().notes);
  append(out, impl_->morph_notes);
  return out;
}

StepTimes const& Engine::times() const { return impl_->times; }

std::vector<unsigned char> Engine::near_field() const { return near_field_mask(impl_->mesh, impl_->plan()); }

std::vector<StageResult> Engine::stage_results(Coordinates const& morphed) const {
  Exec const exec;
  auto const handedness = zone_handedness(exec, impl_->mesh, views(impl_->mesh.coordinates));
  std::vector<StageResult> out;
  for (auto const& stage : impl_->plan().stages)
    out.push_back({stage.name, min_determinant(exec, impl_->mesh, views(morphed), handedness, stage.cells)});
  return out;
}

std::vector<TargetReach> Engine::target_reach(Coordinates const& morphed) const {
  return impl_->prepared.surface.target_reach(impl_->mesh, morphed);
}

Coordinates Engine::morph(Terminal& terminal) const {
  Stopwatch watch;
  terminal.progress("moving the boundary");
  auto const boundary = impl_->prepared.boundary_displacement(impl_->mesh);
  impl_->morph_notes.clear();
  if (auto const note = trim_note(impl_->mesh, impl_->plan(), boundary)) impl_->morph_notes.push_back(*note);
  impl_->times.push_back({"boundary", watch.lap()});
  terminal.progress("morphing the volume");
  Coordinates morphed(impl_->mesh.coordinates.size());
  impl_->apply(Exec(), boundary, morphed);
  impl_->times.push_back({"morph", watch.lap(), true});
  return morphed;
}

void Engine::morph_into(Motion const& motion, Coordinates const& morphed) const {
  PreparedMorph const& prepared = impl_->prepared;
  ResolvedMotion resolved = prepared.motion;
  for (std::size_t r = 0; r < motion.rules.size(); ++r) resolved.rules[r].rule = motion.rules[r].rule;
  // Slides and followers take their motion over from the blade's as it is now.
  SurfaceMotion const surface(impl_->mesh, resolved);
  auto const boundary = evaluate_boundary(impl_->mesh, prepared.planned.boundary, impl_->plan(), resolved, surface,
                                          prepared.links.mesh_size);
  impl_->apply(Exec(), boundary, morphed);
}

}  // namespace gridmorph::cli
