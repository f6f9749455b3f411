// Distance from boundary faces, exact: a function of position alone, however faces and nodes are numbered.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace gridmorph {

/// The distance from a set of edges (2-D), triangles, and polygons as triangles around the mean of their corners.
/// Making it: O(n log n); host.
class FacetDistance {
 public:
  /// faces: lists of nodes, in their order around each face.
  FacetDistance(Coordinates const& coordinates, CsrGraph const& faces);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  /// Infinite where there are no faces. start: any number from an earlier call, left for the next; the closer its place
  /// was, the faster: about O(log faces) where places follow one another.
  [[nodiscard]] double operator()(Vec3 const& p, int& start) const;
  /// No more than the distance, at once: that from the box around all faces.
  [[nodiscard]] double at_least(Vec3 const& p) const;

 private:
  using Triangle = std::array<Vec3, 3>;
  /// A box along the principal axes of its facets. Far off, patches that lie aslant are nearer than their boxes along
  /// the coordinate axes by so much that most of these would have to be opened.
  struct TiltedBox {
    Vec3 centre;
    std::array<Vec3, 3> axis;
    std::array<double, 3> low, high;
    /// Here, where it is inlined: most of a search is this.
    [[nodiscard]] double distance2(Vec3 const& p) const {
      Vec3 const d = p - centre;
      double sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        double const at = dot(axis[a], d), outside = std::max({low[a] - at, at - high[a], 0.0});
        sum += outside * outside;
      }
      // By less than the rounding of what lies beyond.
      return (1 - 1e-12) * sum;
    }
  };
  [[nodiscard]] TiltedBox tilted(int begin, int end) const;
  [[nodiscard]] static double squared(Triangle const& t, Vec3 const& p);

  std::vector<Triangle> triangles_;
  FacetBoxes boxes_;
  std::vector<TiltedBox> tilted_;  ///< of boxes_
};

}  // namespace gridmorph
