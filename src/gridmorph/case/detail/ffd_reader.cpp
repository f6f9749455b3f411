#include <gridmorph/case/detail/number_table.hpp>
#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/detail/toml.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mapping/text_table.hpp>
#include <gridmorph/motion/ffd/check_ffd.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>
#include <gridmorph/motion/ffd/ffd_motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace gridmorph::casefile {

namespace {

/// Control points of a PLOT3D file, i fastest.
struct LatticeFile {
  std::array<int, 3> counts{};
  std::vector<Vec3> points;
};

std::optional<LatticeFile> read_lattice_file(TableReader& table, std::string const& key) {
  auto const name = table.string(key);
  if (!name) return std::nullopt;
  try {
    Mesh const mesh = read_mesh(table.context().input(*name).string());
    if (mesh.zones.size() != 1 || !mesh.is_structured() || mesh.dimension != 3) {
      table.problem(key, fmt::format("'{}' holds {} blocks; a lattice is one block of i x j x k control points, and a "
                                     "rule has one lattice",
                                     *name, mesh.zones.size()));
      return std::nullopt;
    }
    LatticeFile out;
    Zone const& zone = mesh.zones.front();
    out.counts = {zone.extent[0], zone.extent[1], zone.extent[2]};
    for (Index n = 0; n < zone.size(); ++n) out.points.push_back(mesh.coordinates[n]);
    return out;
  } catch (Error const& e) {
    table.problem(key, e.what());
    return std::nullopt;
  }
}

/// { from = [x, y, z], to = [x, y, z] } or { origin = [x, y, z], i = [x, y, z], j = ..., k = ... }.
std::optional<FfdBox> read_box_of(TableReader& rule) {
  auto table = rule.table("box");
  if (!table) return std::nullopt;
  FfdBox box;
  bool const aligned = table->has("from") || table->has("to");
  std::array<std::optional<Vec3>, 4> given;
  std::array<std::string, 4> const names{"origin", "i", "j", "k"};
  auto const from = table->vector("from"), to = table->vector("to");
  for (std::size_t n = 0; n < 4; ++n) {
    given[n] = table->vector(names[n]);
    if (aligned && table->has(names[n])) table->problem(names[n], "stands beside from and to; remove it, or these");
    if (!aligned) table->require(names[n], names[n] + " = [x, y, z], or from and to");
  }
  if (aligned) {
    table->require("from", "from = [x, y, z]");
    table->require("to", "to = [x, y, z]");
  }
  table->finish();
  if (aligned) {
    if (!from || !to) return std::nullopt;
    if (!(from->x < to->x && from->y < to->y && from->z < to->z)) {
      rule.problem("box", "must reach from its smaller to its larger x, y and z");
      return std::nullopt;
    }
    Vec3 const e = *to - *from;
    return FfdBox{*from, {Vec3{e.x, 0, 0}, Vec3{0, e.y, 0}, Vec3{0, 0, e.z}}};
  }
  if (!given[0] || !given[1] || !given[2] || !given[3]) return std::nullopt;
  return FfdBox{*given[0], {*given[1], *given[2], *given[3]}};
}

/// Three whole numbers, or one for all three.
std::optional<std::array<int, 3>> read_three(TableReader& table, std::string const& key, bool one_for_all) {
  auto const* value = table.find(key);
  if (value == nullptr) return std::nullopt;
  if (one_for_all && value->is_integer()) {
    auto const n = table.integer(key);
    return n ? std::optional(std::array<int, 3>{*n, *n, *n}) : std::nullopt;
  }
  std::array<int, 3> out{};
  bool good = value->is_array() && value->as_array().size() == 3;
  for (std::size_t a = 0; good && a < 3; ++a) {
    auto const& item = value->as_array()[a];
    good = item.is_integer() && item.as_integer() >= 0 && item.as_integer() <= 10000;
    if (good) out[a] = int(item.as_integer());
  }
  if (good) return out;
  table.problem(key, fmt::format("expected three whole numbers [i, j, k] up to 10000{}, found {}",
                                 one_for_all ? ", or one for all" : "", describe_value(*value)));
  return std::nullopt;
}

/// Degrees: as given, a single number as far as the control points allow; without any Bernstein polynomials, or cubics
/// of a file's lattice.
void read_degree(TableReader& table, FfdRule& rule, bool of_file) {
  auto const* value = table.find("degree");
  auto const given = read_three(table, "degree", true);
  bool const each = value != nullptr && value->is_array();
  for (std::size_t a = 0; a < 3; ++a) {
    int const most = std::min(rule.counts[a] - 1, FfdRule::most_degree);
    rule.degree[a] = given ? (each ? (*given)[a] : std::min((*given)[a], most)) : of_file ? std::min(3, most) : most;
  }
}

void read_open_faces(TableReader& table, FfdRule& rule) {
  auto const names = table.strings("open_faces");
  if (!names) return;
  std::vector<std::string> known;
  for (std::size_t f = 0; f < 6; ++f) known.push_back(ffd_face_name(f));
  for (auto const& name : *names) {
    auto const at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      table.problem("open_faces", fmt::format("\"{}\" is no face of a lattice{}; there are i-min, i-max, j-min, j-max, "
                                              "k-min and k-max",
                                              name, suggestion(name, known)));
    else
      rule.open[at - known.begin()] = true;
  }
}

/// First and last control point along one direction: a number, [first, last] or "all", counted from 1.
std::optional<std::array<int, 2>> read_range(toml::value const& value, int count) {
  auto const whole = [&](toml::value const& v) {
    return v.is_integer() && v.as_integer() >= 1 && v.as_integer() <= count;
  };
  if (value.is_string() && string_of(value) == "all") return std::array<int, 2>{0, count - 1};
  if (whole(value)) return std::array<int, 2>{int(value.as_integer()) - 1, int(value.as_integer()) - 1};
  if (!value.is_array() || value.as_array().size() != 2) return std::nullopt;
  auto const &first = value.as_array()[0], &last = value.as_array()[1];
  if (!whole(first) || !whole(last) || first.as_integer() > last.as_integer()) return std::nullopt;
  return std::array<int, 2>{int(first.as_integer()) - 1, int(last.as_integer()) - 1};
}

/// Control points from, to along i, j, k.
std::optional<std::array<std::array<int, 2>, 3>> read_at(TableReader& table, FfdRule const& rule) {
  auto const* value = table.find("at");
  table.require("at", "at = [i, j, k], counted from 1");
  if (value == nullptr) return std::nullopt;
  std::array<std::array<int, 2>, 3> out{};
  bool good = value->is_array() && value->as_array().size() == 3;
  for (std::size_t a = 0; good && a < 3; ++a) {
    auto const range = read_range(value->as_array()[a], rule.counts[a]);
    good = range.has_value();
    if (range) out[a] = *range;
  }
  if (good) return out;
  table.problem(
      "at", fmt::format("expected [i, j, k] counted from 1, each a number, [first, last] or \"all\", within {} x {} x "
                        "{} control points",
                        rule.counts[0], rule.counts[1], rule.counts[2]));
  return std::nullopt;
}

/// Displacements of groups of control points, which add up: d, or scale, rotation and translation of where the points
/// are.
void read_points(TableReader& table, RuleContext const& shared, FfdLattice const* lattice, FfdRule& rule) {
  for (auto& point : table.tables("points")) {
    auto const at = read_at(point, rule);
    auto const d = point.vector("d");
    std::vector<RigidSteps> moves;
    bool const moved = read_rigid_step(point, shared, moves);
    if (moved == point.has("d"))
      point.context().problem(point.line(), moved
                                                ? "[[motion]] points: d stands beside scale, rotation or translation; "
                                                  "remove it, or these"
                                                : "[[motion]] points: a point needs d = [dx, dy, dz], or scale, "
                                                  "rotation or translation");
    if (moved && lattice == nullptr && !table.has("box") && !table.has("lattice"))
      point.context().problem(point.line(),
                              "[[motion]] points: scale, rotation and translation need to know where the "
                              "control points are; give the rule a box or a lattice");
    point.finish();
    if (!at || !table.context().problems.empty()) continue;
    auto const& [is, js, ks] = *at;
    RigidRule const rigid = moved ? make_rigid_steps(moves) : RigidRule{};
    for (int k = ks[0]; k <= ks[1]; ++k)
      for (int j = js[0]; j <= js[1]; ++j)
        for (int i = is[0]; i <= is[1]; ++i)
          rule.displacement[rule.number(i, j, k)] += moved ? displacement(rigid, lattice->control_point(i, j, k)) : *d;
  }
}

void read_displacements(TableReader& table, FfdRule& rule) {
  auto const file = table.string("file");
  if (!file) return;
  auto const number_to = [](int count) {
    return [count](double v) { return v == std::floor(v) && v >= 1 && v <= count; };
  };
  std::vector<NumberColumn> columns;
  for (std::size_t a = 0; a < 3; ++a)
    columns.push_back({std::string(1, "ijk"[a]), fmt::format("a whole number from 1 to {}", rule.counts[a]),
                       number_to(rule.counts[a])});
  for (char const* name : {"dx", "dy", "dz"}) columns.push_back({name, "a number"});
  try {
    auto const path = table.context().input(*file);
    std::vector<std::string> given(rule.size());
    Problems problems;
    for (auto const& [where, v] :
         read_number_table(mapping::read_text_file(path, "table"), path.string(), columns, "displacements")) {
      std::size_t const n = rule.number(int(v[0]) - 1, int(v[1]) - 1, int(v[2]) - 1);
      if (!given[n].empty())
        problems.add(fmt::format("{}: control point ({}, {}, {}) has a displacement already, from {}", where, v[0],
                                 v[1], v[2], given[n]));
      given[n] = where;
      rule.displacement[n] += {v[3], v[4], v[5]};
    }
    problems.throw_if_any<ConfigError>();
  } catch (Error const& e) {
    table.problem("file", e.what());
  }
}

/// The lattice as it shall be: displacements are its points minus those of the lattice as it stands.
void read_deformed(TableReader& table, FfdLattice const* lattice, FfdRule& rule) {
  auto const deformed = read_lattice_file(table, "deformed");
  if (!deformed) return;
  if (lattice == nullptr) {
    if (!table.has("box") && !table.has("lattice"))
      table.problem("deformed", "needs to know where the control points are now; give the rule a box or a lattice");
  } else if (deformed->counts != rule.counts) {
    auto const& n = deformed->counts;
    table.problem("deformed", fmt::format("holds {} x {} x {} control points, and the lattice has {} x {} x {}", n[0],
                                          n[1], n[2], rule.counts[0], rule.counts[1], rule.counts[2]));
  } else {
    for (int k = 0; k < rule.counts[2]; ++k)
      for (int j = 0; j < rule.counts[1]; ++j)
        for (int i = 0; i < rule.counts[0]; ++i) {
          std::size_t const n = rule.number(i, j, k);
          rule.displacement[n] += deformed->points[n] - lattice->control_point(i, j, k);
        }
  }
}

/// Where the lattice is and how many control points it has; false where the latter is not known.
bool read_lattice(TableReader& table, FfdRule& rule) {
  auto const lattice = read_lattice_file(table, "lattice");
  auto const counts = read_three(table, "counts", false);
  rule.box = read_box_of(table);
  if (table.has("lattice")) {
    for (char const* key : {"box", "counts"})
      if (table.has(key)) table.problem(key, "stands beside lattice, which says it; remove one of the two");
  } else {
    table.require("counts", "counts = [8, 3, 2], the control points along i, j and k");
  }
  if (auto const margin = table.number("margin")) {
    rule.margin = *margin;
    if (!(*margin >= 0)) table.problem("margin", fmt::format("must be 0 or more, found {}", *margin));
    if (table.has("box") || table.has("lattice"))
      table.problem("margin", "belongs to the box around the patches, without box and lattice; remove it");
  }
  if (lattice) {
    rule.counts = lattice->counts;
    rule.points = lattice->points;
  } else if (counts) {
    rule.counts = *counts;
  }
  read_degree(table, rule, lattice.has_value());
  return lattice || counts;
}

/// The lattice as it stands; none where the box is fitted later, or cannot be used (noted).
std::unique_ptr<FfdLattice const> make_lattice(TableReader& table, FfdRule const& rule) {
  try {
    Problems problems;
    check_ffd(rule, "the lattice", problems);
    problems.throw_if_any<MotionError>();
    if (rule.box || !rule.points.empty()) return std::make_unique<FfdLattice const>(rule, "the lattice");
  } catch (Error const& e) {
    table.problem("rule", e.what());
  }
  return nullptr;
}

}  // namespace

TimedRule read_ffd(TableReader& table, RuleContext const& shared) {
  std::size_t const before = table.context().problems.messages().size();
  FfdRule rule;
  bool const counted = read_lattice(table, rule);
  if (auto const continuity = table.integer("continuity")) rule.continuity = *continuity;
  read_open_faces(table, rule);
  if (!table.has("points") && !table.has("file") && !table.has("deformed"))
    table.problem("rule",
                  "ffd displaces no control point; give points = [ { at = [i, j, k], d = [dx, dy, dz] } ], a file "
                  "with columns i, j, k, dx, dy, dz, or deformed, a PLOT3D lattice");
  if (counted && rule.size() <= most_control_points) rule.displacement.assign(rule.size(), {});
  if (counted) {
    auto const lattice = make_lattice(table, rule);
    if (rule.displacement.empty()) return {};
    read_points(table, shared, lattice.get(), rule);
    read_displacements(table, rule);
    read_deformed(table, lattice.get(), rule);
  } else {
    for (char const* key : {"points", "file", "deformed"}) (void)table.find(key);  // nothing to compare them with
  }
  if (table.context().problems.messages().size() > before) return {};
  rule.description = fmt::format("{} x {} x {} control points, degree {}, {}, {}", rule.counts[0], rule.counts[1],
                                 rule.counts[2], rule.degree[0], rule.degree[1], rule.degree[2]);
  return {[rule = std::move(rule)](double share, Moment const&) {
            FfdRule out = rule;
            out.share = share;
            return out;
          },
          {}};
}

}  // namespace gridmorph::casefile
