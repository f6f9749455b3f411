#include <gridmorph/io/checksum.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/page/html.hpp>
#include <gridmorph/report/block_graph_text.hpp>
#include <gridmorph/run/mesh_cuts.hpp>
#include <gridmorph/run/run_page.hpp>
#include <gridmorph/run/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>
#include <system_error>

#include <sys/utsname.h>

namespace gridmorph::cli {

namespace {

constexpr int picture_width = 880, picture_height = 600;  ///< of surfaces; of steps three quarters of it
constexpr int section_width = 640;
constexpr int most_steps = 24;  ///< of a sequence that are shown

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (auto const at = line.find(": "); at != std::string::npos) return line.substr(at + 2);
  return {};
}

std::string machine() {
  utsname name{};
  if (::uname(&name) != 0) return processor();
  std::string const cpu = processor();
  return fmt::format("{} {} {}{}{}", name.sysname, name.release, name.machine, cpu.empty() ? "" : ", ", cpu);
}

std::string now() {
  std::time_t const t = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&t, &utc);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

/// Files that the run reads, and what they are.
std::vector<std::pair<std::string, std::filesystem::path>> inputs_of_run(CaseFile const& case_file) {
  std::vector<std::pair<std::string, std::filesystem::path>> out{{"mesh", case_file.input}};
  if (case_file.side_file) out.emplace_back("side file", *case_file.side_file);
  for (auto const& file : case_file.files) out.emplace_back("input file", file);
  return out;
}

/// Size and checksum; empty of what is no ordinary file.
std::string identity_of(std::filesystem::path const& path) {
  auto const sum = io::posix_checksum(path.string());
  return sum ? fmt::format("{} bytes, cksum {}", sum->bytes, sum->value) : std::string();
}

std::vector<std::pair<std::string, std::string>> settings_of_program() {
  std::vector<std::pair<std::string, std::string>> out;
  std::istringstream versions(version_text());
  for (std::string line; std::getline(versions, line);) out.emplace_back("version", line);
  out.emplace_back("threads", std::to_string(Kokkos::DefaultHostExecutionSpace().concurrency()));
  out.emplace_back("machine", machine());
  std::error_code error;
  out.emplace_back("folder", std::filesystem::current_path(error).string());
  out.emplace_back("date", now());
  return out;
}

}  // namespace

RunPage::RunPage(CaseFile const& case_file, std::string typed) : case_file_(case_file) {
  page_.command_line = std::move(typed);
  page_.settings = settings_of_program();
  page_.case_text = io::read_file(case_file.source.string());
}

void RunPage::begin(Run const& run) {
  pictures_ = run.mesh().pictures();
  roles_ = roles_of(run.plan().rules(), pictures_->mesh().patches.size());
  of_machine_ = is_of_machine(run.plan().rules());
  find_surface(run.mesh().coordinates());
}

void RunPage::begin_passage(std::unique_ptr<page::PictureMesh> pictures, PatchRoles roles,
                            Coordinates const& baseline) {
  pictures_ = std::move(pictures);
  roles_ = std::move(roles);
  of_machine_ = true;
  find_surface(baseline);
}

void RunPage::find_surface(Coordinates const& baseline) {
  if (pictures_->is_plane()) {
    surface_ = page::make_surface(pictures_->plane(), roles_.wall, baseline);
  } else {
    boundary_ = pictures_->boundary();
    surface_ = page::make_surface(boundary_, roles_.wall, baseline);
  }
}

std::vector<Vec3> RunPage::displacement_of_surface(Coordinates const& morphed) const {
  std::vector<Vec3> out;
  out.reserve(surface_.nodes.size());
  for (std::size_t n = 0; n < surface_.nodes.size(); ++n)
    out.push_back(morphed[surface_.nodes[n]] - surface_.baseline[n]);
  return out;
}

void RunPage::add_step(Run const& run, int step, int of, bool worst) {
  int const stride = (of + most_steps - 1) / most_steps;
  if (step % stride == 0) steps_.push_back({step, displacement_of_surface(run.morphed())});
  if (worst) worst_step_ = Step{step, displacement_of_surface(run.morphed())};
}

void RunPage::add_inputs() {
  auto const inputs = inputs_of_run(case_file_);
  std::vector<std::string> identity(inputs.size());
  for_each_task(inputs.size(), [&](std::size_t n) { identity[n] = identity_of(inputs[n].second); });
  for (std::size_t n = 0; n < inputs.size(); ++n)
    page_.settings.emplace_back(inputs[n].first,
                                inputs[n].second.string() + (identity[n].empty() ? "" : " (" + identity[n] + ")"));
  page_.settings.emplace_back("checksums", "as the program cksum prints them: cksum FILE");
}

void RunPage::add_output(std::filesystem::path const& output) {
  if (std::string const identity = identity_of(output); !identity.empty())
    page_.settings.emplace_back("output", identity);
}

void RunPage::describe(PageMeshes const& meshes, std::string const& cells) {
  add_inputs();
  Mesh const& mesh = pictures_->mesh();
  page_.structured = mesh.is_structured();
  page_.kind = cells;
  for (Index n = 0; n < meshes.baseline.size(); ++n)
    page_.largest_displacement = std::max(page_.largest_displacement, norm(meshes.morphed[n] - meshes.baseline[n]));
  page_.mesh_summary = fmt::format("{}, {} {}, {} nodes, {} {}; diagonal of its bounding box {:.4g}.",
                                   pictures_->is_plane() ? "A mesh in a plane" : "A mesh in space", mesh.zones.size(),
                                   mesh.zones.size() == 1 ? "zone" : "zones", mesh.n_nodes(), pictures_->n_cells(),
                                   page_.kind, page_.mesh_size);
}

void RunPage::finish(Run const& run, QualityReport const& quality) {
  BoundaryMotion const& rules = run.plan().rules();
  PageMeshes const meshes{run.mesh().coordinates(), run.morphed(), run.plan().near(),
                          [&](Measure measure) { return run.kept(measure); }};
  page_.mesh_size = rules.boundary().size();
  describe(meshes, run.mesh().kind().cells);
  page_.rules = rule_rows(rules, meshes.baseline, meshes.morphed);
  page_.check = boundary_check(rules, meshes.baseline, meshes.morphed);
  page_.plan = run.plan().json();
  if (auto const graph = run.plan().graph()) page_.graph = svg_text(*graph);
  fill_quality(meshes, quality, *pictures_, page_);
  if (case_file_.sequence)
    make_steps();
  else
    make_surfaces(meshes.morphed);
  make_sections(meshes);
}

void RunPage::finish_passage(PageMeshes const& meshes, QualityReport const& quality, std::string const& cells) {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (Index n = 0; n < meshes.baseline.size(); ++n) {
    Vec3 const p = meshes.baseline[n];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  page_.mesh_size = norm(high - low);
  describe(meshes, cells);
  fill_quality(meshes, quality, *pictures_, page_);
  make_surfaces(meshes.morphed);
  make_sections(meshes);
}

void RunPage::make_surfaces(Coordinates const& morphed) {
  if (surface_.facets.empty()) return;
  auto const u = displacement_of_surface(morphed);
  page_.scale_end = largest_norm(u);
  std::vector<page::View> views;
  if (pictures_->is_plane()) {
    views = {page::plane_view(surface_, u, picture_width, picture_height)};
    page_.surfaces = {{"", "the morphed mesh; blue: where its walls were"}};
  } else {
    auto const both = page::find_views(surface_, u, upwards(case_file_.axis, surface_), picture_width, picture_height);
    views.assign(both.begin(), both.end());
    page_.surfaces = {{"", "the morphed walls as the flow sees them; blue: edges of what moves, in the baseline"},
                      {"", "the same from the other side"}};
  }
  for_each_task(views.size(), [&](std::size_t n) {
    page_.surfaces[n].body =
        page::image(page::surface_picture(surface_, u, page_.scale_end, views[n], picture_width, picture_height),
                    page_.surfaces[n].caption);
  });
}

void RunPage::make_steps() {
  if (surface_.facets.empty() || steps_.empty()) return;
  if (worst_step_ &&
      std::none_of(steps_.begin(), steps_.end(), [&](Step const& s) { return s.step == worst_step_->step; })) {
    steps_.push_back(std::move(*worst_step_));
    std::sort(steps_.begin(), steps_.end(), [](Step const& a, Step const& b) { return a.step < b.step; });
  }
  constexpr int width = picture_width * 3 / 4, height = picture_height * 3 / 4;
  Step const* most = &steps_.front();
  for (Step const& s : steps_)
    if (largest_norm(s.displacement) > largest_norm(most->displacement)) most = &s;
  page_.scale_end = largest_norm(most->displacement);
  page::View const view =
      pictures_->is_plane()
          ? page::plane_view(surface_, most->displacement, width, height)
          : page::find_views(surface_, most->displacement, upwards(case_file_.axis, surface_), width, height)[0];
  page_.steps.resize(steps_.size());
  for_each_task(steps_.size(), [&](std::size_t n) {
    Step const& s = steps_[n];
    page_.steps[n] = {s.step + 1,
                      page::image(page::surface_picture(surface_, s.displacement, page_.scale_end, view, width, height),
                                  fmt::format("surface in step {}", s.step + 1))};
  });
}

namespace {

/// A cut of both meshes.
struct BothSections {
  std::array<page::Section, 2> section;
  std::array<std::vector<page::Colour>, 2> colour;
  std::array<page::FlatBox, 2> walls;

  /// The box around what moves, in both.
  [[nodiscard]] page::FlatBox box() const {
    page::FlatBox out;
    for (auto const& w : walls)
      if (!w.empty()) {
        out.take(w.low);
        out.take(w.high);
      }
    return out;
  }
};

struct SectionFrame {
  std::size_t cut = 0;
  std::array<page::Window, 2> window;  ///< of the baseline and of the morphed mesh
  int height = 0;
  std::string title;
};

/// All of what moves.
SectionFrame whole_frame(std::size_t cut, page::FlatBox const& box, std::string title) {
  double const wide = box.high[0] - box.low[0], high = box.high[1] - box.low[1];
  double const ratio = std::clamp(wide > 0 ? 1.1 * high / wide : 1.0, 0.5, 1.0);
  page::Window const all{{0.5 * (box.low[0] + box.high[0]), 0.5 * (box.low[1] + box.high[1])},
                         1.35 * 0.5 * std::max(wide, high / ratio)};
  return {cut, {all, all}, int(section_width * ratio), std::move(title)};
}

/// An end of what moves along the first coordinate: a leading or trailing edge, a nose, a tail. In each mesh about
/// where it is there.
SectionFrame end_frame(std::size_t cut, BothSections const& both, bool first, std::string title) {
  page::FlatBox const box = both.box();
  double const size = std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  SectionFrame out{cut, {}, section_width * 2 / 3, std::move(title)};
  for (page::Window& w : out.window) w.half_width = 0.07 * size;
  for (std::size_t s = 0; s < 2; ++s)
    for (auto const& wall : both.section[s].walls)
      if (wall.moves)
        for (page::Flat const& p : {wall.a, wall.b})
          if (p[0] == (first ? both.walls[s].low[0] : both.walls[s].high[0])) out.window[s].centre = p;
  return out;
}
}  // namespace

/// By determinants as the run kept them, measured where it did not.
std::vector<page::Colour> RunPage::colours_of(PageMeshes const& meshes, std::vector<Index> const& cells,
                                              bool morphed) const {
  auto const kept = meshes.kept ? meshes.kept(Measure::determinant_3x3x3) : Run::KeptMeasure();
  auto const* const values = morphed ? kept.after : kept.before;
  Coordinates const& at = morphed ? meshes.morphed : meshes.baseline;
  std::vector<page::Colour> out;
  out.reserve(cells.size());
  for (Index const cell : cells)
    out.push_back(page::quality_colours().at(values != nullptr ? (*values)[cell]
                                                               : pictures_->measures(cell, at).determinant_3x3x3));
  return out;
}

void RunPage::make_sections(PageMeshes const& meshes) {
  auto const cuts =
      cuts_of(*pictures_, of_machine_, case_file_.axis, surface_, displacement_of_surface(meshes.morphed));
  std::vector<BothSections> both(cuts.size());
  for_each_task(2 * cuts.size(), [&](std::size_t n) {
    std::size_t const c = n / 2, s = n % 2;
    Coordinates const& at = s == 0 ? meshes.baseline : meshes.morphed;
    both[c].section[s] = page::cut_mesh(*pictures_, boundary_, at, cuts[c], roles_.wall);
    both[c].colour[s] = colours_of(meshes, both[c].section[s].cell, s == 1);
    both[c].walls[s] = page::moving_walls(both[c].section[s]);
  });
  // The cut with most of what moves comes first: of a wing that across its span.
  std::vector<std::size_t> order(cuts.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  auto const pieces = [&](std::size_t c) {
    auto const& walls = both[c].section[0].walls;
    return std::count_if(walls.begin(), walls.end(), [](auto const& wall) { return wall.moves; });
  };
  if (!cuts.empty() && cuts.front().period <= 0)
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pieces(a) > pieces(b); });
  std::vector<SectionFrame> frames;
  for (std::size_t const c : order) {
    page::FlatBox const box = both[c].box();
    if (box.empty()) continue;  // nothing that moves is cut
    bool const details = frames.empty() && !both[c].walls[0].empty() && !both[c].walls[1].empty();
    auto const& labels = cuts[c].labels;
    frames.push_back(
        whole_frame(c, box, fmt::format("{} ({} to the right, {} up)", cuts[c].title, labels[0], labels[1])));
    if (!details) continue;
    for (bool const first : {true, false})
      frames.push_back(end_frame(c, both[c], first,
                                 fmt::format("{}: the end at the {} {}, each mesh about its own", cuts[c].title,
                                             first ? "smallest" : "largest", labels[0])));
  }
  for (SectionFrame const& f : frames) page_.sections.push_back({f.title, {{"", "baseline"}, {"", "morphed"}}});
  for_each_task(2 * frames.size(), [&](std::size_t n) {
    SectionFrame const& f = frames[n / 2];
    page::Figure& figure = page_.sections[n / 2].figures[n % 2];
    BothSections const& b = both[f.cut];
    figure.body =
        page::image(page::section_picture(b.section[n % 2], b.colour[n % 2], f.window[n % 2], section_width, f.height),
                    f.title + ", " + figure.caption);
  });
}

std::string RunPage::text(nlohmann::json const& report) {
  page_.report = report;
  if (report.contains("passages")) {  // what is shown of quality is that of the worst one
    nlohmann::json const& worst = report["passages"][report["worst_passage"].get<std::size_t>() - 1];
    page_.report["morphed"] = worst["quality"];
    page_.report["morphed"]["certificate"] = report["certificate"];
    if (worst.contains("clearances")) page_.report["clearances"] = worst["clearances"];
  }
  return page::page_text(page_);
}

}  // namespace gridmorph::cli
