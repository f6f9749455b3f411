#include <gridmorph/cli/inspect_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace gridmorph::cli {

namespace {

/// A TOML basic string.
std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04X}", int(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string toml_list(std::vector<std::string> const& names) {
  std::string out = "[";
  for (auto const& name : names) out += (out.size() > 1 ? ", " : "") + toml_string(name);
  return out + "]";
}

/// Round-off of single-precision angles would make an odd axis: one component of 1 when it is nearly that.
double tidy(double component) {
  if (std::fabs(component) < 1e-6) return 0;
  if (std::fabs(std::fabs(component) - 1) < 1e-9) return component > 0 ? 1 : -1;
  return component;
}

std::string vector_text(Vec3 const& v) { return fmt::format("[{}, {}, {}]", tidy(v.x), tidy(v.y), tidy(v.z)); }

bool looks_like(BoundarySummary const& b, std::string_view word) { return b.guess.find(word) != std::string::npos; }

/// What a boundary needs in a first case file.
enum class Role { moving, end_wall, through_flow, symmetry, far_field, still };
constexpr std::size_t n_roles = 6;

/// Whether one of the names that people give a boundary (its own, its BCs') has one of the words in it.
bool is_named(BoundarySummary const& b, std::initializer_list<std::string_view> words) {
  auto const has = [&](std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view w) { return name.find(w) != std::string::npos; });
  };
  return has(b.selector) || std::any_of(b.names.begin(), b.names.end(), has);
}

/// The type decides, then the name, then the shape: `Null` and `UserDefined` types say nothing, and neither do many names.
Role role_of(BoundarySummary const& b, MeshSummary const& s) {
  auto const is = [&](PatchKind kind) { return std::find(b.kinds.begin(), b.kinds.end(), kind) != b.kinds.end(); };
  bool const round = s.axis && looks_like(b, "surface of revolution");
  bool const blade =
      is_named(b, {"blade", "vane", "wing", "airfoil", "aerofoil", "stator", "rotor", "fin", "flap", "slat"});
  bool const end_wall = is_named(b, {"hub", "shroud", "casing", "case", "endwall", "end_wall", "end-wall"});
  if (is(PatchKind::wall)) {
    if (end_wall) return round ? Role::end_wall : Role::still;
    return round && !blade ? Role::end_wall : Role::moving;
  }
  if (is(PatchKind::inflow) || is(PatchKind::outflow)) return Role::through_flow;
  bool const flat = looks_like(b, "plane");
  if ((is(PatchKind::symmetry) && flat) || looks_like(b, "side of a 2-D mesh")) return Role::symmetry;
  if (is(PatchKind::farfield)) return Role::far_field;
  if (!is(PatchKind::other) || is(PatchKind::symmetry)) return Role::still;
  // Types that say nothing.
  if (end_wall) return round ? Role::end_wall : Role::still;
  if (is_named(b, {"sym"}) && flat) return Role::symmetry;
  if (is_named(b, {"inlet", "inflow", "outlet", "outflow", "exit"})) return Role::through_flow;
  if (is_named(b, {"far"})) return Role::far_field;
  if (blade || is_named(b, {"wall"})) return Role::moving;
  return Role::still;
}

}  // namespace

std::string case_snippet(MeshSummary const& s) {
  std::array<std::vector<std::string>, n_roles> groups;
  for (auto const& b : s.boundaries) {
    if (std::find(b.kinds.begin(), b.kinds.end(), PatchKind::degenerate) != b.kinds.end()) continue;
    auto& group = groups[std::size_t(role_of(b, s))];
    // A name that is a family and a BC means the family.
    if (std::find(group.begin(), group.end(), b.selector) == group.end()) group.push_back(b.selector);
  }
  auto const& moving = groups[std::size_t(Role::moving)];
  std::filesystem::path const input(s.source);
  std::string const ending = s.file_variant.empty() && !s.unstructured ? ".cgns" : input.extension().string();
  std::string text = "[mesh]\n";
  text += "input  = " + toml_string(input.filename().string()) + "\n";
  text += "output = " + toml_string(input.stem().string() + "_morphed" + ending) + "\n";
  if (s.axis)
    text += fmt::format("axis   = {{ origin = {}, direction = {} }}\n", vector_text(s.axis->origin),
                        vector_text(s.axis->direction));
  if (s.needed_tolerance > 0)
    text += fmt::format("matching_tolerance = {:.2g}  # interface nodes are that far apart\n", s.needed_tolerance);
  if (s.open_faces)
    text += "open_faces = \"open\"       # faces that nothing claims: stay where they are, or give them a rule\n";

  auto const add = [&](std::vector<std::string> const& names, std::string_view comment, std::string_view rule) {
    if (names.empty()) return;
    text += fmt::format("\n[[motion]]{}{}\npatches = {}\n{}\n", comment.empty() ? "" : "  # ", comment,
                        toml_list(names), rule);
  };
  for (auto const& wall : moving)
    add({wall}, "put the motion here; also \"formula\", \"field\", or \"fixed\"",
        "rule = \"rigid\"\ntranslation = [0, 0, 0]");
  add(groups[std::size_t(Role::end_wall)], "nodes slide on the wall", "rule = \"slip\"\nsurface = \"revolution\"");
  bool const turns = s.axis && !moving.empty() && !s.unstructured;
  add(groups[std::size_t(Role::through_flow)], "",
      turns && moving.size() == 1 ? "rule = \"circumferential-slide\"\nof = " + toml_string(moving.front())
                                  : std::string("rule = \"fixed\""));
  if (!s.periodics.empty() && turns && moving.size() == 1)
    add({"type:periodic"}, "", "rule = \"follow\"\nof = " + toml_string(moving.front()));
  add(groups[std::size_t(Role::symmetry)], "", "rule = \"slip\"\nsurface = \"plane\"");
  add(groups[std::size_t(Role::far_field)], "far away", "rule = \"fixed\"");
  add(groups[std::size_t(Role::still)], "", "rule = \"fixed\"");
  if (s.open_faces && s.boundaries.empty())
    add({"open"}, "no boundary has a name: a side file gives them (inspect --write-side-file)", "rule = \"fixed\"");
  // A third of the way across leaves room for the volume stages whatever lies on the other side.
  int across = 0;
  for (auto const& b : s.boundaries)
    if (role_of(b, s) == Role::moving && b.cells_across > 0)
      across = across == 0 ? b.cells_across : std::min(across, b.cells_across);
  if (across >= 3)
    text += fmt::format(
        "\n[boundary_layer]  # extent = \"block\" where blocks of their own surround the walls\nwalls  = {}\n"
        "extent = {{ layers = {} }}\n",
        toml_list(moving), across / 3);
  return text;
}

}  // namespace gridmorph::cli
