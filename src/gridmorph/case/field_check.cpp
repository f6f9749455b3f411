#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/boundary/second_plane.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/case/field_check.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

/// The nodes of the patches that a rule names; what names none is told by those who resolve rules.
std::vector<Vec3> nodes_of(Mesh const& mesh, SecondPlane const& second_plane, MotionRule const& rule) {
  std::vector<Vec3> out;
  for (std::string const& selector : rule.patches) {
    Selection named;
    try {
      named = select(mesh, selector);
    } catch (MotionError const&) {
      continue;
    }
    for (int const p : named.patches) {
      Patch const& patch = mesh.patches[p];
      Zone const& zone = mesh.zones[patch.zone];
      auto const add = [&](Index n) { out.push_back(second_plane.first(mesh.coordinates[n])); };
      if (zone.is_block() && patch.faces.size() == 0 && patch.nodes.empty())
        for_each_node(zone, patch.range, add);
      else
        for (Index32 const n : patch_nodes(patch)) add(n);
    }
  }
  return out;
}

}  // namespace

void check_fields(CaseFile const& case_file, Mesh const& mesh) {
  SecondPlane const second_plane(mesh);
  for (FieldUse const& use : case_file.fields)
    for (MotionRule const& rule : case_file.motion.rules) {
      if (rule.where != use.where) continue;
      // Where a displacement is taken back the nodes are that far from the points.
      double const slack = use.inverse ? use.field->largest_displacement() : 0;
      try {
        use.field->expect(nodes_of(mesh, second_plane, rule), slack);
      } catch (MotionError const& e) {
        throw MotionError(use.where + ": " + e.what());
      }
    }
}

}  // namespace gridmorph
