#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/element_shapes.hpp>
#include <gridmorph/guard/detail/shape_step.hpp>
#include <gridmorph/kernels/vector_array.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gridmorph::detail {

namespace {

void edges(ElementCorner const& corner, Coordinates const& x, Vec3 (&edge)[3]) {
  for (std::size_t d = 0; d < 3; ++d) edge[d] = x[corner.node[d + 1]] - x[corner.node[0]];
}

using Ends = std::array<std::int8_t, 3>;

/// The corners at the other ends of the edges of a corner.
Ends ends_of(ElementType type, int corner) {
  auto const around = [](int k, int n) { return Ends{std::int8_t((k + 1) % n), std::int8_t((k + n - 1) % n), 0}; };
  Ends out{};
  switch (type) {
    case ElementType::tetrahedron: return {1, 2, 3};
    case ElementType::pyramid:
      out = around(corner, 4);
      out[2] = 4;
      return out;
    case ElementType::prism:
    case ElementType::hexahedron: {
      int const n = type == ElementType::prism ? 3 : 4, side = corner / n;
      out = around(corner % n, n);
      for (int d = 0; d < 2; ++d) out[d] = std::int8_t(out[d] + n * side);
      out[2] = std::int8_t(corner % n + n * (1 - side));
      return out;
    }
    default: return out;
  }
}

int n_shape_corners(ElementType type) {
  switch (type) {
    case ElementType::tetrahedron: return 1;
    case ElementType::pyramid: return 4;
    case ElementType::prism: return 6;
    case ElementType::hexahedron: return 8;
    default: return 0;
  }
}

}  // namespace

ElementShapes::ElementShapes(Mesh const& mesh, UnstructuredTopology const& topology, std::span<Index32 const> nodes,
                             std::span<std::pair<Index32, Index32> const> copies)
    : mesh_(mesh) {
  for (Index32 const n : nodes) {
    nodes_.push_back(n);
    auto copy = std::lower_bound(copies.begin(), copies.end(), std::pair(n, Index32(-1)));
    for (; copy != copies.end() && copy->first == n; ++copy) nodes_.push_back(copy->second);
    first_node_.push_back(Index(nodes_.size()));
  }
  find_corners(topology);
  colour();
}

void ElementShapes::add_corners(Index32 element) {
  ElementType const type = mesh_.elements.type[element];
  if (type == ElementType::polyhedron) return add_corners_of_polyhedron(element);
  auto const nodes = mesh_.elements.corners(element);
  for (int c = 0; c < n_shape_corners(type); ++c) {
    Ends const ends = ends_of(type, c);
    corners_.push_back({element, {nodes[c], nodes[ends[0]], nodes[ends[1]], nodes[ends[2]]}});
  }
}

void ElementShapes::add_corners_of_polyhedron(Index32 element) {
  std::vector<std::pair<Index32, Index32>> ends;  // node, the one at the other end of an edge
  std::array<Index32, max_face_corners> unused;
  for (int f = 0; f < n_sides(mesh_, element); ++f) {
    auto const face = side_nodes(mesh_, element, f, unused);
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = face[k], b = face[(k + 1) % face.size()];
      ends.emplace_back(a, b);
      ends.emplace_back(b, a);
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (std::size_t begin = 0, end; begin < ends.size(); begin = end) {
    for (end = begin; end < ends.size() && ends[end].first == ends[begin].first; ++end) {
    }
    if (end - begin == 3)
      corners_.push_back(
          {element, {ends[begin].first, ends[begin].second, ends[begin + 1].second, ends[begin + 2].second}});
  }
}

void ElementShapes::find_corners(UnstructuredTopology const& topology) {
  std::vector<Index32> elements, place(std::size_t(mesh_.n_elements()), -1);
  for (Index32 const n : nodes_)
    for (Index32 const e : topology.elements_of_nodes[n])
      if (place[e] < 0) {
        place[e] = 0;
        elements.push_back(e);
      }
  std::sort(elements.begin(), elements.end());
  std::vector<Index> first{0};  // corner of each of them
  for (std::size_t at = 0; at < elements.size(); ++at) {
    place[elements[at]] = Index32(at);
    add_corners(elements[at]);
    element_of_corner_.resize(corners_.size(), Index32(at));
    first.push_back(Index(corners_.size()));
  }
  for (ElementCorner const& corner : corners_) {
    Vec3 edge[3];
    edges(corner, mesh_.coordinates, edge);
    baseline_.push_back(kernels::BaselineCorner::of(edge));
  }
  std::vector<Change> found;
  for (std::size_t p = 0; p + 1 < first_node_.size(); ++p) {
    found.clear();
    for (Index m = first_node_[p]; m < first_node_[p + 1]; ++m) {
      Index32 const node = nodes_[m];
      for (Index32 const e : topology.elements_of_nodes[node]) {
        auto const at = std::size_t(place[e]);
        for (Index c = first[at]; c < first[at + 1]; ++c) {
          auto const& of_corner = corners_[c].node;
          unsigned roles = 0;
          for (unsigned k = 0; k < 4; ++k) roles |= of_corner[k] == node ? 1u << k : 0u;
          if (roles != 0 && baseline_[c].inverse_det != 0) found.push_back({Index32(c), std::uint8_t(roles)});
        }
      }
    }
    std::stable_sort(found.begin(), found.end(), [](auto const& a, auto const& b) { return a.corner < b.corner; });
    for (Change const& change : found) {
      bool const again = Index(changes_.size()) > first_change_.back() && changes_.back().corner == change.corner;
      if (again)
        changes_.back().roles |= change.roles;
      else
        changes_.push_back(change);
    }
    first_change_.push_back(Index(changes_.size()));
  }
}

void ElementShapes::colour() {
  std::size_t const n_points = first_node_.size() - 1;
  // Elements that a point changes, each once: those of its corners stand side by side.
  auto const for_each_element = [&](std::size_t p, auto const& visit) {
    Index32 last = -1;
    for (Index c = first_change_[p]; c < first_change_[p + 1]; ++c)
      if (Index32 const e = element_of_corner_[changes_[c].corner]; e != last) visit(std::size_t(last = e));
  };
  std::size_t const n_elements = element_of_corner_.empty() ? 0 : std::size_t(element_of_corner_.back()) + 1;
  std::vector<Index> first(n_elements + 1, 0);
  for (std::size_t p = 0; p < n_points; ++p) for_each_element(p, [&](std::size_t e) { ++first[e + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Index32> users(first.back());
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (std::size_t p = 0; p < n_points; ++p) for_each_element(p, [&](std::size_t e) { users[next[e]++] = Index32(p); });
  std::vector<Index32> colour(n_points, -1), taken_by;
  for (std::size_t p = 0; p < n_points; ++p) {
    for_each_element(p, [&](std::size_t e) {
      for (Index u = first[e]; u < first[e + 1]; ++u)
        if (Index32 const k = colour[users[u]]; k >= 0) taken_by[k] = Index32(p);
    });
    std::size_t free = 0;
    while (free < taken_by.size() && taken_by[free] == Index32(p)) ++free;
    if (free == taken_by.size()) {
      taken_by.push_back(-1);
      colours_.emplace_back();
    }
    colour[p] = Index32(free);
    colours_[free].push_back(Index32(p));
  }
}

double ElementShapes::smallest_volume(Coordinates const& x) const {
  double smallest = HUGE_VAL;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (baseline_[c].inverse_det == 0) continue;
    Vec3 edge[3];
    edges(corners_[c], x, edge);
    smallest = std::min(smallest, baseline_[c].inverse_det * dot(cross(edge[0], edge[1]), edge[2]));
  }
  return smallest;
}

void ElementShapes::move(Index32 point, double delta, double relaxation, Coordinates& x,
                         std::vector<kernels::CornerChange>& changes) const {
  auto const p = std::size_t(point);
  changes.clear();
  for (Index c = first_change_[p]; c < first_change_[p + 1]; ++c) {
    Change const& at = changes_[c];
    Vec3 edge[3];
    edges(corners_[at.corner], x, edge);
    double share[3];
    for (int d = 0; d < 3; ++d) share[d] = double(at.roles >> (1 + d) & 1) - double(at.roles & 1);
    changes.push_back(corner_change(baseline_[at.corner], edge, share));
  }
  Coordinates const& before = mesh_.coordinates;
  Index32 const own = nodes_[first_node_[p]];
  make_shape_step(
      changes, x[own] - before[own], delta, relaxation, [](kernels::ShapeSum&) {}, [](Vec3 const& u) { return u; },
      [&](Vec3 const& u) {
        for (Index m = first_node_[p]; m < first_node_[p + 1]; ++m) x.set(nodes_[m], before[nodes_[m]] + u);
      });
}

void ElementShapes::smooth(int sweeps, double relaxation, Coordinates& x) const {
  UntanglingSchedule schedule(sweeps);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double const delta = schedule.delta(sweep, [&] { return smallest_volume(x); });
    for (std::vector<Index32> const& colour : colours_)
      sweep_colour({}, "gridmorph::element_shapes::sweep", colour,
                   [&](Index32 point, auto& changes) { move(point, delta, relaxation, x, changes); });
  }
}

}  // namespace gridmorph::detail
