#include <gridmorph/kernels/joint_slip.hpp>
#include <gridmorph/plan/given_slip.hpp>
#include <gridmorph/plan/plane_axes.hpp>

#include <utility>

namespace gridmorph {

std::vector<Vec3> put_back_given(UnstructuredPlan const& plan, Coordinates const& x, std::vector<Vec3> given) {
  JointSlip const& slip = plan.given_slip;
  std::vector<kernels::SlipSurfaceView> surfaces;
  for (SlipSurface const& s : plan.surfaces) surfaces.push_back(s.view());
  for (std::size_t k = 0; k < slip.of.size(); ++k) {
    auto const from = std::size_t(slip.first[k]);
    auto const surface = [&](int m) {
      std::size_t const at = from + std::size_t(m);
      std::int32_t const turned = slip.turned[at];
      return kernels::SurfaceOfImage(surfaces[std::size_t(slip.surface[at])], along_axes(plan.axes, x[slip.place[at]]),
                                     turned < 0 ? nullptr : &plan.rotations[std::size_t(turned)]);
    };
    Vec3& asked = given[std::size_t(slip.of[k])];
    Vec3 const own = along_axes(plan.axes, asked);
    Vec3 u = own, rate;
    kernels::constrain_to_all<false>(
        int(slip.first[k + 1] - slip.first[k]), surface, [&](int m) { return surface(m).own_offset(); }, Vec3{}, u,
        rate);
    if (norm(u - own) > plan.given_tolerance[k]) asked = back_from_axes(plan.axes, u);
  }
  return given;
}

}  // namespace gridmorph
