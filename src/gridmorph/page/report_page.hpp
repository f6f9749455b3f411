// One page that says what came of a morph: verdict, what moved, plan, quality, sections, timings, and what it takes to
// repeat it.
//
// The page stands by itself: pictures are in it, it asks for nothing from elsewhere, and a policy in its head keeps it
// so. Numbers are those of the JSON report, which is a part of what it is made from.
#pragma once

#include <gridmorph/page/picture_mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::page {

/// How many cells have which value of a measure, baseline and morphed.
struct Histogram {
  Measure measure = Measure::determinant_3x3x3;
  std::vector<double> edge;  ///< (bins + 1), ascending; what lies outside is in the first or the last bin
  std::vector<Index> before,
      after;  ///< (bins) of cells that were looked at; values that are no number are where the worst ones are
  std::string title;
};

/// Edges that suit a measure: determinants and angles evenly, aspect ratios evenly on a logarithmic scale up to
/// `largest`.
std::vector<double> histogram_edges(Measure measure, double largest);

/// Values of cells counted, [0] of those that are not `in` and [1] of those that are, with the same edges. Cost
/// O(values).
std::array<Histogram, 2> histograms(Measure measure, std::vector<double> const& before,
                                    std::vector<double> const& after, std::vector<char> const& in);

/// An SVG that takes its colours from the page: bars of the baseline behind, those of the morphed mesh as a line.
/// Heights are logarithmic: one bad cell among a million is to be seen.
std::string histogram_svg(Histogram const& histogram);

/// One cell and those around it, in a parallel view.
struct CellDrawing {
  std::string baseline, morphed;  ///< SVG that takes its colours from the page
  double stretch = 1;             ///< of the shortest direction of the cell against its longest; 1: true to scale
};

/// Both from one direction and to one scale. A thin cell is stretched along its principal axes, by one linear map for
/// both drawings: that keeps the sign of every Jacobian and all ratios of determinants, not angles. Cost: cells around
/// this one.
CellDrawing draw_cell(PictureMesh const& mesh, Index cell, Coordinates const& baseline, Coordinates const& morphed);

/// What one rule moved.
struct RuleRow {
  std::string rule, patches;
  std::string where;  ///< "case.toml:14"; "default"
  Index nodes = 0;
  double largest = 0, mean = 0;  ///< displacement
};

/// What must hold beside the quality of cells.
struct BoundaryCheck {
  Index periodic_nodes = 0;  ///< of periodic connections; 0: none
  double periodic =
      0;  ///< largest difference between the displacements of a node and of its copy, turned into its frame
  Index slip_nodes = 0;
  double slip = 0;  ///< largest distance of a node of slip surfaces from where its surface has it
};

struct WorstCell {
  CellName name;
  std::string reason;  ///< "smallest determinant, near field"
  Vec3 centre;         ///< morphed
  kernels::CellMeasures before, after;
  std::optional<CellDrawing> drawing;
};

struct Figure {
  std::string body;  ///< HTML
  std::string caption;
};

/// Pictures that belong together, side by side where there is room.
struct FigureGroup {
  std::string title;
  std::vector<Figure> figures;
};

struct StepFigure {
  int step = 0;  ///< from 1 on
  std::string body;
};

struct ReportPage {
  nlohmann::json
      report;  ///< as --report writes it; of wheels with those of the worst passage as "morphed" and "clearances"
  bool structured = true;
  std::string kind;  ///< "cells" or "elements"
  double mesh_size = 0, largest_displacement = 0;
  std::string mesh_summary;  ///< "3-D, 5 zones of blocks, 200000 nodes, ..."
  std::vector<RuleRow> rules;
  BoundaryCheck check;
  std::vector<Figure> surfaces;
  double scale_end = 0;  ///< displacement at the end of the scale of colours
  nlohmann::json plan;   ///< AnyPlan::json()
  std::string graph;     ///< SVG; empty: none
  std::vector<Histogram> near_histograms, far_histograms;
  std::string histogram_note;
  std::vector<WorstCell> worst;
  std::vector<FigureGroup> sections;
  std::vector<StepFigure> steps;
  std::vector<std::pair<std::string, std::string>> settings;  ///< versions, machine, input
  std::string command_line, case_text;
};

/// The page. Cost: its length.
std::string page_text(ReportPage const& page);

}  // namespace gridmorph::page
