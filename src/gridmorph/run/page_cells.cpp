// Histograms and worst cells of a run.
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/run/run_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace gridmorph::cli {

namespace {

constexpr Index most_sampled = 100'000;  ///< cells of a sample

/// One measure of the cells that are looked at.
struct Values {
  std::vector<double> const *before = nullptr, *after = nullptr;
};
struct Sample {
  std::vector<Index> cell;  ///< empty: all
  std::array<Values, page_measures.size()> value;
  std::array<std::vector<double>, 2 * page_measures.size()> own;  ///< of a sample
  std::vector<char> near;
};

double value_of(kernels::CellMeasures const& m, Measure measure) {
  return measure == Measure::aspect_ratio        ? m.aspect_ratio
         : measure == Measure::minimum_angle_deg ? m.minimum_angle_deg
                                                 : m.determinant_3x3x3;
}

bool is_near(NearCells const& near, Index cell) {
  return near.cells.extent(0) > 0 && near.cells(std::size_t(cell)) != 0;
}

/// Whether the run kept all of these measures, which then are those of the sample.
bool take_kept(PageMeshes const& meshes, Sample& out) {
  if (!meshes.kept) return false;
  for (std::size_t m = 0; m < page_measures.size(); ++m) {
    auto const values = meshes.kept(page_measures[m]);
    if (values.before == nullptr || values.after == nullptr) return false;
    out.value[m] = {values.before, values.after};
  }
  return true;
}

/// All cells where the run kept their measures, evenly spaced ones otherwise.
void take_sample(PageMeshes const& meshes, page::PictureMesh const& mesh, Sample& out) {
  NearCells const& near = meshes.near;
  Index const n_cells = mesh.n_cells();
  if (take_kept(meshes, out)) {
    out.near.assign(n_cells, 0);
    for (std::size_t n = 0; n < near.cells.extent(0); ++n) out.near[n] = near.cells(n) != 0 ? 1 : 0;
    return;
  }
  Index const stride = (n_cells + most_sampled - 1) / most_sampled;
  for (Index cell = 0; cell < n_cells; cell += stride) {
    out.cell.push_back(cell);
    out.near.push_back(is_near(near, cell) ? 1 : 0);
  }
  for (auto& values : out.own) values.resize(out.cell.size());
  for (std::size_t m = 0; m < page_measures.size(); ++m) out.value[m] = {&out.own[2 * m], &out.own[2 * m + 1]};
  constexpr std::size_t share = 1024;  // cells of a task
  for_each_task((out.cell.size() + share - 1) / share, [&](std::size_t task) {
    for (std::size_t n = task * share; n < std::min(out.cell.size(), (task + 1) * share); ++n) {
      auto const before = mesh.measures(out.cell[n], meshes.baseline);
      auto const after = mesh.measures(out.cell[n], meshes.morphed);
      for (std::size_t m = 0; m < page_measures.size(); ++m) {
        out.own[2 * m][n] = value_of(before, page_measures[m]);
        out.own[2 * m + 1][n] = value_of(after, page_measures[m]);
      }
    }
  });
}

struct Candidate {
  Index cell = -1;
  std::string reason;
};

/// The cells with the smallest keys in a region, the first of equals. key(n): of cell n.
template <class Key>
void add_smallest(Key const& key, std::vector<char> const& near, bool in_near, std::size_t many,
                  std::string const& reason, std::vector<Candidate>& out) {
  std::vector<std::pair<double, Index>> least;  // ascending
  for (std::size_t n = 0; n < near.size(); ++n) {
    if ((near[n] != 0) != in_near) continue;
    double const k = key(n);
    if (least.size() == many && !(k < least.back().first)) continue;
    auto const at =
        std::upper_bound(least.begin(), least.end(), k, [](double a, auto const& b) { return a < b.first; });
    least.insert(at, {k, Index(n)});
    if (least.size() > many) least.pop_back();
  }
  for (auto const& [k, cell] : least) out.push_back({cell, reason});
}

std::vector<Candidate> worst_of_all(Sample const& sample) {
  auto const &before = *sample.value[0].before, &after = *sample.value[0].after, &angle = *sample.value[1].after;
  std::array<std::vector<Candidate>, 6> found;
  for_each_task(found.size(), [&](std::size_t task) {
    bool const near = task < 3;
    std::string const field = near ? ", near field" : ", far field";
    std::vector<Candidate>& out = found[task];
    if (task % 3 == 0)
      add_smallest([&](std::size_t n) { return after[n]; }, sample.near, near, 2, "smallest determinant" + field, out);
    else if (task % 3 == 1)
      add_smallest([&](std::size_t n) { return angle[n]; }, sample.near, near, 1, "smallest angle" + field, out);
    else  // As CellLimits::max_loss counts.
      add_smallest([&](std::size_t n) { return (after[n] - before[n]) / std::max(std::abs(before[n]), 0.05); },
                   sample.near, near, 1, "largest loss of determinant" + field, out);
  });
  std::vector<Candidate> out;
  for (auto const& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

/// The worst cells of a verdict: those that the report names.
std::vector<Candidate> worst_of_report(QualityReport const& quality, page::PictureMesh const& mesh) {
  std::vector<Candidate> out;
  for (auto const& [region, field] :
       {std::pair(&quality.near_field, ", near field"), std::pair(&quality.far_field, ", far field")}) {
    for (auto const& [m, what] : {std::pair(Measure::determinant_3x3x3, "smallest determinant"),
                                  std::pair(Measure::minimum_angle_deg, "smallest angle")}) {
      MeasureStatistics const& s = (*region)[m];
      if (s.worst_zone >= 0) out.push_back({mesh.number_of(s.worst_zone, s.worst_cell), what + std::string(field)});
    }
    for (Fall const f : {Fall::inverted, Fall::loss})
      if ((*region)[f].cells > 0) out.push_back({(*region)[f].number, std::string(to_string(f)) + field});
  }
  return out;
}

/// One per measure of each field; none of a field without cells.
void make_histograms(Sample const& sample, page::ReportPage& out) {
  std::array<std::array<page::Histogram, 2>, page_measures.size()> made;
  for_each_task(made.size(), [&](std::size_t m) {
    made[m] = page::histograms(page_measures[m], *sample.value[m].before, *sample.value[m].after, sample.near);
  });
  for (std::size_t const near : {0U, 1U}) {
    if (std::find(sample.near.begin(), sample.near.end(), char(near)) == sample.near.end()) continue;
    for (auto& of_measure : made) {
      page::Histogram& h = of_measure[near];
      h.title = std::string(text_of(h.measure).title) + (near != 0 ? ", near field" : ", far field");
      (near != 0 ? out.near_histograms : out.far_histograms).push_back(std::move(h));
    }
  }
}

}  // namespace

void fill_quality(PageMeshes const& meshes, QualityReport const& quality, page::PictureMesh const& mesh,
                  page::ReportPage& out) {
  Sample sample;
  take_sample(meshes, mesh, sample);
  make_histograms(sample, out);
  if (!sample.cell.empty() && (quality.fast || Index(sample.cell.size()) < mesh.n_cells()))
    out.histogram_note =
        fmt::format("{}he histograms are of {} of {} {}, evenly spaced{}.",
                    quality.fast ? "A verdict was measured: t" : "T", sample.cell.size(), mesh.n_cells(), out.kind,
                    meshes.kept ? "; full quality (--quality full) has all of them" : "");
  constexpr std::size_t most_drawn = 6;
  std::set<Index> seen;
  for (Candidate const& one : sample.cell.empty() ? worst_of_all(sample) : worst_of_report(quality, mesh)) {
    if (one.cell < 0 || !seen.insert(one.cell).second) continue;
    page::WorstCell& worst = out.worst.emplace_back();
    worst.name = mesh.name(one.cell);
    worst.reason = one.reason;
    worst.centre = mesh.centre(one.cell, meshes.morphed);
    worst.before = mesh.measures(one.cell, meshes.baseline);
    worst.after = mesh.measures(one.cell, meshes.morphed);
    if (out.worst.size() <= most_drawn)
      worst.drawing = page::draw_cell(mesh, one.cell, meshes.baseline, meshes.morphed);
  }
}

}  // namespace gridmorph::cli
