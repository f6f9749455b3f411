// A mesh of either kind with what follows from it alone: what plans, measures, guards and pictures read beside it.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <memory>
#include <vector>

namespace gridmorph {

class Boundary;
struct Certificate;

/// A mesh with the neighbours of its elements, the patches of its boundary faces, and the orientation of its zones or
/// elements. Blocks have no need of the former; orientations are found when they are first asked for, by one pass over
/// the cells. Copies share their insides, and may be read by several threads.
class IndexedMesh {
 public:
  /// Throws MeshError for a mesh that check_mesh() refuses. Cost: of elements O(elements), of blocks nothing.
  IndexedMesh(HostInstance const& host, Mesh mesh);
  explicit IndexedMesh(Mesh mesh) : IndexedMesh(HostInstance(), std::move(mesh)) {}

  [[nodiscard]] Mesh const& mesh() const;
  /// The mesh alone, and the rest goes; where other copies have it too, a copy.
  [[nodiscard]] Mesh take_mesh() &&;
  [[nodiscard]] bool is_structured() const;
  [[nodiscard]] Index n_nodes() const { return mesh().n_nodes(); }
  /// The number of cells of blocks, or of elements.
  [[nodiscard]] Index n_cells() const;

  /// The neighbours of elements; empty of blocks.
  [[nodiscard]] UnstructuredTopology const& topology() const;
  /// The patches of the boundary faces of elements; empty of blocks.
  [[nodiscard]] BoundaryFacePatches const& face_patches() const;
  /// zone_handedness() of blocks, (zones).
  [[nodiscard]] std::vector<int> const& handedness() const;
  /// numbering_signs() of elements, (n_elements).
  [[nodiscard]] std::vector<signed char> const& signs() const;

  /// The patches with their nodes and facets. Cost: O(boundary).
  [[nodiscard]] Boundary boundary() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Looks at every cell of these zones, all where none are named, on the default host instance: certify() of
/// quality/validity.hpp against the mesh itself.
Certificate certify(IndexedMesh const& mesh, Coordinates const& morphed, std::vector<int> zones = {});

}  // namespace gridmorph
