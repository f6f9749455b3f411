#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/report/smoothing_text.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/wheel_run.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

WheelPassage read(CaseFile const& case_file, MeshSource const& file, Console& console) {
  console.progress("reading " + case_file.input.string());
  return {case_file, file};
}

/// Puts a zone of the sector where its passage stands. Cost: 48 bytes per node.
void place_zone(Exec const& exec, Zone const& zone, Pitches const& pitches, Coordinates const& from, Coordinates& to) {
  Kokkos::parallel_for(
      "gridmorph::wheel::turn",
      Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, zone.first_node, zone.first_node + zone.size()),
      [&](Index n) { to.set(n, pitches(from[n])); });
}

/// Adds what one passage gives; `zones`: numbers in the wheel of the zones of its sector.
void add_passage(Certificate& wheel, Certificate const& passage, std::map<int, int> const& zones) {
  if (wheel.holds() && !passage.holds()) {
    wheel.broken = passage.broken;
    wheel.broken.worst_zone = zones.at(passage.broken.worst_zone);
    wheel.broken.cells = 0;
  }
  wheel.cells += passage.cells;
  wheel.zero += passage.zero;
  wheel.flat_before += passage.flat_before;
  wheel.negative += passage.negative;
  wheel.undecided += passage.undecided;
  wheel.broken.cells += passage.broken.cells;
}

}  // namespace

WheelRun::WheelRun(CaseFile const& case_file, MeshSource const& file, Console& console)
    : case_(case_file),
      console_(console),
      sector_(read(case_file, file, console)),
      mesh_(sector_.mesh()),
      in_file_(sector_.in_file()),
      setup_(wheel_setup(case_file, in_file_.mesh(), in_file_.rows)),
      wheel_(sector_.wheel(setup_.passages(),
                           case_file.wheel->suffix_families ? WheelFamilies::suffixed : WheelFamilies::shared)),
      shared_(in_file_.links, in_file_.rows, true) {
  if (!case_file.clearances.empty()) clearances_.emplace(case_file, sector_.loaded().boundary());
  time("read");
}

void WheelRun::time(std::string const& step) {
  bool const once = step == "plan" || step == "read";
  if (once || !case_.sequence)
    add_time(times_, step, watch_.lap(), !once);
  else
    add_time(times_, fmt::format("{}, {} steps", step, setup_.moments.size()), watch_.lap(), false);
}

void WheelRun::prepare() {
  console_.progress(sector_.loaded().kind().planning);
  check_fields(case_, mesh_);
  plan_ = plan_of(case_);
  check_wave();
  time("plan");
  quality_.near = plan_->motion().plan().near_cells();
  quality_.limits = case_.guard;
  quality_.fast = wants_verdict(case_, sector_.loaded().n_cells());
  baseline_ = sector_.loaded().measure(quality_);
  time("quality");
  morphed_ = Coordinates(mesh_.n_nodes());
  placed_ = Coordinates(in_file_.mesh().n_nodes());
  find_lost_shapes(*plan_);
  if (case_.guard.retry.value_or(false)) {
    retry();
    time("retries");
  }
  if (case_.guard.freeze) {
    freeze();
    time("freeze");
  }
  notes_ = sector_.loaded().notes();
  notes_.insert(notes_.end(), plan_->motion().notes().begin(), plan_->motion().notes().end());
  if (plan_->n_frozen() > 0)
    notes_.push_back(fmt::format(
        "{} cells lose their shape in some of the steps and passages; nodes around them are smoothed in all "
        "of them alike",
        plan_->n_frozen()));
  notes_.insert(notes_.end(), guarded_.notes.begin(), guarded_.notes.end());
  console_.expect({});
}

/// Passages of a wave are one period of one motion, so that the last blade meets the first.
void WheelRun::check_wave() const {
  if (!setup_.has_wave()) return;
  for (std::size_t m = 0; m < setup_.motions.size(); ++m) {
    if (setup_.motions[m].same_rules != int(m)) continue;
    for (Moment const& when : setup_.moments) {
      auto const now = plan_->motion().displacement(int(m), setup_.at(int(m), when));
      auto const later = plan_->motion().displacement(
          int(m), setup_.at(int(m), {when.periods + 1, when.time + setup_.period, when.step}));
      double size = 0, gap = 0;
      for (std::size_t n = 0; n < now.size(); ++n) {
        size = std::max(size, norm(now[n]));
        gap = std::max(gap, distance(now[n], later[n]));
      }
      constexpr double same = 1e-9;  // of the displacement: phases are rounded
      if (gap > same * std::max(size, 1e-6 * sector_.planned().links.mesh_size))
        throw MotionError(
            fmt::format("{}: nodal_diameters: what the rules say at t = {:.9g} and a period ({:.6g}) later differs by "
                        "{:.3g}, so that the last blade of the wave would not meet the first; give motions that "
                        "repeat with the period of [sequence] (whole numbers of harmonic)",
                        case_.source.string(), when.time, setup_.period, gap));
    }
  }
}

void WheelRun::move_to(int step) {
  if (step == step_) return;
  plan_->move(setup_.at(setup_.moments[step]));
  step_ = step;
}

template <class Visit>
void WheelRun::for_each_passage(PassagePlan& plan, Visit const& visit) {
  for (Moment const& when : setup_.moments) {
    plan.move(setup_.at(when));
    for (int p = 0; p < plan.passages().n_passages(); ++p)
      if (plan.passages().first_alike(p) == p) visit(plan.passages().boundary(p));
  }
  plan.move(setup_.at(setup_.moments[step_]));
}

void WheelRun::find_lost_shapes(PassagePlan& plan) {
  if (!case_.sequence || !plan.smooths_blocks()) return;
  console_.progress("looking for cells that lose their shape");
  for_each_passage(plan, [&](std::vector<Vec3> const& boundary) {
    plan.morph(boundary, morphed_);
    plan.freeze(morphed_);
  });
  time("guard");
}

void WheelRun::freeze() {
  PassageMotions const& passages = plan_->passages();
  int n_different = 0;
  for (int p = 0; p < passages.n_passages(); ++p) n_different += passages.first_alike(p) == p ? 1 : 0;
  std::vector<int> const some = some_steps(n_different * int(setup_.moments.size()), SmoothingRecord::most);
  Coordinates plain(mesh_.n_nodes());
  int number = 0;
  std::size_t recorded = 0;
  for_each_passage(*plan_, [&](std::vector<Vec3> const& boundary) {
    if (recorded == some.size() || some[recorded] != number++) return;
    console_.progress(fmt::format("what the guard does in passage {} of {}", ++recorded, some.size()));
    plan_->morph(boundary, plain);
    plan_->morph(boundary, morphed_);
    (void)plan_->relax(morphed_);
    plan_->record(boundary, plain, morphed_);
  });
  SmoothingMap const& map = plan_->freeze_recorded();
  guarded_.notes.push_back(describe(map));
  guarded_.json["frozen_guard"] = frozen_guard_json(map);
}

/// Where the worst passage falls short: other recipes for it, and the best of them for all passages and steps.
void WheelRun::retry() {
  auto const trial_of = [&](PassagePlan& by, std::vector<Vec3> const& boundary) {
    (void)morph(by, boundary, morphed_);
    quality_.morphed = &morphed_;
    QualityReport const quality = sector_.loaded().measure(quality_);
    return Trial{badness_of(quality),
                 newly_inverted(quality) > 0 || any_failure(shortfalls(baseline_, quality, thresholds_of(case_)))};
  };
  int worst = -1, worst_step = 0;
  Trial first;
  for (int step = 0; step < int(setup_.moments.size()); ++step) {
    move_to(step);
    PassageMotions const& motions = plan_->passages();
    for (int p = 0; p < motions.n_passages(); ++p) {
      if (motions.first_alike(p) < p) continue;
      Trial const now = trial_of(*plan_, motions.boundary(p));
      if (worst >= 0 && !(first.badness < now.badness)) continue;
      worst = p;
      worst_step = step;
      first = now;
    }
  }
  if (!first.falls_short) return;
  auto const at_worst = setup_.at(setup_.moments[worst_step]);
  std::unique_ptr<CaseFile> trying;  // plans refer to theirs
  std::unique_ptr<PassagePlan> other;
  Retried retried = RecipeSearch{
      .case_file = case_,
      .unstructured = !mesh_.is_structured(),
      .chains = false,
      .smoothing = false,
      .cells = sector_.loaded().kind().cells,
      .progress = [&](std::string const& keys) { console_.progress("trying " + keys); },
      .make =
          [&](CaseFile const& recipe) {
            other.reset();
            trying = std::make_unique<CaseFile>(recipe);
            other = plan_of(*trying);
            find_lost_shapes(*other);
            other->move(at_worst);
            return trial_of(*other, other->passages().boundary(worst));
          },
      .decide =
          [&](std::unique_ptr<CaseFile> const& kept) {
            if (!kept) return;
            plan_ = std::move(other);
            step_ = worst_step;
            recipe_ = std::move(trying);
          }}.run(first);
  retried.json["passage"] = worst + 1;
  std::string where = fmt::format("passage {}", worst + 1);
  if (case_.sequence) {
    retried.json["step"] = worst_step + 1;
    where += fmt::format(" of step {}", worst_step + 1);
  }
  if (!retried.text.empty()) guarded_.notes.push_back(fmt::format("{}, the worst one: {}", where, retried.text));
  guarded_.json["retry"] = std::move(retried.json);
}

GuardReport WheelRun::morph(PassagePlan& plan, std::vector<Vec3> const& boundary, Coordinates& morphed) {
  plan.morph(boundary, morphed);
  GuardReport const report = plan.relax(morphed);
  time("morph");
  return report;
}

PassageResult WheelRun::measure(std::vector<Vec3> const& boundary, Coordinates const& morphed) {
  PassageResult passage;
  for (Vec3 const& u : boundary) passage.largest_displacement = std::max(passage.largest_displacement, norm(u));
  quality_.morphed = &morphed;
  passage.quality = sector_.loaded().measure(quality_);
  passage.shortfalls = mapping_warnings(case_);
  auto const trims = plan_->motion().trims(boundary);
  refuse_undone(trims, case_.guard.max_trim);
  auto const trimmed = trimmed_beyond(case_.guard.max_trim, trims);
  passage.shortfalls.insert(passage.shortfalls.end(), trimmed.begin(), trimmed.end());
  auto const of_quality = shortfalls(baseline_, passage.quality, thresholds_of(case_));
  passage.shortfalls.insert(passage.shortfalls.end(), of_quality.begin(), of_quality.end());
  if (worst_of_.worst.empty() && newly_inverted(passage.quality) > 0)
    worst_of_ = diagnose(case_, plan_->for_messages(), passage.quality, morphed);
  time("quality");
  return passage;
}

void WheelRun::keep(std::optional<Coordinates>& worst, Coordinates const& morphed) const {
  if (!worst) worst.emplace(morphed.size());
  for (auto const& [to, from] :
       {std::pair(worst->x, morphed.x), std::pair(worst->y, morphed.y), std::pair(worst->z, morphed.z)})
    Kokkos::deep_copy(exec_, to, from);
  exec_.fence();
}

std::vector<Seams> WheelRun::new_seams() const {
  std::vector<Seams> seams;
  for (int r = 0; r < int(in_file_.rows.rows.size()); ++r)
    seams.emplace_back(in_file_.mesh(), shared_, in_file_.rows, r, setup_.blades[r].passages);
  return seams;
}

std::map<int, int> WheelRun::place(int passage, int next, Coordinates const& morphed, std::vector<Seams>& seams,
                                   double& gap) {
  auto const& [rows, row_of_zone, pitches] = in_file_.rows;
  Coordinates const in_sector = sector_.in_file(morphed);
  std::map<int, int> zones;
  for (int n = next; n < int(wheel_.zones.size()) && wheel_.zones[n].passage == passage; ++n) {
    int const z = wheel_.zones[n].zone;
    zones[z] = n;
    place_zone(exec_, in_file_.mesh().zones[z], rows[row_of_zone[z]].pitch.times(passage), in_sector, placed_);
  }
  exec_.fence();
  double mismatch = 0;
  for (PassageLink const& link : in_file_.links.all) mismatch = std::max(mismatch, link.mismatch);
  // Copies may differ by as much as the interfaces of the sector mesh do, and as rules that agree.
  double const tolerance =
      4 * mismatch + displacement_tolerance(std::max(1e-8, case_.motion.conformity_tolerance), in_file_.links.mesh_size,
                                            coordinate_resolution(in_file_.mesh()));
  for (int r = 0; r < int(seams.size()); ++r) {
    if (passage >= setup_.blades[r].passages) continue;
    seams[r].close(passage, placed_);
    SeamGap const& own = seams[r].largest_gap();
    gap = std::max(gap, own.distance);
    if (own.distance > tolerance)
      throw MotionError(
          fmt::format("passage {} and its neighbour move the node they share at {} apart by {:.3g}; a blade on a "
                      "periodic side must move alike on both sides of the passage{}",
                      own.passage + 1, describe_node(in_file_.mesh(), own.node), own.distance,
                      rows[r].pitch.is_straight() ? "" : ", in cylindrical components"));
  }
  return zones;
}

void WheelRun::give(std::map<int, int> const& zones, ZoneSink const& sink) const {
  Coordinates const written = sector_.in_file_order(placed_);
  std::map<int, int> in_order;  // of the wheel
  for (auto const& [of_sector, of_wheel] : zones) in_order[of_wheel] = of_sector;
  for (auto const& [of_wheel, of_sector] : in_order) {
    Index const first = in_file_.mesh().zones[of_sector].first_node;
    sink(of_wheel, written.x.data() + first, written.y.data() + first, written.z.data() + first);
  }
}

WheelMade WheelRun::make(int step, ZoneSink const& sink) {
  move_to(step);
  PassageMotions const& motions = plan_->passages();
  WheelMade made;
  auto& [rows, passages, whole, gap] = made.wheel;
  whole.certificate.emplace();
  whole.unstructured = !in_file_.mesh().is_structured();
  for (Zone const& zone : wheel_.mesh.zones) whole.zone_names.push_back(zone.name);
  auto seams = new_seams();
  int last = -1, next = 0;
  int const n_passages = motions.n_passages(), n_steps = int(setup_.moments.size());
  for (int p = 0; p < n_passages; ++p) {
    console_.progress(n_steps > 1 ? fmt::format("step {} of {}, passage {} of {}", step + 1, n_steps, p + 1, n_passages)
                                  : fmt::format("passage {} of {}", p + 1, n_passages),
                      (step + double(p) / n_passages) / n_steps);
    if (last < 0 || !motions.alike(p, last)) {
      auto const boundary = motions.boundary(p);
      GuardReport const relaxed = morph(*plan_, boundary, morphed_);
      last = p;
      int const same = motions.first_alike(p);  // before p: it has been measured
      passages.push_back(same < p ? passages[same] : measure(boundary, morphed_));
      if (keeps_worst_ && same == p && int(worst_passage(passages)) == p) keep(made.worst, morphed_);
      if (same == p && relaxed.before > 0)
        made.notes.push_back(
            fmt::format("passage {}: {} {}; displacements around them are smoothed in {} rounds, {} are left", p + 1,
                        relaxed.before, sector_.loaded().kind().lost, relaxed.rounds, relaxed.after));
    } else {
      passages.push_back(passages.back());
    }
    passages.back().blades = blades_of(p);
    passages.back().clearances = clearances_of(p, morphed_);
    auto const zones = place(p, next, morphed_, seams, gap);
    next += int(zones.size());
    time("turn");
    certify_zones(zones, *whole.certificate);
    give(zones, sink);
    time("write");
  }
  return made;
}

void WheelRun::make_baseline(ZoneSink const& sink) {
  auto seams = new_seams();
  double gap = 0;
  int next = 0;
  for (int p = 0; p < plan_->passages().n_passages(); ++p) {
    auto const zones = place(p, next, mesh_.coordinates, seams, gap);
    next += int(zones.size());
    give(zones, sink);
  }
  time("write");
}

RunDocument WheelRun::document(WheelMade const& made) const {
  RunDocument out = document_of(case_);
  out.nodes = wheel_.n_nodes();
  out.times = times_;
  for (auto const& notes : {notes_, made.notes, mapping_notes(case_)})
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  out.guarded = guarded_.json;
  out.baseline = baseline_;
  out.wheel = made.wheel;
  for (std::size_t r = 0; r < in_file_.rows.rows.size(); ++r) {
    WheelRow const& row = in_file_.rows.rows[r];
    auto& told = out.wheel->rows.emplace_back(RowOfPassages{{}, setup_.blades[r].passages, row.passages, {}});
    for (int const z : row.zones) told.zones.push_back(in_file_.mesh().zones[z].name);
    if (row.pitch.is_straight()) told.pitch = row.pitch.shift();
  }
  return out;
}

/// Certifies a passage in its place, closed to its neighbours. `zones`: those of the sector that it has.
void WheelRun::certify_zones(std::map<int, int> const& zones, Certificate& wheel) {
  std::vector<int> own;
  for (auto const& [of_sector, of_wheel] : zones) own.push_back(of_sector);
  add_passage(wheel, certify(in_file_.indexed, placed_, own), zones);
  time("quality");
}

std::vector<std::string> WheelRun::blades_of(int passage) const {
  std::vector<std::string> out;
  for (std::size_t r = 0; r < in_file_.rows.rows.size(); ++r)
    if (in_file_.rows.rows[r].periodic() && passage < setup_.blades[r].passages)
      out.push_back(setup_.motions[setup_.blades[r].blades[passage]].name);
  return out;
}

std::vector<TipClearance> WheelRun::clearances_of(int passage, Coordinates const& morphed) const {
  std::vector<TipClearance> out;
  if (!clearances_) return out;
  std::vector<Vec3> const boundary = plan_->passages().boundary(passage);
  std::map<std::array<double, 3>, std::size_t> asked;  // nodes of several zones at one place are asked once
  auto const key = [](Vec3 const& x) { return std::array{x.x, x.y, x.z}; };
  auto const& nodes = plan_->passages().nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n) asked.try_emplace(key(nodes[n].place), n);
  auto const by_rule = [&](std::span<Index const> tip, std::span<Vec3> u) {
    for (std::size_t n = 0; n < tip.size(); ++n) {
      auto const found = asked.find(key(mesh_.coordinates[tip[n]]));
      if (found == asked.end()) return false;
      u[n] = boundary[found->second];
    }
    return true;
  };
  for (std::size_t t = 0; t < clearances_->size(); ++t) {
    auto const& tip = clearances_->nodes_of_tip(t);
    WheelRows const& rows = sector_.planned().rows;
    auto const row = std::size_t(tip.empty() ? 0 : rows.row_of_zone[mesh_.zone_of(tip.front())]);
    if (passage >= setup_.blades[row].passages) continue;
    TipClearance found = clearances_->of(t, morphed, by_rule);
    auto const turned = rows.rows[row].pitch.times(passage);
    found.before.at = turned(found.before.at);
    if (found.by_rule) found.by_rule->at = turned(found.by_rule->at);
    found.after.at = turned(found.after.at);
    out.push_back(std::move(found));
  }
  return out;
}

bool any_inverted(WheelMade const& made) {
  return !made.wheel.whole.certificate->holds() ||
         std::any_of(made.wheel.passages.begin(), made.wheel.passages.end(),
                     [](auto const& p) { return newly_inverted(p.quality) > 0; });
}

std::string wheel_refusal(WheelRun const& run, std::filesystem::path const& output, std::string const& what) {
  return refusal(output.string(), what, run.diagnosis(),
                 "move the blades less, " + (run.sector().mesh().is_structured()
                                                 ? run.sector().loaded().kind().change
                                                 : std::string("change [near_field], set retry = true in [guard]")));
}

}  // namespace gridmorph::cli
