// Motions that tear periodic copies apart, on blocks and on hexahedra: what is wrong, and what would fit.
#include "support/expect_error.hpp"
#include "support/motions.hpp"
#include "support/unstructured_case.hpp"

#include <generators/passage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace gridmorph::test {
namespace {

class TornPassage : public ::testing::TestWithParam<bool> {
 protected:
  /// What is said of a rule of the hub; nothing where it is taken.
  [[nodiscard]] static std::string said_of(Rule hub) {
    PassageOptions options;
    options.nodes = 10'000;
    options.blades = 24;
    Mesh const mesh = make_passage(options);
    Motion m = motion({rule({"hub"}, std::move(hub)), rule({"blade", "type:periodic", "inlet", "outlet"}, FreeRule{}),
                       rule({"case"}, FixedRule{})});
    m.axis = Axis{{0, 0, 0}, {1, 0, 0}};
    try {
      if (GetParam())
        (void)UnstructuredCase(as_hexahedra(mesh)).morph(m);
      else
        (void)prepare(HostInstance(), mesh, m, {}).boundary_displacement();
    } catch (MotionError const& e) {
      return e.what();
    }
    return {};
  }
  static Rule waves(int count) {
    return function_rule([count](Vec3 const& p) {
      double const r = std::hypot(p.y, p.z), height = 1e-4 * std::cos(count * std::atan2(p.z, p.y));
      return (height / r) * Vec3{0, p.y, p.z};
    });
  }
};
INSTANTIATE_TEST_SUITE_P(Meshes, TornPassage, ::testing::Values(false, true),
                         [](auto const& info) { return info.param ? "Hexahedra" : "Blocks"; });

TEST_P(TornPassage, WavesThatDoNotFitThePitchComeWithTheNumberThatDoes) {
  expect_all_in(said_of(waves(23)), {"'hub'", "periodic copies", "15 degrees", "cos(24 * theta)"});
  for (int const fits : {24, 48}) EXPECT_EQ(said_of(waves(fits)), "") << fits;
}

TEST_P(TornPassage, MotionsInSpaceAreToldFromThoseThatTurnWithThePitch) {
  expect_all_in(said_of(RigidRule{{}, {0, 1e-4, 0}}), {"(rigid)", "'hub'", "periodic copies", "sections", "dtheta"});
  EXPECT_EQ(said_of(RigidRule{rotation_matrix({1, 0, 0}, 1e-3), {}}), "");
}

}  // namespace
}  // namespace gridmorph::test
