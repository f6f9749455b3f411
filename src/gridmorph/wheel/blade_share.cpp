#include <gridmorph/wheel/blade_share.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/detail/pitch_fraction.hpp>
#include <gridmorph/wheel/shared_nodes.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <utility>

namespace gridmorph {

namespace {

enum Side : unsigned char { lower_side = 1, upper_side = 2 };

/// Blades of one row, and what its nodes lie on.
class Row {
 public:
  Row(Boundary const& boundary, PassageLinks const& links, WheelRows const& rows, int row, ResolvedMotion const& motion,
      OneOfPlace const& one_of_place)
      : boundary_(boundary), links_(links), rows_(rows), row_(row), motion_(motion), one_of_place_(one_of_place) {}

  void prepare(SharedNodes const& all) {
    for (std::size_t l = 0; l < links_.all.size(); ++l) {
      PassageLink const& link = links_.all[l];
      if (rows_.pitches_of_link[l] == 0 || rows_.row_of_zone[link.zone] != row_) continue;
      unsigned char const side = rows_.pitches_of_link[l] > 0 ? lower_side : upper_side;
      for (auto const& pair : link.pairs) side_[one_of_place_(pair[0])] |= side;
    }
    blades_ = find_blades();
    number_blades(all);
  }

  [[nodiscard]] BladeShare share(Index node, int rule) {
    BladeShare out;
    Index const k = one_of_place_(node);
    auto const side = side_.find(k);
    if (side != side_.end() && side->second == (lower_side | upper_side)) {
      out.on_axis = true;
    } else if (auto const blade = blade_at_.find(k); blade != blade_at_.end()) {
      out.position = blade->second;
    } else if (side != side_.end()) {
      out.position = (side->second == lower_side ? 0.0 : 1.0) - middle_;
    } else if (auto const& fraction = fraction_of(rule); !fraction.empty()) {
      out.position = fraction(boundary_.coordinates()[node]) - middle_;
    }
    return out;
  }

 private:
  [[nodiscard]] std::vector<int> find_blades() const {
    std::set<int> out;
    auto const add = [&](int p) {
      if (rows_.row_of_zone[boundary_.patches()[p].zone] == row_) out.insert(p);
    };
    for (MotionRule const& rule : motion_.rules) {
      if (auto const* slide = std::get_if<CircumferentialSlideRule>(&rule.rule))
        for (int const p : boundary_.select_patches(slide->of)) add(p);
      if (auto const* follow = std::get_if<FollowRule>(&rule.rule))
        for (int const p : boundary_.select_patches(follow->of)) add(p);
    }
    if (!out.empty()) return {out.begin(), out.end()};
    for (int p = 0; p < int(boundary_.patches().size()); ++p) {
      Rule const& rule = motion_.patch_rule(p);
      if ((boundary_.patches()[p].kind == PatchKind::wall || boundary_.patches()[p].kind == PatchKind::other) &&
          (std::holds_alternative<RigidRule>(rule) || std::holds_alternative<FunctionRule>(rule) ||
           std::holds_alternative<SectionsRule>(rule) || std::holds_alternative<TargetRule>(rule) ||
           std::holds_alternative<InflateRule>(rule) || std::holds_alternative<FfdRule>(rule)))
        add(p);
    }
    return {out.begin(), out.end()};
  }

  /// What hangs together of a blade's patch by its faces: in an H mesh of elements one patch has both sides, a pitch
  /// apart.
  struct Piece {
    int patch = -1;
    std::vector<Index> nodes;
  };

  [[nodiscard]] std::vector<Piece> pieces_of_blades() const {
    std::vector<Piece> out;
    for (int const p : blades_) {
      BoundarySurface const& surface = boundary_.surface(p);
      DisjointSets<int> sets(surface.nodes.size());
      std::vector<char> in_face(surface.nodes.size(), 0);
      for (GridFacet const& face : surface.faces)
        for (int const n : face)
          if (n >= 0) {
            sets.join(face[0], n);
            in_face[n] = 1;
          }
      // Blocks have a grid, and nodes amid edges are of no face.
      bool const whole = std::find(in_face.begin(), in_face.end(), 0) != in_face.end();
      std::map<int, std::vector<Index>> pieces;
      for (std::size_t n = 0; n < in_face.size(); ++n)
        pieces[whole ? 0 : sets.root(int(n))].push_back(surface.nodes[n]);
      for (auto& [root, nodes] : pieces) out.push_back({p, std::move(nodes)});
    }
    return out;
  }

  /// Pieces that meet are of one blade. A piece whose nodes are `a` passages ahead meets another whose nodes are `b`
  /// ahead: their blades' numbers differ by a - b.
  void number_blades(SharedNodes const& all) {
    std::vector<Piece> const pieces = pieces_of_blades();
    struct Meeting {
      int piece, offset;
    };
    std::map<int, std::vector<Meeting>> meetings;  // by group
    std::vector<unsigned char> touches(pieces.size(), 0);
    for (std::size_t b = 0; b < pieces.size(); ++b) {
      for (Index const n : pieces[b].nodes) {
        Index const one = one_of_place_(n);
        if (auto const side = side_.find(one); side != side_.end()) touches[b] |= side->second;
        if (auto const* m = all.find(one); m != nullptr && !all.on_axis(m->group))
          meetings[m->group].push_back({int(b), m->offset});
      }
    }
    std::vector<std::set<std::pair<int, int>>> neighbours(pieces.size());  // (piece, its number minus the own one)
    for (auto const& [group, meets] : meetings)
      for (Meeting const& m : meets) {
        Meeting const& first = meets.front();
        neighbours[first.piece].insert({m.piece, m.offset - first.offset});
        neighbours[m.piece].insert({first.piece, first.offset - m.offset});
      }

    std::vector<int> number(pieces.size(), 0);
    std::vector<char> seen(pieces.size(), 0);
    for (std::size_t start = 0; start < pieces.size(); ++start) {
      if (seen[start] != 0) continue;
      std::vector<int> blade{int(start)};
      seen[start] = 1;
      for (std::size_t next = 0; next < blade.size(); ++next)
        for (auto const& [other, ahead] : neighbours[blade[next]]) {
          int const expected = number[blade[next]] + ahead;
          if (seen[other] == 0) {
            seen[other] = 1;
            number[other] = expected;
            blade.push_back(other);
          } else if (number[other] != expected) {
            throw MotionError(
                "blade " + boundary_.describe_patch(pieces[start].patch) +
                " hangs together with the blade of the next passage, so the two cannot move differently; name the "
                "blade alone in `of`, without hub and case");
          }
        }
      // Blade p stands at the lower side of passage p, where it touches one.
      int zero = 0;
      for (int const b : blade)
        if (touches[b] == upper_side) zero = number[b] - 1;
      for (int const b : blade)
        if (touches[b] == lower_side) zero = number[b];
      for (int const b : blade) {
        number[b] -= zero;
        if (touches[b] != 0) middle_ = 0;
      }
    }
    for (std::size_t b = 0; b < pieces.size(); ++b)
      for (Index const n : pieces[b].nodes) blade_at_[one_of_place_(n)] = number[b];
  }

  PitchFraction const& fraction_of(int rule) {
    auto const known = fractions_.find(rule);
    if (known != fractions_.end()) return known->second;
    std::vector<int> patches;
    for (int p = 0; p < int(boundary_.patches().size()); ++p)
      if (motion_.patch[p].rule == rule) patches.push_back(p);
    return fractions_.try_emplace(rule, boundary_, links_, rows_, row_, patches).first->second;
  }

  Boundary const& boundary_;
  PassageLinks const& links_;
  WheelRows const& rows_;
  int row_;
  ResolvedMotion const& motion_;
  OneOfPlace const& one_of_place_;
  std::vector<int> blades_;                        ///< patches
  std::unordered_map<Index, unsigned char> side_;  ///< by place: periodic sides the node lies on
  std::unordered_map<Index, int> blade_at_;        ///< by place: which blade
  std::map<int, PitchFraction> fractions_;         ///< by rule
  double middle_ = 0.5;                            ///< where in the passage its blade stands
};

}  // namespace

OneOfPlace one_of_place(PassageLinks const& links, WheelRows const& rows) {
  auto const plain = std::make_shared<SharedNodes const>(links, rows, false);
  std::vector<Index> first_of_group(plain->n_groups(), -1);
  for (auto const& m : plain->members())
    if (first_of_group[m.group] < 0) first_of_group[m.group] = m.node;
  return [plain, first_of_group](Index node) {
    auto const* member = plain->find(node);
    return member ? first_of_group[member->group] : node;
  };
}

std::vector<BladeShare> blade_shares(Boundary const& sector, PassageLinks const& links, WheelRows const& rows,
                                     ResolvedMotion const& motion, std::vector<char> const& open,
                                     OneOfPlace const& one_of_place, BoundaryRequests const& requests,
                                     std::vector<Index> const& nodes) {
  std::vector<BladeShare> out(nodes.size());
  SharedNodes const all(links, rows, true);
  std::map<int, Row> opened;
  for (int r = 0; r < int(rows.rows.size()); ++r)
    if (open[r] != 0) opened.try_emplace(r, sector, links, rows, r, motion, one_of_place).first->second.prepare(all);

  std::vector<char> done(nodes.size(), 0);
  for (auto const& request : requests.requests) {
    if (done[request.boundary_node] != 0) continue;
    done[request.boundary_node] = 1;
    Index const node = nodes[request.boundary_node];
    auto const row = opened.find(rows.row_of_zone[sector.zone_of(node)]);
    if (row != opened.end()) out[request.boundary_node] = row->second.share(node, request.rule);
  }
  return out;
}

}  // namespace gridmorph
