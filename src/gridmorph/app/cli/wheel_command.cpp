#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/wheel_passage.hpp>
#include <gridmorph/app/cli/wheel_text.hpp>
#include <gridmorph/app/run.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/wheel/seams.hpp>
#include <gridmorph/wheel/turn.hpp>
#include <gridmorph/wheel/wheel_mesh.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Puts a zone of the sector where its passage stands. Cost: 48 bytes per node.
void turn_zone(Exec const& exec, Zone const& zone, Turn const& turn, Coordinates const& from, Coordinates& to) {
  Kokkos::parallel_for(
      "gridmorph::wheel::turn",
      Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, zone.first_node, zone.first_node + zone.size()),
      [&](Index n) { to.set(n, turn(from[n])); });
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
  wheel.negative += passage.negative;
  wheel.undecided += passage.undecided;
  wheel.broken.cells += passage.broken.cells;
}

/// Morphs, measures, turns and writes a wheel, one passage at a time.
class WheelRun {
 public:
  WheelRun(CaseFile const& case_file, MeshKind kind, Terminal& terminal)
      : case_(case_file),
        terminal_(terminal),
        sector_(read(case_file, kind, terminal)),
        mesh_(sector_->mesh()),
        rows_(find_rows(mesh_, sector_->links(), case_file.motion.axis)),
        setup_(wheel_setup(case_file, mesh_, rows_)),
        wheel_(sector_->wheel(rows_, case_file.motion.axis, setup_.passages(),
                              case_file.wheel->suffix_families ? WheelFamilies::suffixed : WheelFamilies::shared)) {
    result_.nodes = wheel_.n_nodes();
    result_.whole.certificate.emplace();
    for (Zone const& zone : wheel_.mesh.zones) result_.whole.zone_names.push_back(zone.name);
    time("read");
  }

  [[nodiscard]] PassageMesh const& sector() const { return *sector_; }
  [[nodiscard]] WheelMesh const& wheel() const { return wheel_; }
  [[nodiscard]] WheelRows const& rows() const { return rows_; }
  [[nodiscard]] WheelSetup const& setup() const { return setup_; }
  [[nodiscard]] Diagnosis const& diagnosis() const { return worst_of_; }
  [[nodiscard]] nlohmann::json const& retried() const { return retried_.json; }

  WheelResult run(MeshFileWriter& writer) {
    terminal_.progress(sector_->kind().planning);
    auto plan = plan_of(case_);
    time("plan");
    prepare_quality(*plan);
    if (case_.guard.retry) {
      retry(plan);
      time("retries");
    }
    PassageMotions const& motions = plan->passages();
    result_.notes = sector_->notes();
    result_.notes.insert(result_.notes.end(), plan->notes().begin(), plan->notes().end());
    if (!retried_.text.empty()) result_.notes.push_back(retried_.text);
    SharedNodes const shared(sector_->links(), rows_, true);
    std::vector<Seams> seams;
    for (int r = 0; r < int(rows_.rows.size()); ++r)
      seams.emplace_back(mesh_, shared, rows_, r, case_.motion.axis, setup_.blades[r].passages);

    terminal_.expect({});
    Coordinates morphed(mesh_.n_nodes()), placed(mesh_.n_nodes());
    int last = -1, zone = 0;
    int const n_passages = motions.n_passages();
    for (int p = 0; p < n_passages; ++p) {
      terminal_.progress(fmt::format("passage {} of {}", p + 1, n_passages), double(p) / n_passages);
      if (last < 0 || !motions.alike(p, last)) {
        auto const boundary = motions.boundary(p);
        RelaxReport const relaxed = morph(*plan, boundary, morphed);
        last = p;
        int const same = motions.first_alike(p);  // before p: it has been measured
        result_.passages.push_back(same < p ? result_.passages[same] : measure(*plan, boundary, morphed));
        if (same == p && relaxed.before > 0)
          result_.notes.push_back(
              fmt::format("passage {}: {} {}; displacements around them are smoothed in {} rounds, {} are left", p + 1,
                          relaxed.before, sector_->kind().lost, relaxed.rounds, relaxed.after));
      } else {
        result_.passages.push_back(result_.passages.back());
      }
      result_.passages.back().blades = blades_of(p);
      std::map<int, int> zones;
      for (int n = zone; n < int(wheel_.zones.size()) && wheel_.zones[n].passage == p; ++n) {
        int const z = wheel_.zones[n].zone;
        zones[z] = n;
        turn_zone(exec_, mesh_.zones[z], Turn(case_.motion.axis, p, rows_.rows[rows_.row_of_zone[z]].passages), morphed,
                  placed);
      }
      exec_.fence();
      for (int r = 0; r < int(seams.size()); ++r)
        if (p < setup_.blades[r].passages) close(seams[r], p, placed);
      time("turn");
      certify_zones(zones, placed);
      Coordinates const written = sector_->in_file_order(placed);
      for (; zone < int(wheel_.zones.size()) && wheel_.zones[zone].passage == p; ++zone) {
        Index const first = mesh_.zones[wheel_.zones[zone].zone].first_node;
        writer.write_zone(zone, written.x.data() + first, written.y.data() + first, written.z.data() + first);
      }
      time("write");
    }
    for (auto const& use : case_.fields) result_.notes.push_back(use.where + ": " + describe_mapping(*use.field));
    return std::move(result_);
  }

 private:
  static std::unique_ptr<PassageMesh> read(CaseFile const& case_file, MeshKind kind, Terminal& terminal) {
    terminal.progress("reading " + case_file.input.string());
    return kind == MeshKind::unstructured ? element_passage(case_file) : block_passage(case_file);
  }

  [[nodiscard]] std::unique_ptr<PassagePlan> plan_of(CaseFile const& case_file) const {
    return sector_->plan(case_file, rows_, setup_);
  }

  /// Where the worst passage falls short: other recipes for it, and the best of them for all passages.
  void retry(std::unique_ptr<PassagePlan>& plan) {
    Coordinates morphed(mesh_.n_nodes());
    auto const trial_of = [&](PassagePlan& by, std::vector<Vec3> const& boundary) {
      (void)morph(by, boundary, morphed);
      quality_.morphed = &morphed;
      QualityReport const quality = sector_->measure(quality_);
      return Trial{badness_of(quality), newly_inverted(quality) > 0 ||
                                            any_failure(shortfalls(result_.baseline, quality, thresholds_of(case_)))};
    };
    PassageMotions const& motions = plan->passages();
    int worst = -1;
    Trial first;
    for (int p = 0; p < motions.n_passages(); ++p) {
      if (motions.first_alike(p) < p) continue;
      Trial const now = trial_of(*plan, motions.boundary(p));
      if (worst >= 0 && !(first.badness < now.badness)) continue;
      worst = p;
      first = now;
    }
    if (!first.falls_short) return;
    std::unique_ptr<CaseFile> trying;  // plans refer to theirs
    std::unique_ptr<PassagePlan> other;
    retried_ = RecipeSearch{
        .case_file = case_,
        .unstructured = !mesh_.is_structured(),
        .chains = false,
        .smoothing = false,
        .cells = sector_->kind().cells,
        .progress = [&](std::string const& keys) { terminal_.progress("trying " + keys); },
        .make =
            [&](CaseFile const& recipe) {
              other.reset();
              trying = std::make_unique<CaseFile>(recipe);
              other = plan_of(*trying);
              return trial_of(*other, other->passages().boundary(worst));
            },
        .decide =
            [&](std::unique_ptr<CaseFile> const& kept) {
              if (!kept) return;
              plan = std::move(other);
              recipe_ = std::move(trying);
            }}.run(first);
    retried_.json["passage"] = worst + 1;
    if (!retried_.text.empty()) retried_.text = fmt::format("passage {}, the worst one: {}", worst + 1, retried_.text);
  }

  void time(std::string const& step) { add_time(result_.times, step, watch_.lap(), step != "plan" && step != "read"); }

  void prepare_quality(PassagePlan const& plan) {
    quality_.near = plan.near();
    quality_.limits = case_.guard;
    quality_.fast = wants_verdict(case_, sector_->n_cells());
    result_.baseline = sector_->measure(quality_);
    result_.whole.unstructured = result_.baseline.unstructured;
    time("quality");
  }

  RelaxReport morph(PassagePlan& plan, std::vector<Vec3> const& boundary, Coordinates& morphed) {
    RelaxReport const report = plan.morph(boundary, morphed);
    time("morph");
    return report;
  }

  PassageResult measure(PassagePlan const& plan, std::vector<Vec3> const& boundary, Coordinates const& morphed) {
    PassageResult passage;
    for (Vec3 const& u : boundary) passage.largest_displacement = std::max(passage.largest_displacement, norm(u));
    quality_.morphed = &morphed;
    passage.quality = sector_->measure(quality_);
    passage.shortfalls = shortfalls(result_.baseline, passage.quality, thresholds_of(case_));
    if (worst_of_.worst.empty() && newly_inverted(passage.quality) > 0)
      worst_of_ = diagnose(case_, plan.for_messages(), passage.quality, morphed);
    time("quality");
    return passage;
  }

  /// Of a passage in its place, closed to its neighbours. `zones`: those of the sector that it has.
  void certify_zones(std::map<int, int> const& zones, Coordinates const& placed) {
    std::vector<int> own;
    for (auto const& [of_sector, of_wheel] : zones) own.push_back(of_sector);
    add_passage(*result_.whole.certificate, sector_->certify(placed, own), zones);
    time("quality");
  }

  [[nodiscard]] std::vector<std::string> blades_of(int passage) const {
    std::vector<std::string> out;
    for (std::size_t r = 0; r < rows_.rows.size(); ++r)
      if (rows_.rows[r].periodic() && passage < setup_.blades[r].passages)
        out.push_back(setup_.names[setup_.blades[r].blades[passage]]);
    return out;
  }

  /// Copies may differ by as much as the interfaces of the sector mesh do, and as rules that agree.
  void close(Seams& seams, int passage, Coordinates& placed) {
    seams.close(passage, placed);
    SeamGap const& gap = seams.largest_gap();
    if (gap.distance > result_.gap.distance) result_.gap = gap;
    double mismatch = 0;
    for (PassageLink const& link : sector_->links().all) mismatch = std::max(mismatch, link.mismatch);
    double const tolerance =
        4 * mismatch + std::max(1e-8, case_.motion.conformity_tolerance) * sector_->links().mesh_size;
    if (gap.distance > tolerance)
      throw MotionError(
          fmt::format("passage {} and its neighbour move the node they share at {} apart by {:.3g}; a blade on a "
                      "periodic side must move alike on both sides of the passage, in cylindrical components",
                      gap.passage + 1, describe_node(mesh_, gap.node), gap.distance));
  }

  CaseFile const& case_;
  Terminal& terminal_;
  Retried retried_;
  Diagnosis worst_of_;  ///< of the first passage with inverted cells
  Stopwatch watch_;
  Exec exec_;
  WheelResult result_;
  std::unique_ptr<PassageMesh> sector_;
  Mesh const& mesh_;
  WheelRows rows_;
  WheelSetup setup_;
  WheelMesh wheel_;
  QualityWanted quality_;
  std::unique_ptr<CaseFile> recipe_;  ///< that the plan refers to, where it is not the case file
};

bool any_inverted(WheelResult const& result) {
  return !result.whole.certificate->holds() || std::any_of(result.passages.begin(), result.passages.end(),
                                                           [](auto const& p) { return newly_inverted(p.quality) > 0; });
}

std::string text_of(WheelRun const& run, WheelResult const& result) {
  std::string text;
  for (auto const& note : result.notes) text += "note: " + note + "\n";
  text += describe_rows(run.sector().mesh(), run.rows(), run.setup()) + "\n" + passage_table(result);
  text += certificate_text(result.whole);
  text += fmt::format("\nlargest distance of coincident nodes before one took over the other's position: {:.3g}\n",
                      result.gap.distance);
  return text + "\n" + format_times(result.times, result.nodes);
}

}  // namespace

int run_wheel_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document);
  set_quality(case_file, options.quality);
  if (!case_file.wheel)
    throw ConfigError(options.input.string() + ": no [wheel]; add [wheel] with output = \"wheel.cgns\"");
  auto const output = options.output.value_or(case_file.wheel->output);
  auto const report = options.report ? options.report : case_file.output_options.report;
  if (output.empty())
    throw ConfigError(options.input.string() +
                      ": no output; add output = \"wheel.cgns\" to [wheel] or give --output FILE");
  MeshSource const file = checked_mesh_file(case_file, CaseUse::Run::wheel);
  RunFiles outputs = outputs_of(output, report);
  outputs.front().what = "wheel";  // CGNS, whatever the sector is
  check_run_files(inputs_of(case_file, file), outputs);

  WheelRun run(case_file, file.kind, terminal);
  MeshFileWriter writer(output.string(), run.wheel().mesh);
  WheelResult const result = run.run(writer);
  bool const written = !any_inverted(result) || case_file.guard.write_inverted;
  std::vector<std::string> failures;
  for (std::size_t p = 0; p < result.passages.size(); ++p)
    for (auto const& s : result.passages[p].shortfalls)
      if (s.severity == Shortfall::Severity::failure)
        failures.push_back(fmt::format("passage {}: {}", p + 1, s.message));
  return conclude({.output = output,
                   .report = report,
                   .written = written,
                   .falls_short = !failures.empty(),
                   .json =
                       [&] {
                         nlohmann::json json = wheel_json(run.sector().mesh(), run.rows(), run.setup(), result);
                         json["case_file"] = case_file.source.string();
                         json["input"] = case_file.input.string();
                         if (!run.retried().is_null()) json["retry"] = run.retried();
                         return json;
                       },
                   .write =
                       [&] {
                         if (written) writer.commit();
                       },
                   .text = [&] { return text_of(run, result); },
                   .wrote = fmt::format("\nwrote {}\n", output.string()),
                   .also_wrote = {},
                   .warnings = failures,
                   .refusal =
                       [&] {
                         return refusal(output.string(), "cells are inverted that were not in the baseline",
                                        run.diagnosis(),
                                        "move the blades less, " +
                                            (run.sector().mesh().is_structured()
                                                 ? run.sector().kind().change
                                                 : std::string("change [near_field], set retry = true in [guard]")));
                       }},
                  terminal);
}

}  // namespace gridmorph::cli
