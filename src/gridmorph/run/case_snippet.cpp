#include <gridmorph/run/inspect_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

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
enum class Role { moving, end_wall, through_flow, symmetry, far_field, still, paired };

/// Whether one of the names that people give a boundary (its own, its BCs') has one of the words in it.
bool is_named(BoundarySummary const& b, std::initializer_list<std::string_view> words) {
  auto const has = [&](std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view w) { return name.find(w) != std::string::npos; });
  };
  return has(b.selector) || std::any_of(b.names.begin(), b.names.end(), has);
}

bool is_plane(BoundarySummary const& b) { return b.flat || looks_like(b, "plane "); }

/// Planes, arcs and surfaces of revolution lie across the flow or around it.
bool is_plain(BoundarySummary const& b) {
  return is_plane(b) || looks_like(b, "arc about") || looks_like(b, "surface of revolution");
}

/// Whether a boundary keeps off the limits of the mesh all round and is no plane: something in the flow.
bool is_body(BoundarySummary const& b, MeshSummary const& s) {
  return b.enclosed >= (s.two_dimensional ? 2 : 3) && !is_plain(b);
}

bool lies_in(Box const& inner, Box const& outer) {
  return inner.low.x > outer.low.x && inner.low.y > outer.low.y && inner.low.z >= outer.low.z &&
         inner.high.x < outer.high.x && inner.high.y < outer.high.y && inner.high.z <= outer.high.z;
}

/// Whether a body lies in a boundary that looks like one: then it is the limit of a mesh around the body.
bool is_around_a_body(BoundarySummary const& b, MeshSummary const& s) {
  return std::any_of(s.boundaries.begin(), s.boundaries.end(), [&](BoundarySummary const& other) {
    return &other != &b && is_body(other, s) && lies_in(other.box, b.box);
  });
}

/// The type decides, then the name, then the shape: `Null` and `UserDefined` types say nothing, and neither do many
/// names.
Role role_of(BoundarySummary const& b, MeshSummary const& s) {
  auto const is = [&](PatchKind kind) { return std::find(b.kinds.begin(), b.kinds.end(), kind) != b.kinds.end(); };
  bool const round = s.axis && looks_like(b, "surface of revolution");
  // Both a row and what limits it are called by the row.
  bool const of_row = is_named(b, {"stator", "rotor"});
  bool const blade =
      is_named(b, {"blade", "vane", "wing", "airfoil", "aerofoil", "fin", "flap", "slat"}) || (of_row && !b.flat);
  bool const end_wall = is_named(b, {"hub", "shroud", "casing", "case", "endwall", "end_wall", "end-wall"});
  if (is(PatchKind::wall)) {
    if (end_wall) return round ? Role::end_wall : Role::still;
    return round && !blade ? Role::end_wall : Role::moving;
  }
  if (is(PatchKind::inflow) || is(PatchKind::outflow)) return Role::through_flow;
  if (b.paired) return Role::paired;
  if (is(PatchKind::symmetry) || looks_like(b, "side of a 2-D mesh")) return Role::symmetry;
  if (is(PatchKind::farfield)) return Role::far_field;
  if (!is(PatchKind::other)) return Role::still;
  // Types that say nothing.
  if (end_wall) return round ? Role::end_wall : Role::still;
  if (is_named(b, {"mixing", "interface", "periodic"})) return Role::still;
  if (is_named(b, {"sym"}) && b.flat) return Role::symmetry;
  if (is_named(b, {"inlet", "inflow", "outlet", "outflow", "exit"})) return Role::through_flow;
  if (is_named(b, {"far", "infinity", "freestream"})) return Role::far_field;
  if (blade || is_named(b, {"wall"}) || (is_body(b, s) && !is_around_a_body(b, s))) return Role::moving;
  return Role::still;
}

bool is_kind(BoundarySummary const& b, PatchKind kind) {
  return std::find(b.kinds.begin(), b.kinds.end(), kind) != b.kinds.end();
}

/// Where no wall is known by type, name or neighbours: a body in the flow is enclosed, and its cells are thin. No plane
/// is one, and nothing that is all of the boundary. Walls by type or name come first, then what nothing is said about,
/// then all others; -1: there is nothing like one.
int most_like_a_body(MeshSummary const& s, std::vector<Role> const& roles) {
  int best = -1;
  std::array<double, 4> best_rank{};
  auto const is_wall = [](BoundarySummary const& b) {
    return is_kind(b, PatchKind::wall) || is_named(b, {"wall", "hub", "shroud", "casing"});
  };
  for (std::size_t b = 0; b < s.boundaries.size(); ++b) {
    auto const& boundary = s.boundaries[b];
    if (roles[b] == Role::paired || is_kind(boundary, PatchKind::degenerate) ||
        is_kind(boundary, PatchKind::connection) || looks_like(boundary, "collapsed") ||
        looks_like(boundary, "side of a 2-D mesh") || is_plane(boundary) ||
        (s.boundaries.size() == 1 && looks_like(boundary, "reaches round")))
      continue;
    std::array<double, 4> const rank{is_wall(boundary)         ? 2.0
                                     : roles[b] == Role::still ? 1.0
                                                               : 0.0,
                                     is_plain(boundary) ? 0.0 : 1.0, double(boundary.enclosed),
                                     looks_like(boundary, "thin first cells") ? 1.0 : 0.0};
    if (best >= 0 && !(rank > best_rank)) continue;
    best = int(b);
    best_rank = rank;
  }
  return best;
}

/// The boundaries that are still, enclosed as much and joined to a body are part of it.
void add_rest_of_body(MeshSummary const& s, int body, std::vector<Role>& roles) {
  std::vector<int> front{body};
  int const enclosed = s.boundaries[body].enclosed;
  while (!front.empty()) {
    int const at = front.back();
    front.pop_back();
    for (int const next : s.boundaries[at].touches) {
      auto& role = roles[next];
      auto const& other = s.boundaries[next];
      if (role != Role::still || enclosed == 0 || other.enclosed < enclosed || is_plain(other)) continue;
      role = Role::moving;
      front.push_back(next);
    }
  }
}

/// A plane wall that reaches farther than a wall that is no plane is the ground that this stands on, or the tunnel
/// around it, and no body.
void leave_grounds(MeshSummary const& s, std::vector<Role>& roles) {
  std::vector<Role> const before = roles;
  for (std::size_t b = 0; b < s.boundaries.size(); ++b) {
    auto const& plane = s.boundaries[b];
    if (before[b] != Role::moving || !is_plane(plane)) continue;
    for (std::size_t other = 0; other < s.boundaries.size(); ++other)
      if (before[other] == Role::moving && !is_plain(s.boundaries[other]) &&
          s.boundaries[other].enclosed > plane.enclosed)
        roles[b] = Role::still;
  }
}

/// A wall of revolution that touches walls that move, and nothing beside them, is the tip of a blade, not an end wall.
void add_tips(MeshSummary const& s, std::vector<Role>& roles) {
  for (std::size_t b = 0; b < s.boundaries.size(); ++b) {
    if (roles[b] != Role::end_wall) continue;
    auto const& touches = s.boundaries[b].touches;
    if (!touches.empty() &&
        std::all_of(touches.begin(), touches.end(), [&](int t) { return roles[t] == Role::moving; }))
      roles[b] = Role::moving;
  }
}

/// Boundaries of one role that are joined, directly or through each other: each group ascending.
std::vector<std::vector<int>> joined(MeshSummary const& s, std::vector<Role> const& roles, Role role) {
  std::vector<std::vector<int>> out;
  std::vector<char> done(s.boundaries.size(), 0);
  for (std::size_t b = 0; b < s.boundaries.size(); ++b) {
    if (done[b] || roles[b] != role) continue;
    std::vector<int> group, front{int(b)};
    done[b] = 1;
    while (!front.empty()) {
      group.push_back(front.back());
      front.pop_back();
      for (int const next : s.boundaries[group.back()].touches)
        if (!done[next] && roles[next] == role) {
          done[next] = 1;
          front.push_back(next);
        }
    }
    std::sort(group.begin(), group.end());
    out.push_back(std::move(group));
  }
  return out;
}

/// A path as a file in `folder` should name it. Links on the way to the folder are resolved, because ".." goes up from
/// what they lead to; the name of the file itself is kept.
std::string path_from(std::filesystem::path const& folder, std::filesystem::path const& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::path const parent = file.has_parent_path() ? file.parent_path() : fs::path(".");
  fs::path const from = fs::canonical(folder.empty() ? fs::path(".") : folder, failed);
  if (failed) return file.string();
  fs::path const to = fs::canonical(parent, failed);
  if (failed) return file.string();
  fs::path const way = to.lexically_relative(from);
  if (way.empty()) return (to / file.filename()).string();
  return (way / file.filename()).lexically_normal().string();
}

/// The name of the morphed mesh: that of the input with "_morphed" before its ending, which of binary UGRID has two
/// parts; folders have none.
std::string morphed_name(std::filesystem::path const& input, bool cgns) {
  namespace fs = std::filesystem;
  std::string const added = "_morphed";
  std::error_code failed;
  bool const foam = input.extension() == ".foam";
  if (fs::is_directory(input, failed) || foam) {
    fs::path const whole = fs::weakly_canonical(foam ? fs::absolute(input).parent_path() : input, failed);
    std::string const name =
        foam && !input.stem().string().starts_with(".") ? input.stem().string() : whole.filename().string();
    return (failed || name.empty() ? "mesh" : name) + added;
  }
  fs::path const stem = input.stem();
  if (cgns) return stem.string() + added + ".cgns";
  bool const two_parts = input.extension() == ".ugrid" && stem.has_extension() && stem.extension().string().size() <= 5;
  return two_parts ? stem.stem().string() + added + stem.extension().string() + ".ugrid"
                   : stem.string() + added + input.extension().string();
}

class Snippet {
 public:
  Snippet(MeshSummary const& s, SnippetOptions const& options) : s_(s), options_(options) {
    for (auto const& b : s.boundaries) roles_.push_back(role_of(b, s));
    for (std::size_t b = 0; b < s.boundaries.size(); ++b)
      if (is_kind(s.boundaries[b], PatchKind::degenerate)) roles_[b] = Role::paired;
    if (s.axis)
      add_tips(s, roles_);
    else
      leave_grounds(s, roles_);
    if (std::find(roles_.begin(), roles_.end(), Role::moving) == roles_.end())
      if (int const body = most_like_a_body(s, roles_); body >= 0) {
        guessed_ = true;
        roles_[body] = Role::moving;
        add_rest_of_body(s, body, roles_);
      }
    // A wall round the whole mesh with a body in it is a duct, not what moves.
    bool const any_body = std::any_of(s.boundaries.begin(), s.boundaries.end(), [&](BoundarySummary const& b) {
      return roles_[&b - s.boundaries.data()] == Role::moving && is_body(b, s);
    });
    for (std::size_t b = 0; any_body && b < roles_.size(); ++b)
      if (roles_[b] == Role::moving && looks_like(s.boundaries[b], "reaches round")) roles_[b] = Role::still;
    bodies_ = joined(s, roles_, Role::moving);
    if (s.axis && !s.unstructured && !guessed_ && bodies_.size() == 1) blade_ = blade_of(bodies_.front());
  }

  std::string text() {
    if (auto const why = why_no_case(s_); !why.empty()) return "# none: " + why + "\n";
    head();
    for (auto const& body : bodies_) moving(body);
    if (bodies_.empty() && !s_.boundaries.empty())
      text_ +=
          "\n# Nothing here is known as a wall or looks like a body: give one of these a motion, such as\n"
          "# rule = \"rigid\" with translation = [0, 0, 0].\n";
    others();
    near_field();
    return std::move(text_);
  }

 private:
  [[nodiscard]] std::vector<std::string> names(std::vector<int> const& list) const {
    std::vector<std::string> out;
    for (int const b : list) {
      auto const& name = s_.boundaries[b].selector;
      // A name that is a family and a BC means the family.
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
    return out;
  }

  void head() {
    std::filesystem::path const input(s_.source);
    text_ = "[mesh]\ninput  = " + toml_string(path_from(options_.folder, input)) + "\n";
    text_ += "output = " + toml_string(morphed_name(input, s_.file_variant.empty() && !s_.unstructured)) + "\n";
    if (options_.side_file)
      text_ += "side_file = " + toml_string(path_from(options_.folder, *options_.side_file)) + "\n";
    if (!options_.leave_out.empty()) text_ += "leave_out = " + toml_list(options_.leave_out) + "\n";
    if (s_.axis)
      text_ += fmt::format("axis   = {{ origin = {}, direction = {} }}\n", vector_text(s_.axis->origin),
                           vector_text(s_.axis->direction));
    if (s_.needed_tolerance > 0)
      text_ += fmt::format("matching_tolerance = {:.2g}  # interface nodes are that far apart\n", s_.needed_tolerance);
    if (s_.open_faces)
      text_ += "open_faces = \"open\"       # faces that nothing claims: stay where they are, or give them a rule\n";
  }

  void rule(std::vector<std::string> const& patches, std::string_view comment, std::string_view lines) {
    std::vector<std::string> fresh;
    for (auto const& name : patches)
      if (std::find(named_.begin(), named_.end(), name) == named_.end()) fresh.push_back(name);
    named_.insert(named_.end(), fresh.begin(), fresh.end());
    if (fresh.empty()) return;
    text_ += fmt::format("\n[[motion]]{}{}\npatches = {}\n{}\n", comment.empty() ? "" : "  # ", comment,
                         toml_list(fresh), lines);
  }

  void moving(std::vector<int> const& body) {
    std::string comment = "put the motion here; also \"formula\", \"field\", or \"fixed\"";
    if (guessed_) comment = "no wall is known by its type or name, this may be one: " + comment;
    if (names(body).size() > 1) comment += "; they touch, so they move as one";
    rule(names(body), comment, "rule = \"rigid\"\ntranslation = [0, 0, 0]");
  }

  /// What stands on an end wall, of a body that is alone or has a tip as well; -1: nothing, or several.
  [[nodiscard]] int blade_of(std::vector<int> const& body) const {
    std::vector<int> standing;
    for (int const b : body) {
      auto const& boundary = s_.boundaries[b];
      bool const stands = std::any_of(boundary.touches.begin(), boundary.touches.end(),
                                      [&](int t) { return roles_[t] == Role::end_wall; });
      if ((stands || body.size() == 1) && !looks_like(boundary, "surface of revolution")) standing.push_back(b);
    }
    return standing.size() == 1 ? standing.front() : -1;
  }

  [[nodiscard]] bool meets_a_moving_one(int b) const {
    auto const& touches = s_.boundaries[b].touches;
    return std::any_of(touches.begin(), touches.end(), [&](int t) { return roles_[t] == Role::moving; });
  }

  [[nodiscard]] std::vector<int> of_role(Role role) const {
    std::vector<int> out;
    for (std::size_t b = 0; b < roles_.size(); ++b)
      if (roles_[b] == role) out.push_back(int(b));
    return out;
  }

  /// Whether nodes can slide on the facets of a boundary: 2-D meshes have none.
  [[nodiscard]] bool has_facets() const { return !s_.two_dimensional; }

  void others() {
    bool const one_blade = blade_ >= 0;
    std::vector<int> planes, loose, far, rest, ranked, slides;
    // A wall goes off what is curved as it moves, and slip would undo its motion there; overset boundaries are no
    // surface of anything.
    auto const sort_in = [&](int b, std::vector<int>& standing) {
      bool const meets = meets_a_moving_one(b);
      bool const overset = is_kind(s_.boundaries[b], PatchKind::connection);
      (meets && s_.boundaries[b].flat && !overset ? planes
       : meets && (has_facets() || overset)       ? loose
       : meets                                    ? ranked
                                                  : standing)
          .push_back(b);
    };
    for (int const b : of_role(Role::symmetry)) {
      if (s_.boundaries[b].flat)
        planes.push_back(b);
      else
        sort_in(b, rest);
    }
    for (int const b : of_role(Role::through_flow)) one_blade ? slides.push_back(b) : sort_in(b, rest);
    for (int const b : of_role(Role::far_field)) sort_in(b, far);
    for (int const b : of_role(Role::still)) sort_in(b, rest);

    rule(names(of_role(Role::end_wall)), "nodes slide on the wall", "rule = \"slip\"\nsurface = \"revolution\"");
    std::string const of_blade = one_blade ? "\nof = " + toml_string(names({blade_}).front()) : "";
    rule(names(slides), "", "rule = \"circumferential-slide\"" + of_blade);
    if (one_blade && !s_.periodics.empty()) rule({"type:periodic"}, "", "rule = \"follow\"" + of_blade);
    rule(names(planes), "nodes slide on the plane", "rule = \"slip\"\nsurface = \"plane\"");
    rule(names(loose), "moving walls end here and take the nodes along; on a surface that stays: slip, baseline",
         "rule = \"free\"");
    rule(names(far), "far away", "rule = \"fixed\"");
    rule(names(rest), "", "rule = \"fixed\"");
    rule(names(ranked), "where a moving wall ends here, the wall decides", "rule = \"fixed\"\nrank = 1");
    if (s_.unstructured) rule(names(paired_of_other_kinds()), "periodic: both sides move as one", "rule = \"free\"");
    if (s_.open_faces && s_.boundaries.empty())
      rule({"open"}, "no boundary has a name: a side file gives them (inspect --write-side-file)", "rule = \"fixed\"");
  }

  /// Those of no kind are free without being told.
  [[nodiscard]] std::vector<int> paired_of_other_kinds() const {
    std::vector<int> out;
    for (int const b : of_role(Role::paired)) {
      auto const& boundary = s_.boundaries[b];
      if (boundary.paired && !(boundary.kinds.size() == 1 && is_kind(boundary, PatchKind::other))) out.push_back(b);
    }
    return out;
  }

  void near_field() {
    // Without an extent it goes as far as there is room.
    bool drives = false;
    std::vector<int> all;
    for (auto const& body : bodies_)
      for (int const b : body) {
        auto const& boundary = s_.boundaries[b];
        // Over a tip there is a gap, and no near field.
        if (blade_ >= 0 && b != blade_) continue;
        all.push_back(b);
        drives = drives || is_kind(boundary, PatchKind::wall) || is_kind(boundary, PatchKind::other);
      }
    std::sort(all.begin(), all.end());
    if (!s_.unstructured && !all.empty())
      text_ += fmt::format("\n[boundary_layer]\nwalls = {}\n", toml_list(names(all)));
    if (s_.unstructured && !all.empty() && !drives)
      text_ += fmt::format("\n[near_field]\nwalls = {}\n", toml_list(names(all)));
  }

  MeshSummary const& s_;
  SnippetOptions const& options_;
  std::vector<Role> roles_;
  std::vector<std::vector<int>> bodies_;  ///< moving boundaries that are joined
  bool guessed_ = false;
  int blade_ = -1;                  ///< the one of a blade row
  std::vector<std::string> named_;  ///< patches that have a rule
  std::string text_;
};

}  // namespace

std::string case_snippet(MeshSummary const& s, SnippetOptions const& options) { return Snippet(s, options).text(); }

std::string why_no_case(MeshSummary const& s) {
  bool const blocks_with_open_faces = !s.unstructured && s.open_faces;  // these have a rule of their own
  if (!s.boundaries.empty() || blocks_with_open_faces) return {};
  return "the file names no boundary, and what has no name cannot be moved; name its boundaries in the mesh generator" +
         std::string(s.unstructured ? "" : " or in a side file (gridmorph inspect --write-side-file)");
}

}  // namespace gridmorph::cli
