// All of the library's core that a solver needs, in one header.
#pragma once

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/mesh/deal_zones.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/gather_coordinates.hpp>
#include <gridmorph/mesh/point_ranges.hpp>
#include <gridmorph/morph/design_modes.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/morph/plan_share.hpp>
#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/motion/inflation_heights.hpp>
#include <gridmorph/motion/rigid_motion.hpp>
#include <gridmorph/quality/design_box.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>
#include <gridmorph/version.hpp>
