#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/core/text.hpp>

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

std::vector<std::string> const variable_names{"x", "y", "z", "r", "theta", "axial", "t", "step"};
/// Variables of places on sections, for heights alone; constants of these names hide them.
std::vector<std::string> const place_names{"span_fraction", "chord_fraction", "side"};

/// Evaluated this many points at a time: long enough to hide the call, short enough to stay in cache.
constexpr std::size_t batch = 512;

double smoothstep(double low, double high, double value) {
  double const s = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}
double clamp(double value, double low, double high) { return std::fmin(std::fmax(value, low), high); }
double floor_of(double value) { return std::floor(value); }
double ceil_of(double value) { return std::ceil(value); }
double hypot_of(double a, double b) { return std::hypot(a, b); }

void define_language(mu::Parser& parser) {
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("deg", std::numbers::pi / 180);
  parser.DefineFun("smoothstep", smoothstep);
  parser.DefineFun("clamp", clamp);
  parser.DefineFun("floor", floor_of);
  parser.DefineFun("ceil", ceil_of);
  parser.DefineFun("hypot", hypot_of);
}

bool is_name_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Names in an expression, in order; numbers like 1e5 are no names.
std::vector<std::string> names_in(std::string const& expression) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < expression.size();) {
    if (!is_name_character(expression[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < expression.size() && is_name_character(expression[end])) ++end;
    if (std::isdigit(static_cast<unsigned char>(expression[i])) == 0) names.push_back(expression.substr(i, end - i));
    i = end;
  }
  return names;
}

/// A single '=' assigns in muParser, which would overwrite the coordinates.
bool assigns(std::string const& e) {
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (e[i] != '=') continue;
    if (i + 1 < e.size() && e[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i > 0 && (e[i - 1] == '<' || e[i - 1] == '>' || e[i - 1] == '!')) continue;
    return true;
  }
  return false;
}

/// Unit vectors of the cylindrical frame: theta = 0 along `zero`, theta = 90 degrees along `quarter`.
struct PolarFrame {
  Vec3 origin, axis, zero, quarter;
};

PolarFrame frame_of(Axis const& axis) {
  PolarFrame f;
  f.origin = axis.origin;
  f.axis = (1 / norm(axis.direction)) * axis.direction;
  double const a[3] = {std::fabs(f.axis.x), std::fabs(f.axis.y), std::fabs(f.axis.z)};
  int const dominant = int(std::max_element(a, a + 3) - a);
  Vec3 const e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 const next = e[(dominant + 1) % 3];
  Vec3 const flat = next - dot(next, f.axis) * f.axis;
  f.zero = (1 / norm(flat)) * flat;
  f.quarter = cross(f.axis, f.zero);
  return f;
}

class Formula {
 public:
  /// `names`: variable_names, and what of place_names it has.
  Formula(FormulaFrame frame, std::array<FormulaComponent, 3> components, Axis const& axis,
          std::vector<std::string> names = variable_names)
      : frame_(frame),
        components_(std::move(components)),
        cylinder_(frame_of(axis)),
        names_(std::move(names)),
        variables_(names_.size()) {
    for (auto& v : variables_) v.assign(batch, 1.0);
    for (auto& r : results_) r.assign(batch, 0.0);
  }

  void prepare(std::map<std::string, double> const& constants, Problems& problems) {
    for (int c = 0; c < 3; ++c) {
      if (components_[c].expression.empty()) continue;
      check(c, constants, problems);
      for (auto const& name : names_in(components_[c].expression))
        needs_cylinder_ = needs_cylinder_ || name == "r" || name == "theta" || name == "axial";
    }
    needs_cylinder_ = needs_cylinder_ || frame_ == FormulaFrame::cylindrical;
  }

  void operator()(std::span<Vec3 const> points, std::span<Vec3> displacement, double share, Moment const& when) {
    std::lock_guard const lock(turn_);
    begin(when);
    for (std::size_t first = 0; first < points.size(); first += batch) {
      std::size_t const n = std::min(batch, points.size() - first);
      evaluate(points.subspan(first, n), displacement.subspan(first, n), share);
    }
  }

  /// The first component at places.
  void heights(std::span<SurfacePlace const> places, std::span<double> out, Moment const& when) {
    std::lock_guard const lock(turn_);
    begin(when);
    std::array<Vec3, batch> points, values;
    for (std::size_t first = 0; first < places.size(); first += batch) {
      std::size_t const n = std::min(batch, places.size() - first);
      for (std::size_t i = 0; i < n; ++i) points[i] = places[first + i].point;
      for (std::size_t v = variable_names.size(); v < names_.size(); ++v)
        for (std::size_t i = 0; i < n; ++i) variables_[v][i] = value_of(names_[v], places[first + i]);
      evaluate({points.data(), n}, {values.data(), n}, 1);
      for (std::size_t i = 0; i < n; ++i) out[first + i] = values[i].x;
    }
  }

 private:
  static double value_of(std::string const& name, SurfacePlace const& place) {
    return name == place_names[0] ? place.span_fraction : name == place_names[1] ? place.chord_fraction : place.side;
  }

  void begin(Moment const& when) {
    std::fill(variables_[6].begin(), variables_[6].end(), when.time);
    std::fill(variables_[7].begin(), variables_[7].end(), double(when.step));
  }

  void check(int c, std::map<std::string, double> const& constants, Problems& problems) {
    auto const& [key, expression, where] = components_[c];
    mu::Parser& parser = parsers_[c];
    if (assigns(expression)) {
      problems.add(
          fmt::format("{}: formula {} = \"{}\" contains a single '='; write == to compare", where, key, expression));
      return;
    }
    try {
      define_language(parser);
      for (std::size_t v = 0; v < names_.size(); ++v) parser.DefineVar(names_[v], variables_[v].data());
      // Of however many constants those that are named.
      for (auto const& name : names_in(expression))
        if (auto const at = constants.find(name); at != constants.end()) parser.DefineConst(name, at->second);
      parser.SetExpr(expression);
      int results = 0;
      parser.Eval(results);
      if (results != 1)
        problems.add(fmt::format("{}: formula {} = \"{}\" gives {} values separated by commas; one is wanted", where,
                                 key, expression, results));
    } catch (mu::Parser::exception_type const& e) {
      problems.add(describe(e, c, constants));
    } catch (std::exception const& e) {
      problems.add(fmt::format("{}: formula {} = \"{}\": {}", where, key, expression, e.what()));
    }
  }

  std::string describe(mu::Parser::exception_type const& e, int c,
                       std::map<std::string, double> const& constants) const {
    auto const& [key, expression, where] = components_[c];
    std::string const at = fmt::format("{}: formula {} = \"{}\"", where, key, expression);
    int const position = std::clamp(int(e.GetPos()), 0, int(expression.size()));
    if (e.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !e.GetToken().empty()) {
      std::string token;  // muParser's token runs on to the next operator; the name ends earlier
      for (char const ch : e.GetToken()) {
        if (!is_name_character(ch)) break;
        token += ch;
      }
      std::vector<std::string> known = names_;
      for (auto const& [name, value] : constants) known.push_back(name);
      std::string const near = nearest_word(token, [&] {
        auto all = known;
        for (auto const& [name, callback] : parsers_[c].GetFunDef()) all.push_back(name);
        return all;
      }());
      constexpr std::size_t most_named = 40;
      if (known.size() > most_named) known.resize(most_named);
      known.insert(known.end(), {"pi", "deg"});
      std::string names;
      for (auto const& name : known) names += (names.empty() ? "" : ", ") + name;
      return fmt::format("{}: unknown name '{}' at character {}{}", at, token.empty() ? e.GetToken() : token,
                         position + 1,
                         near.empty() ? "; known here: " + names + " and functions" : "; did you mean '" + near + "'?");
    }
    std::string text = e.GetMsg();
    while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
    return fmt::format("{}: {} (at character {})", at, text, position + 1);
  }

  void evaluate(std::span<Vec3 const> points, std::span<Vec3> displacement, double share) {
    std::size_t const n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
      variables_[0][i] = points[i].x;
      variables_[1][i] = points[i].y;
      variables_[2][i] = points[i].z;
      if (!needs_cylinder_) continue;
      Vec3 const p = points[i] - cylinder_.origin;
      double const a = dot(p, cylinder_.zero), b = dot(p, cylinder_.quarter);
      variables_[3][i] = std::sqrt(a * a + b * b);
      variables_[4][i] = std::atan2(b, a);
      variables_[5][i] = dot(p, cylinder_.axis);
    }
    for (int c = 0; c < 3; ++c) {
      if (components_[c].expression.empty()) continue;
      try {
        parsers_[c].Eval(results_[c].data(), int(n));
      } catch (mu::Parser::exception_type const& e) {
        throw_at(c, e.GetMsg());
      } catch (std::exception const& e) {
        throw_at(c, e.what());
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (int c = 0; c < 3; ++c) {
        if (share != 1 && !components_[c].expression.empty()) results_[c][i] *= share;
        if (!std::isfinite(results_[c][i])) not_finite(c, points[i], results_[c][i]);
      }
      displacement[i] = frame_ == FormulaFrame::cartesian ? Vec3{results_[0][i], results_[1][i], results_[2][i]}
                                                          : along_circle(i, points[i]);
    }
  }

  /// From (r, theta, axial) to (r + dr, theta + dtheta, axial + daxial), without cancellation for small motions.
  Vec3 along_circle(std::size_t i, Vec3 const& point) const {
    double const dr = results_[0][i], dtheta = results_[1][i], daxial = results_[2][i], r = variables_[3][i];
    if (r == 0) {
      if (dr != 0)
        throw MotionError(fmt::format(
            "{}: formula {} = \"{}\" is {} at {} on the axis, where the radial direction is not defined; make it zero "
            "there",
            components_[0].where, components_[0].key, components_[0].expression, dr, to_text(point, 9)));
      return daxial * cylinder_.axis;
    }
    double const theta = variables_[4][i];
    Vec3 const radial = std::cos(theta) * cylinder_.zero + std::sin(theta) * cylinder_.quarter;
    Vec3 const tangent = cross(cylinder_.axis, radial);
    double const half = std::sin(dtheta / 2);
    return (dr * std::cos(dtheta) - 2 * r * half * half) * radial + ((r + dr) * std::sin(dtheta)) * tangent +
           daxial * cylinder_.axis;
  }

  [[noreturn]] void throw_at(int c, std::string const& what) const {
    throw MotionError(fmt::format("{}: formula {} = \"{}\": {}", components_[c].where, components_[c].key,
                                  components_[c].expression, what));
  }

  [[noreturn]] void not_finite(int c, Vec3 const& point, double value) const {
    throw MotionError(fmt::format(
        "{}: formula {} = \"{}\" is {} at x = {:.9g}, y = {:.9g}, z = {:.9g}; restrict it to where "
        "it is defined, for example with (condition ? value : 0)",
        components_[c].where, components_[c].key, components_[c].expression, value, point.x, point.y, point.z));
  }

  FormulaFrame frame_;
  std::array<FormulaComponent, 3> components_;
  PolarFrame cylinder_;
  bool needs_cylinder_ = false;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> variables_;  // in the order of names_, of one batch
  std::array<std::vector<double>, 3> results_;
  std::array<mu::Parser, 3> parsers_;
  std::mutex turn_;  // the parsers read and write the batch above
};

}  // namespace

bool is_free_formula_name(std::string const& name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) return false;
  if (!std::all_of(name.begin(), name.end(), is_name_character)) return false;
  if (std::find(variable_names.begin(), variable_names.end(), name) != variable_names.end()) return false;
  static mu::Parser const parser = [] {
    mu::Parser out;
    define_language(out);
    return out;
  }();
  return parser.GetConst().count(name) == 0 && parser.GetFunDef().count(name) == 0;
}

bool uses_name(std::string const& expression, std::string const& name) {
  auto const names = names_in(expression);
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool uses_axis(std::string const& expression) {
  auto const names = names_in(expression);
  return std::any_of(names.begin(), names.end(),
                     [](std::string const& n) { return n == "r" || n == "theta" || n == "axial"; });
}

bool uses_time(std::string const& expression) {
  auto const names = names_in(expression);
  return std::any_of(names.begin(), names.end(), [](std::string const& n) { return n == "t" || n == "step"; });
}

namespace {

void refuse_variables(FormulaComponent const& formula, std::vector<std::string> const& allowed,
                      std::string const& advice, Problems& problems) {
  auto const holds = [](std::vector<std::string> const& list, std::string const& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (auto const& name : names_in(formula.expression))
    if (holds(variable_names, name) && !holds(allowed, name))
      problems.add(fmt::format("{}: formula {} = \"{}\" uses {}; it may depend on {}", formula.where, formula.key,
                               formula.expression, name, advice));
}

}  // namespace

std::function<double(double t)> make_law_formula(FormulaComponent const& formula,
                                                 std::map<std::string, double> const& constants, Problems& problems) {
  refuse_variables(formula, {"t"}, "t, the fraction of a line's length, alone", problems);
  auto const w = make_time_formula(formula, constants, problems);
  return [w](double t) {
    try {
      return w({0, t, 1});
    } catch (MotionError const&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
}

std::function<double(Moment const& when)> make_time_formula(FormulaComponent const& formula,
                                                            std::map<std::string, double> const& constants,
                                                            Problems& problems) {
  refuse_variables(formula, {"t", "step"}, "t and step, not on the position", problems);
  auto const rule = make_formula_in_time(FormulaFrame::cartesian, {formula, {}, {}}, constants, Axis{}, problems);
  return [rule](Moment const& when) {
    Vec3 const origin;
    Vec3 value;
    rule(1, when).function({&origin, 1}, {&value, 1});
    return value.x;
  };
}

std::optional<double> value_of_formula(FormulaComponent const& formula, std::map<std::string, double> const& constants,
                                       Problems& problems) {
  std::size_t const before = problems.messages().size();
  refuse_variables(formula, {}, "parameters and constants alone", problems);
  auto const value =
      make_formula_in_time(FormulaFrame::cartesian, {formula, {}, {}}, constants, Axis{}, problems)(1, {});
  if (problems.messages().size() > before) return std::nullopt;
  Vec3 const origin;
  Vec3 out;
  try {
    value.function({&origin, 1}, {&out, 1});
  } catch (MotionError const& e) {
    problems.add(e.what());
    return std::nullopt;
  }
  return out.x;
}

HeightAt make_height_formula(FormulaComponent const& formula, std::map<std::string, double> const& constants,
                             Axis const& axis, Problems& problems) {
  std::vector<std::string> names = variable_names;
  for (auto const& name : place_names)
    if (!constants.contains(name)) names.push_back(name);
  auto const made = std::make_shared<Formula>(FormulaFrame::cartesian, std::array<FormulaComponent, 3>{formula, {}, {}},
                                              axis, std::move(names));
  made->prepare(constants, problems);
  return [made](std::span<SurfacePlace const> places, std::span<double> out, Moment const& when) {
    made->heights(places, out, when);
  };
}

bool uses_sections(std::string const& expression, std::map<std::string, double> const& constants) {
  auto const names = names_in(expression);
  return std::any_of(place_names.begin(), place_names.end(), [&](std::string const& name) {
    return !constants.contains(name) && std::find(names.begin(), names.end(), name) != names.end();
  });
}

bool uses_side(std::string const& expression, std::map<std::string, double> const& constants) {
  auto const names = names_in(expression);
  return !constants.contains("side") && std::find(names.begin(), names.end(), "side") != names.end();
}

FunctionRule make_formula(FormulaFrame frame, std::array<FormulaComponent, 3> const& components,
                          std::map<std::string, double> const& constants, Axis const& axis, Problems& problems) {
  return make_formula_in_time(frame, components, constants, axis, problems)(1, {});
}

FormulaAt make_formula_in_time(FormulaFrame frame, std::array<FormulaComponent, 3> const& components,
                               std::map<std::string, double> const& constants, Axis const& axis, Problems& problems) {
  auto const formula = std::make_shared<Formula>(frame, components, axis);
  formula->prepare(constants, problems);
  std::string description = "formula";
  for (auto const& c : components)
    if (!c.expression.empty())
      description += fmt::format("{} {} = {}", description == "formula" ? "" : ",", c.key, c.expression);
  return [formula, description](double share, Moment const& when) {
    return FunctionRule{description,
                        [formula, share, when](std::span<Vec3 const> points, std::span<Vec3> displacement) {
                          (*formula)(points, displacement, share, when);
                        }};
  };
}

}  // namespace gridmorph
