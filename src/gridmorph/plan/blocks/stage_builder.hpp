// Compiles chains into the flat tables of a stage.
#pragma once

#include <gridmorph/plan/blocks/chain_tables.hpp>

#include <vector>

namespace gridmorph {

/// How displacement varies along the lines of a chain.
struct ChainLaw {
  kernels::LineLaw law;
  std::array<double, 2> slope;  ///< of LineLaw::cubic
  std::array<std::int32_t, 2> knots =
      {};  ///< of LineLaw::table: where they start in Plan::law_knots, intervals between them

  ChainLaw(kernels::LineLaw l = kernels::LineLaw::linear, std::array<double, 2> const& s = {1, 1}) : law(l), slope(s) {}
  /// Whether it may differ from one end to the other.
  [[nodiscard]] bool is_directed() const {
    return law == kernels::LineLaw::table || (law == kernels::LineLaw::cubic && slope[0] != slope[1]);
  }
  friend bool operator==(ChainLaw const&, ChainLaw const&) = default;
};

struct StageChain {
  Chain chain;
  ChainLaw law;
  bool open_end = false;                           ///< carry the first end's displacement to the last end
  kernels::TurnLaw turn = kernels::TurnLaw::none;  ///< how rotations of its ends fade, where they carry any
  double turn_reach = 0;                           ///< TurnLaw::far: length of lines over the size of bodies
};

/// Tables of all chains; entities not known yet are written by the first chain that holds them. Marks them known with
/// the chain's better end kind (as `kind_order` decides). Sides that are known get the transfinite correction.
Stage build_stage(PlanContext const& context, std::vector<StageChain> const& chains, Known& known,
                  std::vector<std::string> const& kind_order);

/// How far given displacements may take nodes off a surface before they are put back: 1e-10 of the mesh size, or twice
/// as far as nodes of the baseline scatter about it, up to 1e-6 of its size.
double given_tolerance(SlipSurface const& surface, double mesh_size);

/// Redistribution chains, all with one law: every entity of the chains is written once, known or not. `given` are the
/// entities whose displacement the motion rules give: they are honoured exactly while they stay within
/// given_tolerance() of their slip surfaces, and trimmed to them beyond that. Uses mesh_size and surfaces of `plan`.
SpreadPass build_spread(PlanContext const& context, std::vector<Chain> const& chains, kernels::LineLaw law,
                        std::vector<int> const& surface_of_patch, Known const& given, Plan const& plan);

/// Position of a kind in the priority's order, negative for patches that it names; kinds that are not listed come after
/// all that are.
int kind_rank(EndKind kind, std::vector<std::string> const& order);

}  // namespace gridmorph
