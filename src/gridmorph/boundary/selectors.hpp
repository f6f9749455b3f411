// What a selector of a motion rule names: patches and interfaces of a mesh.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Whether text matches a pattern of literal characters, `*` (any run, also empty) and `?` (any one character).
bool glob_match(std::string_view pattern, std::string_view text);

/// What interfaces of blocks and connections of elements have in common.
struct AnyConnection {
  int number = 0;  ///< Mesh::interfaces first, then Mesh::connections
  std::string const& name;
  std::vector<std::string> const& families;
  int zone = -1, donor_zone = -1;
  std::optional<Periodic> const& periodic;
  std::string_view zone_in_file{};  ///< as Interface1to1 has it
};
/// All connections of a mesh, which must outlive them.
std::vector<AnyConnection> connections_of(BoundaryMesh const& mesh);

/// The patches and connections selected, by their numbers in Mesh::patches and connections_of(), ascending.
struct Selection {
  std::vector<int> patches;
  std::vector<int> interfaces;  ///< by family or `type:periodic`: periodic ones; by their own name: plain ones too
  [[nodiscard]] bool empty() const { return patches.empty() && interfaces.empty(); }
};

/// `type:KIND` by kind; otherwise the first of these that the selector matches: families, BC names, connection and
/// interface names. A selector with a `/` matches BC and connection names as "zone/name" as well. Empty when nothing
/// matches. Throws MotionError for a KIND there is not.
Selection select(BoundaryMesh const& mesh, std::string const& selector);

/// Numbers of the patches a list of selectors names, ascending. Case-sensitive; family first, then BC name, then
/// connection name: a selector that matches a family takes that family's patches only. "zone/name" addresses a BC or
/// connection of one zone. Throws one MotionError for all selectors that name no patch; it lists what there is.
std::vector<int> select_patches(BoundaryMesh const& mesh, std::vector<std::string> const& selectors);

/// "there are families: ...; regions: ..." of what the mesh has, for messages; BC names, connections and types where it
/// has no families.
std::string describe_selectable(BoundaryMesh const& mesh);

/// Why a selector is no use: what was probably meant, and what there is.
std::string matches_nothing(BoundaryMesh const& mesh, std::string const& selector);

/// A list of names in quotes, for messages: "'a', 'b', 'c' and 4 more".
std::string quote_list(std::vector<std::string> const& names, std::size_t at_most = 30);

/// Family name if there is one, otherwise the connection's own name: how users know it.
std::string describe_interface(BoundaryMesh const& mesh, AnyConnection const& interface);

/// The patches and connections of a mesh, which must outlive it, as rules name them: by what they are called and what
/// kind they are of, wherever their nodes may be.
class NamedBoundary {
 public:
  explicit NamedBoundary(BoundaryMesh const& mesh) : mesh_(&mesh) {}

  [[nodiscard]] std::vector<Patch> const& patches() const { return mesh_->patches; }
  [[nodiscard]] std::vector<AnyConnection> connections() const { return connections_of(*mesh_); }
  /// The functions of these names above.
  [[nodiscard]] Selection select(std::string const& selector) const { return gridmorph::select(*mesh_, selector); }
  [[nodiscard]] std::vector<int> select_patches(std::vector<std::string> const& selectors) const {
    return gridmorph::select_patches(*mesh_, selectors);
  }
  [[nodiscard]] std::string matches_nothing(std::string const& selector) const {
    return gridmorph::matches_nothing(*mesh_, selector);
  }
  [[nodiscard]] std::string describe_patch(int patch) const {
    return gridmorph::describe_patch(*mesh_, mesh_->patches[patch]);
  }
  [[nodiscard]] std::string describe_interface(AnyConnection const& interface) const {
    return gridmorph::describe_interface(*mesh_, interface);
  }
  /// The other side of a connection that the file stores twice, by their numbers, or -1.
  [[nodiscard]] int other_side(int connection) const;

 private:
  BoundaryMesh const* mesh_;
};

}  // namespace gridmorph
