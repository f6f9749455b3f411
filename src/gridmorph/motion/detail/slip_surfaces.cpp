#include <gridmorph/motion/detail/slip_surfaces.hpp>

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/boundary/periodic_copies.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/profile_smoothing.hpp>
#include <gridmorph/motion/detail/facet_groups.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace gridmorph {

namespace {

using Patches = std::vector<int>;

/// How far nodes may lie off a profile of revolution, as a share of the wall's size (radius or extent along the axis).
constexpr double profile_tolerance = 1e-3;

std::string describe(Boundary const& boundary, Patches const& patches) {
  std::vector<std::string> names;
  for (int p : patches) names.push_back(boundary.describe_patch(p));
  std::string text = names.front();
  if (names.size() > 1) text += " and " + std::to_string(names.size() - 1) + " more on the same surface";
  return text;
}

/// Nodes on the four edges of a grid; all of a surface that is none.
std::vector<Index> outline_nodes(BoundarySurface const& surface) {
  if (!surface.grid) return surface.nodes;
  auto const [n_a, n_b] = *surface.grid;
  std::vector<Index> out;
  for (int b = 0; b < n_b; ++b)
    for (int a = 0; a < n_a; a += b == 0 || b == n_b - 1 ? 1 : std::max(1, n_a - 1))
      out.push_back(surface.nodes[std::size_t(a) + std::size_t(n_a) * std::size_t(b)]);
  return out;
}

/// Patches that meet in the meridional plane, directly or through others: a hub split over several zones, also where
/// only periodic copies meet. Compares the nodes on the outlines.
std::vector<Patches> meridionally_connected(Boundary const& boundary, CylindricalFrame const& frame,
                                            Patches const& patches) {
  double const tolerance = place_tolerance(1e-6, boundary.size(), boundary.precision().resolution());
  struct Mark {
    MeridionalPoint at;
    int member;
  };
  std::vector<Mark> marks;
  for (std::size_t m = 0; m < patches.size(); ++m)
    for (Index const n : outline_nodes(boundary.surface(patches[m])))
      marks.push_back({frame.meridional(boundary.coordinates()[n]), int(m)});
  std::sort(marks.begin(), marks.end(), [](Mark const& a, Mark const& b) { return a.at.axial < b.at.axial; });

  DisjointSets<int> sets(patches.size());
  // Along one circumferential line marks repeat; looking back as far as the tolerance reaches would be quadratic, so
  // the latest mark of each member is kept per radius cell of the current axial window.
  std::map<long long, std::map<int, Mark>> window;
  double window_start = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    Mark const& mark = marks[i];
    if (i == 0 || mark.at.axial - window_start > 64 * tolerance) {
      std::map<long long, std::map<int, Mark>> recent;
      for (auto const& [cell, members] : window)
        for (auto const& [member, m] : members)
          if (mark.at.axial - m.at.axial <= tolerance) recent[cell][member] = m;
      window = std::move(recent);
      window_start = mark.at.axial;
    }
    auto const cell = (long long)(std::floor(mark.at.radius / tolerance));
    for (long long c = cell - 1; c <= cell + 1; ++c)
      if (auto const near = window.find(c); near != window.end())
        for (auto const& [member, m] : near->second)
          if (member != mark.member && mark.at.axial - m.at.axial <= tolerance &&
              std::abs(mark.at.radius - m.at.radius) <= tolerance)
            sets.join(member, mark.member);
    window[cell].insert_or_assign(mark.member, mark);
  }
  std::map<int, Patches> groups;
  for (std::size_t m = 0; m < patches.size(); ++m) groups[sets.root(int(m))].push_back(patches[m]);
  std::vector<Patches> out;
  for (auto& [r, members] : groups) out.push_back(std::move(members));
  std::sort(out.begin(), out.end());
  return out;
}

bool same_surface(SlipSurface const& a, SlipSurface const& b) {
  return a.kind == b.kind && a.origin == b.origin && a.direction == b.direction && a.profile.knots == b.profile.knots &&
         a.frame == b.frame && a.facets.points == b.facets.points;
}

class Finder {
 public:
  Finder(Boundary const& boundary, ResolvedMotion const& motion, SlipSurfaces& out, std::vector<std::string>& notes)
      : boundary_(boundary), motion_(motion), frame_(motion.axis), out_(out), notes_(notes) {}

  void run() {
    std::map<int, Patches> by_rule;
    for (std::size_t p = 0; p < boundary_.patches().size(); ++p) by_rule[motion_.patch[p].rule].push_back(int(p));
    for (auto const& [r, patches] : by_rule) {
      if (r < 0) continue;
      MotionRule const& rule = motion_.rules[r];
      where_ = rule.where.empty() ? "rule " + std::to_string(r + 1) : rule.where;
      if (auto const* slip = std::get_if<SlipRule>(&rule.rule)) {
        switch (slip->surface) {
          case SlipRule::Surface::revolution: revolutions(patches, *slip); break;
          case SlipRule::Surface::baseline: baseline(patches, *slip); break;
          case SlipRule::Surface::plane: planes(patches, slip->plane); break;
        }
      } else if (auto const* free = std::get_if<FreeRule>(&rule.rule)) {
        if (free->constraint == FreeRule::Constraint::plane) planes(patches, std::nullopt);
        if (free->constraint == FreeRule::Constraint::axial) axial(patches);
      }
    }
    problems_.throw_if_any<MotionError>();
  }

 private:
  void store(SlipSurface surface, Patches const& patches, std::vector<Vec3> const& points) {
    int const number = store(std::move(surface), points);
    for (int p : patches) out_.of_patch[p] = number;
  }

  /// Stores a surface, unless it is there already, and returns its number.
  int store(SlipSurface surface, std::vector<Vec3> const& points) {
    for (Vec3 const& p : points) surface.size = std::max(surface.size, distance(p, surface.origin));
    // Two rules may give one surface: a node on both slides on it, not along an edge.
    auto const known = std::find_if(out_.surfaces.begin(), out_.surfaces.end(),
                                    [&](SlipSurface const& other) { return same_surface(surface, other); });
    int const number = int(known - out_.surfaces.begin());
    if (known == out_.surfaces.end()) {
      out_.surfaces.push_back(std::move(surface));
    } else {
      known->size = std::max(known->size, surface.size);
      known->baseline_deviation = std::max(known->baseline_deviation, surface.baseline_deviation);
    }
    return number;
  }

  void axial(Patches const& patches) {
    SlipSurface surface;
    surface.kind = SlipSurface::Kind::axial;
    surface.origin = frame_.origin();
    surface.direction = frame_.direction();
    store(std::move(surface), patches, boundary_.points(patches));
  }

  /// A patch, or one of the planes that it lies on.
  struct Part {
    int patch = -1;
    std::vector<Index> nodes{};  ///< none: all of the patch
    std::vector<Vec3> points;
    PlaneFit fit;
  };

  /// The patch, or its planes where it lies on several.
  [[nodiscard]] std::vector<Part> parts_of(int p) const {
    Part whole{p, {}, boundary_.points(p), {}};
    whole.fit = fit_plane(whole.points);
    std::vector<Part> parts;
    if (whole.fit.determined && !is_flat(whole)) parts = planes_of(p);
    if (parts.size() < 2) parts = {std::move(whole)};
    return parts;
  }

  /// The planes of a patch; none where it lies on something else.
  [[nodiscard]] std::vector<Part> planes_of(int p) const {
    std::vector<Part> out;
    std::vector<Index> listed;
    for (auto& nodes : flat_pieces(boundary_, p)) {
      auto points = boundary_.points_of(nodes);
      PlaneFit const fit = fit_plane(points);
      listed.insert(listed.end(), nodes.begin(), nodes.end());
      out.push_back({p, std::move(nodes), std::move(points), fit});
      if (!fit.determined || !is_flat(out.back())) return {};
    }
    // Further nodes of second-order faces are no corners; they lie on the planes that they are on.
    std::sort(listed.begin(), listed.end());
    for (Index const n : boundary_.surface(p).nodes) {
      if (std::binary_search(listed.begin(), listed.end(), n)) continue;
      std::vector<Vec3> const point{boundary_.coordinates()[n]};
      bool found = false;
      for (Part& part : out) {
        if (deviation_from_plane(point, part.fit.origin, part.fit.normal) > flat(part.fit.extent, point)) continue;
        part.nodes.push_back(n);
        found = true;
      }
      if (!found) return {};
    }
    return out;
  }

  [[nodiscard]] bool is_flat(Part const& part) const {
    return deviation_from_plane(part.points, part.fit.origin, part.fit.normal) <= flat(part.fit.extent, part.points);
  }

  /// Patches on one plane share it: largest first, each takes those that lie on its plane.
  void planes(Patches const& patches, std::optional<std::pair<Vec3, Vec3>> const& given) {
    if (given) {
      if (!patches.empty()) plane(patches, given);
      return;
    }
    std::vector<Part> parts;
    for (int const p : patches)
      for (Part& part : parts_of(p)) parts.push_back(std::move(part));
    std::stable_sort(parts.begin(), parts.end(),
                     [](Part const& a, Part const& b) { return a.fit.extent > b.fit.extent; });
    while (!parts.empty()) {
      PlaneFit const seed = parts.front().fit;
      std::vector<Part> members, rest;
      for (std::size_t n = 0; n < parts.size(); ++n) {
        Part& part = parts[n];
        bool const same = n == 0 || (seed.determined && deviation_from_plane(part.points, seed.origin, seed.normal) <=
                                                            flat(seed.extent, part.points));
        (same ? members : rest).push_back(std::move(part));
      }
      plane(members);
      parts = std::move(rest);
    }
  }

  /// 1e-6 of the patch's size, and the rounding of its coordinates, at least that of single precision, wherever they
  /// are.
  [[nodiscard]] double flat(double extent, std::vector<Vec3> const& points) const {
    double const largest = largest_component(points);
    return 1e-6 * extent + std::max(2e-7 * largest, 2 * boundary_.precision().at(largest));
  }

  /// Finds the plane of whole patches and of parts of others together.
  void plane(std::vector<Part> const& parts) {
    Patches whole, all;
    for (Part const& part : parts) {
      all.push_back(part.patch);
      if (part.nodes.empty()) whole.push_back(part.patch);
    }
    if (whole.size() == all.size()) return plane(whole, std::nullopt);
    std::sort(all.begin(), all.end());
    std::vector<Vec3> points;
    for (Part const& part : parts) points.insert(points.end(), part.points.begin(), part.points.end());
    auto surface = plane_through(all, points, std::nullopt);
    if (!surface) return;
    int const number = store(std::move(*surface), points);
    for (Part const& part : parts) {
      if (int& first = out_.of_patch[part.patch]; first < 0) first = number;
      if (!part.nodes.empty()) out_.pieces[part.patch].push_back({number, part.nodes});
    }
  }

  void plane(Patches members, std::optional<std::pair<Vec3, Vec3>> const& given) {
    std::sort(members.begin(), members.end());
    auto const points = boundary_.points(members);
    if (auto surface = plane_through(members, points, given)) store(std::move(*surface), members, points);
  }

  /// The plane through points, given or fitted; nothing, and a problem, where there is none.
  std::optional<SlipSurface> plane_through(Patches const& members, std::vector<Vec3> const& points,
                                           std::optional<std::pair<Vec3, Vec3>> const& given) {
    PlaneFit const fit = fit_plane(points);
    SlipSurface surface;
    surface.kind = SlipSurface::Kind::plane;
    surface.origin = given ? given->first : fit.origin;
    surface.direction = given ? (1 / norm(given->second)) * given->second : fit.normal;
    surface.baseline_deviation = deviation_from_plane(points, surface.origin, surface.direction);
    std::string const who = where_ + ": patch " + describe(boundary_, members);
    if (!given && !fit.determined) {
      problems_.add(who +
                    " is collapsed to a line, which lies on many planes; "
                    "give the plane, or another rule");
      return std::nullopt;
    }
    if (double const limit = flat(fit.extent, points); surface.baseline_deviation > limit) {
      problems_.add(who + " is up to " + to_text(surface.baseline_deviation, 3) + " off " +
                    (given ? "the given plane" : "the nearest plane") + " (allowed: " + to_text(limit, 3) +
                    "); give it another rule, such as fixed" + (given ? ", or another plane" : ""));
      return std::nullopt;
    }
    return surface;
  }

  void baseline(Patches const& patches, SlipRule const& slip) {
    FacetOptions const options{.crease_angle_rad = slip.crease_angle_rad};
    // A rule whose patches are all collapsed has no facets to join.
    for (int const p : patches)
      if (boundary_.facets({&p, 1}).facets.empty())
        problems_.add(where_ + ": patch " + describe(boundary_, {p}) + " has no facets; give it another rule");
    try {
      for (Patches const& members : smoothly_joined(boundary_, patches, options)) {
        SlipSurface surface;
        surface.kind = SlipSurface::Kind::facets;
        // With what lies beyond the periodic sides, so that nodes can slide out of the sector and normals are the same
        // on both.
        surface.facets = FacetSurface::from_facets(
            with_copies(boundary_.facets(members), periodic_copies(boundary_, members)), options);
        surface.origin = surface.facets.boxes.front().low;
        auto const points = boundary_.points(members);
        PlaneFit const fit = fit_plane(points);
        if (fit.determined &&
            deviation_from_plane(points, fit.origin, fit.normal) <= 1e-13 * largest_component(points)) {
          // Flat to round-off: a plane is the same surface at a fraction of the cost.
          plane(members, std::nullopt);
          continue;
        }
        for (Vec3 const& p : points) {
          kernels::FacetFoot const foot = surface.facets.closest_point(p);
          surface.baseline_deviation = std::max(surface.baseline_deviation, foot.distance);
        }
        std::size_t creases = 0;
        for (kernels::Facet const& f : surface.facets.facets)
          for (int q = 0; q < 4; ++q) creases += f.is_crease(q) ? 1 : 0;
        notes_.push_back("slip " + describe(boundary_, members) + ": its own surface, smooth through " +
                         std::to_string(surface.facets.facets.size()) + " facets (periodic copies included), " +
                         std::to_string(creases / 2) + " edges are creases; nodes are within " +
                         to_text(surface.baseline_deviation, 3) + " of it");
        store(std::move(surface), members, points);
      }
    } catch (MotionError const& e) {
      problems_.add(where_ + ": patch " + describe(boundary_, patches) + ": " + e.what());
    }
  }

  void revolutions(Patches const& patches, SlipRule const& slip) {
    if (!slip.profile.empty()) return given_profile(patches, slip);
    std::map<std::string, Patches> families;
    Patches nameless;
    for (int p : patches) {
      auto const& own = boundary_.patches()[p].families;
      (own.empty() ? nameless : families[own.front()]).push_back(p);
    }
    for (auto const& [family, members] : families) {
      try {
        revolution(members, radius_over_axial);
      } catch (MotionError const&) {
        // One family may hold several surfaces, such as hub and case: tell them apart by what meets. Only what meets is
        // looked at in turned frames, where hub and case can follow one another.
        connected(members);
      }
    }
    connected(nameless);
  }

  void connected(Patches const& patches) {
    for (Patches const& members : meridionally_connected(boundary_, frame_, patches)) {
      try {
        revolution(members, TurnedProfile::from_points);
      } catch (MotionError const& e) {
        problems_.add(where_ + ": patch " + describe(boundary_, members) + ": " + e.what());
      }
    }
  }

  SlipSurface on_axis() const {
    SlipSurface surface;
    surface.kind = SlipSurface::Kind::revolution;
    surface.origin = frame_.origin();
    surface.direction = frame_.direction();
    return surface;
  }

  using MeridionalPoints = std::vector<std::pair<double, double>>;

  static TurnedProfile radius_over_axial(MeridionalPoints const& points) {
    TurnedProfile fit{RevolutionProfile::from_points(points), {}};
    if (fit.profile.is_steep()) throw MotionError("too steep for a radius over the axial position");
    return fit;
  }

  static void set_profile(SlipSurface& surface, TurnedProfile fit) {
    surface.kind =
        fit.frame == kernels::MeridionalFrame{} ? SlipSurface::Kind::revolution : SlipSurface::Kind::meridional;
    surface.profile = std::move(fit.profile);
    surface.frame = fit.frame;
  }

  /// How far the rounding of coordinates may have taken points, where they are known less exactly than double precision
  /// has them; otherwise 0.
  [[nodiscard]] double rounding_of(std::vector<Vec3> const& points) const {
    CoordinatePrecision const& precision = boundary_.precision();
    if (precision.relative <= std::numeric_limits<double>::epsilon() && precision.last_decimal == 0) return 0;
    double largest = 0;
    for (Vec3 const& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Half a unit in the last place in each of two directions.
    return 0.7 * precision.at(largest);
  }

  static void smooth_profile(SlipSurface& surface, MeridionalPoints const& points, double rounding) {
    if (rounding == 0) return;
    MeridionalPoints in_frame;
    for (auto const& [a, r] : points) in_frame.emplace_back(surface.frame.abscissa(a, r), surface.frame.ordinate(a, r));
    smooth(surface.profile, std::move(in_frame), rounding);
  }

  template <class Fit>
  void revolution(Patches const& members, Fit const& fit) {
    auto const points = boundary_.points(members);
    MeridionalPoints meridional;
    meridional.reserve(points.size());
    double size = 0;
    for (Vec3 const& p : points) {
      auto const [a, r] = frame_.meridional(p);
      meridional.emplace_back(a, r);
      size = std::max(size, r);
    }
    SlipSurface surface = on_axis();
    set_profile(surface, fit(meridional));
    smooth_profile(surface, meridional, rounding_of(points));
    surface.baseline_deviation = surface.profile.deviation;
    size = std::max(size, surface.profile.knots.back().axial - surface.profile.knots.front().axial);
    if (surface.baseline_deviation > profile_tolerance * size)
      throw MotionError("its nodes are up to " + to_text(surface.baseline_deviation, 3) +
                        " off the nearest surface of revolution about the "
                        "axis; check the axis, or give another rule");
    note(members, surface, "profile of revolution through");
    store(std::move(surface), members, points);
  }

  void given_profile(Patches const& patches, SlipRule const& slip) {
    SlipSurface surface = on_axis();
    try {
      set_profile(surface, TurnedProfile::from_points(slip.profile));
    } catch (MotionError const& e) {
      problems_.add(where_ + ": profile: " + e.what());
      return;
    }
    auto const points = boundary_.points(patches);
    double const size = wall_size(points);
    std::string far;
    for (int const patch : patches)
      for (Vec3 const& p : boundary_.points(patch)) {
        double const off = distance(p, surface.view().project(p));
        if (off > profile_tolerance * size && off > surface.baseline_deviation)
          far = describe(boundary_, {patch}) + " is up to " + to_text(off, 3) + " off the given profile, most at " +
                place(p);
        surface.baseline_deviation = std::max(surface.baseline_deviation, off);
      }
    if (!far.empty()) {
      problems_.add(where_ + ": patch " + far + " (allowed: " + to_text(profile_tolerance * size, 3) +
                    "); nodes that slip stay on the wall as it is: give its own profile or none; to move the wall onto "
                    "this profile, use the rule contour");
      return;
    }
    note(patches, surface, "given profile of");
    store(std::move(surface), patches, points);
  }

  std::string place(Vec3 const& p) const {
    auto const [axial, radius] = frame_.meridional(p);
    return to_text(p, 3) + ", axial " + to_text(axial, 3) + ", radius " + to_text(radius, 3);
  }

  /// The size of a wall of revolution: its largest radius, or its extent along the axis where that is more.
  double wall_size(std::vector<Vec3> const& points) const {
    double radius = 0, first = frame_.meridional(points.front()).axial, last = first;
    for (Vec3 const& p : points) {
      auto const [a, r] = frame_.meridional(p);
      radius = std::max(radius, r);
      first = std::min(first, a);
      last = std::max(last, a);
    }
    return std::max(radius, last - first);
  }

  static std::string end(SlipSurface const& s, kernels::ProfileKnot const& k) {
    if (s.kind == SlipSurface::Kind::revolution) return "axial " + to_text(k.axial, 3);
    return "(axial " + to_text(s.frame.axial(k.axial, k.radius), 3) + ", radius " +
           to_text(s.frame.radius(k.axial, k.radius), 3) + ")";
  }

  void note(Patches const& patches, SlipSurface const& s, char const* what) {
    notes_.push_back("slip " + describe(boundary_, patches) + ": " + what + " " +
                     std::to_string(s.profile.knots.size()) + " points, " + end(s, s.profile.knots.front()) + " to " +
                     end(s, s.profile.knots.back()) + "; nodes are within " + to_text(s.baseline_deviation, 3) +
                     " of it");
  }

  Boundary const& boundary_;
  ResolvedMotion const& motion_;
  CylindricalFrame frame_;
  SlipSurfaces& out_;
  std::vector<std::string>& notes_;
  std::string where_;
  Problems problems_;
};

}  // namespace

SlipSurfaces::SlipSurfaces(Boundary const& boundary, ResolvedMotion const& motion, std::vector<std::string>& notes)
    : of_patch(boundary.patches().size(), -1) {
  Finder(boundary, motion, *this, notes).run();
}

}  // namespace gridmorph
