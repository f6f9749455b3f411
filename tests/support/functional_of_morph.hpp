// A function of a whole morph whose gradient is known at the nodes: what gradients of parameters are compared with.
#pragma once

#include "support/transpose_check.hpp"

#include <gridmorph/morph/morph.hpp>

#include <vector>

namespace gridmorph::test {

/// J = sum of w . x + |x|^2 / 2 of all nodes, as a function of the displacement of the boundary.
template <class Exec>
class FunctionalOfMorph {
 public:
  FunctionalOfMorph(MorphPlan const& plan, Coordinates const& baseline)
      : plan_(plan), morpher_(Exec(), plan, baseline, {.transpose = true}), n_nodes_(baseline.size()) {}

  [[nodiscard]] double of(Motion const& motion) const {
    Coordinates const x = positions(plan_.boundary_displacement(motion));
    double sum = 0;
    for (Index n = 0; n < x.size(); ++n) sum += dot(w + 0.5 * x[n], x[n]);
    return sum;
  }
  /// dJ/db where the rules of the plan have the boundary.
  [[nodiscard]] std::vector<Vec3> gradient() const {
    Coordinates dJ_dx = positions(plan_.boundary_displacement()), dJ_db(Index(plan_.boundary_nodes().size()));
    for (Index n = 0; n < dJ_dx.size(); ++n) dJ_dx.set(n, dJ_dx[n] + w);
    morpher_.transpose(Exec(), coordinates_of(plan_.boundary_displacement()), dJ_dx, dJ_db);
    Exec().fence();
    std::vector<Vec3> out;
    for (Index m = 0; m < dJ_db.size(); ++m) out.push_back(dJ_db[m]);
    return out;
  }

 private:
  static constexpr Vec3 w{1, -2, 0.5};

  [[nodiscard]] Coordinates positions(std::vector<Vec3> const& boundary) const {
    Coordinates x(n_nodes_);
    morpher_.positions(Exec(), coordinates_of(boundary), x);
    Exec().fence();
    return x;
  }

  MorphPlan const& plan_;
  Morpher<Exec> morpher_;
  Index n_nodes_;
};

}  // namespace gridmorph::test
