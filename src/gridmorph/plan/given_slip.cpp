#include <gridmorph/kernels/joint_slip.hpp>
#include <gridmorph/plan/given_slip.hpp>
#include <gridmorph/plan/plane_axes.hpp>

#include <utility>

namespace gridmorph {

std::vector<Vec3> put_back_given(UnstructuredPlan const& plan, Coordinates const& x, std::vector<Vec3> given) {
  JointSlip const& slip = plan.given_slip;
  std::vector<kernels::SlipSurfaceView> surfaces;
  for (SlipSurface const& s : plan.surfaces) surfaces.push_back(s.view());
  std::vector<kernels::SurfaceOfImage> images;
  std::vector<double> own_offsets;
  for (std::size_t k = 0; k < slip.of.size(); ++k) {
    images.clear();
    own_offsets.clear();
    for (auto at = std::size_t(slip.first[k]); at < std::size_t(slip.first[k + 1]); ++at) {
      std::int32_t const turned = slip.turned[at];
      images.emplace_back(surfaces[slip.surface[at]], along_axes(plan.axes, x[slip.place[at]]),
                          turned < 0 ? nullptr : &plan.rotations[turned]);
      own_offsets.push_back(images.back().own_offset());
    }
    Vec3& asked = given[slip.of[k]];
    Vec3 const own = along_axes(plan.axes, asked);
    Vec3 u = own, rate;
    kernels::constrain_to_all<false>(int(images.size()), kernels::Listed<kernels::SurfaceOfImage>{images.data()},
                                     kernels::Listed<double>{own_offsets.data()}, Vec3{}, u, rate);
    if (norm(u - own) > plan.given_tolerance[k]) asked = back_from_axes(plan.axes, u);
  }
  return given;
}

}  // namespace gridmorph
