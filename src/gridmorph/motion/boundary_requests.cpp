#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/boundary_requests.hpp>
#include <gridmorph/motion/disagreements.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

namespace gridmorph {

namespace {

using Request = BoundaryRequests::Request;

/// The name of what asks, as users know it.
std::string const& requester(BoundaryRequests const& boundary, Request const& r) {
  return r.patch < 0 ? boundary.interface_names[r.interface] : boundary.patch_names[r.patch];
}

class Evaluation {
 public:
  Evaluation(BoundaryRequests const& boundary, BoundaryMotion const& motion, std::vector<Mat3> const& rotations)
      : places_(motion.boundary().coordinates()),
        boundary_(boundary),
        rotations_(rotations),
        rules_(motion),
        motion_(motion.motion()),
        tolerance_(displacement_tolerance(motion_.conformity_tolerance, motion.boundary().size(),
                                          motion.boundary().precision().resolution())),
        values_(std::size_t(boundary.n_boundary_nodes)),
        given_by_(values_.size(), -1) {}

  void take(std::size_t n, Vec3 const& value) {
    Request const& r = boundary_.requests[n];
    auto const node = std::size_t(r.boundary_node);
    Index& given_by = given_by_[node];
    Request const* first = given_by < 0 ? nullptr : &boundary_.requests[given_by];
    if (first == nullptr || yields(*first, r)) {
      given_by = Index(n);
      values_[node] = value;
      return;
    }
    if (yields(r, *first) || rule(*first).rank < rule(r).rank) return;
    if (distance(values_[node], value) <= tolerance_) return;
    if (are_torn_copies(*first, r))
      torn_.add(rule(r).where, std::string(rule_name(rule(r).rule)), requester(boundary_, *first),
                {first->node, r.node, values_[node], value, turn_between(*first, r)});
    else
      disagreements_.add(first->node, side(*first, values_[node]), side(r, value));
  }

  [[nodiscard]] std::vector<Index> const& given_by() const { return given_by_; }

  std::vector<Vec3> result() {
    Problems problems;
    for (std::string& message :
         disagreements_.messages(rules_.boundary(), motion_.axis, [&](auto& name) { return points_of(name); }))
      problems.add(std::move(message));
    for (std::string& message : torn_.messages(rules_.boundary())) problems.add(std::move(message));
    problems.throw_if_any<MotionError>();
    return std::move(values_);
  }

 private:
  /// Whether one rule is asked for a node and for a periodic copy of it, elsewhere.
  [[nodiscard]] bool are_torn_copies(Request const& a, Request const& b) const {
    constexpr double apart = 1e-6;  // of the size
    return a.rule == b.rule && distance(places_[a.node], places_[b.node]) > apart * rules_.boundary().size();
  }
  [[nodiscard]] double turn_between(Request const& a, Request const& b) const {
    auto const rotation = [&](Request const& r) {
      return r.rotation < 0 ? RigidTransform{}.rotation : rotations_[r.rotation];
    };
    return norm(rotation_vector(rotation(b) * transpose(rotation(a))));
  }

  [[nodiscard]] Disagreeing side(Request const& r, Vec3 const& displacement) const {
    return {requester(boundary_, r), rule(r).where, displacement, is_default(r), advice(r)};
  }

  /// What to do where an attached part disagrees with its walls: one motion for all nodes of a part parts it from walls
  /// that bend. Empty for other rules.
  [[nodiscard]] std::string advice(Request const& r) const {
    auto const* attached = std::get_if<AttachedRule>(&rule(r).rule);
    if (attached == nullptr || attached->how == AttachedRule::How::nearest) return {};
    return "what " + requester(boundary_, r) +
           " is attached to bends there: take how = \"nearest\", with which every node follows the walls, or rule = "
           "\"carry\", with which it keeps its shape and the walls around go along";
  }

  /// The nodes of everything that has this name, patch by patch.
  [[nodiscard]] std::vector<std::vector<Vec3>> points_of(std::string const& name) const {
    std::map<int, std::vector<Vec3>> of_patch;
    std::map<int, bool> has_name;
    for (Request const& r : boundary_.requests) {
      if (r.patch < 0) continue;
      auto const [at, added] = has_name.try_emplace(r.patch, false);
      if (added) at->second = requester(boundary_, r) == name;
      if (at->second) of_patch[r.patch].push_back(places_[r.node]);
    }
    std::vector<std::vector<Vec3>> out;
    for (auto& [patch, points] : of_patch) out.push_back(std::move(points));
    return out;
  }

  [[nodiscard]] MotionRule const& rule(Request const& r) const { return motion_.rules[r.rule]; }
  [[nodiscard]] bool is_default(Request const& r) const {
    return r.patch >= 0 && std::size_t(r.patch) < motion_.patch.size() && motion_.patch[r.patch].by_default;
  }
  [[nodiscard]] bool is_prescribed(Request const& r) const {
    return std::holds_alternative<PrescribedRule>(rule(r).rule);
  }
  /// Whether the value of `own` gives way to that of `other` without a word.
  [[nodiscard]] bool yields(Request const& own, Request const& other) const {
    if (is_prescribed(own) != is_prescribed(other)) return is_prescribed(own);
    if (own.rule != other.rule && rules_.gives_way(own.rule, other.patch)) return true;
    return boundary_.defaults_yield && is_default(own) && !is_default(other) &&
           rules_.boundary().zone_of(own.node) != rules_.boundary().zone_of(other.node);
  }

  Coordinates const& places_;
  BoundaryRequests const& boundary_;
  std::vector<Mat3> const& rotations_;
  BoundaryMotion const& rules_;
  ResolvedMotion const& motion_;
  double tolerance_;
  std::vector<Vec3> values_;
  std::vector<Index> given_by_;  ///< number of the request
  Disagreements disagreements_;
  TornCopies torn_;
};

}  // namespace

void BoundaryRequests::name(NamedBoundary const& boundary) {
  auto const named = [](std::string const& name, std::vector<std::string> const& families) {
    return "'" + (families.empty() ? name : families.front()) + "'";
  };
  patch_names.clear();
  for (Patch const& patch : boundary.patches())
    patch_names.push_back(patch.kind == PatchKind::region ? "'" + patch.name + "' (region)"
                                                          : named(patch.name, patch.families));
  interface_names.clear();
  for (AnyConnection const& connection : boundary.connections())
    interface_names.push_back(named(connection.name, connection.families) + " (periodic)");
}

void BoundaryRequests::sort(std::vector<MotionRule> const& rules) {
  auto const order = [&](Request const& r) { return std::pair(rules[r.rule].rank, r.rule); };
  std::stable_sort(requests.begin(), requests.end(),
                   [&](Request const& a, Request const& b) { return order(a) < order(b); });
}

namespace {

/// Refuses what leads out of the plane of a mesh that has no other: it would be dropped, and a body that is turned out
/// of its plane squeezed.
void require_in_plane(BoundaryRequests const& boundary, BoundaryMotion const& motion,
                      std::vector<Vec3> const& displacement) {
  Boundary const& surfaces = motion.boundary();
  if (!surfaces.is_plane()) return;
  constexpr double rounding = 1e-6;  // of the largest displacement: tables have six digits and more
  Vec3 const normal = (1 / norm(surfaces.across())) * surfaces.across();
  double largest = 0, most = 0;
  Request const* out = nullptr;
  for (Request const& r : boundary.requests) {
    Vec3 const& u = displacement[r.boundary_node];
    largest = std::max(largest, norm(u));
    if (double const off = std::abs(dot(normal, u)); off > most) {
      most = off;
      out = &r;
    }
  }
  double const tolerance =
      displacement_tolerance(motion.motion().conformity_tolerance, surfaces.size(), surfaces.precision().resolution());
  if (out == nullptr || most <= std::max(tolerance, rounding * largest)) return;
  MotionRule const& rule = motion.motion().rules[out->rule];
  throw MotionError(
      (rule.where.empty() ? "rule " + std::to_string(out->rule + 1) : rule.where) + ": rule '" +
      std::string(rule_name(rule.rule)) + "' displaces " + surfaces.describe_node(out->node) + " of " +
      requester(boundary, *out) + " by " + to_text(displacement[out->boundary_node], 3) + ", " + to_text(most, 3) +
      " of it out of the plane of a 2-D mesh; move it within its plane, turn it about " + to_text(normal, 3));
}

}  // namespace

std::vector<Vec3> evaluate(BoundaryRequests const& boundary, BoundaryMotion const& motion,
                           std::vector<Mat3> const& rotations) {
  auto const& requests = boundary.requests;
  Coordinates const& places = motion.boundary().coordinates();
  Evaluation evaluation(boundary, motion, rotations);
  for (std::size_t begin = 0, end = 0; begin < requests.size(); begin = end) {
    while (end < requests.size() && requests[end].rule == requests[begin].rule) ++end;
    std::vector<Vec3> points(end - begin), u(end - begin);
    for (std::size_t n = begin; n < end; ++n) points[n - begin] = places[requests[n].node];
    motion.displacement(requests[begin].rule, points, u);
    for (std::size_t n = begin; n < end; ++n) {
      std::int32_t const r = requests[n].rotation;
      evaluation.take(n, r < 0 ? u[n - begin] : transpose(rotations[r]) * u[n - begin]);
    }
  }
  auto out = evaluation.result();
  require_in_plane(boundary, motion, out);
  return out;
}

void require_equal_copies(BoundaryRequests const& boundary, BoundaryMotion const& motion,
                          std::vector<Vec3> const& displacement) {
  ResolvedMotion const& resolved = motion.motion();
  Boundary const& surfaces = motion.boundary();
  double const tolerance =
      displacement_tolerance(resolved.conformity_tolerance, surfaces.size(), surfaces.precision().resolution());
  // The first request of a boundary node gives its value.
  std::vector<Request const*> first(displacement.size(), nullptr);
  std::unordered_map<Index, Index> asked;
  for (Request const& r : boundary.requests) {
    if (Request const*& own = first[r.boundary_node]; own == nullptr) own = &r;
    asked[r.node] = r.boundary_node;
  }
  TornCopies torn;
  for (AnyConnection const& connection : surfaces.connections()) {
    if (!connection.periodic) continue;
    auto const pairs = surfaces.pairs(connection.number);
    if (pairs.empty()) continue;
    Mat3 const turn = surfaces.transform(connection.number).rotation;
    for (auto const& [node, donor] : pairs) {
      auto const own = asked.find(node), other = asked.find(donor);
      if (own == asked.end() || other == asked.end()) continue;
      Request const &a = *first[own->second], &b = *first[other->second];
      Vec3 const u = displacement[own->second];
      Vec3 const copy = transpose(turn) * displacement[other->second];
      if (a.rule != b.rule || distance(u, copy) <= tolerance) continue;
      MotionRule const& rule = resolved.rules[a.rule];
      torn.add(rule.where, std::string(rule_name(rule.rule)), requester(boundary, a),
               {own->first, other->first, u, copy, norm(rotation_vector(turn))});
    }
  }
  Problems problems;
  for (std::string& message : torn.messages(surfaces)) problems.add(std::move(message));
  problems.throw_if_any<MotionError>();
}

std::vector<Index> deciding_requests(BoundaryRequests const& boundary, BoundaryMotion const& motion) {
  std::vector<Mat3> const none;
  Evaluation evaluation(boundary, motion, none);
  for (std::size_t n = 0; n < boundary.requests.size(); ++n) evaluation.take(n, {});  // ranks decide, not values
  return evaluation.given_by();
}

}  // namespace gridmorph
