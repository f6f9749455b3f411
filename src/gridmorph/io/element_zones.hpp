// Zones of elements, one by one into a CGNS file, by their faces where they have to be. Internal to io.
#pragma once

#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::io {

/// The elements of a zone by their faces, each face once: what NGON_n and NFACE_n sections hold.
class ZoneFaces {
 public:
  /// Corners alone: nodes amid the edges of second-order elements are on no face. Faces are numbered in the order of
  /// the elements that have them first, their nodes as these see them from outside. Throws MeshError for a face of more
  /// than two elements. Cost O(n log n) in faces.
  ZoneFaces(Mesh const& mesh, Zone const& zone);

  /// Nodes of the mesh around each face.
  [[nodiscard]] CsrGraph const& faces() const { return faces_; }
  /// Faces of each element of the zone, from 1 on; negative where the normal points into it.
  [[nodiscard]] CsrGraph const& elements() const { return elements_; }
  /// The face with these nodes in any order; -1 where there is none.
  [[nodiscard]] Index find(std::span<Index32 const> nodes) const;

 private:
  CsrGraph faces_, elements_;
  std::vector<std::pair<std::uint64_t, Index32>> by_key_;  ///< sorted
};

/// Writes the zones of a mesh with their elements, patches and connections. Nodes, elements, faces and connections of a
/// zone are numbered from its first node and first element on; zones may share them, as the copies of a passage in a
/// wheel do. A zone with polyhedra is written by its faces, NGON_n and NFACE_n, as the standard asks for all of its
/// elements then.
class ElementZoneWriter {
 public:
  /// The mesh, in the order of its file and without coordinates, must outlive the writer.
  ElementZoneWriter(cgns::File& file, Mesh const& mesh, WriteOptions const& options);

  void begin();
  /// Writes zone z. values: x, y, z of its nodes. Throws IoError for elements and faces that cannot be written.
  void zone(int z, std::array<double const*, 3> const& values);

 private:
  double base(std::string const& name);
  void coordinates(Zone const& zone, double zone_id, std::array<double const*, 3> const& values);
  /// Writes one section: `types` of its elements and their 1-based nodes, one after another. MIXED unless all types are
  /// equal.
  void section(double zone_id, std::string const& name, Index first, std::vector<std::int32_t> const& types,
               std::vector<Index> const& start, std::vector<std::int32_t> const& nodes);
  /// Writes the elements of a zone; returns the next element number.
  Index elements(Zone const& zone, double zone_id, std::set<std::string>& taken);
  ZoneFaces const& faces_of(Zone const& zone);
  /// Writes the elements of a zone with polyhedra; returns the next element number.
  Index elements(Zone const& zone, ZoneFaces const& faces, double zone_id, std::set<std::string>& taken);
  double elements_node(double zone_id, std::string const& name, std::int32_t type, Index first, Index size);
  void family_names(double parent, std::vector<std::string> const& families);
  void boundary(int z, ZoneFaces const* faces, double zone_id, Index next, std::set<std::string>& sections);
  /// Writes where the faces of a patch are, by their numbers.
  void listed_faces(Patch const& patch, ZoneFaces const& faces, double bc_id);
  void points(double parent, char const* name, std::vector<Index32> const& nodes, Zone const& zone);
  void connections(int z, double zone_id);
  void periodic(double connection, Periodic const& p);

  cgns::File& file_;
  Mesh const& mesh_;
  WriteOptions options_;
  std::map<std::string, double> bases_;
  std::map<Index, ZoneFaces> faces_;  ///< by first elements, which zones may share
};

/// The bytes that the elements of a mesh take in a file; somewhat more than the file will take.
std::uint64_t bytes_of_elements(Mesh const& mesh);

}  // namespace gridmorph::io
