#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

constexpr double smooth = 0.866;  // cosine of 30 degrees
constexpr double limit = 1e-6;    // of the mesh size

/// Two nodes of an edge by their numbers as coincident points, and the normal of the cell that ends there, into the
/// mesh.
struct Edge {
  std::pair<Index, Index> nodes;
  std::size_t patch;
  Vec3 normal;
};

using Groups = DisjointSets<std::size_t>;

class Namer {
 public:
  Namer(Mesh const& mesh, std::size_t first)
      : mesh_(mesh), first_(first), n_(mesh.patches.size() - first), number_(coincident_block_nodes(mesh)) {
    for (Index n = 0; n < mesh.n_nodes(); ++n) whole_.include(mesh.coordinates[n]);
    size_ = distance(whole_.low, whole_.high);
  }

  std::vector<std::string> run() {
    std::vector<Edge> edges;
    for (std::size_t p = 0; p < n_; ++p) outline(p, edges);
    std::sort(edges.begin(), edges.end(),
              [](Edge const& a, Edge const& b) { return std::pair(a.nodes, a.patch) < std::pair(b.nodes, b.patch); });
    Groups smoothly(n_);
    each_meeting(edges, [&](Edge const& a, Edge const& b) {
      if (dot(a.normal, b.normal) > smooth && !is_pole(a.patch) && !is_pole(b.patch)) smoothly.join(a.patch, b.patch);
    });
    std::vector<Box> box(n_);
    for (std::size_t p = 0; p < n_; ++p)
      each_node(p, [&](Index n) { box[smoothly.root(p)].include(mesh_.coordinates[n]); });

    std::vector<std::string> plane(n_);
    std::vector<char> inside(n_, 0);
    for (std::size_t p = 0; p < n_; ++p) {
      std::size_t const g = smoothly.root(p);
      plane[p] = plane_at_limit(box[g]);
      inside[p] = plane[p].empty() && directions_inside(box[g]) >= (mesh_.dimension == 2 ? 1 : 2) ? 1 : 0;
    }
    Groups bodies(n_);
    for (std::size_t p = 0; p < n_; ++p) bodies.join(p, smoothly.root(p));
    each_meeting(edges, [&](Edge const& a, Edge const& b) {
      if (inside[a.patch] && inside[b.patch] && !is_pole(a.patch) && !is_pole(b.patch)) bodies.join(a.patch, b.patch);
    });
    return names(plane, inside, bodies);
  }

 private:
  [[nodiscard]] Patch const& patch(std::size_t p) const { return mesh_.patches[first_ + p]; }
  [[nodiscard]] bool is_pole(std::size_t p) const { return patch(p).kind == PatchKind::degenerate; }

  template <class Visit>
  void each_node(std::size_t p, Visit visit) const {
    IndexRange const& r = patch(p).range;
    Zone const& zone = mesh_.zones[patch(p).zone];
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) visit(zone.node({i, j, k}));
  }

  /// The edges around a rectangle, each with the normal of its cell.
  void outline(std::size_t p, std::vector<Edge>& edges) const {
    IndexRange const& r = patch(p).range;
    Zone const& zone = mesh_.zones[patch(p).zone];
    int normal = 0;
    while (normal < 2 && r.extent(normal) != 1) ++normal;
    int const u = normal == 0 ? 1 : 0, v = normal == 2 ? 1 : 2;
    int const inward = r.begin[normal] == 0 ? 1 : -1;
    auto const node = [&](int a, int b, int off) {
      Index3 at{};
      at[normal] = r.begin[normal] + off;
      at[u] = r.begin[u] + a;
      at[v] = r.begin[v] + b;
      return zone.node(at);
    };
    auto const x = [&](Index n) { return mesh_.coordinates[n]; };
    auto const cell_normal = [&](int a, int b) {
      Vec3 out = cross(x(node(a + 1, b + 1, 0)) - x(node(a, b, 0)), x(node(a, b + 1, 0)) - x(node(a + 1, b, 0)));
      Vec3 const in =
          x(node(a, b, inward)) - x(node(a, b, 0)) + x(node(a + 1, b + 1, inward)) - x(node(a + 1, b + 1, 0));
      double const length = norm(out);
      return length > 0 ? (dot(out, in) < 0 ? -1 / length : 1 / length) * out : Vec3{};
    };
    auto const add = [&](Index m, Index n, Vec3 const& across) {
      Index const a = number_[m], b = number_[n];
      if (a != b && distance(x(m), x(n)) > 0) edges.push_back({{std::min(a, b), std::max(a, b)}, p, across});
    };
    int const nu = r.extent(u) - 1, nv = r.extent(v) - 1;
    for (int a = 0; a < nu; ++a) {
      add(node(a, 0, 0), node(a + 1, 0, 0), cell_normal(a, 0));
      add(node(a, nv, 0), node(a + 1, nv, 0), cell_normal(a, nv - 1));
    }
    for (int b = 0; b < nv; ++b) {
      add(node(0, b, 0), node(0, b + 1, 0), cell_normal(0, b));
      add(node(nu, b, 0), node(nu, b + 1, 0), cell_normal(nu - 1, b));
    }
  }

  template <class Visit>
  static void each_meeting(std::vector<Edge> const& edges, Visit visit) {
    for (std::size_t e = 1; e < edges.size(); ++e)
      for (std::size_t before = e; before-- > 0 && edges[before].nodes == edges[e].nodes;)
        visit(edges[before], edges[e]);
  }

  [[nodiscard]] std::string plane_at_limit(Box const& box) const {
    double const off = limit * size_;
    auto const at = [&](double low, double high, double whole_low, double whole_high, char const* name) {
      if (high - low > off) return std::string();
      return std::fabs(low - whole_low) <= off     ? std::string(name) + "_min"
             : std::fabs(high - whole_high) <= off ? std::string(name) + "_max"
                                                   : std::string();
    };
    for (auto const& name : {at(box.low.x, box.high.x, whole_.low.x, whole_.high.x, "x"),
                             at(box.low.y, box.high.y, whole_.low.y, whole_.high.y, "y"),
                             at(box.low.z, box.high.z, whole_.low.z, whole_.high.z, "z")})
      if (!name.empty()) return name;
    return "";
  }

  [[nodiscard]] int directions_inside(Box const& box) const {
    double const off = limit * size_;
    auto const inside = [&](double low, double high, double whole_low, double whole_high) {
      return low > whole_low + off && high < whole_high - off ? 1 : 0;
    };
    return inside(box.low.x, box.high.x, whole_.low.x, whole_.high.x) +
           inside(box.low.y, box.high.y, whole_.low.y, whole_.high.y) +
           inside(box.low.z, box.high.z, whole_.low.z, whole_.high.z);
  }

  [[nodiscard]] std::vector<std::string> names(std::vector<std::string> const& plane, std::vector<char> const& inside,
                                               Groups& bodies) const {
    std::array<std::map<std::size_t, int>, 2> number;  // of surfaces and bodies, in the order of their first patch
    for (std::size_t p = 0; p < n_; ++p)
      if (plane[p].empty() && !is_pole(p)) {
        auto& of_kind = number[inside[p]];
        of_kind.try_emplace(bodies.root(p), int(of_kind.size()) + 1);
      }
    std::vector<std::string> out;
    for (std::size_t p = 0; p < n_; ++p) {
      auto const& of_kind = number[inside[p]];
      std::string const word = inside[p] ? "body" : "surface";
      if (is_pole(p))
        out.emplace_back("pole");
      else if (!plane[p].empty())
        out.push_back(plane[p]);
      else
        out.push_back(of_kind.size() == 1 ? word : word + " " + std::to_string(of_kind.at(bodies.root(p))));
    }
    return out;
  }

  Mesh const& mesh_;
  std::size_t first_, n_;
  std::vector<Index> number_;  ///< coincident_block_nodes()
  Box whole_;
  double size_ = 0;
};

/// A name for each of the patches `first`, `first` + 1, ... of a mesh, which are rectangles of zone faces:
/// - a plane on a limit of the mesh is "x_min" ... "z_max";
/// - what keeps off the limits in two directions or more (one in a 2-D mesh), with all that joins it at whatever angle,
/// is "body", or
///   "body 1", "body 2", ... by the zones they begin in: six faces round a box are one body;
/// - the rest is joined where it goes on smoothly (30 degrees) and called "surface", or "surface 1", ...;
/// - poles keep the name "pole".
/// Cost: O(nodes + patch nodes log patch nodes).
std::vector<std::string> names_of_open_patches(Mesh const& mesh, std::size_t first) {
  return first < mesh.patches.size() ? Namer(mesh, first).run() : std::vector<std::string>{};
}

std::string quoted(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04X}", int(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out + "\"";
}

std::string vector_text(Vec3 const& v) { return fmt::format("[{}, {}, {}]", v.x + 0.0, v.y + 0.0, v.z + 0.0); }

std::string range_text(IndexRange const& r) {
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", r.begin[0] + 1, r.begin[1] + 1, r.begin[2] + 1, r.end[0], r.end[1],
                     r.end[2]);
}

/// From the node that goes with the first of the own range to the one that goes with the last.
std::string donor_range_text(Interface1to1 const& face) {
  Index3 const a = face.to_donor(face.range.begin);
  Index3 const b = face.to_donor(Index3{face.range.end[0] - 1, face.range.end[1] - 1, face.range.end[2] - 1});
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", a[0] + 1, a[1] + 1, a[2] + 1, b[0] + 1, b[1] + 1, b[2] + 1);
}

std::string transform_text(Orientation const& o) {
  return fmt::format("[{}, {}, {}]", o.sign[0] * (o.axis[0] + 1), o.sign[1] * (o.axis[1] + 1),
                     o.sign[2] * (o.axis[2] + 1));
}

bool same(Periodic const& a, Periodic const& b) {
  return a.rotation_angle_rad == b.rotation_angle_rad && a.rotation_center == b.rotation_center &&
         a.translation == b.translation && a.declared.translation == b.declared.translation;
}

/// Axis and angle of a declared rotation, whatever the axis.
std::string periodic_text(Periodic const& p, std::string const& name) {
  std::string out = fmt::format("\n[[periodic]]\nname = {}\n", quoted(name));
  auto const turn = as_turn(p.declared, std::numeric_limits<double>::infinity());
  if (!turn) return out + "translation = " + vector_text(p.translation) + "\n";
  double angle = turn->angle_rad;
  Vec3 direction = turn->direction;
  // About x, y or z the angles say it without the round-off of the matrix.
  Vec3 const w = p.rotation_angle_rad;
  if (double const plain = norm(w); std::fabs(plain - angle) < 1e-9) {
    angle = plain;
    direction = (1 / plain) * w;
  }
  return out + fmt::format("axis = {{ origin = {}, direction = {} }}\nangle_deg = {}\n", vector_text(p.rotation_center),
                           vector_text(direction), angle * 180 / std::numbers::pi);
}

}  // namespace

std::string side_file_text(Mesh const& mesh, FoundInterfaces const& found, std::string const& existing) {
  std::string text = existing;
  if (existing.empty()) {
    text =
        fmt::format("# Patches and interfaces of {}. Nodes are counted from 1; docs/formats.md describes the keys.\n",
                    std::filesystem::path(mesh.source).filename().string());
    if (!mesh.file_variant.empty()) text += fmt::format("format = {}\n", quoted(mesh.file_variant));
  } else if (text.back() != '\n') {
    text += '\n';
  }
  for (auto const& note : found.notes) text += "# " + note + "\n";

  std::vector<Periodic> periodics;
  auto const number_of = [&](Periodic const& p) {
    for (std::size_t n = 0; n < periodics.size(); ++n)
      if (same(periodics[n], p)) return n + 1;
    periodics.push_back(p);
    text += periodic_text(p, fmt::format("found {}", periodics.size()));
    return periodics.size();
  };
  Mesh rest = mesh;  // shares the coordinates
  auto const zone = [&](int z) {
    return mesh.file_variant.empty() ? quoted(mesh.zones[z].name) : std::to_string(z + 1);
  };
  for (auto const& face : found.interfaces) {
    std::string const periodic =
        face.periodic ? fmt::format("periodic = \"found {}\"\n", number_of(*face.periodic)) : std::string();
    text += fmt::format(
        "\n[[interface]]\nname = {}\nzone = {}\nrange = {}\ndonor_zone = {}\ndonor_range = {}\ntransform = {}\n{}",
        quoted(face.name), zone(face.zone), range_text(face.range), zone(face.donor_zone), donor_range_text(face),
        transform_text(face.to_donor.orientation), periodic);
    rest.interfaces.push_back(face);
  }

  TopologyOptions everything;
  everything.open_faces = "open";
  everything.matching_tolerance = mesh.size();  // what was found is good enough to say what is left
  Problems ignored;
  std::size_t const before = rest.patches.size();
  complete_patches(rest, connect(rest, everything, ignored), everything);
  if (rest.patches.size() > before)
    text +=
        "\n# What is left is the boundary: give each patch its name, family and kind (wall, inflow, outflow, "
        "symmetry,\n"
        "# farfield, other).\n";
  auto const names = names_of_open_patches(rest, before);
  for (std::size_t p = before; p < rest.patches.size(); ++p) {
    Patch const& patch = rest.patches[p];
    text += fmt::format("\n[[patch]]\nname = {}\nkind = \"{}\"\nzone = {}\nrange = {}\n", quoted(names[p - before]),
                        to_string(patch.kind), zone(patch.zone), range_text(patch.range));
  }
  return text;
}

}  // namespace gridmorph
