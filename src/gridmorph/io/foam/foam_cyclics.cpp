#include <gridmorph/io/foam/foam_cyclics.hpp>
#include <gridmorph/io/periodic_transform.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace gridmorph::foam {

namespace {

/// The distance between nodes that match, as a share of the mesh size: points of meshes in text have six digits and
/// more.
constexpr double tolerance = 1e-5;

using Pairs = std::vector<std::array<Index32, 2>>;

class Matcher {
 public:
  Matcher(BoundaryEntry const& own, BoundaryEntry const& other, CsrGraph const& faces, Mesh const& mesh)
      : own_(own), other_(other), faces_(faces), x_(mesh.coordinates), allowed_(tolerance * mesh.size()) {}

  /// Pairs of nodes and their transform; nothing where the sides do not fit.
  std::optional<std::pair<Pairs, Periodic>> run() const {
    if (own_.size != other_.size) return std::nullopt;
    for (Index k = 0; k < own_.size; ++k)
      if (own(k).size() != other(k).size()) return std::nullopt;
    // First nodes of two faces belong together; then they go around in opposite senses.
    Pairs pairs = paired([](Index) { return std::size_t(0); });
    auto transform = io::periodic_between(places(pairs, 0), places(pairs, 1), allowed_);
    if (!transform) {
      auto const coarse = io::periodic_between(middles(own_), middles(other_), allowed_);
      if (!coarse) return std::nullopt;
      pairs = paired([&](Index k) { return nearest(other(k), coarse->declared(x_[own(k)[0]])); });
      transform = io::periodic_between(places(pairs, 0), places(pairs, 1), allowed_);
      if (!transform) return std::nullopt;
    }
    return std::pair(std::move(pairs), *transform);
  }

 private:
  [[nodiscard]] std::span<Index32 const> own(Index k) const { return faces_[own_.start + k]; }
  [[nodiscard]] std::span<Index32 const> other(Index k) const { return faces_[other_.start + k]; }

  /// `first`: which node of the other side's face k belongs to the first of the own one.
  template <class First>
  [[nodiscard]] Pairs paired(First const& first) const {
    Pairs out;
    for (Index k = 0; k < own_.size; ++k) {
      auto const a = own(k), b = other(k);
      std::size_t const n = a.size(), start = first(k);
      for (std::size_t v = 0; v < n; ++v) out.push_back({a[v], b[(start + n - v) % n]});
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  [[nodiscard]] std::vector<Vec3> places(Pairs const& pairs, int side) const {
    std::vector<Vec3> out;
    for (auto const& p : pairs) out.push_back(x_[p[side]]);
    return out;
  }

  [[nodiscard]] std::vector<Vec3> middles(BoundaryEntry const& side) const {
    std::vector<Vec3> out;
    for (Index k = 0; k < side.size; ++k) {
      Vec3 sum;
      for (Index32 const v : faces_[side.start + k]) sum += x_[v];
      out.push_back((1 / double(faces_[side.start + k].size())) * sum);
    }
    return out;
  }

  [[nodiscard]] std::size_t nearest(std::span<Index32 const> face, Vec3 const& place) const {
    auto const at = std::min_element(face.begin(), face.end(), [&](Index32 a, Index32 b) {
      return distance(x_[a], place) < distance(x_[b], place);
    });
    return std::size_t(at - face.begin());
  }

  BoundaryEntry const &own_, &other_;
  CsrGraph const& faces_;
  Coordinates const& x_;
  double allowed_;
};

void add_patch(BoundaryEntry const& side, CsrGraph const& faces, Mesh& mesh) {
  Patch patch;
  patch.name = side.name;
  patch.bc_type = "cyclic";
  patch.kind = PatchKind::connection;
  patch.zone = 0;
  for (Index f = side.start; f < side.start + side.size; ++f) patch.faces.add(faces[f]);
  mesh.patches.push_back(std::move(patch));
}

}  // namespace

void add_cyclics(std::vector<BoundaryEntry const*> const& sides, CsrGraph const& faces, Mesh& mesh) {
  std::map<std::string, BoundaryEntry const*, std::less<>> by_name;
  for (BoundaryEntry const* side : sides) by_name[side->name] = side;
  for (BoundaryEntry const* each : sides) {
    BoundaryEntry const& side = *each;
    auto const other = by_name.find(side["neighbourPatch"]);
    if (other == by_name.end() || other->second == &side) {
      mesh.notes.push_back("cyclic patch '" + side.name + "' has no neighbourPatch; taken as a plain patch");
      add_patch(side, faces, mesh);
      continue;
    }
    if (other->second < &side) continue;  // with the other side
    auto const match = Matcher(side, *other->second, faces, mesh).run();
    if (!match) {
      mesh.notes.push_back("cyclic patches '" + side.name + "' and '" + other->first +
                           "' do not match node by node; they move apart from one another");
      add_patch(side, faces, mesh);
      add_patch(*other->second, faces, mesh);
      continue;
    }
    Connection connection;
    connection.name = side.name;
    connection.zone = connection.donor_zone = 0;
    connection.periodic = match->second;
    for (auto const& [own, donor] : match->first) {
      connection.nodes.push_back(own);
      connection.donor_nodes.push_back(donor);
    }
    mesh.connections.push_back(std::move(connection));
  }
}

namespace {

/// The vector in a text such as "(0 0 1)"; nothing where there are no three numbers.
std::optional<Vec3> vector_of(std::string_view text) {
  std::string numbers(text);
  std::replace_if(
      numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')'; }, ' ');
  std::istringstream in(numbers);
  Vec3 v;
  if (in >> v.x >> v.y >> v.z && std::isfinite(norm(v))) return v;
  return std::nullopt;
}

std::vector<Index32> nodes_of(BoundaryEntry const& side, CsrGraph const& faces) {
  std::vector<Index32> out;
  for (Index k = 0; k < side.size; ++k) {
    auto const face = faces[side.start + k];
    out.insert(out.end(), face.begin(), face.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Vec3> places_of(std::vector<Index32> const& nodes, Coordinates const& x) {
  std::vector<Vec3> out;
  for (Index32 const n : nodes) out.push_back(x[n]);
  return out;
}

Vec3 mean_of(std::vector<Vec3> const& places) {
  Vec3 sum;
  for (Vec3 const& p : places) sum += p;
  return (1 / double(places.size())) * sum;
}

/// The transforms that may take one middle to the other.
std::vector<Periodic> ways_between(BoundaryEntry const& side, Vec3 const& from, Vec3 const& to) {
  std::vector<Periodic> out{periodic_translation(to - from)};
  auto const axis = vector_of(side["rotationAxis"]), centre = vector_of(side["rotationCentre"]);
  if (!axis || !(norm(*axis) > 0)) return out;
  Vec3 const origin = centre.value_or(Vec3{}), direction = (1 / norm(*axis)) * *axis;
  auto const across = [&](Vec3 const& p) { return (p - origin) - dot(p - origin, direction) * direction; };
  Vec3 const a = across(from), b = across(to);
  double const angle = std::atan2(dot(direction, cross(a, b)), dot(a, b));
  if (angle != 0) out.push_back(periodic_rotation(origin, direction, angle));
  return out;
}

/// The nodes that those of one side are mapped to, each once, and how; nothing where they do not match.
std::optional<std::pair<std::vector<Index32>, Periodic>> match(std::vector<Index32> const& own,
                                                               std::vector<Index32> const& donors,
                                                               std::vector<Periodic> const& ways, Coordinates const& x,
                                                               double allowed) {
  if (own.size() != donors.size()) return std::nullopt;
  for (Periodic const& way : ways) {
    std::vector<Index32> list = match_points(x, own, donors, allowed, way);
    auto const each = std::set<Index32>(list.begin(), list.end());
    if (each.size() != list.size() || each.contains(-1)) continue;
    if (auto const transform = io::periodic_between(places_of(own, x), places_of(list, x), allowed))
      return std::pair(std::move(list), *transform);
  }
  return std::nullopt;
}

}  // namespace

std::vector<Connection> matching_sides(std::vector<BoundaryEntry const*> const& sides, CsrGraph const& faces,
                                       Mesh& mesh) {
  std::vector<Connection> out;
  double const allowed = tolerance * mesh.size();
  std::map<std::string, BoundaryEntry const*, std::less<>> by_name;
  for (BoundaryEntry const* side : sides) by_name[side->name] = side;
  for (BoundaryEntry const* side : sides) {
    auto const other = by_name.find((*side)["neighbourPatch"]);
    if (other == by_name.end() || other->second <= side) continue;  // with the other side
    std::vector<Index32> const own = nodes_of(*side, faces), donors = nodes_of(*other->second, faces);
    Vec3 const from = mean_of(places_of(own, mesh.coordinates)), to = mean_of(places_of(donors, mesh.coordinates));
    auto const paired = match(own, donors, ways_between(*side, from, to), mesh.coordinates, allowed);
    if (!paired) {
      if (distance(from, to) > 0.01 * mesh.size())
        mesh.notes.push_back("cyclicAMI patches '" + side->name + "' and '" + other->first +
                             "' do not match node by node; they move apart from one another");
      continue;
    }
    if (distance(from, to) <= allowed && norm(paired->second.rotation_angle_rad) == 0) continue;
    Connection there;
    there.name = side->name;
    there.zone = there.donor_zone = 0;
    there.nodes = own;
    there.donor_nodes = paired->first;
    there.periodic = paired->second;
    Connection back = there;
    back.name = other->first;
    std::swap(back.nodes, back.donor_nodes);
    back.periodic = io::periodic_between(places_of(back.nodes, mesh.coordinates),
                                         places_of(back.donor_nodes, mesh.coordinates), allowed);
    if (!back.periodic) continue;
    out.push_back(std::move(there));
    out.push_back(std::move(back));
  }
  return out;
}

}  // namespace gridmorph::foam
