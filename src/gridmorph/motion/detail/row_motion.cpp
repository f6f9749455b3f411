#include <gridmorph/motion/detail/row_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/detail/patch_points.hpp>
#include <gridmorph/motion/selectors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

std::vector<MeridionalPoint> meridional_points(Mesh const& mesh, CylindricalFrame const& frame,
                                               std::vector<int> const& patches) {
  std::vector<MeridionalPoint> out;
  for (Vec3 const& p : patch_points(mesh, patches)) out.push_back(frame.meridional(p));
  return out;
}

/// Zones that hold the blade or hang together with those by node-to-node interfaces.
std::vector<bool> zones_of_row(Mesh const& mesh, std::vector<int> const& blades) {
  std::vector<int> root(mesh.zones.size());
  std::iota(root.begin(), root.end(), 0);
  auto const find = [&](int z) {
    while (root[z] != z) z = root[z] = root[root[z]];
    return z;
  };
  for (Interface1to1 const& i : mesh.interfaces) root[find(i.zone)] = find(i.donor_zone);
  std::set<int> roots;
  for (int p : blades) roots.insert(find(mesh.patches[p].zone));
  std::vector<bool> in_row(mesh.zones.size());
  for (std::size_t z = 0; z < in_row.size(); ++z) in_row[z] = roots.contains(find(int(z)));
  return in_row;
}

std::vector<int> surfaces_of_row(Mesh const& mesh, SlipSurfaces const& surfaces, std::vector<bool> const& in_row) {
  std::set<int> found;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (int const s = surfaces.of_patch[p]; s >= 0 && in_row[mesh.patches[p].zone]) found.insert(s);
  return {found.begin(), found.end()};
}

BladeSections make_sections(Mesh const& mesh, std::vector<int> const& blades, CylindricalFrame const& frame,
                            Annulus const& annulus, RowMotion::PatchDisplacement const& displacement,
                            std::vector<std::string>& notes) {
  // Radially, what counts is how far the blade departs from keeping its span fraction.
  auto const motion = [&](Vec3 const& point, Vec3 const& u) {
    CylindricalMotion m = frame.motion(point, u);
    m.radial -= annulus.radius_change(frame.meridional(point), m.axial);
    return m;
  };
  BladeInput const input{frame, [&annulus](MeridionalPoint const& p) { return annulus.span(p); }, motion, displacement};
  BladeSurface const surface = stitch_blade(mesh, blades, input, notes);
  BladeSections sections(surface);
  auto const closed =
      std::count_if(surface.contours.begin(), surface.contours.end(), [](auto const& c) { return c.closed; });
  notes.push_back("blade " + describe_patch(mesh, mesh.patches[blades.front()]) + ": " +
                  std::to_string(surface.lines.size()) + " spanwise lines in " + std::to_string(closed) +
                  " closed and " + std::to_string(std::ptrdiff_t(surface.contours.size()) - closed) +
                  " open contours; span fractions " + std::to_string(sections.first_span()) + " to " +
                  std::to_string(sections.last_span()) +
                  (annulus.has_walls() ? " between hub and case" : " of its own radii") + ", axial " +
                  std::to_string(sections.most_upstream()) + " to " + std::to_string(sections.most_downstream()));
  return sections;
}

}  // namespace

Annulus::Annulus(SlipSurfaces const& surfaces, std::vector<int> const& candidates,
                 std::vector<MeridionalPoint> const& blade) {
  r_lo_ = inf;
  r_hi_ = -inf;
  for (MeridionalPoint const& p : blade) {
    r_lo_ = std::min(r_lo_, p.radius);
    r_hi_ = std::max(r_hi_, p.radius);
  }
  for (int s : candidates) {
    SlipSurface const& surface = surfaces.surfaces[s];
    if (surface.kind != SlipSurface::Kind::revolution) continue;
    // Most of the blade lies outside of the hub and inside of the case.
    auto const outside = std::count_if(blade.begin(), blade.end(),
                                       [&](MeridionalPoint const& p) { return p.radius > surface.profile(p.axial); });
    (2 * std::size_t(outside) > blade.size() ? inner_ : outer_).push_back(&surface.profile);
  }
  if (!has_walls() && !(r_hi_ > r_lo_))
    throw MotionError("the blade lies at one radius, " + std::to_string(r_lo_) +
                      ": it has no span; check the axis, or give hub and case "
                      "the rule slip on a surface of revolution");
}

RevolutionProfile const& Annulus::at(Profiles const& profiles, double axial) {
  auto const gap = [axial](RevolutionProfile const* p) {
    return std::max({p->knots.front().axial - axial, axial - p->knots.back().axial, 0.0});
  };
  return **std::min_element(profiles.begin(), profiles.end(),
                            [&](auto const* a, auto const* b) { return gap(a) < gap(b); });
}

double Annulus::span(MeridionalPoint const& p) const {
  double const inner = has_walls() ? at(inner_, p.axial)(p.axial) : r_lo_;
  double const outer = has_walls() ? at(outer_, p.axial)(p.axial) : r_hi_;
  if (!(outer > inner))
    throw MotionError("at axial position " + std::to_string(p.axial) + " the case (radius " + std::to_string(outer) +
                      ") is not outside of the hub (radius " + std::to_string(inner) + "); check the slip rules");
  return (p.radius - inner) / (outer - inner);
}

double Annulus::height(MeridionalPoint const& p) const {
  return has_walls() ? at(outer_, p.axial)(p.axial) - at(inner_, p.axial)(p.axial) : r_hi_ - r_lo_;
}

double Annulus::radius_change(MeridionalPoint const& p, double axial) const {
  if (axial == 0 || !has_walls()) return 0;
  double const h = span(p), moved = p.axial + axial;
  return (1 - h) * (at(inner_, moved)(moved) - at(inner_, p.axial)(p.axial)) +
         h * (at(outer_, moved)(moved) - at(outer_, p.axial)(p.axial));
}

Annulus annulus_of_row(Mesh const& mesh, SlipSurfaces const& surfaces, CylindricalFrame const& frame,
                       std::vector<int> const& blades) {
  return {surfaces, surfaces_of_row(mesh, surfaces, zones_of_row(mesh, blades)),
          meridional_points(mesh, frame, blades)};
}

RowMotion::RowMotion(Mesh const& mesh, ResolvedMotion const& motion, std::vector<int> const& blades,
                     SlipSurfaces const& surfaces, PatchDisplacement const& displacement,
                     std::vector<std::string>& notes)
    : frame_(motion.axis),
      row_zones_(zones_of_row(mesh, blades)),
      annulus_(surfaces, surfaces_of_row(mesh, surfaces, row_zones_), meridional_points(mesh, frame_, blades)),
      sections_(make_sections(mesh, blades, frame_, annulus_, displacement, notes)),
      middle_(0.5 * (sections_.most_upstream() + sections_.most_downstream())),
      inlet_(find_end(mesh, motion, blades, -1)),
      exit_(find_end(mesh, motion, blades, +1)) {}

RowMotion::End RowMotion::find_end(Mesh const& mesh, ResolvedMotion const& motion, std::vector<int> const& blades,
                                   int side) const {
  double const edge = side < 0 ? sections_.most_upstream() : sections_.most_downstream();
  auto const beyond = [&](std::vector<MeridionalPoint> const& points, double limit) {
    return std::all_of(points.begin(), points.end(), [&](auto const& p) { return side * (p.axial - limit) > 0; });
  };

  std::vector<int> sliding, others;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    Patch const& patch = mesh.patches[p];
    auto const* slide = std::get_if<CircumferentialSlideRule>(&motion.patch_rule(int(p)));
    if (slide != nullptr && select_patches(mesh, slide->of) == blades) {
      auto const points = meridional_points(mesh, frame_, {int(p)});
      if (beyond(points, middle_)) {
        sliding.push_back(int(p));
      } else if (std::any_of(points.begin(), points.end(),
                             [&](auto const& q) { return side * (q.axial - middle_) > 0; })) {
        throw MotionError("patch " + describe_patch(mesh, patch) +
                          " has the rule circumferential-slide but lies beside the blade's "
                          "mid-chord at axial position " +
                          std::to_string(middle_) + "; only patches upstream or downstream of it can slide");
      }
    } else if (row_zones_[patch.zone] && (patch.kind != PatchKind::wall && patch.kind != PatchKind::symmetry &&
                                          patch.kind != PatchKind::degenerate)) {
      if (beyond(meridional_points(mesh, frame_, {int(p)}), edge)) others.push_back(int(p));
    }
  }

  End end;
  end.slides = !sliding.empty();
  end.axial = -side * inf;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    if (!row_zones_[z]) continue;
    Zone const& zone = mesh.zones[z];
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      double const a = frame_.meridional(mesh.coordinates[n]).axial;
      end.axial = side < 0 ? std::min(end.axial, a) : std::max(end.axial, a);
    }
  }
  std::vector<std::pair<double, double>> nodes;
  for (MeridionalPoint const& p : meridional_points(mesh, frame_, end.slides ? sliding : others))
    nodes.emplace_back(annulus_.span(p), p.axial);
  try {
    if (!nodes.empty()) end.axial_of_span = RevolutionProfile::from_points(std::move(nodes));
  } catch (MotionError const& e) {
    // An end that does not move may have any shape: the taper then ends at the outermost axial position.
    if (end.slides)
      throw MotionError("patch " + describe_patch(mesh, mesh.patches[sliding.front()]) +
                        " has the rule circumferential-slide, but its axial "
                        "position is not a function of the span "
                        "fraction (here called axial position, and its axial "
                        "position radius): " +
                        e.what());
  }
  return end;
}

CylindricalMotion RowMotion::taper(End const& end, double span, double axial, double edge_axial,
                                   CylindricalMotion const& edge) const {
  // Nodes of the end itself scatter about its fitted shape by `deviation`: within it, they are at the end.
  double const margin = end.axial_of_span ? end.axial_of_span->deviation : 0;
  double const x = end.at(span);
  double const length = std::abs(edge_axial - x) - margin;
  double const w = length > 0 ? std::clamp((std::abs(axial - x) - margin) / length, 0.0, 1.0) : 1.0;
  bool const outside = (axial - x) * (edge_axial - x) <= 0;
  double const share = outside ? 0.0 : w;
  return {share * edge.axial, share * edge.radial, end.slides ? edge.angle_rad : share * edge.angle_rad};
}

CylindricalMotion RowMotion::follow_motion(MeridionalPoint const& p, double h) const {
  double const leading = sections_.leading(h), trailing = sections_.trailing(h);
  if (p.axial < leading) return taper(inlet_, h, p.axial, leading, sections_.motion(h, 0));
  if (p.axial > trailing) return taper(exit_, h, p.axial, trailing, sections_.motion(h, 1));
  return sections_.motion(h, (p.axial - leading) / (trailing - leading));
}

Vec3 RowMotion::slide(Vec3 const& point) const {
  MeridionalPoint const p = frame_.meridional(point);
  CylindricalMotion const edge = sections_.motion(annulus_.span(p), p.axial < middle_ ? 0 : 1);
  return frame_.displacement(point, {0, 0, edge.angle_rad});
}

Vec3 RowMotion::follow(Vec3 const& point) const {
  MeridionalPoint const p = frame_.meridional(point);
  double const h = annulus_.span(p);
  CylindricalMotion m = follow_motion(p, h);
  m.radial += annulus_.radius_change(p, m.axial);
  return frame_.displacement(point, m);
}

}  // namespace gridmorph
