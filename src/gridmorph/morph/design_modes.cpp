#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/design_modes.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

/// More than this share of the mesh's size beside the sum is no rounding.
constexpr double most_deviation = 1e-9;

class Designs {
 public:
  Designs(MorphPlan const& plan, Coordinates const& baseline, ParametricMotion const& motion,
          std::span<double const> low, std::span<double const> high)
      : plan_(plan),
        motion_(motion),
        morpher_({}, plan, baseline),
        size_(norm(extent_of({}, baseline).high - extent_of({}, baseline).low)) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      middle_.push_back(0.5 * (low[i] + high[i]));
      half_.push_back(0.5 * (high[i] - low[i]));
    }
  }

  DesignModes modes() {
    std::size_t const n = middle_.size();
    out_.centre = at(std::vector<double>(n, 0));
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double> t(n, 0);
      t[i] = 1;
      Coordinates const above = at(t);
      t[i] = -1;
      Coordinates mode = at(t);
      for (Index node = 0; node < mode.size(); ++node) mode.set(node, 0.5 * (above[node] - mode[node]));
      out_.modes.push_back(std::move(mode));
      t[i] = 1;
      compare(t, above);
    }
    return std::move(out_);
  }
  void look_at_corners(DesignModes& designs, int corners) {
    out_ = std::move(designs);
    std::mt19937_64 random(1);
    for (int k = 0; k < corners && out_.modes.size() > 1; ++k) {
      std::vector<double> t;
      for (std::size_t i = 0; i < out_.modes.size(); ++i) t.push_back((random() >> 40 & 1) != 0 ? 1 : -1);
      compare(t, at(t));
    }
    designs = std::move(out_);
  }

 private:
  Coordinates at(std::vector<double> const& t) const {
    std::vector<double> p = middle_;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += t[i] * half_[i];
    Coordinates x(plan_.n_nodes());
    apply_on_host(morpher_, plan_.boundary_displacement(motion_(p)), x);
    return x;
  }

  /// How far a mesh is beside the sum.
  void compare(std::vector<double> const& t, Coordinates const& x) {
    double worst = 0;
    Index where = -1;
    for (Index n = 0; n < x.size(); ++n) {
      Vec3 sum = out_.centre[n];
      for (std::size_t i = 0; i < out_.modes.size(); ++i)
        if (t[i] != 0) sum += t[i] * out_.modes[i][n];
      double const off = distance(sum, x[n]);
      if (off > worst || !(off == off)) {
        worst = off;
        where = n;
      }
    }
    if (!(worst <= most_deviation * size_)) refuse(t, x, worst, where);
    out_.deviation = std::max(out_.deviation, worst);
  }

  [[noreturn]] void refuse(std::vector<double> const& t, Coordinates const& x, double off, Index node) const {
    auto const changed = std::count_if(t.begin(), t.end(), [](double v) { return v != 0; });
    auto const first = std::find_if(t.begin(), t.end(), [](double v) { return v != 0; }) - t.begin();
    std::string const which = changed == 1 ? "in parameter " + std::to_string(first + 1) : "in all parameters together";
    throw ConfigError("gridmorph::design_modes: meshes are not linear " + which + ": node " + std::to_string(node + 1) +
                      " lies " + to_text(off, 3) + " beside the sum of its displacements, at " + to_text(x[node], 6) +
                      "; a box of designs has bounds where they are: near fields with mode = \"translate\", rules that "
                      "are linear in their parameters (shifts, formulas; no rotations), slip on planes");
  }

  MorphPlan const& plan_;
  ParametricMotion const& motion_;
  Morpher<Kokkos::DefaultHostExecutionSpace> morpher_;
  double size_;
  std::vector<double> middle_, half_;
  DesignModes out_;
};

}  // namespace

DesignModes design_modes(MorphPlan const& plan, Coordinates const& baseline, ParametricMotion const& motion,
                         std::span<double const> low, std::span<double const> high, int corners) {
  std::string const who = "gridmorph::design_modes: ";
  if (low.size() != high.size())
    throw ConfigError(who + std::to_string(low.size()) + " lowest and " + std::to_string(high.size()) +
                      " highest values; give one of each for every parameter");
  for (std::size_t i = 0; i < low.size(); ++i)
    if (!(low[i] <= high[i]))
      throw ConfigError(who + "parameter " + std::to_string(i + 1) + " goes from " + to_text(low[i], 9) + " to " +
                        to_text(high[i], 9) + "; give the lowest value first");
  Designs designs(plan, baseline, motion, low, high);
  DesignModes out = designs.modes();
  designs.look_at_corners(out, corners);
  return out;
}

}  // namespace gridmorph
