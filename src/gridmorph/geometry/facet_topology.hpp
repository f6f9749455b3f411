// Facets put in order: coincident points are one, edges know their facets, neighbours run around alike.
#pragma once

#include <gridmorph/geometry/facet_surface.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// An edge of the surface; which of its facets comes first has no meaning.
struct FacetEdge {
  std::array<int, 2> point;  ///< the lower number first
  std::array<int, 2> facet;  ///< [1] = -1 at a rim; both -1 where more than two facets meet
  std::array<int, 2> place;  ///< the edge's number in each facet
  bool crease = false;
  /// The surface ends or bends here: rim, crease, or more than two facets.
  [[nodiscard]] bool special() const { return crease || facet[1] < 0; }
};

struct FacetTopology {
  std::vector<Vec3> points;  ///< in lexicographic order
  std::vector<std::array<int, 4>> facets;
  std::vector<int> source;                         ///< per facet its number in the list
  std::vector<std::array<int, 4>> edges_of_facet;  ///< edge q runs from corner q to the next
  std::vector<FacetEdge> edges;
  std::vector<std::vector<int>> edges_of_point, facets_of_point;

  FacetTopology(FacetList const& list, FacetOptions const& options);

  [[nodiscard]] int n_corners(int facet) const { return facets[facet][3] < 0 ? 3 : 4; }
  /// The end of an edge that is not `point`.
  [[nodiscard]] int other_end(int edge, int point) const {
    return edges[edge].point[0] == point ? edges[edge].point[1] : edges[edge].point[0];
  }
  /// Unscaled normal of the flat facet.
  [[nodiscard]] Vec3 area(int facet) const;

 private:
  void weld(FacetList const& list, double relative);
  void find_edges();
  void orient();
  void find_creases(double angle_rad);
};

}  // namespace gridmorph
