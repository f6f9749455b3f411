#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/index_buckets.hpp>
#include <gridmorph/core/sort_keys.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <algorithm>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

namespace gridmorph {

namespace {

using detail::for_all;

std::vector<Index32> inverse_of(HostInstance const& host, std::vector<Index32> const& order) {
  std::vector<Index32> inverse(order.size());
  for_all(host, "gridmorph::inverse_of", Index(order.size()),
          [&](Index n) { inverse[std::size_t(order[std::size_t(n)])] = Index32(n); });
  return inverse;
}

/// The values at the places that `order` names, one after another.
template <class T>
std::vector<T> gather(HostInstance const& host, std::vector<T> const& values, std::vector<Index32> const& order) {
  std::vector<T> out(values.size());
  for_all(host, "gridmorph::gather", Index(values.size()),
          [&](Index n) { out[std::size_t(n)] = values[std::size_t(order[std::size_t(n)])]; });
  return out;
}

Coordinates gather(HostInstance const& host, Coordinates const& values, std::vector<Index32> const& order) {
  Coordinates out(values.size());
  for_all(host, "gridmorph::gather_coordinates", values.size(),
          [&](Index n) { out.set(n, values[order[std::size_t(n)]]); });
  return out;
}

/// The lists that `order` names, one after another, the numbers in them translated.
CsrGraph gather(HostInstance const& host, CsrGraph const& lists, std::vector<Index32> const& order,
                std::vector<Index32> const& translation) {
  CsrGraph out;
  out.first.resize(std::size_t(lists.size()) + 1);
  for (std::size_t n = 0; n < order.size(); ++n) {
    auto const from = std::size_t(order[n]);
    out.first[n + 1] = out.first[n] + lists.first[from + 1] - lists.first[from];
  }
  out.item.resize(lists.item.size());
  for_all(host, "gridmorph::gather_lists", lists.size(), [&](Index n) {
    auto const list = lists[order[std::size_t(n)]];
    std::transform(list.begin(), list.end(), out.item.begin() + out.first[std::size_t(n)],
                   [&](Index32 item) { return translation[std::size_t(item)]; });
  });
  return out;
}

void translate(std::vector<Index32>& numbers, std::vector<Index32> const& translation) {
  for (Index32& n : numbers) n = translation[std::size_t(n)];
}

/// Polyhedra in the order of their elements, their nodes translated.
Polyhedra gather(Polyhedra const& polyhedra, std::vector<Index32> const& new_element,
                 std::vector<Index32> const& new_node) {
  std::vector<std::pair<Index32, std::size_t>> moved;  // new number, old place
  for (std::size_t p = 0; p < polyhedra.element.size(); ++p)
    moved.emplace_back(new_element[std::size_t(polyhedra.element[p])], p);
  std::sort(moved.begin(), moved.end());
  Polyhedra out;
  if (!polyhedra.first_face.empty()) out.first_face.push_back(0);
  std::vector<Index32> nodes;
  for (auto const& [element, p] : moved) {
    out.element.push_back(element);
    for (Index f = polyhedra.first_face[p]; f < polyhedra.first_face[p + 1]; ++f) {
      nodes.assign(polyhedra.faces[f].begin(), polyhedra.faces[f].end());
      translate(nodes, new_node);
      out.faces.add(nodes);
    }
    out.first_face.push_back(out.faces.size());
  }
  return out;
}

/// What stands at place order.node[n] and order.element[e] comes to places n and e.
Mesh permuted(HostInstance const& host, Mesh const& mesh, FileOrder const& order) {
  auto const new_node = inverse_of(host, order.node);
  Mesh out;
  out.dimension = mesh.dimension;
  out.zones = mesh.zones;
  out.elements.type = gather(host, mesh.elements.type, order.element);
  out.elements.nodes = gather(host, mesh.elements.nodes, order.element, new_node);
  if (!mesh.elements.number.empty()) out.elements.number = gather(host, mesh.elements.number, order.element);
  if (!mesh.polyhedra.element.empty())
    out.polyhedra = gather(mesh.polyhedra, inverse_of(host, order.element), new_node);
  out.patches = mesh.patches;
  for (auto& patch : out.patches) {
    translate(patch.faces.item, new_node);
    translate(patch.nodes, new_node);
    std::sort(patch.nodes.begin(), patch.nodes.end());
  }
  out.connections = mesh.connections;
  for (auto& connection : out.connections) {
    translate(connection.nodes, new_node);
    translate(connection.donor_nodes, new_node);
  }
  out.families = mesh.families;
  out.subsets = mesh.subsets;
  if (!out.subsets.empty()) {
    auto const new_element = inverse_of(host, order.element);
    for (auto& subset : out.subsets) {
      translate(subset.elements, new_element);
      std::sort(subset.elements.begin(), subset.elements.end());
      translate(subset.faces.item, new_node);
    }
  }
  if (mesh.coordinates.size() > 0) out.coordinates = gather(host, mesh.coordinates, order.node);
  out.source = mesh.source;
  out.notes = mesh.notes;
  out.first_number = mesh.first_number;
  return out;
}

std::vector<Index32> order_nodes(HostInstance const& host, Mesh const& mesh) {
  MeshExtent const box = extent_of(host, mesh.coordinates);
  Vec3 const size = box.high - box.low;
  double const longest = std::max({size.x, size.y, size.z});
  double const steps = longest > 0 ? double(1 << kernels::LatticePlace::bits) / longest : 0;
  std::vector<Index32> order(std::size_t(mesh.n_nodes()));
  for (auto const& zone : mesh.zones) {
    if (zone.is_block()) {
      std::iota(order.begin() + zone.first_node, order.begin() + zone.first_node + zone.size(),
                Index32(zone.first_node));
      continue;
    }
    detail::KeyedIndices<Kokkos::HostSpace> const list(std::size_t(zone.size()), "gridmorph::order_by_position");
    for_all(host, "gridmorph::order_by_position::codes", zone.size(), [&](Index n) {
      list.key(n) = kernels::hilbert_code({mesh.coordinates[zone.first_node + n], box.low, {steps, steps, steps}});
      list.number(n) = Index32(zone.first_node + n);
    });
    host.visit([&](auto const& exec) {
      auto const sorted = detail::sort_keys(exec, list);
      compat::fence(exec, "gridmorph::order_by_position (read by the host)");
      std::copy_n(sorted.number.data(), zone.size(), order.begin() + zone.first_node);
    });
  }
  return order;
}

/// By the smallest new number among their nodes.
std::vector<Index32> order_elements(HostInstance const& host, Mesh const& mesh, std::vector<Index32> const& new_node) {
  detail::IndexBuckets<Index32> const buckets(host, "gridmorph::order_elements", mesh.n_elements(), mesh.n_nodes(),
                                              [&](Index e, auto const& put) {
                                                Index32 first = new_node[std::size_t(mesh.elements.nodes[e].front())];
                                                for (Index32 const n : mesh.elements.corners(e))
                                                  first = std::min(first, new_node[std::size_t(n)]);
                                                put(first, Index32(e));
                                              });
  std::vector<Index32> order(std::size_t(mesh.n_elements()));
  buckets.for_each_key([&](Index32, Index at, std::span<Index32 const> elements) {
    std::copy(elements.begin(), elements.end(), order.begin() + at);
  });
  return order;
}

bool stays(std::vector<Index32> const& order, Index first, Index n) {
  for (Index m = first; m < first + n; ++m)
    if (order[std::size_t(m)] != m) return false;
  return true;
}

}  // namespace

bool is_scattered(HostInstance const& host, Mesh const& mesh) {
  constexpr Index smallest = 4096, parts = 16;
  if (mesh.n_nodes() < smallest) return false;
  Index const near = mesh.n_nodes() / parts;
  Index wide = 0, looked_at = 0;
  for (auto const& zone : mesh.zones) {
    if (zone.is_block()) continue;
    Index of_zone = 0;
    host.visit([&](auto const& exec) {
      using Policy = Kokkos::RangePolicy<std::decay_t<decltype(exec)>, Kokkos::IndexType<Index>>;
      Kokkos::parallel_reduce(
          "gridmorph::is_scattered", Policy(exec, zone.first_element, zone.first_element + zone.n_elements),
          [&](Index e, Index& sum) {
            auto const corners = mesh.elements.corners(e);
            if (corners.empty()) return;
            auto const [first, last] = std::minmax_element(corners.begin(), corners.end());
            sum += *last - *first > near ? 1 : 0;
          },
          of_zone);
    });
    wide += of_zone;
    looked_at += zone.n_elements;
  }
  return 2 * wide > looked_at;
}

FileOrder order_by_position(HostInstance const& host, Mesh const& mesh) {
  if (mesh.coordinates.size() != mesh.n_nodes())
    throw MeshError("order by position: '" + mesh.source + "' has " + std::to_string(mesh.n_nodes()) +
                    " nodes, but coordinates of " + std::to_string(mesh.coordinates.size()));
  FileOrder order;
  order.node = order_nodes(host, mesh);
  bool const has_empty = std::adjacent_find(mesh.elements.nodes.first.begin(), mesh.elements.nodes.first.end()) !=
                         mesh.elements.nodes.first.end();
  if (has_empty) {
    order.element.resize(std::size_t(mesh.n_elements()));
    std::iota(order.element.begin(), order.element.end(), 0);
  } else {
    order.element = order_elements(host, mesh, inverse_of(host, order.node));
  }
  return order;
}

void reorder(HostInstance const& host, Mesh& mesh, FileOrder order) {
  if (!mesh.file_order.node.empty())
    throw MeshError("reorder: '" + mesh.source + "' is not in the order of its file; put it back with in_file_order()");
  if (Index(order.node.size()) != mesh.n_nodes() || Index(order.element.size()) != mesh.n_elements())
    throw MeshError("reorder: the order is one of " + std::to_string(order.node.size()) + " nodes and " +
                    std::to_string(order.element.size()) + " elements, but '" + mesh.source + "' has " +
                    std::to_string(mesh.n_nodes()) + " and " + std::to_string(mesh.n_elements()));
  for (auto const& zone : mesh.zones)
    if (zone.is_block() &&
        !(stays(order.node, zone.first_node, zone.size()) && stays(order.element, zone.first_element, zone.n_elements)))
      throw MeshError("reorder: the order moves nodes or cells of '" + zone.name + "', a block; leave them in place");
  mesh = permuted(host, mesh, order);
  mesh.file_order = std::move(order);
}

Mesh in_file_order(HostInstance const& host, Mesh const& mesh) {
  if (mesh.file_order.node.empty()) return mesh;
  return permuted(host, mesh, {inverse_of(host, mesh.file_order.node), inverse_of(host, mesh.file_order.element)});
}

Coordinates in_file_order(HostInstance const& host, Mesh const& mesh, Coordinates const& coordinates) {
  if (mesh.file_order.node.empty()) return coordinates;
  return gather(host, coordinates, inverse_of(host, mesh.file_order.node));
}

std::vector<double> in_file_order(HostInstance const& host, std::span<Index32 const> place,
                                  std::span<double const> values) {
  std::vector<double> out(values.begin(), values.end());
  for_all(host, "gridmorph::in_file_order", Index(place.size()),
          [&](Index n) { out[std::size_t(place[std::size_t(n)])] = values[std::size_t(n)]; });
  return out;
}

}  // namespace gridmorph
