#include <gridmorph/wheel/wheel_mesh.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr std::size_t longest_name = 32;  // of a CGNS node

std::string with_suffix(std::string const& name, std::string const& suffix, char const* what) {
  std::string const last = name.substr(name.rfind('/') == std::string::npos ? 0 : name.rfind('/') + 1);
  if (last.size() + suffix.size() > longest_name)
    throw MeshError(std::string(what) + " '" + name + "' is too long for a wheel: with '" + suffix + "' it has " +
                    std::to_string(last.size() + suffix.size()) + " characters of " + std::to_string(longest_name) +
                    "; give it a shorter name");
  return name + suffix;
}

class Builder {
 public:
  Builder(Mesh const& sector, PassageLinks const& links, WheelRows const& rows, std::vector<int> const& passages,
          WheelFamilies families)
      : sector_(sector),
        links_(links),
        rows_(rows),
        passages_(passages),
        families_(families),
        of_elements_(!sector.is_structured()) {}

  WheelMesh run() {
    Mesh& mesh = out_.mesh;
    mesh.source = sector_.source;
    mesh.dimension = sector_.dimension;
    mesh.elements = sector_.elements;
    mesh.polyhedra = sector_.polyhedra;
    if (of_elements_)
      for (Patch const& patch : sector_.patches) sides_.push_back(sides_of(patch));
    int const most = *std::max_element(passages_.begin(), passages_.end());
    for (int p = 0; p < most; ++p)
      for (int z = 0; z < int(sector_.zones.size()); ++z)
        if (p < passages_of(z)) add_zone(z, p);
    for (std::size_t n = 0; n < out_.zones.size(); ++n) number_[{out_.zones[n].zone, out_.zones[n].passage}] = int(n);
    if (families_ == WheelFamilies::shared) mesh.families = sector_.families;
    for (auto const& [zone, passage] : out_.zones) {
      add_patches(zone, passage);
      add_connections(zone, passage);
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] WheelRow const& row_of(int zone) const { return rows_.rows[rows_.row_of_zone[zone]]; }
  [[nodiscard]] int passages_of(int zone) const { return passages_[rows_.row_of_zone[zone]]; }
  [[nodiscard]] std::string suffix_of(int zone, int passage) const {
    return row_of(zone).periodic() ? passage_suffix(passage, std::max(row_of(zone).passages, passages_of(zone)))
                                   : std::string();
  }

  void add_zone(int z, int passage) {
    Zone const& zone = sector_.zones[z];
    std::string const name = with_suffix(zone.name, suffix_of(z, passage), "zone");
    if (of_elements_)
      out_.mesh.zones.push_back({.name = name,
                                 .first_node = zone.first_node,
                                 .n_nodes = zone.size(),
                                 .first_element = zone.first_element,
                                 .n_elements = zone.n_elements});
    else
      out_.mesh.add_zone(name, zone.extent);
    out_.mesh.zones.back().single_precision = zone.single_precision;
    out_.zones.push_back({z, passage});
  }

  [[nodiscard]] std::vector<std::string> family_names(std::vector<std::string> names, int zone, int passage) const {
    if (families_ == WheelFamilies::suffixed)
      for (auto& name : names) name = with_suffix(name, suffix_of(zone, passage), "family");
    return names;
  }

  void add_patches(int zone, int passage) {
    for (std::size_t p = 0; p < sector_.patches.size(); ++p) {
      Patch const& patch = sector_.patches[p];
      if (patch.zone != zone) continue;
      auto own = of_elements_ ? without_seams(patch, sides_[p], passage) : patch;
      if (!own) continue;
      Patch copy = std::move(*own);
      copy.zone = number_.at({zone, passage});
      copy.families = family_names(patch.families, zone, passage);
      out_.mesh.patches.push_back(std::move(copy));
    }
  }

  /// Per face of a patch of elements the periodic link of its zone on whose side it lies, or -1; of a patch of nodes
  /// one entry.
  [[nodiscard]] std::vector<int> sides_of(Patch const& patch) const {
    std::vector<int> out(std::max<Index>(1, patch.faces.size()), -1);
    for (int const l : links_.of_zone[patch.zone]) {
      if (!links_.all[l].periodic) continue;
      std::vector<Index> side;
      for (auto const& pair : links_.all[l].pairs) side.push_back(pair[0]);
      std::sort(side.begin(), side.end());
      auto const within = [&](auto const& nodes) {
        return !nodes.empty() && std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) {
          return std::binary_search(side.begin(), side.end(), Index(n));
        });
      };
      for (Index f = 0; f < patch.faces.size(); ++f)
        if (out[f] < 0 && within(patch.faces[f])) out[f] = l;
      if (patch.faces.size() == 0 && out.front() < 0 && within(patch.nodes)) out.front() = l;
    }
    return out;
  }

  /// What a patch has in a passage; nothing where all of it lies between passages.
  [[nodiscard]] std::optional<Patch> without_seams(Patch const& patch, std::vector<int> const& sides,
                                                   int passage) const {
    auto const between = [&](int link) { return link >= 0 && !is_end(link, patch.zone, passage); };
    if (std::none_of(sides.begin(), sides.end(), between)) return patch;
    if (patch.faces.size() == 0) return {};
    Patch out = patch;
    out.faces = {};
    for (Index f = 0; f < patch.faces.size(); ++f)
      if (!between(sides[f])) out.faces.add(patch.faces[f]);
    if (out.faces.size() == 0) return {};
    return out;
  }

  [[nodiscard]] int donor_of(int link, int zone, int passage) const {
    int const made = passages_of(zone);
    return (passage - rows_.pitches_of_link[link] + made) % made;
  }
  /// Whether a link of a passage leads from one end of a part of a wheel or of
  /// a straight row to the other.
  [[nodiscard]] bool is_end(int link, int zone, int passage) const {
    return !row_of(zone).pitch.comes_round(passages_of(zone)) &&
           donor_of(link, zone, passage) != passage - rows_.pitches_of_link[link];
  }

  void add_connections(int zone, int passage) {
    auto const stored = connections_of(sector_);
    std::set<std::string> taken;
    for (int const l : links_.of_zone[zone]) {
      PassageLink const& link = links_.all[l];
      AnyConnection const& from = stored[link.connection];
      // A connection that the file stores once gets the same name on its other side, unless that is taken there.
      std::string name = from.name;
      for (int n = 2; !taken.insert(name).second; ++n) {
        std::string const number = "_" + std::to_string(n);
        name = from.name.substr(0, longest_name - number.size()) + number;
      }
      auto const families = family_names(from.families, zone, passage);
      int const own = number_.at({zone, passage}), donor = number_.at({link.donor_zone, donor_of(l, zone, passage)});
      std::optional<Periodic> periodic;
      if (is_end(l, zone, passage))
        periodic = row_of(zone).pitch.periodic(passages_of(zone) * rows_.pitches_of_link[l]);
      if (!of_elements_) {
        out_.mesh.interfaces.push_back({name, families, own, donor, link.range, link.to_donor, periodic});
        continue;
      }
      Connection c{name, families, own, donor, {}, {}, periodic};
      for (auto const& [node, partner] : link.pairs) {
        c.nodes.push_back(Index32(node));
        c.donor_nodes.push_back(Index32(partner));
      }
      out_.mesh.connections.push_back(std::move(c));
    }
  }

  Mesh const& sector_;
  PassageLinks const& links_;
  WheelRows const& rows_;
  std::vector<int> const& passages_;
  WheelFamilies families_;
  bool of_elements_;
  std::vector<std::vector<int>> sides_;  ///< of patches of elements, see sides_of()
  WheelMesh out_;
  std::map<std::pair<int, int>, int> number_;  ///< (zone of the sector, passage) -> zone of the wheel
};

}  // namespace

Index WheelMesh::n_nodes() const {
  Index n = 0;
  for (Zone const& zone : mesh.zones) n += zone.size();
  return n;
}

std::string passage_suffix(int passage, int passages) {
  std::size_t const digits = std::max<std::size_t>(2, std::to_string(passages).size());
  std::string const number = std::to_string(passage + 1);
  return "_P" + std::string(digits - std::min(digits, number.size()), '0') + number;
}

WheelMesh make_wheel_mesh(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                          std::vector<int> const& passages, WheelFamilies families) {
  return Builder(sector, links, rows, passages, families).run();
}

}  // namespace gridmorph
