#include <gridmorph/app/any_mesh.hpp>
#include <gridmorph/app/block_mesh.hpp>
#include <gridmorph/app/element_mesh.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/mapping_report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace gridmorph::cli {

std::string field_name(Measure measure) {
  std::string out;
  bool upper = true;
  for (char const c : to_string(measure)) {
    if (c != '_') out += upper && c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    upper = c == '_';
  }
  return out;
}

std::vector<Shortfall> trimmed_beyond(double allowed, std::vector<Trim> const& trims) {
  std::vector<Shortfall> out;
  for (Trim const& trim : trims)
    if (trim.share() > allowed) out.push_back({Shortfall::Severity::failure, describe(trim)});
  return out;
}

void AnyPlan::take_trims(std::vector<Trim> const& trims, double allowed) {
  refuse_undone(trims, allowed);
  allowed_trim_ = allowed;
  for (Trim const& trim : trims) {
    auto const known = std::find_if(trims_.begin(), trims_.end(),
                                    [&](Trim const& t) { return t.patch == trim.patch && t.rule == trim.rule; });
    if (known == trims_.end())
      trims_.push_back(trim);
    else if (trim.share() > known->share())
      *known = trim;
  }
}

std::vector<Shortfall> AnyPlan::trimmed() const { return trimmed_beyond(allowed_trim_, trims_); }

std::vector<std::string> AnyPlan::trim_notes() const {
  std::vector<std::string> out;
  for (Trim const& trim : trims_)
    if (trim.share() <= allowed_trim_) out.push_back(describe(trim));
  return out;
}

void AnyPlan::record(std::vector<Vec3> const& displacement, Coordinates const& plain, Coordinates const& guarded) {
  if (!record_) record_.emplace(new_record());
  record_->add(displacement, plain, guarded);
}

SmoothingMap const& AnyPlan::freeze_recorded() {
  frozen_map_ = record_->map();
  record_.reset();
  drop_morpher();
  return *frozen_map_;
}

void make_stage_folder(std::filesystem::path const& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw MachineError(
        fmt::format("the folder '{}' for the stages cannot be made: {}", folder.string(), error.message()));
}

CellFields<Kokkos::HostSpace> fields_of(std::vector<CellField>& out, std::span<Measure const> measures, Index n_cells) {
  CellFields<Kokkos::HostSpace> fields;
  out.clear();
  for (Measure const m : measures) {
    auto const unit = m == Measure::minimum_angle_deg ? FieldUnit::degree : FieldUnit::number;
    auto& values = out.emplace_back(CellField{field_name(m), std::vector<double>(std::size_t(n_cells)), unit}).values;
    fields[m] = Kokkos::View<double*, Kokkos::HostSpace>(values.data(), values.size());
  }
  return fields;
}

std::vector<int> predicted_steps(CaseFile const& case_file, int most) {
  return case_file.sequence ? case_file.sequence->some_steps(most) : std::vector<int>{0};
}

std::string worst_step_text(CaseFile const& case_file, int step) {
  auto const looked_at = int(predicted_steps(case_file).size()), steps = case_file.sequence->steps;
  return looked_at == steps
             ? fmt::format("step {} of {} comes out worst: ", step + 1, steps)
             : fmt::format("step {} comes out worst of the {} that are looked at of {}: ", step + 1, looked_at, steps);
}

std::vector<Shortfall> mapping_warnings(CaseFile const& case_file) {
  std::vector<Shortfall> out;
  for (auto const& use : case_file.fields) {
    try {
      use.field->judge();
    } catch (MotionError const& e) {
      throw MotionError(use.where + ": " + e.what());
    }
    if (auto const text = far_from_model(*use.field); !text.empty() && !use.inverse)
      out.push_back({Shortfall::Severity::warning, use.where + ": " + text});
  }
  return out;
}

std::vector<std::string> mapping_notes(CaseFile const& case_file) {
  std::vector<std::string> notes = case_file.notes;
  for (auto const& use : case_file.fields) {
    notes.insert(notes.end(), use.field->notes().begin(), use.field->notes().end());
    notes.push_back(use.where + ": " + describe_mapping(*use.field));
    if (use.inverse) notes.push_back(use.where + ": " + describe_inverse(*use.inverse));
  }
  return notes;
}

KindTraits const& MeshSource::traits() const {
  return kind == MeshKind::unstructured ? ElementMesh::traits() : BlockMesh::traits();
}

MeshSource look_at(std::filesystem::path const& path, std::vector<std::string> const& leave_out) {
  return {look_at_mesh(path.string(), leave_out), path, leave_out};
}

std::unique_ptr<AnyMesh> load(MeshSource const& file, std::optional<std::filesystem::path> const& side_file) {
  if (file.kind == MeshKind::unstructured) return std::make_unique<ElementMesh>(file.path, side_file, file.leave_out);
  return std::make_unique<BlockMesh>(file.path, side_file, file.leave_out);
}

}  // namespace gridmorph::cli
