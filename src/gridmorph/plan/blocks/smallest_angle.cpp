#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gridmorph {
namespace {

/// Unit vectors along one row of nodes, zero where there is no edge or one of no length. The angle between such an edge
/// and another then counts as 90 degrees, which is more than the smallest angle of any face.
class Row {
 public:
  explicit Row(int n) : n_(std::size_t(n)), values_(3 * n_) {}
  [[nodiscard]] double* x() { return values_.data(); }
  [[nodiscard]] double* y() { return values_.data() + n_; }
  [[nodiscard]] double* z() { return values_.data() + 2 * n_; }
  [[nodiscard]] double const* x() const { return values_.data(); }
  [[nodiscard]] double const* y() const { return values_.data() + n_; }
  [[nodiscard]] double const* z() const { return values_.data() + 2 * n_; }
  void clear() { std::fill(values_.begin(), values_.end(), 0.0); }

 private:
  std::size_t n_;
  std::vector<double> values_;
};

/// Unit vectors from points i to i + stride, for i < n.
void find_edges(double const* KOKKOS_RESTRICT x, double const* KOKKOS_RESTRICT y, double const* KOKKOS_RESTRICT z,
                Index stride, int n, double* KOKKOS_RESTRICT ex, double* KOKKOS_RESTRICT ey,
                double* KOKKOS_RESTRICT ez) {
  constexpr double least = 1e-300;  // lost in the square of any length but zero, and zero times its inverse stays zero
  for (int i = 0; i < n; ++i) {
    double const dx = x[i + stride] - x[i], dy = y[i + stride] - y[i], dz = z[i + stride] - z[i];
    double const scale = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + least);
    ex[i] = scale * dx;
    ey[i] = scale * dy;
    ez[i] = scale * dz;
  }
}

/// The edges from node first + i to the one `stride` further, for i < n, put at `at` + i of the row.
void find_edges(Coordinates const& c, Index first, Index stride, int n, Row& edge, int at = 0) {
  find_edges(c.x.data() + first, c.y.data() + first, c.z.data() + first, stride, n, edge.x() + at, edge.y() + at,
             edge.z() + at);
}

/// Keeps in largest[i] the largest cosine of four angles at node i: between the edges of two directions that leave it
/// forwards (at `fa`, `fb`) and backwards (arriving edges `ba`, `bb`, pointing forwards too).
void compare(Row const& fa, int fa_at, Row const& ba, int ba_at, Row const& fb, Row const& bb, int n,
             double* KOKKOS_RESTRICT largest) {
  double const *const ax = fa.x() + fa_at, *const ay = fa.y() + fa_at, *const az = fa.z() + fa_at;
  double const *const cx = ba.x() + ba_at, *const cy = ba.y() + ba_at, *const cz = ba.z() + ba_at;
  double const *const bx = fb.x(), *const by = fb.y(), *const bz = fb.z();
  double const *const dx = bb.x(), *const dy = bb.y(), *const dz = bb.z();
  for (int i = 0; i < n; ++i) {
    double const both_forward = ax[i] * bx[i] + ay[i] * by[i] + az[i] * bz[i];
    double const both_backward = cx[i] * dx[i] + cy[i] * dy[i] + cz[i] * dz[i];
    double const forward_backward = -(ax[i] * dx[i] + ay[i] * dy[i] + az[i] * dz[i]);
    double const backward_forward = -(cx[i] * bx[i] + cy[i] * by[i] + cz[i] * bz[i]);
    double const p = both_forward > both_backward ? both_forward : both_backward;
    double const q = forward_backward > backward_forward ? forward_backward : backward_forward;
    double const most = p > q ? p : q;
    largest[i] = most > largest[i] ? most : largest[i];
  }
}

/// The largest cosine in one plane of constant k of a box.
double largest_cosine(Mesh const& mesh, NodeBox const& box, int k) {
  Zone const& zone = mesh.zones[box.zone];
  IndexRange const& r = box.nodes;
  auto const stride = zone.strides();
  int const n = r.extent(0);
  // Along i the edge that leaves node i backwards is that of node i - 1: one row, with a zero before and after.
  Row along_i(n + 1), next_j(n), previous_j(n), next_k(n), previous_k(n);
  std::vector<double> largest(n, 0.0);
  for (int j = r.begin[1]; j < r.end[1]; ++j) {
    Index const first = zone.node({r.begin[0], j, k});
    Coordinates const& c = mesh.coordinates;
    find_edges(c, first, stride[0], n - 1, along_i, 1);
    std::swap(previous_j, next_j);
    if (j + 1 < r.end[1])
      find_edges(c, first, stride[1], n, next_j);
    else
      next_j.clear();
    if (k + 1 < r.end[2]) find_edges(c, first, stride[2], n, next_k);
    if (k > r.begin[2]) find_edges(c, first - stride[2], stride[2], n, previous_k);
    compare(along_i, 1, along_i, 0, next_j, previous_j, n, largest.data());
    compare(along_i, 1, along_i, 0, next_k, previous_k, n, largest.data());
    compare(next_j, 0, previous_j, 0, next_k, previous_k, n, largest.data());
  }
  return *std::max_element(largest.begin(), largest.end());
}

}  // namespace

std::vector<double> largest_cosines(HostInstance const& host, Mesh const& mesh, std::span<NodeBox const> boxes) {
  struct Plane {
    int box, k;
  };
  std::vector<Plane> planes;
  for (int b = 0; b < int(boxes.size()); ++b)
    for (int k = boxes[b].nodes.begin[2]; k < boxes[b].nodes.end[2]; ++k) planes.push_back({b, k});
  std::vector<double> of_plane(planes.size());
  detail::for_all_parts(host, "gridmorph::largest_cosines", Index(planes.size()),
                        [&](Index p) { of_plane[p] = largest_cosine(mesh, boxes[planes[p].box], planes[p].k); });
  std::vector<double> largest(boxes.size(), 0.0);
  for (std::size_t p = 0; p < planes.size(); ++p)
    largest[planes[p].box] = std::max(largest[planes[p].box], of_plane[p]);
  return largest;
}

}  // namespace gridmorph
