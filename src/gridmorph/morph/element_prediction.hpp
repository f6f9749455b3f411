// What a plan makes of elements, of some of them, before anything is smoothed: prediction.hpp for unstructured meshes.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class MorphPlan;
struct PreparedUnstructured;  ///< plan/unstructured_plan.hpp

struct ElementPredictionOptions {
  /// One element in so many, in the order of the mesh (along a Hilbert curve), is looked at; 1: all. 0: the smallest
  /// power of two that leaves at most 20,000.
  int every = 0;
  /// Those with the largest relative displacements that are looked at as well.
  Index most_strained = 20'000;
};

struct ElementValue {
  double value = 0;
  Index element = -1;
};

/// Worst elements among those looked at; polyhedra are not.
struct PredictedElements {
  Index elements = 0;
  Index inverted = 0;                    ///< a corner's Jacobian would be negative, and is not in the baseline
  ElementValue determinant{1};           ///< smallest 3x3x3
  double determinant_before = 1;         ///< of that element in the baseline
  ElementValue kept{1};                  ///< smallest share of its determinant that an element keeps, at most 1
  ElementValue angle_deg{180};           ///< smallest
  ElementValue relative_displacement{};  ///< largest of any element: Measure::relative_displacement
};

struct PredictedRegion {
  std::string name;  ///< "columns on walls", "near field", "partially wrapped", "far field"
  PredictedElements elements;
};

struct ElementPrediction {
  Index n_elements = 0;  ///< of the mesh
  int every = 1;         ///< ElementPredictionOptions::every, where it was 0 what was taken
  PredictedElements all;
  std::vector<PredictedRegion> regions;  ///< with elements looked at, that which keeps the smallest share first
};

/// Compares the displaced nodes of a plan with the baseline. Looked at are all elements between the end of a column and
/// what is beyond, those with the largest relative displacements, and one in `every`. Largest relative displacements
/// are those of all elements; of the elements looked at all measures are what Morpher::positions() makes, so that
/// others can come out worse, and what the guard then mends is not in it. displaced: all nodes; signs:
/// numbering_signs() of the mesh. Cost: one pass over the elements for their relative displacements (100 flops each),
/// two sets of measures for those looked at. The same for any number of threads. Fences.
ElementPrediction predict(HostInstance const& host, Mesh const& mesh, PreparedUnstructured const& prepared,
                          Coordinates const& displaced, std::span<signed char const> signs,
                          ElementPredictionOptions const& options = {});
/// plan: of elements.
ElementPrediction predict(HostInstance const& host, Mesh const& mesh, MorphPlan const& plan,
                          Coordinates const& displaced, std::span<signed char const> signs,
                          ElementPredictionOptions const& options = {});

}  // namespace gridmorph
