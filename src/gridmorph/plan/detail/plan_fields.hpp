// The fields of a plan, in the order of the plan file. To change them is to change plan_format_version.
#pragma once

#include <gridmorph/plan/detail/archive.hpp>
#include <gridmorph/plan/plan.hpp>

namespace gridmorph::detail {

GRIDMORPH_DETAIL_FIELDS(Vec3, x, y, z)
GRIDMORPH_DETAIL_FIELDS(Mat3, m)
GRIDMORPH_DETAIL_FIELDS(IndexRange, begin, end)
GRIDMORPH_DETAIL_FIELDS(CellBox, zone, cells)

GRIDMORPH_DETAIL_FIELDS(kernels::Chain, n_s, n_a, n_b, law, open_end, first_side, first_junction, n_blocks, known_sides,
                        first_end_value, first_section)
GRIDMORPH_DETAIL_FIELDS(kernels::Tube, chain, a_begin, b_begin, n_a, n_b, first_segment, n_segments)
GRIDMORPH_DETAIL_FIELDS(kernels::Segment, first, stride_s, stride_a, stride_b, count, begin, target)
GRIDMORPH_DETAIL_FIELDS(kernels::ParameterTarget, first, stride_s, stride_a, stride_b)
GRIDMORPH_DETAIL_FIELDS(kernels::NodeCopy, source, source_stride_p, source_stride_q, destination, destination_stride_p,
                        destination_stride_q, n_p, n_q, matrix)
GRIDMORPH_DETAIL_FIELDS(kernels::SkeletonSweep, chain, matrix, n_p, n_q, slot, slot_q, t, t_p, t_q, s, a, b)
GRIDMORPH_DETAIL_FIELDS(kernels::SlipEnd, node, slot, value, to_node, to_chain, surface, tolerance)
GRIDMORPH_DETAIL_FIELDS(kernels::VolumeBox, first, stride_j, stride_k, n, first_term, n_terms)
GRIDMORPH_DETAIL_FIELDS(kernels::VolumeTerm, chain, matrix, t, end_value, end_stride, s, a, b)
GRIDMORPH_DETAIL_FIELDS(kernels::Side, chain, n_w, first)
GRIDMORPH_DETAIL_FIELDS(kernels::Junction, position, known_across, known_along)
GRIDMORPH_DETAIL_FIELDS(kernels::SideLine, side, w)

GRIDMORPH_DETAIL_FIELDS(LineTables, chains, tubes, segments, targets, n_parameters, n_end_values)
GRIDMORPH_DETAIL_FIELDS(VolumePart, box, term)
GRIDMORPH_DETAIL_FIELDS(SideTables, sides, junctions, lines, corrected, gathers, t, section)
GRIDMORPH_DETAIL_FIELDS(Stage, lines, sides, ends, sweeps, volume, cells, name, description)
GRIDMORPH_DETAIL_FIELDS(SpreadPass, lines, ends, sweeps, volume, description)
GRIDMORPH_DETAIL_FIELDS(ProfileKnot, axial, radius, slope, curvature)
GRIDMORPH_DETAIL_FIELDS(RevolutionProfile, knots, bucket_piece, deviation)
GRIDMORPH_DETAIL_FIELDS(MeridionalFrame, cosine, sine)
GRIDMORPH_DETAIL_FIELDS(Facet, corner, normal, bend, neighbour, creases)
GRIDMORPH_DETAIL_FIELDS(FacetBox, low, high, first, count)
GRIDMORPH_DETAIL_FIELDS(FacetSurface, points, normals, bends, facets, boxes)
GRIDMORPH_DETAIL_FIELDS(SlipSurface, kind, origin, direction, profile, baseline_deviation, size, frame, facets)
GRIDMORPH_DETAIL_FIELDS(Plan, boundary_nodes, boundary_slots, boundary_projections, stages, spreads, skeleton_nodes,
                        boxes, surfaces, rotations, near_field, notes, n_nodes, n_slots, mesh_size)

}  // namespace gridmorph::detail
