#include <gridmorph/plan/blocks/plan_basis.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>

#include <gridmorph/plan/blocks/stage_builder.hpp>

namespace gridmorph {
namespace {

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

Priority::Priority(HostInstance const& host, Mesh const& mesh, Topology const& topology, VolumeOptions const& options,
                   double mesh_size)
    : host_(host),
      mesh_(mesh),
      topology_(topology),
      options_(options),
      mesh_size_(mesh_size),
      angle_of_block_(topology.blocks.size(), -1) {
  kind_order_ = PriorityRule{}.order;
  for (PriorityRule const& rule : options.priority)
    if (rule.kind == PriorityRule::Kind::boundary) kind_order_ = rule.order;
}

void Priority::measure_angles(std::set<int> const& blocks) {
  std::vector<NodeBox> boxes;
  std::vector<int> block_of_box;
  for (int const block : blocks) {
    if (angle_of_block_[block] >= 0) continue;
    for (PlacedPiece const& placed : topology_.blocks[block].pieces) {
      Piece const& piece = topology_.lattice.pieces()[placed.piece];
      boxes.push_back({piece.zone, piece.nodes});
      block_of_box.push_back(block);
    }
  }
  if (boxes.empty()) return;
  std::vector<double> const cosine = largest_cosines(host_, mesh_, boxes);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    double const angle = std::acos(std::clamp(cosine[b], -1.0, 1.0)) * 180 / std::numbers::pi;
    double& smallest = angle_of_block_[block_of_box[b]];
    smallest = smallest < 0 ? angle : std::min(smallest, angle);
  }
}

void Priority::add_quality(std::span<RankedChain> chains) {
  bool const wanted = std::any_of(options_.priority.begin(), options_.priority.end(),
                                  [](PriorityRule const& rule) { return rule.kind == PriorityRule::Kind::quality; });
  if (!wanted) return;
  std::set<int> blocks;
  for (RankedChain const& ranked : chains)
    for (ChainStep const& step : ranked.chain.steps) blocks.insert(step.block);
  measure_angles(blocks);
  for (RankedChain& ranked : chains) {
    double angle = 180;
    for (ChainStep const& step : ranked.chain.steps) angle = std::min(angle, angle_of_block_[step.block]);
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

bool Priority::quality_leads() const {
  return !options_.priority.empty() && options_.priority.front().kind == PriorityRule::Kind::quality;
}

bool Priority::same_rank(RankedChain const& a, RankedChain const& b) const {
  if (quality_leads()) return a.quality == b.quality;
  if (!options_.priority.empty() && options_.priority.front().kind == PriorityRule::Kind::aspect_ratio)
    return a.aspect_ratio == b.aspect_ratio;
  return a.boundary == b.boundary;
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
