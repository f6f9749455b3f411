#include <gridmorph/case/target_file.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface/surface_io.hpp>
#include <gridmorph/motion/motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <system_error>

namespace gridmorph {

namespace {

constexpr std::size_t most_problems = 10;
constexpr std::size_t fewest_points = 5;
constexpr std::string_view separators = ",; \t\r";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(separators), line.size()));
    if (line.empty()) return out;
    std::size_t const end = std::min(line.find_first_of(separators), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

/// Goes through the lines of a text. A header, a line without any number before the first point, is passed over.
class PointLines {
 public:
  PointLines(std::string_view text, std::string const& source) : text_(text), source_(source) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  enum class Kind { end, blank, comment, point };
  struct Line {
    Kind kind = Kind::end;
    std::string_view label;  ///< comment: its text; point: the word before the three numbers, if there is one
    Vec3 point;
  };

  Line next() {
    while (!text_.empty() && problems_.messages().size() < most_problems) {
      std::size_t const end = text_.find('\n');
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++number_;
      line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
      if (line.empty()) return {Kind::blank, {}, {}};
      if (line.front() == '#') {
        line.remove_prefix(std::min(line.find_first_not_of("# \t"), line.size()));
        line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
        return {Kind::comment, line, {}};
      }
      auto const words = words_of(line);
      bool const any = std::any_of(words.begin(), words.end(), [](auto w) { return finite_number(w).has_value(); });
      if (!any && !started_) {
        started_ = true;
        continue;
      }
      started_ = true;
      if (auto const point = read(words, line)) return *point;
    }
    return {};
  }
  [[nodiscard]] int number() const { return number_; }
  Problems& problems() { return problems_; }
  void finish() const { problems_.throw_if_any<ConfigError>(); }

 private:
  std::optional<Line> read(std::vector<std::string_view> const& words, std::string_view line) {
    if (columns_ == 0 && (words.size() == 3 || words.size() == 4)) columns_ = words.size();
    if (words.size() != columns_) {
      problems_.add(fmt::format("{}:{}: expected {} columns, found {}: \"{}\"", source_, number_,
                                columns_ == 0 ? "x, y, z or section, x, y, z, so 3 or 4" : std::to_string(columns_),
                                words.size(), line.substr(0, 80)));
      return std::nullopt;
    }
    std::array<double, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) {
      auto const v = finite_number(words[words.size() - 3 + c]);
      if (!v) {
        problems_.add(fmt::format("{}:{}: {} = \"{}\" is not a finite number", source_, number_, "xyz"[c],
                                  words[words.size() - 3 + c].substr(0, 40)));
        return std::nullopt;
      }
      value[c] = *v;
    }
    return Line{Kind::point, words.size() == 4 ? words[0] : std::string_view{}, {value[0], value[1], value[2]}};
  }

  std::string_view text_;
  std::string const& source_;
  int number_ = 0;
  bool started_ = false;
  std::size_t columns_ = 0;
  Problems problems_;
};

std::string text_of(std::filesystem::path const& path) {
  std::string text = mapping::read_text_file(path, "target file");
  if (text.find('\0') != std::string::npos)
    throw ConfigError(fmt::format(
        "target file '{}' is no text file; surfaces must have names that end in .stl or .cgns", path.string()));
  return text;
}

void scale(std::vector<Vec3>& points, double factor, std::filesystem::path const& file) {
  if (factor == 1) return;
  for (Vec3& p : points) {
    p = factor * p;
    if (!std::isfinite(norm(p)))
      throw ConfigError(fmt::format("{}: a point is not finite after length_scale = {}", file.string(), factor));
  }
}

TargetGeometry read_unscaled(TargetSource const& source) {
  std::string ending = source.file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  std::string const path = source.file.string();
  bool const cgns = ending == ".cgns" || ending == ".cgn" || ending == ".adf" || ending == ".hdf" || ending == ".h5";
  if (!cgns && !source.patches.empty())
    throw ConfigError(fmt::format("'{}': only CGNS meshes have target_patches; remove the key", path));
  if (ending == ".stl") return read_stl(path);
  if (cgns && source.patches.empty()) return read_cgns_surface(path);
  if (cgns) {
    Mesh const mesh = read_mesh(path);
    return surface_of(mesh, select_patches(mesh, source.patches));
  }
  TargetGeometry out;
  if (source.nodes)
    out.nodes = read_target_nodes(source.file);
  else
    out.sections = read_target_sections(source.file);
  return out;
}

}  // namespace

std::vector<TargetSection> parse_target_sections(std::string_view text, std::string const& source) {
  std::vector<TargetSection> out;
  PointLines lines(text, source);
  std::string name;   // of the next section
  std::string label;  // first column of the section at hand
  bool fresh = true;  // the next point begins a section
  std::vector<int> begins;
  for (auto line = lines.next(); line.kind != PointLines::Kind::end; line = lines.next()) {
    if (line.kind == PointLines::Kind::comment && !line.label.empty()) name = line.label;
    if (line.kind != PointLines::Kind::point) {
      // With a column that names sections, blank lines and comments do not divide them.
      fresh = fresh || label.empty();
      continue;
    }
    if (fresh || line.label != label) {
      label = line.label;
      out.push_back({!label.empty() ? label : !name.empty() ? name : fmt::format("line {}", lines.number()), {}});
      begins.push_back(lines.number());
      name.clear();
      fresh = false;
    }
    out.back().points.push_back(line.point);
  }
  for (std::size_t s = 0; s < out.size() && lines.problems().messages().size() < most_problems; ++s)
    if (out[s].points.size() < fewest_points)
      lines.problems().add(fmt::format("{}:{}: section '{}' has {} points; give at least {} around the profile", source,
                                       begins[s], out[s].name, out[s].points.size(), fewest_points));
  lines.finish();
  if (out.empty())
    throw ConfigError(fmt::format("{}: holds no sections; expected lines of x, y, z or section, x, y, z", source));
  return out;
}

std::vector<Vec3> parse_target_nodes(std::string_view text, std::string const& source) {
  std::vector<Vec3> out;
  PointLines lines(text, source);
  for (auto line = lines.next(); line.kind != PointLines::Kind::end; line = lines.next())
    if (line.kind == PointLines::Kind::point) out.push_back(line.point);
  lines.finish();
  if (out.empty()) throw ConfigError(fmt::format("{}: holds no points; expected lines of x, y, z", source));
  return out;
}

std::vector<TargetSection> read_target_sections(std::filesystem::path const& path) {
  return parse_target_sections(text_of(path), path.string());
}

std::vector<Vec3> read_target_nodes(std::filesystem::path const& path) {
  return parse_target_nodes(text_of(path), path.string());
}

TargetGeometry read_target(TargetSource const& source) {
  try {
    TargetGeometry out = read_unscaled(source);
    scale(out.points, source.length_scale, source.file);
    scale(out.nodes, source.length_scale, source.file);
    for (TargetGrid& grid : out.grids) scale(grid.points, source.length_scale, source.file);
    for (TargetSection& section : out.sections) scale(section.points, source.length_scale, source.file);
    return out;
  } catch (IoError const& e) {
    throw ConfigError(e.what());
  } catch (MeshError const& e) {
    throw ConfigError(e.what());
  } catch (MotionError const& e) {
    throw ConfigError(fmt::format("target_patches: {}", e.what()));
  }
}

}  // namespace gridmorph
