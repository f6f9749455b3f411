#include <gridmorph/fillet/root_sections.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr double sharpest = 0.349, flattest = 2.618;  ///< 20 and 150 degrees
constexpr double reach_contacts = 3;      ///< of the contacts' distances from the corner, within which walls change
constexpr double least_contacts = 1.25;   ///< that have to be left
constexpr double steepest = 0.5;          ///< change of the reach along the corner
constexpr double filled_already = 0.436;  ///< 25 degrees, by which walls may turn within their reach
constexpr double same_side = 0.3;         ///< cosine between normals of one side of a blade

/// The direction of the parabola through a point and those beside it; towards the next one at an end.
Vec3 tangent(RootLine const& line, std::size_t k, std::vector<Vec3> const& at) {
  std::size_t const n = line.places.size();
  bool const first = k == 0 && !line.closed, last = k + 1 == n && !line.closed;
  Vec3 const before = at[k] - at[(k + n - 1) % n], behind = at[(k + 1) % n] - at[k];
  if (first) return unit(behind);
  if (last) return unit(before);
  return unit(norm(behind) * unit(before) + norm(before) * unit(behind));
}

/// The angle between walls with these normals, unit.
double angle_of(Vec3 const& a, Vec3 const& b) { return std::numbers::pi - std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

Vec3 across(Vec3 const& v, Vec3 const& along) { return unit(v - dot(v, along) * along); }

/// The direction along a wall away from the other one.
Vec3 up(Vec3 const& along, Vec3 const& own_normal, Vec3 const& other_normal) {
  Vec3 const v = unit(cross(along, own_normal));
  return dot(v, other_normal) < 0 ? -v : v;
}

/// How the blade's normal turns along the line, per length.
std::vector<double> turning_of(WallEdges const& edges, RootLine const& line, std::vector<Vec3> const& at) {
  std::size_t const n = at.size();
  std::vector<double> out;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t const a = line.closed ? (k + n - 1) % n : k - std::min<std::size_t>(k, 1);
    std::size_t const b = line.closed ? (k + 1) % n : std::min(k + 1, n - 1);
    Vec3 const t = tangent(line, k, at), turn = edges.normal(0, line.places[b]) - edges.normal(0, line.places[a]);
    out.push_back(dot(turn, t) / (distance(at[a], at[k]) + distance(at[k], at[b])));
  }
  return out;
}

/// How far along the line the blade's surface goes per length up the blade, where its normal stays across the line:
/// edges of blades lean. `turning`: of the normal along the line [1/length]. Nothing to go by where the blade is flat
/// along the line.
double sweep(FacetSurface const& blade, RootSection const& s, Vec3 const& up, Vec3 const& normal, double turning,
             double height) {
  constexpr int steps = 8;
  double const flat = 1 / (4 * height), way = turning / (turning * turning + flat * flat);
  double lean = 0;
  for (int k = 1; k <= steps; ++k) {
    double const h = height * k / steps;
    kernels::FacetFoot const foot = blade.closest_point(s.root + h * (up + lean * s.along));
    Vec3 const n = dot(foot.normal, normal) < 0 ? -foot.normal : foot.normal;
    lean += -way * dot(n, s.along) / h;
    lean = std::clamp(lean, -1.0, 1.0);
  }
  return lean;
}

}  // namespace

double off_wall(kernels::FacetFoot const& foot, Vec3 const& p) {
  return foot.place == kernels::FacetFoot::Place::rim ? std::abs(dot(p - foot.point, foot.normal)) : foot.distance;
}

std::array<double, 2> off_walls(std::array<FacetSurface const*, 2> const& walls, Vec3 const& p) {
  return {off_wall(walls[0]->closest_point(p), p), off_wall(walls[1]->closest_point(p), p)};
}

RootSections::RootSections(JoinedElements const& elements, BoundaryFacePatches const& face_patches,
                           WallEdges const& edges, std::vector<RootLine> const& lines, std::vector<Mitre> const& mitres,
                           std::vector<std::vector<double>> const& radii, FacetSurface const& blade,
                           FacetSurface const& end_wall)
    : lines_(lines) {
  std::array<FacetSurface const*, 2> const walls{&blade, &end_wall};
  double const small = 1e-9 * blade.size();
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> edge_of_segment;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    RootLine const& line = lines[l];
    std::vector<Vec3> at;
    for (Index32 const p : line.places) at.push_back(elements.position(p));
    double const largest = *std::max_element(radii[l].begin(), radii[l].end());
    auto const turning = turning_of(edges, line, at);
    sections_.emplace_back();
    for (std::size_t k = 0; k < line.places.size(); ++k) {
      RootSection s;
      s.root = at[k];
      s.along = tangent(line, k, at);
      std::array<Vec3, 2> normal{across(edges.normal(0, line.places[k]), s.along),
                                 across(edges.normal(1, line.places[k]), s.along)};
      s.blade_normal = normal[0];
      double const wanted = radii[l][k];
      std::array<Vec3, 2> ups{up(s.along, normal[0], normal[1]), up(s.along, normal[1], normal[0])};
      double const half = std::acos(std::clamp(dot(ups[0], ups[1]), -1.0, 1.0)) / 2, height = wanted / std::tan(half);
      double const lean = wanted > small ? sweep(blade, s, ups[0], normal[0], turning[k], height) : 0;
      s.across = unit(s.along - lean * ups[0]);
      for (Vec3& n : normal) n = across(n, s.across);
      ups = {up(s.across, normal[0], normal[1]), up(s.across, normal[1], normal[0])};
      s.angle_rad = std::acos(std::clamp(dot(ups[0], ups[1]), -1.0, 1.0));
      if (s.angle_rad < sharpest || s.angle_rad > flattest)
        throw MotionError("the walls meet at an angle of " + to_text(s.angle_rad * 180 / std::numbers::pi, 3) +
                          " degrees at the corner's node " + to_text(s.root, 9) +
                          "; a fillet takes 20 to 150, and none that is there already");
      s.to_middle = -unit(normal[0] + normal[1]);
      double const length = std::max(1.2 * reach_contacts * largest / std::tan(half), 1e-3 * blade.size());
      for (std::size_t w = 0; w < 2; ++w)
        s.wall[w] = WallProfile(*walls[w], s.root, s.across, ups[w], normal[w], length);
      if (wanted > small) {
        double const far = std::min(reach_contacts * wanted / std::tan(s.angle_rad / 2), 0.95 * length);
        double const turned = s.angle_rad - angle_of(s.wall[0].at(far).normal, s.wall[1].at(far).normal);
        if (turned > filled_already)
          throw MotionError("the walls turn away from each other by " + to_text(turned * 180 / std::numbers::pi, 3) +
                            " degrees within " + to_text(far, 3) + " of the corner's node " + to_text(s.root, 9) +
                            ": there is a fillet already, and none can be laid over it; fill the mesh that has none");
        auto const circle = circle_between(s.wall[0], s.wall[1], wanted);
        if (!circle)
          throw MotionError("the fillet does not fit at the corner's node " + to_text(s.root, 9) +
                            ": no circle of its radius " + to_text(wanted, 6) +
                            " touches both walls there; give a smaller radius");
        s.radius = wanted;
        s.centre = circle->centre;
        s.to_middle = circle->to_middle;
        s.half_arc = wanted * circle->half_angle_rad;
        s.contact = circle->contact;
        s.reach = std::min(reach_contacts * std::max(s.contact[0], s.contact[1]), 0.95 * length);
      }
      std::vector<std::array<double, 2>> off;
      for (MitrePlace const& m : mitres[l].at[k]) {
        off.push_back(off_walls(walls, elements.position(m.place)));
        known_[m.place] = {{l, k, k, 0}, true};
      }
      s.mitre = MitreRelations(mitres[l].at[k], off, s.radius);
      if (!mitres[l].on_walls.empty())
        for (Index32 const p : mitres[l].on_walls[k]) known_[p] = {{l, k, k, 0}, false};
      points.push_back(s.root);
      sections_.back().push_back(std::move(s));
    }
    int const first = int(points.size() - line.places.size());
    for (std::size_t k = 0; k < line.n_edges(); ++k) {
      std::size_t const next = (k + 1) % line.places.size();
      segments_.push_back({l, k, next});
      edge_of_segment.push_back({first + int(k), first + int(next), first + int(next)});
    }
  }
  tree_ = TargetTree(std::move(points), std::move(edge_of_segment));
  for (auto const& line : sections_)
    for (RootSection const& s : line) largest_reach_ = std::max(largest_reach_, s.reach);
  limit_reach(elements, face_patches, edges, radii);
}

RootSections::Segment RootSections::next(Segment const& of, int step) const {
  RootLine const& line = lines_[of.line];
  auto const n = line.n_edges();
  std::size_t const k = of.first;
  if (!line.closed && ((step < 0 && k == 0) || (step > 0 && k + 1 == n))) return of;
  std::size_t const to = (k + n + std::size_t(step + int(n))) % n;
  return {of.line, to, (to + 1) % line.places.size()};
}

double RootSections::ahead(Vec3 const& p, std::size_t line, std::size_t section) const {
  RootSection const& s = sections_[line][section];
  return dot(p - s.root, s.across);
}

KnownPlace const* RootSections::known(Index32 place) const {
  auto const found = known_.find(place);
  return found == known_.end() ? nullptr : &found->second;
}

std::optional<SectionPlace> RootSections::find(Vec3 const& p, Vec3 const& blade_normal, double within) const {
  auto const nearest = nearest_section(p, {}, within);
  if (!nearest || blade_normal == Vec3{} || beyond_end(*nearest, p)) return nearest;
  return nearest_section(p, blade_normal, within);
}

bool RootSections::beyond_end(SectionPlace const& at, Vec3 const& p) const {
  RootLine const& line = lines_[at.line];
  if (line.closed) return false;
  return (at.first == 0 && at.share == 0 && ahead(p, at.line, 0) < 0) ||
         (at.second + 1 == line.places.size() && at.share == 1 && ahead(p, at.line, at.second) > 0);
}

std::optional<SectionPlace> RootSections::nearest_section(Vec3 const& p, Vec3 const& blade_normal,
                                                          double within) const {
  auto const same_way = [&](int k) {
    Segment const& s = segments_[k];
    auto const& line = sections_[s.line];
    return std::max(dot(blade_normal, line[s.first].blade_normal), dot(blade_normal, line[s.second].blade_normal)) >=
           same_side;
  };
  auto const hit = blade_normal == Vec3{} ? tree_.closest_within(p, within) : tree_.closest_of(p, same_way);
  if (hit.triangle < 0 || hit.distance >= within) return {};

  Segment at = segments_[hit.triangle];
  int last_step = 0;
  for (int n = 0; n < 64; ++n) {
    double const from = ahead(p, at.line, at.first), to = ahead(p, at.line, at.second);
    int const step = from < 0 ? -1 : to > 0 ? 1 : 0;
    if (step == 0) break;
    Segment const other = next(at, step);
    if (other.first == at.first || step == -last_step) break;
    last_step = step;
    at = other;
  }
  SectionPlace out{at.line, at.first, at.second, 0};
  RootSection const &a = sections_[at.line][at.first], &b = sections_[at.line][at.second];
  if (ahead(p, at.line, at.first) < 0) return out;
  if (ahead(p, at.line, at.second) > 0) {
    out.share = 1;
    return out;
  }
  double low = 0, high = 1;
  for (int n = 0; n < 50; ++n) {
    double const t = (low + high) / 2;
    Vec3 const root = a.root + t * (b.root - a.root), across = a.across + t * (b.across - a.across);
    (dot(p - root, across) >= 0 ? low : high) = t;
  }
  out.share = (low + high) / 2;
  return out;
}

void RootSections::limit_reach(JoinedElements const& elements, BoundaryFacePatches const& face_patches,
                               WallEdges const& edges, std::vector<std::vector<double>> const& radii) {
  Mesh const& mesh = elements.mesh();
  BoundaryFaces const& faces = elements.topology().boundary;
  auto const which = [&](Index f) {  // patch, or side of a connection
    int const patch = face_patches.patch[f];
    return patch >= 0 ? std::pair(0, patch) : std::pair(1, int(faces.connection[f]));
  };
  // A line may end on a boundary, which then lies across it.
  std::set<std::pair<int, int>> lines_end_on;
  for (RootLine const& line : lines_) {
    if (line.closed) continue;
    for (int const end : {0, 1})
      for (Index32 const f : faces_across_end(elements, edges, line, end)) lines_end_on.insert(which(f));
  }
  std::vector<std::vector<double>> room;
  for (auto const& line : sections_) room.emplace_back(line.size(), std::numeric_limits<double>::infinity());
  for (Index f = 0; f < faces.size(); ++f) {
    if (!is_foreign(elements, edges, f) || lines_end_on.contains(which(f))) continue;
    for (Index32 const n : faces.nodes[f]) {
      auto const at = find(mesh.coordinates[n], {}, 1.1 * largest_reach_);
      if (!at) continue;
      for (std::size_t const k : {at->first, at->second})
        room[at->line][k] = std::min(room[at->line][k], distance(mesh.coordinates[n], sections_[at->line][k].root));
    }
  }
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (std::size_t m = 0; m < lines_.size(); ++m) {
      auto const &own = lines_[l].places, &other = lines_[m].places;
      if (l == m || own.front() == other.front() || own.front() == other.back() || own.back() == other.front() ||
          own.back() == other.back())
        continue;
      for (std::size_t k = 0; k < own.size(); ++k)
        for (RootSection const& there : sections_[m])
          room[l][k] = std::min(room[l][k], distance(sections_[l][k].root, there.root) / 2);
    }
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    auto& line = sections_[l];
    for (std::size_t k = 0; k < line.size(); ++k) line[k].reach = std::min(line[k].reach, 0.98 * room[l][k]);
    std::size_t const n = line.size(), edges_in_line = lines_[l].n_edges();
    for (int round = 0; round < 2; ++round)
      for (std::size_t e = 0; e < 2 * edges_in_line; ++e) {
        std::size_t const k = e < edges_in_line ? e : 2 * edges_in_line - 1 - e;
        RootSection &a = line[k], &b = line[(k + 1) % n];
        double const most = steepest * distance(a.root, b.root);
        if (a.radius > 0) a.reach = std::min(a.reach, b.reach + most);
        if (b.radius > 0) b.reach = std::min(b.reach, a.reach + most);
      }
    for (std::size_t k = 0; k < n; ++k) {
      RootSection const& s = line[k];
      double const needed = least_contacts * std::max(s.contact[0], s.contact[1]);
      if (s.radius > 0 && s.reach < needed)
        throw MotionError("the fillet does not fit at the corner's node " + to_text(s.root, 9) + ": its radius is " +
                          to_text(radii[l][k], 6) + " and needs " + to_text(needed, 3) +
                          " of both walls, of which there are " + to_text(s.reach, 3) +
                          " up to the next boundary; about " + to_text(0.97 * radii[l][k] * s.reach / needed, 3) +
                          " would do");
    }
  }
}

}  // namespace gridmorph
