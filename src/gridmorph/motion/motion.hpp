// Motion rules: how the boundary of the domain moves. Plain values; case files and solvers fill them alike.
//
// A rule addresses patches by selector: a family name, BC name or connection name, with `*` and `?` globs, or
// `type:wall`, `type:inflow`, `type:periodic`, ... Rules are explicit (fixed, rigid, function, sections, target,
// inflate, ffd, extend, circumferential slide, follow, attached, carry, wake, shock, prescribed: the displacement of
// every node is known before the volume stage) or implicit (slip, free: the volume stage carries the nodes and the
// finalize step puts them back on their surface). Regions inside the domain are addressed by their names and take
// explicit rules that need no surface.
#pragma once

#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/ffd_rule.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gridmorph {

/// Nodes that stay where they are: their displacement is zero.
struct FixedRule {};

/// x' = matrix * x + translation for every node: rotation, scaling, translation or a composition of them.
struct RigidRule {
  Mat3 matrix;
  Vec3 translation;
};

/// Displacement as a function of the baseline position: formulas, point clouds, tables, a solver's own code. The
/// function fills displacement[n] for points[n]; it must give equal results for equal points.
struct FunctionRule {
  std::string description;  ///< for reports: "formula dx = ...", "field blade.csv (nearest, 2112 points)"
  std::function<void(std::span<Vec3 const> points, std::span<Vec3> displacement)> function;
};

/// Values of one parameter along the span.
struct SpanwiseTable {
  enum class Interpolation {
    spline,  ///< C1 cubics without overshoot: level at extremes, harmonic means of the secants elsewhere
    linear
  };
  /// The stations (span fraction, value), span fractions strictly increasing. Beyond the first and the last: their
  /// values. Empty: 0.
  std::vector<std::pair<double, double>> stations;
  Interpolation interpolation = Interpolation::spline;

  /// Value at a span fraction; exactly the station's at a station. Cost O(log stations).
  [[nodiscard]] double at(double span) const;
  /// Whether every value is exactly zero.
  [[nodiscard]] bool is_zero() const;
};

/// Redesign of an airfoil section by section: every section changes its shape in its own plane, by parameters that vary
/// along the span. Leading edge, trailing edge, chord line, camber and span fraction are found from the patches
/// themselves; docs/motion.md has the formulas. Where all parameters are zero the displacement is exactly zero.
struct SectionsRule {
  /// blade: sections are surfaces of constant span fraction between hub and case about Motion::axis, rolled out with
  /// the coordinates (axial position, R theta). wing: plane sections across the span direction.
  enum class Sections { blade, wing };
  Sections sections = Sections::blade;
  /// The direction of the span of a wing, from root to tip. Found when absent: across the symmetry plane the wing
  /// stands on, else its longest extent.
  std::optional<Vec3> span{};
  /// The way of the flow around a wing, roughly; tells leading from trailing edge. Blades: along the axis.
  Vec3 flow{1, 0, 0};
  /// Chord fraction of the point of the chord line that chord, scale, twist and stagger leave in place.
  double pivot = 0.5;

  SpanwiseTable chord;        ///< relative change of length along the chord line (-0.1: 10 % shorter), thickness kept
  SpanwiseTable scale;        ///< relative change of size of the section as a whole
  SpanwiseTable thickness;    ///< relative change of thickness about the camber line
  SpanwiseTable twist_rad;    ///< the section turns rigidly; positive: towards a larger stagger angle
  SpanwiseTable stagger_rad;  ///< change of the stagger angle that keeps every axial (wing: streamwise) position
  SpanwiseTable sweep;        ///< shift along the baseline chord line [length], positive towards the trailing edge
  SpanwiseTable lean;         ///< circumferential shift [length; blade: R theta, wing: across span and flow]
  SpanwiseTable bow_rad;  ///< lean angle of the stacking line; shifts like lean by its tangent's integral from span 0
};

/// Inlet and exit: turn about the axis by the angle that the leading edge (upstream patches) or trailing edge
/// (downstream patches) of the `of` patches turns by at the same span fraction; axial position and radius kept.
struct CircumferentialSlideRule {
  std::vector<std::string> of;
};

/// Periodics: replicate the mid-camber motion of `of` between its leading and trailing edge at the same span and chord
/// fraction, taper linearly along the flow path to the motion of inlet and exit; copies stay 1-to-1.
struct FollowRule {
  std::vector<std::string> of;
};

/// No deformation of the surface: nodes slide on it.
struct SlipRule {
  enum class Surface { plane, revolution, baseline };
  Surface surface = Surface::plane;
  /// A point and the normal of a plane; fitted to the baseline patch when absent.
  std::optional<std::pair<Vec3, Vec3>> plane{};
  /// The (axial, radius) points along the profile of a surface of revolution; read off the baseline patch when empty.
  /// See TurnedProfile.
  std::vector<std::pair<double, double>> profile{};
  /// The angle above which facets of the patch meet at a crease, which stays sharp, where nodes slide on the baseline.
  double crease_angle_rad = 0.8;
};

/// Left to the volume stage, with an optional constraint.
struct FreeRule {
  enum class Constraint { none, axial, plane };
  Constraint constraint = Constraint::none;  ///< axial: axial position kept; plane: nodes stay on the patch's plane
};

/// Whatever displacement the caller of a morph gives these nodes: surfaces that a structural solver moves. What rules
/// give them is zero, and no rule beside them disagrees with it.
struct PrescribedRule {};

/// Where a node of a surface is: its position, and on a blade or wing its place on the sections that SectionsRule
/// finds.
struct SurfacePlace {
  Vec3 point;                 ///< baseline
  double span_fraction = 0;   ///< the others are 0 unless the rule asks for sections
  double chord_fraction = 0;  ///< along the chord line, 0 at the leading edge, 1 at the trailing edge
  double side = 0;   ///< of the camber line: 1 where t grows (theta; wing: along span x flow), -1 on the other side
  double chord = 0;  ///< of its section [length]
  double from_leading_edge = 0;   ///< straight, in the surface of the section [length]
  double from_trailing_edge = 0;  ///< likewise
};

/// Nodes go along the normals of their surface: coatings, deposits, erosion. Every face is offset by the height; on
/// smooth surfaces a node moves by the height along its normal, at creases by the height over the cosine between its
/// way and the normals of the faces, by twice the height at most. Nodes of slip surfaces stay on them. Surfaces that
/// would fold are refused. docs/motion.md has the rest.
struct InflateRule {
  std::string description{};  ///< for reports: "height 0.001"
  /// Height at each place, positive into the mesh; equal for equal places.
  std::function<void(std::span<SurfacePlace const> places, std::span<double> height)> height;
  double share = 1;  ///< of the height
  /// Faces that turn by more than this meet in a crease.
  double crease_angle_deg = 40;
  /// What the sections of SurfacePlace are of, a blade or a wing: as in SectionsRule.
  struct Sections {
    SectionsRule::Sections kind = SectionsRule::Sections::blade;
    std::optional<Vec3> span{};
    Vec3 flow{1, 0, 0};
    bool sides = false;  ///< whether `side` is used, which takes both sides of the blade
  };
  std::optional<Sections> sections{};
  /// Heights above so many chords are refused; needs sections.
  std::optional<double> most_chords{};
};

/// Goes along with walls that other rules move: regions around a wake or of refinement, bodies carried by a wing.
struct AttachedRule {
  std::vector<std::string> of;  ///< patches with a rule of their own
  enum class How {
    rigid,   ///< one rigid motion, x' = t + R (x - s): the one that fits that of the walls' nodes best (least squares)
    shift,   ///< the mean displacement of the walls' nodes
    nearest  ///< each point takes the displacement of the nearest place on the walls, linear between the corners of its
             ///< face
  };
  How how = How::rigid;
  /// rigid, shift: only the nodes within a distance of a place, which is the second [length].
  std::optional<std::pair<Vec3, double>> near{};
};

/// Features that sit on walls which other rules move: holes, squealers, shrouds, sensors. Each connected one keeps its
/// shape and goes with the wall where its rim meets it; the wall around goes along, and fades to its own motion.
/// CarriedFeatures has the formulas.
struct CarryRule {
  std::vector<std::string> of;  ///< patches with a rule of their own that the features sit on
  /// axial: the axial position of every node is kept; plane: nodes stay on the planes of the feature's flat patches.
  FreeRule::Constraint constraint = FreeRule::Constraint::none;
  std::optional<double>
      fade{};  ///< how far from a rim the walls have their own motion again [length]; absent: the size of the rim
};

/// Goes along with trailing edges that other rules move: wakes (WakeMotion has the formula).
struct WakeRule {
  std::vector<std::string> of;  ///< patches with a rule of their own: whole blades or wings
  SectionsRule::Sections sections = SectionsRule::Sections::blade;  ///< these three as in SectionsRule
  std::optional<Vec3> span{};
  Vec3 flow{1, 0, 0};
  std::optional<double> fade{};  ///< how far behind the edge the motion has faded [length]; absent: nowhere
  double turn = 1;               ///< share of the turn of the edge that the wake takes over
};

class ShockShift;

/// Goes along with a shock from where one flow solution has it to where another has it (ShockMotion has the formula).
struct ShockRule {
  std::vector<std::string> of;  ///< walls with a rule of their own that the shock stands on; may be empty
  double fade = 0;   ///< distance from these walls within which the motion of the shock fades to theirs [length]
  double share = 1;  ///< of the way
  std::shared_ptr<ShockShift const> shift{};  ///< how far the shock goes, place by place
};

/// Blades on end walls that other rules move: their spanwise grid lines are extended or trimmed along themselves to the
/// moved walls, and the walls' nodes around them go along.
struct ExtendRule {
  std::vector<std::string>
      of;  ///< end walls with a displacement of their own; another end of the lines stays where it is
};

using Rule = std::variant<FixedRule, RigidRule, FunctionRule, CircumferentialSlideRule, FollowRule, SlipRule, FreeRule,
                          SectionsRule, TargetRule, PrescribedRule, AttachedRule, InflateRule, ExtendRule, WakeRule,
                          FfdRule, ShockRule, CarryRule>;

/// "fixed", "rigid", ... as spelled in case files ("formula" and "field" are both FunctionRule and print as
/// "function").
std::string_view rule_name(Rule const& rule);

struct MotionRule {
  std::vector<std::string> patches;  ///< selectors
  Rule rule;
  /// Where two patches that meet disagree, the lower rank wins; equal ranks that disagree are an error.
  int rank = 0;
  std::string where;  ///< "case.toml:14" or whatever names the rule in messages
};

struct Motion {
  Axis axis;
  std::vector<MotionRule> rules;
  std::vector<InnerRegion> regions;  ///< inside meshes of blocks, for rules to name
  /// A patch that no rule matches: its CGNS type's default (symmetry slips on its plane, periodic pairs move freely as
  /// one, everything else stays fixed), or an error when strict.
  bool strict = false;
  /// Displacements that differ by less than this times the mesh size on a shared edge, or by what the rounding of
  /// coordinates makes of them, are one and the same.
  double conformity_tolerance = 1e-9;
};

/// What resolve() decided for one patch or one periodic interface.
struct Resolution {
  int rule = -1;  ///< number in rules
  bool by_default = false;
};

/// Every patch (and every periodic interface, which `type:periodic` or its name may address) with its one rule. `rules`
/// are Motion::rules followed by the default rules that were needed.
struct ResolvedMotion {
  Axis axis;
  double conformity_tolerance = 1e-9;
  std::vector<MotionRule> rules;
  std::vector<Resolution> patch;      ///< per Mesh::patches
  std::vector<Resolution> interface;  ///< per connection (Mesh::interfaces, then Mesh::connections); rule -1 for plain
                                      ///< ones and for free periodics
  std::vector<std::string> notes;     ///< defaults taken, for the output

  [[nodiscard]] Rule const& patch_rule(int p) const { return rules[patch[p].rule].rule; }
};

/// Gives each patch and periodic interface its rule. A later rule does not override an earlier one: two rules that name
/// the same patch are an error, and so is a selector that matches nothing (the message lists what there is). A rule on
/// one side of a periodic interface holds for its other side, which files store as an interface of its own. All
/// problems are reported in one MotionError. Cost O(patches + interfaces^2), nothing per node.
ResolvedMotion resolve(BoundaryMesh const& mesh, Motion const& motion);

}  // namespace gridmorph
