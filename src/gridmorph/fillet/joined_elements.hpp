// Elements of all zones around a place: nodes that connections put at one place are one here.
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <span>
#include <unordered_map>
#include <vector>

namespace gridmorph {

/// The elements of a mesh around places that zones share. Refers to its mesh and topology. A place is known by the
/// smallest number among its nodes (nodes_at_one_place()).
class JoinedElements {
 public:
  JoinedElements(Mesh const& mesh, UnstructuredTopology const& topology);

  [[nodiscard]] Mesh const& mesh() const { return mesh_; }
  [[nodiscard]] UnstructuredTopology const& topology() const { return topology_; }
  [[nodiscard]] Index32 place(Index32 node) const { return place_[std::size_t(node)]; }
  /// All nodes at a place.
  [[nodiscard]] std::vector<Index32> nodes_at(Index32 place) const;
  /// Elements that have a place among their corners, ascending in each zone.
  [[nodiscard]] std::vector<Index32> around(Index32 place) const;
  /// The elements that have all of some places among their corners.
  [[nodiscard]] std::vector<Index32> with(std::span<Index32 const> places) const;
  [[nodiscard]] bool has(Index32 element, Index32 place) const;
  /// The corner of an element at a place; -1: none.
  [[nodiscard]] Index32 node_at(Index32 element, Index32 place) const;
  [[nodiscard]] Vec3 position(Index32 place) const { return mesh_.coordinates[place]; }

 private:
  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  std::vector<Index32> place_;
  std::unordered_map<Index32, std::vector<Index32>> further_;  ///< nodes at places that have several
};

}  // namespace gridmorph
