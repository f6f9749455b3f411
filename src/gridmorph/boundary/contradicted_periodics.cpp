#include <gridmorph/boundary/contradicted_periodics.hpp>
#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

namespace gridmorph {

namespace {

/// The share of the mesh size by which partners are too far off: more than angles in single precision and rounded axes
/// leave.
constexpr double far_off_partner = 1e-3;

struct PartnerNodes {
  std::vector<Vec3> from, to;

  [[nodiscard]] double apart(RigidTransform const& t) const {
    double worst = 0;
    for (std::size_t n = 0; n < from.size(); ++n) worst = std::max(worst, distance(t(from[n]), to[n]));
    return worst;
  }
};

std::string transform_text(RigidTransform const& t) {
  auto const turn = as_turn(t, std::numeric_limits<double>::infinity());
  if (!turn) return "a translation by " + to_text(t.translation, 6);
  return "a rotation of " + to_text(turn->angle_rad * 180 / std::numbers::pi, 6) + " degrees about " +
         to_text(turn->direction, 4) + " through " + to_text(turn->origin, 4);
}

bool range_is_inside(Zone const& zone, IndexRange const& range) {
  for (int a = 0; a < 3; ++a)
    if (range.begin[a] < 0 || range.begin[a] >= range.end[a] || range.end[a] > zone.extent[a]) return false;
  return true;
}

class Contradictions {
 public:
  explicit Contradictions(double size) : size_(size) {}

  void look(std::string const& what, Periodic const& declared, PartnerNodes const& pairs) {
    bool const says_nothing = declared.rotation_angle_rad == Vec3{} && declared.translation == Vec3{};
    if (pairs.from.empty() || says_nothing) return;
    double const tolerance = far_off_partner * size_;
    if (pairs.apart(declared.declared) <= tolerance || pairs.apart(declared.declared.inverse()) <= tolerance) return;
    RigidTransform const fitted = fit_periodic(declared, pairs.from, pairs.to, size_);
    if (!(pairs.apart(fitted) <= tolerance)) return;  // they do not match at all, which is told elsewhere
    std::string says = ": the file declares " + transform_text(declared.declared) + ", and by the nodes it is " +
                       transform_text(fitted) + ", which counts; correct it in the file, other programs may go by that";
    auto const known = std::find_if(found_.begin(), found_.end(), [&](Found const& f) { return f.says == says; });
    if (known == found_.end())
      found_.push_back({what, std::move(says), 0});
    else
      ++known->more;
  }

  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> out;
    for (Found const& f : found_)
      out.push_back(f.what + (f.more > 0 ? " and " + std::to_string(f.more) + " more" : "") + f.says);
    return out;
  }

 private:
  struct Found {
    std::string what, says;
    int more = 0;
  };
  double size_;
  std::vector<Found> found_;
};

}  // namespace

std::vector<std::string> contradicted_periodics(Mesh const& mesh, double mesh_size) {
  auto const is_periodic = [](auto const& c) { return c.periodic.has_value(); };
  if (std::none_of(mesh.interfaces.begin(), mesh.interfaces.end(), is_periodic) &&
      std::none_of(mesh.connections.begin(), mesh.connections.end(), is_periodic))
    return {};
  Contradictions out(mesh_size);
  auto const n_zones = int(mesh.zones.size());
  for (auto const& face : mesh.interfaces) {
    bool const placed = face.zone >= 0 && face.zone < n_zones && face.donor_zone >= 0 && face.donor_zone < n_zones;
    if (!face.periodic || !placed || !range_is_inside(mesh.zones[face.zone], face.range) ||
        !range_is_inside(mesh.zones[face.donor_zone], face.to_donor(face.range)))
      continue;
    PartnerNodes pairs;
    for_each_pair(mesh, face, [&](Index p, Index q) {
      pairs.from.push_back(mesh.coordinates[p]);
      pairs.to.push_back(mesh.coordinates[q]);
    });
    out.look("periodic interface '" + face.name + "' (" + describe_range(mesh, face.zone, face.range) + ")",
             *face.periodic, pairs);
  }
  for (auto const& c : mesh.connections) {
    if (!c.periodic) continue;
    PartnerNodes pairs;
    for (std::size_t n = 0; n < c.nodes.size(); ++n) {
      pairs.from.push_back(mesh.coordinates[c.nodes[n]]);
      pairs.to.push_back(mesh.coordinates[c.donor_nodes[n]]);
    }
    out.look("periodic connection '" + c.name + "'", *c.periodic, pairs);
  }
  return out.lines();
}

}  // namespace gridmorph
