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

/// The families along a path of their names below `top`; empty where there is no such path.
std::vector<Node const*> follow(Node const& top, std::vector<std::string> const& path) {
  std::vector<Node const*> out;
  Node const* at = &top;
  for (auto const& name : path) {
    at = at->child(name);
    if (!at || at->label != "Family_t") return {};
    out.push_back(at);
  }
  return out;
}

/// The nearest type above the end of a path.
std::optional<std::string> type_along(File const& file, std::vector<Node const*> const& path) {
  std::optional<std::string> type;
  for (Node const* family : path)
    if (auto const* bc = family->labelled("FamilyBC_t")) type = file.text(*bc);
  return type;
}

void add_once(std::vector<std::string>& names, std::string name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
}

}  // namespace

std::vector<std::string> family_names(Node const& base) {
  std::vector<std::string> names;
  collect(base, "", names);
  return names;
}

std::vector<std::string> families_of(File const& file, Node const& base, Node const& owner) {
  std::vector<std::string> names;
  for (auto const* label : {"FamilyName_t", "AdditionalFamilyName_t"})
    for (auto const* node : owner.all(label)) add_once(names, file.text(*node));
  std::vector<std::string> own, above;
  for (auto const& name : names)
    if (auto const path = follow(base, split(name)); !path.empty())
      for (auto const* node : path.back()->all("FamilyName_t")) {
        auto const text = file.text(*node);
        add_once(follow(base, split(text)).empty() ? own : above, text);
      }
  for (auto const* list : {&names, &above})
    for (auto const& name : *list) add_once(own, name);
  return own;
}

std::optional<std::string> family_bc_type(File const& file, Node const& tree, Node const& base,
                                          std::vector<std::string> const& names) {
  for (auto const& name : names) {
    auto path = split(name);
    if (auto const found = follow(base, path); !found.empty()) return type_along(file, found);
    auto const* other = path.size() < 2 ? nullptr : tree.child(path.front());
    if (!other || other->label != "CGNSBase_t") continue;
    path.erase(path.begin());
    return type_along(file, follow(*other, path));
  }
  return std::nullopt;
}

std::string take_bc_type(File const& file, Node const& tree, Node const& base, Node const& bc, Patch& patch) {
  patch.bc_type = file.text(bc);
  auto const type = patch.bc_type == "FamilySpecified" ? family_bc_type(file, tree, base, patch.families)
                                                       : std::optional(patch.bc_type);
  patch.bc_type = type.value_or(patch.bc_type);
  patch.kind = patch_kind(patch.bc_type);
  if (type) return {};
  return "is FamilySpecified, but " +
         (patch.families.empty() ? "names no family" : "family '" + patch.families.front() + "' has no FamilyBC_t") +
         "; its kind is not known";
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
