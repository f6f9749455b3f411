#include <gridmorph/core/for_all.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <iterator>
#include <numeric>

namespace gridmorph {

namespace {

/// The other ends of the edges at a node, most of them once: as long as a place of the table has only one of them.
class Ends {
 public:
  std::vector<Index32> list;

  void begin(Index32 node) {
    list.clear();
    own_ = std::uint64_t(node + 1) << 32;
  }
  void add(Index32 end) {
    std::uint64_t& place = last_[std::size_t(end) % last_.size()];
    if (place == (own_ | std::uint64_t(end))) return;
    place = own_ | std::uint64_t(end);
    list.push_back(end);
  }

 private:
  std::uint64_t own_ = 0;
  std::array<std::uint64_t, 512> last_{};  ///< node and end last seen there
};

class GraphMaker {
 public:
  GraphMaker(HostInstance const& host, Mesh const& mesh, CsrGraph const& elements_of_nodes, std::span<int const> groups)
      : host_(host),
        mesh_(mesh),
        elements_of_nodes_(elements_of_nodes),
        owner_(nodes_at_one_place(host, mesh, groups)) {
    for (Index32 n = 0; n < Index32(owner_.size()); ++n)
      if (owner_[n] != n) others_.push_back({owner_[n], n});
    std::sort(others_.begin(), others_.end());
  }

  NodeGraph run() && {
    Index const n = mesh_.n_nodes();
    CsrGraph lists;
    lists.first.assign(n + 1, 0);
    // Every part keeps its lists to itself until it is known where they go.
    constexpr Index part = 4096;
    std::vector<std::vector<Index32>> found((n + part - 1) / part);
    detail::for_all_parts(host_, "gridmorph::node_graph::find", Index(found.size()), [&](Index p) {
      Ends ends;
      for (Index node = p * part; node < std::min(n, (p + 1) * part); ++node) {
        neighbours(Index32(node), ends);
        lists.first[node + 1] = std::ssize(ends.list);
        found[p].insert(found[p].end(), ends.list.begin(), ends.list.end());
      }
    });
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    lists.item.resize(lists.first.back());
    detail::for_all_parts(host_, "gridmorph::node_graph::join", Index(found.size()), [&](Index p) {
      auto const& own = found[p];
      std::copy(own.begin(), own.end(), lists.item.begin() + lists.first[p * part]);
    });
    return {std::move(owner_), std::move(lists)};
  }

 private:
  struct Other {
    Index32 owner, node;
    auto operator<=>(Other const&) const = default;
  };

  /// Neighbours of a representative, ascending; none of another node.
  void neighbours(Index32 node, Ends& ends) const {
    ends.begin(node);
    if (owner_[node] != node) return;
    add_ends(node, node, ends);
    for (auto at = std::lower_bound(others_.begin(), others_.end(), Other{node, 0});
         at != others_.end() && at->owner == node; ++at)
      add_ends(at->node, node, ends);
    std::sort(ends.list.begin(), ends.list.end());
    ends.list.erase(std::unique(ends.list.begin(), ends.list.end()), ends.list.end());
  }

  /// Owners of the other ends of all edges at a node.
  void add_ends(Index32 node, Index32 own, Ends& ends) const {
    auto const add = [&](Index32 end) {
      if (Index32 const other = owner_[end]; other != own) ends.add(other);
    };
    for (Index32 const e : elements_of_nodes_[node]) {
      ElementType const type = mesh_.elements.type[e];
      auto const nodes = mesh_.elements.corners(e);
      if (type == ElementType::polyhedron) {
        add_polyhedron(node, e, add);
      } else if (type == ElementType::tetrahedron) {
        for (std::size_t k = 0; k < 4; ++k) add(nodes[k]);
      } else {
        for (int k = 0; k < n_edges(type); ++k) {
          Index32 const a = nodes[edge_corner(type, k, 0)], b = nodes[edge_corner(type, k, 1)];
          if (a == node || b == node) add(a == node ? b : a);
        }
      }
    }
  }

  template <class Add>
  void add_polyhedron(Index32 node, Index element, Add const& add) const {
    for (int s = 0; s < n_sides(mesh_, element); ++s) {
      std::array<Index32, max_face_corners> room{};
      auto const face = side_nodes(mesh_, element, s, room);
      for (std::size_t k = 0; k < face.size(); ++k) {
        Index32 const next = face[(k + 1) % face.size()];
        if (face[k] == node) add(next);
        if (next == node) add(face[k]);
      }
    }
  }

  HostInstance const& host_;
  Mesh const& mesh_;
  CsrGraph const& elements_of_nodes_;
  std::vector<Index32> owner_;
  std::vector<Other> others_;  ///< nodes that are not their own owner
};

}  // namespace

NodeGraph make_node_graph(HostInstance const& host, Mesh const& mesh, CsrGraph const& elements_of_nodes,
                          std::span<int const> groups) {
  return GraphMaker(host, mesh, elements_of_nodes, groups).run();
}

}  // namespace gridmorph
