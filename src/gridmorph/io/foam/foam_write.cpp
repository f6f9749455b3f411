#include <gridmorph/core/error.hpp>
#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/foam/foam_plane.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>

#include <array>
#include <charconv>
#include <cstring>
#include <system_error>

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
    if (std::error_code ignored; fs::exists(other / name, ignored))
      return fs::is_regular_file(folder / name, ignored) &&
             io::read_file((folder / name).string()) == io::read_file((other / name).string());
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

/// Folders that are made for an output; those that are not kept go again.
class MadeFolders {
 public:
  explicit MadeFolders(fs::path const& folder) {
    std::error_code failure;
    for (fs::path p = folder; !p.empty() && !fs::exists(p, failure); p = p.parent_path()) made_.push_back(p);
    fs::create_directories(folder, failure);
    if (failure) throw MachineError(folder.string() + ": cannot be made: " + failure.message());
  }
  ~MadeFolders() {
    std::error_code ignored;
    if (!kept_)
      for (fs::path const& p : made_) fs::remove_all(p, ignored);
  }
  MadeFolders(MadeFolders const&) = delete;
  MadeFolders& operator=(MadeFolders const&) = delete;
  void keep() { kept_ = true; }
  [[nodiscard]] bool is_new() const { return !made_.empty(); }

 private:
  std::vector<fs::path> made_;
  bool kept_ = false;
};

}  // namespace

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  auto const from = poly_mesh(input);
  if (!from) throw IoError(input + ": holds no mesh of OpenFOAM any more");
  FoamFile points((*from / "points").string(), {"vectorField"});
  std::string const text =
      with_points(points, mesh.dimension == 2 ? of_both_planes(*from, points, mesh, morphed) : morphed);
  // Beside the output's name stands what stood beside the input's.
  std::error_code ignored;
  fs::path below;
  for (fs::path const& part : {fs::path("constant") / "polyMesh", fs::path("polyMesh")})
    if (below.empty() && from->string().ends_with(part.string()) && !fs::equivalent(*from, input, ignored))
      below = part;
  fs::path const folder = below.empty() ? fs::path(output) : fs::path(output) / below;
  std::string const points_name = fs::path(points.path()).filename().string();
  bool const in_place = fs::exists(folder, ignored) && fs::equivalent(folder, *from, ignored);
  MadeFolders made(folder);
  if (!in_place) {
    if (!made.is_new() && !fs::is_empty(folder, ignored) && !holds_same_faces(folder, *from))
      throw IoError(folder.string() + ": is there and holds something else than the mesh of " + input +
                    "; give another name, or remove it");
    for (fs::directory_entry const& entry : fs::directory_iterator(*from)) {
      if (!entry.is_regular_file() || entry.path().filename() == points_name) continue;
      io::OutputFile copy((folder / entry.path().filename()).string());
      copy.copy_from(entry.path().string());
      copy.commit();
    }
  }
  io::OutputFile target((folder / points_name).string());
  target.write(text);
  target.commit();
  made.keep();
}

}  // namespace gridmorph::foam
