// Reads the [[motion]] tables of a case file. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <map>
#include <string>
#include <vector>

namespace gridmorph::casefile {

/// What rules share: the machine axis and the constants of formulas.
struct RuleContext {
  std::optional<Axis> axis;
  std::map<std::string, double> constants;
  bool in_time = false;  ///< whether there is a sequence, so that things may depend on time
};

/// The words for `rule`, those that are not available yet among them.
std::vector<std::string> const& known_rules();

/// { origin = [x, y, z], direction = [x, y, z] } or "x", "y", "z". Nothing when absent or unusable (problem noted).
std::optional<Axis> read_axis(TableReader& table, std::string const& key);

/// Notes that a key whose value depends on t or step needs a sequence, where there is none.
void needs_sequence(TableReader& table, RuleContext const& shared, std::string const& key);

/// rotation = { axis, origin, angle_deg } of a table; without axis and origin about the machine axis.
void read_rotation(TableReader& step, RuleContext const& shared, RigidSteps& rigid);

/// Scale, then rotation, then translation, as far as given, at the end of the list. False when none is.
bool read_rigid_step(TableReader& step, RuleContext const& shared, std::vector<RigidSteps>& all);

/// Constants of formulas: a table of names and numbers.
void read_constants(TableReader& table, std::string const& key, std::map<std::string, double>& constants);

/// Reads one [[motion]] table and appends its rule (and its point field, if any) to the case file.
void read_motion_rule(TableReader& table, RuleContext const& shared, CaseFile& out);

}  // namespace gridmorph::casefile
