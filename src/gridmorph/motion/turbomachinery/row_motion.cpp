#include <gridmorph/motion/turbomachinery/row_motion.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

std::vector<std::string> names_of_blades(Boundary const& boundary, std::vector<int> const& patches) {
  std::set<std::string> names;
  for (int const p : patches) {
    Patch const& patch = boundary.patches()[p];
    names.insert(patch.families.empty() ? patch.name : patch.families.front());
  }
  return {names.begin(), names.end()};
}

std::vector<MeridionalPoint> meridional_points(Boundary const& boundary, CylindricalFrame const& frame,
                                               std::vector<int> const& patches) {
  std::vector<MeridionalPoint> out;
  for (Vec3 const& p : boundary.points(patches)) out.push_back(frame.meridional(p));
  return out;
}

/// Zones that hold the blade or hang together with those by node-to-node interfaces.
std::vector<bool> zones_of_row(Boundary const& boundary, std::vector<int> const& blades) {
  DisjointSets<int> rows(boundary.zones().size());
  for (AnyConnection const& i : boundary.connections()) rows.join(i.zone, i.donor_zone);
  std::set<int> roots;
  for (int p : blades) roots.insert(rows.root(boundary.patches()[p].zone));
  std::vector<bool> in_row(boundary.zones().size());
  for (std::size_t z = 0; z < in_row.size(); ++z) in_row[z] = roots.contains(rows.root(int(z)));
  return in_row;
}

std::vector<int> end_walls_of_row(Boundary const& boundary, SlipSurfaces const& surfaces,
                                  std::vector<bool> const& in_row) {
  std::set<int> found;
  for (std::size_t p = 0; p < boundary.patches().size(); ++p)
    if (int const s = surfaces.of_patch[p];
        s >= 0 && in_row[boundary.patches()[p].zone] && !ends_row(boundary.patches()[p].kind))
      found.insert(s);
  return {found.begin(), found.end()};
}

/// What there is to say of the sections of a blade.
void note_sections(Boundary const& boundary, std::vector<int> const& blades, CylindricalFrame const& frame,
                   Annulus const& annulus, BladeSurface const& surface, BladeSections const& sections,
                   std::vector<std::string>& notes) {
  constexpr double apart = 1e-3;  // chords, radians: more than blunt edges make of the two sides of one blade
  if (auto const spread = sections.edge_spread(); spread.length > apart || spread.angle_rad > apart)
    notes.push_back("blade " + quote_list(names_of_blades(boundary, blades)) + ": its " +
                    std::to_string(surface.contours.size()) +
                    " contours do not move alike: their edges differ from the mean, which inlet, exit and periodics "
                    "follow, by up to " +
                    to_text(spread.length, 3) + " chords and " + to_text(spread.angle_rad * 180 / std::numbers::pi, 3) +
                    " degrees about the axis; let `of` name the one blade to follow, or give copies of a blade motions "
                    "that are the same about the axis");
  auto const closed =
      std::count_if(surface.contours.begin(), surface.contours.end(), [](auto const& c) { return c.closed; });
  notes.push_back("blade " + boundary.describe_patch(blades.front()) + ": " + std::to_string(surface.lines.size()) +
                  " spanwise lines in " + std::to_string(closed) + " closed and " +
                  std::to_string(std::ptrdiff_t(surface.contours.size()) - closed) + " open contours; span fractions " +
                  std::to_string(sections.first_span()) + " to " + std::to_string(sections.last_span()) +
                  (annulus.has_walls() ? " between hub and case"
                   : frame.is_linear() ? " of its own extent, in a linear cascade"
                   : frame.is_plane()  ? " across a plane"
                                       : " of its own radii") +
                  (annulus.turns()    ? ", along the flow path "
                   : frame.is_plane() ? ", radii "
                                      : ", axial ") +
                  std::to_string(sections.most_upstream()) + " to " + std::to_string(sections.most_downstream()));
}

/// Directions of the translations among the periodic connections of the zones, none twice; `followers`: of those alone
/// that follow a blade. Nothing when one of them turns.
std::optional<std::vector<Vec3>> pitch_directions(Boundary const& boundary, ResolvedMotion const& motion,
                                                  std::vector<bool> const& in_row, bool followers) {
  constexpr double no_turn = 1e-9, same = 1e-6;
  std::vector<Vec3> found;
  for (AnyConnection const& c : boundary.connections()) {
    if (!c.periodic || !in_row[c.zone]) continue;
    int const r = motion.interface[c.number].rule;
    if (followers && !(r >= 0 && std::holds_alternative<FollowRule>(motion.rules[r].rule))) continue;
    RigidTransform const t = boundary.transform(c.number);
    double turned = 0;
    for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      turned = std::max(turned, norm(t.rotation * e - e));
    if (turned > no_turn) return std::nullopt;
    if (!(norm(t.translation) > 0)) continue;
    Vec3 const d = (1 / norm(t.translation)) * t.translation;
    if (std::none_of(found.begin(), found.end(), [&](Vec3 const& other) { return norm(cross(d, other)) < same; }))
      found.push_back(d);
  }
  return found;
}

/// A direction or its opposite: that whose largest component is positive.
Vec3 upwards(Vec3 const& v) {
  Vec3 const size{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  double const largest = size.x >= size.y && size.x >= size.z ? v.x : (size.y >= size.z ? v.y : v.z);
  return largest < 0 ? -v : v;
}

/// Whether the row is in a plane across a direction (unit): of a plane mesh, or one cell thick, so that its nodes are
/// on two planes.
bool lies_across(Boundary const& boundary, std::vector<bool> const& in_row, Vec3 const& direction) {
  constexpr double parallel = 1e-6, flat = 1e-3;  // of the distance between the planes
  if (boundary.is_plane()) return norm(cross(boundary.across(), direction)) < parallel * norm(boundary.across());
  double low = inf, high = -inf;
  // Most rows soon show a node that is on neither plane, whatever heights are still to come.
  double const off = 1.001 * flat * boundary.size();
  auto const for_heights = [&](auto&& visit) {
    for (std::size_t z = 0; z < boundary.zones().size(); ++z)
      for (Index n = 0; in_row[z] && n < boundary.zones()[z].size(); ++n)
        if (!visit(dot(boundary.coordinates()[boundary.zones()[z].first_node + n], direction))) return false;
    return true;
  };
  bool const may = for_heights([&](double h) {
    low = std::min(low, h);
    high = std::max(high, h);
    return h - low <= off || high - h <= off;
  });
  return may && for_heights([&](double h) { return std::min(h - low, high - h) <= flat * (high - low); });
}

}  // namespace

CylindricalFrame frame_of_row(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& blades) {
  std::vector<bool> const in_row = zones_of_row(boundary, blades);
  auto directions = pitch_directions(boundary, motion, in_row, false);
  if (directions && directions->size() > 1) directions = pitch_directions(boundary, motion, in_row, true);
  CylindricalFrame const about_axis(motion.axis);
  if (!directions || directions->empty())
    return lies_across(boundary, in_row, about_axis.direction()) ? CylindricalFrame::in_plane(motion.axis) : about_axis;
  if (directions->size() > 1)
    throw MotionError(
        "the periodic sides of the row are apart in several directions; let the rule follow name those between blades");
  // Which way it counts shall not depend on which side the file names first.
  Vec3 const pitch = upwards(directions->front());
  // The plane leaves one way across the pitch.
  if (lies_across(boundary, in_row, about_axis.direction()))
    return {Axis{motion.axis.origin, upwards(cross(pitch, about_axis.direction()))}, pitch};
  constexpr double across = 1e-3;
  if (std::abs(dot(pitch, about_axis.direction())) > across)
    throw MotionError(
        "the periodic sides of the row are apart by a translation, so that it is a linear cascade, but not across the "
        "axis; give "
        "[mesh] an axis along the flow, across the pitch (" +
        std::to_string(pitch.x) + ", " + std::to_string(pitch.y) + ", " + std::to_string(pitch.z) + ")");
  return {motion.axis, pitch - dot(pitch, about_axis.direction()) * about_axis.direction()};
}

std::vector<RigidTransform> periodic_transforms_of_row(Boundary const& boundary, std::vector<int> const& blades) {
  std::vector<bool> const in_row = zones_of_row(boundary, blades);
  std::vector<RigidTransform> out;
  for (AnyConnection const& connection : boundary.connections())
    if (connection.periodic && in_row[connection.zone]) out.push_back(boundary.transform(connection.number));
  return out;
}

Annulus annulus_of_row(Boundary const& boundary, SlipSurfaces const& surfaces, CylindricalFrame const& frame,
                       std::vector<int> const& blades) {
  // Circles in a plane are ends of a row there, never its hub or case.
  if (frame.is_plane()) return {surfaces, {}, meridional_points(boundary, frame, blades)};
  std::vector<bool> const in_row = zones_of_row(boundary, blades);
  return {surfaces, end_walls_of_row(boundary, surfaces, in_row), meridional_points(boundary, frame, blades),
          [&] { return walls_of_row(boundary, surfaces, in_row, frame); }};
}

RowMotion::Row::Row(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& of,
                    SlipSurfaces const& surfaces, std::vector<std::string>& notes)
    : blades(of),
      frame(frame_of_row(boundary, motion, blades)),
      zones(zones_of_row(boundary, blades)),
      annulus(annulus_of_row(boundary, surfaces, frame, blades)),
      blade(stitched(boundary, blades, notes)) {}

RowMotion::Blade RowMotion::Row::stitched(Boundary const& boundary, std::vector<int> const& patches,
                                          std::vector<std::string>& notes) const {
  BladeInput const input{frame, [this](MeridionalPoint const& p) { return annulus.position(p); },
                         [this](MeridionalPoint const& p) { return annulus.height(p); },
                         [this](Vec3 const& p) { return annulus.along(frame.meridional(p)); }};
  Blade out{patches, stitch_blade(boundary, patches, input, notes)};
  if (int const left_out = leave_out_splitters(out.surface); left_out > 0)
    notes.push_back("blade " + boundary.describe_patch(patches.front()) + ": " + std::to_string(left_out) +
                    " contours of splitter blades are left out; inlet, exit and periodics follow the main blade");
  return out;
}

BladeSections RowMotion::Row::sections(Boundary const& boundary, Blade const& of,
                                       PatchDisplacement const& displacement) const {
  // Across the flow, what counts is how far the blade departs from keeping its span fraction.
  auto const motion = [this](Vec3 const& point, Vec3 const& u) {
    return annulus.components(frame.meridional(point), frame.motion(point, u));
  };
  return {of.surface, motions_of(of.surface, boundary, of.patches, {motion, displacement})};
}

RowMotion::RowMotion(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& blades,
                     SlipSurfaces const& surfaces, PatchDisplacement const& displacement,
                     std::vector<std::string>& notes) {
  auto const row = std::make_shared<Row>(boundary, motion, blades, surfaces, notes);
  sections_ = row->sections(boundary, row->blade, displacement);
  note_sections(boundary, blades, row->frame, row->annulus, row->blade.surface, *sections_, notes);
  row->middle = 0.5 * (sections_->most_upstream() + sections_->most_downstream());
  for (int const side : {-1, +1}) row->ends[side < 0 ? 0 : 1] = row->find_end(boundary, motion, *sections_, side);
  row_ = row;
  move_ends(boundary, displacement);
}

RowMotion::RowMotion(RowMotion const& other, Boundary const& boundary, PatchDisplacement const& displacement)
    : row_(other.row_), sections_(row_->sections(boundary, row_->blade, displacement)) {
  move_ends(boundary, displacement);
}

void RowMotion::move_ends(Boundary const& boundary, PatchDisplacement const& displacement) {
  for (std::size_t e = 0; e < 2; ++e)
    if (auto const& blade = row_->ends[e].slides_with) slides_with_[e] = row_->sections(boundary, *blade, displacement);
}

bool RowMotion::Row::has(Boundary const& boundary, BladeSections const& sections,
                         std::vector<int> const& others) const {
  if (std::any_of(blades.begin(), blades.end(),
                  [&](int p) { return std::binary_search(others.begin(), others.end(), p); }))
    return true;
  if (!std::all_of(others.begin(), others.end(), [&](int p) { return zones[boundary.patches()[p].zone]; }))
    return false;
  double lo = inf, hi = -inf;
  for (MeridionalPoint const& p : meridional_points(boundary, frame, others)) {
    double const m = annulus.along(p);
    lo = std::min(lo, m);
    hi = std::max(hi, m);
  }
  return lo < sections.most_downstream() && hi > sections.most_upstream();
}

RowMotion::End RowMotion::Row::find_end(Boundary const& boundary, ResolvedMotion const& motion,
                                        BladeSections const& sections, int side) const {
  double const edge = side < 0 ? sections.most_upstream() : sections.most_downstream();
  auto const beyond = [&](std::vector<MeridionalPoint> const& points, double limit) {
    return std::all_of(points.begin(), points.end(),
                       [&](auto const& p) { return side * (annulus.along(p) - limit) > 0; });
  };

  std::vector<MeridionalPoint> sliding, others;
  int first_sliding = -1;
  for (std::size_t p = 0; p < boundary.patches().size(); ++p) {
    Patch const& patch = boundary.patches()[p];
    auto const* slide = std::get_if<CircumferentialSlideRule>(&motion.patch_rule(int(p)));
    if (slide != nullptr && has(boundary, sections, boundary.select_patches(slide->of))) {
      auto const points = meridional_points(boundary, frame, {int(p)});
      if (beyond(points, middle)) {
        sliding.insert(sliding.end(), points.begin(), points.end());
        if (first_sliding < 0) first_sliding = int(p);
      } else if (std::any_of(points.begin(), points.end(),
                             [&](auto const& q) { return side * (annulus.along(q) - middle) > 0; })) {
        throw MotionError("patch " + boundary.describe_patch(int(p)) +
                          " has the rule circumferential-slide but lies beside the blade's "
                          "mid-chord at " +
                          std::string(annulus.turns()    ? "flow path length "
                                      : frame.is_plane() ? "radius "
                                                         : "axial position ") +
                          std::to_string(middle) + "; only patches upstream or downstream of it can slide");
      }
    } else if (zones[patch.zone] && (patch.kind != PatchKind::wall && patch.kind != PatchKind::symmetry &&
                                     patch.kind != PatchKind::degenerate && patch.kind != PatchKind::region)) {
      auto const points = meridional_points(boundary, frame, {int(p)});
      if (beyond(points, edge)) others.insert(others.end(), points.begin(), points.end());
    }
  }

  End end;
  end.slides = first_sliding >= 0;
  if (end.slides) {
    auto const with = boundary.select_patches(std::get<CircumferentialSlideRule>(motion.patch_rule(first_sliding)).of);
    std::vector<std::string> known;  // the slide's own row says all this
    if (with != blades) end.slides_with = stitched(boundary, with, known);
  }
  std::vector<std::pair<double, double>> nodes;
  for (MeridionalPoint const& p : end.slides ? sliding : others) {
    FlowPosition const at = annulus.position(p);
    nodes.emplace_back(at.h, at.m);
  }
  try {
    if (!nodes.empty()) end.m_of_span = RevolutionProfile::from_points(std::move(nodes));
  } catch (MotionError const& e) {
    // An end that does not move may have any shape: the taper then ends at the outermost position.
    if (end.slides)
      throw MotionError(
          "patch " + boundary.describe_patch(first_sliding) +
          " has the rule circumferential-slide, but its position along the flow (its axial position, where "
          "that is axial) is not a function of the span fraction (here called axial position, and its "
          "position along the flow radius): " +
          e.what());
  }
  if (!end.m_of_span) end.m = outermost(boundary, side);
  return end;
}

double RowMotion::Row::outermost(Boundary const& boundary, int side) const {
  double m = -side * inf;
  for (std::size_t z = 0; z < boundary.zones().size(); ++z) {
    if (!zones[z]) continue;
    Zone const& zone = boundary.zones()[z];
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      double const here = annulus.along(frame.meridional(boundary.coordinates()[n]));
      m = side < 0 ? std::min(m, here) : std::max(m, here);
    }
  }
  return m;
}

CylindricalMotion RowMotion::taper(int side, FlowPosition const& at, double edge_m, double chord_fraction) const {
  End const& end = row_->ends[std::size_t(side)];
  CylindricalMotion const edge = sections_->motion(at.h, chord_fraction);
  // Nodes of the end itself scatter about its fitted shape by `deviation`: within it, they are at the end.
  double const margin = end.m_of_span ? end.m_of_span->deviation : 0;
  double const x = end.at(at.h);
  double const length = std::abs(edge_m - x) - margin;
  double const w = length > 0 ? std::clamp((std::abs(at.m - x) - margin) / length, 0.0, 1.0) : 1.0;
  bool const outside = (at.m - x) * (edge_m - x) <= 0;
  double const share = outside ? 0.0 : w;
  double const end_angle = !end.slides       ? 0
                           : end.slides_with ? slides_with_[std::size_t(side)]->motion(at.h, chord_fraction).angle_rad
                                             : edge.angle_rad;
  return {share * edge.axial, share * edge.radial, end_angle + share * (edge.angle_rad - end_angle)};
}

double RowMotion::share_over_gap(double h) const {
  constexpr double gap = 1e-4;  // in span: what a blade that reaches its walls may lack
  double const first = sections_->lowest_span(), last = sections_->highest_span();
  if (!row_->annulus.has_walls()) return 1;
  if (h > last && 1 - last > gap) return std::max(1 - h, 0.0) / (1 - last);
  if (h < first && first > gap) return std::max(h, 0.0) / first;
  return 1;
}

CylindricalMotion RowMotion::follow_motion(FlowPosition const& at) const {
  CylindricalMotion out = along_camber(at);
  out.radial *= share_over_gap(at.h);
  return out;
}

CylindricalMotion RowMotion::along_camber(FlowPosition const& at) const {
  double const leading = sections_->leading(at.h), trailing = sections_->trailing(at.h);
  if (at.m < leading) return taper(0, at, leading, 0);
  if (at.m > trailing) return taper(1, at, trailing, 1);
  return sections_->motion(at.h, (at.m - leading) / (trailing - leading));
}

bool RowMotion::gives_way_to(int patch) const {
  return sections_->sliced() && std::binary_search(row_->blades.begin(), row_->blades.end(), patch);
}

bool RowMotion::is_upstream(Vec3 const& point) const {
  return row_->annulus.position(row_->frame.meridional(point)).m < row_->middle;
}

Vec3 RowMotion::slide(Vec3 const& point) const {
  FlowPosition const at = row_->annulus.position(row_->frame.meridional(point));
  CylindricalMotion const edge = sections_->motion(at.h, at.m < row_->middle ? 0 : 1);
  return row_->frame.displacement(point, {0, 0, edge.angle_rad});
}

Vec3 RowMotion::follow(Vec3 const& point) const {
  MeridionalPoint const p = row_->frame.meridional(point);
  return row_->frame.displacement(point, row_->annulus.motion(p, follow_motion(row_->annulus.position(p))));
}

}  // namespace gridmorph
