// Meshes of real size and shape: the demo passage, and meshes from outside with a motion each.
#include "invariants/cases.hpp"
#include "support/reduced.hpp"
#include "support/shared_mesh.hpp"

#include <generators/aircraft.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>

namespace gridmorph::test {
namespace {

PassageOptions passage_options(PassageOptions::Layout layout, bool left_handed, BladeTip tip = BladeTip::none) {
  PassageOptions o;
  o.nodes = 10'000;
  o.tip = tip;
  o.layout = layout;
  o.left_handed = left_handed;
  o.placement = rotation_about({0.1, 0.2, -0.3}, {1, -2, 0.5}, 0.8);
  return o;
}

Case passage(std::string name, PassageOptions const& options, PassageMotion const& move) {
  Case c;
  c.name = std::move(name);
  c.mesh = [=] { return make_passage(options); };
  c.motion = [=](double factor) {
    Motion m = motion(
        {rule(blade_families(options.tip),
              function_rule(scaled(factor, [=](Vec3 const& p) { return passage_displacement(options, move, p); }))),
         rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}), rule({"type:periodic"}, FollowRule{{"blade"}}),
         rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
    m.axis = {options.placement.translation, options.placement.rotation * Vec3{1, 0, 0}};
    return m;
  };
  c.options.boundary_layers = {{{"blade"}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::translate}};
  c.translation = 0.37 * (options.placement.rotation * Vec3{1, 0, 0});
  c.all_patches = blade_families(options.tip);
  for (char const* other : {"inlet", "outlet", "hub", "case"}) c.all_patches.emplace_back(other);
  return c;
}

/// Blade given, inlet free to slide and to deform in its plane, periodics free as one: the implicit surface morph.
Case passage_with_free_surfaces() {
  PassageOptions const options = passage_options(PassageOptions::Layout::whole_faces, false);
  PassageMotion const move = rotated_sections();
  Case c = passage("passage_free_surfaces", options, move);
  c.motion = [=](double factor) {
    Motion m = motion(
        {rule({"blade"},
              function_rule(scaled(factor, [=](Vec3 const& p) { return passage_displacement(options, move, p); }))),
         rule({"inlet"}, FreeRule{FreeRule::Constraint::axial}),
         rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
    m.axis = {options.placement.translation, options.placement.rotation * Vec3{1, 0, 0}};
    return m;
  };
  return c;
}

/// An aircraft in 628 zones: the wing bends, its tail plane twists, the nacelle goes along.
Case aircraft() {
  Case c;
  c.name = "aircraft";
  c.mesh = [] {
    AircraftOptions options;
    options.nodes = 100'000;
    options.first_cell = 1e-3;
    return make_aircraft(options);
  };
  c.motion = [](double factor) {
    VectorField const bend = [](Vec3 const& p) {
      double const t = std::max(p.y - 2.2, 0.0) / 15;
      return Vec3{0, -0.1 * (p.z + 0.7) * t, 0.8 * t * t};
    };
    VectorField const trim = [](Vec3 const& p) {
      return rotation_about({33.5, 0, 0.8}, {0, 1, 0}, -0.02 * std::max(p.y - 1.4, 0.0))(p) - p;
    };
    AttachedRule carried;
    carried.of = {"wing"};
    return motion({rule({"wing", "aileron"}, function_rule(scaled(factor, bend))),
                   rule({"htail"}, function_rule(scaled(factor, trim))), rule({"nacelle"}, carried),
                   rule({"fuselage"}, SlipRule{SlipRule::Surface::baseline, {}, {}}), rule({"symmetry"}, SlipRule{})});
  };
  c.options.boundary_layers = {
      {{"wing", "aileron", "nacelle", "htail"}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::rotate}};
  return c;
}

/// Motion about an axis of rotation, the same in every passage: radius kept.
VectorField twist(Vec3 const& axis, double angle_rad) {
  return [=](Vec3 const& p) {
    double const along = dot(p, axis), radius = norm(p - along * axis);
    return rotation_about({}, axis, angle_rad * (1 + std::sin(20 * along) * std::cos(10 * radius)))(p) - p;
  };
}

Case from_file(std::string name, std::string file, std::vector<std::string> families,
               std::function<Motion(double)> motion) {
  Case c;
  c.name = std::move(name);
  c.file = shared_mesh(file);
  c.mesh = [path = c.file] {
    Mesh mesh = read_mesh(path);
    // Where BC names repeat, the zone tells them apart.
    for (Patch& p : mesh.patches)
      if (p.families.empty()) p.families = {mesh.zones[p.zone].name + "/" + p.name};
    return mesh;
  };
  c.motion = std::move(motion);
  c.all_patches = std::move(families);
  return c;
}

BoundaryLayer layers(std::vector<std::string> walls, int n) {
  return {std::move(walls), BoundaryLayer::Extent::layers, n, 0, BoundaryLayer::Mode::translate};
}

Case machine(std::string name, std::string const& file, Vec3 const& axis, std::vector<std::string> blades,
             Rule const& planes) {
  std::vector<std::string> all{"HUB", "SHROUD", "INLET", "OUTLET", "MIXING"};
  all.insert(all.end(), blades.begin(), blades.end());
  Case c = from_file(std::move(name), file, all, [=](double factor) {
    Motion m = motion({rule(blades, function_rule(scaled(factor, twist(axis, 0.01)))),
                       rule({"INLET", "OUTLET", "MIXING"}, planes),
                       rule({"HUB", "SHROUD"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
    m.axis.direction = axis;
    return m;
  });
  c.translation = 0.3 * axis;
  return c;
}

}  // namespace

std::vector<Case> make_cases() {
  using Layout = PassageOptions::Layout;
  std::vector<Case> list{
      passage("passage", passage_options(Layout::whole_faces, false), rotated_sections()),
      passage("passage_left_handed", passage_options(Layout::five_zones, true), chord_redesign()),
      passage("passage_squealer", passage_options(Layout::whole_faces, false, BladeTip::squealer), rotated_sections()),
      passage_with_free_surfaces(),
      machine("turbine_stage", "axial_turbine_stage_H.cgns", {1, 0, 0}, {"BLADE1", "BLADE2"}, FixedRule{}),
      machine("turbine_stage_free_planes", "axial_turbine_stage_H.cgns", {1, 0, 0}, {"BLADE1", "BLADE2"},
              FreeRule{FreeRule::Constraint::axial}),
  };
  if (!reduced()) {
    list.push_back(
        passage("passage_flat_tip", passage_options(Layout::five_zones, true, BladeTip::flat), gap_halved()));
    list.push_back(passage("passage_groove", passage_options(Layout::five_zones, false, BladeTip::groove),
                           {"turned", -6, {{0.5, 1.04}}, 0.5}));
  }
  // The stand-in, and what it stands in for where that is there.
  for (auto const& [name, file] : {std::pair("water_turbine", "water_turbine.cgns"),
                                   std::pair("water_turbine_of_others", "axialTurbine_7blk.cgns")})
    if (!shared_mesh(file).empty())
      list.push_back(machine(name, file, {0, 0, 1}, {"BLADE_GV", "BLADE_RU"}, FixedRule{}));
  std::string const slat = "Zone   3/Klo*";
  for (auto const& [name, file] :
       {std::pair("airfoil_with_slat", "slotted_airfoil.cgns"), std::pair("airfoil_of_others", "multi.cgns")}) {
    if (shared_mesh(file).empty()) continue;
    list.push_back(from_file(name, file, {"*"}, [=](double factor) {
      VectorField const turn = [](Vec3 const& p) { return rotation_about({}, {0, 1, 0}, -0.1)(p) - p; };
      return motion({rule({slat}, function_rule(scaled(factor, turn))), rule({"*/Ilo*", "*/Ihi*"}, SlipRule{})});
    }));
    list.back().options.boundary_layers = {{{slat}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::translate},
                                           layers({"Zone   1/Klo*", "Zone   2/Klo*"}, 16)};
  }
  auto const bent = [](std::string const& wall) {
    return [=](double factor) {
      return motion({rule({wall}, function_rule(scaled(factor, [](Vec3 const& p) {
                            return Vec3{0, 0.004 * p.z * p.z, -0.0005 * p.y * p.z};
                          })))});
    };
  };
  list.push_back(aircraft());
  list.push_back(from_file("wing", "mdo_tutorial_000_vol.cgns", {"*"}, bent("wall")));
  list.push_back(from_file("winglet", "717_wl_L2.cgns", {"*"}, bent("wall")));
  list.back().options.boundary_layers = {layers({"wall"}, 4)};
  for (std::string const name : {"passage", "passage_left_handed", "turbine_stage", "wing", "winglet"}) {
    Case turned = *std::find_if(list.begin(), list.end(), [&](Case const& c) { return c.name == name; });
    turned.name += "_turned";
    if (turned.options.boundary_layers.empty()) turned.options.boundary_layers = {layers({}, 4)};
    for (BoundaryLayer& layer : turned.options.boundary_layers) layer.mode = BoundaryLayer::Mode::rotate;
    list.push_back(std::move(turned));
  }
  for (Case& c : list)
    if (c.options.boundary_layers.empty()) c.options.default_boundary_layer = false;
  return list;
}

}  // namespace gridmorph::test
