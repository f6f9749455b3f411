#include <gridmorph/motion/boundary_motion.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_many.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/along_walls.hpp>
#include <gridmorph/motion/carry/carried_features.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/end_walls/extended_blades.hpp>
#include <gridmorph/motion/ffd/ffd_motion.hpp>
#include <gridmorph/motion/inflation/inflate_motion.hpp>
#include <gridmorph/motion/rigid_motion.hpp>
#include <gridmorph/motion/target/target_motion.hpp>
#include <gridmorph/motion/turbomachinery/row_motion.hpp>
#include <gridmorph/motion/turbomachinery/section_motion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace gridmorph {

namespace {

std::vector<std::string> const* blades_of(Rule const& rule) {
  if (auto const* slide = std::get_if<CircumferentialSlideRule>(&rule)) return &slide->of;
  if (auto const* follow = std::get_if<FollowRule>(&rule)) return &follow->of;
  return nullptr;
}

/// displacement(point) of every point, on all cores where they are many.
template <class Displacement>
void at_each(std::span<Vec3 const> points, std::span<Vec3> out, Displacement const& displacement) {
  detail::for_many("gridmorph::boundary_motion", Index(points.size()),
                   [&](Index n) { out[n] = displacement(points[n]); });
}

}  // namespace

struct BoundaryMotion::Impl {
  std::shared_ptr<Boundary const> boundary;
  ResolvedMotion motion;
  std::vector<MotionRule> const& rules = motion.rules;
  SecondPlane second_plane;
  std::vector<std::string> notes;
  std::shared_ptr<SlipSurfaces const> slip;
  std::map<std::vector<int>, RowMotion> rows;  ///< by the patches of the blade; map, so that rows stay where they
                                               ///< are
  std::vector<RowMotion const*> row_of_rule;   ///< per rule, null for rules without a blade
  std::vector<std::unique_ptr<SectionMotion>> sections_of_rule;  ///< per rule, null for other rules
  std::map<int, std::shared_ptr<TargetMotion const>> targets;    ///< by rule
  std::map<int, InflateMotion> inflations;                       ///< by rule
  std::map<int, FfdMotion> lattices;                             ///< by rule
  std::map<int, MovedWall> moved_walls;                          ///< by rule, those that blades are extended to
  std::map<int, ExtensionMotion> extensions;                     ///< by rule
  std::map<int, WallShift> wall_shifts;                          ///< by the rule of the wall
  std::map<int, CarriedFeatures> carried;                        ///< by rule
  std::map<int, std::shared_ptr<CarryingWall const>> carrying;   ///< by the rule of the wall
  std::map<int, AttachedMotion> attached;                        ///< by rule
  std::map<int, WakeMotion> wakes;                               ///< by rule
  std::map<int, ShockMotion> shocks;                             ///< by rule

  Impl(std::shared_ptr<Boundary const> of, ResolvedMotion resolved)
      : boundary(std::move(of)),
        motion(std::move(resolved)),
        second_plane(boundary->second_plane()),
        slip(std::make_shared<SlipSurfaces const>(*boundary, motion, notes)) {
    make_targets();
    inflate();
    each<FfdRule>(
        [&](int r, FfdRule const& rule) { lattices.try_emplace(r, *boundary, patches_of(r), rule, label(r), notes); });
    extend(notes);
    make_blades();
    carry(notes);
    attach(notes);
  }

  Impl(Impl const& other, Motion const& now)
      : boundary(other.boundary), motion(other.motion), second_plane(other.second_plane), slip(other.slip) {
    for (std::size_t r = 0; r < now.rules.size(); ++r) motion.rules[r].rule = now.rules[r].rule;
    for (auto const& [r, target] : other.targets)
      targets[r] = std::make_shared<TargetMotion const>(*target, std::get<TargetRule>(rules[r].rule).share);
    each<InflateRule>(
        [&](int r, InflateRule const& rule) { inflations.try_emplace(r, other.inflations.at(r), rule, label(r)); });
    each<FfdRule>([&](int r, FfdRule const& rule) { lattices.try_emplace(r, other.lattices.at(r), rule, label(r)); });
    std::vector<std::string> said;  // with the notes of the first motion
    extend(said);
    make_blades(&other.rows);
    carry(said);
    attach(said);
  }

  Impl(Impl const&) = delete;
  Impl& operator=(Impl const&) = delete;

  /// `known`: rows where other motions of the same blades have been made already.
  void make_blades(std::map<std::vector<int>, RowMotion> const* known = nullptr) {
    Problems problems;
    row_of_rule.assign(rules.size(), nullptr);
    sections_of_rule.resize(rules.size());
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto const* sections = std::get_if<SectionsRule>(&rules[r].rule);
      if (sections == nullptr) continue;
      try {
        sections_of_rule[r] =
            std::make_unique<SectionMotion>(*boundary, motion, *sections, patches_of(int(r)), *slip, notes);
      } catch (MotionError const& e) {
        problems.add(label(int(r)) + ": " + e.what());
      }
    }
    problems.throw_if_any<MotionError>();  // rows take up what the sections do
    for (std::size_t r = 0; r < rules.size(); ++r) {
      if (blades_of(rules[r].rule) == nullptr) continue;
      try {
        row_of_rule[r] = &row(boundary->select_patches(*blades_of(rules[r].rule)), known);
      } catch (MotionError const& e) {
        problems.add(label(int(r)) + ": " + e.what());
      }
    }
    problems.throw_if_any<MotionError>();
  }

  /// Makes the motions of target rules, before the blade rows, which may follow a blade that has a target.
  void make_targets() {
    Problems problems;
    BesideTarget beside{slip->surfaces, {}, {}};
    for (int p = 0; p < int(boundary->patches().size()); ++p) {
      if (motion.patch[p].rule < 0) continue;
      if (std::holds_alternative<FixedRule>(motion.patch_rule(p))) beside.fixed.push_back(p);
      if (std::holds_alternative<FreeRule>(motion.patch_rule(p))) beside.free.push_back(p);
    }
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto const* target = std::get_if<TargetRule>(&rules[r].rule);
      if (target == nullptr) continue;
      try {
        targets[int(r)] = std::make_shared<TargetMotion const>(*boundary, patches_of(int(r)), *target, motion.axis,
                                                               beside, label(int(r)), notes);
      } catch (MotionError const& e) {
        problems.add(e.what());
      }
    }
    problems.throw_if_any<MotionError>();
  }

  /// make(number, rule) for the rules of a kind.
  template <class Kind, class Make>
  void each(Make const& make) {
    Problems problems;
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto const* rule = std::get_if<Kind>(&rules[r].rule);
      if (rule == nullptr) continue;
      try {
        make(int(r), *rule);
      } catch (MotionError const& e) {
        problems.add(e.what());
      }
    }
    problems.throw_if_any<MotionError>();
  }

  /// Makes the motions of inflate rules, before the blade rows, which may follow a blade that is inflated.
  void inflate() {
    each<InflateRule>([&](int r, InflateRule const& rule) {
      inflations.try_emplace(r, *boundary, motion, patches_of(r), rule, slip, label(r), notes);
    });
  }

  /// Extends blades to their walls, after all that moves walls.
  void extend(std::vector<std::string>& said) {
    Problems problems;
    sections_of_rule.resize(rules.size());                         // none yet: they have walls that are known
    std::map<int, std::vector<ExtensionMotion const*>> blades_on;  // by the rule of the wall
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto const* rule = std::get_if<ExtendRule>(&rules[r].rule);
      if (rule == nullptr) continue;
      try {
        std::vector<int> const named = boundary->select_patches(rule->of);
        require_direct(named);
        std::map<int, MovedWall const*> walls;
        for (int const p : named) {
          int const w = motion.patch[p].rule;
          if (std::holds_alternative<SectionsRule>(rules[w].rule))
            throw MotionError(label(int(r)) + ": of: " + boundary->describe_patch(p) +
                              " has the rule 'sections', which is about blades and not about the walls they stand on");
          walls[w] = &moved_wall(w, label(int(r)));
        }
        std::vector<MovedWall const*> list;
        for (auto const& [w, wall] : walls) list.push_back(wall);
        auto const made =
            extensions.try_emplace(int(r), *boundary, patches_of(int(r)), list, label(int(r)), said).first;
        for (auto const& [w, wall] : walls) blades_on[w].push_back(&made->second);
      } catch (MotionError const& e) {
        problems.add(e.what());
      }
    }
    problems.throw_if_any<MotionError>();
    for (auto const& [w, blades] : blades_on)
      wall_shifts.try_emplace(w, *boundary, moved_walls.at(w), blades, label(w));
  }

  MovedWall const& moved_wall(int w, std::string const& name) {
    auto const displacement = [this, w](std::span<Vec3 const> points, std::span<Vec3> out) {
      evaluate_rule(w, points, out);
    };
    bool const anywhere =
        !std::holds_alternative<TargetRule>(rules[w].rule) && !std::holds_alternative<InflateRule>(rules[w].rule);
    return moved_walls.try_emplace(w, *boundary, patches_of(w), displacement, anywhere, name).first->second;
  }

  /// Makes features be carried by their walls, after all that moves walls, and before what is attached to them as they
  /// go. Walls that carry features together are one.
  void carry(std::vector<std::string>& said) {
    auto const displacement = [this](int p, std::span<Vec3 const> points, std::span<Vec3> out) {
      evaluate(motion.patch[p].rule, points, out);
    };
    DisjointSets<int> together(rules.size());  // carrying rules and those of their walls
    each<CarryRule>([&](int r, CarryRule const& rule) {
      std::vector<int> const walls = boundary->select_patches(rule.of);
      require_direct(walls);
      carried.try_emplace(r, *boundary, motion, patches_of(r), rule, walls, displacement, label(r));
      for (int const p : walls) together.join(r, motion.patch[p].rule);
      said.push_back(label(r) + ": " + described(carried.at(r).features()));
    });
    std::map<int, std::shared_ptr<CarryingWall const>> made;  // none changes what the others start from
    for (auto const& [r, features] : carried)
      if (auto const at = made.try_emplace(together.root(r)); at.second)
        at.first->second = carrying_wall(together.roots(), together.root(r), displacement);
    for (std::size_t r = 0; r < rules.size(); ++r)
      if (auto const wall = made.find(together.root(int(r))); wall != made.end() && is_direct(rules[r].rule))
        carrying[int(r)] = wall->second;
  }

  static std::string described(std::vector<CarriedFeatures::Feature> const& features) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (auto const& feature : features) {
      least = std::min(least, feature.fade);
      most = std::max(most, feature.fade);
    }
    return std::to_string(features.size()) + (features.size() == 1 ? " feature" : " features") +
           ", with which the walls go along as far as " + to_text(least, 3) +
           (least < most ? " to " + to_text(most, 3) : "") + " around, where they have room";
  }

  /// The walls and features of one set of rules; patches with a displacement of their own that are none of it limit how
  /// far they reach.
  [[nodiscard]] std::shared_ptr<CarryingWall const> carrying_wall(std::vector<int> const& set_of_rule, int set,
                                                                  CarriedFeatures::Displacement const& own) const {
    std::vector<int> walls;
    std::vector<char> limits(motion.patch.size(), 0);
    for (std::size_t p = 0; p < motion.patch.size(); ++p) {
      int const r = motion.patch[p].rule;
      if (set_of_rule[r] != set)
        limits[p] = is_explicit(r) ? 1 : 0;
      else if (is_direct(rules[r].rule))
        walls.push_back(int(p));
    }
    std::vector<CarriedFeatures::Feature const*> features;
    for (auto const& [r, of_rule] : carried)
      if (set_of_rule[r] == set)
        for (auto const& feature : of_rule.features()) features.push_back(&feature);
    return std::make_shared<CarryingWall const>(*boundary, walls, features, limits, own);
  }

  /// Makes the motions of attached parts, after all that parts can be attached to.
  void attach(std::vector<std::string>& said) {
    Problems problems;
    auto const displacement = [&](int p, std::span<Vec3 const> points, std::span<Vec3> out) {
      evaluate(motion.patch[p].rule, points, out);
    };
    auto const walls_of = [&](std::vector<std::string> const& of) {
      std::vector<int> walls = boundary->select_patches(of);
      require_direct(walls);
      return walls;
    };
    for (std::size_t r = 0; r < rules.size(); ++r) try {
        if (auto const* rule = std::get_if<AttachedRule>(&rules[r].rule))
          attached.try_emplace(int(r), *boundary, walls_of(rule->of), *rule, displacement);
        else if (auto const* wake = std::get_if<WakeRule>(&rules[r].rule))
          wakes.try_emplace(int(r), *boundary, motion, *wake, walls_of(wake->of), *slip, displacement, said,
                            beside_wake_of(walls_of(wake->of)));
        else if (auto const* shock = std::get_if<ShockRule>(&rules[r].rule))
          shocks.try_emplace(int(r), *boundary, *shock, shock->of.empty() ? std::vector<int>() : walls_of(shock->of),
                             displacement);
      } catch (MotionError const& e) {
        problems.add(label(int(r)) + ": " + e.what());
      }
    problems.throw_if_any<MotionError>();
  }

  /// What the periodic sides of a blade row do; nothing where no rule goes along with these blades.
  [[nodiscard]] WakeMotion::Beside beside_wake_of(std::vector<int> const& blades) const {
    for (std::size_t r = 0; r < rules.size(); ++r) {
      if (!std::holds_alternative<FollowRule>(rules[r].rule)) continue;
      std::vector<int> const followed = boundary->select_patches(*blades_of(rules[r].rule));
      if (std::find_first_of(blades.begin(), blades.end(), followed.begin(), followed.end()) != blades.end())
        return [row = row_of_rule[r]](Vec3 const& x) { return row->follow(x); };
    }
    return {};
  }

  void require_direct(std::vector<int> const& patches) const {
    for (int p : patches)
      if (Rule const& rule = motion.patch_rule(p); !is_direct(rule))
        throw MotionError("of: patch " + boundary->describe_patch(p) + " has the rule '" +
                          std::string(rule_name(rule)) +
                          "', whose displacement is not known beforehand; give "
                          "it fixed, rigid, formula, field, sections, target, inflate or ffd");
    if (patches.empty()) throw MotionError("of: names no patch");
  }

  RowMotion const& row(std::vector<int> const& blades, std::map<std::vector<int>, RowMotion> const* known) {
    if (auto const made = rows.find(blades); made != rows.end()) return made->second;
    require_direct(blades);
    auto const displacement = [&](int p, std::span<Vec3 const> points, std::span<Vec3> out) {
      evaluate(motion.patch[p].rule, points, out);
    };
    if (known != nullptr)
      if (auto const same = known->find(blades); same != known->end())
        return rows.try_emplace(blades, same->second, *boundary, displacement).first->second;
    return rows.try_emplace(blades, *boundary, motion, blades, *slip, displacement, notes).first->second;
  }

  static bool is_direct(Rule const& rule) {
    return std::holds_alternative<FixedRule>(rule) || std::holds_alternative<RigidRule>(rule) ||
           std::holds_alternative<FunctionRule>(rule) || std::holds_alternative<SectionsRule>(rule) ||
           std::holds_alternative<TargetRule>(rule) || std::holds_alternative<InflateRule>(rule) ||
           std::holds_alternative<FfdRule>(rule);
  }

  [[nodiscard]] bool is_explicit(int rule) const {
    Rule const& own = rules[rule].rule;
    return is_direct(own) || row_of_rule[rule] != nullptr || std::holds_alternative<AttachedRule>(own) ||
           std::holds_alternative<CarryRule>(own) || std::holds_alternative<WakeRule>(own) ||
           std::holds_alternative<ShockRule>(own) || std::holds_alternative<PrescribedRule>(own) ||
           std::holds_alternative<ExtendRule>(own);
  }

  [[nodiscard]] std::vector<int> patches_of(int r) const {
    std::vector<int> patches;
    for (std::size_t p = 0; p < motion.patch.size(); ++p)
      if (motion.patch[p].rule == r) patches.push_back(int(p));
    return patches;
  }

  std::string label(int r) const {
    MotionRule const& rule = rules[r];
    std::string text = "rule " + std::to_string(r + 1) + " (" + std::string(rule_name(rule.rule));
    if (auto const* function = std::get_if<FunctionRule>(&rule.rule);
        function != nullptr && !function->description.empty())
      text += ": " + function->description;
    if (auto const* target = std::get_if<TargetRule>(&rule.rule); target != nullptr && !target->description.empty())
      text += ": " + target->description;
    if (auto const* inflate = std::get_if<InflateRule>(&rule.rule); inflate != nullptr && !inflate->description.empty())
      text += ": " + inflate->description;
    if (auto const* ffd = std::get_if<FfdRule>(&rule.rule); ffd != nullptr && !ffd->description.empty())
      text += ": " + ffd->description;
    return text + (rule.where.empty() ? "" : ", " + rule.where) + ")";
  }

  void evaluate(int r, std::span<Vec3 const> points, std::span<Vec3> out) const {
    if (auto const shift = wall_shifts.find(r); shift != wall_shifts.end())
      shift->second.displacement(points, out);
    else
      evaluate_rule(r, points, out);
    if (auto const wall = carrying.find(r); wall != carrying.end()) wall->second->change(points, out);
  }

  void evaluate_rule(int r, std::span<Vec3 const> points, std::span<Vec3> out) const {
    Rule const& rule = rules[r].rule;
    if (std::holds_alternative<FixedRule>(rule) || std::holds_alternative<PrescribedRule>(rule)) {
      std::fill(out.begin(), out.end(), Vec3{});
    } else if (auto const* rigid = std::get_if<RigidRule>(&rule)) {
      at_each(points, out, [rigid](Vec3 const& p) { return gridmorph::displacement(*rigid, p); });
    } else if (auto const* function = std::get_if<FunctionRule>(&rule)) {
      if (second_plane.is_there()) {
        std::vector<Vec3> in_first(points.begin(), points.end());
        for (Vec3& p : in_first) p = second_plane.first(p);
        function->function(in_first, out);
      } else {
        function->function(points, out);
      }
    } else if (SectionMotion const* sections = sections_of_rule[r].get()) {
      at_each(points, out, [sections](Vec3 const& p) { return sections->displacement(p); });
    } else if (std::holds_alternative<TargetRule>(rule)) {
      targets.at(r)->displacement(points, out);
    } else if (std::holds_alternative<InflateRule>(rule)) {
      inflations.at(r).displacement(points, out);
    } else if (std::holds_alternative<FfdRule>(rule)) {
      lattices.at(r).displacement(points, out);
    } else if (std::holds_alternative<ExtendRule>(rule)) {
      extensions.at(r).displacement(points, out);
    } else if (std::holds_alternative<CarryRule>(rule)) {
      carried.at(r).displacement(points, out);
    } else if (std::holds_alternative<AttachedRule>(rule)) {
      AttachedMotion const& motion_of_walls = attached.at(r);
      at_each(points, out, [&](Vec3 const& p) { return motion_of_walls.displacement(p); });
    } else if (std::holds_alternative<WakeRule>(rule)) {
      WakeMotion const& wake = wakes.at(r);
      at_each(points, out, [&](Vec3 const& p) { return wake.displacement(p); });
    } else if (std::holds_alternative<ShockRule>(rule)) {
      ShockMotion const& shock = shocks.at(r);
      at_each(points, out, [&](Vec3 const& p) { return shock.displacement(p); });
    } else {
      RowMotion const& row = *row_of_rule[r];
      bool const slides = std::holds_alternative<CircumferentialSlideRule>(rule);
      at_each(points, out, [&](Vec3 const& p) { return slides ? row.slide(p) : row.follow(p); });
    }
    for (std::size_t n = 0; n < points.size(); ++n)
      if (!std::isfinite(out[n].x) || !std::isfinite(out[n].y) || !std::isfinite(out[n].z))
        throw MotionError(label(r) + " gives the point " + to_text(points[n], 9) + " the displacement " +
                          to_text(out[n], 9) +
                          ", which is not finite; correct the rule, or narrow "
                          "the patches it names");
  }
};

BoundaryMotion::BoundaryMotion(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BoundaryMotion::BoundaryMotion(std::shared_ptr<Boundary const> boundary, ResolvedMotion const& motion)
    : impl_(std::make_unique<Impl>(std::move(boundary), motion)) {}
BoundaryMotion::BoundaryMotion(Mesh const& mesh, ResolvedMotion const& motion)
    : BoundaryMotion(std::make_shared<Boundary const>(mesh), motion) {}
BoundaryMotion::~BoundaryMotion() = default;
BoundaryMotion::BoundaryMotion(BoundaryMotion&&) noexcept = default;
BoundaryMotion& BoundaryMotion::operator=(BoundaryMotion&&) noexcept = default;

bool BoundaryMotion::is_explicit(int rule) const { return impl_->is_explicit(rule); }

void BoundaryMotion::displacement(int rule, std::span<Vec3 const> points, std::span<Vec3> out) const {
  if (!is_explicit(rule))
    throw MotionError(impl_->label(rule) + " is left to the volume stage and has no displacement of its own");
  if (points.size() != out.size())
    throw MotionError(impl_->label(rule) + ": " + std::to_string(points.size()) + " points but room for " +
                      std::to_string(out.size()) + " displacements");
  impl_->evaluate(rule, points, out);
}

BoundaryMotion BoundaryMotion::with(Motion const& motion) const {
  return BoundaryMotion(std::make_unique<Impl>(*impl_, motion));
}

Boundary const& BoundaryMotion::boundary() const { return *impl_->boundary; }
std::shared_ptr<Boundary const> const& BoundaryMotion::shared_boundary() const { return impl_->boundary; }
ResolvedMotion const& BoundaryMotion::motion() const { return impl_->motion; }

std::vector<SlipSurface> const& BoundaryMotion::slip_surfaces() const { return impl_->slip->surfaces; }
int BoundaryMotion::slip_surface_of(int patch) const { return impl_->slip->of_patch[patch]; }

void BoundaryMotion::each_slip_surface(int patch,
                                       std::function<void(int, std::vector<Index> const&)> const& visit) const {
  if (auto const pieces = impl_->slip->pieces.find(patch); pieces != impl_->slip->pieces.end()) {
    for (SlipPiece const& piece : pieces->second) visit(piece.surface, piece.nodes);
  } else if (int const s = slip_surface_of(patch); s >= 0) {
    visit(s, impl_->boundary->surface(patch).nodes);
  }
}

SlipSurface const* BoundaryMotion::slip_surface(int patch) const {
  int const s = slip_surface_of(patch);
  return s < 0 ? nullptr : &slip_surfaces()[s];
}

bool BoundaryMotion::slides_upstream(int rule, Vec3 const& point) const {
  RowMotion const* row = impl_->row_of_rule[rule];
  return row != nullptr && row->is_upstream(point);
}

CylindricalFrame const* BoundaryMotion::row_frame(int rule) const {
  RowMotion const* row = impl_->row_of_rule[rule];
  return row == nullptr ? nullptr : &row->frame();
}

bool BoundaryMotion::gives_way(int rule, int patch) const {
  RowMotion const* row = impl_->row_of_rule[rule];
  return row != nullptr && patch >= 0 && row->gives_way_to(patch);
}

FfdMotion const* BoundaryMotion::lattice(int rule) const {
  auto const found = impl_->lattices.find(rule);
  return found == impl_->lattices.end() ? nullptr : &found->second;
}

bool BoundaryMotion::alone(int rule) const {
  return impl_->wall_shifts.count(rule) == 0 && impl_->carrying.count(rule) == 0;
}

std::vector<TargetReach> BoundaryMotion::target_reach(Coordinates const& morphed) const {
  std::vector<TargetReach> out;
  for (auto const& [rule, target] : impl_->targets)
    if (target->whole()) out.push_back(target->reach(morphed));
  return out;
}

std::vector<std::string> const& BoundaryMotion::notes() const { return impl_->notes; }

}  // namespace gridmorph
