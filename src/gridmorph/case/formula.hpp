// Displacement rules written as formulas of the baseline position (muParser).
#pragma once

#include <gridmorph/case/timed_rule.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/motion.hpp>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace gridmorph {

/// In which directions the three expressions of a formula point.
enum class FormulaFrame {
  cartesian,   ///< dx, dy, dz along the coordinate axes
  cylindrical  ///< dr [length], dtheta [rad], daxial [length] about the machine axis, moved along circles exactly
};

/// One component of a formula.
struct FormulaComponent {
  std::string key;         ///< "dx", for messages
  std::string expression;  ///< empty: the component is zero
  std::string where;       ///< "case.toml:14", for messages
};

/// Makes a rule from three expressions in x, y, z, r, theta and axial (position relative to the axis; theta in radians,
/// right-handed about the axis, zero along the coordinate axis that follows the axis' dominant one in the cycle x, y,
/// z; for an x axis theta = atan2(z, y)), the user's constants, `pi` and `deg` (pi / 180).
///
/// Problems of the expressions are added to `problems` with place, position and the nearest known name. The rule throws
/// MotionError when a component is not finite, naming the point. Evaluations may come from several threads; they take
/// turns. Cost per point: the expressions plus one square root and one atan2 where r or theta is used.
FunctionRule make_formula(FormulaFrame frame, std::array<FormulaComponent, 3> const& components,
                          std::map<std::string, double> const& constants, Axis const& axis, Problems& problems);

/// The same at a moment of a sequence, with the variables `t` (time) and `step` (1, 2, ...), times a share of each
/// component (so half of a turn by dtheta is a turn by half the angle).
using FormulaAt = std::function<FunctionRule(double share, Moment const& when)>;
FormulaAt make_formula_in_time(FormulaFrame frame, std::array<FormulaComponent, 3> const& components,
                               std::map<std::string, double> const& constants, Axis const& axis, Problems& problems);

/// Heights of an inflated surface: an expression in the position, t and step as above, and in span_fraction,
/// chord_fraction and side of SurfacePlace, unless constants have these names. Problems and errors as above.
using HeightAt =
    std::function<void(std::span<SurfacePlace const> places, std::span<double> height, Moment const& when)>;
HeightAt make_height_formula(FormulaComponent const& formula, std::map<std::string, double> const& constants,
                             Axis const& axis, Problems& problems);
/// Whether an expression for a height uses span_fraction, chord_fraction or side; and side among them.
bool uses_sections(std::string const& expression, std::map<std::string, double> const& constants);
bool uses_side(std::string const& expression, std::map<std::string, double> const& constants);

/// A number that depends on `t`, `step` and the constants alone. Problems are added as above, also for names of the
/// position.
std::function<double(Moment const& when)> make_time_formula(FormulaComponent const& formula,
                                                            std::map<std::string, double> const& constants,
                                                            Problems& problems);

/// w(t), t the fraction of a grid line's length, of t and the constants alone; not a number where the expression has no
/// value. Problems are added as above.
std::function<double(double t)> make_law_formula(FormulaComponent const& formula,
                                                 std::map<std::string, double> const& constants, Problems& problems);

/// The value of an expression of constants alone. Problems are added as above, also where the value is not finite; then
/// there is none.
std::optional<double> value_of_formula(FormulaComponent const& formula, std::map<std::string, double> const& constants,
                                       Problems& problems);

/// Whether an expression has the name in it.
bool uses_name(std::string const& expression, std::string const& name);

/// Whether a name can be a constant of a formula: letters, digits and '_', not starting with a digit, and neither a
/// variable, a built-in constant nor a function.
bool is_free_formula_name(std::string const& name);
/// What to say of others.
inline constexpr char const* not_a_constant =
    "cannot be the name of a constant; use letters, digits and '_', and none of x, y, z, r, theta, axial, t, step, pi, "
    "deg or the functions";

/// Whether an expression uses t or step, that is, needs a sequence.
bool uses_time(std::string const& expression);

/// Whether an expression uses r, theta or axial, that is, needs the machine axis.
bool uses_axis(std::string const& expression);

}  // namespace gridmorph
