#include <gridmorph/wheel/wheel_mesh.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/turn.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
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

/// Angles about x, y, z (CGNS SIDS: x first) of a turn; a turn about a coordinate axis keeps its angle as it is.
Vec3 angles_of(Axis const& axis, RigidTransform const& t, double angle) {
  Vec3 const d = (1 / norm(axis.direction)) * axis.direction;
  if (std::abs(d.x) == 1 || std::abs(d.y) == 1 || std::abs(d.z) == 1) return angle * d;
  auto const& m = t.rotation.m;
  return {std::atan2(m[2][1], m[2][2]), std::atan2(-m[2][0], std::hypot(m[0][0], m[1][0])),
          std::atan2(m[1][0], m[0][0])};
}

class Builder {
 public:
  Builder(Mesh const& sector, Links const& links, WheelRows const& rows, Axis const& axis,
          std::vector<int> const& passages, WheelFamilies families)
      : sector_(sector), links_(links), rows_(rows), axis_(axis), passages_(passages), families_(families) {}

  WheelMesh run() {
    Mesh& mesh = out_.mesh;
    mesh.source = sector_.source;
    mesh.dimension = sector_.dimension;
    int const most = *std::max_element(passages_.begin(), passages_.end());
    for (int p = 0; p < most; ++p)
      for (int z = 0; z < int(sector_.zones.size()); ++z)
        if (p < passages_of(z)) add_zone(z, p);
    for (std::size_t n = 0; n < out_.zones.size(); ++n) number_[{out_.zones[n].zone, out_.zones[n].passage}] = int(n);
    if (families_ == WheelFamilies::shared) mesh.families = sector_.families;
    for (auto const& [zone, passage] : out_.zones) {
      add_patches(zone, passage);
      add_interfaces(zone, passage);
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] WheelRow const& row_of(int zone) const { return rows_.rows[rows_.row_of_zone[zone]]; }
  [[nodiscard]] int passages_of(int zone) const { return passages_[rows_.row_of_zone[zone]]; }
  [[nodiscard]] std::string suffix_of(int zone, int passage) const {
    return row_of(zone).periodic() ? passage_suffix(passage, row_of(zone).passages) : std::string();
  }

  void add_zone(int z, int passage) {
    Zone const& zone = sector_.zones[z];
    int const n = out_.mesh.add_zone(with_suffix(zone.name, suffix_of(z, passage), "zone"), zone.extent);
    out_.mesh.zones[n].single_precision = zone.single_precision;
    out_.zones.push_back({z, passage});
  }

  [[nodiscard]] std::vector<std::string> family_names(std::vector<std::string> names, int zone, int passage) const {
    if (families_ == WheelFamilies::suffixed)
      for (auto& name : names) name = with_suffix(name, suffix_of(zone, passage), "family");
    return names;
  }

  void add_patches(int zone, int passage) {
    for (Patch const& patch : sector_.patches) {
      if (patch.zone != zone) continue;
      Patch copy = patch;
      copy.zone = number_.at({zone, passage});
      copy.families = family_names(patch.families, zone, passage);
      out_.mesh.patches.push_back(std::move(copy));
    }
  }

  void add_interfaces(int zone, int passage) {
    std::set<std::string> taken;
    for (int const l : links_.of_zone[zone]) {
      Link const& link = links_.all[l];
      Interface1to1 const& from = sector_.interfaces[link.interface];
      Interface1to1 face;
      // A connection that the file stores once gets the same name on its other side, unless that is taken there.
      face.name = from.name;
      for (int n = 2; !taken.insert(face.name).second; ++n) {
        std::string const number = "_" + std::to_string(n);
        face.name = from.name.substr(0, longest_name - number.size()) + number;
      }
      face.families = family_names(from.families, zone, passage);
      face.zone = number_.at({zone, passage});
      face.range = link.range;
      face.to_donor = link.to_donor;
      int const made = passages_of(zone), whole = row_of(zone).passages, beyond = passage - rows_.pitches_of_link[l];
      int const donor = (beyond + made) % made;
      face.donor_zone = number_.at({link.donor_zone, donor});
      if (donor != beyond && made < whole) face.periodic = end_to_end(made * rows_.pitches_of_link[l], whole);
      out_.mesh.interfaces.push_back(std::move(face));
    }
  }

  [[nodiscard]] Periodic end_to_end(int pitches, int whole) const {
    Periodic periodic;
    periodic.declared = Turn(axis_, pitches, whole).transform();
    periodic.rotation_center = axis_.origin;
    periodic.rotation_angle_rad = angles_of(axis_, periodic.declared, 2 * std::numbers::pi * pitches / whole);
    return periodic;
  }

  Mesh const& sector_;
  Links const& links_;
  WheelRows const& rows_;
  Axis const& axis_;
  std::vector<int> const& passages_;
  WheelFamilies families_;
  WheelMesh out_;
  std::map<std::pair<int, int>, int> number_;  ///< (zone of the sector, passage) -> zone of the wheel
};

}  // namespace

std::string passage_suffix(int passage, int passages) {
  std::size_t const digits = std::max<std::size_t>(2, std::to_string(passages).size());
  std::string const number = std::to_string(passage + 1);
  return "_P" + std::string(digits - std::min(digits, number.size()), '0') + number;
}

WheelMesh make_wheel_mesh(Mesh const& sector, Links const& links, WheelRows const& rows, Axis const& axis,
                          std::vector<int> const& passages, WheelFamilies families) {
  return Builder(sector, links, rows, axis, passages, families).run();
}

}  // namespace gridmorph
