// Which cells a shock sensor takes, against the profile that the solution was made of.
#include "shock_flow.hpp"
#include "support/cascade.hpp"
#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/motion/shock/shock_cells.hpp>

#include <gtest/gtest.h>

#include <numeric>

namespace gridmorph::test {
namespace {

using Sensor = ShockSearch::Sensor;

std::vector<std::uint8_t> all(Mesh const& mesh) { return std::vector<std::uint8_t>(corners_of_cells(mesh).size(), 1); }

ShockSearch search_for(Sensor sensor, double threshold) {
  ShockSearch out;
  out.sensor = sensor;
  out.threshold = threshold;
  out.smallest = 1;
  return out;
}

Index count(std::vector<std::uint8_t> const& cells) { return Index(std::count(cells.begin(), cells.end(), 1)); }

/// Rises of the pressure over the cells, from the profile along the normal alone.
std::vector<double> rises(Mesh const& mesh, NormalShock const& shock) {
  std::vector<double> out;
  for (auto const& corners : corners_of_cells(mesh)) {
    double first = std::numeric_limits<double>::infinity(), last = -first, mean = 0;
    for (Index const n : corners) {
      double const s = shock.ahead(mesh.coordinates[n]);
      first = std::min(first, s);
      last = std::max(last, s);
      mean += shock.pressure(s) / double(corners.size());
    }
    out.push_back((shock.pressure(last) - shock.pressure(first)) / mean);
  }
  return out;
}

Vec3 unit(Vec3 const& v) { return (1 / norm(v)) * v; }

void expect_rises_found(Mesh const& mesh, NormalShock const& shock, double threshold) {
  ShockCells const found = find_shock(mesh, solution_of(mesh, shock), search_for(Sensor::jump, threshold), all(mesh));
  std::vector<double> const rise = rises(mesh, shock);
  ASSERT_EQ(found.cells.size(), rise.size());
  for (std::size_t c = 0; c < rise.size(); ++c)
    EXPECT_EQ(found.cells[c] != 0, rise[c] >= threshold) << "cell " << c << ", rise " << rise[c];
  EXPECT_GT(count(found.cells), 0);
  EXPECT_LT(count(found.cells), Index(rise.size()));
}

TEST(ShockCells, TheRiseOverACellIsThatOfTheProfileWhateverThePlaneAndTheCells) {
  for (Vec3 const& normal : {Vec3{1, 0, 0}, unit({2, 1, -0.5}), unit({-0.3, 1, 0.4})}) {
    NormalShock const shock{.normal = normal};
    for (Index3 const& extent : {Index3{17, 9, 7}, Index3{9, 12, 21}}) {
      Mesh const straight = box(extent, Shape::straight, 1), curved = box(extent, Shape::curved, 5);
      expect_rises_found(straight, shock, 0.2);
      expect_rises_found(to_hexahedra(straight), shock, 0.2);
      expect_rises_found(to_prisms_and_tetrahedra(straight, 3), shock, 0.2);
      NormalShock within = shock;
      within.through = curved.coordinates[curved.n_nodes() / 2];
      expect_rises_found(curved, within, 0.1);
    }
  }
}

TEST(ShockCells, HowZonesAreCutTurnedAndNumberedChangesNothing) {
  Mesh const mesh = bricks_with_t_junctions(3);
  NormalShock shock{.normal = unit({1, 0.4, 0.2}), .width = 0.3};
  shock.through = mesh.coordinates[mesh.n_nodes() / 2];
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Mesh const other = scramble(mesh, {.seed = seed, .cuts = 2}).mesh;
    expect_rises_found(other, shock, 0.1);
    // Groups reach across interfaces.
    ShockSearch search = search_for(Sensor::jump, 0.1);
    auto const found = find_shock(other, solution_of(other, shock), search, all(other));
    search.smallest = int(count(found.cells));
    EXPECT_EQ(count(find_shock(other, solution_of(other, shock), search, all(other)).cells), count(found.cells));
  }
}

TEST(ShockCells, TheNormalMachNumberIsThatOfTheProfileAndTheShockItsFirstPart) {
  for (Vec3 const& normal : {Vec3{1, 0, 0}, unit({2, 1, -0.5}), unit({-0.3, 1, 0.4})}) {
    NormalShock const shock{.normal = normal};
    for (bool const elements : {false, true}) {
      Mesh const blocks = box({25, 13, 15}, Shape::straight, 1);
      Mesh const mesh = elements ? to_prisms_and_tetrahedra(blocks, 4) : blocks;
      ShockCells const found =
          find_shock(mesh, solution_of(mesh, shock), search_for(Sensor::normal_mach, 1), all(mesh));
      std::vector<double> const rise = rises(mesh, shock);
      auto const corners = corners_of_cells(mesh);
      Index sure = 0;
      for (std::size_t c = 0; c < corners.size(); ++c) {
        double speed = 0, sound = 0;
        for (Index const n : corners[c]) {
          double const s = shock.ahead(mesh.coordinates[n]);
          speed += shock.speed(s);
          sound += std::sqrt(NormalShock::gamma * shock.pressure(s) / shock.density(s));
        }
        double const mach = speed / sound;
        // In cells that are not cubes the gradient of a curved profile is not quite along the normal.
        if (rise[c] < 0.05 || mach < 1) {
          EXPECT_EQ(found.cells[c], 0) << mach << " " << rise[c];
        }
        if (rise[c] < 0.05 || mach < 1.03) continue;
        EXPECT_EQ(found.cells[c], 1) << mach << " " << rise[c];
        ++sure;
      }
      EXPECT_GT(sure, 20);
      EXPECT_GT(dot(found.direction, normal), 0.99);
    }
  }
}

TEST(ShockCells, AFlowThatGoesTheOtherWayIsAnExpansionAndNoShock) {
  Mesh const mesh = box({17, 9, 7}, Shape::straight, 1);
  FlowSolution backwards = solution_of(mesh, {});
  for (char const* name : {"VelocityX", "VelocityY", "VelocityZ"})
    for (double& v : backwards.values[name]) v = -v;
  expect_all_in(
      message_of<MotionError>([&] { find_shock(mesh, backwards, search_for(Sensor::normal_mach, 1), all(mesh)); }),
      {"none of the 768 cells", "along the flow"});
}

TEST(ShockCells, ValuesInCellsAreAveragedAroundNodesAcrossInterfacesToo) {
  NormalShock const shock{.normal = unit({1, 0.3, 0.1})};
  Mesh const whole = box({17, 9, 7}, Shape::straight, 1);
  Mesh const cut = scramble(whole, {.seed = 7, .cuts = 3, .reorient = true, .reorder = true}).mesh;
  ASSERT_GT(cut.zones.size(), 1U);
  auto const middles = [](Mesh const& mesh, Sensor sensor, NormalShock const& of) {
    ShockCells const found =
        find_shock(mesh, solution_of(mesh, of, false), search_for(sensor, sensor == Sensor::jump ? 0.2 : 1), all(mesh));
    std::vector<std::array<long, 3>> out;
    for (ShockPoint const& p : found.points)
      out.push_back({std::lround(1e9 * p.place.x), std::lround(1e9 * p.place.y), std::lround(1e9 * p.place.z)});
    std::sort(out.begin(), out.end());
    return out;
  };
  for (Sensor const sensor : {Sensor::jump, Sensor::normal_mach}) {
    auto const of_whole = middles(whole, sensor, shock);
    EXPECT_GT(of_whole.size(), 10U);
    EXPECT_EQ(middles(cut, sensor, shock), of_whole);
    EXPECT_EQ(middles(to_hexahedra(cut), sensor, shock), of_whole);
  }
  // Independently, away from the boundary: the mean of the eight cells around a node.
  FlowSolution const solution = solution_of(whole, shock, false);
  std::vector<double> const& p = solution.values.at("Pressure");
  auto const node = [&](int i, int j, int k) {
    double sum = 0;
    for (int n = 0; n < 8; ++n) sum += p[i - 1 + (n & 1) + 16 * (j - 1 + (n >> 1 & 1) + 8 * (k - 1 + (n >> 2)))];
    return sum / 8;
  };
  ShockCells const found = find_shock(whole, solution, search_for(Sensor::jump, 0.2), all(whole));
  for (int k = 1; k < 5; ++k)
    for (int j = 1; j < 7; ++j)
      for (int i = 1; i < 15; ++i) {
        double low = 1e9, high = 0, mean = 0;
        for (int n = 0; n < 8; ++n) {
          double const q = node(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
          low = std::min(low, q);
          high = std::max(high, q);
          mean += q / 8;
        }
        EXPECT_EQ(found.cells[i + 16 * (j + 8 * k)] != 0, (high - low) / mean >= 0.2);
      }
}

TEST(ShockCells, ConservedVariablesGiveThePressureAndTheVelocityThatPrimitiveOnesAre) {
  Mesh const mesh = box({17, 9, 7}, Shape::straight, 1);
  FlowSolution const primitive = solution_of(mesh, {});
  FlowSolution conserved = primitive;
  auto& v = conserved.values;
  for (std::size_t n = 0; n < v["Density"].size(); ++n) {
    double const rho = v["Density"][n], u = v["VelocityX"][n];
    v["MomentumX"].push_back(rho * u);
    v["MomentumY"].push_back(0);
    v["MomentumZ"].push_back(0);
    v["EnergyStagnationDensity"].push_back(v["Pressure"][n] / 0.4 + 0.5 * rho * u * u);
  }
  for (char const* name : {"Pressure", "VelocityX", "VelocityY", "VelocityZ"}) v.erase(name);
  for (Sensor const sensor : {Sensor::normal_mach, Sensor::jump})
    EXPECT_EQ(find_shock(mesh, conserved, search_for(sensor, sensor == Sensor::jump ? 0.2 : 1), all(mesh)).cells,
              find_shock(mesh, primitive, search_for(sensor, sensor == Sensor::jump ? 0.2 : 1), all(mesh)).cells);
}

TEST(ShockCells, APlaneMeshNeedsNoVelocityAcrossItWhicheverAxisThatIs) {
  for (int const across : {0, 1, 2}) {
    Mesh mesh = flat_box(24, 8, 0);
    std::array const arrays{mesh.coordinates.x, mesh.coordinates.y, mesh.coordinates.z};
    auto const turned = [&](int axis) { return arrays[std::size_t(axis - across + 5) % 3]; };
    mesh.coordinates.x = turned(0);
    mesh.coordinates.y = turned(1);
    mesh.coordinates.z = turned(2);
    Vec3 const normal{across == 2 ? 1.0 : 0.0, across == 0 ? 1.0 : 0.0, across == 1 ? 1.0 : 0.0};
    NormalShock const shock{.through = 12 * normal, .normal = normal, .width = 2};
    FlowSolution solution = solution_of(mesh, shock);
    auto const cells = [&] { return find_shock(mesh, solution, search_for(Sensor::normal_mach, 1), all(mesh)).cells; };
    auto const with_all = cells();
    EXPECT_GT(count(with_all), 0);
    solution.values.erase(std::string("Velocity") + char('X' + across));
    EXPECT_EQ(cells(), with_all) << across;
    solution.values.erase(std::string("Velocity") + char('X' + (across + 1) % 3));
    expect_all_in(message_of<MotionError>(cells), {"no VelocityX"});
  }
}

TEST(ShockCells, SmallGroupsAreDroppedAndLayersGrowFromTheOthers) {
  Mesh const mesh = box({17, 9, 7}, Shape::straight, 1);
  FlowSolution solution = solution_of(mesh, {});
  ShockSearch search = search_for(Sensor::jump, 0.2);
  auto const shock = find_shock(mesh, solution, search, all(mesh)).cells;
  Index const n = count(shock);
  solution.values["Pressure"][0] = 3;  // one cell at a corner
  auto const with_speck = find_shock(mesh, solution, search, all(mesh)).cells;
  EXPECT_EQ(count(with_speck), n + 1);
  search.smallest = 2;
  EXPECT_EQ(find_shock(mesh, solution, search, all(mesh)).cells, shock);
  search.grow = 2;
  auto const grown = find_shock(mesh, solution, search, all(mesh));
  EXPECT_EQ(Index(grown.points.size()), n);  // where the shock is does not grow
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 16; ++i) {
        bool near = false;
        for (int d = -2; d <= 2; ++d) near = near || (i + d >= 0 && i + d < 16 && shock[i + d + 16 * (j + 8 * k)] != 0);
        EXPECT_EQ(grown.cells[i + 16 * (j + 8 * k)] != 0, near);
      }
  search.smallest = int(n) + 1;
  search.grow = 0;
  expect_all_in(message_of<MotionError>([&] { find_shock(mesh, solution, search, all(mesh)); }),
                {"in 2 groups of " + std::to_string(n), "smallest = " + std::to_string(n) + " would keep"});
}

/// A solution of one pressure but at nodes (i, any j, k), for k in `layers`.
FlowSolution raised(Mesh const& mesh, int i, std::vector<int> const& layers) {
  FlowSolution out = solution_of(mesh, {});
  std::vector<double>& p = out.values["Pressure"];
  std::fill(p.begin(), p.end(), 1.0);
  Zone const& zone = mesh.zones.front();
  for (int const k : layers)
    for (int j = 0; j < zone.extent[1]; ++j) p[zone.node({i, j, k})] = 3;
  return out;
}

// Straight and round the axis; a pressure that is raised on both of its periodic sides is raised in one place.
TEST(ShockCells, CellsThatMeetAcrossPeriodicSidesAreOfOneGroup) {
  for (double const radius : {0.0, 3.0}) {
    Mesh const blocks = cascade(radius);
    Zone const zone = blocks.zones.front();
    int const last = zone.extent[2] - 1, of_a_side = 2 * (zone.extent[1] - 1);
    FlowSolution const both = raised(blocks, 5, {0, last}), one = raised(blocks, 5, {last});
    for (bool const elements : {false, true}) {
      Mesh const mesh = elements ? as_hexahedra(blocks) : blocks;
      ShockSearch search = search_for(Sensor::jump, 0.2);
      search.smallest = of_a_side + 1;
      ShockCells const found = find_shock(mesh, both, search, all(mesh));
      EXPECT_EQ(count(found.cells), 2 * of_a_side);
      expect_all_in(found.summary, {std::to_string(2 * of_a_side) + " cells in 1 group "});
      expect_all_in(message_of<MotionError>([&] { find_shock(mesh, one, search, all(mesh)); }),
                    {"in 1 groups of " + std::to_string(of_a_side) + " at most"});
      // Without the periodic sides they are two.
      Mesh apart = mesh;
      apart.interfaces.clear();
      apart.connections.clear();
      expect_all_in(message_of<MotionError>([&] { find_shock(apart, both, search, all(apart)); }),
                    {"in 2 groups of " + std::to_string(of_a_side) + " at most"});
    }
  }
}

TEST(ShockCells, LayersGrowAcrossPeriodicSides) {
  Mesh const mesh = cascade(3);
  Zone const& zone = mesh.zones.front();
  ShockSearch search = search_for(Sensor::jump, 0.2);
  search.grow = 1;
  auto const cells = find_shock(mesh, raised(mesh, 5, {1}), search, all(mesh)).cells;
  Index const ni = zone.extent[0] - 1, nj = zone.extent[1] - 1, nk = zone.extent[2] - 1;
  for (Index k = 0; k < nk; ++k)
    for (Index j = 0; j < nj; ++j)
      for (Index i = 0; i < ni; ++i)
        EXPECT_EQ(cells[i + ni * (j + nj * k)] != 0, i >= 3 && i <= 6 && (k <= 2 || k == nk - 1)) << i << k;
}

TEST(ShockCells, WhereNoneIsFoundTheThresholdThatIsNamedWouldDo) {
  Mesh const mesh = box({17, 9, 7}, Shape::straight, 1);
  for (Sensor const sensor : {Sensor::jump, Sensor::normal_mach}) {
    ShockSearch search = search_for(sensor, 7);
    std::string const text =
        message_of<MotionError>([&] { find_shock(mesh, solution_of(mesh, {}), search, all(mesh)); });
    std::size_t const at = text.find("threshold = ");
    ASSERT_NE(at, std::string::npos) << text;
    search.threshold = std::stod(text.substr(at + 12));
    EXPECT_GT(count(find_shock(mesh, solution_of(mesh, {}), search, all(mesh)).cells), 0) << text;
  }
}

TEST(ShockCells, WhatLacksIsSaidWithWhatThereIs) {
  Mesh const mesh = box({5, 5, 5}, Shape::straight, 1);
  FlowSolution solution = solution_of(mesh, {});
  solution.values.erase("VelocityY");
  solution.available = {"Pressure", "Density", "Mach"};
  expect_all_in(
      message_of<MotionError>([&] { find_shock(mesh, solution, search_for(Sensor::normal_mach, 1), all(mesh)); }),
      {"no VelocityX, VelocityY", "'Pressure', 'Density', 'Mach'"});
  ShockSearch search = search_for(Sensor::jump, 1);
  search.variable = "Entropy";
  expect_all_in(message_of<MotionError>([&] { find_shock(mesh, solution, search, all(mesh)); }),
                {"no Entropy", "'Mach'"});
}

TEST(ShockCells, ARegionLooksInItsZonesAndWhereItHoldsAlone) {
  Mesh const mesh = box({17, 9, 7}, Shape::straight, 1);
  InnerRegion region;
  region.holds = [](Vec3 const& p) { return p.y < 0.5; };
  auto const looked = cells_looked_at(mesh, region);
  EXPECT_EQ(count(looked), 16 * 4 * 6);
  auto const found = find_shock(mesh, solution_of(mesh, {}), search_for(Sensor::jump, 0.2), looked).cells;
  auto const everywhere = find_shock(mesh, solution_of(mesh, {}), search_for(Sensor::jump, 0.2), all(mesh)).cells;
  for (std::size_t c = 0; c < looked.size(); ++c) EXPECT_EQ(found[c], everywhere[c] & looked[c]);
  region.cells = std::make_shared<std::vector<std::uint8_t> const>(found);
  Mesh blocks = mesh;
  region.name = "shock";
  add_regions(blocks, std::vector{region});
  EXPECT_EQ(blocks.patches.back().range.extent(1), 5);
  Mesh const elements = to_hexahedra(mesh);
  EXPECT_EQ(elements_of_region(elements, region), found);
  std::vector<std::string> notes;
  EXPECT_FALSE(regions_of_elements(elements, std::vector{region}, notes).at(0).nodes.empty());
  region.cells = std::make_shared<std::vector<std::uint8_t> const>(3);
  region.name = "other";
  expect_all_in(message_of<MotionError>([&] { add_regions(blocks, std::vector{region}); }), {"of 3 cells"});
}

}  // namespace
}  // namespace gridmorph::test
