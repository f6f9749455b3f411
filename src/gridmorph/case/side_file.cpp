#include <gridmorph/case/detail/side_tables.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>
#include <toml.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

namespace gridmorph {

namespace {

using casefile::Context;
using casefile::TableReader;

/// Some hundred bytes per interface.
constexpr std::uintmax_t largest_side_file = 256u << 20;

std::string read_text(std::filesystem::path const& path) {
  return mapping::read_text_file(path, "side file", largest_side_file);
}

class Reader {
 public:
  Reader(Context& context, Mesh& mesh) : context_(context), mesh_(mesh) {}

  void read(toml::value const& document) {
    TableReader root(context_, document, "");
    (void)root.string("format");  // was for the reader of the mesh
    if (auto const names = root.strings("zone_names")) rename(root, *names);
    for (auto& table : root.tables("periodic")) periodic_.read(table);
    for (auto& table : root.tables("patch")) patch(table);
    for (auto& table : root.tables("interface")) interface(table);
    root.finish();
  }

 private:
  void rename(TableReader& root, std::vector<std::string> const& names) {
    if (names.size() != mesh_.zones.size())
      return root.problem("zone_names", fmt::format("has {} names, and the mesh has {} zones; give one for each",
                                                    names.size(), mesh_.zones.size()));
    for (std::size_t z = 0; z < names.size(); ++z) {
      if (std::count(names.begin(), names.end(), names[z]) > 1)
        return root.problem("zone_names", fmt::format("names '{}' twice; zones need names of their own", names[z]));
      mesh_.zones[z].name = names[z];
    }
  }

  /// A zone by number, from 1, or by name.
  std::optional<int> zone(TableReader& table, std::string const& key) {
    auto const* value = table.find(key);
    table.require(key, key + " = 1 (number or name of a zone)");
    if (value == nullptr) return std::nullopt;
    if (value->is_string()) {
      for (int z = 0; z < int(mesh_.zones.size()); ++z)
        if (mesh_.zones[z].name == casefile::string_of(*value)) return z;
      std::vector<std::string> names;
      for (auto const& z : mesh_.zones) names.push_back(z.name);
      if (names.size() > 20) names.resize(20);
      table.problem(key, fmt::format("there is no zone '{}'{}", casefile::string_of(*value),
                                     suggestion(casefile::string_of(*value), names)));
      return std::nullopt;
    }
    auto const number = table.integer(key);
    if (number && (*number < 1 || *number > int(mesh_.zones.size()))) {
      table.problem(key, fmt::format("there is no zone {}; the mesh has zones 1 to {}", *number, mesh_.zones.size()));
      return std::nullopt;
    }
    if (!number) return std::nullopt;
    return *number - 1;
  }

  /// [i, j, k], or [i, j] in a 2-D mesh (k then runs over both planes).
  std::optional<std::vector<int>> index(toml::value const& value) {
    if (!value.is_array()) return std::nullopt;
    std::vector<int> out;
    for (auto const& n : value.as_array()) {
      if (!n.is_integer() || n.as_integer() < 1 || n.as_integer() > 2'000'000'000) return std::nullopt;
      out.push_back(int(n.as_integer()));
    }
    if (out.size() == 3 || (out.size() == 2 && mesh_.dimension == 2)) return out;
    return std::nullopt;
  }

  /// `face_key` = "i_min" ... or `range_key` = [[i, j, k], [i, j, k]]: a part of one face of a zone.
  std::optional<IndexRange> range(TableReader& table, int zone, std::string const& face_key,
                                  std::string const& range_key) {
    Index3 const extent = mesh_.zones[zone].extent;
    IndexRange out{{0, 0, 0}, extent};
    if (table.has(face_key) == table.has(range_key)) {
      (void)table.find(face_key);
      (void)table.find(range_key);
      context_.problem(table.line(),
                       fmt::format("needs one of {} = \"i_min\" (... \"k_max\") and {} = [[1, 1, 1], [9, 9, 1]]",
                                   face_key, range_key));
      return std::nullopt;
    }
    if (auto const face = table.choice(face_key, {"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"})) {
      int const axis = int(*face / 2);
      out.begin[axis] = *face % 2 == 0 ? 0 : extent[axis] - 1;
      out.end[axis] = out.begin[axis] + 1;
      return out;
    }
    auto const* value = table.find(range_key);
    if (value == nullptr) return std::nullopt;  // the word for the face was wrong
    std::optional<std::vector<int>> a, b;
    if (value->is_array() && value->as_array().size() == 2) {
      a = index(value->as_array()[0]);
      b = index(value->as_array()[1]);
    }
    if (!a || !b || a->size() != b->size()) {
      table.problem(range_key, fmt::format("expected two nodes [[i, j, k], [i, j, k]], counted from 1, found {}",
                                           casefile::describe_value(*value)));
      return std::nullopt;
    }
    for (std::size_t d = 0; d < a->size(); ++d) {
      out.begin[d] = std::min((*a)[d], (*b)[d]) - 1;
      out.end[d] = std::max((*a)[d], (*b)[d]);
    }
    int flat = 0;
    bool inside = true, outer = false;
    for (int d = 0; d < 3; ++d) {
      inside = inside && out.end[d] <= extent[d];
      if (out.extent(d) != 1) continue;
      ++flat;
      outer = outer || out.begin[d] == 0 || out.begin[d] == extent[d] - 1;
    }
    if (!inside || flat != 1 || !outer) {
      table.problem(range_key, fmt::format("{} is no part of one face of zone '{}', which has nodes {}", to_string(out),
                                           mesh_.zones[zone].name, to_string(IndexRange{{0, 0, 0}, extent})));
      return std::nullopt;
    }
    return out;
  }

  void patch(TableReader& table) {
    Patch out;
    auto const name = table.string("name");
    table.require("name", "name = \"blade\"");
    if (auto const family = table.strings("family")) out.families = *family;
    if (auto const kind = table.choice("kind", casefile::side_file_kinds)) {
      out.kind = PatchKind(*kind);
      out.bc_type = casefile::bc_type_of(out.kind);
    }
    auto const on = zone(table, "zone");
    auto const where = on ? range(table, *on, "face", "range") : std::nullopt;
    if (on) table.finish();
    if (!name || !on || !where) return;
    out.name = *name;
    out.zone = *on;
    out.range = *where;
    for (auto const& family : out.families)
      if (std::find(mesh_.families.begin(), mesh_.families.end(), family) == mesh_.families.end())
        mesh_.families.push_back(family);
    mesh_.patches.push_back(std::move(out));
  }

  std::optional<Orientation> transform(TableReader& table, bool two) {
    auto const entries = table.numbers("transform");
    table.require("transform", "transform = [1, 2, 3]: donor axis, with sign, along which each own axis runs");
    if (!entries) return std::nullopt;
    Orientation o;
    std::array<bool, 3> used{};
    auto list = *entries;
    if (two && list.size() == 2) list.push_back(3);
    bool good = list.size() == 3;
    for (std::size_t a = 0; good && a < 3; ++a) {
      double const magnitude = std::fabs(list[a]);
      good = magnitude == 1 || magnitude == 2 || magnitude == 3;
      if (!good) break;
      int const axis = int(magnitude) - 1;
      good = !used[axis];
      used[axis] = true;
      o.axis[a] = axis;
      o.sign[a] = list[a] > 0 ? 1 : -1;
    }
    if (good) return o;
    table.problem("transform", "expected 1, 2 and 3 in some order, each with a sign, as [1, 2, -3]");
    return std::nullopt;
  }

  void interface(TableReader& table) {
    Interface1to1 out;
    out.name = table.string("name").value_or(fmt::format("interface {}", mesh_.interfaces.size() + 1));
    if (auto const family = table.strings("family")) out.families = *family;
    auto const own = zone(table, "zone"), donor = zone(table, "donor_zone");
    auto const own_range = own ? range(table, *own, "face", "range") : std::nullopt;
    auto const donor_range = donor ? range(table, *donor, "donor_face", "donor_range") : std::nullopt;
    auto o = transform(table, mesh_.dimension == 2);
    out.periodic = periodic_.of(table);
    if (own && donor) table.finish();
    if (!own_range || !donor_range || !o) return;
    int normal = 0, donor_normal = 0;
    while (own_range->extent(normal) != 1) ++normal;
    while (donor_range->extent(donor_normal) != 1) ++donor_normal;
    bool fits = o->axis[normal] == donor_normal;
    for (int a = 0; a < 3; ++a) fits = fits && own_range->extent(a) == donor_range->extent(o->axis[a]);
    if (!fits)
      return table.problem("transform", fmt::format("does not carry the nodes {} onto the donor's {}",
                                                    to_string(*own_range), to_string(*donor_range)));
    // Through the face into the donor, whatever the sign says.
    o->sign[normal] = (own_range->begin[normal] == 0) == (donor_range->begin[donor_normal] == 0) ? -1 : 1;
    out.zone = *own;
    out.donor_zone = *donor;
    out.range = *own_range;
    out.to_donor = {*o, own_range->begin, {0, 0, 0}};
    for (int a = 0; a < 3; ++a) {
      int const d = o->axis[a];
      out.to_donor.donor_origin[d] = a == normal || o->sign[a] > 0 ? donor_range->begin[d] : donor_range->end[d] - 1;
    }
    mesh_.interfaces.push_back(std::move(out));
  }

  Context& context_;
  Mesh& mesh_;
  casefile::SidePeriodics periodic_;
};

}  // namespace

std::optional<std::filesystem::path> find_side_file(std::filesystem::path const& mesh) {
  auto path = mesh;
  path.replace_extension(".toml");
  std::error_code error;
  if (path == mesh || !std::filesystem::is_regular_file(path, error)) return std::nullopt;
  auto const document = casefile::parse_toml_text(read_text(path), path.string()).root;
  if (!document.is_table() || document.contains("mesh") || document.contains("motion")) return std::nullopt;
  return path;
}

void add_side_file(std::string const& text, std::filesystem::path const& path, Mesh& mesh) {
  Context context{path.string(), path.parent_path(), {}, nullptr};
  auto const [document, lines] = casefile::parse_toml_text(text, context.file);
  context.lines = lines;
  if (mesh.is_structured())
    Reader(context, mesh).read(document);
  else
    casefile::read_side_file_of_elements(context, document, mesh);
  context.problems.throw_if_any<ConfigError>();
}

Mesh load_mesh(std::filesystem::path const& mesh, std::optional<std::filesystem::path> const& side_file,
               std::vector<std::string> const& leave_out) {
  ReadOptions options;
  options.leave_out = leave_out;
  auto const side = side_file ? side_file : find_side_file(mesh);
  if (!side) return read_mesh(mesh.string(), options);
  std::string const text = read_text(*side);
  auto const document = casefile::parse_toml_text(text, side->string()).root;
  if (document.is_table() && document.contains("format") && document.at("format").is_string())
    options.plot3d_format = casefile::string_of(document.at("format"));
  Mesh out = read_mesh(mesh.string(), options);
  add_side_file(text, *side, out);
  out.notes.push_back(fmt::format(
      fmt::runtime(out.is_structured() ? "patches and interfaces of '{}' added" : "what '{}' says is taken"),
      side->string()));
  return out;
}

}  // namespace gridmorph
