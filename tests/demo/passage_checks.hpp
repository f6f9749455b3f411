// What the tests of the demo passage share. Formulas are written out here again, apart from the generator's.
#pragma once

#include <generators/passage.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace passage_checks {

using namespace gridmorph;

inline PassageOptions small(Index nodes = 20'000) {
  PassageOptions o;
  o.nodes = nodes;
  return o;
}

/// A machine about a skew axis, away from the origin.
inline RigidTransform skew_placement() {
  RigidTransform t = rotation_about({0, 0, 0}, {1, 2, -0.5}, 1.1);
  t.translation = {0.3, -0.2, 1.7};
  return t;
}

inline double end_wall_radius(EndWall const& w, double axial, PassageOptions const& o) {
  double const t = (axial - o.inlet) / (o.outlet - o.inlet);
  double const smooth = 3 * std::pow(t, 2) - 2 * std::pow(t, 3);
  return w.inlet_radius + (w.outlet_radius - w.inlet_radius) * ((1 - w.curving) * t + w.curving * smooth) +
         16 * w.bulge * std::pow(t, 2) * std::pow(1 - t, 2);
}

/// Span fraction and developed coordinates (axial, R theta) of a point of the machine frame.
struct Developed {
  double span, x, y;
};

inline Developed develop(PassageOptions const& o, Vec3 const& p) {
  double const r = std::sqrt(p.y * p.y + p.z * p.z);
  double const hub = end_wall_radius(o.hub, p.x, o), casing = end_wall_radius(o.casing, p.x, o);
  double const span = (r - hub) / (casing - hub);
  double const radius = end_wall_radius(o.hub, 0, o) * (1 - span) + end_wall_radius(o.casing, 0, o) * span;
  return {span, p.x, radius * std::atan2(p.z, p.y)};
}

inline void for_each_node(IndexRange const& r, std::function<void(Index3 const&)> const& f) {
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) f({i, j, k});
}

inline Vec3 node(Mesh const& mesh, int zone, Index3 const& p) { return mesh.coordinates[mesh.zones[zone].node(p)]; }

inline int zone_named(Mesh const& mesh, std::string const& name) {
  for (int z = 0; z < int(mesh.zones.size()); ++z)
    if (mesh.zones[z].name == name) return z;
  return -1;
}

}  // namespace passage_checks
