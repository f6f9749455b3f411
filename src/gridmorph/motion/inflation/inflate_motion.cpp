#include <gridmorph/motion/inflation/inflate_motion.hpp>

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/turbomachinery/section_places.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace gridmorph {

namespace {

/// Where a displaced surface loses a face first.
struct Fold {
  double share = 1;  ///< of the displacement; 1: the surface does not fold
  int vertex = -1;
};

constexpr double least_area = 0.01;  // of the baseline's

/// The smallest positive s with a + b s + c s^2 = 0 for a > 0; above 1 where there is none up to 1.
double first_root(double a, double b, double c) {
  double const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return 2;
  // 2 a / (-b + root): the root of smaller size where b is negative; where it is not, c has to be.
  double const divisor = -b + std::sqrt(discriminant);
  return divisor > 0 ? 2 * a / divisor : 2;
}

class FoldSearch {
 public:
  FoldSearch(PatchSurface const& surface, std::span<Vec3 const> u) : surface_(surface), u_(u) {}

  Fold run() {
    if (surface_.lines) {
      for (PatchGrid const& grid : surface_.grids)
        for (GridFacet const& face : grid.faces) {
          Vec3 const e = edge(face[0], face[1]);
          take(face[0], (1 - least_area) * dot(e, e), dot(change(face[0], face[1]), e), 0);
        }
      return out_;
    }
    for (GridFacet const& facet : surface_.facets()) visit(facet, facet[3] < 0 ? 3 : 4);
    return out_;
  }

 private:
  [[nodiscard]] Vec3 edge(int a, int b) const { return surface_.points[b] - surface_.points[a]; }
  [[nodiscard]] Vec3 change(int a, int b) const { return u_[b] - u_[a]; }

  void visit(GridFacet const& facet, int n) {
    Vec3 normal;
    for (int c = 1; c + 1 < n; ++c) normal += cross(edge(facet[0], facet[c]), edge(facet[0], facet[c + 1]));
    for (int c = 0; c < n; ++c) {
      int const at = facet[c], next = facet[(c + 1) % n], before = facet[(c + n - 1) % n];
      Vec3 const e = edge(at, next), f = edge(at, before), du = change(at, next), dv = change(at, before);
      double const area = dot(cross(e, f), normal);
      // Corners of 180 degrees and re-entrant ones say nothing.
      if (area > 1e-9 * norm(e) * norm(f) * norm(normal))
        take(at, (1 - least_area) * area, dot(cross(e, dv) + cross(du, f), normal), dot(cross(du, dv), normal));
    }
  }

  void take(int vertex, double a, double b, double c) {
    double const share = a > 0 ? first_root(a, b, c) : 2;
    if (share < out_.share) out_ = {share, vertex};
  }

  PatchSurface const& surface_;
  std::span<Vec3 const> u_;
  Fold out_;
};

/// The smallest share s of the displacements u of the vertices, up to 1, at which a corner of a face has less than a
/// hundredth of its baseline area, counted along the face's baseline normal n: with edges e, f from the corner, ((e + s
/// du) x (f + s dv)) . n =
/// ((e x f) . n) / 100, a quadratic in s. Of lines the same with their length. Cost O(faces).
Fold fold_share(PatchSurface const& surface, std::span<Vec3 const> displacement) {
  return FoldSearch(surface, displacement).run();
}

/// Three digits, rounded down, so that what it says would do does.
std::string rounded_down(double share) {
  double const unit = std::pow(10.0, std::floor(std::log10(share)) - 2);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::floor(share / unit) * unit);
  return text;
}

std::vector<SurfacePlace> places_of(Boundary const& boundary, ResolvedMotion const& motion,
                                    std::vector<int> const& patches, InflateRule const& rule,
                                    PatchSurface const& surface, SlipSurfaces const& slip, std::string const& name,
                                    std::vector<std::string>& notes) {
  std::vector<SurfacePlace> out(surface.points.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v].point = surface.points[v];
  if (!rule.sections) return out;
  SectionsRule sought;
  sought.sections = rule.sections->kind;
  sought.span = rule.sections->span;
  sought.flow = rule.sections->flow;
  try {
    SectionPlaces const sections(boundary, motion, sought, patches, slip, notes);
    if (rule.sections->sides && !sections.have_camber())
      throw MotionError("`side` needs both sides of the blade: its camber line lies between them; name both");
    for (auto& place : out) place = sections.at(place.point);
  } catch (MotionError const& e) {
    throw MotionError(name + ": " + e.what());
  }
  return out;
}

}  // namespace

InflateMotion::InflateMotion(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& patches,
                             InflateRule const& rule, std::shared_ptr<SlipSurfaces const> const& slip,
                             std::string const& name, std::vector<std::string>& notes)
    : name_(name) {
  if (patches.empty()) throw MotionError(name + ": it moves patches only, and names none");
  PatchSurface surface(boundary, patches);
  if (!(surface.size > 0)) throw MotionError(name + ": the nodes of its patches are one point");
  if (!surface.gridded &&
      std::all_of(surface.grids.begin(), surface.grids.end(), [](PatchGrid const& g) { return g.faces.empty(); }))
    throw MotionError(name + ": its patches have no faces that could be offset");
  SurfaceOffset offset(boundary, surface, *slip, rule.crease_angle_deg, name);
  auto places = places_of(boundary, motion, patches, rule, surface, *slip, name, notes);
  ground_ = std::make_shared<Ground const>(Ground{slip, std::move(surface), std::move(offset), std::move(places)});
  raise(rule);
  auto const [least, most] = std::minmax_element(height_.begin(), height_.end());
  std::string note = name + ": heights from " + to_text(*least, 4) + " to " + to_text(*most, 4) + " at " +
                     std::to_string(height_.size()) + " nodes";
  if (ground_->offset.at_creases() > 0)
    note += ", " + std::to_string(ground_->offset.at_creases()) + " of them at creases";
  if (ground_->offset.limited() > 0)
    note += "; at " + std::to_string(ground_->offset.limited()) +
            " a crease, or the angle to a slip wall, is so sharp that faces are offset by less than the height";
  notes.push_back(note);
}

InflateMotion::InflateMotion(InflateMotion const& other, InflateRule const& rule, std::string const& name)
    : ground_(other.ground_), name_(name) {
  raise(rule);
}

void InflateMotion::raise(InflateRule const& rule) {
  auto const& [slip, surface, offset, places] = *ground_;
  std::size_t const n = places.size();
  height_.assign(n, 0.0);
  rule.height(places, height_);
  displacement_.resize(n);
  std::size_t worst = 0;
  double most = 0;  // height over what is allowed
  for (std::size_t v = 0; v < n; ++v) {
    if (!std::isfinite(height_[v]))
      throw MotionError(name_ + ": the height at " + to_text(places[v].point, 9) + " is " + to_text(height_[v], 9) +
                        "; correct it there");
    if (rule.share != 1) height_[v] *= rule.share;
    displacement_[v] = offset.displacement(int(v), height_[v]);
    if (!rule.most_chords) continue;
    double const chords = std::abs(height_[v]) / (*rule.most_chords * places[v].chord);
    if (chords > most) {
      most = chords;
      worst = v;
    }
  }
  if (most > 1)
    throw MotionError(name_ + ": the height at " + to_text(places[worst].point, 9) + " is " +
                      to_text(height_[worst], 6) + ", more than the chord there, " + to_text(places[worst].chord, 6) +
                      "; " + rounded_down(1 / most) + " of the height would do (amplitude)");
  Fold const fold = fold_share(surface, displacement_);
  if (fold.share < 1) {
    auto const v = std::size_t(fold.vertex);
    throw MotionError(name_ + ": the surface folds at " + to_text(places[v].point, 9) + ", where the height is " +
                      to_text(height_[v], 6) + " and the radius of curvature too small for it; up to " +
                      rounded_down(fold.share) + " of the height would do (amplitude)");
  }
}

void InflateMotion::displacement(std::span<Vec3 const> points, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < points.size(); ++n) {
    int const v = ground_->surface.numbers.find(points[n]);
    if (v < 0)
      throw MotionError(name_ + ": the point " + to_text(points[n], 9) +
                        " is no node of its patches; they alone have normals and a height");
    out[n] = displacement_[v];
  }
}

}  // namespace gridmorph
