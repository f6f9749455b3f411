// A standing normal shock of an ideal gas, spread by a tanh profile: what the shock tests look for.
#pragma once

#include <gridmorph/mesh/flow_solution.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::test {

struct NormalShock {
  Vec3 through{1, 0.5, 0.6};
  Vec3 normal{1, 0, 0};  ///< downstream, length 1
  double width = 0.1;    ///< of tanh
  double mach = 1.5;

  static constexpr double gamma = 1.4;

  [[nodiscard]] double ahead(Vec3 const& x) const { return dot(x - through, normal); }
  [[nodiscard]] double share(double s) const { return 0.5 * (1 + std::tanh(s / width)); }
  [[nodiscard]] double pressure(double s) const { return 1 + share(s) * 2 * gamma / (gamma + 1) * (mach * mach - 1); }
  [[nodiscard]] double density(double s) const {
    double const behind = (gamma + 1) * mach * mach / ((gamma - 1) * mach * mach + 2);
    return 1 + share(s) * (behind - 1);
  }
  /// Along the normal.
  [[nodiscard]] double speed(double s) const {
    double const before = mach * std::sqrt(gamma), behind = (gamma + 1) * mach * mach / ((gamma - 1) * mach * mach + 2);
    return before + share(s) * (before / behind - before);
  }
};

/// Corner nodes of every cell, blocks zone after zone, i fastest.
inline std::vector<std::vector<Index>> corners_of_cells(Mesh const& mesh) {
  std::vector<std::vector<Index>> out;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    out.emplace_back(corners.begin(), corners.end());
  }
  if (!out.empty()) return out;
  for (Zone const& zone : mesh.zones)
    for (int k = 1; k < zone.extent[2]; ++k)
      for (int j = 1; j < zone.extent[1]; ++j)
        for (int i = 1; i < zone.extent[0]; ++i) {
          auto& corners = out.emplace_back();
          for (int c = k - 1; c <= k; ++c)
            for (int b = j - 1; b <= j; ++b)
              for (int a = i - 1; a <= i; ++a) corners.push_back(zone.node({a, b, c}));
        }
  return out;
}

/// At the nodes, or at the middles of the cells.
inline FlowSolution solution_of(Mesh const& mesh, NormalShock const& shock, bool at_nodes = true) {
  FlowSolution out;
  out.source = "made";
  out.at_nodes = at_nodes;
  auto const add = [&](Vec3 const& x) {
    double const s = shock.ahead(x);
    Vec3 const v = shock.speed(s) * shock.normal;
    for (auto const& [name, value] :
         {std::pair("Pressure", shock.pressure(s)), std::pair("Density", shock.density(s)), std::pair("VelocityX", v.x),
          std::pair("VelocityY", v.y), std::pair("VelocityZ", v.z)})
      out.values[name].push_back(value);
  };
  if (at_nodes)
    for (Index n = 0; n < mesh.n_nodes(); ++n) add(mesh.coordinates[n]);
  else
    for (auto const& corners : corners_of_cells(mesh)) {
      Vec3 sum;
      for (Index const n : corners) sum += mesh.coordinates[n];
      add((1.0 / double(corners.size())) * sum);
    }
  for (auto const& [name, values] : out.values) out.available.push_back(name);
  return out;
}

}  // namespace gridmorph::test
