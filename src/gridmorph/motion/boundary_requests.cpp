#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/boundary_requests.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

using Request = BoundaryRequests::Request;

std::string requester(Mesh const& mesh, Request const& r) {
  if (r.patch >= 0 && mesh.patches[std::size_t(r.patch)].kind == PatchKind::region)
    return "'" + mesh.patches[std::size_t(r.patch)].name + "' (region)";
  return r.patch >= 0 ? describe_patch(mesh, mesh.patches[std::size_t(r.patch)])
                      : "'" + connections_of(mesh)[std::size_t(r.interface)].name + "' (periodic)";
}

class Evaluation {
 public:
  Evaluation(Mesh const& mesh, BoundaryRequests const& boundary, BoundaryMotion const& motion)
      : mesh_(mesh),
        boundary_(boundary),
        rules_(motion),
        motion_(motion.motion()),
        tolerance_(motion_.conformity_tolerance * motion.boundary().size()),
        values_(std::size_t(boundary.n_boundary_nodes)),
        given_by_(values_.size(), -1) {}

  void take(std::size_t n, Vec3 const& value) {
    Request const& r = boundary_.requests[n];
    auto const node = std::size_t(r.boundary_node);
    Index& given_by = given_by_[node];
    Request const* first = given_by < 0 ? nullptr : &boundary_.requests[std::size_t(given_by)];
    if (first == nullptr || yields(*first, r)) {
      given_by = Index(n);
      values_[node] = value;
      return;
    }
    if (yields(r, *first) || rule(*first).rank < rule(r).rank) return;
    double const gap = distance(values_[node], value);
    if (gap <= tolerance_) return;
    Conflict& c = conflicts_[{requester(mesh_, *first), requester(mesh_, r)}];
    ++c.count;
    if (gap > c.size) c = {gap, given_by, Index(n), c.count, values_[node], value};
  }

  [[nodiscard]] std::vector<Index> const& given_by() const { return given_by_; }

  std::vector<Vec3> result() {
    Problems problems;
    for (auto const& [who, c] : conflicts_) {
      Request const& first = boundary_.requests[std::size_t(c.first)];
      Request const& second = boundary_.requests[std::size_t(c.second)];
      problems.add("patches " + who.first + " and " + who.second + " disagree on " + std::to_string(c.count) +
                   " common nodes, most at " + describe_node(mesh_, first.node) + ": " + to_text(c.a, 6) + " from " +
                   rule(first).where + ", " + to_text(c.b, 6) + " from " + rule(second).where + ", apart by " +
                   to_text(c.size, 6) +
                   "; make the two motions agree there, let one of them slip, or give the rules different ranks");
    }
    problems.throw_if_any<MotionError>();
    return std::move(values_);
  }

 private:
  struct Conflict {
    double size = 0;
    Index first = 0, second = 0, count = 0;
    Vec3 a, b;
  };

  [[nodiscard]] MotionRule const& rule(Request const& r) const { return motion_.rules[std::size_t(r.rule)]; }
  [[nodiscard]] bool is_default(Request const& r) const {
    return r.patch >= 0 && motion_.patch[std::size_t(r.patch)].by_default;
  }
  [[nodiscard]] bool is_prescribed(Request const& r) const {
    return std::holds_alternative<PrescribedRule>(rule(r).rule);
  }
  /// Whether the value of `own` gives way to that of `other` without a word.
  [[nodiscard]] bool yields(Request const& own, Request const& other) const {
    if (is_prescribed(own) != is_prescribed(other)) return is_prescribed(own);
    if (own.rule != other.rule && rules_.gives_way(own.rule, other.patch)) return true;
    return boundary_.defaults_yield && is_default(own) && !is_default(other) &&
           mesh_.zone_of(own.node) != mesh_.zone_of(other.node);
  }

  Mesh const& mesh_;
  BoundaryRequests const& boundary_;
  BoundaryMotion const& rules_;
  ResolvedMotion const& motion_;
  double tolerance_;
  std::vector<Vec3> values_;
  std::vector<Index> given_by_;  ///< number of the request
  std::map<std::pair<std::string, std::string>, Conflict> conflicts_;
};

}  // namespace

void BoundaryRequests::sort(std::vector<MotionRule> const& rules) {
  auto const order = [&](Request const& r) { return std::pair(rules[std::size_t(r.rule)].rank, r.rule); };
  std::stable_sort(requests.begin(), requests.end(),
                   [&](Request const& a, Request const& b) { return order(a) < order(b); });
}

std::vector<Vec3> evaluate(Mesh const& mesh, BoundaryRequests const& boundary, BoundaryMotion const& motion,
                           std::vector<Mat3> const& rotations) {
  auto const& requests = boundary.requests;
  Evaluation evaluation(mesh, boundary, motion);
  for (std::size_t begin = 0, end = 0; begin < requests.size(); begin = end) {
    while (end < requests.size() && requests[end].rule == requests[begin].rule) ++end;
    std::vector<Vec3> points(end - begin), u(end - begin);
    for (std::size_t n = begin; n < end; ++n) points[n - begin] = mesh.coordinates[requests[n].node];
    motion.displacement(requests[begin].rule, points, u);
    for (std::size_t n = begin; n < end; ++n) {
      std::int32_t const r = requests[n].rotation;
      evaluation.take(n, r < 0 ? u[n - begin] : transpose(rotations[std::size_t(r)]) * u[n - begin]);
    }
  }
  return evaluation.result();
}

std::vector<Index> deciding_requests(Mesh const& mesh, BoundaryRequests const& boundary, BoundaryMotion const& motion) {
  Evaluation evaluation(mesh, boundary, motion);
  for (std::size_t n = 0; n < boundary.requests.size(); ++n) evaluation.take(n, {});  // ranks decide, not values
  return evaluation.given_by();
}

}  // namespace gridmorph
