#include <gridmorph/io/cgns/new_names.hpp>

namespace gridmorph::cgns {

std::string unique_name(std::set<std::string>& taken, std::string const& wanted) {
  std::string name = wanted.substr(0, longest_name);
  for (int n = 2; !taken.insert(name).second; ++n) {
    std::string const suffix = "_" + std::to_string(n);
    name = wanted.substr(0, longest_name - suffix.size()) + suffix;
  }
  return name;
}

std::string bc_type_of(Patch const& patch) {
  if (patch.kind == PatchKind::connection) return "UserDefined";
  if (!patch.bc_type.empty()) return patch.bc_type;
  switch (patch.kind) {
    case PatchKind::wall: return "BCWall";
    case PatchKind::inflow: return "BCInflow";
    case PatchKind::outflow: return "BCOutflow";
    case PatchKind::symmetry: return "BCSymmetryPlane";
    case PatchKind::farfield: return "BCFarfield";
    case PatchKind::degenerate: return "BCDegenerateLine";
    default: return "UserDefined";
  }
}

}  // namespace gridmorph::cgns
