#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/mapping/detail/facet_shape.hpp>
#include <gridmorph/mapping/facet_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

using mapping::FacetPoint;
using mapping::FacetShape;

constexpr std::size_t most_problems = 10;
/// An element whose area is below this share of its longest side squared is a line.
constexpr double no_area = 1e-12;
/// The share of an element by less than which a place beyond an edge is on it, but for rounding.
constexpr double at_the_edge = 1e-9;

std::vector<Vec3> corners_of(StructuralModel const& model, StructuralFacet const& facet) {
  std::vector<Vec3> out;
  for (int c = 0; c < facet.corners(); ++c) out.push_back(model.nodes.position[facet.node[c]]);
  return out;
}

FacetShape shape_of(std::vector<Vec3> const& corners) {
  std::array<Vec3, 4> four{};
  std::copy(corners.begin(), corners.end(), four.begin());
  return {four, int(corners.size())};
}

double longest_side(std::vector<Vec3> const& corners) {
  double out = 0;
  for (std::size_t c = 0; c < corners.size(); ++c)
    out = std::max(out, distance(corners[c], corners[(c + 1) % corners.size()]));
  return out;
}

}  // namespace

struct FacetMap::Impl {
  std::vector<Vec3> position;
  std::vector<StructuralFacet> facets;
  std::vector<FacetShape> shapes;
  std::vector<std::array<bool, 4>> free_side;  // no other element has it
  Extrapolation extrapolation;
  double coincidence;
  FacetBoxes tree;  // a bilinear surface lies inside the hull of its corners, so that their boxes hold the elements

  struct Hit {
    int facet = -1;
    FacetPoint point;
  };
  /// The closest facet; of equally close ones that with the lowest number. Cost O(log n).
  [[nodiscard]] Hit closest(Vec3 const& q) const;
  void find_free_sides();
  [[nodiscard]] bool at_free_side(Hit const& hit) const;
};

FacetMap::FacetMap(StructuralModel const& model, Extrapolation extrapolation, double coincidence)
    : impl_(std::make_unique<Impl>()) {
  impl_->position = model.nodes.position;
  impl_->facets = model.facets;
  impl_->extrapolation = extrapolation;
  impl_->coincidence = coincidence;
  std::vector<std::array<int, 4>> nodes;
  Problems problems;
  for (StructuralFacet const& facet : model.facets) {
    auto const corners = corners_of(model, facet);
    nodes.push_back(facet.node);
    impl_->shapes.push_back(shape_of(corners));
    double const side = longest_side(corners);
    if (norm(impl_->shapes.back().area_vector()) > no_area * side * side) continue;
    problems.add(fmt::format("{}:{}: the element at {} has no area; remove it or correct its nodes", model.elements,
                             facet.place, to_text(corners.front(), 6)));
    if (problems.messages().size() >= most_problems) break;
  }
  problems.throw_if_any<ConfigError>();
  impl_->tree = FacetBoxes(impl_->position, nodes);
  impl_->find_free_sides();
}

FacetMap::~FacetMap() = default;
FacetMap::FacetMap(FacetMap&&) noexcept = default;
FacetMap& FacetMap::operator=(FacetMap&&) noexcept = default;

void FacetMap::Impl::find_free_sides() {
  std::map<std::pair<std::int32_t, std::int32_t>, int> count;
  auto const side = [](StructuralFacet const& facet, int s) {
    auto const ends = std::minmax(facet.node[s], facet.node[(s + 1) % facet.corners()]);
    return std::pair(ends.first, ends.second);
  };
  for (StructuralFacet const& facet : facets)
    for (int s = 0; s < facet.corners(); ++s) ++count[side(facet, s)];
  for (StructuralFacet const& facet : facets) {
    auto& free = free_side.emplace_back(std::array<bool, 4>{});
    for (int s = 0; s < facet.corners(); ++s) free[s] = count[side(facet, s)] == 1;
  }
}

FacetMap::Impl::Hit FacetMap::Impl::closest(Vec3 const& q) const {
  Hit best;
  best.point.squared = std::numeric_limits<double>::max();
  auto const look = [&](int f) {
    FacetPoint const p = shapes[f].closest(q);
    if (p.squared < best.point.squared || (p.squared == best.point.squared && f < best.facet)) best = {f, p};
  };
  tree.for_each_nearer(q, look, [&] { return best.point.squared; });
  return best;
}

bool FacetMap::Impl::at_free_side(Hit const& hit) const {
  for (int s = 0; s < facets[hit.facet].corners(); ++s)
    if (free_side[hit.facet][s] && shapes[hit.facet].on_side(hit.point, s)) return true;
  return false;
}

Stencil FacetMap::stencil(Vec3 const& q, Vec3 const& anchor) const {
  Impl::Hit hit = impl_->closest(anchor);
  if (!(anchor == q)) hit.point = impl_->shapes[hit.facet].closest(q);
  StructuralFacet const& facet = impl_->facets[hit.facet];
  FacetShape const& shape = impl_->shapes[hit.facet];
  FacetPoint const& p = hit.point;
  int const n = facet.corners();
  Stencil out;
  out.distance = std::sqrt(p.squared);
  out.reference = facet.node[0];
  for (int c = 0; c < n; ++c) {
    if (distance(q, impl_->position[facet.node[c]]) > impl_->coincidence) continue;
    out.reference = facet.node[c];
    out.coincident = true;
    return out;
  }
  auto const value = shape.shape(p.a, p.b);
  std::array<double, 4> change{};
  out.lever = q - p.position;
  if (impl_->at_free_side(hit)) {
    // The part of the lever in the plane of the element, in steps along its tangents.
    auto const [ta, tb] = shape.tangents(p.a, p.b);
    double const aa = dot(ta, ta), ab = dot(ta, tb), bb = dot(tb, tb), determinant = aa * bb - ab * ab;
    double const la = dot(out.lever, ta), lb = dot(out.lever, tb);
    if (determinant > 0) {
      double da = (la * bb - lb * ab) / determinant, db = (lb * aa - la * ab) / determinant;
      double const steps = std::max(std::fabs(da), std::fabs(db));
      if (steps > at_the_edge) {
        out.beyond = norm(da * ta + db * tb);
        out.far_beyond = steps > 2;
        double const share = impl_->extrapolation == Extrapolation::nearest ? 0 : std::min(1.0, 1 / steps);
        da *= share;
        db *= share;
        change = shape.shape_change(p.a, p.b, da, db);
        out.lever = out.lever - (da * ta + db * tb);
      }
    }
  }
  for (int c = 0; c < n; ++c) out.terms.push_back({facet.node[c], value[c] + change[c], value[c]});
  return out;
}

}  // namespace gridmorph
