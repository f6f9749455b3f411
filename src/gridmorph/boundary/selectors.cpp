#include <gridmorph/boundary/selectors.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>

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
Selection select_if(BoundaryMesh const& mesh, Test const& test) {
  Selection s;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (test(mesh.patches[p])) s.patches.push_back(int(p));
  return s;
}

Selection select_type(BoundaryMesh const& mesh, std::string const& selector) {
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
  std::vector<std::string> words{std::string(periodic)};
  for (PatchKind kind : kinds) words.emplace_back(to_string(kind));
  std::string const near = nearest_word(type, words);
  throw MotionError("selector '" + selector + "': there is no type '" + std::string(type) + "'" +
                    (near.empty() ? "" : ", did you mean 'type:" + near + "'?") + "; the types are " + known +
                    std::string(periodic));
}

bool names_family(std::string const& pattern, std::vector<std::string> const& families) {
  return std::any_of(families.begin(), families.end(), [&](auto const& f) { return glob_match(pattern, f); });
}

std::vector<std::string> sorted_names(std::set<std::string> const& names) { return {names.begin(), names.end()}; }

}  // namespace

std::vector<AnyConnection> connections_of(BoundaryMesh const& mesh) {
  std::vector<AnyConnection> out;
  auto const add = [&](auto const& c) {
    AnyConnection one{int(out.size()), c.name, c.families, c.zone, c.donor_zone, c.periodic};
    if constexpr (requires { c.zone_in_file; }) one.zone_in_file = c.zone_in_file;
    out.push_back(std::move(one));
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

Selection select(BoundaryMesh const& mesh, std::string const& selector) {
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
  auto const named = [&](auto const& one) {
    std::string zone(one.zone_in_file.empty() ? mesh.zones[one.zone].name : one.zone_in_file);
    return glob_match(selector, one.name) || (qualified && glob_match(selector, zone + "/" + one.name));
  };
  Selection const by_bc = select_if(mesh, [&](Patch const& p) { return p.kind != PatchKind::connection && named(p); });
  if (!by_bc.empty()) return by_bc;

  Selection by_connection =
      select_if(mesh, [&](Patch const& p) { return p.kind == PatchKind::connection && named(p); });
  for (auto const& c : connections_of(mesh))
    if (named(c)) by_connection.interfaces.push_back(c.number);
  return by_connection;
}

std::string quote_list(std::vector<std::string> const& names, std::size_t at_most) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), at_most); ++n) text += (n > 0 ? ", '" : "'") + names[n] + "'";
  if (names.size() > at_most) text += " and " + std::to_string(names.size() - at_most) + " more";
  return text;
}

namespace {

struct Selectable {
  std::set<std::string> families, regions, bcs, connections, types;
};

Selectable selectable(BoundaryMesh const& mesh) {
  Selectable out;
  auto& [families, regions, bcs, connections, types] = out;
  for (Patch const& p : mesh.patches) {
    families.insert(p.families.begin(), p.families.end());
    (p.kind == PatchKind::connection ? connections : p.kind == PatchKind::region ? regions : bcs).insert(p.name);
    types.insert(std::string(type_prefix) + std::string(to_string(p.kind)));
  }
  for (AnyConnection const& i : connections_of(mesh)) {
    if (!i.periodic) continue;
    families.insert(i.families.begin(), i.families.end());
    connections.insert(i.name);
    types.insert(std::string(type_prefix) + std::string(periodic));
  }
  return out;
}

}  // namespace

std::string describe_selectable(BoundaryMesh const& mesh) {
  auto const [families, regions, bcs, connections, types] = selectable(mesh);
  std::string text;
  auto const add = [&text](char const* what, std::set<std::string> const& names) {
    if (!names.empty()) text += (text.empty() ? "" : "; ") + (what + quote_list(sorted_names(names)));
  };
  add("families: ", families);
  add("regions: ", regions);
  if (families.empty()) {
    add("BC names: ", bcs);
    add("connections: ", connections);
    add("types: ", types);
  }
  return text.empty() ? "the mesh has no patch and no periodic interface" : "there are " + text;
}

std::string matches_nothing(BoundaryMesh const& mesh, std::string const& selector) {
  auto const names = selectable(mesh);
  std::vector<std::string> known;
  for (auto const* some : {&names.families, &names.regions, &names.bcs, &names.connections, &names.types})
    known.insert(known.end(), some->begin(), some->end());
  std::string const near = nearest_word(selector, known), there_are = describe_selectable(mesh);
  return "selector '" + selector + "' matches nothing; " +
         (near.empty() ? there_are : "did you mean '" + near + "'? (" + there_are + ")");
}

std::string describe_interface(BoundaryMesh const& mesh, AnyConnection const& i) {
  return "'" + i.name + "' (zone '" + mesh.zones[i.zone].name + "' to zone '" + mesh.zones[i.donor_zone].name + "')";
}

namespace {

/// The other side of a connection that the file stores twice, or -1. A range that closes on itself is its own partner
/// only if there is no other.
int find_partner(BoundaryMesh const& mesh, int interface) {
  Interface1to1 const& own = mesh.interfaces[interface];
  IndexRange const donor = own.to_donor(own.range);
  for (std::size_t j = 0; j < mesh.interfaces.size(); ++j) {
    Interface1to1 const& other = mesh.interfaces[j];
    if (int(j) != interface && other.zone == own.donor_zone && other.donor_zone == own.zone && other.range == donor &&
        other.to_donor(other.range) == own.range)
      return int(j);
  }
  return -1;
}

/// The other side of a connection of elements that the file stores twice, or -1; sides may list their nodes in any
/// order.
int find_partner(std::vector<Connection> const& connections, int connection) {
  Connection const& own = connections[connection];
  auto const sorted = [](std::vector<Index32> list) {
    std::sort(list.begin(), list.end());
    return list;
  };
  for (std::size_t j = 0; j < connections.size(); ++j) {
    Connection const& other = connections[j];
    if (int(j) != connection && other.zone == own.donor_zone && other.donor_zone == own.zone && other.periodic &&
        other.nodes.size() == own.nodes.size() && sorted(own.donor_nodes) == sorted(other.nodes))
      return int(j);
  }
  return -1;
}

}  // namespace

int NamedBoundary::other_side(int connection) const {
  auto const blocks = int(mesh_->interfaces.size());
  if (connection < blocks) return find_partner(*mesh_, connection);
  int const other = find_partner(mesh_->connections, connection - blocks);
  return other < 0 ? -1 : blocks + other;
}

std::vector<int> select_patches(BoundaryMesh const& mesh, std::vector<std::string> const& selectors) {
  Problems problems;
  std::set<int> chosen;
  for (std::string const& selector : selectors) {
    try {
      Selection const s = select(mesh, selector);
      if (s.empty())
        problems.add(matches_nothing(mesh, selector));
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
