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
  for_all(host, "gridmorph::inverse_of", Index(order.size()), [&](Index n) { inverse[order[n]] = Index32(n); });
  return inverse;
}

/// The values at the places that `order` names, one after another.
template <class T>
std::vector<T> gather(HostInstance const& host, std::vector<T> const& values, std::vector<Index32> const& order) {
  std::vector<T> out(values.size());
  for_all(host, "gridmorph::gather", Index(values.size()), [&](Index n) { out[n] = values[order[n]]; });
  return out;
}

Coordinates gather(HostInstance const& host, Coordinates const& values, std::vector<Index32> const& order) {
  Coordinates out(values.size());
  for_all(host, "gridmorph::gather_coordinates", values.size(), [&](Index n) { out.set(n, values[order[n]]); });
  return out;
}

/// The lists that `order` names, one after another, the numbers in them translated.
CsrGraph gather(HostInstance const& host, CsrGraph const& lists, std::vector<Index32> const& order,
                std::vector<Index32> const& translation) {
  CsrGraph out;
  out.first.resize(lists.size() + 1);
  for (std::size_t n = 0; n < order.size(); ++n) {
    auto const from = std::size_t(order[n]);
    out.first[n + 1] = out.first[n] + lists.first[from + 1] - lists.first[from];
  }
  out.item.resize(lists.item.size());
  for_all(host, "gridmorph::gather_lists", lists.size(), [&](Index n) {
    auto const list = lists[order[n]];
    std::transform(list.begin(), list.end(), out.item.begin() + out.first[n],
                   [&](Index32 item) { return translation[item]; });
  });
  return out;
}

void translate(std::vector<Index32>& numbers, std::vector<Index32> const& translation) {
  for (Index32& n : numbers) n = translation[n];
}

/// Nodes in patches, connections and faces of subsets.
void translate_nodes(Mesh& mesh, std::vector<Index32> const& new_node) {
  for (auto& patch : mesh.patches) {
    translate(patch.faces.item, new_node);
    translate(patch.nodes, new_node);
    std::sort(patch.nodes.begin(), patch.nodes.end());
  }
  for (auto& connection : mesh.connections) {
    translate(connection.nodes, new_node);
    translate(connection.donor_nodes, new_node);
  }
  for (auto& subset : mesh.subsets) translate(subset.faces.item, new_node);
}

/// Polyhedra in the order of their elements, their nodes translated.
Polyhedra gather(Polyhedra const& polyhedra, std::vector<Index32> const& new_element,
                 std::vector<Index32> const& new_node) {
  std::vector<std::pair<Index32, std::size_t>> moved;  // new number, old place
  for (std::size_t p = 0; p < polyhedra.element.size(); ++p) moved.emplace_back(new_element[polyhedra.element[p]], p);
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
  out.connections = mesh.connections;
  out.families = mesh.families;
  out.subsets = mesh.subsets;
  translate_nodes(out, new_node);
  if (!out.subsets.empty()) {
    auto const new_element = inverse_of(host, order.element);
    for (auto& subset : out.subsets) {
      translate(subset.elements, new_element);
      std::sort(subset.elements.begin(), subset.elements.end());
    }
  }
  if (mesh.coordinates.size() > 0) out.coordinates = gather(host, mesh.coordinates, order.node);
  out.source = mesh.source;
  out.notes = mesh.notes;
  out.first_number = mesh.first_number;
  return out;
}

/// Gives the zones those numbers of nodes, and everything that names nodes their new numbers; the mesh is in the order
/// of its file.
void renumber(Mesh& mesh, std::vector<Index> const& n_nodes, std::vector<Index32> const& new_node) {
  Index first = 0;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    Zone& zone = mesh.zones[z];
    zone.first_node = first;
    if (!zone.is_block()) zone.n_nodes = n_nodes[z];
    first += zone.size();
  }
  translate(mesh.elements.nodes.item, new_node);
  translate(mesh.polyhedra.faces.item, new_node);
  translate_nodes(mesh, new_node);
}

/// Number among all nodes of the file of each of the mesh.
std::vector<Index32> numbers_in(NodesOfFile const& file, Mesh const& mesh) {
  auto const refuse = [&](std::string const& why) {
    throw MeshError(mesh.source + ": " + why + "; give the file that the mesh was read from");
  };
  if (file.n_nodes.size() != mesh.zones.size())
    refuse("has " + std::to_string(mesh.zones.size()) + " zones and its file " + std::to_string(file.n_nodes.size()));
  std::vector<Index32> out(mesh.n_nodes());
  Index first = 0;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    Zone const& zone = mesh.zones[z];
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      Index const place = mesh.file_order.node[n] - zone.first_node;
      if (place >= file.n_nodes[z])
        refuse("zone '" + zone.name + "' has " + std::to_string(file.n_nodes[z]) + " nodes in its file, and node " +
               std::to_string(place + mesh.first_number) + " is wanted");
      out[n] = Index32(first + place);
    }
    first += file.n_nodes[z];
  }
  if (first != file.coordinates.size())
    refuse("zones of its file have " + std::to_string(first) + " nodes, and there are coordinates of " +
           std::to_string(file.coordinates.size()));
  return out;
}

std::vector<Index32> order_nodes(HostInstance const& host, Mesh const& mesh) {
  MeshExtent const box = extent_of(host, mesh.coordinates);
  Vec3 const size = box.high - box.low;
  double const longest = std::max({size.x, size.y, size.z});
  double const steps = longest > 0 ? double(1 << kernels::LatticePlace::bits) / longest : 0;
  std::vector<Index32> order(mesh.n_nodes());
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

/// The elements in the order of the smallest new number among their nodes.
std::vector<Index32> order_elements(HostInstance const& host, Mesh const& mesh, std::vector<Index32> const& new_node) {
  detail::IndexBuckets<Index32> const buckets(host, "gridmorph::order_elements", mesh.n_elements(), mesh.n_nodes(),
                                              [&](Index e, auto const& put) {
                                                Index32 first = new_node[mesh.elements.nodes[e].front()];
                                                for (Index32 const n : mesh.elements.corners(e))
                                                  first = std::min(first, new_node[n]);
                                                put(first, Index32(e));
                                              });
  std::vector<Index32> order(mesh.n_elements());
  buckets.for_each_key([&](Index32, Index at, std::span<Index32 const> elements) {
    std::copy(elements.begin(), elements.end(), order.begin() + at);
  });
  return order;
}

bool stays(std::vector<Index32> const& order, Index first, Index n) {
  for (Index m = first; m < first + n; ++m)
    if (order[m] != m) return false;
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
    order.element.resize(mesh.n_elements());
    std::iota(order.element.begin(), order.element.end(), 0);
  } else {
    order.element = order_elements(host, mesh, inverse_of(host, order.node));
  }
  return order;
}

void reorder(HostInstance const& host, Mesh& mesh, FileOrder order) {
  Index const left_out = mesh.file_order.left_out;
  if (left_out > 0 ? !mesh.file_order.element.empty() : !mesh.file_order.node.empty())
    throw MeshError("reorder: '" + mesh.source + "' is not in the order of its file; put it back with in_file_order()");
  if (Index(order.node.size()) != mesh.n_nodes() || Index(order.element.size()) != mesh.n_elements())
    throw MeshError("reorder: the order is one of " + std::to_string(order.node.size()) + " nodes and " +
                    std::to_string(order.element.size()) + " elements, but '" + mesh.source + "' has " +
                    std::to_string(mesh.n_nodes()) + " and " + std::to_string(mesh.n_elements()));
  for (auto const& zone : mesh.zones)
    if (zone.is_block() &&
        !(stays(order.node, zone.first_node, zone.size()) && stays(order.element, zone.first_element, zone.n_elements)))
      throw MeshError("reorder: the order moves nodes or cells of '" + zone.name + "', a block; leave them in place");
  auto const place = std::move(mesh.file_order.node);
  mesh = permuted(host, mesh, order);
  if (left_out > 0) order.node = gather(host, place, order.node);
  order.left_out = left_out;
  mesh.file_order = std::move(order);
}

Mesh in_file_order(HostInstance const& host, Mesh const& mesh) {
  if (mesh.file_order.node.empty()) return mesh;
  if (mesh.file_order.element.empty()) {  // left nodes to its file, and was not reordered
    Mesh out = mesh;
    out.file_order = {};
    return out;
  }
  return permuted(host, mesh, {inverse_of(host, node_places(mesh)), inverse_of(host, mesh.file_order.element)});
}

Coordinates in_file_order(HostInstance const& host, Mesh const& mesh, Coordinates const& coordinates) {
  if (mesh.file_order.node.empty()) return coordinates;
  return gather(host, coordinates, inverse_of(host, node_places(mesh)));
}

std::vector<double> in_file_order(HostInstance const& host, std::span<Index32 const> place,
                                  std::span<double const> values) {
  std::vector<double> out(values.begin(), values.end());
  for_all(host, "gridmorph::in_file_order", Index(place.size()), [&](Index n) { out[place[n]] = values[n]; });
  return out;
}

Index leave_out_unused_nodes(Mesh& mesh) {
  if (mesh.is_structured() || !mesh.file_order.node.empty()) return 0;
  std::vector<Index32> new_node(mesh.n_nodes(), -1);
  auto const take = [&](std::vector<Index32> const& nodes) {
    for (Index32 const n : nodes) new_node[n] = 0;
  };
  take(mesh.elements.nodes.item);
  for (auto const& patch : mesh.patches) take(patch.faces.item);
  for (auto const& connection : mesh.connections) {
    take(connection.nodes);
    take(connection.donor_nodes);
  }
  for (auto const& subset : mesh.subsets) take(subset.faces.item);
  for (auto const& zone : mesh.zones)
    if (zone.is_block())
      std::fill_n(new_node.begin() + std::ptrdiff_t(zone.first_node), std::size_t(zone.size()), Index32(0));
  auto const unused = Index(std::count(new_node.begin(), new_node.end(), -1));
  if (unused == 0) return 0;

  std::vector<Index> n_nodes;
  std::vector<Index32> place;
  place.reserve(new_node.size() - std::size_t(unused));
  std::vector<Index32> old;
  old.reserve(place.capacity());
  for (auto const& zone : mesh.zones) {
    auto const first = Index32(place.size());
    for (Index n = 0; n < zone.size(); ++n) {
      auto const at = std::size_t(zone.first_node + n);
      if (new_node[at] < 0) continue;
      new_node[at] = Index32(place.size());
      place.push_back(Index32(first + n));
      old.push_back(Index32(at));
    }
    n_nodes.push_back(Index(place.size()) - first);
  }
  // Patches that list nodes say where boundaries are, and there is none at these.
  for (auto& patch : mesh.patches) std::erase_if(patch.nodes, [&](Index32 n) { return new_node[n] < 0; });
  Coordinates used{Index(old.size())};
  for (std::size_t n = 0; n < old.size(); ++n) used.set(Index(n), mesh.coordinates[old[n]]);
  mesh.coordinates = used;
  renumber(mesh, n_nodes, new_node);
  mesh.file_order.node = std::move(place);
  mesh.file_order.left_out = unused;
  return unused;
}

std::vector<Index32> node_places(Mesh const& mesh) {
  auto out = mesh.file_order.node;
  if (mesh.file_order.left_out == 0) return out;
  for (auto const& zone : mesh.zones) {
    auto const begin = out.begin() + std::ptrdiff_t(zone.first_node), end = begin + std::ptrdiff_t(zone.size());
    if (begin == end) continue;
    std::vector<Index32> rank(std::size_t(*std::max_element(begin, end) - zone.first_node) + 1, 0);
    for (auto p = begin; p != end; ++p) rank[*p - zone.first_node] = 1;
    std::exclusive_scan(rank.begin(), rank.end(), rank.begin(), Index32(zone.first_node));
    for (auto p = begin; p != end; ++p) *p = rank[*p - zone.first_node];
  }
  return out;
}

Mesh with_all_nodes(Mesh const& mesh, NodesOfFile const& file) {
  auto const number = numbers_in(file, mesh);
  Mesh out = in_file_order(mesh);
  std::vector<Index32> new_node(number.size());
  auto const place = node_places(mesh);
  for (std::size_t n = 0; n < number.size(); ++n) new_node[place[n]] = number[n];
  renumber(out, file.n_nodes, new_node);
  out.coordinates = file.coordinates;
  return out;
}

Coordinates with_all_nodes(Mesh const& mesh, NodesOfFile const& file, Coordinates const& coordinates) {
  auto const number = numbers_in(file, mesh);
  Coordinates out(file.coordinates.size());
  for (Index n = 0; n < out.size(); ++n) out.set(n, file.coordinates[n]);
  for (std::size_t n = 0; n < number.size(); ++n) out.set(number[n], coordinates[Index(n)]);
  return out;
}

std::vector<double> with_all_nodes(Mesh const& mesh, NodesOfFile const& file, std::span<double const> values) {
  auto const number = numbers_in(file, mesh);
  std::vector<double> out(file.coordinates.size(), 0.0);
  for (std::size_t n = 0; n < number.size(); ++n) out[number[n]] = values[n];
  return out;
}

}  // namespace gridmorph
