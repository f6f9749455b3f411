// Drawings of a plan of blocks: its blocks in the chains that move them, in their order, and what joins them.
#pragma once

#include <gridmorph/plan/block_graph.hpp>

#include <string>
#include <string_view>

namespace gridmorph {

/// The colour of chains of a stage, "#rrggbb"; after eight they come again.
std::string_view stage_colour(std::size_t stage);

/// A graph for the dot program of Graphviz: a cluster per chain, coloured by stage, blocks as nodes, arrows along
/// chains, lines for interfaces (dashed where they are periodic).
std::string dot_text(BlockGraph const& graph);

/// The same as a picture (SVG 1.1) that needs no other program: a row of chains per stage, from top to bottom as they
/// follow one another; what a block or a chain is in full stands where a pointer rests on it.
std::string svg_text(BlockGraph const& graph);

}  // namespace gridmorph
