#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/foam/foam_parts.hpp>
#include <gridmorph/io/foam/foam_plane.hpp>
#include <gridmorph/io/made_folders.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>

#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace gridmorph::foam {

namespace {

namespace fs = std::filesystem;

/// The text of the points with others in their place; what did not change stays byte for byte.
std::string with_points(FoamFile& file, Coordinates const& morphed) {
  std::string const& text = file.text();
  std::array<double const*, 3> const arrays{morphed.x.data(), morphed.y.data(), morphed.z.data()};
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  std::size_t copied = 0;
  Index const n = file.points([&](PointText const& p) {
    if (p.point >= morphed.size()) return;
    double const value = arrays[p.component][p.point];
    std::array<char, 32> bytes{};
    std::size_t length = 0;
    if (!file.is_binary()) {
      if (std::memcmp(&value, &p.value, sizeof value) == 0) return;
      length = std::size_t(std::to_chars(bytes.data(), bytes.data() + bytes.size(), value).ptr - bytes.data());
    } else if (file.scalar_bytes() == 8) {
      std::memcpy(bytes.data(), &value, length = sizeof value);
    } else {
      auto const single = float(value);
      std::memcpy(bytes.data(), &single, length = sizeof single);
    }
    out.append(text, copied, p.begin - copied);
    out.append(bytes.data(), length);
    copied = p.end;
  });
  if (n != morphed.size())
    throw IoError(file.path() + ": holds " + std::to_string(n) + " points and the mesh has " +
                  std::to_string(morphed.size()) + "; give the folder that the mesh was read from");
  out.append(text, copied);
  return file.is_packed() ? packed(file.path(), out) : out;
}

/// Whether a folder holds a mesh with the faces of another one, as the same bytes.
bool holds_same_faces(fs::path const& folder, fs::path const& other) {
  for (char const* name : {"faces", "faces.gz"})
    if (std::error_code ignored; fs::exists(other / name, ignored)) {
      if (!fs::is_regular_file(folder / name, ignored)) return false;
      bool const is_input = io::FilesRead::name_of(folder / name).has_value();
      bool const same = io::read_file((folder / name).string()) == io::read_file((other / name).string());
      if (!is_input) io::FilesRead::release(folder / name);  // was only looked at, and may be replaced
      return same;
    }
  return false;
}

/// The points of a mesh, a file for each of its parts.
class PointFiles {
 public:
  PointFiles(std::string const& input, Mesh const& mesh)
      : input_(input), n_nodes_(mesh.n_nodes()), parts_(parts_of(input)) {
    if (parts_.empty()) throw IoError(input + ": holds no mesh of OpenFOAM any more");
    for (Part const& part : parts_) files_.emplace_back((part.folders.points / "points").string(), vectors);
    if (parts_.front().number >= 0) joined_ = join(parts_, input);
    if (mesh.dimension == 2) find_both_planes();
  }

  [[nodiscard]] std::vector<Part> const& parts() const { return parts_; }
  [[nodiscard]] std::string name(std::size_t part) const { return fs::path(files_[part].path()).filename().string(); }
  /// All points, where the nodes of the mesh are `morphed`.
  [[nodiscard]] Coordinates all(Coordinates const& morphed) const {
    return planes_ ? both_planes(on_planes_, *planes_, morphed) : morphed;
  }
  /// The text of the points of one part, which are among `all`.
  std::string text(std::size_t part, Coordinates const& all) {
    if (joined_ && all.size() != joined_->lists.points.size()) refuse();
    return with_points(files_[part], joined_ ? points_of_part(*joined_, part, all) : all);
  }
  /// The text of the points of one part as they are.
  std::string text(std::size_t part) { return with_points(files_[part], files_[part].coordinates()); }

 private:
  static inline std::vector<std::string_view> const vectors{"vectorField"};

  [[noreturn]] void refuse() const {
    throw IoError(input_ + ": holds another mesh than the one that was read; give the folder of that one");
  }
  void find_both_planes() {
    Lists const lists = joined_ ? joined_->lists : read_lists(parts_.front().folders);
    std::string why_not;
    planes_ = find_planes(lists, why_not);
    if (!planes_ || Index(planes_->pairs.size()) != n_nodes_) refuse();
    on_planes_ = lists.points;
  }

  std::string input_;
  Index n_nodes_;
  std::vector<Part> parts_;
  std::vector<FoamFile> files_;
  std::optional<JoinedLists> joined_;
  std::optional<Planes> planes_;  ///< of a plane mesh
  Coordinates on_planes_;         ///< all points that it lies between
};

/// Where a mesh lies below the folder by which it is named.
fs::path place_below(fs::path const& mesh, std::string const& input) {
  std::error_code ignored;
  for (fs::path const& part : {fs::path("constant") / "polyMesh", fs::path("polyMesh")})
    if (mesh.string().ends_with(part.string()) && !fs::equivalent(mesh, input, ignored)) return part;
  return {};
}

/// Where a part goes below the output.
fs::path place_of(Part const& part, std::string const& input, bool is_series) {
  fs::path const constant = fs::path("constant") / "polyMesh";
  if (part.number >= 0) return part.folder.filename() / constant;
  return is_series ? constant : place_below(part.folders.mesh, input);
}

/// What is made of a mesh, and appears in the end or not at all.
struct Making {
  io::MadeFolders folders;
  io::OutputFiles files;

  void commit() {
    files.commit();
    folders.keep();
  }
};

/// Adds all files of a mesh, with `text` for its points.
void add_mesh_folder(std::string const& input, Folders const& from, fs::path const& folder,
                     std::string const& points_name, std::string const& text, Making& to) {
  std::error_code ignored;
  bool const in_place = fs::exists(folder, ignored) && fs::equivalent(folder, from.mesh, ignored);
  to.folders.make(folder);
  if (!in_place) {
    if (!fs::is_empty(folder, ignored) && !holds_same_faces(folder, from.mesh))
      throw IoError(folder.string() + ": is there and holds something else than the mesh of " + input +
                    "; give another name, or remove it");
    for (fs::directory_entry const& entry : fs::directory_iterator(from.mesh)) {
      std::string const name = entry.path().filename().string();
      if (!entry.is_regular_file() || name == "points" || name == "points.gz") continue;
      to.files.add((folder / name).string()).copy_from(entry.path().string());
    }
  }
  to.files.add((folder / points_name).string()).write(text);
}

std::string time_name(double time) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), time).ptr};
}

/// The folder of the points of a part at a time.
fs::path time_folder(Part const& part, fs::path const& output, double time) {
  return output / part.folder.filename() / time_name(time) / "polyMesh";
}

/// Adds what lies in a folder, and the folder itself.
void add_files_in(fs::path const& folder, std::vector<fs::path>& out) {
  out.push_back(folder);
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
    if (entry->is_regular_file(failure)) out.push_back(entry->path());
}

}  // namespace

std::vector<fs::path> files_of(std::string const& path) {
  std::vector<fs::path> out;
  for (Part const& part : parts_of(path))
    for (fs::path const& folder : {part.folders.mesh, part.folders.points}) {
      add_files_in(folder, out);
      // The case is named by its own folder, too, or by one between: nothing is written into it, whichever of them is
      // the output.
      auto above = fs::absolute(folder).lexically_normal();
      if (above.filename() != "polyMesh") continue;
      out.push_back(above = above.parent_path());
      if (above.filename() == "constant" || folder != part.folders.mesh) out.push_back(above = above.parent_path());
      if (part.number >= 0) out.push_back(fs::absolute(part.folder).lexically_normal().parent_path());
    }
  return out;
}

std::vector<fs::path> files_to_write(std::string const& input, std::string const& output,
                                     std::vector<double> const& times) {
  std::vector<fs::path> out;
  for (Part const& part : parts_of(input)) {
    fs::path const to = fs::path(output) / place_of(part, input, !times.empty());
    std::vector<fs::path> there;
    add_files_in(part.folders.mesh, there);
    std::string const points = fs::exists(part.folders.points / "points") ? "points" : "points.gz";
    out.push_back(to);
    out.push_back(to / points);
    for (std::size_t n = 1; n < there.size(); ++n) out.push_back(to / there[n].filename());
    for (double const time : times) {
      out.push_back(time_folder(part, output, time));
      out.push_back(out.back() / points);
    }
  }
  return out;
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  PointFiles points(input, mesh);
  Coordinates const all = points.all(morphed);
  Making to;
  for (std::size_t p = 0; p < points.parts().size(); ++p) {
    Part const& part = points.parts()[p];
    add_mesh_folder(input, part.folders, fs::path(output) / place_of(part, input, false), points.name(p),
                    points.text(p, all), to);
  }
  to.commit();
}

struct TimeFolders::State {
  fs::path output;
  PointFiles points;
  std::vector<double> times;
  std::size_t written = 0;
  Making to;
};

TimeFolders::TimeFolders(std::string const& input, std::string const& output, Mesh const& mesh,
                         std::vector<double> const& times)
    : state_(new State{output, PointFiles(input, mesh), times, 0, {}}) {
  for (std::size_t n = 1; n < times.size(); ++n)
    if (time_name(times[n]) == time_name(times[n - 1]))
      throw IoError(output + ": two times of the series are " + time_name(times[n]) + "; their folders would be one");
  State& s = *state_;
  for (std::size_t p = 0; p < s.points.parts().size(); ++p) {
    Part const& part = s.points.parts()[p];
    add_mesh_folder(input, part.folders, s.output / place_of(part, input, true), s.points.name(p), s.points.text(p),
                    s.to);
  }
}

TimeFolders::~TimeFolders() = default;

void TimeFolders::add(Coordinates const& morphed) {
  State& s = *state_;
  Coordinates const all = s.points.all(morphed);
  for (std::size_t p = 0; p < s.points.parts().size(); ++p) {
    fs::path const folder = time_folder(s.points.parts()[p], s.output, s.times.at(s.written));
    s.to.folders.make(folder);
    s.to.files.add((folder / s.points.name(p)).string()).write(s.points.text(p, all));
  }
  ++s.written;
}

void TimeFolders::commit() { state_->to.commit(); }

}  // namespace gridmorph::foam
