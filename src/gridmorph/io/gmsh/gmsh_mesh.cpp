#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/gmsh/gmsh_file.hpp>
#include <gridmorph/io/gmsh/gmsh_mesh.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/periodic_transform.hpp>
#include <gridmorph/io/replaced_text.hpp>
#include <gridmorph/io/rest_of_boundary.hpp>
#include <gridmorph/io/used_nodes.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace gridmorph::gmsh {

namespace {

/// The distance between nodes that match, as a share of the mesh size: periodic nodes in text have six digits and more.
constexpr double periodic_tolerance = 1e-5;

int dimension_of(File const& file) {
  int out = 0;
  for (auto const& group : file.groups) out = std::max(out, group.dimension);
  return out;
}

/// Number in the mesh of each node of the file; -1 for those that no element of its dimension uses (centres of circles,
/// ...).
std::vector<Index32> mesh_nodes(File const& file, int dimension, Index& n_nodes) {
  return io::used_nodes(
      file.nodes, file.tag.size(), [&](Index e) { return file.groups[file.group[e]].dimension == dimension; }, n_nodes);
}

class Builder {
 public:
  Builder(std::string const& path, File const& file) : path_(path), file_(file) {
    mesh_.source = path;
    mesh_.first_number = 1;
  }

  Mesh run() {
    mesh_.dimension = dimension_of(file_);
    if (mesh_.dimension < 2)
      throw MeshError(path_ + ": has neither volumes nor surfaces; save the mesh with its elements");
    Index n_nodes = 0;
    number_ = mesh_nodes(file_, mesh_.dimension, n_nodes);
    mesh_.add_zone("zone 1", n_nodes);
    coordinates();
    Problems problems;
    io::check_places(mesh_, path_, problems);
    problems.throw_if_any<MeshError>();
    gather_groups();
    elements();
    patches();
    connections();
    check_mesh(mesh_);
    ungrouped_ = io::add_rest_of_boundary(mesh_);
    notes();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] Group const& group_of(Index e) const { return file_.groups[file_.group[e]]; }

  void coordinates() {
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    for (std::size_t n = 0; n < number_.size(); ++n)
      if (number_[n] >= 0)
        mesh_.coordinates.set(number_[n],
                              {file_.coordinates[3 * n], file_.coordinates[3 * n + 1], file_.coordinates[3 * n + 2]});
  }

  /// Gathers the groups of elements that are there several times: in version 2.2 an element that belongs to several
  /// physical groups is there once for each of them.
  void gather_groups() {
    if (!file_.repeats_elements) return;
    std::map<std::pair<int, std::int64_t>, int> with_entity;
    for (auto const& group : file_.groups) ++with_entity[{group.dimension, group.entity}];
    std::vector<char> several(file_.groups.size());
    for (std::size_t g = 0; g < several.size(); ++g)
      several[g] = with_entity[{file_.groups[g].dimension, file_.groups[g].entity}] > 1 &&
                   file_.groups[g].dimension >= mesh_.dimension - 1;
    std::map<std::vector<Index32>, Index> first;
    for (Index e = 0; e < file_.nodes.size(); ++e) {
      if (several[file_.group[e]] == 0) continue;
      auto const nodes = file_.nodes[e];
      std::vector<Index32> key(nodes.begin(), nodes.end());
      std::sort(key.begin(), key.end());
      auto const [at, is_new] = first.try_emplace(std::move(key), e);
      if (is_new) continue;
      repeated_.push_back(e);
      auto& groups = further_.try_emplace(at->second, group_of(at->second).physical).first->second;
      groups.insert(groups.end(), group_of(e).physical.begin(), group_of(e).physical.end());
      std::sort(groups.begin(), groups.end());
      groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    }
  }

  [[nodiscard]] bool is_repeated(Index e) const { return std::binary_search(repeated_.begin(), repeated_.end(), e); }

  void elements() {
    auto const& tags = file_.number;
    bool const numbered = std::all_of(
        tags.begin(), tags.end(), [](std::int64_t t) { return t >= 0 && t <= std::numeric_limits<Index32>::max(); });
    std::vector<Index32> row;
    for (Index e = 0; e < file_.nodes.size(); ++e) {
      if (group_of(e).dimension != mesh_.dimension || is_repeated(e)) continue;
      auto const shape = io::gmsh_shape(file_.type[e]);
      auto const nodes = file_.nodes[e];
      row.clear();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        row.push_back(number_[nodes[shape.order.empty() ? k : shape.order[k]]]);
      mesh_.add_element(shape.type, row);
      if (numbered) mesh_.elements.number.push_back(Index32(tags[e]));
    }
  }

  [[nodiscard]] std::string name_of(int dimension, std::int64_t physical) const {
    auto const found = file_.names.find({dimension, physical});
    if (found != file_.names.end() && !found->second.empty()) return found->second;
    return std::string("physical ") + (dimension == 2 ? "surface " : "curve ") + std::to_string(physical);
  }

  void patches() {
    int const dimension = mesh_.dimension - 1;
    std::map<std::pair<std::vector<std::int64_t>, std::int64_t>, std::size_t> known;
    std::vector<Index32> face;
    for (Index e = 0; e < file_.nodes.size(); ++e) {
      auto const& group = group_of(e);
      if (group.dimension != dimension || group.between_parts || is_repeated(e)) continue;
      face.clear();
      auto const corners = file_.nodes[e].first(std::size_t(io::gmsh_shape(file_.type[e]).corners));
      for (Index32 const n : corners) face.push_back(number_[n]);
      if (std::find(face.begin(), face.end(), -1) != face.end()) {
        ++loose_;
        continue;
      }
      auto const merged = further_.find(e);
      auto const& physical = merged == further_.end() ? group.physical : merged->second;
      auto const [at, is_new] =
          known.try_emplace({physical, physical.empty() ? group.entity : 0}, mesh_.patches.size());
      if (is_new) add_patch(dimension, physical, group.entity);
      mesh_.patches[at->second].faces.add(face);
    }
  }

  void add_patch(int dimension, std::vector<std::int64_t> const& physical, std::int64_t entity) {
    Patch patch;
    patch.zone = 0;
    if (physical.empty()) patch.name = (dimension == 2 ? "surface " : "curve ") + std::to_string(entity);
    for (std::int64_t const p : physical) {
      if (physical.size() > 1) patch.families.push_back(name_of(dimension, p));
      patch.name += (patch.name.empty() ? "" : " + ") + name_of(dimension, p);
    }
    patch.kind = io::kind_by_name(patch.name);
    by_name_ = by_name_ || patch.kind != PatchKind::other;
    mesh_.patches.push_back(std::move(patch));
  }

  void connections() {
    double const allowed = periodic_tolerance * mesh_.size();
    for (auto const& link : file_.periodic) {
      if (link.dimension != mesh_.dimension - 1) continue;
      Connection c;
      c.name = (link.dimension == 2 ? "surface " : "curve ") + std::to_string(link.entity) + " periodic to " +
               std::to_string(link.master);
      c.zone = c.donor_zone = 0;
      std::vector<Vec3> from, to;
      for (auto const& [image, master] : link.nodes) {
        Index32 const own = number_[image], donor = number_[master];
        if (own < 0 || donor < 0 || own == donor) continue;
        c.nodes.push_back(own);
        c.donor_nodes.push_back(donor);
        from.push_back(mesh_.coordinates[own]);
        to.push_back(mesh_.coordinates[donor]);
      }
      if (c.nodes.empty()) continue;
      c.periodic = given(link, allowed);
      if (c.periodic && farthest(*c.periodic, from, to) > allowed) c.periodic.reset();
      if (!c.periodic) c.periodic = io::periodic_between(from, to, allowed, mesh_.dimension == 2);
      if (!c.periodic) {
        mesh_.notes.push_back(path_ + ": " + c.name + ": neither a translation nor a rotation takes its " +
                              std::to_string(from.size()) +
                              " nodes onto one another; they move apart from one another");
        continue;
      }
      mesh_.connections.push_back(std::move(c));
    }
  }

  static double farthest(Periodic const& p, std::vector<Vec3> const& from, std::vector<Vec3> const& to) {
    double out = 0;
    for (std::size_t n = 0; n < from.size(); ++n) out = std::max(out, distance(p.declared(from[n]), to[n]));
    return out;
  }

  /// The file's transform, which takes masters onto their images, the other way round.
  static std::optional<Periodic> given(PeriodicLink const& link, double allowed) {
    if (!link.affine) return std::nullopt;
    auto const& a = *link.affine;
    RigidTransform t;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) t.rotation.m[i][j] = a[4 * i + j];
    t.translation = {a[3], a[7], a[11]};
    constexpr double round_off = 1e-6;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double product = 0;
        for (int k = 0; k < 3; ++k) product += t.rotation.m[i][k] * t.rotation.m[j][k];
        if (!(std::fabs(product - (i == j ? 1 : 0)) < round_off)) return std::nullopt;
      }
    return io::periodic_of(t.inverse(), allowed);
  }

  [[nodiscard]] bool is_a_shell() const {
    MeshExtent const box = extent_of(mesh_.coordinates);
    Vec3 const size = box.high - box.low;
    return mesh_.dimension == 2 && std::min({size.x, size.y, size.z}) > periodic_tolerance * mesh_.size();
  }

  void notes() {
    auto const add = [&](std::string const& text) { mesh_.notes.push_back(path_ + ": " + text); };
    if (by_name_) add("Gmsh files do not say what a patch is; kinds are taken from the names");
    bool in_order = true;
    Index kept = 0;
    for (std::size_t n = 0; n < number_.size(); ++n)
      if (number_[n] >= 0) in_order = in_order && file_.tag[n] == ++kept;
    if (!in_order) add("nodes are not numbered 1, 2, 3, ...; messages count them in the order of the file");
    if (auto const unused = Index(file_.tag.size()) - mesh_.n_nodes(); unused > 0)
      add(std::to_string(unused) + " nodes belong to no element of the mesh and stay where they are");
    if (ungrouped_ > 0)
      add(std::to_string(ungrouped_) +
          " faces of its boundary are in no physical group, so Gmsh did not save them; they are the patch 'boundary'");
    if (is_a_shell())
      add("has surfaces that are not plane and no volumes: Gmsh saves what is in a physical group alone. Give the "
          "volumes one (Physical Volume), or save all: gmsh -save_all");
    if (loose_ > 0) add(std::to_string(loose_) + " elements of its boundary are not at the mesh; left alone");
    if (file_.parametric) add("parameters of nodes on the geometry are left as they are");
    for (auto const& name : file_.passed_over) add(name + " plays no part in morphing; left alone");
  }

  std::string const& path_;
  File const& file_;
  Mesh mesh_;
  std::vector<Index32> number_;
  std::vector<Index> repeated_;
  std::map<Index, std::vector<std::int64_t>> further_;  ///< physical groups of elements that are there several times
  Index loose_ = 0, ungrouped_ = 0;
  bool by_name_ = false;
};

}  // namespace

bool is_gmsh(std::string_view head) {
  auto const begin = head.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  head.remove_prefix(begin);
  return head.starts_with("$MeshFormat") || head.starts_with("$NOD") || head.starts_with("$Comments");
}

Mesh read(std::string const& path) {
  Text text(path);
  return Builder(path, parse(text)).run();
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  Text text(input);
  File const file = parse(text);
  Index n_nodes = 0;
  int const dimension = dimension_of(file);
  auto const number = mesh_nodes(file, dimension, n_nodes);
  if (n_nodes != mesh.n_nodes() || dimension != mesh.dimension)
    throw IoError(input + ": holds another mesh than the one that was read; give the file of that one");
  io::ReplacedText out(text.bytes());
  auto const& format = text.format();
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    Vec3 const to = morphed[number[n]];
    std::size_t at = file.at[n];
    for (int c = 0; c < 3; ++c) {
      double const value = c == 0 ? to.x : c == 1 ? to.y : to.z;
      if (format.binary) {
        out.replace_raw(at, value, format.swapped);
        at += sizeof value;
      } else {
        at = out.replace_word(at, file.coordinates[3 * n + std::size_t(c)], value);
      }
    }
  }
  io::OutputFile target(output);
  target.write(out.take());
  target.commit();
}

}  // namespace gridmorph::gmsh
