#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/foam/foam_cyclics.hpp>
#include <gridmorph/io/foam/foam_lists.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/foam/foam_parts.hpp>
#include <gridmorph/io/foam/foam_plane.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/polyhedron.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

namespace gridmorph::foam {

namespace {

namespace fs = std::filesystem;

bool holds_mesh(fs::path const& folder) {
  return is_there((folder / "faces").string()) && is_there((folder / "points").string());
}

constexpr char const* latest_time = "latestTime";

/// The number that is a folder's name.
std::optional<double> time_of(fs::path const& folder) {
  std::string const name = folder.filename().string();
  double value = 0;
  auto const [end, failure] = std::from_chars(name.data(), name.data() + name.size(), value);
  return failure != std::errc() || end != name.data() + name.size() ? std::nullopt : std::optional(value);
}

/// The folder of the latest time that has points of a mesh.
std::optional<fs::path> latest_points(fs::path const& of_case) {
  std::optional<fs::path> out;
  std::error_code failure;
  for (fs::directory_iterator entry(of_case, failure), end; !failure && entry != end; entry.increment(failure)) {
    auto const time = time_of(entry->path());
    if (time && is_there((entry->path() / "polyMesh" / "points").string()) && (!out || *time > *time_of(*out)))
      out = entry->path();
  }
  return out;
}

/// The folder that a path names: without the empty file that stands for a case, and the stroke at the end.
fs::path folder_named(fs::path const& path) {
  std::error_code ignored;
  bool const named = path.extension() == ".foam" || path.extension() == ".OpenFOAM";
  fs::path const folder = named && !fs::is_directory(path, ignored) ? path.parent_path() : path;
  return folder.filename().empty() ? folder.parent_path() : folder;
}

fs::path above(fs::path const& folder) { return folder.parent_path().empty() ? fs::path(".") : folder.parent_path(); }

/// The number of a folder processor<number>.
std::optional<int> processor_of(fs::path const& folder) {
  std::string const name = folder.filename().string();
  std::string_view const wanted = "processor";
  int value = 0;
  if (!name.starts_with(wanted)) return std::nullopt;
  auto const [end, failure] = std::from_chars(name.data() + wanted.size(), name.data() + name.size(), value);
  return failure != std::errc() || end != name.data() + name.size() ? std::nullopt : std::optional(value);
}

/// The parts of a decomposed case that have a mesh, at a time if one is given.
std::vector<Part> parts_below(fs::path const& of_case, fs::path const& time) {
  std::vector<Part> out;
  std::error_code failure;
  for (fs::directory_iterator entry(of_case.empty() ? "." : of_case, failure), end; !failure && entry != end;
       entry.increment(failure))
    if (auto const number = processor_of(entry->path()))
      if (auto folders = poly_mesh(time.empty() ? entry->path() : entry->path() / time))
        out.push_back({std::move(*folders), *number, entry->path()});
  std::sort(out.begin(), out.end(), [](Part const& a, Part const& b) { return a.number < b.number; });
  return out;
}

class Reader {
 public:
  Reader(std::string const& path, Lists lists) : path_(path), lists_(std::move(lists)) {}

  Mesh run() {
    mesh_.source = path_;
    mesh_.first_number = 0;
    mesh_.dimension = 3;
    mesh_.coordinates = lists_.points;
    mesh_.add_zone("internalMesh", mesh_.coordinates.size());
    mesh_.zones.back().single_precision = lists_.single_precision;
    add_cells();
    check_closed();
    add_patches(lists_.boundary);
    add_subsets();
    Problems problems;
    io::check_places(mesh_, path_, problems);
    problems.throw_if_any<MeshError>();
    std::string why_not;
    if (auto const planes = find_planes(lists_, why_not))
      mesh_ = upper_plane(mesh_, *planes, lists_);
    else if (!why_not.empty())
      mesh_.notes.push_back(
          path_ + ": has " + why_not +
          ", so that it is morphed as a mesh of volumes; nodes of the two planes may come apart a little");
    check_mesh(mesh_);
    return std::move(mesh_);
  }

 private:
  /// Area vectors of all faces of a cell add up to nothing, to the 1e-6 that checkMesh asks for, whatever their shape.
  void check_closed() const {
    constexpr double rounding = 1e-6;
    std::vector<Vec3> sum(lists_.n_cells());
    std::vector<double> areas(sum.size(), 0.0);
    for (Index f = 0; f < faces_.size(); ++f) {
      Vec3 const area = 0.5 * face_normal(faces_[f], mesh_.coordinates);
      double const size = norm(area);
      auto const add = [&](Index32 cell, Vec3 const& outwards) {
        sum[cell] += outwards;
        areas[cell] += size;
      };
      add(owner_[f], area);
      if (std::size_t(f) < neighbour_.size()) add(neighbour_[f], -1.0 * area);
    }
    Index open = 0, first = -1;
    for (std::size_t c = 0; c < sum.size(); ++c)
      if (norm(sum[c]) > rounding * areas[c] && open++ == 0) first = Index(c);
    if (open > 0)
      throw MeshError(path_ + ": " + std::to_string(open) + " cells do not close, the first is cell " +
                      std::to_string(first) + ": its faces lack " + to_text(norm(sum[first]), 3) + " of an area of " +
                      to_text(areas[first], 3) +
                      "; owner, neighbour or the way round of a face is wrong (see checkMesh), write the mesh again");
  }

  void add_cells() {
    Index32 const n_cells = lists_.n_cells();
    // Faces of each cell, ascending; faces that lead into it as -1 - face.
    std::vector<Index> first(std::size_t(n_cells) + 1, 0);
    for (auto const* list : {&owner_, &neighbour_})
      for (Index32 const c : *list) ++first[c + 1];
    for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
    std::vector<Index32> of_cell(first.back());
    std::vector<Index> next(first.begin(), first.end() - 1);
    for (std::size_t f = 0; f < owner_.size(); ++f) {
      of_cell[next[owner_[f]]++] = Index32(f);
      if (f < neighbour_.size()) of_cell[next[neighbour_[f]]++] = -1 - Index32(f);
    }
    io::ElementsByFaces elements(mesh_);
    for (Index32 c = 0; c < n_cells; ++c) {
      for (Index k = first[c]; k < first[c + 1]; ++k) {
        Index32 const f = of_cell[k];
        elements.add_face(faces_[f < 0 ? -1 - f : f], f >= 0);
      }
      if (elements.n_faces() < 4)
        throw MeshError(path_ + ": cell " + std::to_string(c) + " has " + std::to_string(elements.n_faces()) +
                        " faces; a volume needs 4");
      elements.end_element(c);
    }
  }

  void add_patches(std::vector<BoundaryEntry> const& entries) {
    Problems problems;
    std::vector<BoundaryEntry const*> cyclics, mapped;
    for (BoundaryEntry const& entry : entries)
      if (entry["type"] == "cyclicAMI" && entry.size > 0) mapped.push_back(&entry);
    std::vector<Connection> matched = matching_sides(mapped, faces_, mesh_);
    auto const is_matched = [&](BoundaryEntry const& entry) {
      return entry["type"] == "cyclicAMI" &&
             std::any_of(matched.begin(), matched.end(), [&](Connection const& c) { return c.name == entry.name; });
    };
    for (BoundaryEntry const& entry : entries) {
      if (entry.size == 0) continue;
      std::string const type(entry["type"]);
      if (type.starts_with("processor"))
        problems.add(path_ + ": patch '" + entry.name + "' is of type " + type +
                     ": this is one part of a decomposed mesh; name the case above all of its folders processor0, "
                     "processor1, ..., or put the parts together (reconstructParMesh)");
      else if (type == "cyclic")
        cyclics.push_back(&entry);
      else if (type == "empty")
        add_planes(entry);
      else if (!is_matched(entry))
        add_patch(entry, type);
    }
    problems.throw_if_any<MeshError>();
    add_cyclics(cyclics, faces_, mesh_);
    std::move(matched.begin(), matched.end(), std::back_inserter(mesh_.connections));
  }

  void add_subsets() {
    for (ZoneEntry& zone : lists_.cell_zones) mesh_.subsets.push_back({std::move(zone.name), std::move(zone.labels)});
    for (ZoneEntry& zone : lists_.face_zones) {
      mesh_.subsets.push_back({std::move(zone.name), {}});
      for (Index32 const f : zone.labels) mesh_.subsets.back().faces.add(faces_[f]);
    }
  }

  Patch patch_of(BoundaryEntry const& entry, std::string const& type) {
    Patch patch;
    patch.name = entry.name;
    patch.bc_type = type;
    patch.zone = 0;
    patch.kind = type == "wall" ? PatchKind::wall
                 : type == "symmetryPlane" || type == "symmetry" || type == "wedge" || type == "empty"
                     ? PatchKind::symmetry
                 : type == "patch" ? io::kind_by_name(entry.name)
                                   : PatchKind::connection;
    // inGroups 2(wall rotor): a group that is not the type is a name for several patches.
    std::string groups(entry["inGroups"]);
    std::replace_if(
        groups.begin(), groups.end(), [](char c) { return c == '(' || c == ')'; }, ' ');
    std::istringstream words(groups);
    for (std::string word; words >> word;)
      if (word != type && word.find_first_not_of("0123456789") != std::string::npos && !word.starts_with("List<"))
        patch.families.push_back(word);
    if (!patch.families.empty()) patch.families.insert(patch.families.begin(), patch.name);
    return patch;
  }

  void add_patch(BoundaryEntry const& entry, std::string const& type) {
    Patch patch = patch_of(entry, type);
    for (Index k = 0; k < entry.size; ++k) patch.faces.add(faces_[entry.start + k]);
    mesh_.patches.push_back(std::move(patch));
  }

  /// The two sides of a mesh one cell thick, which may be one patch: what looks to one side, and what looks to the
  /// other.
  void add_planes(BoundaryEntry const& entry) {
    Vec3 const way = face_normal(faces_[entry.start], mesh_.coordinates);
    Patch sides[2] = {patch_of(entry, "empty"), patch_of(entry, "empty")};
    for (Index f = entry.start; f < entry.start + entry.size; ++f)
      sides[dot(way, face_normal(faces_[f], mesh_.coordinates)) < 0 ? 1 : 0].faces.add(faces_[f]);
    for (Patch& side : sides)
      if (side.faces.size() > 0) mesh_.patches.push_back(std::move(side));
  }

  std::string const& path_;
  Lists lists_;
  CsrGraph const& faces_ = lists_.faces;
  std::vector<Index32> const &owner_ = lists_.owner, &neighbour_ = lists_.neighbour;
  Mesh mesh_;
};

}  // namespace

std::optional<Folders> poly_mesh(fs::path const& path) {
  std::error_code ignored;
  fs::path folder = folder_named(path);
  if (folder.filename() == latest_time && !fs::exists(folder, ignored)) {
    fs::path const of_case = above(folder);
    folder = latest_points(of_case).value_or(of_case);
  }
  for (fs::path const& candidate : {folder / "constant" / "polyMesh", folder / "polyMesh", folder})
    if (holds_mesh(candidate)) return Folders{candidate, candidate};
  fs::path const constant = folder.parent_path() / "constant" / "polyMesh";
  if (time_of(folder) && is_there((folder / "polyMesh" / "points").string()) && holds_mesh(constant))
    return Folders{constant, folder / "polyMesh"};
  return std::nullopt;
}

std::vector<Part> parts_of(fs::path const& path) {
  fs::path const folder = folder_named(path);
  if (processor_of(folder)) return parts_below(above(folder), {});
  if (auto whole = poly_mesh(path)) return {{std::move(*whole), -1, {}}};
  if (folder.filename() == latest_time || time_of(folder)) return parts_below(above(folder), folder.filename());
  return parts_below(folder, {});
}

Mesh read(std::string const& path) {
  auto const parts = parts_of(path);
  if (parts.empty())
    throw IoError(path +
                  ": holds no mesh of OpenFOAM (constant/polyMesh with points and faces); make it first "
                  "(blockMesh, snappyHexMesh), or name the folder");
  if (parts.front().number >= 0) return Reader(path, join(parts, path).lists).run();
  Mesh mesh = Reader(path, read_lists(parts.front().folders)).run();
  if (auto const beside = parts_below(folder_named(path), {}); !beside.empty())
    mesh.notes.push_back(path + ": is the mesh as a whole; that of its " + std::to_string(beside.size()) +
                         " processor folders is another one, which " + beside.front().folder.string() + " names");
  return mesh;
}

}  // namespace gridmorph::foam
