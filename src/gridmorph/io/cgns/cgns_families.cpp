#include <gridmorph/io/cgns/cgns_families.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cgns {

namespace {

void collect(Node const& parent, std::string const& prefix, std::vector<std::string>& names) {
  for (auto const* family : parent.all("Family_t")) {
    names.push_back(prefix + family->name);
    collect(*family, names.back() + "/", names);
  }
}

std::vector<std::string> split(std::string const& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    std::size_t const end = std::min(path.find('/', begin), path.size());
    if (end > begin) parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// The type at the end of a path of families below `top`; false in `.first` when there is no such path.
std::pair<bool, std::optional<std::string>> follow(File const& file, Node const& top,
                                                   std::vector<std::string> const& path) {
  Node const* at = &top;
  std::optional<std::string> type;
  for (auto const& name : path) {
    at = at->child(name);
    if (!at || at->label != "Family_t") return {false, std::nullopt};
    if (auto const* bc = at->labelled("FamilyBC_t")) type = file.text(*bc);
  }
  return {!path.empty(), type};
}

}  // namespace

std::vector<std::string> family_names(Node const& base) {
  std::vector<std::string> names;
  collect(base, "", names);
  return names;
}

std::vector<std::string> families_of(File const& file, Node const& owner) {
  std::vector<std::string> names;
  for (auto const* label : {"FamilyName_t", "AdditionalFamilyName_t"})
    for (auto const* node : owner.all(label)) {
      auto name = file.text(*node);
      if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
  return names;
}

std::optional<std::string> family_bc_type(File const& file, Node const& tree, Node const& base,
                                          std::string const& name) {
  auto path = split(name);
  if (auto const [found, type] = follow(file, base, path); found) return type;
  if (path.size() < 2) return std::nullopt;
  auto const* other = tree.child(path.front());
  if (!other || other->label != "CGNSBase_t") return std::nullopt;
  path.erase(path.begin());
  return follow(file, *other, path).second;
}

PatchKind patch_kind(std::string_view bc_type) {
  if (bc_type.starts_with("BCWall")) return PatchKind::wall;
  if (bc_type.starts_with("BCInflow") || bc_type == "BCTunnelInflow") return PatchKind::inflow;
  if (bc_type.starts_with("BCOutflow") || bc_type == "BCTunnelOutflow") return PatchKind::outflow;
  if (bc_type.starts_with("BCSymmetry")) return PatchKind::symmetry;
  if (bc_type == "BCFarfield") return PatchKind::farfield;
  if (bc_type.starts_with("BCDegenerate") || bc_type == "BCAxisymmetricWedge") return PatchKind::degenerate;
  return PatchKind::other;
}

}  // namespace gridmorph::cgns
