// The values that solvers fill in, made as their authors write them: inside templates, where g++ 12 ends with an
// internal error over default members that are braced lists of structs.
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/wrap.hpp>
#include <gridmorph/plan/options.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

template <class Exec>
struct Solver {
  PlanOptions member{};
  PlanOptions copied = PlanOptions{};
  PlanOptions unstructured{};

  [[nodiscard]] std::size_t rules(PlanOptions const& options = {}) const {
    return options.volume.priority.size() + PlanOptions{}.volume.priority.size() + PlanOptions().volume.priority.size();
  }
  [[nodiscard]] bool others() const {
    (void)Motion{};
    (void)MotionRule{};
    (void)Mesh{};
    (void)Mesh{};
    (void)Background{};
    (void)StepOptions{};
    return TopologyOptions{}.open_faces.empty() && BoundaryLayer{}.walls.empty() &&
           VolumeOptions{}.law == Law::linear && MorpherOptions{}.fields == 1 && RelaxOptions{}.signs.empty() &&
           WrapOptions{}.resolution > 0;
  }
};

TEST(Options, CanBeMadeWithTheirDefaultsInsideTemplates) {
  Solver<Kokkos::DefaultHostExecutionSpace> const solver;
  EXPECT_EQ(solver.rules(), 9U);
  EXPECT_TRUE(solver.others());
  EXPECT_EQ(PriorityRule{}.order, (std::vector<std::string>{"wall", "periodic", "inflow", "outflow"}));
  EXPECT_EQ(solver.copied.volume.priority[0].order, PriorityRule{}.order);
  EXPECT_TRUE(solver.copied.volume.priority[1].order.empty());
}

}  // namespace
}  // namespace gridmorph::test
