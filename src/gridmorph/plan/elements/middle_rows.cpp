#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/plan/elements/middle_rows.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace gridmorph::detail {

namespace {

/// Corners of the edge, face or element amid which the further node number k of element e is.
std::vector<Index32> corners_around(Mesh const& mesh, Index e, std::size_t k) {
  ElementType const type = mesh.elements.type[std::size_t(e)];
  auto const corners = mesh.elements.corners(e);
  int const edge = int(k - corners.size());
  if (edge < n_edges(type))
    return {corners[std::size_t(edge_corner(type, edge, 0))], corners[std::size_t(edge_corner(type, edge, 1))]};
  int square = edge - n_edges(type);
  if (!is_surface(type))
    for (int f = 0; f < n_faces(type); ++f) {
      if (n_face_corners(type, f) != 4 || square-- > 0) continue;
      std::array<Index32, max_face_corners> room;
      auto const face = side_nodes(mesh, e, f, room);
      return {face.begin(), face.end()};
    }
  return {corners.begin(), corners.end()};
}

class MiddleRows {
 public:
  MiddleRows(Mesh const& mesh, NodeGraph const& graph) : mesh_(mesh), graph_(graph) {}

  InterpolationOperator run() {
    for (Index e = 0; e < mesh_.n_elements(); ++e) {
      auto const all = mesh_.elements.nodes[e];
      for (std::size_t k = mesh_.elements.corners(e).size(); k < all.size(); ++k)
        if (graph_.carries(all[k]) && graph_.neighbours[all[k]].empty())
          uses_.push_back({all[k], Index32(e), Index32(k)});
    }
    std::sort(uses_.begin(), uses_.end());
    for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
      for (end = begin; end < uses_.size() && uses_[end][0] == uses_[begin][0]; ++end) {
      }
      add({uses_.data() + begin, end - begin});
    }
    return std::move(rows_);
  }

 private:
  using Use = std::array<Index32, 3>;  ///< node, element, place in the element

  [[nodiscard]] Index32 owner(Index32 n) const { return graph_.representative[std::size_t(n)]; }

  void add(std::span<Use const> uses) {
    Coordinates const& x = mesh_.coordinates;
    Index32 const node = uses[0][0];
    items_.clear();
    weights_.clear();
    Vec3 mean;
    auto const own = corners_around(mesh_, uses[0][1], std::size_t(uses[0][2]));
    double const share = 1.0 / double(own.size());
    double size = 0;
    for (Index32 const c : own) {
      mean += share * x[c];
      add_item(owner(c), share);
      size = std::max(size, distance(x[c], x[own[0]]));
    }
    Vec3 const c = x[node] - mean;
    constexpr double straight = 1e-9;  // of the edge
    if (norm(c) > straight * size) add_gradient(uses, c);
    rows_.add(node, items_, weights_);
  }

  void add_item(Index32 node, double weight) {
    auto const at = std::find(items_.begin(), items_.end(), node);
    if (at != items_.end()) {
      weights_[std::size_t(at - items_.begin())] += weight;
    } else {
      items_.push_back(node);
      weights_.push_back(weight);
    }
  }

  /// G c = sum over the corners p of (g . (p - p0)) u_p, with (sum of (p - p0)(p - p0)^T) g = c; only along what the
  /// corners span.
  void add_gradient(std::span<Use const> uses, Vec3 const& c) {
    Coordinates const& x = mesh_.coordinates;
    around_.clear();
    for (Use const& use : uses)
      for (Index32 const corner : mesh_.elements.corners(use[1])) around_.push_back(owner(corner));
    std::sort(around_.begin(), around_.end());
    around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    Vec3 centre;
    for (Index32 const p : around_) centre += (1.0 / double(around_.size())) * x[p];
    double moments[3][3] = {}, axis[3][3];
    for (Index32 const p : around_) {
      Vec3 const d = x[p] - centre;
      double const of[3] = {d.x, d.y, d.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) moments[i][j] += of[i] * of[j];
    }
    double const total = moments[0][0] + moments[1][1] + moments[2][2];
    kernels::diagonalise(moments, axis);
    Vec3 g;
    for (int k = 0; k < 3; ++k) {
      constexpr double flat = 1e-20;  // of the moments: 1e-10 of the lengths
      if (!(moments[k][k] > flat * total)) continue;
      Vec3 const a{axis[k][0], axis[k][1], axis[k][2]};
      g += (dot(a, c) / moments[k][k]) * a;
    }
    for (Index32 const p : around_) add_item(p, dot(g, x[p] - centre));
  }

  Mesh const& mesh_;
  NodeGraph const& graph_;
  InterpolationOperator rows_;
  std::vector<Use> uses_;
  std::vector<Index32> items_, around_;
  std::vector<double> weights_;
};

}  // namespace

InterpolationOperator middle_rows(Mesh const& mesh, NodeGraph const& graph) { return MiddleRows(mesh, graph).run(); }

}  // namespace gridmorph::detail
