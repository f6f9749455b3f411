// All of the library's core that a solver needs, in one header.
#pragma once

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/smoothing_record.hpp>
#include <gridmorph/guard/stepped_morph.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/point_ranges.hpp>
#include <gridmorph/morph/ffd_gradient.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/motion/bulbs.hpp>
#include <gridmorph/motion/height_table.hpp>
#include <gridmorph/motion/rigid_motion.hpp>
#include <gridmorph/quality/certificate.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>
#include <gridmorph/version.hpp>
