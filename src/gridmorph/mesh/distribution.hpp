// How the nodes of a mesh of blocks are shared out among ranks; internal.
#pragma once

#include <gridmorph/core/ranks.hpp>
#include <gridmorph/mesh/first_box.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

/// Nodes that a rank has.
struct Part {
  int zone = -1;
  IndexRange nodes{};
  int rank = -1;
  Index first_node = 0;  ///< of the part in the arrays of its rank; set by the Distribution

  /// From a node to the next along i, j, k in the arrays of its rank: i varies fastest.
  [[nodiscard]] std::array<Index, 3> strides() const {
    return {1, Index(nodes.extent(0)), Index(nodes.extent(0)) * nodes.extent(1)};
  }
  /// Where a node of the part stands there.
  [[nodiscard]] Index node(Index3 const& p) const {
    auto const stride = strides();
    Index3 const at = minus(p, nodes.begin);
    return first_node + at[0] + at[1] * stride[1] + at[2] * stride[2];
  }
};

/// The parts of all ranks. They cover the zones and may overlap: planes that neighbours share, layers of ghost nodes. A
/// rank may have any number of them or none, anywhere. Node arrays of a rank have its parts in the order of the list,
/// one after another.
///
/// The home of a node is the first part that holds it: of its copies the one that others ask for. Parts are no zones:
/// numbers of nodes and all messages are those of the mesh as a whole, whoever has its nodes.
///
/// Memory: O(zones + parts), on every rank, see FirstBox; no node is looked at.
class Distribution {
 public:
  /// The same zones and parts on all ranks; collective. Coordinates of the mesh are not read. Throws MeshError, on all
  /// ranks: lists that differ, a part that is empty or leaves its zone, a rank that is not there, a zone of elements, a
  /// node in no part.
  Distribution(std::shared_ptr<Ranks const> ranks, BoundaryMesh const& mesh, std::vector<Part> parts);

  [[nodiscard]] Ranks const& ranks() const { return *ranks_; }
  [[nodiscard]] std::span<Part const> parts() const { return parts_; }
  /// Those of this rank.
  [[nodiscard]] std::span<Part const> own() const { return own_; }
  /// Number of nodes in own parts: copies count.
  [[nodiscard]] Index n_nodes() const { return n_nodes_; }

  /// The first part that holds a node.
  [[nodiscard]] Part const& home(int zone, Index3 const& node) const;
  /// The part in which a cell (between nodes i and i + 1, ...) counts where cells are summed up: the first that holds
  /// all its corners; the home of its first corner where none does, as where parts share no nodes.
  [[nodiscard]] Part const& home_of_cell(int zone, Index3 const& cell) const;

  /// The boxes that the nodes of `box` make up with their homes, in an order that is the same on all ranks.
  struct HomeBox {
    int part = -1;
    IndexRange nodes{};
  };
  [[nodiscard]] std::vector<HomeBox> homes(NodeBox const& box) const;

 private:
  /// A zone, with the numbers of its parts.
  struct ZoneParts {
    std::vector<int> parts;
    detail::FirstBox nodes, cells;
  };

  void check_lists() const;
  void check_part(Part const& part) const;
  [[nodiscard]] std::vector<std::vector<int>> parts_by_zone() const;
  [[nodiscard]] ZoneParts zone_parts(int zone, std::vector<int> parts) const;
  void check_covered(int zone) const;
  void check_inside(NodeBox const& box) const;

  std::shared_ptr<Ranks const> ranks_;
  BoundaryMesh mesh_;  ///< zones alone, for messages
  std::vector<Part> parts_, own_;
  std::vector<ZoneParts> zones_;
  Index n_nodes_ = 0;
};

}  // namespace gridmorph
