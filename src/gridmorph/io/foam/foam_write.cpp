#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/foam/foam_plane.hpp>
#include <gridmorph/io/made_folders.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>

#include <array>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

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
    double const value = arrays[std::size_t(p.component)][p.point];
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

/// All points of a plane mesh.
Coordinates of_both_planes(fs::path const& folder, FoamFile& points, Mesh const& mesh, Coordinates const& morphed) {
  Coordinates const all = points.coordinates();
  CsrGraph const faces = FoamFile((folder / "faces").string(), {"faceList", "faceCompactList"}).faces();
  std::string why_not;
  auto const pairs = plane_pairs(FoamFile((folder / "boundary").string(), {"polyBoundaryMesh"}).boundary(faces.size()),
                                 faces, all, mesh.size(), why_not);
  if (!pairs || Index(pairs->size()) != mesh.n_nodes())
    throw IoError(folder.string() + ": holds another mesh than the one that was read; give the folder of that one");
  return both_planes(all, *pairs, morphed);
}

/// Where a mesh lies below the folder by which it is named.
fs::path place_below(fs::path const& mesh, std::string const& input) {
  std::error_code ignored;
  for (fs::path const& part : {fs::path("constant") / "polyMesh", fs::path("polyMesh")})
    if (mesh.string().ends_with(part.string()) && !fs::equivalent(mesh, input, ignored)) return part;
  return {};
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

/// All files of a mesh but its points, which are that text.
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

std::string file_name(FoamFile const& file) { return fs::path(file.path()).filename().string(); }

std::string time_name(double time) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), time).ptr};
}

/// What lies in a folder, the folder with it.
void add_files_in(fs::path const& folder, std::vector<fs::path>& out) {
  out.push_back(folder);
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
    if (entry->is_regular_file(failure)) out.push_back(entry->path());
}

}  // namespace

std::vector<fs::path> files_of(std::string const& path) {
  std::vector<fs::path> out;
  auto const folders = poly_mesh(path);
  if (!folders) return out;
  for (fs::path const& folder : {folders->mesh, folders->points}) {
    add_files_in(folder, out);
    // The case is named by its own folder, too, or by one between: nothing is written into it, whichever of them is the output.
    auto above = fs::absolute(folder).lexically_normal();
    if (above.filename() != "polyMesh") continue;
    out.push_back(above = above.parent_path());
    if (above.filename() == "constant" || folder != folders->mesh) out.push_back(above.parent_path());
  }
  return out;
}

std::vector<fs::path> files_to_write(std::string const& input, std::string const& output,
                                     std::vector<double> const& times) {
  std::vector<fs::path> out;
  auto const from = poly_mesh(input);
  if (!from) return out;
  fs::path const place = times.empty() ? place_below(from->mesh, input) : fs::path("constant") / "polyMesh";
  std::vector<fs::path> there;
  add_files_in(from->mesh, there);
  std::string const points = fs::exists(from->points / "points") ? "points" : "points.gz";
  out.push_back(fs::path(output) / place);
  out.push_back(fs::path(output) / place / points);
  for (std::size_t n = 1; n < there.size(); ++n) out.push_back(fs::path(output) / place / there[n].filename());
  for (double const time : times) {
    out.push_back(fs::path(output) / time_name(time) / "polyMesh");
    out.push_back(out.back() / points);
  }
  return out;
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  auto const from = poly_mesh(input);
  if (!from) throw IoError(input + ": holds no mesh of OpenFOAM any more");
  FoamFile points((from->points / "points").string(), {"vectorField"});
  std::string const text =
      with_points(points, mesh.dimension == 2 ? of_both_planes(from->mesh, points, mesh, morphed) : morphed);
  Making to;
  add_mesh_folder(input, *from, fs::path(output) / place_below(from->mesh, input), file_name(points), text, to);
  to.commit();
}

struct TimeFolders::State {
  std::string input;
  fs::path output;
  Folders from;
  Mesh const& mesh;
  FoamFile points;
  std::vector<double> times;
  std::size_t written = 0;
  Making to;

  State(std::string in, std::string const& out, Mesh const& m, std::vector<double> t, Folders f)
      : input(std::move(in)),
        output(out),
        from(std::move(f)),
        mesh(m),
        points((from.points / "points").string(), {"vectorField"}),
        times(std::move(t)) {}
};

TimeFolders::TimeFolders(std::string const& input, std::string const& output, Mesh const& mesh,
                         std::vector<double> const& times) {
  auto from = poly_mesh(input);
  if (!from) throw IoError(input + ": holds no mesh of OpenFOAM any more");
  for (std::size_t n = 1; n < times.size(); ++n)
    if (time_name(times[n]) == time_name(times[n - 1]))
      throw IoError(output + ": two times of the series are " + time_name(times[n]) + "; their folders would be one");
  state_ = std::make_unique<State>(input, output, mesh, times, *from);
  add_mesh_folder(input, *from, state_->output / "constant" / "polyMesh", file_name(state_->points),
                  with_points(state_->points, state_->points.coordinates()), state_->to);
}

TimeFolders::~TimeFolders() = default;

void TimeFolders::add(Coordinates const& morphed) {
  State& s = *state_;
  fs::path const folder = s.output / time_name(s.times.at(s.written)) / "polyMesh";
  s.to.folders.make(folder);
  std::string text =
      with_points(s.points, s.mesh.dimension == 2 ? of_both_planes(s.from.mesh, s.points, s.mesh, morphed) : morphed);
  s.to.files.add((folder / file_name(s.points)).string()).write(text);
  ++s.written;
}

void TimeFolders::commit() { state_->to.commit(); }

}  // namespace gridmorph::foam
