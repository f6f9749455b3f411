#include <gridmorph/plan/priority.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>

#include <gridmorph/plan/stage_builder.hpp>

namespace gridmorph {
namespace {

/// Largest cosine between grid edges of different directions that meet at a node, over all nodes and the edges inside the
/// box: the cosine of the smallest angle of the faces of its cells.
double largest_cosine(Mesh const& mesh, Zone const& zone, IndexRange const& r) {
  double largest = -1;
  auto const stride = zone.strides();
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        Index3 const p{i, j, k};
        Index const n = zone.node(p);
        Vec3 const here = mesh.coordinates[n];
        Vec3 edge[6];
        bool has[6];
        for (int d = 0; d < 6; ++d) {
          int const a = d / 2;
          has[d] = d % 2 == 0 ? p[a] > r.begin[a] : p[a] + 1 < r.end[a];
          if (!has[d]) continue;
          edge[d] = mesh.coordinates[n + (d % 2 == 0 ? -stride[a] : stride[a])] - here;
          double const length = norm(edge[d]);
          has[d] = length > 0;
          if (has[d]) edge[d] = (1 / length) * edge[d];
        }
        for (int d = 0; d < 6; ++d)
          for (int e = (d / 2 + 1) * 2; e < 6; ++e)
            if (has[d] && has[e]) largest = std::max(largest, dot(edge[d], edge[e]));
      }
  return largest;
}

struct Corners {
  Vec3 p[2][2][2];  ///< [s][a][b] end
};

Corners corners_of(Mesh const& mesh, Topology const& topology, Chain const& chain) {
  ChainLayout const layout = lay_out(topology, chain);
  Corners c;
  for (int s = 0; s < 2; ++s)
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        ChainPiece const& piece = layout.at(s ? layout.n[0] - 1 : 0, a ? layout.n[1] - 1 : 0, b ? layout.n[2] - 1 : 0);
        PieceNodes const n = piece_nodes(mesh, topology.lattice, piece);
        Vec3 const x = mesh.coordinates[n.first + s * (n.count[0] - 1) * n.stride[0] +
                                        a * (n.count[1] - 1) * n.stride[1] + b * (n.count[2] - 1) * n.stride[2]];
        c.p[s][a][b] = transpose(chain.steps[piece.step].rotation) * x;
      }
  return c;
}

}  // namespace

Priority::Priority(Mesh const& mesh, Topology const& topology, VolumeOptions const& options, double mesh_size)
    : mesh_(mesh),
      topology_(topology),
      options_(options),
      mesh_size_(mesh_size),
      angle_of_block_(topology.blocks.size(), -1) {
  kind_order_ = PriorityRule{}.order;
  for (PriorityRule const& rule : options.priority)
    if (rule.kind == PriorityRule::Kind::boundary) kind_order_ = rule.order;
}

double Priority::minimum_angle_deg(int block) {
  double& angle = angle_of_block_[block];
  if (angle < 0) {
    double cosine = -1;
    for (PlacedPiece const& placed : topology_.blocks[block].pieces) {
      Piece const& piece = topology_.lattice.pieces()[placed.piece];
      cosine = std::max(cosine, largest_cosine(mesh_, mesh_.zones[piece.zone], piece.nodes));
    }
    angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
  }
  return angle;
}

void Priority::add_quality(RankedChain& ranked) {
  for (PriorityRule const& rule : options_.priority) {
    if (rule.kind != PriorityRule::Kind::quality) continue;
    double angle = 180;
    for (ChainStep const& step : ranked.chain.steps) angle = std::min(angle, minimum_angle_deg(step.block));
    ranked.quality = std::llround(angle * 1e6);
  }
}

RankedChain Priority::rank(Chain chain) const {
  RankedChain ranked;
  int const first = kind_rank(chain.first.kind, kind_order_), last = kind_rank(chain.last.kind, kind_order_);
  ranked.boundary = {std::min(first, last), std::max(first, last)};
  Corners const c = corners_of(mesh_, topology_, chain);
  double length = 0, width = 0;
  Vec3 centre;
  for (int p = 0; p < 2; ++p)
    for (int q = 0; q < 2; ++q) {
      length += distance(c.p[0][p][q], c.p[1][p][q]);
      width += distance(c.p[p][0][q], c.p[p][1][q]) + distance(c.p[p][q][0], c.p[p][q][1]);
      centre += c.p[0][p][q] + c.p[1][p][q];
    }
  ranked.aspect_ratio = std::llround(1e6 * std::min(1e9, width > 0 ? 2 * length / width : 1e9));
  double const unit = 1e-9 * mesh_size_ * 8;
  auto const place = [unit](Vec3 const& p) {
    return std::array<long long, 3>{std::llround(p.x / unit), std::llround(p.y / unit), std::llround(p.z / unit)};
  };
  ranked.centre = place(centre);
  for (int s = 0; s < 2; ++s)
    ranked.ends[s] = place(2 * ((c.p[s][0][0] + c.p[s][1][1]) + (c.p[s][0][1] + c.p[s][1][0])));
  std::sort(ranked.ends.begin(), ranked.ends.end());
  ranked.chain = std::move(chain);
  return ranked;
}

void Priority::sort(std::vector<RankedChain>& chains) const {
  std::stable_sort(chains.begin(), chains.end(), [&](RankedChain const& a, RankedChain const& b) {
    for (PriorityRule const& rule : options_.priority) switch (rule.kind) {
        case PriorityRule::Kind::boundary:
          if (a.boundary != b.boundary) return a.boundary < b.boundary;
          break;
        case PriorityRule::Kind::quality:
          if (a.quality != b.quality) return a.quality < b.quality;
          break;
        case PriorityRule::Kind::aspect_ratio:
          if (a.aspect_ratio != b.aspect_ratio) return a.aspect_ratio < b.aspect_ratio;
          break;
      }
    if (a.aspect_ratio != b.aspect_ratio) return a.aspect_ratio < b.aspect_ratio;
    // Two directions through one block have the same centre.
    return std::tie(a.centre, a.ends) < std::tie(b.centre, b.ends);
  });
}

std::string Priority::reason(RankedChain const& chain) const {
  auto kind = [](ChainEnd const& end) { return end.known ? end_kind_name(end.kind) : std::string_view("open"); };
  char numbers[96];
  std::string text = std::string(kind(chain.chain.first)) + " to " + std::string(kind(chain.chain.last));
  if (chain.quality > 0) {
    std::snprintf(numbers, sizeof numbers, ", smallest angle %.2f deg", double(chain.quality) * 1e-6);
    text += numbers;
  }
  std::snprintf(numbers, sizeof numbers, ", aspect ratio %.3g", double(chain.aspect_ratio) * 1e-6);
  return text + numbers;
}

}  // namespace gridmorph
