// Structural models made in memory, and fields with known answers.
#pragma once

#include "case_text.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mapping/structural_model.hpp>

#include <cmath>
#include <functional>
#include <numbers>

namespace gridmorph::test {

/// A grid of (nu, nv) nodes at place(s, t), s and t in [0, 1], as quadrilaterals, or as triangles two by two.
inline StructuralModel grid_model(int nu, int nv, std::function<Vec3(double, double)> const& place,
                                  std::function<Vec3(Vec3 const&)> const& u, bool triangles = false) {
  StructuralModel model;
  model.nodes.source = "d.csv";
  model.elements = "e.csv";
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      model.nodes.position.push_back(place(double(i) / (nu - 1), double(j) / (nv - 1)));
      model.nodes.displacement.push_back(u(model.nodes.position.back()));
      model.nodes.line.push_back(std::int64_t(model.nodes.line.size()) + 1);
    }
  for (int j = 0; j + 1 < nv; ++j)
    for (int i = 0; i + 1 < nu; ++i) {
      std::int32_t const a = i + nu * j, b = a + 1, c = b + nu, d = a + nu;
      std::int64_t const place_in_file = std::int64_t(model.facets.size()) + 1;
      if (triangles) {
        model.facets.push_back({{a, b, c, -1}, place_in_file});
        model.facets.push_back({{a, c, d, -1}, place_in_file + 1});
      } else {
        model.facets.push_back({{a, b, c, d}, place_in_file});
      }
    }
  return model;
}

/// A quarter of a cylinder about x.
inline std::function<Vec3(double, double)> quarter_cylinder(double radius) {
  return [radius](double s, double t) {
    double const a = std::numbers::pi / 2 * s;
    return Vec3{t, radius * std::cos(a), radius * std::sin(a)};
  };
}

inline std::vector<Vec3> mapped(PointField const& field, std::vector<Vec3> const& at) {
  std::vector<Vec3> out(at.size());
  field(at, out);
  return out;
}

inline double largest_error(PointField const& field, std::vector<Vec3> const& at,
                            std::function<Vec3(Vec3 const&)> const& wanted) {
  auto const found = mapped(field, at);
  double worst = 0;
  for (std::size_t n = 0; n < at.size(); ++n) worst = std::max(worst, distance(found[n], wanted(at[n])));
  return worst;
}

}  // namespace gridmorph::test
