// What a mesh consists of, in the terms that a case file can use.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/run/block_summary.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct Box {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf};

  void add(Vec3 const& p);
  void add(Box const& other);
};

struct ZoneSummary {
  std::string name;
  Index3 extent;
  Index nodes = 0;
  Box box;
};

/// Patches that one selector of a case file names together.
struct BoundarySummary {
  enum class Source { family, boundary_condition, connection };
  std::string selector;
  Source source = Source::family;
  std::vector<PatchKind> kinds;       ///< usually one
  std::vector<std::string> bc_types;  ///< as in the file, each once
  std::vector<std::string> names;     ///< BC or connection names, each once
  std::vector<int> patches;           ///< numbers in Mesh::patches
  Index nodes = 0;                    ///< nodes that several patches share count once per patch
  Box box;
  double first_height_min = 0, first_height_mean = 0;  ///< distance to the next node off the face [length]
  int cells_across = 0;                                ///< of the thinnest zone, from the face to the opposite one
  std::string guess;                                   ///< what its shape suggests; empty: nothing in particular
  Index faces = 0;                                     ///< of unstructured meshes
  bool flat = false;         ///< each of its patches lies in a plane, so that nodes can slide on it
  bool paired = false;       ///< of unstructured meshes: periodic connections pair all of its nodes
  int enclosed = 0;          ///< directions x, y, z in which it keeps off the mesh's own limits on both sides
  std::vector<int> touches;  ///< numbers of the boundaries that share nodes with it, ascending
};

/// Periodic interfaces that share their transform.
struct PeriodicSummary {
  std::vector<std::string> names;  ///< as case files can use them, each once
  std::vector<std::string> zones;  ///< "Zone 1 - Zone 2", each once
  int interfaces = 0;
  double angle_deg = 0;  ///< rotation, positive; 0: translation
  Axis axis;             ///< of the rotation
  Vec3 translation;
  int sectors = 0;  ///< of a full wheel; 0 when the angle is no share of one
};

struct MeshSummary {
  std::string source, file_variant;  ///< as in Mesh
  std::vector<ZoneSummary> zones;
  std::vector<std::string> families;         ///< all of the file
  std::vector<std::string> unused_families;  ///< no patch has them
  std::vector<BoundarySummary> boundaries;
  std::vector<PeriodicSummary> periodics;
  int interfaces = 0;        ///< 1-to-1, periodic ones included, as stored
  int self_interfaces = 0;   ///< of a zone with itself, not periodic
  std::optional<Axis> axis;  ///< of the periodic rotation, if all agree
  Box box;
  Index nodes = 0, cells = 0;
  bool two_dimensional = false;
  bool unstructured = false;            ///< then zones, periodics and blocks are not filled in
  std::vector<std::string> notes;       ///< of the reader
  std::vector<std::string> problems;    ///< what a morph would refuse
  bool remedied = false;                ///< with the two settings below it would not
  double needed_tolerance = 0;          ///< matching_tolerance with which interfaces match; 0: the default does
  bool open_faces = false;              ///< some faces are claimed by nothing
  std::optional<BlocksSummary> blocks;  ///< only without problems
};

/// Axis, angle and sectors, or the translation, without names. `fitted`: what matched nodes say, where there are any;
/// it counts before what the file declares. The dominant component of the direction is positive, so that both sides of
/// a pair have one axis.
PeriodicSummary describe_periodic(Periodic const& declared, RigidTransform const* fitted, double size);

/// Fills BoundarySummary::touches. nodes[b]: those of boundary b, nodes that coincide by one number less than n_nodes.
void find_touching(std::vector<BoundarySummary>& boundaries, std::vector<std::vector<Index>> const& nodes,
                   Index n_nodes);

/// Cost: O(nodes) for extents, O(boundary nodes) for the rest.
MeshSummary summarize(Mesh const& mesh);

}  // namespace gridmorph::cli
