#include <gridmorph/fillet/split_mesh.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

constexpr std::size_t longest_name = 32;  // of a CGNS node

class Splitter {
 public:
  Splitter(Mesh const& old, WallSheets const& sheets, SheetLayers const& layers)
      : old_(old), sheets_(sheets), layers_(layers), parts_(old.zones.size()) {}

  SplitMesh run() {
    Mesh& mesh = out_.mesh;
    mesh.source = old_.source;
    mesh.dimension = old_.dimension;
    mesh.families = old_.families;
    for (int z = 0; z < int(old_.zones.size()); ++z) names_.insert(old_.zones[z].name);
    for (int z = 0; z < int(old_.zones.size()); ++z) split(z);
    for (std::size_t p = 0; p < old_.patches.size(); ++p) add(int(p));
    for (Interface1to1 const& interface : old_.interfaces) add(interface);
    for (int z = 0; z < int(old_.zones.size()); ++z) join(z);
    return std::move(out_);
  }

 private:
  [[nodiscard]] Sheet const& sheet_of(SplitZone const& part) const { return sheets_.all[part.sheet]; }
  [[nodiscard]] int layers_of(Sheet const& sheet) const { return layers_.old[int(sheet.wall)]; }

  /// Takes the sheet's layers off a box.
  void trim(IndexRange& box, Sheet const& sheet) const {
    if (sheet.side == 0)
      box.begin[sheet.axis] += layers_of(sheet);
    else
      box.end[sheet.axis] -= layers_of(sheet);
  }

  void split(int z) {
    Zone const& zone = old_.zones[z];
    IndexRange core{{0, 0, 0}, zone.extent};
    auto const& own = sheets_.of_zone[z];
    for (int n : own) trim(core, sheets_.all[n]);
    for (int axis = 0; axis < 3; ++axis)
      if (core.extent(axis) < 2)
        throw MeshError("zone '" + zone.name + "' has " + std::to_string(zone.extent[axis] - 1) + " cells along " +
                        "ijk"[axis] + ", too few for the layers along its walls (" + std::to_string(layers_.old[0]) +
                        " off the blade, " + std::to_string(layers_.old[1]) +
                        " off the end wall) and one more; fill with a smaller radius, or give fewer layers");
    add_zone(zone.name, {z, core, -1});
    for (int n : own) {
      Sheet const& sheet = sheets_.all[n];
      IndexRange box{{0, 0, 0}, zone.extent};
      for (int other : own)
        if (sheets_.all[other].axis != sheet.axis) trim(box, sheets_.all[other]);
      (sheet.side == 0 ? box.end : box.begin)[sheet.axis] =
          sheet.side == 0 ? layers_of(sheet) + 1 : zone.extent[sheet.axis] - 1 - layers_of(sheet);
      add_zone(free_name(zone.name, sheet.wall == Wall::blade ? "_blade" : "_wall"), {z, box, n});
    }
  }

  std::string free_name(std::string const& name, std::string const& suffix) {
    for (int n = 1;; ++n) {
      std::string const end = suffix + (n == 1 ? "" : std::to_string(n));
      std::size_t const base = name.rfind('/') == std::string::npos ? 0 : name.rfind('/') + 1;
      std::string const tried = name.substr(0, base + std::min(name.size() - base, longest_name - end.size())) + end;
      if (names_.insert(tried).second) return tried;
    }
  }

  void add_zone(std::string const& name, SplitZone const& part) {
    Index3 extent;
    for (int axis = 0; axis < 3; ++axis)
      extent[axis] = part.sheet >= 0 && sheet_of(part).axis == axis ? layers_.made + 1 : part.box.extent(axis);
    parts_[part.zone].push_back(int(out_.zones.size()));
    out_.zones.push_back(part);
    int const n = out_.mesh.add_zone(name, extent);
    out_.mesh.zones[n].single_precision = old_.zones[part.zone].single_precision;
  }

  /// Old node numbers along an axis as those of the part. Along the layers of a sheet only its two ends have one.
  [[nodiscard]] int place(SplitZone const& part, int axis, int index) const {
    if (part.sheet < 0 || sheet_of(part).axis != axis) return index - part.box.begin[axis];
    if (index == part.box.begin[axis]) return 0;
    if (index == part.box.end[axis] - 1) return layers_.made;
    throw MeshError("zone '" + old_.zones[part.zone].name +
                    "': a patch or an interface ends inside of the layers along a wall, at " + "ijk"[axis] + " = " +
                    std::to_string(index + 1) + "; give another number of layers, so that they end there");
  }
  [[nodiscard]] Index3 place(SplitZone const& part, Index3 const& p) const {
    return {place(part, 0, p[0]), place(part, 1, p[1]), place(part, 2, p[2])};
  }
  [[nodiscard]] IndexRange place(SplitZone const& part, IndexRange const& range) const {
    Index3 const first = place(part, range.begin);
    Index3 const last = place(part, Index3{range.end[0] - 1, range.end[1] - 1, range.end[2] - 1});
    return {first, {last[0] + 1, last[1] + 1, last[2] + 1}};
  }

  /// What two boxes of nodes have in common, where that is a face of cells.
  static std::optional<IndexRange> common(IndexRange const& a, IndexRange const& b) {
    IndexRange out;
    int flat = 0;
    for (int axis = 0; axis < 3; ++axis) {
      out.begin[axis] = std::max(a.begin[axis], b.begin[axis]);
      out.end[axis] = std::min(a.end[axis], b.end[axis]);
      if (out.extent(axis) < 1) return {};
      flat += out.extent(axis) == 1 ? 1 : 0;
    }
    if (flat != 1) return {};
    return out;
  }

  void add(int p) {
    Patch const& patch = old_.patches[p];
    for (int n : parts_[patch.zone]) {
      auto const piece = common(patch.range, out_.zones[n].box);
      if (!piece) continue;
      Patch next = patch;
      next.zone = n;
      next.range = place(out_.zones[n], *piece);
      out_.mesh.patches.push_back(std::move(next));
      out_.patches.push_back(p);
    }
  }

  void add(Interface1to1 const& interface) {
    for (int n : parts_[interface.zone]) {
      SplitZone const& part = out_.zones[n];
      auto const own = common(interface.range, part.box);
      if (!own) continue;
      for (int d : parts_[interface.donor_zone]) {
        SplitZone const& donor = out_.zones[d];
        auto const there = common(interface.to_donor(*own), donor.box);
        if (!there) continue;
        IndexRange const here = interface.to_donor.inverse()(*there);
        Interface1to1 next = interface;
        next.zone = n;
        next.donor_zone = d;
        next.range = place(part, here);
        next.to_donor.own_origin = place(part, here.begin);
        next.to_donor.donor_origin = place(donor, interface.to_donor(here.begin));
        out_.mesh.interfaces.push_back(std::move(next));
      }
    }
  }

  /// Adds both sides of an interface between two parts.
  void add_join(int own, IndexRange const& range, int donor, IndexMap const& map) {
    add_side(own, range, donor, map);
    add_side(donor, map(range), own, map.inverse());
  }
  void add_side(int own, IndexRange const& range, int donor, IndexMap const& map) {
    std::string const& to = out_.mesh.zones[donor].name;
    std::string const last = to.substr(to.rfind('/') == std::string::npos ? 0 : to.rfind('/') + 1);
    out_.mesh.interfaces.push_back({.name = "to_" + last,
                                    .families = {},
                                    .zone = own,
                                    .donor_zone = donor,
                                    .range = range,
                                    .to_donor = map,
                                    .periodic = {}});
  }

  /// Interfaces among the parts of one zone.
  void join(int z) {
    auto const& parts = parts_[z];
    for (std::size_t n = 1; n < parts.size(); ++n) {
      SplitZone const &core = out_.zones[parts[0]], &sheet = out_.zones[parts[n]];
      if (auto const face = common(sheet.box, core.box))
        add_join(parts[n], place(sheet, *face), parts[0], {{}, place(sheet, face->begin), place(core, face->begin)});
      for (std::size_t m = n + 1; m < parts.size(); ++m)
        if (sheet_of(sheet).axis != sheet_of(out_.zones[parts[m]]).axis) join_sheets(parts[n], parts[m]);
    }
  }

  /// The end of one sheet, layer by layer, on that of the other.
  void join_sheets(int one, int other) {
    Sheet const &a = sheet_of(out_.zones[one]), &b = sheet_of(out_.zones[other]);
    Index3 const extent = out_.mesh.zones[one].extent, donor = out_.mesh.zones[other].extent;
    // The face of each that looks at the other's wall.
    IndexRange face{{0, 0, 0}, extent};
    face.begin[b.axis] = b.side == 0 ? 0 : extent[b.axis] - 1;
    face.end[b.axis] = face.begin[b.axis] + 1;
    IndexMap map;
    int const along = 3 - a.axis - b.axis;
    int const same = a.side == b.side ? 1 : -1;
    map.orientation.axis[along] = along;
    map.orientation.axis[a.axis] = b.axis;  // layer by layer
    map.orientation.sign[a.axis] = same;
    map.orientation.axis[b.axis] = a.axis;  // out of the one into the other
    map.orientation.sign[b.axis] = -same;
    // The wall's corner: on the wall of `a`, on the face; of the other, on its own wall, on its face.
    map.own_origin = face.begin;
    map.own_origin[a.axis] = a.side == 0 ? 0 : extent[a.axis] - 1;
    map.donor_origin[along] = map.own_origin[along];
    map.donor_origin[b.axis] = b.side == 0 ? 0 : donor[b.axis] - 1;
    map.donor_origin[a.axis] = a.side == 0 ? 0 : donor[a.axis] - 1;
    add_join(one, face, other, map);
  }

  Mesh const& old_;
  WallSheets const& sheets_;
  SheetLayers const& layers_;
  std::vector<std::vector<int>> parts_;  ///< per old zone: what is left of it first
  std::set<std::string> names_;
  SplitMesh out_;
};

}  // namespace

SplitMesh split_corners(Mesh const& mesh, WallSheets const& sheets, SheetLayers const& layers) {
  return Splitter(mesh, sheets, layers).run();
}

}  // namespace gridmorph
