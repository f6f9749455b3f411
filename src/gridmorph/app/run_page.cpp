#include <gridmorph/app/cli/version.hpp>
#include <gridmorph/app/page/html.hpp>
#include <gridmorph/app/run_page.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/report/block_graph_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>

#include <sys/utsname.h>

namespace gridmorph::cli {

namespace {

constexpr int picture_width = 880, picture_height = 600;  ///< of surfaces; of steps three quarters of it
constexpr int section_width = 760;
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

std::string size_text(std::filesystem::path const& path) {
  std::error_code error;
  auto const size = std::filesystem::file_size(path, error);
  return error ? path.string() : fmt::format("{} ({} bytes)", path.string(), size);
}

std::vector<std::pair<std::string, std::string>> settings_of(CaseFile const& case_file) {
  std::vector<std::pair<std::string, std::string>> out;
  std::istringstream versions(version_text());
  for (std::string line; std::getline(versions, line);) out.emplace_back("version", line);
  out.emplace_back("threads", std::to_string(Kokkos::DefaultHostExecutionSpace().concurrency()));
  out.emplace_back("machine", machine());
  std::error_code error;
  out.emplace_back("folder", std::filesystem::current_path(error).string());
  out.emplace_back("mesh", size_text(case_file.input));
  if (case_file.side_file) out.emplace_back("side file", size_text(*case_file.side_file));
  for (auto const& file : case_file.files) out.emplace_back("input file", size_text(file));
  out.emplace_back("date", now());
  return out;
}

double largest(std::vector<Vec3> const& u) {
  double out = 0;
  for (Vec3 const& v : u) out = std::max(out, norm(v));
  return out;
}

/// Away from the axis of a machine; otherwise what the body is thinnest along, and z where it is as thick all round.
Vec3 upwards(std::optional<Axis> const& axis, page::Surface const& surface) {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, sum;
  double n = 0;
  for (std::size_t k = 0; k < surface.nodes.size(); ++k) {
    if (surface.focus[k] == 0) continue;
    Vec3 const& p = surface.baseline[k];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    sum += p;
    ++n;
  }
  if (n == 0) return {0, 0, 1};
  if (axis) {
    CylindricalFrame const frame(*axis);
    Vec3 const d = (1 / n) * sum - frame.origin();
    Vec3 const radial = d - dot(d, frame.direction()) * frame.direction();
    if (norm(radial) > 1e-3 * norm(d)) return (1 / norm(radial)) * radial;
  }
  Vec3 const size = high - low;
  if (size.y < 0.5 * size.z && size.y <= size.x) return {0, 1, 0};
  if (size.x < 0.5 * size.z && size.x < size.y) return {1, 0, 0};
  return {0, 0, 1};
}

}  // namespace

RunPage::RunPage(CaseFile const& case_file, std::string typed) : case_file_(case_file) {
  page_.command_line = std::move(typed);
  page_.settings = settings_of(case_file);
  page_.case_text = io::read_file(case_file.source.string());
}

void RunPage::begin(Run const& run) {
  pictures_ = run.mesh().pictures();
  Mesh const& mesh = pictures_->mesh();
  roles_ = roles_of(run.plan().rules(), mesh.patches.size());
  if (pictures_->is_plane()) {
    surface_ = page::make_surface(pictures_->plane(), roles_.wall, run.mesh().coordinates());
  } else {
    boundary_ = pictures_->boundary();
    surface_ = page::make_surface(boundary_, roles_.wall, run.mesh().coordinates());
  }
}

std::vector<Vec3> RunPage::displacement_of_surface(Run const& run) const {
  std::vector<Vec3> out;
  out.reserve(surface_.nodes.size());
  for (std::size_t n = 0; n < surface_.nodes.size(); ++n)
    out.push_back(run.morphed()[surface_.nodes[n]] - surface_.baseline[n]);
  return out;
}

void RunPage::add_step(Run const& run, int step, int of, bool worst) {
  int const stride = (of + most_steps - 1) / most_steps;
  if (step % stride == 0) steps_.push_back({step, displacement_of_surface(run)});
  if (worst) worst_step_ = Step{step, displacement_of_surface(run)};
}

void RunPage::finish(Run const& run, QualityReport const& quality) {
  BoundaryMotion const& rules = run.plan().rules();
  Mesh const& mesh = pictures_->mesh();
  Coordinates const& baseline = run.mesh().coordinates();
  page_.structured = mesh.is_structured();
  page_.kind = run.mesh().kind().cells;
  page_.mesh_size = rules.boundary().size();
  for (Index n = 0; n < baseline.size(); ++n)
    page_.largest_displacement = std::max(page_.largest_displacement, norm(run.morphed()[n] - baseline[n]));
  page_.mesh_summary = fmt::format(
      "{}, {} {}, {} nodes, {} {}; diagonal of its bounding box {:.4g}.",
      pictures_->is_plane() ? "A mesh in a plane" : "A mesh in space", mesh.zones.size(),
      mesh.zones.size() == 1 ? "zone" : "zones", mesh.n_nodes(), pictures_->n_cells(), page_.kind, page_.mesh_size);
  page_.rules = rule_rows(rules, baseline, run.morphed());
  page_.check = boundary_check(rules, baseline, run.morphed());
  page_.plan = run.plan().json();
  if (auto const graph = run.plan().graph()) page_.graph = svg_text(*graph);
  fill_quality(run, quality, *pictures_, page_);
  if (case_file_.sequence)
    make_steps();
  else
    make_surfaces(run);
  make_sections(run);
}

void RunPage::make_surfaces(Run const& run) {
  if (surface_.facets.empty()) return;
  auto const u = displacement_of_surface(run);
  page_.scale_end = largest(u);
  auto const add = [&](page::View const& view, std::string const& caption) {
    page_.surfaces.push_back({page::image(page::surface_picture(surface_, u, page_.scale_end, view, picture_width, picture_height),
                                          caption), caption});
  };
  if (pictures_->is_plane()) {
    add(page::plane_view(surface_, u, picture_width, picture_height),
        "the morphed mesh; blue: where its walls were");
    return;
  }
  auto const views = page::find_views(surface_, u, upwards(case_file_.axis, surface_), picture_width, picture_height);
  add(views[0], "the morphed walls as the flow sees them; blue: edges of patches in the baseline");
  add(views[1], "the same from the other side");
}

void RunPage::make_steps() {
  if (surface_.facets.empty() || steps_.empty()) return;
  if (worst_step_ && std::none_of(steps_.begin(), steps_.end(), [&](Step const& s) { return s.step == worst_step_->step; })) {
    steps_.push_back(std::move(*worst_step_));
    std::sort(steps_.begin(), steps_.end(), [](Step const& a, Step const& b) { return a.step < b.step; });
  }
  constexpr int width = picture_width * 3 / 4, height = picture_height * 3 / 4;
  Step const* most = &steps_.front();
  for (Step const& s : steps_)
    if (largest(s.displacement) > largest(most->displacement)) most = &s;
  page_.scale_end = largest(most->displacement);
  page::View const view =
      pictures_->is_plane()
          ? page::plane_view(surface_, most->displacement, width, height)
          : page::find_views(surface_, most->displacement, upwards(case_file_.axis, surface_), width, height)[0];
  for (Step const& s : steps_)
    page_.steps.push_back(
        {s.step + 1, page::image(page::surface_picture(surface_, s.displacement, page_.scale_end, view, width, height),
                                 fmt::format("surface in step {}", s.step + 1))});
}

void RunPage::make_sections(Run const& run) {
  auto const cuts = cuts_of(*pictures_, run.plan().rules(), case_file_.axis, surface_, displacement_of_surface(run));
  bool details = true;
  for (page::Cut const& cut : cuts) {
    std::array<Coordinates const*, 2> const at{&run.mesh().coordinates(), &run.morphed()};
    std::array<page::Section, 2> section;
    std::array<std::vector<float>, 2> value;
    page::FlatBox box;
    std::array<page::FlatBox, 2> walls;
    for (std::size_t s = 0; s < 2; ++s) {
      section[s] = page::cut_mesh(*pictures_, boundary_, *at[s], cut, roles_.wall);
      for (Index const cell : section[s].cell)
        value[s].push_back(float(pictures_->measures(cell, *at[s]).determinant_3x3x3));
      walls[s] = page::moving_walls(section[s]);
      if (!walls[s].empty()) {
        box.take(walls[s].low);
        box.take(walls[s].high);
      }
    }
    if (box.empty()) continue;  // nothing that moves is cut
    auto const add = [&](page::Window const& window, int height, std::string const& title) {
      page::FigureGroup group{title, {}};
      for (std::size_t s = 0; s < 2; ++s) {
        std::string const caption = s == 0 ? "baseline" : "morphed";
        group.figures.push_back(
            {page::image(page::section_picture(section[s], value[s], window, section_width, height), title + ", " + caption),
             caption});
      }
      page_.sections.push_back(std::move(group));
    };
    double const wide = box.high[0] - box.low[0], high = box.high[1] - box.low[1];
    double const ratio = std::clamp(wide > 0 ? 1.1 * high / wide : 1.0, 0.5, 1.0);
    page::Window const all{{0.5 * (box.low[0] + box.high[0]), 0.5 * (box.low[1] + box.high[1])},
                           1.35 * 0.5 * std::max(wide, high / ratio)};
    add(all, int(section_width * ratio), fmt::format("{} ({} to the right, {} up)", cut.title, cut.labels[0], cut.labels[1]));
    if (!details) continue;
    details = false;
    // The two ends of what moves along the first coordinate: leading and trailing edges, noses and tails.
    for (bool const first : {true, false}) {
      std::array<page::Flat, 2> tip{};
      for (std::size_t s = 0; s < 2; ++s)
        for (auto const& wall : section[s].walls)
          if (wall.moves)
            for (page::Flat const& p : {wall.a, wall.b})
              if (p[0] == (first ? walls[s].low[0] : walls[s].high[0])) tip[s] = p;
      double const apart = std::hypot(tip[0][0] - tip[1][0], tip[0][1] - tip[1][1]);
      page::Window const near{{0.5 * (tip[0][0] + tip[1][0]), 0.5 * (tip[0][1] + tip[1][1])},
                              std::max(0.07 * std::max(wide, high), 0.8 * apart)};
      add(near, section_width * 2 / 3, fmt::format("{}: the end towards {} {}", cut.title, first ? "smaller" : "larger", cut.labels[0]));
    }
  }
}

std::string RunPage::text(nlohmann::json const& report) {
  page_.report = report;
  return page::page_text(page_);
}

}  // namespace gridmorph::cli
