// A case file (TOML): what to morph, how the boundary moves, and what to write. Plain structs with their defaults.
//
// The keys are described in docs/case_file.md.
#pragma once

#include <gridmorph/case/timed_rule.hpp>
#include <gridmorph/mapping/inverse_field.hpp>
#include <gridmorph/mapping/point_field.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/options.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// [[wheel.blade]]: a blade that differs from what [[motion]] says.
struct WheelBlade {
  std::string name;
  double factor = 1;              ///< multiplies what explicit rules do, see docs/wheel.md
  std::vector<MotionRule> rules;  ///< in place of the [[motion]] rules of the same patches
  std::vector<TimedRule> timed;   ///< of the same number
  std::string where;              ///< "case.toml:14"
};

/// [[wheel.row]], or the same keys in [wheel].
struct WheelRowCase {
  std::vector<std::string> zones;      ///< names or globs; empty: all zones
  int passages = 0;                    ///< 0: the whole wheel; straight rows have none
  std::vector<std::string> sequence;   ///< names of blades, first passage first, repeated round the
                                       ///< wheel; empty: as [[motion]] says
  std::optional<int> nodal_diameters;  ///< of the wave in which the blades move over time
  std::string where_diameters;
  std::vector<double> factors;  ///< on the displacement as WheelBlade::factor, repeated likewise; empty: 1
  std::string where;
};

/// [wheel]: how many passages, and which blade stands in which of them.
struct WheelCase {
  std::filesystem::path output;  ///< empty when the case file names none
  bool suffix_families = false;
  std::vector<WheelBlade> blades;
  std::vector<WheelRowCase> rows;
};

/// How much of the quality is measured. automatic: a verdict for meshes of more than a million cells, else all.
enum class QualityMode { automatic, full, fast };

/// [guard]: when the result counts as good.
struct GuardOptions : CellLimits {
  bool write_inverted = false;  ///< write a mesh with inverted cells all the same
  QualityMode quality = QualityMode::automatic;
  /// Try other recipes where the mesh falls short; not said: where cells of blocks are inverted.
  std::optional<bool> retry;
  bool smooth = false;  ///< move nodes where cells of blocks lost their shape
  bool freeze = false;  ///< what the guard does becomes a linear part of the plan
  /// Share of the largest displacement of a rule that may lead off slip surfaces before a morph falls short.
  double max_trim = 0.01;
  int steps = 4;  ///< most steps to try where elements of an unstructured mesh are inverted otherwise; 1: none
};

/// [output]: what comes with the coordinates.
struct OutputOptions {
  bool displacement = false;                    ///< displacement at the nodes, as a solution of the output mesh
  bool quality = false;                         ///< quality measures in the cells, as a solution of the output mesh
  std::optional<std::filesystem::path> report;  ///< JSON report
  std::optional<std::filesystem::path> page;    ///< the report as a page (HTML)
  std::optional<std::filesystem::path> vtk;     ///< the morphed mesh with these fields, for viewers
  /// Folder for what a morph goes through: the mesh after each stage of blocks; the wrap and the background mesh,
  /// before and after, of elements.
  std::optional<std::filesystem::path> stages;
};

/// One `field` rule, so that reports can say how far its nodes were from the points.
struct FieldUse {
  std::string where;  ///< "case.toml:14"
  std::shared_ptr<PointField const> field;
  std::shared_ptr<InverseField const> inverse =
      {};  ///< of the rule, where its displacement is taken back; with its first field
};

/// [parameters]: a number that expressions of the case file know by its name.
struct Parameter {
  std::string name;
  double value = 0;
  std::optional<std::array<double, 2>> range;  ///< lowest and highest
  std::string unit;                            ///< for people
};
using ParameterValues = std::map<std::string, double>;

/// [sequence]: meshes over time; or [sweep]: meshes of designs, whose steps are 1, 2, ... and which have no time.
struct SequenceOptions {
  int steps = 0;
  double period = 1;             ///< [time]
  double periods = 1;            ///< that the steps are spread over
  bool include_end = false;      ///< whether the last step is at the end of all periods, or a step short of it
  std::vector<double> times;     ///< of the steps, ascending; empty: spread evenly
  std::filesystem::path output;  ///< with "{step}" in its name: one file per step; without: one file with a series
  std::vector<std::string> parameters;       ///< of a sweep: their names
  std::vector<std::vector<double>> designs;  ///< of a sweep: per step the value of each

  [[nodiscard]] bool is_sweep() const { return !parameters.empty(); }
  /// How people call a step.
  [[nodiscard]] char const* step_word() const { return is_sweep() ? "design" : "step"; }
  /// Of a sweep.
  [[nodiscard]] ParameterValues values_at(int step) const {
    ParameterValues out;
    for (std::size_t p = 0; p < parameters.size(); ++p) out[parameters[p]] = designs[step][p];
    return out;
  }
  /// The periods passed at step 0 ... steps - 1.
  [[nodiscard]] double periods_at(int step) const {
    return times.empty() ? periods * step / (include_end && steps > 1 ? steps - 1 : steps) : times[step] / period;
  }
  [[nodiscard]] double time_at(int step) const {
    return is_sweep() ? step + 1 : times.empty() ? period * periods_at(step) : times[step];
  }
  [[nodiscard]] Moment moment(int step) const { return {periods_at(step), time_at(step), step + 1}; }
};

/// Most steps.
inline constexpr int largest_sequence = 99999;
/// Whether the output names one file per step.
bool one_file_per_step(SequenceOptions const& options);

/// [[clearance]]: how far the tips of blades are from a wall.
struct ClearanceCase {
  std::string name;
  std::vector<std::string> tips, walls;  ///< selectors of patches
  double rim = 1;                        ///< share of the height of `tips` that is tip: 1: all of it
  std::string where;
};

/// A rule `shock`: where the shock that its regions have goes to.
struct ShockFollow {
  std::size_t rule = 0;           ///< number in Motion::rules
  std::string to;                 ///< CGNS file with a mesh and the solution on it
  std::string solution;           ///< FlowSolution_t; empty: as SolutionWanted has it
  std::optional<Vec3> direction;  ///< absent: that of the gradient in the shock
  std::optional<double> smooth;   ///< radius of the means of ShockShift; absent: a tenth of the shock's extent
  std::string where;              ///< "case.toml:14"
};

/// [background] file: a background mesh of the user's.
struct BackgroundFile {
  std::filesystem::path path;
  /// Selectors of its patches.
  std::vector<std::string> wrap = std::vector<std::string>(1, "wrap"), outer = std::vector<std::string>(1, "outer");
};

/// A key that stands in a case file.
struct GivenKey {
  std::string table;  ///< "", "mesh", "mesh axis", "motion", "motion modes", ...
  std::string key;
  int line = 0;

  auto operator<=>(GivenKey const&) const = default;
};

struct CaseFile {
  std::filesystem::path source;  ///< the case file itself, as given
  std::filesystem::path input;   ///< relative paths are already joined with the directory of the case file
  std::filesystem::path output;  ///< empty when the case file names none
  std::optional<std::filesystem::path> side_file;  ///< patches and interfaces of the mesh (side_file.hpp)
  std::vector<std::string> leave_out;              ///< bases and zones of the file that are no part of the mesh
  std::optional<Axis> axis;                        ///< [mesh] axis as given; Motion::axis holds it too
  std::optional<bool> find_blocks;                 ///< [mesh] blocks as given: why_elements() says what holds
  Motion motion;
  std::vector<InnerRegion> measured_regions;  ///< [[region]] that rules do not move
  PlanOptions plan;
  std::optional<BackgroundFile> background;  ///< read and made part of `plan` by whoever morphs
  GuardOptions guard;
  OutputOptions output_options;
  std::vector<FieldUse> fields;
  std::vector<ClearanceCase> clearances;
  std::vector<ShockFollow> shock_follows;
  std::optional<WheelCase> wheel;           ///< [wheel], for `gridmorph wheel`
  std::vector<TimedRule> timed;             ///< per rule of `motion`
  std::optional<SequenceOptions> sequence;  ///< or a sweep
  std::vector<Parameter> parameters;        ///< by name
  /// The rules for other values of parameters, the others' as they stand; the file is read again, tables and targets
  /// that it names too. Throws ConfigError where a value is none that the rules can have.
  std::function<Motion(ParameterValues const& values)> motion_for;
  std::vector<std::filesystem::path> files;  ///< tables, targets, models, ... that its keys name and that are read
  std::vector<std::string> notes;            ///< what was taken that no key says
  std::vector<GivenKey>
      given;  ///< every key that was read, by table and line; what the mesh decides about (ignored_keys.hpp)
};

/// A rule at a moment, times a factor. Throws MotionError where its amplitude is not finite; `where`: of the rule.
Rule rule_at(TimedRule const& timed, std::string const& where, Moment const& when, double factor = 1);

/// The rules of the case file at a moment: those that change with time as they are then, all others as they stand; of a
/// sweep those of the design. Throws MotionError where an amplitude is not finite, ConfigError where a design cannot be
/// made.
Motion motion_at(CaseFile const& case_file, Moment const& when);

/// The rules with every amplitude times `share`: rigid motions turn by that share of their angle, targets are
/// approached by that share of the way.
Motion fraction_of(CaseFile const& case_file, double share);
/// Makes that the motion of the case file.
void take_fraction(CaseFile& case_file, double share);

/// A case file as it stands, parsed once: which mesh it names is asked before Kokkos runs, the rest after. Copies share
/// it.
class CaseDocument {
 public:
  /// Throws ConfigError for a file that cannot be read, and for one that is not TOML.
  explicit CaseDocument(std::filesystem::path const& path);
  /// From text; `path` names it in messages and anchors relative paths.
  CaseDocument(std::string const& text, std::filesystem::path path);

  [[nodiscard]] std::filesystem::path const& path() const { return path_; }
  /// The mesh that it names; nothing where it names none.
  [[nodiscard]] std::optional<std::filesystem::path> mesh() const;
  struct Root;
  [[nodiscard]] Root const& root() const { return *root_; }

 private:
  std::filesystem::path path_;
  std::shared_ptr<Root const> root_;
};

/// What a case file says, with the displacement files that it names. Throws one ConfigError that lists every problem,
/// each as "file:line: what, found, what to do". values: of parameters, in place of the file's. Cost: O(size of the
/// files), O(n log n) for point clouds.
CaseFile read_case_file(CaseDocument const& document, ParameterValues const& values = {});
inline CaseFile read_case_file(std::filesystem::path const& path, ParameterValues const& values = {}) {
  return read_case_file(CaseDocument(path), values);
}

/// As what the reader reads a key: "string", "number", "whole number", "true or false", "list of numbers", "[x, y, z]",
/// "string or list", "table", "list of tables"; the words that it chooses from.
struct KeyReading {
  std::set<std::string> as;
  std::vector<std::string> words;
};
/// (table, key) pairs that the reader asked for, tables as "mesh", "mesh axis", "motion": what it knows, for checks of
/// the docs.
using CaseKeyUse = std::map<std::pair<std::string, std::string>, KeyReading>;

/// The same from text (see CaseDocument). `asked`, when given, is filled also when there are problems.
CaseFile parse_case_file(std::string const& text, std::filesystem::path const& path, CaseKeyUse* asked = nullptr);

}  // namespace gridmorph
