// Meshes made in memory, one of each kind of topology.
#include "invariants/cases.hpp"

#include <algorithm>
#include <utility>

namespace gridmorph::test {
namespace {

PlanOptions layers(int n, std::vector<std::string> walls = {}) {
  PlanOptions options;
  BoundaryLayer layer;
  layer.walls = std::move(walls);
  layer.extent = BoundaryLayer::Extent::layers;
  layer.layers = n;
  options.boundary_layers = {layer};
  return options;
}

PlanOptions law(Law l, PlanOptions options = {}) {
  options.volume.law = l;
  options.volume.own_law = {[](double t) { return t * (1.25 - 0.25 * t * t); }, "steep"};
  return options;
}

PlanOptions laws(std::vector<LawOfEnds> of_ends, PlanOptions options) {
  options.volume.laws = std::move(of_ends);
  return options;
}

/// Rules with a field on some families, fixed on others, free on the rest.
std::function<Motion(double)> moves(VectorField field, std::vector<std::string> moving,
                                    std::vector<std::string> fixed = {}, std::vector<std::string> free = {}) {
  return [=](double factor) {
    std::vector<MotionRule> rules{rule(moving, function_rule(scaled(factor, field)))};
    if (!fixed.empty()) rules.push_back(rule(fixed, FixedRule{}));
    if (!free.empty()) rules.push_back(rule(free, FreeRule{}));
    return motion(std::move(rules));
  };
}

/// One end of a straight box moves, tangentially where it meets the sides, on which nodes slip.
std::function<Motion(double)> on_planes(SlipRule const& sides) {
  return [=](double f) {
    VectorField const field = scaled(f, waves(0.1));
    return motion({rule({"u_min"}, function_rule([=](Vec3 const& p) {
                          Vec3 const u = field(p);
                          return Vec3{u.x, p.y * (1 - p.y) * u.y, p.z * (1.2 - p.z) * u.z};
                        })),
                   rule({"u_max"}, FixedRule{}), rule({"v_min", "v_max"}, sides), rule({"w_min", "w_max"}, sides)});
  };
}

/// The cells of some ranges of nodes, however the mesh is stored.
InnerRegion region(Mesh const& mesh, std::vector<std::pair<int, IndexRange>> const& ranges) {
  std::vector<Vec3> centres;
  for (auto const& [z, range] : ranges)
    for (int k = range.begin[2]; k + 1 < range.end[2]; ++k)
      for (int j = range.begin[1]; j + 1 < range.end[1]; ++j)
        for (int i = range.begin[0]; i + 1 < range.end[0]; ++i) {
          Vec3 sum;
          for (int c = 0; c < 8; ++c)
            sum += mesh.coordinates[mesh.zones[z].node({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)})];
          centres.push_back(0.125 * sum);
        }
  InnerRegion out;
  out.name = "part";
  out.holds = [centres = std::move(centres)](Vec3 const& p) {
    return std::any_of(centres.begin(), centres.end(), [&](Vec3 const& c) { return distance(p, c) < 1e-9; });
  };
  return out;
}

/// The motion, and a rule for the cells of some ranges of nodes.
std::function<Motion(double)> with_region(std::function<Motion(double)> motion, std::function<Mesh()> mesh,
                                          std::vector<std::pair<int, IndexRange>> ranges,
                                          std::function<Rule(double)> rule_of) {
  return [=](double factor) {
    Motion out = motion(factor);
    out.regions = {region(mesh(), ranges)};
    out.rules.push_back(rule({"part"}, rule_of(factor), 1));
    return out;
  };
}

/// As with_region(), by a field.
std::function<Rule(double)> by(VectorField field) {
  return [=](double factor) { return Rule(function_rule(scaled(factor, field))); };
}

std::function<Rule(double)> attached(std::string const& wall, AttachedRule::How how) {
  return [=](double) { return Rule(AttachedRule{{wall}, how}); };
}

}  // namespace

std::vector<Case> make_cases() {
  Index3 const n{8, 7, 6};
  Sector const sector;
  Sector wedge;
  wedge.inner_radius = 0;
  Sector const about_z{{}, {0, 0, 1}, 5, 0, false};
  Vec3 const axial = (0.4 / norm(sector.axis)) * sector.axis;
  std::vector<std::string> const sides{"v_min", "v_max", "w_min", "w_max"};
  std::vector<Case> list{
      {"box_all_faces", [=] { return box(n, Shape::curved, 1); }, moves(waves(0.1), {"*"}), {}},
      {"box_one_face", [=] { return box(n, Shape::curved, 2); }, moves(waves(0.1), {"u_min"}, {"u_max"}, sides),
       law(Law::c1, layers(2))},
      {"box_on_planes", [=] { return box(n, Shape::straight, 3); }, on_planes(SlipRule{}), {}},
      {"box_on_its_own_sides",
       [=] { return box(n, Shape::straight, 3); },
       on_planes(SlipRule{SlipRule::Surface::baseline}),
       {}},
      {"bricks_all_faces", [] { return bricks_with_t_junctions(4); }, moves(waves(0.1), {"*"}), {}},
      {"bricks_one_face", [] { return bricks_with_t_junctions(5); }, moves(waves(0.1), {"u_min"}, {"u_max"}, sides),
       layers(4, {"u_min"})},
      {"bricks_matched", [] { return bricks_with_t_junctions(5); }, moves(waves(0.1), {"u_min"}, {"u_max"}, sides),
       law(Law::matched, layers(4, {"u_min"}))},
      {"around_a_box_mixed", [] { return around_a_box(7); },
       moves(turn_about_z({1.2, 0.6, 0}, 0.1), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
       law(Law::mixed, layers(1))},
      {"around_a_box_laws_by_kind", [] { return around_a_box(7); },
       moves(turn_about_z({1.2, 0.6, 0}, 0.1), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
       laws({{{"wall", "inflow"}, Law::matched}, {{"wall", "outflow"}, Law::c2}}, layers(1))},
      {"around_a_box_own_laws", [] { return around_a_box(7); },
       moves(turn_about_z({1.2, 0.6, 0}, 0.1), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
       laws({{{"u_min", "step"}, Law::own, {[](double t) { return t * t; }, "square"}}}, law(Law::own, layers(1)))},
      {"l_shape", [] { return l_shape(6); },
       moves(waves(0.05), {"step"}, {"u_min", "v_min"}, {"u_max", "v_max", "w_min", "w_max"}), law(Law::c2)},
      {"around_a_box", [] { return around_a_box(7); },
       moves(turn_about_z({1.2, 0.6, 0}, 0.1), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
       layers(1)},
      {"around_a_box_plain",
       [] { return around_a_box(8); },
       moves(turn_about_z({1.2, 0.6, 0}, 0.1), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
       {}},
      {"star3", [] { return star(3, 9); }, moves(waves(0.05), {"rim"}, {}, {"front", "back"}), {}},
      {"star5", [] { return star(5, 10); }, moves(waves(0.05), {"rim"}, {}, {"front", "back"}), {}},
      {"star5_all_faces", [] { return star(5, 11); }, moves(waves(0.05), {"*"}), {}},
      {"o_grid", [] { return o_grid(0.8, 12); }, moves(turn_about_z({0.1, 0, 0}, 0.2), {"body"}, {"far"}), layers(2)},
      {"o_grid_all_faces", [] { return o_grid(0.8, 13); }, moves(waves(0.1), {"*"}), {}, {0.3, -0.7, 0.2}, {"*"}, true},
      {"pole",
       [] { return o_grid(0, 14); },
       moves(
           [](Vec3 const& p) {
             return Vec3{0.1 + 0.1 * p.z, -0.05 * p.z * p.z, 0};
           },
           {"pole"}, {"far"}),
       {}},
      {"c_grid", [] { return c_grid(15); }, moves(turn_about_z({0.3, 0, 0}, 0.1), {"body"}, {"far"}, {"exit"}),
       layers(2)},
      {"c_grid_all_faces", [] { return c_grid(16); }, moves(waves(0.05), {"*"}), {}},
      {"sector",
       [=] { return annulus_sector(sector, 17); },
       moves(turning_waves(sector, 0.1), {"hub"}, {"case"}, {"inlet", "outlet"}),
       layers(2),
       axial,
       {"hub", "case", "inlet", "outlet"}},
      {"sector_all_faces",
       [=] { return annulus_sector(sector, 18); },
       moves(turning_waves(sector, 0.1), {"hub", "case", "inlet", "outlet"}),
       {},
       axial,
       {"hub", "case", "inlet", "outlet"}},
      {"sector_known_periodic",
       [=] { return annulus_sector(sector, 19); },
       moves(turning_waves(sector, 0.1), {"*", "type:periodic"}),
       {},
       axial},
      {"bend_on_its_walls",
       [=] { return bend_sector(sector, 24); },
       [=](double f) {
         VectorField const turn = [=](Vec3 const& p) {
           Vec3 const q = sector_coordinates(sector, p);  // keeps to hub and case
           return sector_position(sector, q.x, q.y, q.z + f * 0.1 * (1 + q.x - 0.5 * q.y)) - p;
         };
         Motion m =
             motion({rule({"inlet", "outlet"}, function_rule([=](Vec3 const& p) { return f == 0 ? Vec3{} : turn(p); })),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
         m.axis = {sector.origin, sector.axis};
         return m;
       },
       {},
       axial,
       {"hub", "case", "inlet", "outlet"}},
      {"wedge",
       [=] { return annulus_sector(wedge, 20); },
       moves(turning_waves(wedge, 0.1), {"case", "inlet", "outlet", "pole"}),
       {},
       axial,
       {"case", "inlet", "outlet", "pole"}},
      {"star_sector",
       [] { return star_sector(5, 23); },
       moves(turning_waves(about_z, 0.1), {"rim", "front", "back"}),
       {},
       {0, 0, 0.4},
       {"rim", "front", "back"}},
      {"translational",
       [] { return translational(1, 21); },
       moves(layered_waves(0.1), {"bottom"}, {"top"}, {"side"}),
       layers(2, {"bottom"}),
       {0.3, -0.7, 0.2},
       {"bottom", "top", "side"}},
      {"box_with_a_region",
       [=] { return box(n, Shape::straight, 3); },
       with_region(
           on_planes(SlipRule{}), [=] { return box(n, Shape::straight, 3); }, {{0, {{2, 2, 2}, {6, 6, 5}}}},
           by(waves(0.05))),
       {}},
      {"bricks_with_a_region",
       [] { return bricks_with_t_junctions(4); },
       with_region(
           moves(waves(0.1), {"*"}), [] { return bricks_with_t_junctions(4); },
           {{0, {{1, 1, 1}, {4, 4, 4}}}, {2, {{0, 0, 1}, {3, 2, 4}}}}, by(waves(0.1))),
       {}},
      {"around_a_box_with_a_region", [] { return around_a_box(7); },
       with_region(
           moves(turn_about_z({1.2, 0.6, 0}, 0.05), {"step"}, {"u_min", "u_max", "v_min", "v_max"}, {"w_min", "w_max"}),
           [] { return around_a_box(7); }, {{4, {{2, 1, 0}, {4, 4, 4}}}}, attached("step", AttachedRule::How::rigid)),
       layers(1)},
      {"o_grid_with_a_region", [] { return o_grid(0.8, 12); },
       with_region(
           moves(turn_about_z({0.1, 0, 0}, 0.1), {"body"}, {"far"}), [] { return o_grid(0.8, 12); },
           {{0, {{0, 1, 0}, {3, 4, 4}}}, {0, {{11, 1, 0}, {13, 4, 4}}}}, by(turn_about_z({0.1, 0, 0}, 0.07))),
       layers(2)},
      {"c_grid_with_a_region", [] { return c_grid(15); },
       with_region(
           moves(turn_about_z({0.3, 0, 0}, 0.05), {"body"}, {"far"}, {"exit"}), [] { return c_grid(15); },
           {{0, {{1, 0, 0}, {4, 3, 4}}}, {0, {{13, 0, 0}, {16, 3, 4}}}}, attached("body", AttachedRule::How::nearest)),
       layers(2)},
      {"sector_with_a_region",
       [=] { return annulus_sector(sector, 17); },
       with_region(
           moves(turning_waves(sector, 0.1), {"hub"}, {"case"}, {"inlet", "outlet"}),
           [=] { return annulus_sector(sector, 17); }, {{0, {{2, 3, 0}, {5, 5, 3}}}}, by(turning_waves(sector, 0.05))),
       layers(2),
       axial,
       {"hub", "case", "inlet", "outlet"}},
      {"translational_twice",
       [] { return translational(2, 22); },
       moves(layered_waves(0.1), {"bottom"}, {"top"}),
       {},
       {0.3, -0.7, 0.2},
       {"bottom", "top"}},
  };
  // Near fields are what cases say, and in these what there is by default.
  for (char const* name : {"bricks_one_face", "around_a_box", "o_grid", "sector"}) {
    Case plain = *std::find_if(list.begin(), list.end(), [&](Case const& c) { return c.name == name; });
    plain.name += "_default";
    plain.options.boundary_layers = {BoundaryLayer{}};
    list.push_back(std::move(plain));
  }
  for (Case& c : list)
    if (c.options.boundary_layers.empty()) c.options.default_boundary_layer = false;
  // The same with near fields that turn, and hand on some of their turn.
  for (std::size_t n = 0, count = list.size(); n < count; ++n) {
    if (list[n].options.boundary_layers.empty()) continue;
    Case turned = list[n];
    turned.name += "_turned";
    for (BoundaryLayer& layer : turned.options.boundary_layers) layer.mode = BoundaryLayer::Mode::rotate;
    turned.options.volume.turn = 0.4;
    list.push_back(std::move(turned));
  }
  return list;
}

}  // namespace gridmorph::test
