#include <gridmorph/motion/shock/shock_cells.hpp>

#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

using Values = std::vector<double>;

class FlowVariables {
 public:
  /// dimension: of the mesh.
  FlowVariables(FlowSolution const& solution, double heat_ratio, int dimension)
      : solution_(solution), gamma_(heat_ratio), plane_(dimension == 2) {}

  [[nodiscard]] Values pressure() const {
    if (auto const* p = solution_.find("Pressure")) return *p;
    if (!solution_.has({"Density", "EnergyStagnationDensity"}) || !(has_velocity() || has_momentum()))
      lacks("Pressure, or Density, EnergyStagnationDensity and the momentum");
    Values const &rho = *solution_.find("Density"), &energy = *solution_.find("EnergyStagnationDensity");
    auto const v = velocity();
    Values out(rho.size());
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n] = (gamma_ - 1) * (energy[n] - 0.5 * rho[n] * (v[0][n] * v[0][n] + v[1][n] * v[1][n] + v[2][n] * v[2][n]));
    return out;
  }

  /// The components of the velocity; the one that a solution in two dimensions lacks is zero.
  [[nodiscard]] std::array<Values, 3> velocity() const {
    std::array<Values, 3> out;
    bool const own = has_velocity();
    if (!own && !has_momentum())
      lacks("VelocityX, VelocityY, VelocityZ, or Density and MomentumX, MomentumY, MomentumZ");
    for (std::size_t c = 0; c < 3; ++c) {
      std::string const component = (own ? "Velocity" : "Momentum") + std::string(1, char('X' + int(c)));
      auto const* found = solution_.find(component);
      if (found == nullptr) continue;
      out[c] = *found;
      if (own) continue;
      Values const& rho = *solution_.find("Density");
      for (std::size_t n = 0; n < rho.size(); ++n) out[c][n] /= rho[n];
    }
    auto const size = std::max({out[0].size(), out[1].size(), out[2].size()});
    for (Values& of_axis : out) of_axis.resize(size, 0);
    return out;
  }

  [[nodiscard]] Values sound(Values const& p) const {
    if (auto const* a = solution_.find("VelocitySound")) return *a;
    auto const* rho = solution_.find("Density");
    if (rho == nullptr) lacks("VelocitySound, or Density, for the speed of sound");
    Values out(p.size());
    for (std::size_t n = 0; n < p.size(); ++n) out[n] = std::sqrt(std::max(0.0, gamma_ * p[n] / (*rho)[n]));
    return out;
  }

  [[nodiscard]] Values any(std::string const& name) const {
    if (name == "Pressure") return pressure();
    auto const* found = solution_.find(name);
    if (found == nullptr) lacks(name);
    return *found;
  }

 private:
  [[nodiscard]] bool has_velocity() const { return has_components("Velocity"); }
  [[nodiscard]] bool has_momentum() const { return solution_.has({"Density"}) && has_components("Momentum"); }
  /// Those along x and y; of a plane mesh, which may lie across any axis, any two.
  [[nodiscard]] bool has_components(std::string const& of) const {
    auto const has = [&](char axis) { return solution_.find(of + axis) != nullptr; };
    return (has('X') && has('Y')) || (plane_ && has('Z') && (has('X') || has('Y')));
  }

  [[noreturn]] void lacks(std::string const& what) const {
    throw MotionError(solution_.source + " has no " + what + "; it has " + quote_list(solution_.available) +
                      "; choose another variable or sensor, or another solution");
  }

  FlowSolution const& solution_;
  double gamma_;
  bool plane_;
};

/// The mean of the cells around each place; nodes of no cell: 0.
Values mean_at_nodes(CellCorners const& cells, Values const& of_cells) {
  auto const n = std::size_t(cells.n_nodes());
  Values sum(n, 0.0);
  std::vector<int> count(n, 0);
  cells.each([&](Index c, std::span<Index const> corners) {
    for (Index const corner : corners) {
      auto const one = std::size_t(cells.one(corner));
      sum[one] += of_cells[c];
      ++count[one];
    }
  });
  Values out(n, 0.0);
  for (std::size_t m = 0; m < n; ++m) {
    auto const one = std::size_t(cells.one(Index(m)));
    if (count[one] > 0) out[m] = sum[one] / count[one];
  }
  return out;
}

}  // namespace

CellCorners::CellCorners(Mesh const& mesh) : mesh_(mesh) {
  if (mesh.is_structured()) {
    n_ = mesh.n_cells();
    one_ = coincident_block_nodes(mesh);
  } else {
    n_ = mesh.n_elements();
    auto const one = nodes_at_one_place(mesh);
    one_.assign(one.begin(), one.end());
  }
}

std::vector<Index> CellCorners::one_across_periodic_sides() const {
  return nodes_joined_across_periodic_sides(mesh_, one_);
}

void CellCorners::each(std::function<void(Index, std::span<Index const>)> const& look) const {
  std::vector<Index> corners;
  if (!mesh_.is_structured()) {
    for (Index e = 0; e < n_; ++e) {
      auto const of = mesh_.elements.corners(e);
      corners.assign(of.begin(), of.end());
      look(e, corners);
    }
    return;
  }
  Index c = 0;
  corners.resize(8);
  for (Zone const& zone : mesh_.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i) {
          for (int n = 0; n < 8; ++n) corners[n] = zone.node({i + (n & 1), j + (n >> 1 & 1), k + (n >> 2)});
          look(c++, corners);
        }
}

FlowAtNodes flow_at_nodes(CellCorners const& cells, FlowSolution const& solution, ShockSearch const& search) {
  FlowVariables const variables(solution, search.heat_ratio, cells.dimension());
  auto const at_nodes = [&](Values values) {
    return solution.at_nodes ? std::move(values) : mean_at_nodes(cells, values);
  };
  FlowAtNodes out;
  if (search.sensor == ShockSearch::Sensor::jump) {
    out.variable = at_nodes(variables.any(search.variable));
    return out;
  }
  Values p = variables.pressure();
  auto velocity = variables.velocity();
  out.sound = at_nodes(variables.sound(p));
  for (std::size_t c = 0; c < 3; ++c) out.velocity[c] = at_nodes(std::move(velocity[c]));
  out.variable = at_nodes(std::move(p));
  return out;
}

}  // namespace gridmorph
