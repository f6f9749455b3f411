// Boxes of designs: certified ones have no design that the certificate finds broken, and the design that is named does
// break its cell.
#include "quality/test_meshes.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/kernels/jacobian_bounds.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/quality/design_box.hpp>
#include <gridmorph/quality/detail/design_search.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace gridmorph::test {
namespace {

using kernels::ElementCorners;
using kernels::ElementType;
using kernels::JacobianSign;

/// An element of each type of the usual shape.
ElementCorners regular(ElementType type) {
  switch (type) {
    case ElementType::triangle: return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    case ElementType::quadrilateral: return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    case ElementType::tetrahedron: return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    case ElementType::pyramid: return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}};
    case ElementType::prism: return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    default: return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  }
}

struct Shape {
  Vec3 sides{1, 1, 1};
  double shear = 0;
  Vec3 far;  ///< where it lies
};

/// A cell, a little out of shape, and modes of that many times its sides.
detail::DesignCell random_cell(std::mt19937& random, ElementType type, int n_modes, double size, Shape const& shape) {
  std::uniform_real_distribution<double> off(-1, 1);
  bool const plane = is_surface(type);
  auto const placed = [&](Vec3 const& p) {
    Vec3 const s{p.x * shape.sides.x, p.y * shape.sides.y, p.z * shape.sides.z};
    return Vec3{s.x + shape.shear * s.y, s.y + shape.shear * s.z, s.z};
  };
  auto const noise = [&](double amplitude) {
    return Vec3{amplitude * off(random), amplitude * off(random), plane ? 0 : amplitude * off(random)};
  };
  detail::DesignCell cell{type, off(random) < 0 ? -1.0 : 1.0, {0, 0, 1}, regular(type), {}, 0};
  for (int k = 0; k < n_corners(type); ++k) {
    Vec3 p = placed(cell.x.at[k] + noise(0.1));
    if (cell.sign < 0) p.x = -p.x;  // mirrored: inside out by its numbering
    cell.x.at[k] = p + shape.far;
  }
  for (int i = 0; i < n_modes; ++i) {
    ElementCorners mode;
    for (int k = 0; k < n_corners(type); ++k) mode.at[k] = placed(noise(size));
    cell.modes.push_back(mode);
  }
  return cell;
}

constexpr ElementType types[] = {ElementType::triangle, ElementType::quadrilateral, ElementType::tetrahedron,
                                 ElementType::pyramid,  ElementType::prism,         ElementType::hexahedron};
Shape const shapes[] = {{}, {{1, 1, 1e-6}, 0, {}}, {{1, 1e-6, 1e-3}, 3, {}}, {{1, 1, 1}, 0.5, {1e4, -2e4, 3e3}}};

kernels::ScreenedCell screened(detail::DesignCell const& cell, double limit, double enough) {
  return kernels::with_element_type(cell.type, [&]<ElementType type>() {
    return kernels::screen_design_cell<type>(
        cell.x, [&](int i) { return cell.modes[i]; },
        {int(cell.modes.size()), cell.sign, cell.plane_normal, limit, enough, cell.deviation});
  });
}

/// Designs |t_i| <= size, corners of the box among them.
template <class Judge>
void sample(std::mt19937& random, int n_modes, double size, int count, Judge const& judge) {
  std::uniform_real_distribution<double> t(-size, size);
  for (int k = 0; k < count; ++k) {
    std::vector<double> design(n_modes);
    for (double& v : design) {
      v = t(random);
      if (k % 2 == 0) v = v < 0 ? -size : size;
    }
    judge(design);
  }
}

TEST(DesignCell, ScreensAreNeverBeyondWhatHolds) {
  std::mt19937 random(3);
  int useful = 0, cells = 0;
  for (ElementType const type : types)
    for (Shape const& shape : shapes)
      for (int k = 0; k < 40; ++k) {
        auto const cell = random_cell(random, type, 1 + k % 4, 0.3, shape);
        if (cell.sign_at(std::vector<double>(cell.modes.size(), 0)) != JacobianSign::positive) continue;
        auto const norms = screened(cell, 4, 0), slopes = screened(cell, 4, 4);
        EXPECT_GE(slopes.scale, norms.scale);
        ++cells;
        useful += slopes.scale > 0.1 ? 1 : 0;
        sample(random, int(cell.modes.size()), slopes.scale, 60, [&](std::vector<double> const& t) {
          ASSERT_LT(cell.sign_at(t), JacobianSign::negative) << int(type) << " " << slopes.scale;
        });
      }
  EXPECT_GT(cells, 700);
  EXPECT_GT(useful, cells / 2);
}

TEST(DesignCell, SearchesTellValidBoxesFromBrokenOnes) {
  std::mt19937 random(4);
  int valid = 0, broken = 0, undecided = 0;
  for (ElementType const type : types)
    for (Shape const& shape : shapes)
      for (int k = 0; k < 12; ++k) {
        auto const cell = random_cell(random, type, 1 + k % 5, 0.3, shape);
        if (cell.sign_at(std::vector<double>(cell.modes.size(), 0)) != JacobianSign::positive) continue;
        auto const witness = detail::look_for_broken_design(cell, 8);
        if (!witness.found()) continue;
        EXPECT_TRUE(cell.broken_at(witness.t));
        for (double const share : {0.5, 0.9, 1.1}) {
          double const size = share * witness.scale;
          auto const answer = detail::search_designs(cell, size, 2000);
          valid += answer.kind == detail::DesignAnswer::Kind::valid ? 1 : 0;
          undecided += answer.kind == detail::DesignAnswer::Kind::undecided ? 1 : 0;
          if (answer.kind == detail::DesignAnswer::Kind::broken) {
            ++broken;
            EXPECT_TRUE(cell.broken_at(answer.broken.t));
            EXPECT_LE(answer.broken.scale, size * (1 + 1e-12));
          }
          EXPECT_TRUE(share < 1 || answer.kind != detail::DesignAnswer::Kind::valid);
          if (answer.kind != detail::DesignAnswer::Kind::valid) continue;
          sample(random, int(cell.modes.size()), size, 200, [&](std::vector<double> const& t) {
            ASSERT_LT(cell.sign_at(t), JacobianSign::negative) << int(type) << " " << share;
          });
        }
      }
  EXPECT_GT(valid, 200);
  EXPECT_GT(broken, 100);
  EXPECT_LT(undecided, (valid + broken) / 20);
}

/// A block over (0 ... 1)^3 with first cells of the given height at z = 0.
Mesh block(int n, double first_height) {
  return one_zone({n, n, n}, [&](Index3 const& i) {
    double const z = i[2] == 0 ? 0 : first_height * std::pow(1 / first_height, double(i[2] - 1) / (n - 2));
    return Vec3{double(i[0]) / (n - 1), double(i[1]) / (n - 1), z};
  });
}

Coordinates zeros(Index n) {
  Coordinates out(n);
  for (Index k = 0; k < n; ++k) out.set(k, {0, 0, 0});
  return out;
}

TEST(DesignBox, OfALayerThatIsSqueezedIsKnown) {
  for (double const h : {0.1, 1e-6}) {
    IndexedMesh const mesh(block(6, h));
    DesignModes designs{mesh.mesh().coordinates, {zeros(mesh.n_nodes())}, 0};
    // The wall moves up by twice the height of the first cells: these are flat at half of it.
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (designs.centre[n].z == 0) designs.modes[0].set(n, {0, 0, 2 * h});
    DesignBox const box = certify_designs({}, mesh, designs);
    EXPECT_NEAR(box.broken, 0.5, 2e-6);
    EXPECT_GT(box.certified, 0.5 * (1 - 0.021));
    EXPECT_LE(box.certified, 0.5);
    ASSERT_EQ(box.design.size(), 1U);
    EXPECT_GT(box.design[0], 0);
    EXPECT_EQ(box.cell[2], 0);
    EXPECT_FALSE(box.holds());
    // Half of the mode: twice the share of the box.
    for (Index n = 0; n < mesh.n_nodes(); ++n) designs.modes[0].set(n, 0.2 * designs.modes[0][n]);
    EXPECT_TRUE(certify_designs({}, mesh, designs).holds());
    DesignBoxOptions far;
    far.limit = 10;
    EXPECT_NEAR(certify_designs({}, mesh, designs, far).broken, 2.5, 1e-5);
  }
}

TEST(DesignBox, RigidModesNeverEnd) {
  IndexedMesh const mesh(block(5, 1e-4));
  DesignModes designs{mesh.mesh().coordinates, {zeros(mesh.n_nodes()), zeros(mesh.n_nodes())}, 0};
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    designs.modes[0].set(n, {3, 0, 0});
    designs.modes[1].set(n, {0, -2, 1});
  }
  DesignBox const box = certify_designs({}, mesh, designs);
  EXPECT_EQ(box.certified, 1);
  EXPECT_TRUE(std::isinf(box.broken));
  EXPECT_EQ(box.zone, -1);
  EXPECT_EQ(box.cells, 64);
}

/// Smooth modes over the block: bends, twists and waves.
std::vector<Coordinates> smooth_modes(Coordinates const& x, int count, double amplitude) {
  std::vector<Coordinates> out;
  for (int i = 0; i < count; ++i) {
    Coordinates mode(x.size());
    for (Index n = 0; n < x.size(); ++n) {
      Vec3 const p = x[n];
      double const w = std::sin((i + 1) * p.x + 0.7 * i) * std::cos(1.3 * (i % 3) * p.y), fade = 1 - p.z;
      mode.set(n, amplitude * fade * Vec3{i % 3 == 0 ? w : 0, i % 3 == 1 ? w : 0, i % 2 == 0 ? w : -w * p.y});
    }
    out.push_back(std::move(mode));
  }
  return out;
}

/// No design of the certified box is broken, as certify() sees it, and that of `broken` is.
void expect_true(IndexedMesh const& mesh, DesignModes const& designs, DesignBox const& box, int count) {
  std::mt19937 random(9);
  auto const at = [&](std::vector<double> const& t) {
    Coordinates x(designs.centre.size());
    for (Index n = 0; n < x.size(); ++n) {
      Vec3 p = designs.centre[n];
      for (std::size_t i = 0; i < t.size(); ++i) p += t[i] * designs.modes[i][n];
      x.set(n, p);
    }
    return certify(mesh, x);
  };
  sample(random, int(designs.modes.size()), box.certified, count,
         [&](std::vector<double> const& t) { ASSERT_TRUE(at(t).holds()); });
  if (!box.design.empty()) {
    Certificate const broken = at(box.design);
    ASSERT_FALSE(broken.holds()) << box.broken;
    EXPECT_GT(broken.negative + broken.undecided, 0);
  }
}

TEST(DesignBox, HoldsForBlocksAndElements) {
  for (double const h : {0.2, 1e-3, 1e-6}) {
    if (reduced() && h == 1e-3) continue;
    Mesh const blocks = block(7, h);
    for (bool const as_elements : {false, true}) {
      IndexedMesh const mesh(as_elements ? as_hexahedra(blocks) : blocks);
      for (int const n : {1, 3, 6}) {
        if (reduced() && n == 6) continue;
        DesignModes const designs{mesh.mesh().coordinates, smooth_modes(mesh.mesh().coordinates, n, 0.4), 0};
        DesignBoxOptions options;
        options.limit = 3;
        DesignBox const box = certify_designs({}, mesh, designs, options);
        EXPECT_GT(box.certified, 0.8 * std::min(3.0, box.broken)) << h << " " << n << " " << box.broken;
        expect_true(mesh, designs, box, 60);
      }
    }
  }
}

/// The search allocates little and computes much: with sanitizers a hundredth of it takes as long.
unsigned seeds() { return reduced() ? 1 : 3; }

/// Boxes of random modes, smooth ones and one that moves each node by itself, of `size` times the given vector.
void expect_true_of(Mesh const& mesh, Vec3 const& size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-1, 1);
  IndexedMesh const indexed(mesh);
  DesignModes designs{mesh.coordinates, {}, 0};
  for (int i = 0; i < 4; ++i) {
    Vec3 const a{off(random), off(random), off(random)}, b{3 * off(random), 3 * off(random), 3 * off(random)};
    designs.modes.push_back(moved(mesh, [&](Vec3 const& p) {
      double const w = i == 3 ? 0.2 : std::sin(dot(b, p) + i);
      Vec3 const v = i == 3 ? Vec3{off(random), off(random), off(random)} : a;
      return w * Vec3{size.x * v.x, size.y * v.y, size.z * v.z};
    }));
  }
  DesignBoxOptions options;
  options.limit = 8;
  DesignBox const box = certify_designs({}, indexed, designs, options);
  EXPECT_EQ(box.negative, 0);
  EXPECT_LT(box.broken, options.limit);
  EXPECT_GT(box.certified, 0.9 * box.broken);
  expect_true(indexed, designs, box, reduced() ? 20 : 200);
  // A box half as wide is certified for twice as much of it.
  for (Coordinates& mode : designs.modes)
    for (Index n = 0; n < mode.size(); ++n) mode.set(n, 0.5 * mode[n]);
  options.limit = 16;
  DesignBox const half = certify_designs({}, indexed, designs, options);
  EXPECT_DOUBLE_EQ(half.broken, 2 * box.broken);
  EXPECT_DOUBLE_EQ(half.certified, 2 * box.certified);
  EXPECT_EQ(half.cell, box.cell);
}

TEST(DesignBox, HoldsForElementsOfAllKinds) {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    expect_true_of(unit_box({3, 3, 4}), {1, 1, 1}, seed);
    expect_true_of(to_prisms_and_tetrahedra(one_zone({4, 5, 5},
                                                     [](Index3 const& i) {
                                                       return wavy({0.3 * i[0], 0.2 * i[1], 0.25 * i[2]}, 0.02);
                                                     }),
                                            2),
                   {1, 1, 1}, seed);
    expect_true_of(flat_box(5, 6, 3), {1, 1, 0}, seed);
  }
}

TEST(DesignBox, HoldsForPyramids) {
  // A cube as six pyramids around its centre.
  ElementCorners const cube = regular(ElementType::hexahedron);
  Mesh pyramids;
  pyramids.source = "pyramids";
  pyramids.add_zone("only", 9);
  pyramids.coordinates = Coordinates(9);
  for (int k = 0; k < 8; ++k) pyramids.coordinates.set(k, cube.at[k]);
  pyramids.coordinates.set(8, {0.5, 0.5, 0.5});
  for (int f = 0; f < 6; ++f) {
    auto const corner = [&](int k) { return Index32(face_corner(ElementType::hexahedron, f, k)); };
    pyramids.add_element(ElementType::pyramid, std::array{corner(3), corner(2), corner(1), corner(0), Index32(8)});
  }
  for (unsigned seed = 1; seed <= seeds(); ++seed) expect_true_of(pyramids, {1, 1, 1}, seed);
}

TEST(DesignBox, HoldsForLeftHandedZones) {
  for (unsigned seed = 1; seed <= seeds(); ++seed) expect_true_of(two_handed_zones(), {1, 1, 1}, seed);
}

TEST(DesignBox, HoldsFarFromTheOriginAndForThinCells) {
  for (double const h : {1e-2, 1e-5}) {
    Mesh mesh = block(6, h);
    mesh.coordinates = moved(mesh, [](Vec3 const& p) {
      return Vec3{p.x + 300, p.y - 500, p.z + 0.1 * std::sin(3 * p.x)};
    });
    // Nodes by themselves move by the height of the first cells.
    expect_true_of(mesh, {1, 1, h}, 7);
  }
}

TEST(DesignBox, LeavesEdgesThatStayCollapsedAlone) {
  // A wedge around the z axis, whose cells there have no edge along j.
  IndexedMesh const mesh(one_zone({4, 4, 3}, [](Index3 const& i) {
    double const r = 0.3 * i[0], a = 0.2 * i[1];
    return Vec3{r * std::cos(a), r * std::sin(a), 0.4 * i[2]};
  }));
  Coordinates const& x = mesh.mesh().coordinates;
  DesignModes const designs{x, smooth_modes(x, 3, 0.1), 0};
  DesignBoxOptions options;
  options.limit = 20;
  DesignBox const box = certify_designs({}, mesh, designs, options);
  EXPECT_EQ(box.flat, 0);
  EXPECT_GT(box.certified, 0.9 * std::min(box.broken, 20.0));
  expect_true(mesh, designs, box, reduced() ? 20 : 200);
}

TEST(DesignBox, OfModesThatAreNoNumbersHoldsNothing) {
  IndexedMesh const mesh(block(4, 0.2));
  DesignModes designs{mesh.mesh().coordinates, {zeros(mesh.n_nodes())}, 0};
  designs.modes[0].set(5, {std::nan(""), 0, 0});
  EXPECT_EQ(certify_designs({}, mesh, designs).certified, 0);
}

TEST(DesignBox, OfManyParametersIsCertifiedToo) {
  IndexedMesh const mesh(block(5, 1e-3));
  DesignModes const designs{mesh.mesh().coordinates, smooth_modes(mesh.mesh().coordinates, reduced() ? 6 : 24, 0.05),
                            0};
  DesignBoxOptions options;
  options.limit = 5;
  DesignBox const box = certify_designs({}, mesh, designs, options);
  EXPECT_GT(box.certified, 0.8 * std::min(5.0, box.broken));
  expect_true(mesh, designs, box, reduced() ? 20 : 200);
}

/// A node in the middle of the block moved beyond its neighbours.
Coordinates with_inverted_cells(Mesh const& mesh) {
  Coordinates x = moved(mesh, [](Vec3 const& p) { return p; });
  Index const node = mesh.zones[0].node({2, 2, 2});
  x.set(node, x[node] + Vec3{0.6, 0.6, 0});
  return x;
}

TEST(DesignBox, LeavesOutCellsThatAreInvertedInTheMesh) {
  Mesh mesh = block(5, 0.2);
  mesh.coordinates = with_inverted_cells(mesh);
  IndexedMesh const indexed(mesh);
  DesignModes const designs{mesh.coordinates, smooth_modes(mesh.coordinates, 2, 0.01), 0};
  DesignBox const box = certify_designs({}, indexed, designs);
  EXPECT_GT(box.negative, 0);
  EXPECT_LT(box.negative, 9);
  EXPECT_EQ(box.certified, 1);
  expect_true(indexed, designs, box, 20);
}

TEST(DesignBox, WhoseCentreBreaksASoundCellHasNothingThatHolds) {
  IndexedMesh const mesh(block(5, 0.2));
  DesignModes const designs{with_inverted_cells(mesh.mesh()), smooth_modes(mesh.mesh().coordinates, 2, 0.01), 0};
  DesignBox const box = certify_designs({}, mesh, designs);
  EXPECT_FALSE(certify(mesh, designs.centre).holds());
  EXPECT_FALSE(box.holds());
  EXPECT_EQ(box.certified, 0);
  EXPECT_EQ(box.broken, 0);
  EXPECT_EQ(box.design, std::vector<double>(2, 0));
  EXPECT_GE(box.zone, 0);
  EXPECT_EQ(box.negative, 0);
}

TEST(DesignBox, SaysWhatItCannotTake) {
  IndexedMesh const mesh(block(4, 0.2));
  EXPECT_THROW((void)certify_designs({}, mesh, {Coordinates(3), {}, 0}), ConfigError);
  EXPECT_THROW((void)certify_designs({}, mesh, {mesh.mesh().coordinates, {Coordinates(3)}, 0}), ConfigError);
}

}  // namespace
}  // namespace gridmorph::test
