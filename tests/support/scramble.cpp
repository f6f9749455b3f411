#include "support/scramble.hpp"

#include "support/mesh_builders.hpp"
#include "support/random.hpp"

#include <algorithm>
#include <numeric>

namespace gridmorph::test {
namespace {

/// A part of an original zone, turned: `turned` maps a node index of the zone to one of the new zone.
struct Part {
  int old_zone = 0;
  IndexRange box;
  IndexMap turned;
  int number = 0;
};

/// What two boxes have in common where it is a face.
std::optional<IndexRange> common_face(IndexRange const& a, IndexRange const& b) {
  IndexRange const r = intersection(a, b);
  int flat = 0;
  for (int d = 0; d < 3; ++d) flat += r.extent(d) == 1;
  return r.size() > 0 && flat == 1 ? std::optional(r) : std::nullopt;
}

IndexMap turn(IndexRange const& box, Orientation const& o) {
  IndexMap m{o, box.begin, {0, 0, 0}};
  for (int a = 0; a < 3; ++a)
    if (o.sign[a] < 0) m.donor_origin[o.axis[a]] = box.extent(a) - 1;
  return m;
}

std::vector<std::vector<IndexRange>> cut(Mesh const& mesh, int cuts, Random& random) {
  std::vector<std::vector<IndexRange>> boxes;
  for (Zone const& z : mesh.zones) boxes.push_back({whole(z)});
  for (int n = 0; n < cuts; ++n) {
    int const z = random.below(int(mesh.zones.size())), axis = random.below(3);
    if (mesh.zones[z].extent[axis] < 3) continue;
    int const plane = 1 + random.below(mesh.zones[z].extent[axis] - 2);
    std::vector<IndexRange> now;
    for (IndexRange const& box : boxes[z]) {
      if (plane <= box.begin[axis] || plane >= box.end[axis] - 1) {
        now.push_back(box);
        continue;
      }
      IndexRange lower = box, upper = box;
      lower.end[axis] = plane + 1;
      upper.begin[axis] = plane;
      now.push_back(lower);
      now.push_back(upper);
    }
    boxes[z] = std::move(now);
  }
  return boxes;
}

Interface1to1 reversed(Interface1to1 face) {
  face.range = face.to_donor(face.range);
  std::swap(face.zone, face.donor_zone);
  face.to_donor = face.to_donor.inverse();
  if (face.periodic) {
    Periodic& p = *face.periodic;
    p.rotation_angle_rad = -p.rotation_angle_rad;
    p.translation = -p.translation;
    p.declared = p.declared.inverse();
  }
  return face;
}

bool is_other_side(Interface1to1 const& a, Interface1to1 const& b) {
  return a.zone == b.donor_zone && a.donor_zone == b.zone && a.to_donor(a.range) == b.range &&
         b.to_donor(b.range) == a.range;
}

/// Each connection once: files mostly store them twice.
std::vector<Interface1to1> one_sided(std::vector<Interface1to1> const& all) {
  std::vector<Interface1to1> once;
  for (Interface1to1 const& face : all)
    if (std::none_of(once.begin(), once.end(), [&](auto const& other) { return is_other_side(face, other); }))
      once.push_back(face);
  return once;
}

}  // namespace

std::vector<Orientation> all_orientations() {
  std::vector<Orientation> list;
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (int s = 0; s < 8; ++s) list.push_back({axis, {s & 1 ? -1 : 1, s & 2 ? -1 : 1, s & 4 ? -1 : 1}});
  } while (std::next_permutation(axis.begin(), axis.end()));
  return list;
}

ScrambledMesh scramble(Mesh const& mesh, Scramble const& what) {
  Random random(what.seed);
  auto const orientations = all_orientations();
  std::vector<Part> parts;
  auto const boxes = cut(mesh, what.cuts, random);
  for (int z = 0; z < int(boxes.size()); ++z)
    for (IndexRange const& box : boxes[z])
      parts.push_back({z, box, turn(box, what.reorient ? orientations[random.below(48)] : Orientation{}), 0});
  if (what.reorder) random.shuffle(parts);

  ScrambledMesh out;
  out.mesh.source = mesh.source + " scrambled with seed " + std::to_string(what.seed);
  out.mesh.families = mesh.families;
  for (Part& part : parts) {
    IndexRange const box = part.turned(part.box);
    part.number = out.mesh.add_zone("new" + std::to_string(out.mesh.zones.size() + 1), box.end);
    out.mesh.zones.back().single_precision = mesh.zones[part.old_zone].single_precision;
    IndexMap const back = part.turned.inverse();
    Zone const& zone = out.mesh.zones.back();
    for (Index n = 0; n < zone.size(); ++n)
      out.old_node.push_back(mesh.zones[part.old_zone].node(back(zone.index(zone.first_node + n))));
  }
  out.mesh.coordinates = Coordinates(out.mesh.n_nodes());
  for (Index n = 0; n < out.mesh.n_nodes(); ++n) out.mesh.coordinates.set(n, mesh.coordinates[out.old_node[n]]);

  for (Patch const& patch : mesh.patches)
    for (Part const& part : parts)
      if (part.old_zone == patch.zone)
        if (auto const common = common_face(patch.range, part.box)) {
          Patch p = patch;
          p.name += "_" + std::to_string(part.number);
          if (p.families.empty()) p.families = {patch.name};
          p.zone = part.number;
          p.range = part.turned(*common);
          out.mesh.patches.push_back(std::move(p));
        }

  std::vector<Interface1to1> faces;
  auto connect = [&](Interface1to1 const& face, Part const& own, Part const& donor, IndexRange const& range) {
    Interface1to1 f = face;
    f.name += "_" + std::to_string(faces.size() + 1);
    f.zone = own.number;
    f.donor_zone = donor.number;
    f.range = own.turned(range);
    f.to_donor = own.turned.inverse().then(face.to_donor).then(donor.turned);
    faces.push_back(std::move(f));
  };
  for (Interface1to1 const& face : one_sided(mesh.interfaces))
    for (Part const& own : parts)
      for (Part const& donor : parts) {
        if (own.old_zone != face.zone || donor.old_zone != face.donor_zone) continue;
        auto const mine = common_face(face.range, own.box);
        if (!mine) continue;
        if (auto const theirs = common_face(face.to_donor(*mine), donor.box))
          connect(face, own, donor, face.to_donor.inverse()(*theirs));
      }
  Interface1to1 plain;
  plain.name = "cut";
  for (Part const& own : parts)
    for (Part const& donor : parts)
      for (int axis = 0; axis < 3; ++axis)
        if (own.old_zone == donor.old_zone)
          if (auto const common = common_face(face_of(own.box, axis, 1), face_of(donor.box, axis, 0)))
            connect(plain, own, donor, *common);

  if (what.reorder) random.shuffle(out.mesh.patches);
  for (Interface1to1 const& face : faces) {
    int const sides = what.resides ? random.below(3) : 2;
    if (sides != 0) out.mesh.interfaces.push_back(face);
    if (sides != 1) out.mesh.interfaces.push_back(reversed(face));
    if (sides == 2) out.mesh.interfaces.back().name += "_back";
  }
  if (what.reorder) random.shuffle(out.mesh.interfaces);
  return out;
}

std::vector<std::string> flaws(Mesh const& mesh, double tolerance) {
  std::vector<std::string> found;
  // Times each cell of each zone face is covered, by zone, axis and side; cells numbered as nodes of their lower
  // corner.
  std::vector<std::vector<int>> covered(6 * mesh.zones.size());
  for (std::size_t z = 0; z < mesh.zones.size(); ++z)
    for (int f = 0; f < 6; ++f) covered[6 * z + f].assign(mesh.zones[z].size(), 0);
  auto each = [&](int zone, IndexRange const& r, auto&& visit) {
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) visit(Index3{i, j, k}, mesh.zones[zone].node({i, j, k}));
  };
  auto cover = [&](int zone, IndexRange range, int add) {
    int const axis = face_axis(range);
    int const side = range.begin[axis] == 0 ? 0 : 1;
    for (int a = 0; a < 3; ++a)
      if (a != axis) --range.end[a];
    each(zone, range,
         [&](Index3 const&, Index n) { covered[6 * zone + 2 * axis + side][n - mesh.zones[zone].first_node] += add; });
  };
  for (Patch const& p : mesh.patches) cover(p.zone, p.range, 1);
  for (Interface1to1 const& face : one_sided(mesh.interfaces)) {
    cover(face.zone, face.range, 1);
    cover(face.donor_zone, face.to_donor(face.range), 1);
  }
  for (std::size_t z = 0; z < mesh.zones.size(); ++z)
    for (int f = 0; f < 6; ++f) {
      IndexRange cells = face_of(whole(mesh.zones[z]), f / 2, f % 2);
      for (int a = 0; a < 3; ++a)
        if (a != f / 2) --cells.end[a];
      int wrong = 0;
      each(int(z), cells,
           [&](Index3 const&, Index n) { wrong += covered[6 * z + f][n - mesh.zones[z].first_node] != 1; });
      if (wrong > 0)
        found.push_back(std::to_string(wrong) + " cells of " + mesh.zones[z].name + " " +
                        std::string(face_name(f / 2, f % 2)) + " are not covered once");
    }
  for (Interface1to1 const& face : mesh.interfaces) {
    double worst = 0;
    each(face.zone, face.range, [&](Index3 const& p, Index n) {
      Vec3 const own = face.periodic ? face.periodic->declared(mesh.coordinates[n]) : mesh.coordinates[n];
      worst = std::max(worst, distance(own, mesh.coordinates[mesh.zones[face.donor_zone].node(face.to_donor(p))]));
    });
    if (!(worst <= tolerance)) found.push_back("interface " + face.name + " is open by " + std::to_string(worst));
  }
  return found;
}

}  // namespace gridmorph::test
