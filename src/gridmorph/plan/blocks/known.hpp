// What is known while a plan is being made: which entities have their displacement, and what they rank as.
#pragma once

#include <gridmorph/plan/topology.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Kinds that chain ends rank by: the patch kinds, then periodic.
using EndKind = int;
inline constexpr EndKind periodic_end = 100;
inline constexpr EndKind unknown_end = -1;
inline constexpr int no_body = -1;
inline EndKind end_kind(PatchKind kind) { return kind == PatchKind::periodic ? periodic_end : int(kind); }
/// Patches that the priority names have kinds of their own, which hold what they are besides.
inline constexpr EndKind named_ends = 1000;
inline EndKind named_end(int number, EndKind kind) { return named_ends * (number + 1) + kind % named_ends; }
inline std::string_view end_kind_name(EndKind named_or_not) {
  EndKind const kind = named_or_not % named_ends;
  return kind == periodic_end ? "periodic" : (kind == unknown_end ? "open" : to_string(PatchKind(kind)));
}

/// What is known of each entity class of the lattice.
struct Known {
  std::vector<char> known;
  std::vector<EndKind> kind;
  std::vector<std::vector<int>> patches;  ///< whose kind that is, ascending: Mesh::patches, then Mesh::interfaces
  std::vector<char> turns;                ///< whether its displacement comes with a rotation
  std::vector<int> body;  ///< whose rotation that is, where it is one body's; see WallRoots::centre_of_body()

  explicit Known(int n_classes)
      : known(n_classes, 0),
        kind(n_classes, unknown_end),
        patches(n_classes),
        turns(n_classes, 0),
        body(n_classes, no_body) {}
  [[nodiscard]] bool operator()(int entity_class) const { return known[entity_class] != 0; }
};

}  // namespace gridmorph
