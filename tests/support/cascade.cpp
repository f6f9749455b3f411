#include "support/cascade.hpp"

#include "support/mesh_builders.hpp"

#include <cmath>

namespace gridmorph::test {

Mesh cascade(double radius) {
  constexpr int before = 10, along = 14, behind = 10, spanwise = 9, across = 13;
  constexpr double pi = 3.14159265358979323846;
  MeshBuilder build("cascade");
  auto const place = [=](double x, double h, double z) -> Vec3 {
    double const y = cascade_span * h;
    if (radius == 0) return {x, y, z};
    return {x, (radius + y) * std::cos(z / radius), (radius + y) * std::sin(z / radius)};
  };
  int const zone = build.zone("passage", {before + along + behind + 1, spanwise, across}, [=](Index3 const& n) {
    double const h = double(n[1]) / (spanwise - 1), w = double(n[2]) / (across - 1);
    double const c = double(n[0] - before) / along;
    double const sweep = 0.1 * h, x = sweep + (c < 0   ? c * 1.4
                                               : c > 1 ? 1 + (c - 1) * 1.4
                                                       : 0.5 * (1 - std::cos(pi * c)));
    double const s = x - sweep, camber = 0.3 * std::sin(1.5 * s) + 0.1 * h * h;
    double const half = s > 0 && s < 1 ? 0.2 * s * (1 - s) : 0;
    return place(x, h, camber + half + w * (cascade_pitch - 2 * half));
  });
  IndexRange const all = whole(build.mesh().zones[zone]);
  build.patch("inlet", PatchKind::inflow, zone, 0, 0);
  build.patch("outlet", PatchKind::outflow, zone, 0, 1);
  build.patch("hub", PatchKind::wall, zone, 1, 0);
  build.patch("case", PatchKind::wall, zone, 1, 1);
  IndexRange lower = face_of(all, 2, 0), upper = face_of(all, 2, 1);
  auto const part = [](IndexRange range, int first, int last) {
    range.begin[0] = first;
    range.end[0] = last + 1;
    return range;
  };
  build.patch("blade", PatchKind::wall, zone, part(lower, before, before + along));
  build.patch("blade", PatchKind::wall, zone, part(upper, before, before + along));
  Periodic const pitch = radius == 0 ? periodic_translation({0, 0, cascade_pitch})
                                     : rotation({0, 0, 0}, {1, 0, 0}, cascade_pitch / radius);
  for (int const first : {0, before + along}) {
    int const last = first == 0 ? before : before + along + behind;
    build.join(zone, part(lower, first, last), zone, part(upper, first, last), {}, pitch);
  }
  return build.finish();
}

}  // namespace gridmorph::test
