// Structural models in CGNS files, written with the CGNS library itself.
#include "io_support.hpp"
#include "mll_file.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_model.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph::test {
namespace {

/// An unstructured zone with a displacement (x, 2 y, 3 z) at its nodes.
class ModelFile : public MllFile {
 public:
  using MllFile::MllFile;

  int zone(std::string const& name, std::vector<Vec3> const& x) {
    cgsize_t size[3] = {cgsize_t(x.size()), 1, 0};
    check(cg_zone_write(file(), base(), name.c_str(), size, CGNS_ENUMV(Unstructured), &zone_));
    int number = 0;
    for (int c = 0; c < 3; ++c)
      check(cg_coord_write(file(), base(), zone_, CGNS_ENUMV(RealDouble),
                           std::array{"CoordinateX", "CoordinateY", "CoordinateZ"}[c], component(x, c, 1).data(),
                           &number));
    return zone_;
  }
  void solution(std::string const& name, std::vector<Vec3> const& x, double factor = 1, std::string const& part = "") {
    int number = 0, field = 0;
    if (name != last_) check(cg_sol_write(file(), base(), zone_, name.c_str(), CGNS_ENUMV(Vertex), &number_));
    last_ = name;
    static_cast<void>(number);
    for (int c = 0; c < 3; ++c)
      check(cg_field_write(file(), base(), zone_, number_, CGNS_ENUMV(RealDouble),
                           (std::array{"DisplacementX", "DisplacementY", "DisplacementZ"}[c] + part).c_str(),
                           component(x, c, factor * (c + 1)).data(), &field));
  }
  void section(std::string const& name, CGNS_ENUMT(ElementType_t) type, std::vector<cgsize_t> const& nodes, int count) {
    int number = 0;
    check(cg_section_write(file(), base(), zone_, name.c_str(), type, next_, next_ + count - 1, 0, nodes.data(),
                           &number));
    next_ += count;
  }

 private:
  static std::vector<double> component(std::vector<Vec3> const& x, int c, double factor) {
    std::vector<double> out;
    for (auto const& p : x) out.push_back(factor * (c == 0 ? p.x : c == 1 ? p.y : p.z));
    return out;
  }
  int zone_ = 0, number_ = 0;
  cgsize_t next_ = 1;
  std::string last_;
};

std::vector<Vec3> const square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, 0}};

/// Area of all facets, each through its own corners.
double area(ElementModel const& m) {
  double sum = 0;
  for (auto const& f : m.facets) {
    auto const& x = m.position;
    sum += f[3] < 0 ? 0.5 * norm(cross(x[f[1]] - x[f[0]], x[f[2]] - x[f[0]]))
                    : 0.5 * norm(cross(x[f[2]] - x[f[0]], x[f[3]] - x[f[1]]));
  }
  return sum;
}
std::size_t nodes_used(ElementModel const& m) {
  std::set<std::int32_t> used;
  for (auto const& f : m.facets)
    for (auto const n : f)
      if (n >= 0) used.insert(n);
  return used.size();
}

TEST(ElementModel, ReadsShellsAndTheirDisplacement) {
  TemporaryFolder const folder;
  {
    ModelFile file(folder.file("m.cgns"), 2);
    file.zone("shell", square);
    file.solution("FlowSolution", square);
    file.section("quads", CGNS_ENUMV(QUAD_4), {1, 2, 3, 4}, 1);
    file.section("triangles", CGNS_ENUMV(TRI_3), {2, 5, 3}, 1);
    file.section("beam", CGNS_ENUMV(BAR_2), {1, 2}, 1);
  }
  auto const m = read_element_model(folder.file("m.cgns"));
  ASSERT_EQ(m.position.size(), 5u);
  EXPECT_EQ(m.displacement[4], (Vec3{2, 1, 0}));
  ASSERT_EQ(m.facets.size(), 2u);
  EXPECT_EQ(m.facets[0], (std::array<std::int32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(m.facets[1], (std::array<std::int32_t, 4>{1, 4, 2, -1}));
  EXPECT_TRUE(m.imaginary.empty());
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("1 node and line elements"), std::string::npos);
}

TEST(ElementModel, TakesTheSolutionThatIsNamedAndItsImaginaryPart) {
  TemporaryFolder const folder;
  {
    ModelFile file(folder.file("m.cgns"), 2);
    file.zone("shell", square);
    file.solution("Mode1", square);
    file.solution("Mode2", square, 10);
    file.solution("Mode2", square, -1, "_im");
    file.section("quads", CGNS_ENUMV(QUAD_4), {1, 2, 3, 4}, 1);
  }
  EXPECT_EQ(read_element_model(folder.file("m.cgns")).displacement[2], (Vec3{1, 2, 0}));
  auto const second = read_element_model(folder.file("m.cgns"), "Mode2");
  EXPECT_EQ(second.displacement[2], (Vec3{10, 20, 0}));
  EXPECT_EQ(second.imaginary[2], (Vec3{-1, -2, 0}));
  auto const message = message_of<IoError>([&] { read_element_model(folder.file("m.cgns"), "Mode3"); });
  EXPECT_NE(message.find("'Mode3'"), std::string::npos);
  EXPECT_NE(message.find("'Mode1', 'Mode2'"), std::string::npos) << message;
}

TEST(ElementModel, TakesTheOutsideOfSolids) {
  // A cube in five tetrahedra and a prism, a pyramid and a hexahedron each beside it, all in one MIXED section.
  std::vector<Vec3> const x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},     {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
                            {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}, {0.5, 0.5, 2}, {3, 0, 0}, {3, 1, 0}};
  TemporaryFolder const folder;
  {
    ModelFile file(folder.file("m.cgns"), 3);
    file.zone("solid", x);
    file.solution("S", x);
    std::vector<cgsize_t> const mixed{cgsize_t(CGNS_ENUMV(HEXA_8)),
                                      1,
                                      2,
                                      3,
                                      4,
                                      5,
                                      6,
                                      7,
                                      8,
                                      cgsize_t(CGNS_ENUMV(HEXA_8)),
                                      2,
                                      9,
                                      10,
                                      3,
                                      6,
                                      11,
                                      12,
                                      7,
                                      cgsize_t(CGNS_ENUMV(PYRA_5)),
                                      5,
                                      6,
                                      7,
                                      8,
                                      13,
                                      cgsize_t(CGNS_ENUMV(PENTA_6)),
                                      9,
                                      14,
                                      11,
                                      10,
                                      15,
                                      12};
    std::vector<cgsize_t> const offset{0, 9, 18, 24, 31};
    int number = 0;
    MllFile::check(cg_poly_section_write(file.file(), file.base(), 1, "all", CGNS_ENUMV(MIXED), 1, 4, 0, mixed.data(),
                                         offset.data(), &number));
  }
  auto const m = read_element_model(folder.file("m.cgns"));
  // Two cubes: 8 outer squares without the top of the first; 4 sides of the pyramid; the prism replaces a square by
  // two triangles, a slanted square of length sqrt 2 and the bottom.
  double const pyramid = 4 * 0.5 * std::sqrt(1 + 0.25), prism = 2 * 0.5 + std::sqrt(2.0) + 1;
  EXPECT_NEAR(area(m), 8 + pyramid + prism, 1e-12);
  EXPECT_EQ(nodes_used(m), 15u);
}

TEST(ElementModel, SplitsElementsOfSecondOrderAtAllTheirNodes) {
  // One element each over a paraboloid: the facets go through the nodes amid the sides.
  auto const on = [](double a, double b) { return Vec3{a, b, 0.2 * (a * a + b * b)}; };
  std::vector<Vec3> const triangle{on(0, 0), on(1, 0), on(0, 1), on(0.5, 0), on(0.5, 0.5), on(0, 0.5)};
  std::vector<Vec3> square8{on(0, 0), on(1, 0), on(1, 1), on(0, 1), on(0.5, 0), on(1, 0.5), on(0.5, 1), on(0, 0.5)};
  auto square9 = square8;
  square9.push_back(on(0.5, 0.5));
  auto const read = [&](std::vector<Vec3> const& x, CGNS_ENUMT(ElementType_t) type) {
    TemporaryFolder const folder;
    {
      ModelFile file(folder.file("m.cgns"), 2);
      file.zone("shell", x);
      file.solution("S", x);
      std::vector<cgsize_t> nodes;
      for (std::size_t n = 1; n <= x.size(); ++n) nodes.push_back(cgsize_t(n));
      file.section("one", type, nodes, 1);
    }
    return read_element_model(folder.file("m.cgns"));
  };
  auto const flat_area = [](ElementModel m) {
    for (auto& p : m.position) p.z = 0;
    return area(m);
  };
  auto const t6 = read(triangle, CGNS_ENUMV(TRI_6));
  EXPECT_EQ(t6.facets.size(), 4u);
  EXPECT_EQ(nodes_used(t6), 6u);
  EXPECT_NEAR(flat_area(t6), 0.5, 1e-14);
  auto const q8 = read(square8, CGNS_ENUMV(QUAD_8));
  EXPECT_EQ(q8.facets.size(), 5u);
  EXPECT_EQ(nodes_used(q8), 8u);
  EXPECT_NEAR(flat_area(q8), 1, 1e-14);
  auto const q9 = read(square9, CGNS_ENUMV(QUAD_9));
  EXPECT_EQ(q9.facets.size(), 4u);
  EXPECT_EQ(nodes_used(q9), 9u);
  EXPECT_NEAR(flat_area(q9), 1, 1e-14);
}

TEST(ElementModel, EverySolidIsClosed) {
  // Corners of the unit cube and, for elements of second order, the middle of every edge in the order of the standard.
  // The vector areas of a closed surface add up to zero, whatever the numbering of its faces.
  std::vector<Vec3> const corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::vector<std::array<int, 2>> const edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5},
                                              {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  auto x = corners;
  for (auto const& [a, b] : edges) x.push_back(0.5 * (corners[a] + corners[b]));
  for (bool const second : {false, true}) {
    TemporaryFolder const folder;
    {
      ModelFile file(folder.file("m.cgns"), 3);
      file.zone("solid", x);
      file.solution("S", x);
      std::vector<cgsize_t> nodes;
      for (int n = 1; n <= (second ? 20 : 8); ++n) nodes.push_back(n);
      file.section("one", second ? CGNS_ENUMV(HEXA_20) : CGNS_ENUMV(HEXA_8), nodes, 1);
    }
    auto const m = read_element_model(folder.file("m.cgns"));
    EXPECT_EQ(m.facets.size(), second ? 30u : 6u);
    EXPECT_NEAR(area(m), 6, 1e-13);
    double volume = 0;
    for (auto const& f : m.facets) {
      Vec3 const a = m.position[f[0]], b = m.position[f[1]], c = m.position[f[2]];
      volume += dot(a, cross(b, c)) / 6;
      if (f[3] >= 0) volume += dot(a, cross(c, m.position[f[3]])) / 6;
    }
    EXPECT_NEAR(volume, 1, 1e-13) << "faces look outward";
  }
}

TEST(ElementModel, ReadsStructuredSurfaces) {
  TemporaryFolder const folder;
  {
    MllFile file(folder.file("m.cgns"), 2);
    cgsize_t size[6] = {4, 3, 3, 2, 0, 0};
    int zone = 0, number = 0, solution = 0;
    MllFile::check(cg_zone_write(file.file(), file.base(), "skin", size, CGNS_ENUMV(Structured), &zone));
    std::vector<double> x, y, z(12, 0.0);
    for (int n = 0; n < 12; ++n) {
      x.push_back(n % 4);
      y.push_back(n / 4);
    }
    MllFile::check(
        cg_coord_write(file.file(), file.base(), zone, CGNS_ENUMV(RealDouble), "CoordinateX", x.data(), &number));
    MllFile::check(
        cg_coord_write(file.file(), file.base(), zone, CGNS_ENUMV(RealDouble), "CoordinateY", y.data(), &number));
    MllFile::check(
        cg_coord_write(file.file(), file.base(), zone, CGNS_ENUMV(RealDouble), "CoordinateZ", z.data(), &number));
    MllFile::check(cg_sol_write(file.file(), file.base(), zone, "S", CGNS_ENUMV(Vertex), &solution));
    MllFile::check(cg_field_write(file.file(), file.base(), zone, solution, CGNS_ENUMV(RealDouble), "DisplacementZ",
                                  x.data(), &number));
  }
  auto const m = read_element_model(folder.file("m.cgns"));
  EXPECT_EQ(m.facets.size(), 6u);
  EXPECT_NEAR(area(m), 6, 1e-14);
  EXPECT_EQ(m.displacement[7], (Vec3{0, 0, 3}));
}

TEST(ElementModel, RefusesWhatCannotBeUsed) {
  TemporaryFolder const folder;
  auto const model = [&](std::vector<cgsize_t> const& nodes, double factor, bool with_solution = true) {
    std::filesystem::remove(folder.path("m.cgns"));
    ModelFile file(folder.file("m.cgns"), 2);
    file.zone("shell", square);
    if (with_solution) file.solution("S", square, factor);
    file.section("quads", CGNS_ENUMV(QUAD_4), nodes, 1);
  };
  auto const path = folder.file("m.cgns");
  model({1, 2, 3, 6}, 1);
  EXPECT_NE(message_of<MeshError>([&] { read_element_model(path); }).find("names a node that is not there"),
            std::string::npos);
  model({1, 2, 3, 4}, std::nan(""));
  EXPECT_NE(message_of<MeshError>([&] { read_element_model(path); }).find("not finite"), std::string::npos);
  model({1, 2, 3, 4}, 1, false);
  EXPECT_NE(message_of<IoError>([&] { read_element_model(path); }).find("no solution with DisplacementX"),
            std::string::npos);
}

TEST(ElementModel, SurvivesFilesCutShortAndBitsFlipped) {
  TemporaryFolder const folder;
  {
    ModelFile file(folder.file("m.cgns"), 2);
    file.zone("shell", square);
    file.solution("S", square);
    file.section("quads", CGNS_ENUMV(QUAD_4), {1, 2, 3, 4}, 1);
  }
  std::string const bytes = bytes_of(folder.path("m.cgns"));
  for (std::size_t length = 1; length < bytes.size(); length += 1 + bytes.size() / 40) {
    write_bytes(folder.path("cut.cgns"), bytes.substr(0, length));
    EXPECT_THROW(read_element_model(folder.file("cut.cgns")), Error) << length;
  }
}

}  // namespace
}  // namespace gridmorph::test
