// How the library behaves inside a program that profiles it: labels, allocations, fences, instances.
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/guard/guard.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

namespace hooks = Kokkos::Tools::Experimental;

/// What Kokkos reported while a Listener was alive.
struct Record {
  std::vector<std::string> kernels, allocations, fences, copies, regions;
  std::vector<std::uint32_t> devices;  ///< and instances, of the kernels
  int open_regions = 0;
};
Record record;

void on_kernel(char const* name, uint32_t device, uint64_t*) {
  record.kernels.emplace_back(name);
  record.devices.push_back(device);
}
void on_region(char const* name) {
  record.regions.emplace_back(name);
  ++record.open_regions;
}
void on_region_end() { --record.open_regions; }
void on_allocation(Kokkos_Profiling_SpaceHandle const, char const* name, void const*, uint64_t const) {
  record.allocations.emplace_back(name);
}
void on_fence(char const* name, uint32_t const, uint64_t*) { record.fences.emplace_back(name); }
void on_copy(Kokkos_Profiling_SpaceHandle, char const* to, void const*, Kokkos_Profiling_SpaceHandle, char const* from,
             void const*, uint64_t) {
  record.copies.push_back(std::string(to) + " <- " + from);
}

class Listener {
 public:
  Listener() {
    record = {};
    hooks::set_begin_parallel_for_callback(on_kernel);
    hooks::set_begin_parallel_reduce_callback(on_kernel);
    hooks::set_begin_parallel_scan_callback(on_kernel);
    hooks::set_allocate_data_callback(on_allocation);
    hooks::set_begin_fence_callback(on_fence);
    hooks::set_begin_deep_copy_callback(on_copy);
    hooks::set_push_region_callback(on_region);
    hooks::set_pop_region_callback(on_region_end);
  }
  ~Listener() {
    hooks::set_begin_parallel_for_callback(nullptr);
    hooks::set_begin_parallel_reduce_callback(nullptr);
    hooks::set_begin_parallel_scan_callback(nullptr);
    hooks::set_allocate_data_callback(nullptr);
    hooks::set_begin_fence_callback(nullptr);
    hooks::set_begin_deep_copy_callback(nullptr);
    hooks::set_push_region_callback(nullptr);
    hooks::set_pop_region_callback(nullptr);
  }
  Listener(Listener const&) = delete;
  Listener& operator=(Listener const&) = delete;
};

/// Kokkos itself fences around kernels while a tool listens.
bool is_profiling_fence(std::string const& name) { return name.find("Profile") != std::string::npos; }

void expect_labels(std::vector<std::string> const& names) {
  std::regex const pattern("^(gridmorph::|Kokkos::).+");
  for (auto const& name : names) EXPECT_TRUE(std::regex_match(name, pattern)) << "'" << name << "'";
}

using Exec = Kokkos::DefaultExecutionSpace;
using Memory = Exec::memory_space;

/// A morph with every kind of kernel: near field, sweeps, corrections, copies, periodic turns, slip surfaces.
class Manners : public ::testing::Test {
 protected:
  static Sector sector() { return {}; }
  Mesh mesh = annulus_sector(sector(), 1);
  MorphPlan plan = [this] {
    PlanOptions options;
    options.boundary_layers = {{{"hub"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
    Motion m = motion({rule({"hub", "case", "inlet"}, function_rule(turning_waves(sector(), 0.05))),
                       rule({"outlet"}, FreeRule{FreeRule::Constraint::axial})});
    m.axis = {sector().origin, sector().axis};
    return PlanAccess::of(prepare(mesh, m, options));
  }();
  PreparedMorph const& prepared = *PlanAccess::blocks(plan);
  Exec exec;
  Kokkos::View<Vec3*, Memory> boundary = upload<Memory>(prepared.boundary_displacement());
  DeviceField<Memory> x{mesh.coordinates}, u{Coordinates(mesh.n_nodes())};
  std::vector<Morpher<Exec>::In> two_in{boundary, boundary};
  std::vector<Morpher<Exec>::Out> two_out{u, u};
};

TEST_F(Manners, EveryAllocationAndKernelOfTheLibraryHasItsLabel) {
  Listener const listener;
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true});
  morpher.displacements(exec, boundary, u);
  morpher.positions(exec, boundary, u);
  exec.fence();
  EXPECT_GE(record.kernels.size(), 8u);
  EXPECT_GE(record.allocations.size(), 8u);
  expect_labels(record.kernels);
  expect_labels(record.allocations);
  for (char const* kernel : {"gridmorph::boundary", "gridmorph::chain_ends", "gridmorph::side_residual",
                             "gridmorph::skeleton_sweep", "gridmorph::skeleton_spread", "gridmorph::slip_ends",
                             "gridmorph::skeleton_nodes", "gridmorph::volume", "gridmorph::line_parameters"})
    EXPECT_NE(std::find(record.kernels.begin(), record.kernels.end(), kernel), record.kernels.end()) << kernel;
}

/// Nodes of slip surfaces and inner ones, moved by something.
TEST_F(Manners, AFrozenGuardAddsKernelsAndNothingElse) {
  std::vector<Vec3> const given = prepared.boundary_displacement();
  Coordinates plain(mesh.n_nodes()), guarded(mesh.n_nodes());
  apply_on_host(MorpherAccess::of(Kokkos::DefaultHostExecutionSpace(), prepared.plan(), mesh.coordinates), given,
                plain);
  for (Index n = 0; n < plain.size(); ++n) guarded.set(n, plain[n] + Vec3{1e-3, 0, 0});
  SmoothingRecord smoothing(plan);
  smoothing.add(given, plain, guarded);
  Listener const made;
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true, smoothing.map()});
  exec.fence();
  expect_labels(record.allocations);
  std::vector<std::string> first;
  for (int n = 0; n < 2; ++n) {
    Listener const listener;
    record = {};
    morpher.displacements(exec, two_in, two_out);
    morpher.positions(exec, boundary, u);
    morpher.velocities(exec, boundary, boundary, u);
    EXPECT_EQ(record.allocations, std::vector<std::string>());
    EXPECT_EQ(record.copies, std::vector<std::string>());
    for (auto const& fence : record.fences) EXPECT_TRUE(is_profiling_fence(fence)) << fence;
    expect_labels(record.kernels);
    EXPECT_NE(std::find(record.kernels.begin(), record.kernels.end(), "gridmorph::frozen_shifts::add"),
              record.kernels.end());
    if (n == 0) first = record.kernels;
    EXPECT_EQ(record.kernels, first);
    Kokkos::deep_copy(boundary, Vec3{});
  }
}

TEST_F(Manners, MorphingAllocatesNothingCopiesNothingAndDoesNotFence) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true});
  exec.fence();
  {
    Listener const listener;
    morpher.displacements(exec, boundary, u);
    morpher.positions(exec, boundary, u);
    morpher.velocities(exec, boundary, boundary, u);
    morpher.displacements(exec, two_in, two_out);
  }
  EXPECT_EQ(record.allocations, std::vector<std::string>());
  EXPECT_EQ(record.copies, std::vector<std::string>());
  for (auto const& fence : record.fences) EXPECT_TRUE(is_profiling_fence(fence)) << fence;
  EXPECT_FALSE(record.kernels.empty());
}

/// A list of another length than the plan wants is refused with both numbers, before any kernel.
template <class Call>
void expect_refused(std::size_t given, std::size_t needed, char const* list, Call const& call) {
  Listener const listener;
  expect_all_in(message_of<ConfigError>(call),
                {"has " + std::to_string(given) + " entries", std::to_string(needed) + " boundary nodes", list});
  EXPECT_TRUE(record.kernels.empty());
}

TEST_F(Manners, BoundaryDisplacementsOfAnotherLengthAreRefused) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true});
  std::size_t const n = boundary.extent(0);
  for (std::size_t const other : {std::size_t(0), n - 1, n + 1}) {
    Kokkos::View<Vec3*, Memory> const list("gridmorph::test::list", other);
    std::vector<Morpher<Exec>::In> const lists{boundary, list};
    auto const refused = [&](auto const& call) { expect_refused(other, n, "MorphPlan::boundary_nodes()", call); };
    refused([&] { morpher.positions(exec, list, u); });
    refused([&] { morpher.displacements(exec, list, u); });
    refused([&] { morpher.displacements(exec, lists, two_out); });
    refused([&] { morpher.velocities(exec, list, boundary, u); });
    refused([&] { morpher.velocities(exec, boundary, list, u); });
  }
}

TEST_F(Manners, MeshesWithoutAllTheirCoordinatesAreRefused) {
  auto const refused = [](Mesh& m, std::initializer_list<std::string_view> words) {
    expect_all_in(message_of<MeshError>([&] { (void)prepare(m, motion({rule({"*"}, FixedRule{})}), PlanOptions{}); }),
                  words);
  };
  std::string const n = std::to_string(mesh.n_nodes()) + " nodes";
  mesh.coordinates.z = {};
  refused(mesh, {n, "for " + std::to_string(mesh.n_nodes()) + " (x)", " 0 (z)"});
  mesh.coordinates = Coordinates(mesh.n_nodes() - 1);
  refused(mesh, {n, std::to_string(mesh.n_nodes() - 1) + " (y)"});
  mesh.coordinates = {};
  refused(mesh, {n, "0 (x)", "set coordinates"});
  Mesh nothing;
  refused(nothing, {"no zones"});
}

TEST_F(Manners, StagesAreRegionsOfProfiles) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true});
  Listener const listener;
  morpher.positions(exec, boundary, u);
  // Stages that are launched together are one region, which names them.
  std::vector<std::string> expected{"gridmorph::stage boundary"};
  std::string const stage = "gridmorph::stage ";
  for (Stage const& s : prepared.plan().stages) expected.push_back(stage + s.name);
  std::vector<std::string> found;
  for (std::string const& region : record.regions) {
    std::string rest = region;
    for (auto at = rest.find(", "); at != std::string::npos && rest.starts_with(stage); at = rest.find(", ")) {
      found.push_back(rest.substr(0, at));
      rest = stage + rest.substr(at + 2);
    }
    found.push_back(rest);
  }
  for (std::size_t n = 0; n < prepared.plan().spreads.size(); ++n) expected.emplace_back("gridmorph::slip surfaces");
  expected.emplace_back("gridmorph::all nodes");
  EXPECT_EQ(found, expected);
  EXPECT_EQ(record.open_regions, 0);
}

#ifdef KOKKOS_ENABLE_SERIAL
/// Serial is not the default space where there is another: what is launched on the default instance shows.
TEST_F(Manners, EverythingRunsOnTheInstanceThatIsHandedOver) {
  Kokkos::Serial const other;
  Coordinates const moved(mesh.n_nodes());
  std::vector<Vec3> const given = prepared.boundary_displacement();
  Kokkos::View<Vec3 const*, Kokkos::HostSpace> const host_boundary(given.data(), given.size());
  Listener const listener;
  auto const morpher = MorpherAccess::of(other, prepared.plan(), mesh.coordinates, {2, true});
  morpher.positions(other, host_boundary, moved);
  morpher.displacements(other, host_boundary, moved);
  morpher.velocities(other, host_boundary, host_boundary, moved);
  EXPECT_FALSE(record.devices.empty());
  for (std::size_t n = 0; n < record.devices.size(); ++n)
    EXPECT_EQ(record.devices[n], hooks::device_id(other)) << record.kernels[n];
}
#endif

TEST_F(Manners, EveryMorphRunsTheSameKernels) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x, {2, true});
  std::vector<std::string> first;
  for (int n = 0; n < 3; ++n) {
    Listener const listener;
    morpher.displacements(exec, boundary, u);
    if (n == 0) first = record.kernels;
    EXPECT_EQ(record.kernels, first);
    Kokkos::deep_copy(boundary, Vec3{});
  }
}

TEST_F(Manners, PlanningASmallMeshLaunchesOnlyWhatReadsAllOfItAndWhatConnectsItsZones) {
  Listener const listener;
  Mesh const again = annulus_sector(sector(), 1);
  record = {};
  Motion const m =
      motion({rule({"hub"}, FixedRule{}), rule({"case"}, FixedRule{}), rule({"inlet", "outlet"}, FreeRule{})});
  PreparedMorph const p = prepare(again, m, {});
  EXPECT_FALSE(p.boundary_displacement().empty());
  for (auto const& kernel : record.kernels)
    EXPECT_TRUE(kernel == "gridmorph::extent_of" || kernel == "gridmorph::largest_cosines" ||
                kernel == "gridmorph::connect")
        << kernel;
}

#ifdef KOKKOS_ENABLE_SERIAL
/// What Kokkos launches on its default space, whatever the instance: copies of long lists of the host, and the end of
/// Views.
bool is_of_kokkos(std::string const& kernel) {
  return kernel.find("Kokkos::Impl::host_space_deepcopy") == 0 || kernel.find("Kokkos::View::destruction") == 0;
}

/// As below: Serial is not the default space where there is another.
void expect_planned_on_serial(Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  Kokkos::Serial const other;
  Listener const listener;
  MorphPlan const plan(other, mesh, motion, options);
  (void)morph(other, mesh, motion, options);
  EXPECT_FALSE(record.devices.empty());
  for (std::size_t n = 0; n < record.devices.size(); ++n)
    if (!is_of_kokkos(record.kernels[n])) {
      EXPECT_EQ(record.devices[n], hooks::device_id(other)) << record.kernels[n];
    }
}

TEST_F(Manners, PlanningLaunchesOnTheInstanceThatIsHandedOver) {
  PlanOptions options;
  options.volume.priority.assign(1, PriorityRule{PriorityRule::Kind::quality, {}});  // looks at all cells
  expect_planned_on_serial(
      mesh, motion({rule({"hub"}, FixedRule{}), rule({"case"}, FixedRule{}), rule({"inlet", "outlet"}, FreeRule{})}),
      options);
}
#endif

/// An unstructured morph with every kind of kernel: columns, layers, background mesh, other boundaries, nodes of two
/// zones.
class UnstructuredManners : public ::testing::Test {
 protected:
  static bool in_body(Vec3 const& x) { return x.x > 4 && x.x < 8 && x.y > 4 && x.y < 8 && x.z > 4 && x.z < 8; }
  Mesh mesh = in_two_zones(box_around({12, 12, 12}, in_body), [](Vec3 const& x) { return x.x < 6; });
  [[nodiscard]] PreparedUnstructured prepared_by(NearFieldMethod method) const {
    UnstructuredTopology const topology = make_topology(mesh);
    PlanOptions options;
    options.elements.method = method;
    options.boundary_layers.push_back({.walls = {"body"}, .extent = BoundaryLayer::Extent::layers, .layers = 1});
    return prepare(mesh, topology, find_face_patches(mesh, topology),
                   motion({rule({"body"}, RigidRule{{}, {1, 0.5, 0}}), rule({"k_min"}, SlipRule{})}), options);
  }
  PreparedUnstructured prepared = prepared_by(NearFieldMethod::lattice);
  Exec exec;
  Kokkos::View<Vec3*, Memory> boundary = upload<Memory>(prepared.boundary_displacement());
  DeviceField<Memory> x{mesh.coordinates}, u{Coordinates(mesh.n_nodes())};
  std::vector<Morpher<Exec>::In> two_in{boundary, boundary};
  std::vector<Morpher<Exec>::Out> two_out{u, u};
};

TEST_F(UnstructuredManners, EveryAllocationAndKernelOfTheLibraryHasItsLabel) {
  Listener const listener;
  auto const morpher = MorpherAccess::of(exec, prepared.plan, x);
  morpher.positions(exec, boundary, u);
  exec.fence();
  EXPECT_GE(record.allocations.size(), 20u);
  expect_labels(record.kernels);
  expect_labels(record.allocations);
  for (char const* kernel :
       {"gridmorph::moving_walls", "gridmorph::wall_turn", "gridmorph::columns", "gridmorph::near", "gridmorph::volume",
        "gridmorph::residual_nodes", "gridmorph::residual", "gridmorph::copies", "gridmorph::move"})
    EXPECT_NE(std::find(record.kernels.begin(), record.kernels.end(), kernel), record.kernels.end()) << kernel;
}

/// Nothing but kernels in any call of a morpher.
void expect_only_kernels(Morpher<Exec> const& morpher, auto const& calls) {
  Exec().fence();
  {
    Listener const listener;
    calls(morpher);
  }
  EXPECT_EQ(record.allocations, std::vector<std::string>());
  EXPECT_EQ(record.copies, std::vector<std::string>());
  for (auto const& fence : record.fences) EXPECT_TRUE(is_profiling_fence(fence)) << fence;
  EXPECT_FALSE(record.kernels.empty());
}

TEST_F(UnstructuredManners, MorphingAllocatesNothingCopiesNothingAndDoesNotFence) {
  auto const calls = [&](Morpher<Exec> const& morpher) {
    morpher.displacements(exec, boundary, u);
    morpher.positions(exec, boundary, u);
    morpher.velocities(exec, boundary, boundary, u);
    morpher.displacements(exec, two_in, two_out);
  };
  expect_only_kernels(MorpherAccess::of(exec, prepared.plan, x, {1, true}), calls);
  auto const layers = prepared_by(NearFieldMethod::layers);
  expect_only_kernels(MorpherAccess::of(exec, layers.plan, x, {1, true}), calls);
  for (char const* kernel : {"gridmorph::near::seeds", "gridmorph::near::layers"})
    EXPECT_NE(std::find(record.kernels.begin(), record.kernels.end(), kernel), record.kernels.end()) << kernel;
}

TEST_F(UnstructuredManners, StagesAreRegionsOfProfiles) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan, x);
  Listener const listener;
  morpher.positions(exec, boundary, u);
  std::vector<std::string> own;
  for (auto const& region : record.regions)
    if (region.find("gridmorph::stage ") != 0 && region != "gridmorph::all nodes") own.push_back(region);
  EXPECT_EQ(own,
            (std::vector<std::string>{
                "gridmorph::GivenSlip", "gridmorph::WallMotion", "gridmorph::TakeTurns", "gridmorph::NearField",
                "gridmorph::FarField", "gridmorph::slip surfaces", "gridmorph::AddTurns", "gridmorph::StartResidual",
                "gridmorph::PrescribeAtBoundary", "gridmorph::SpreadResidual", "gridmorph::CopyNodes"}));
  EXPECT_EQ(record.open_regions, 0);
}

#ifdef KOKKOS_ENABLE_SERIAL
TEST_F(UnstructuredManners, PlanningLaunchesOnTheInstanceThatIsHandedOver) {
  Motion const m = motion({rule({"body"}, RigidRule{{}, {1, 0.5, 0}}), rule({"k_min"}, SlipRule{})});
  PlanOptions options;
  expect_planned_on_serial(mesh, m, options);
  // A background mesh that is not made of lattice cells: its nodes are found by the element locator.
  Background own = *prepared.plan.background;
  own.lattice.reset();
  options.elements.background = std::make_shared<Background const>(std::move(own));
  expect_planned_on_serial(mesh, m, options);
}

TEST_F(UnstructuredManners, OrdersAreFoundOnTheInstanceThatIsHandedOver) {
  Kokkos::Serial const other;
  Mesh copy = mesh;
  Listener const listener;
  reorder(other, copy, order_by_position(other, mesh));
  EXPECT_FALSE(is_scattered(other, copy));
  (void)in_file_order(other, copy);
  EXPECT_FALSE(record.devices.empty());
  for (std::size_t n = 0; n < record.devices.size(); ++n)
    EXPECT_EQ(record.devices[n], hooks::device_id(other)) << record.kernels[n];
}

TEST_F(UnstructuredManners, EverythingRunsOnTheInstanceThatIsHandedOver) {
  Kokkos::Serial const other;
  Coordinates const moved(mesh.n_nodes());
  std::vector<Vec3> const given = prepared.boundary_displacement();
  Kokkos::View<Vec3 const*, Kokkos::HostSpace> const host_boundary(given.data(), given.size());
  Listener const listener;
  auto const morpher = MorpherAccess::of(other, prepared.plan, mesh.coordinates, {1, true});
  morpher.positions(other, host_boundary, moved);
  morpher.displacements(other, host_boundary, moved);
  morpher.velocities(other, host_boundary, host_boundary, moved);
  EXPECT_FALSE(record.devices.empty());
  for (std::size_t n = 0; n < record.devices.size(); ++n)
    if (!is_of_kokkos(record.kernels[n])) {
      EXPECT_EQ(record.devices[n], hooks::device_id(other)) << record.kernels[n];
    }
}
#endif

TEST_F(UnstructuredManners, BoundaryDisplacementsOfAnotherLengthAreRefused) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan, x, {1, true});
  std::size_t const n = boundary.extent(0);
  for (std::size_t const other : {std::size_t(0), n - 1, n + 1}) {
    Kokkos::View<Vec3*, Memory> const list("gridmorph::test::list", other);
    auto const refused = [&](auto const& call) { expect_refused(other, n, "MorphPlan::boundary_nodes()", call); };
    refused([&] { morpher.positions(exec, list, u); });
    refused([&] { morpher.displacements(exec, list, u); });
    refused([&] { morpher.velocities(exec, list, boundary, u); });
    refused([&] { morpher.velocities(exec, boundary, list, u); });
  }
}

TEST_F(UnstructuredManners, MeshesWithoutCoordinatesAreRefused) {
  UnstructuredTopology const topology = make_topology(mesh);
  BoundaryFacePatches const face_patches = find_face_patches(mesh, topology);
  mesh.coordinates = {};
  expect_all_in(message_of<MeshError>([&] {
                  (void)prepare(mesh, topology, face_patches, motion({rule({"body"}, RigidRule{{}, {1, 0.5, 0}})}),
                                PlanOptions{});
                }),
                {std::to_string(mesh.n_nodes()) + " nodes", "0 (x)"});
}

TEST_F(UnstructuredManners, EveryMorphRunsTheSameKernels) {
  auto const morpher = MorpherAccess::of(exec, prepared.plan, x);
  std::vector<std::string> first;
  for (int n = 0; n < 3; ++n) {
    Listener const listener;
    morpher.displacements(exec, boundary, u);
    if (n == 0) first = record.kernels;
    EXPECT_EQ(record.kernels, first);
    Kokkos::deep_copy(boundary, Vec3{});
  }
}

}  // namespace
}  // namespace gridmorph::test
