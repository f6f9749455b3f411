#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

/// Adds the weights of a polyhedron's corner nodes.
void polyhedron_weights(Mesh const& mesh, Location const& where, std::span<Index32 const> corners,
                        std::vector<double>& weight) {
  auto const& polyhedra = mesh.polyhedra;
  auto const here = std::lower_bound(polyhedra.element.begin(), polyhedra.element.end(), where.element);
  auto const number = std::size_t(here - polyhedra.element.begin());
  double const of_face = where.local.x, of_begin = where.local.y, of_end = where.local.z;
  double const of_all = 1 - of_face - of_begin - of_end;
  std::fill(weight.begin(), weight.end(), of_all / double(corners.size()));
  auto const add = [&](Index32 node, double w) {
    auto const at = std::find(corners.begin(), corners.end(), node);
    if (at != corners.end()) weight[at - corners.begin()] += w;
  };
  Index part = where.part;
  for (Index f = polyhedra.first_face[number]; f < polyhedra.first_face[number + 1]; ++f) {
    auto const face = polyhedra.faces[f];
    auto const n = Index(face.size());
    if (part >= n) {
      part -= n;
      continue;
    }
    for (Index32 const node : face) add(node, of_face / double(n));
    add(face[part], of_begin);
    add(face[(part + 1) % n], of_end);
    return;
  }
}

void fill_weights(Mesh const& mesh, Location const& where, std::vector<double>& weight) {
  auto const corners = mesh.elements.corners(where.element);
  ElementType const type = mesh.elements.type[where.element];
  weight.resize(corners.size());
  if (type == ElementType::polyhedron) return polyhedron_weights(mesh, where, corners, weight);
  kernels::ElementWeights const w = element_weights(type, where.local);
  std::copy_n(w.of, corners.size(), weight.begin());
}

/// Calls visit(node, weight) for the corner nodes of a place whose weights count, each node once (collapsed elements
/// name some more than once); these weights sum to one.
template <class Visit>
void for_each_item(Mesh const& mesh, Location const& where, Visit const& visit) {
  constexpr double negligible = 1e-9;
  auto const corners = mesh.elements.corners(where.element);
  ElementType const type = mesh.elements.type[where.element];
  kernels::ElementWeights some;
  std::vector<double> many;
  double* weight = some.of;
  if (type == ElementType::polyhedron) {
    fill_weights(mesh, where, many);
    weight = many.data();
  } else {
    some = element_weights(type, where.local);
    for (std::size_t k = 1; k < corners.size(); ++k)
      for (std::size_t earlier = 0; earlier < k; ++earlier) {
        if (corners[earlier] != corners[k]) continue;
        weight[earlier] += weight[k];
        weight[k] = 0;
        break;
      }
  }
  double sum = 0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (weight[k] >= negligible) sum += weight[k];
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (weight[k] >= negligible) visit(corners[k], weight[k] / sum);
}

void check(Mesh const& mesh, Location const& where) {
  if (where.element >= 0 && where.element < mesh.n_elements()) return;
  throw MeshError(
      "interpolation in '" + mesh.source +
      "': a point has no element there; the elements to look in are none, or its coordinates are no numbers");
}

}  // namespace

std::vector<double> corner_weights(Mesh const& mesh, Location const& location) {
  check(mesh, location);
  std::vector<double> weight;
  fill_weights(mesh, location, weight);
  return weight;
}

Vec3 position(Mesh const& mesh, Location const& location) {
  auto const weight = corner_weights(mesh, location);
  auto const corners = mesh.elements.corners(location.element);
  Vec3 const origin = mesh.coordinates[corners[0]];
  Vec3 sum;
  for (std::size_t k = 1; k < corners.size(); ++k) sum += weight[k] * (mesh.coordinates[corners[k]] - origin);
  return origin + sum;
}

InterpolationOperator interpolation_rows(HostInstance const& host, Mesh const& mesh,
                                         std::span<Location const> locations, std::span<Index32 const> targets) {
  if (targets.size() != locations.size())
    throw MeshError("interpolation in '" + mesh.source + "': " + std::to_string(locations.size()) + " locations for " +
                    std::to_string(targets.size()) + " targets");
  for (Location const& where : locations) check(mesh, where);
  InterpolationOperator rows;
  rows.target.assign(targets.begin(), targets.end());
  rows.first.resize(locations.size() + 1);
  Index const n_rows = Index(locations.size());
  detail::for_all(host, "gridmorph::interpolation_rows::count", n_rows, [&](Index const n) {
    Index count = 0;
    for_each_item(mesh, locations[n], [&](Index32, double) { ++count; });
    rows.first[n + 1] = count;
  });
  for (std::size_t n = 0; n < locations.size(); ++n) rows.first[n + 1] += rows.first[n];
  rows.item.resize(rows.first.back());
  rows.weight.resize(rows.first.back());
  detail::for_all(host, "gridmorph::interpolation_rows::fill", n_rows, [&](Index const n) {
    auto at = std::size_t(rows.first[n]);
    for_each_item(mesh, locations[n], [&](Index32 node, double w) {
      rows.item[at] = node;
      rows.weight[at++] = float(w);
    });
  });
  return rows;
}

LocateReport summarise(std::span<Location const> locations) {
  LocateReport report;
  for (std::size_t n = 0; n < locations.size(); ++n) {
    Location const& where = locations[n];
    double const distance = where.element < 0 ? kernels::unbounded : where.distance;
    if (distance == 0) {
      ++report.inside;
      continue;
    }
    ++report.outside;
    if (report.worst >= 0 && !(distance > report.largest_distance)) continue;
    report.largest_distance = distance;
    report.worst = Index(n);
  }
  return report;
}

}  // namespace gridmorph
