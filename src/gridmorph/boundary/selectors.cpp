#include <gridmorph/boundary/selectors.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

namespace gridmorph {

namespace {

constexpr std::array kinds{PatchKind::wall,       PatchKind::inflow,   PatchKind::outflow,
                           PatchKind::symmetry,   PatchKind::farfield, PatchKind::degenerate,
                           PatchKind::connection, PatchKind::other,    PatchKind::region};
constexpr std::string_view type_prefix = "type:";
constexpr std::string_view periodic = "periodic";

template <class Test>
Selection select_if(Mesh const& mesh, Test const& test) {
  Selection s;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (test(mesh.patches[p])) s.patches.push_back(int(p));
  return s;
}

Selection select_type(Mesh const& mesh, std::string const& selector) {
  std::string_view const type = std::string_view(selector).substr(type_prefix.size());
  if (type == periodic) {
    Selection s;
    for (auto const& c : connections_of(mesh))
      if (c.periodic) s.interfaces.push_back(c.number);
    return s;
  }
  for (PatchKind kind : kinds)
    if (type == to_string(kind)) return select_if(mesh, [kind](Patch const& p) { return p.kind == kind; });
  std::string known;
  for (PatchKind kind : kinds) known += std::string(to_string(kind)) + ", ";
  throw MotionError("selector '" + selector + "': there is no type '" + std::string(type) + "'; the types are " +
                    known + std::string(periodic));
}

bool names_family(std::string const& pattern, std::vector<std::string> const& families) {
  return std::any_of(families.begin(), families.end(), [&](auto const& f) { return glob_match(pattern, f); });
}

std::vector<std::string> sorted_names(std::set<std::string> const& names) { return {names.begin(), names.end()}; }

}  // namespace

std::vector<AnyConnection> connections_of(Mesh const& mesh) {
  std::vector<AnyConnection> out;
  auto const add = [&](auto const& c) {
    out.push_back({int(out.size()), c.name, c.families, c.zone, c.donor_zone, c.periodic});
  };
  std::for_each(mesh.interfaces.begin(), mesh.interfaces.end(), add);
  std::for_each(mesh.connections.begin(), mesh.connections.end(), add);
  return out;
}

bool glob_match(std::string_view pattern, std::string_view text) {
  // Greedy with one point to fall back to: the last `*` may always swallow one more character.
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

Selection select(Mesh const& mesh, std::string const& selector) {
  if (selector.starts_with(type_prefix)) return select_type(mesh, selector);

  Selection by_family = select_if(mesh, [&](Patch const& p) { return names_family(selector, p.families); });
  std::vector<int> plain;
  for (auto const& c : connections_of(mesh))
    if (names_family(selector, c.families)) (c.periodic ? by_family.interfaces : plain).push_back(c.number);
  // Plain interfaces that carry the family of their blade row are not what the user means, unless there is nothing
  // else.
  if (by_family.empty()) by_family.interfaces = plain;
  if (!by_family.empty()) return by_family;

  bool const qualified = selector.find('/') != std::string::npos;
  auto const named = [&](std::string const& name, int zone) {
    return glob_match(selector, name) || (qualified && glob_match(selector, mesh.zones[zone].name + "/" + name));
  };
  Selection const by_bc =
      select_if(mesh, [&](Patch const& p) { return p.kind != PatchKind::connection && named(p.name, p.zone); });
  if (!by_bc.empty()) return by_bc;

  Selection by_connection =
      select_if(mesh, [&](Patch const& p) { return p.kind == PatchKind::connection && named(p.name, p.zone); });
  for (auto const& c : connections_of(mesh))
    if (named(c.name, c.zone)) by_connection.interfaces.push_back(c.number);
  return by_connection;
}

std::string quote_list(std::vector<std::string> const& names, std::size_t at_most) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), at_most); ++n) text += (n > 0 ? ", '" : "'") + names[n] + "'";
  if (names.size() > at_most) text += " and " + std::to_string(names.size() - at_most) + " more";
  return text;
}

std::string describe_selectable(Mesh const& mesh) {
  std::set<std::string> families, bcs, connections, types;
  for (Patch const& p : mesh.patches) {
    families.insert(p.families.begin(), p.families.end());
    (p.kind == PatchKind::connection ? connections : bcs).insert(p.name);
    types.insert(std::string(type_prefix) + std::string(to_string(p.kind)));
  }
  for (AnyConnection const& i : connections_of(mesh)) {
    if (!i.periodic) continue;
    families.insert(i.families.begin(), i.families.end());
    connections.insert(i.name);
    types.insert(std::string(type_prefix) + std::string(periodic));
  }
  std::string text;
  auto const add = [&text](char const* what, std::set<std::string> const& names) {
    if (!names.empty()) text += (text.empty() ? "" : "; ") + (what + quote_list(sorted_names(names)));
  };
  add("families: ", families);
  add("BC names: ", bcs);
  add("connections: ", connections);
  add("types: ", types);
  return text.empty() ? "the mesh has no patch and no periodic interface" : "there are " + text;
}

std::string describe_interface(Mesh const& mesh, AnyConnection const& i) {
  return "'" + i.name + "' (zone '" + mesh.zones[i.zone].name + "' to zone '" + mesh.zones[i.donor_zone].name + "')";
}

std::vector<int> select_patches(Mesh const& mesh, std::vector<std::string> const& selectors) {
  Problems problems;
  std::set<int> chosen;
  for (std::string const& selector : selectors) {
    try {
      Selection const s = select(mesh, selector);
      if (s.empty())
        problems.add("selector '" + selector + "' matches nothing; " + describe_selectable(mesh));
      else if (s.patches.empty())
        problems.add("selector '" + selector + "' names interfaces, where patches are needed");
      chosen.insert(s.patches.begin(), s.patches.end());
    } catch (MotionError const& e) {
      problems.add(e.what());
    }
  }
  problems.throw_if_any<MotionError>();
  return {chosen.begin(), chosen.end()};
}

}  // namespace gridmorph
