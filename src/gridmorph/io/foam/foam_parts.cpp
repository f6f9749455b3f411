#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/foam/foam_parts.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

namespace gridmorph::foam {

namespace {

constexpr double coincident = 1e-6;  // of the mesh size

bool is_shared(BoundaryEntry const& entry) { return entry["type"] == "processor"; }
bool is_shared_cyclic(BoundaryEntry const& entry) { return entry["type"] == "processorCyclic"; }

/// What a part knows of the mesh that it was cut from: labels of points and cells from 0 on, of faces from 1 on,
/// negative where they are the other way round.
struct Addressing {
  std::vector<Index32> points, cells, faces;
};

std::optional<Addressing> addressing_of(Part const& part, Lists const& lists) {
  auto const labels = [&](char const* name, std::size_t n, std::int64_t least) -> std::optional<std::vector<Index32>> {
    std::string const path = (part.folders.mesh / name).string();
    if (!is_there(path)) return std::nullopt;
    auto out = FoamFile(path, {"labelList"}).labels(Index(n), least);
    return out.size() == n ? std::optional(std::move(out)) : std::nullopt;
  };
  auto points = labels("pointProcAddressing", std::size_t(lists.points.size()), 0);
  auto cells = labels("cellProcAddressing", std::size_t(lists.n_cells()), 0);
  auto faces = labels("faceProcAddressing", std::size_t(lists.faces.size()), std::numeric_limits<Index32>::min() + 1);
  if (!points || !cells || !faces) return std::nullopt;
  return Addressing{std::move(*points), std::move(*cells), std::move(*faces)};
}

/// Nodes of the one side of a face in the order of the other side's, which goes around the other way from the same
/// node.
std::vector<Index32> reversed(std::span<Index32 const> nodes, std::size_t start) {
  std::vector<Index32> out;
  for (std::size_t v = 0; v < nodes.size(); ++v) out.push_back(nodes[(start + nodes.size() - v) % nodes.size()]);
  return out;
}

class Joiner {
 public:
  Joiner(std::vector<Part> const& parts, std::string const& source) : parts_(parts), source_(source) {
    kernels::Box box;
    bool all = true;
    for (Part const& part : parts) {
      lists_.push_back(read_lists(part.folders));
      Lists const& own = lists_.back();
      MeshExtent const extent = extent_of(own.points);
      if (own.points.size() > 0) {
        box.include(extent.low);
        box.include(extent.high);
      }
      first_node_.push_back(first_node_.back() + own.points.size());
      first_cell_.push_back(first_cell_.back() + own.n_cells());
      auto known = addressing_of(part, own);
      all = all && known;
      if (all) addressing_.push_back(std::move(*known));
    }
    if (!all) addressing_.clear();
    allowed_ = coincident * distance(box.low, box.high);
  }

  JoinedLists run() {
    for (std::size_t p = 0; p < parts_.size(); ++p) names_of_patches(p);
    number_nodes(numbers_of_joined_nodes());
    number_cells();
    for (std::size_t p = 0; p < parts_.size(); ++p) add_faces(p);
    take_faces();
    take_zones();
    for (Lists& own : lists_) out_.points.push_back(own.points);
    out_.lists.single_precision = lists_.front().single_precision;
    return std::move(out_);
  }

 private:
  /// A face of the joined mesh. Those inside come first, then patch by patch, those of each in the order of `turn` and
  /// of `number`.
  struct Face {
    int patch = -1;
    std::array<int, 2> turn{-1, -1};
    Index number = 0;
    Index32 owner = -1, neighbour = -1;
    bool turned = false;                ///< goes around the other way than there
    std::array<Index, 2> of{-1, -1};    ///< its part and face there
    std::array<Index, 2> also{-1, -1};  ///< the other part's
  };

  [[nodiscard]] std::string name_of(std::size_t p) const { return parts_[p].folders.mesh.string(); }

  /// Patches but for those between parts, by the first part that has them.
  void names_of_patches(std::size_t p) {
    for (BoundaryEntry const& entry : lists_[p].boundary) {
      if (is_shared(entry) || is_shared_cyclic(entry)) continue;
      if (patch_.emplace(entry.name, int(out_.lists.boundary.size())).second) {
        out_.lists.boundary.push_back(entry);
        out_.lists.boundary.back().start = out_.lists.boundary.back().size = 0;
      }
    }
  }
  [[nodiscard]] int patch_of(std::size_t p, BoundaryEntry const& entry, std::string_view name) const {
    auto const found = patch_.find(name);
    if (found == patch_.end())
      throw MeshError(name_of(p) + ": patch '" + entry.name + "' refers to patch '" + std::string(name) +
                      "', which there is not; decompose the mesh again (decomposePar)");
    return found->second;
  }

  /// The part that a patch leads to, and its patch that leads back.
  std::pair<std::size_t, BoundaryEntry const*> other_side(std::size_t p, BoundaryEntry const& entry) const {
    std::string const leads_to(entry["neighbProcNo"]);
    int number = -1;
    std::from_chars(leads_to.data(), leads_to.data() + leads_to.size(), number);
    auto const q = std::find_if(parts_.begin(), parts_.end(), [&](Part const& part) { return part.number == number; });
    if (number < 0 || q == parts_.end())
      throw MeshError(source_ + ": patch '" + entry.name + "' of processor" + std::to_string(parts_[p].number) +
                      " leads to processor" + (leads_to.empty() ? "?" : leads_to) +
                      ", and there is no mesh of that one; bring all parts of the decomposed mesh, or put it together "
                      "(reconstructParMesh)");
    auto const at = std::size_t(q - parts_.begin());
    for (BoundaryEntry const& back : lists_[at].boundary)
      if (back["type"] == entry["type"] && back["neighbProcNo"] == std::to_string(parts_[p].number) &&
          (is_shared(entry) || back["referPatch"] == neighbour_patch(p, entry)) && back.size == entry.size)
        return {at, &back};
    throw MeshError(source_ + ": patch '" + entry.name + "' of processor" + std::to_string(parts_[p].number) + " has " +
                    std::to_string(entry.size) + " faces, and no patch of processor" + std::to_string(number) +
                    " has as many that lead back; decompose the mesh again (decomposePar)");
  }
  /// The neighbour patch of the cyclic patch that a patch between parts refers to.
  [[nodiscard]] std::string_view neighbour_patch(std::size_t p, BoundaryEntry const& entry) const {
    return out_.lists.boundary[patch_of(p, entry, entry["referPatch"])]["neighbourPatch"];
  }

  /// Calls body(patch, face, the other part, its face) for each face that part p shares with a later one, so once for
  /// each pair of parts.
  template <class Body>
  void each_shared_face(std::size_t p, Body const& body) const {
    for (BoundaryEntry const& entry : lists_[p].boundary) {
      if (!is_shared(entry) || entry.size == 0) continue;
      auto const [q, back] = other_side(p, entry);
      if (q <= p) continue;
      for (Index k = 0; k < entry.size; ++k) body(entry, entry.start + k, q, back->start + k);
    }
  }

  /// The number of the node of the other part's face that is the first of the own one.
  [[nodiscard]] std::size_t start_of(BoundaryEntry const& entry, std::size_t p, Index f, std::size_t q, Index g) const {
    auto const own = lists_[p].faces[f], other = lists_[q].faces[g];
    auto const far = [&](std::size_t start) {
      double most = 0;
      auto const there = reversed(other, start);
      for (std::size_t v = 0; v < own.size(); ++v)
        most = std::max(most, distance(lists_[p].points[own[v]], lists_[q].points[there[v]]));
      return most;
    };
    if (own.size() == other.size())
      for (std::size_t start = 0; start < other.size(); ++start)
        if (far(start) <= allowed_) return start;
    throw MeshError(source_ + ": face " + std::to_string(f - entry.start) + " of patch '" + entry.name +
                    "' of processor" + std::to_string(parts_[p].number) + ", at " +
                    to_text(lists_[p].points[own[0]], 6) + ", is not where that of processor" +
                    std::to_string(parts_[q].number) + " is (" +
                    (own.size() == other.size() ? to_text(far(0), 3) + " apart" : "it has other nodes") +
                    "); morph all parts of one mesh together, or decompose it again (decomposePar)");
  }

  /// The numbers of the nodes of all parts, one after another: nodes at the same place have one number.
  [[nodiscard]] std::vector<Index> numbers_of_joined_nodes() const {
    DisjointSets<Index> same(std::size_t(first_node_.back()));
    for (std::size_t p = 0; p < parts_.size(); ++p)
      each_shared_face(p, [&](BoundaryEntry const& entry, Index f, std::size_t q, Index g) {
        auto const own = lists_[p].faces[f];
        auto const there = reversed(lists_[q].faces[g], start_of(entry, p, f, q, g));
        for (std::size_t v = 0; v < own.size(); ++v) same.join(first_node_[p] + own[v], first_node_[q] + there[v]);
      });
    return same.set_numbers();
  }

  void number_nodes(std::vector<Index> const& number) {
    for (std::size_t p = 0; p < parts_.size(); ++p)
      out_.nodes.emplace_back(number.begin() + first_node_[p], number.begin() + first_node_[p + 1]);
    Index32 const n_nodes = number.empty() ? 0 : Index32(1 + *std::max_element(number.begin(), number.end()));
    if (!addressing_.empty() && follows_addressing(n_nodes))
      for (std::size_t p = 0; p < parts_.size(); ++p) out_.nodes[p] = addressing_[p].points;
    else
      addressing_.clear();
    out_.lists.points = Coordinates(n_nodes);
    for (std::size_t p = parts_.size(); p-- > 0;)
      for (Index n = 0; n < lists_[p].points.size(); ++n) out_.lists.points.set(out_.nodes[p][n], lists_[p].points[n]);
  }
  /// Whether what the parts know of the mesh that they were cut from names the same nodes as one, each number once, and
  /// all cells.
  [[nodiscard]] bool follows_addressing(Index32 n_nodes) const {
    std::vector<Index32> known(n_nodes, -1), joined(std::size_t(n_nodes), -1);
    std::vector<char> cells(first_cell_.back(), 0);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (std::size_t n = 0; n < addressing_[p].points.size(); ++n) {
        Index32 const to = addressing_[p].points[n], own = out_.nodes[p][n];
        if (to < 0 || to >= n_nodes) return false;
        if (std::exchange(known[own], to) >= 0 && known[own] != to) return false;
        if (Index32 const before = std::exchange(joined[to], own); before >= 0 && before != own) return false;
      }
      for (Index32 const c : addressing_[p].cells)
        if (c < 0 || c >= Index32(cells.size()) || std::exchange(cells[c], 1) != 0) return false;
      for (Index32 const f : addressing_[p].faces)
        if (f == 0) return false;
    }
    return true;
  }

  void number_cells() {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      std::vector<Index32> own(lists_[p].n_cells());
      std::iota(own.begin(), own.end(), Index32(first_cell_[p]));
      cell_.push_back(addressing_.empty() ? std::move(own) : addressing_[p].cells);
    }
  }
  [[nodiscard]] Index32 cell_of(std::size_t p, std::vector<Index32> const& list, Index f) const {
    return cell_[p][list[f]];
  }

  /// A face of a part, as the mesh that it was cut from has it, where that is known.
  [[nodiscard]] Face face_of(std::size_t p, Index f) const {
    Face out;
    out.owner = cell_of(p, lists_[p].owner, f);
    out.number = addressing_.empty() ? Index(faces_.size()) : std::abs(addressing_[p].faces[f]);
    out.of = {Index(p), f};
    return out;
  }
  [[nodiscard]] bool is_turned(std::size_t p, Index f) const {
    return !addressing_.empty() && addressing_[p].faces[f] < 0;
  }

  void add_faces(std::size_t p) {
    for (Index f = 0; f < Index(lists_[p].neighbour.size()); ++f) {
      Face face = face_of(p, f);
      face.neighbour = cell_of(p, lists_[p].neighbour, f);
      if (is_turned(p, f)) {
        face.turned = true;
        std::swap(face.owner, face.neighbour);
      }
      faces_.push_back(std::move(face));
    }
    each_shared_face(p, [&](BoundaryEntry const&, Index f, std::size_t q, Index g) {
      bool const turned = is_turned(p, f);
      Face face = turned ? face_of(q, g) : face_of(p, f);
      face.neighbour = turned ? cell_of(p, lists_[p].owner, f) : cell_of(q, lists_[q].owner, g);
      face.also = turned ? std::array{Index(p), f} : std::array{Index(q), g};
      faces_.push_back(std::move(face));
    });
    for (BoundaryEntry const& entry : lists_[p].boundary) {
      if (is_shared(entry)) continue;
      std::array<int, 2> const turn = is_shared_cyclic(entry) ? turn_of(p, entry) : std::array{-1, -1};
      int const patch = patch_of(p, entry, is_shared_cyclic(entry) ? entry["referPatch"] : entry.name);
      for (Index k = 0; k < entry.size; ++k) {
        Face face = face_of(p, entry.start + k);
        face.patch = patch;
        face.turn = turn;
        if (turn[0] >= 0) face.number = k;
        faces_.push_back(std::move(face));
      }
    }
  }
  /// The parts of a pair of cyclic faces, that of the first patch of the two first: one for both sides.
  std::array<int, 2> turn_of(std::size_t p, BoundaryEntry const& entry) const {
    if (entry.size == 0) return {-1, -1};
    int const own = parts_[p].number, other = parts_[other_side(p, entry).first].number;
    bool const is_first = patch_of(p, entry, entry["referPatch"]) < patch_of(p, entry, neighbour_patch(p, entry));
    return is_first ? std::array{own, other} : std::array{other, own};
  }

  [[nodiscard]] std::vector<Index32> nodes_of(Face const& face) const {
    auto const p = std::size_t(face.of[0]);
    auto const there = lists_[p].faces[face.of[1]];
    std::vector<Index32> out = face.turned ? reversed(there, 0) : std::vector<Index32>(there.begin(), there.end());
    for (Index32& n : out) n = out_.nodes[p][n];
    return out;
  }

  void take_faces() {
    std::stable_sort(faces_.begin(), faces_.end(), [](Face const& a, Face const& b) {
      return std::tie(a.patch, a.turn, a.number) < std::tie(b.patch, b.turn, b.number);
    });
    for (std::size_t p = 0; p < parts_.size(); ++p) face_.emplace_back(std::size_t(lists_[p].faces.size()), -1);
    Lists& to = out_.lists;
    for (Face const& face : faces_) {
      if (face.patch >= 0) {
        BoundaryEntry& entry = to.boundary[face.patch];
        if (entry.size++ == 0) entry.start = to.faces.size();
      }
      for (auto const& [p, f] : {face.of, face.also})
        if (p >= 0) face_[p][f] = Index32(to.faces.size());
      to.faces.add(nodes_of(face));
      to.owner.push_back(face.owner);
      if (face.patch < 0) to.neighbour.push_back(face.neighbour);
    }
  }

  void take_zones() {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      add_zones(lists_[p].cell_zones, cell_[p], out_.lists.cell_zones);
      add_zones(lists_[p].face_zones, face_[p], out_.lists.face_zones);
    }
  }
  static void add_zones(std::vector<ZoneEntry> const& of_part, std::vector<Index32> const& number,
                        std::vector<ZoneEntry>& to) {
    for (ZoneEntry const& zone : of_part) {
      auto at = std::find_if(to.begin(), to.end(), [&](ZoneEntry const& z) { return z.name == zone.name; });
      if (at == to.end()) at = to.insert(to.end(), {zone.name, {}});
      for (Index32 const label : zone.labels) at->labels.push_back(number[label]);
      std::sort(at->labels.begin(), at->labels.end());
      at->labels.erase(std::unique(at->labels.begin(), at->labels.end()), at->labels.end());
    }
  }

  std::vector<Part> const& parts_;
  std::string const& source_;
  std::vector<Lists> lists_;
  std::vector<Addressing> addressing_;  ///< none where a part has none
  std::vector<Index> first_node_{0}, first_cell_{0};
  double allowed_ = 0;
  std::map<std::string, int, std::less<>> patch_;
  std::vector<std::vector<Index32>> cell_, face_;  ///< of parts -> of the joined mesh
  std::vector<Face> faces_;
  JoinedLists out_;
};

}  // namespace

JoinedLists join(std::vector<Part> const& parts, std::string const& source) { return Joiner(parts, source).run(); }

Coordinates points_of_part(JoinedLists const& joined, std::size_t part, Coordinates const& morphed) {
  Coordinates const& own = joined.points[part];
  Coordinates out(own.size());
  for (Index n = 0; n < own.size(); ++n) {
    Index const node = joined.nodes[part][n];
    Vec3 const at = own[n], from = joined.lists.points[node], to = morphed[node];
    out.set(n, {gone_along(at.x, from.x, to.x), gone_along(at.y, from.y, to.y), gone_along(at.z, from.z, to.z)});
  }
  return out;
}

}  // namespace gridmorph::foam
