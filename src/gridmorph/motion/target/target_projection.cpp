#include <gridmorph/motion/target/target_projection.hpp>

#include <gridmorph/core/text.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/motion/target/edge_images.hpp>
#include <gridmorph/motion/target/feature_edges.hpp>
#include <gridmorph/motion/target/surface_spread.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

std::vector<GridFacet> as_facets(std::vector<std::array<int, 3>> const& triangles) {
  std::vector<GridFacet> out;
  for (auto const& t : triangles) out.push_back({t[0], t[1], t[2], -1});
  return out;
}

Box box_of(std::vector<Vec3> const& points) {
  Box box;
  for (Vec3 const& p : points) box.include(p);
  return box;
}

}  // namespace

std::function<Vec3(Vec3 const&)> rough_guess(std::vector<Vec3> const& points, TargetTree const& target) {
  auto const [lo, hi] = box_of(points);
  auto const [target_lo, target_hi] = box_of(target.points());
  Vec3 const shift = 0.5 * ((target_lo + target_hi) - (lo + hi));
  auto const ratio = [](double to, double from) { return from > 0 && to > 0 ? to / from : 1.0; };
  Vec3 const scale{ratio(target_hi.x - target_lo.x, hi.x - lo.x), ratio(target_hi.y - target_lo.y, hi.y - lo.y),
                   ratio(target_hi.z - target_lo.z, hi.z - lo.z)};
  Vec3 const centre = 0.5 * (lo + hi);
  std::array<std::function<Vec3(Vec3 const&)>, 3> const guesses{
      [](Vec3 const& p) { return p; }, [shift](Vec3 const& p) { return p + shift; },
      [=](Vec3 const& p) {
        Vec3 const d = p - centre;
        return centre + shift + Vec3{scale.x * d.x, scale.y * d.y, scale.z * d.z};
      }};
  std::size_t const step = std::max<std::size_t>(1, points.size() / 500);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < guesses.size(); ++g) {
    double sum = 0;
    for (std::size_t n = 0; n < points.size(); n += step) sum += target.closest(guesses[g](points[n])).distance;
    if (sum < (g == 0 ? 1.0 : 0.5) * least) {
      least = sum;
      best = g;
    }
  }
  return guesses[best];
}

namespace {

class Projection {
 public:
  Projection(PatchSurface const& surface, TargetTree const& target, std::vector<char> const& held,
             double crease_angle_deg)
      : surface_(surface),
        target_(target),
        points_(surface.points),
        facets_(surface.facets()),
        target_facets_(as_facets(target.triangles())) {
    edges_ = map_edges(points_, find_feature_edges(points_, facets_, crease_angle_deg), target,
                       find_feature_edges(target.points(), target_facets_, crease_angle_deg), surface.size,
                       rough_guess(points_, target));
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (held[v] == 0 || target.closest(points_[v]).distance > held_within * surface.size) continue;
      edges_.known[v] = 1;
      edges_.image[v] = points_[v];
    }
  }

  [[nodiscard]] EdgeImages const& edges() const { return edges_; }

  std::vector<Vec3> run() {
    auto const as_it_is = [](int, Vec3 const& at) { return at; };
    SurfaceSpread spread(surface_, edges_.known, edges_.image, edges_.edges);
    auto spread_out = spread.run(as_it_is);
    wanted_ = points_;
    for (Vec3& x : wanted_) x = x + spread.carried()(x);
    // A closed smooth surface has no edge to go along with: the box around it is all there is to guess by.
    if (!surface_.gridded && edges_.edges.empty()) {
      wanted_ = closed_guess();
      spread_out = wanted_;
    }
    // Patches may end anywhere, and their sides know nothing of an edge beside them: what is spread is evened out.
    wanted_ = relax(surface_, edges_.known, wanted_, std::move(spread_out), as_it_is);
    normal_.assign(points_.size(), {});
    for (GridFacet const& f : facets_)
      for (int const v : f)
        if (v >= 0) normal_[v] += facet_normal(wanted_, f);
    find_sense();
    find_pieces();
    auto const place = [this](int v, Vec3 const& p) { return project(v, p); };
    auto placed = wanted_;
    for (std::size_t v = 0; v < placed.size(); ++v)
      if (edges_.known[v] == 0) placed[v] = place(int(v), wanted_[v]);
    image_ = relax(surface_, edges_.known, wanted_, std::move(placed), place);
    std::vector<Vec3> displacement(points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) {
      Vec3 const u = image_[v] - points_[v];
      bool const stays = norm(u) <= 1e-14 * (surface_.size + norm(points_[v]));
      if (!stays) displacement[v] = u;
    }
    return displacement;
  }

  /// Facets that were not folded, and are on the target: a corner of theirs turned over. After run().
  [[nodiscard]] std::vector<GridFacet> folded() const {
    std::vector<GridFacet> out;
    for (GridFacet const& f : facets_) {
      Vec3 const before = facet_normal(points_, f), after = facet_normal(wanted_, f);
      int const corners = f[3] < 0 ? 3 : 4;
      for (int c = 0; c < corners; ++c) {
        GridFacet const corner{f[(c + corners - 1) % corners], f[c], f[(c + 1) % corners], -1};
        if (dot(facet_normal(points_, corner), before) > 0 && !(dot(facet_normal(image_, corner), after) > 0)) {
          out.push_back(f);
          break;
        }
      }
    }
    return out;
  }

 private:
  /// Where the vertices of a surface without edges go, roughly: with its size and its middle, by area; with the sides
  /// of its box where that comes much closer.
  [[nodiscard]] std::vector<Vec3> closed_guess() const {
    auto const [from, own] = middle_and_area(points_, facets_);
    auto const [to, there] = middle_and_area(target_.points(), target_facets_);
    double const scale = own > 0 && there > 0 ? std::sqrt(there / own) : 1;
    std::vector<Vec3> even, stretched;
    double to_even = 0, to_stretched = 0;
    for (Vec3 const& p : points_) {
      even.push_back(to + scale * (p - from));
      stretched.push_back(edges_.guess(p));
    }
    std::size_t const step = std::max<std::size_t>(1, points_.size() / 500);
    for (std::size_t v = 0; v < points_.size(); v += step) {
      to_even += target_.closest(even[v]).distance;
      to_stretched += target_.closest(stretched[v]).distance;
    }
    return to_stretched < 0.5 * to_even ? stretched : even;
  }

  static std::pair<Vec3, double> middle_and_area(std::vector<Vec3> const& points,
                                                 std::vector<GridFacet> const& facets) {
    Vec3 sum;
    double area = 0;
    for (GridFacet const& f : facets) {
      double const own = 0.5 * norm(facet_normal(points, f));
      Vec3 middle = points[f[0]] + points[f[1]] + points[f[2]];
      if (f[3] >= 0) middle += points[f[3]];
      sum += (own / (f[3] < 0 ? 3 : 4)) * middle;
      area += own;
    }
    return {area > 0 ? (1 / area) * sum : Vec3{}, area};
  }

  /// Whether the target's normals point as the surface's do (+1), the other way (-1), or neither (0).
  void find_sense() {
    std::size_t const step = std::max<std::size_t>(1, points_.size() / 500);
    int same = 0, all = 0;
    for (std::size_t v = 0; v < points_.size(); v += step) {
      auto const hit = target_.closest(wanted_[v]);
      double const facing = dot(target_.normal(hit.triangle), normal_[v]);
      same += facing > 0 ? 1 : 0;
      all += facing != 0 ? 1 : 0;
    }
    sense_ = same >= 0.7 * all ? 1 : (same <= 0.3 * all ? -1 : 0);
  }

  /// Which piece of the target, between the edges that edges are mapped to, the nodes of each piece of the surface
  /// belong to: that to which more than 60 % of them are nearest; none where the pieces do not correspond.
  void find_pieces() {
    auto const piece = pieces_between(facets_, edges_.edges);
    target_piece_ = pieces_between(target_facets_, edges_.on_target);
    piece_.assign(points_.size(), -1);
    for (std::size_t n = 0; n < facets_.size(); ++n)
      for (int const v : facets_[n])
        if (v >= 0) piece_[v] = piece[n];
    int const n_pieces = piece.empty() ? 0 : 1 + *std::max_element(piece.begin(), piece.end());
    std::vector<std::map<int, int>> votes(n_pieces);
    std::vector<int> all(n_pieces, 0);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (edges_.known[v] != 0 || piece_[v] < 0) continue;
      auto const hit =
          sense_ == 0 ? target_.closest(wanted_[v]) : target_.closest_facing(wanted_[v], sense_ * normal_[v]);
      ++all[piece_[v]];
      if (hit.triangle >= 0) ++votes[piece_[v]][target_piece_[hit.triangle]];
    }
    belongs_to_.assign(n_pieces, -1);
    for (int p = 0; p < n_pieces; ++p)
      for (auto const& [target, count] : votes[p])
        if (count > 0.6 * all[p]) belongs_to_[p] = target;
  }

  /// The closest point on the own piece of the target that faces the same way. Beside a thin edge the other side may be
  /// nearer than the own one. Where nothing of that kind is nearby (folds, doubtful normals), the closest point
  /// is better than a far one.
  [[nodiscard]] Vec3 project(int v, Vec3 const& wanted) const {
    TargetTree::Hit const any = target_.closest(wanted);
    auto const near = [&](TargetTree::Hit const& hit) {
      return hit.triangle >= 0 && hit.distance <= 10 * any.distance + 0.02 * surface_.size;
    };
    int const own = piece_[v] >= 0 ? belongs_to_[piece_[v]] : -1;
    Vec3 const facing = sense_ * normal_[v];
    auto const faces = [&](int t) { return sense_ == 0 || dot(target_.normal(t), facing) > 0; };
    if (own >= 0) {
      auto const hit = target_.closest_of(wanted, [&](int t) { return target_piece_[t] == own && faces(t); });
      if (near(hit)) return hit.point;
    }
    if (sense_ == 0) return any.point;
    auto const hit = target_.closest_facing(wanted, facing);
    return near(hit) ? hit.point : any.point;
  }

  PatchSurface const& surface_;
  TargetTree const& target_;
  std::vector<Vec3> const& points_;
  std::vector<GridFacet> facets_, target_facets_;
  EdgeImages edges_;
  std::vector<Vec3> wanted_;  ///< per vertex: carried along with the edges, not on the target yet
  std::vector<Vec3> normal_;  ///< of `wanted_`, into the mesh, per vertex, longer for larger facets
  std::vector<Vec3> image_;
  int sense_ = 0;
  std::vector<int> piece_;         ///< per vertex not on a mapped edge
  std::vector<int> belongs_to_;    ///< per piece of the surface: piece of the target, -1: unknown
  std::vector<int> target_piece_;  ///< per triangle
};

}  // namespace

std::vector<Vec3> project_to_target(PatchSurface const& surface, TargetTree const& target,
                                    std::vector<char> const& held, double crease_angle_deg, std::string const& name,
                                    std::vector<std::string>& notes) {
  Projection projection(surface, target, held, crease_angle_deg);
  EdgeImages const& edges = projection.edges();
  std::string note = name + ": mapped by projection, " + std::to_string(edges.mapped) + " edges to edges of the target";
  if (edges.unmapped > 0)
    note += "; " + std::to_string(edges.unmapped) +
            " edges of the patches have none near them there and go to the closest point";
  notes.push_back(note);
  auto displacement = projection.run();
  if (auto const folded = projection.folded(); !folded.empty()) {
    Vec3 const& at = surface.points[folded.front()[0]];
    notes.push_back(
        name + ": " + std::to_string(folded.size()) + " facets of the patches fold on the target, the first at " +
        to_text(at, 6) +
        "; another crease_angle_deg may help, or a target with the parametrisation of the mesh (mapping nodes "
        "or sections)");
  }
  return displacement;
}

}  // namespace gridmorph
