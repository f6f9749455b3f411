#include <gridmorph/plan/detail/archive.hpp>
#include <gridmorph/plan/detail/hash64.hpp>
#include <gridmorph/plan/detail/plan_fields.hpp>
#include <gridmorph/plan/plan_key.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace gridmorph {

namespace detail {

GRIDMORPH_DETAIL_FIELDS(Orientation, axis, sign)
GRIDMORPH_DETAIL_FIELDS(IndexMap, orientation, own_origin, donor_origin)
GRIDMORPH_DETAIL_FIELDS(RigidTransform, rotation, translation)
GRIDMORPH_DETAIL_FIELDS(Periodic, rotation_center, rotation_angle_rad, translation, declared)
GRIDMORPH_DETAIL_FIELDS(Patch, name, bc_type, kind, families, zone, range)
GRIDMORPH_DETAIL_FIELDS(Zone, name, extent, first_node, single_precision)
GRIDMORPH_DETAIL_FIELDS(Axis, origin, direction)
GRIDMORPH_DETAIL_FIELDS(TopologyOptions, matching_tolerance, open_faces)
GRIDMORPH_DETAIL_FIELDS(BoundaryLayer, walls, extent, layers, thickness, mode)
GRIDMORPH_DETAIL_FIELDS(PriorityRule, kind, order)
GRIDMORPH_DETAIL_FIELDS(VolumeOptions, law, priority)
GRIDMORPH_DETAIL_FIELDS(PlanOptions, topology, boundary_layers, volume)

}  // namespace detail

namespace {

using detail::ByteWriter;
using detail::pass;

void add(ByteWriter& to, Interface1to1 const& interface) {
  auto const& [name, families, zone, donor_zone, range, to_donor, periodic] = interface;
  pass(to, name);
  pass(to, families);
  pass(to, zone);
  pass(to, donor_zone);
  pass(to, range);
  pass(to, to_donor);
  to.number(periodic.has_value());
  if (periodic) pass(to, *periodic);
}

// What of a rule a plan depends on, besides its name.
void add(ByteWriter&, FixedRule const&) {}
void add(ByteWriter&, RigidRule const&) {}
void add(ByteWriter&, FunctionRule const&) {}
void add(ByteWriter&, SectionsRule const&) {}
void add(ByteWriter&, TargetRule const&) {}
void add(ByteWriter& to, CircumferentialSlideRule const& rule) { pass(to, rule.of); }
void add(ByteWriter& to, FollowRule const& rule) { pass(to, rule.of); }
void add(ByteWriter& to, FreeRule const& rule) { pass(to, rule.constraint); }
void add(ByteWriter& to, SlipRule const& rule) {
  auto const& [surface, plane, profile, crease_angle_rad] = rule;
  pass(to, surface);
  pass(to, crease_angle_rad);
  to.number(plane.has_value());
  if (plane) {
    pass(to, plane->first);
    pass(to, plane->second);
  }
  to.number(std::uint64_t(profile.size()));
  for (auto const& [axial, radius] : profile) {
    pass(to, axial);
    pass(to, radius);
  }
}

std::uint64_t structure_hash(Mesh const& mesh) {
  ByteWriter bytes;
  bytes.number(std::uint64_t(mesh.zones.size()));
  for (Zone const& zone : mesh.zones) pass(bytes, zone);
  bytes.number(std::uint64_t(mesh.patches.size()));
  for (Patch const& patch : mesh.patches) pass(bytes, patch);
  for (Interface1to1 const& interface : mesh.interfaces) add(bytes, interface);
  return detail::hash64(bytes.bytes());
}

std::uint64_t coordinates_hash(Coordinates const& x) {
  detail::Hash64 hash;
  for (Coordinates::View const& component : {x.x, x.y, x.z}) {
    std::span<double const> const values(component.data(), component.extent(0));
    if constexpr (std::endian::native == std::endian::little) {
      hash.add(std::as_bytes(values));
    } else {
      for (double const v : values) {
        ByteWriter bytes;
        bytes.number(v);
        hash.add(bytes.bytes());
      }
    }
  }
  return hash.value();
}

std::uint64_t rules_hash(Motion const& motion) {
  ByteWriter bytes;
  pass(bytes, motion.axis);
  pass(bytes, motion.strict);
  for (MotionRule const& rule : motion.rules) {
    pass(bytes, rule.patches);
    pass(bytes, rule.rank);
    std::string const name(rule_name(rule.rule));
    pass(bytes, name);
    std::visit([&](auto const& r) { add(bytes, r); }, rule.rule);
  }
  return detail::hash64(bytes.bytes());
}

}  // namespace

PlanKey plan_key(Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  PlanKey key;
  key.structure = structure_hash(mesh);
  key.coordinates = coordinates_hash(mesh.coordinates);
  key.rules = rules_hash(motion);
  ByteWriter bytes;
  pass(bytes, options);
  key.options = detail::hash64(bytes.bytes());
  key.n_nodes = mesh.n_nodes();
  return key;
}

}  // namespace gridmorph
