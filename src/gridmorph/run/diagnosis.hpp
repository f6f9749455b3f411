// What is said when a morph went wrong: where its worst cell is, and what of the case file looks like the cause.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// A mesh of either kind as messages need it. What it is made from must outlive it.
struct MeshForMessages {
  Mesh const& selectable;  ///< patches that selectors name
  Coordinates const& baseline;
  double size = 0;  ///< of the mesh
  std::vector<std::string> patch_names;
  std::vector<std::vector<Index>> patch_nodes;
  std::vector<Vec3> (*corners)(void const* mesh, FallenCells const& cell, Coordinates const& at) = nullptr;
  void const* mesh = nullptr;
};

MeshForMessages for_messages(Mesh const& mesh);
/// The same of elements. boundary: of `mesh`.
MeshForMessages for_messages(Mesh const& mesh, Boundary const& boundary);

/// The worst of the cells that a morph inverted: "the worst is zone 'A' cell (i 3, j 1, k 7) at (1, 2, 3), 0.002 from
/// patch 'blade' in the baseline: its smallest corner Jacobian is -35.2 times the largest it had". Empty where none is.
/// Cost: nodes of all patches.
std::string describe_worst_inverted(MeshForMessages const& mesh, QualityReport const& quality,
                                    Coordinates const& morphed);

/// The first cell that a certificate says is broken, or the worst inverted one where there is none: "zone 'A' cell (i
/// 3, j 1, k 7) is inside out, at (1, 2, 3), ... from patch 'blade'". Empty where all are sound.
std::string describe_first_broken(MeshForMessages const& mesh, QualityReport const& quality,
                                  Coordinates const& morphed);

/// What may be wrong with the rules of a case file whose mesh came out bad: displacements larger than what they move
/// and points far from their patches (another unit), axes of rotation that are far away. One sentence each. Cost: nodes
/// of the patches that the rules name.
std::vector<std::string> likely_causes(CaseFile const& case_file, MeshForMessages const& mesh,
                                       Coordinates const& morphed);

/// A sentence where the axis of [mesh] is none that the periodic interfaces of the mesh turn about.
std::optional<std::string> axis_mismatch(Mesh const& mesh, Axis const& axis);

struct Diagnosis {
  std::string worst;                ///< describe_worst_inverted()
  std::vector<std::string> causes;  ///< likely_causes()
};

Diagnosis diagnose(CaseFile const& case_file, MeshForMessages const& mesh, QualityReport const& quality,
                   Coordinates const& morphed);

/// Why `output` is not written: `what` went wrong, the worst cell, what can be done, likely causes. Lines for
/// Console::error.
std::string refusal(std::string const& output, std::string const& what, Diagnosis const& diagnosis,
                    std::string const& what_to_do);

}  // namespace gridmorph::cli
