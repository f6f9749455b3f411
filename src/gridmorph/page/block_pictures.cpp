#include <gridmorph/page/picture_mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace gridmorph::page {

std::vector<Index32> PictureMesh::nodes(Index cell) const {
  CellFaces faces_of;
  faces(cell, faces_of);
  std::vector<Index32> out = std::move(faces_of.node);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Vec3 PictureMesh::centre(Index cell, Coordinates const& at) const {
  Vec3 sum;
  auto const corners = nodes(cell);
  for (Index32 const n : corners) sum += at[n];
  return (1 / double(corners.size())) * sum;
}

std::string to_string(CellName const& name) {
  if (name.index.size() == 1) return fmt::format("zone '{}' element {}", name.zone, name.index[0]);
  return fmt::format("zone '{}' cell (i {}, j {}, k {})", name.zone, name.index[0], name.index[1], name.index[2]);
}

namespace {

class BlockPictures final : public PictureMesh {
 public:
  BlockPictures(Mesh const& mesh, std::span<int const> handedness)
      : PictureMesh(mesh), handedness_(handedness.begin(), handedness.end()), first_(first_cells(mesh)) {}

  bool is_plane() const override {
    return mesh().dimension == 2 ||
           std::all_of(mesh().zones.begin(), mesh().zones.end(), [](Zone const& zone) { return zone.extent[2] == 2; });
  }
  Index n_cells() const override { return first_.back(); }

  std::vector<Facet> boundary() const override {
    std::vector<Facet> out;
    for (int p = 0; p < int(mesh().patches.size()); ++p) add_patch(p, out);
    return out;
  }

  Plane plane() const override { return index_plane(2, 0); }

  Plane index_plane(int axis, int index) const override {
    Plane out;
    int const u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    for (int z = 0; z < int(mesh().zones.size()); ++z) {
      Zone const& zone = mesh().zones[z];
      if (index >= zone.extent[axis]) continue;
      Index3 p{0, 0, 0};
      for (p[v] = 0; p[v] + 1 < zone.extent[v]; ++p[v])
        for (p[u] = 0; p[u] + 1 < zone.extent[u]; ++p[u]) {
          auto const node = [&](int a, int b) {
            Index3 q = p;
            q[axis] = index;
            q[u] += a;
            q[v] += b;
            return number(zone, q);
          };
          out.facets.push_back({{node(0, 0), node(1, 0), node(1, 1), node(0, 1)}, -1});
          Index3 cell = p;
          cell[axis] = std::min(index, zone.extent[axis] - 2);
          out.cell.push_back(number_of(z, cell));
        }
    }
    for (int p = 0; p < int(mesh().patches.size()); ++p) add_sides(p, axis, index, out.sides);
    return out;
  }

  std::vector<Index> crossed(std::span<double const> level) const override {
    std::vector<Index> out;
    std::vector<int> below;  // of four nodes that differ in j and k, along i
    for (std::size_t z = 0; z < mesh().zones.size(); ++z) {
      Zone const& zone = mesh().zones[z];
      Index const sj = zone.strides()[1], sk = zone.strides()[2];
      auto const ni = std::size_t(zone.extent[0]);
      below.resize(ni);
      Index cell = first_[z];
      for (int k = 0; k + 1 < zone.extent[2]; ++k)
        for (int j = 0; j + 1 < zone.extent[1]; ++j, cell += Index(ni) - 1) {
          double const* const at = level.data() + zone.node({0, j, k});
          int least = 4, most = 0;
          for (std::size_t i = 0; i < ni; ++i) {
            double const* const p = at + i;
            below[i] = int(p[0] < 0) + int(p[sj] < 0) + int(p[sk] < 0) + int(p[sj + sk] < 0);
            least = std::min(least, below[i]);
            most = std::max(most, below[i]);
          }
          if (most == 0 || least == 4) continue;  // so of most rows
          for (std::size_t i = 0; i + 1 < ni; ++i)
            if (int const of_cell = below[i] + below[i + 1]; of_cell != 0 && of_cell != 8)
              out.push_back(cell + Index(i));
        }
    }
    return out;
  }

  void faces(Index cell, CellFaces& out) const override {
    auto const [z, c] = place(cell);
    Zone const& zone = mesh().zones[z];
    out.node.clear();
    out.first.assign(1, 0);
    for (int axis = 0; axis < 3; ++axis)
      for (int const side : {0, 1}) {
        constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        for (auto const& [a, b] : around) {
          Index3 p = c;
          p[axis] += side;
          p[(axis + 1) % 3] += a;
          p[(axis + 2) % 3] += b;
          out.node.push_back(number(zone, p));
        }
        out.first.push_back(out.node.size());
      }
  }

  std::vector<Index> around(Index cell) const override {
    auto const [z, c] = place(cell);
    Zone const& zone = mesh().zones[z];
    std::vector<Index> out;
    for (int k = std::max(0, c[2] - 1); k <= std::min(zone.extent[2] - 2, c[2] + 1); ++k)
      for (int j = std::max(0, c[1] - 1); j <= std::min(zone.extent[1] - 2, c[1] + 1); ++j)
        for (int i = std::max(0, c[0] - 1); i <= std::min(zone.extent[0] - 2, c[0] + 1); ++i)
          if (Index const n = number_of(z, {i, j, k}); n != cell) out.push_back(n);
    return out;
  }

  kernels::CellMeasures measures(Index cell, Coordinates const& at) const override {
    auto const [z, c] = place(cell);
    Zone const& zone = mesh().zones[z];
    kernels::HexCell hex;
    for (int n = 0; n < 8; ++n) hex.corner[n] = at[zone.node({c[0] + (n & 1), c[1] + (n >> 1 & 1), c[2] + (n >> 2)})];
    return kernels::cell_measures(hex, handedness_[z]);
  }

  CellName name(Index cell) const override {
    auto const [z, c] = place(cell);
    return {mesh().zones[z].name, {c[0] + 1, c[1] + 1, c[2] + 1}};
  }

  Index number_of(int zone, Index3 const& cell) const override {
    Index3 const& e = mesh().zones[zone].extent;
    return first_[zone] + cell[0] + Index(e[0] - 1) * (cell[1] + Index(e[1] - 1) * cell[2]);
  }

 private:
  static Index32 number(Zone const& zone, Index3 const& p) { return Index32(zone.node(p)); }

  [[nodiscard]] std::pair<int, Index3> place(Index cell) const {
    auto const z = std::size_t(std::upper_bound(first_.begin(), first_.end(), cell) - first_.begin() - 1);
    Index3 const& e = mesh().zones[z].extent;
    Index const local = cell - first_[z], ni = e[0] - 1, nj = e[1] - 1;
    return {int(z), {int(local % ni), int(local / ni % nj), int(local / (ni * nj))}};
  }

  /// Its axis and side in the zone; -1 where it lies on no face.
  [[nodiscard]] std::pair<int, int> face_of(Patch const& patch) const {
    Zone const& zone = mesh().zones[patch.zone];
    for (int axis = 0; axis < 3; ++axis) {
      auto const a = std::size_t(axis);
      if (patch.range.extent(axis) != 1) continue;
      if (patch.range.begin[a] == 0) return {axis, 0};
      if (patch.range.end[a] == zone.extent[a]) return {axis, 1};
    }
    return {-1, 0};
  }

  void add_patch(int p, std::vector<Facet>& out) const {
    Patch const& patch = mesh().patches[p];
    auto const [axis, side] = face_of(patch);
    if (axis < 0 || patch.kind == PatchKind::region) return;
    Zone const& zone = mesh().zones[patch.zone];
    auto const u = std::size_t((axis + 1) % 3), v = std::size_t((axis + 2) % 3);
    bool const turned = (side == 1) != (handedness_[patch.zone] < 0);
    for (int b = patch.range.begin[v]; b + 1 < patch.range.end[v]; ++b)
      for (int a = patch.range.begin[u]; a + 1 < patch.range.end[u]; ++a) {
        auto const node = [&](int da, int db) {
          Index3 q = patch.range.begin;
          q[u] = a + da;
          q[v] = b + db;
          return number(zone, q);
        };
        Facet facet{{node(0, 0), node(1, 0), node(1, 1), node(0, 1)}, p};
        if (turned) std::swap(facet.node[1], facet.node[3]);
        out.push_back(facet);
      }
  }

  /// Where a patch meets the plane `index` across an axis.
  void add_sides(int p, int across, int index, std::vector<Edge>& out) const {
    Patch const& patch = mesh().patches[p];
    auto const [axis, side] = face_of(patch);
    if (axis < 0 || axis == across || index < patch.range.begin[across] || index >= patch.range.end[across]) return;
    Zone const& zone = mesh().zones[patch.zone];
    auto const along = std::size_t(3 - axis - across);
    for (int a = patch.range.begin[along]; a + 1 < patch.range.end[along]; ++a) {
      Index3 q = patch.range.begin;
      q[across] = index;
      Index3 r = q;
      q[along] = a;
      r[along] = a + 1;
      out.push_back({{number(zone, q), number(zone, r)}, p});
    }
  }

  std::vector<int> handedness_;
  std::vector<Index> first_;
};

}  // namespace

std::unique_ptr<PictureMesh> picture_mesh(Mesh const& mesh, std::span<int const> handedness) {
  return std::make_unique<BlockPictures>(mesh, handedness);
}

}  // namespace gridmorph::page
