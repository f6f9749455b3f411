#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/unstructured/locate.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

namespace gridmorph {

namespace {

/// Adds the weights of a polyhedron's corner nodes.
void polyhedron_weights(UnstructuredMesh const& mesh, Location const& where, std::span<Number const> corners,
                        std::vector<double>& weight) {
  auto const& polyhedra = mesh.polyhedra;
  auto const here = std::lower_bound(polyhedra.element.begin(), polyhedra.element.end(), where.element);
  auto const number = std::size_t(here - polyhedra.element.begin());
  double const of_face = where.local.x, of_begin = where.local.y, of_end = where.local.z;
  double const of_all = 1 - of_face - of_begin - of_end;
  std::fill(weight.begin(), weight.end(), of_all / double(corners.size()));
  auto const add = [&](Number node, double w) {
    auto const at = std::find(corners.begin(), corners.end(), node);
    if (at != corners.end()) weight[std::size_t(at - corners.begin())] += w;
  };
  Index part = where.part;
  for (Index f = polyhedra.first_face[number]; f < polyhedra.first_face[number + 1]; ++f) {
    auto const face = polyhedra.faces[f];
    auto const n = Index(face.size());
    if (part >= n) {
      part -= n;
      continue;
    }
    for (Number const node : face) add(node, of_face / double(n));
    add(face[std::size_t(part)], of_begin);
    add(face[std::size_t((part + 1) % n)], of_end);
    return;
  }
}

void fill_weights(UnstructuredMesh const& mesh, Location const& where, std::vector<double>& weight) {
  auto const corners = mesh.elements.corners(where.element);
  ElementType const type = mesh.elements.type[std::size_t(where.element)];
  weight.resize(corners.size());
  if (type == ElementType::polyhedron) return polyhedron_weights(mesh, where, corners, weight);
  ElementWeights const w = element_weights(type, where.local);
  std::copy_n(w.of, corners.size(), weight.begin());
}

void check(UnstructuredMesh const& mesh, Location const& where) {
  if (where.element >= 0 && where.element < mesh.n_elements()) return;
  throw MeshError(
      "interpolation in '" + mesh.source +
      "': a point has no element there; the elements to look in are none, or its coordinates are no numbers");
}

}  // namespace

std::vector<double> corner_weights(UnstructuredMesh const& mesh, Location const& location) {
  check(mesh, location);
  std::vector<double> weight;
  fill_weights(mesh, location, weight);
  return weight;
}

Vec3 position(UnstructuredMesh const& mesh, Location const& location) {
  auto const weight = corner_weights(mesh, location);
  auto const corners = mesh.elements.corners(location.element);
  Vec3 const origin = mesh.coordinates[corners[0]];
  Vec3 sum;
  for (std::size_t k = 1; k < corners.size(); ++k) sum += weight[k] * (mesh.coordinates[corners[k]] - origin);
  return origin + sum;
}

GatherRows interpolation_rows(UnstructuredMesh const& mesh, std::span<Location const> locations,
                              std::span<Number const> targets) {
  constexpr double negligible = 1e-9;
  if (targets.size() != locations.size())
    throw MeshError("interpolation in '" + mesh.source + "': " + std::to_string(locations.size()) + " locations for " +
                    std::to_string(targets.size()) + " targets");
  GatherRows rows;
  rows.target.reserve(locations.size());
  rows.first.reserve(locations.size() + 1);
  rows.item.reserve(8 * locations.size());
  rows.weight.reserve(8 * locations.size());
  std::vector<double> weight, kept;
  std::vector<Number> items;
  for (std::size_t n = 0; n < locations.size(); ++n) {
    check(mesh, locations[n]);
    fill_weights(mesh, locations[n], weight);
    auto const corners = mesh.elements.corners(locations[n].element);
    items.clear();
    kept.clear();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (weight[k] < negligible) continue;
      // Collapsed elements name a node more than once.
      auto const same = std::find(items.begin(), items.end(), corners[k]);
      if (same != items.end()) {
        kept[std::size_t(same - items.begin())] += weight[k];
        continue;
      }
      items.push_back(corners[k]);
      kept.push_back(weight[k]);
    }
    rows.add(targets[n], items, kept);
  }
  return rows;
}

LocateReport summarise(std::span<Location const> locations) {
  LocateReport report;
  for (std::size_t n = 0; n < locations.size(); ++n) {
    Location const& where = locations[n];
    double const distance = where.element < 0 ? unbounded : where.distance;
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

std::string describe(LocateReport const& report, std::string const& points, std::string const& mesh) {
  if (report.outside == 0) return {};
  std::array<char, 32> distance{};
  std::snprintf(distance.data(), distance.size(), "%.3g", report.largest_distance);
  return std::to_string(report.outside) + " of " + std::to_string(report.inside + report.outside) + " " + points +
         (report.outside == 1 ? " lies" : " lie") + " outside " + mesh + ", up to " + distance.data() +
         " from it, and " + (report.outside == 1 ? "takes" : "take") + " the nearest place there";
}

}  // namespace gridmorph
