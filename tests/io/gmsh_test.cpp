// Meshes of Gmsh, made here by a writer of their own: versions, text and binary, groups, periodic links, second order,
// damage.
#include "io/damage.hpp"
#include "io/second_order.hpp"
#include "support/expect_error.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <sstream>
#include <vector>

namespace gridmorph::test {
namespace {

struct Storage {
  int version = 41;
  bool binary = false, swapped = false;
};
void PrintTo(Storage const& s, std::ostream* out) { *out << s.version << (s.binary ? " binary" : " text"); }

/// Elements of one type on one piece of geometry.
struct Block {
  int dimension = 3, entity = 1, type = 4;
  std::vector<std::vector<std::int64_t>> nodes;  ///< tags
};

struct MshMesh {
  std::vector<std::int64_t> tags;
  std::vector<Vec3> places;
  std::vector<Block> blocks;
  std::map<std::pair<int, int>, std::vector<int>> physical;  ///< of (dimension, entity)
  std::map<std::pair<int, int>, std::string> names;
  std::map<std::pair<int, int>, std::array<int, 2>>
      cut_from;                                       ///< of pieces of parts: dimension and entity of the whole
  std::vector<std::array<std::int64_t, 2>> periodic;  ///< image, master
  std::string affine;                                 ///< of these
  int periodic_dimension = 2;
  bool parametric = false;

  [[nodiscard]] std::string text(Storage const& how) const { return Writer{*this, how, {}}.run(); }

 private:
  struct Writer {
    MshMesh const& mesh;
    Storage how;
    std::string out;

    template <class T>
    void raw(T value) {
      std::array<char, sizeof(T)> bytes;
      std::memcpy(bytes.data(), &value, sizeof(T));
      if (how.swapped) std::reverse(bytes.begin(), bytes.end());
      out.append(bytes.data(), bytes.size());
    }
    void word(std::int64_t v) { out += std::to_string(v) + " "; }
    void i(std::int64_t v) { how.binary ? raw(std::int32_t(v)) : word(v); }
    void s(std::int64_t v) { how.binary&& how.version == 41 ? raw(v) : i(v); }
    void d(double v) {
      if (how.binary) return raw(v);
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%.17g ", v);
      out += text.data();
    }
    void line() {
      if (!how.binary) out += "\n";
    }

    std::string run() {
      out = how.version == 22 ? "$MeshFormat\n2.2 " : how.version == 40 ? "$MeshFormat\n4 " : "$MeshFormat\n4.1 ";
      out += how.binary ? "1 8\n" : "0 8\n";
      if (how.binary) {
        raw(std::int32_t(1));
        out += "\n";
      }
      out += "$EndMeshFormat\n";
      if (!mesh.names.empty()) {
        out += "$PhysicalNames\n" + std::to_string(mesh.names.size()) + "\n";
        for (auto const& [key, name] : mesh.names)
          out += std::to_string(key.first) + " " + std::to_string(key.second) + " \"" + name + "\"\n";
        out += "$EndPhysicalNames\n";
      }
      if (how.version != 22) entities();
      nodes();
      elements();
      if (!mesh.periodic.empty()) periodic();
      out += "$NodeData\n1\n\"anything\"\n$EndNodeData\n";
      return out;
    }

    void entities() {
      out += "$Entities\n";
      pieces(false);
      out += "\n$EndEntities\n";
      if (mesh.cut_from.empty()) return;
      out += "$PartitionedEntities\n";
      s(2);
      s(1);
      line();
      i(77);
      i(2);
      line();
      pieces(true);
      out += "\n$EndPartitionedEntities\n";
    }

    void pieces(bool of_parts) {
      std::array<std::vector<std::pair<int, std::vector<int>>>, 4> of;
      for (auto const& [key, groups] : mesh.physical)
        if (mesh.cut_from.contains(key) == of_parts) of[key.first].emplace_back(key.second, groups);
      for (auto const& list : of) s(std::int64_t(list.size()));
      line();
      for (int dimension = 0; dimension < 4; ++dimension)
        for (auto const& [tag, groups] : of[dimension]) {
          i(tag);
          if (of_parts) {
            for (int const whole : mesh.cut_from.at({dimension, tag})) i(whole);
            s(1);
            i(1 + tag % 2);
          }
          for (int c = 0; c < (dimension == 0 && how.version == 41 ? 3 : 6); ++c) d(0.5 * c);
          s(std::int64_t(groups.size()));
          for (int const g : groups) i(g);
          if (dimension > 0) {
            s(1);
            i(-1);
          }
          line();
        }
    }

    void parameters(int dimension) {
      for (int c = 0; c < dimension; ++c) d(0.25);
    }

    void nodes() {
      std::size_t const n = mesh.tags.size();
      bool const old_parametric = how.version == 22 && mesh.parametric;
      out += old_parametric ? "$ParametricNodes\n" : "$Nodes\n";
      auto const place = [&](std::size_t k) {
        for (double const c : {mesh.places[k].x, mesh.places[k].y, mesh.places[k].z}) d(c);
      };
      if (how.version == 22) {
        out += std::to_string(n) + "\n";
        for (std::size_t k = 0; k < n; ++k) {
          i(mesh.tags[k]);
          place(k);
          if (mesh.parametric) {
            i(std::int64_t(k % 3));
            i(7);
            parameters(int(k % 3));
          }
          line();
        }
        out += old_parametric ? "$EndParametricNodes\n" : "$EndNodes\n";
        return;
      }
      // Two blocks, the second one with parameters where the mesh has them.
      std::size_t const half = n / 2;
      s(2);
      s(std::int64_t(n));
      if (how.version == 41) {
        s(*std::min_element(mesh.tags.begin(), mesh.tags.end()));
        s(*std::max_element(mesh.tags.begin(), mesh.tags.end()));
      }
      line();
      for (auto const& [begin, end, dimension] : {std::tuple(std::size_t(0), half, 3), std::tuple(half, n, 2)}) {
        bool const with = mesh.parametric && dimension == 2;
        i(how.version == 41 ? dimension : 1);
        i(how.version == 41 ? 1 : dimension);
        i(with);
        s(std::int64_t(end - begin));
        line();
        if (how.version == 41)
          for (std::size_t k = begin; k < end; ++k) {
            s(mesh.tags[k]);
            line();
          }
        for (std::size_t k = begin; k < end; ++k) {
          if (how.version == 40) i(mesh.tags[k]);
          place(k);
          if (with) parameters(2);
          line();
        }
      }
      out += "\n$EndNodes\n";
    }

    void elements() {
      std::int64_t number = 0, count = 0;
      for (Block const& b : mesh.blocks) {
        auto const groups = mesh.physical.find({b.dimension, b.entity});
        count += std::int64_t(b.nodes.size()) * (how.version == 22 && groups != mesh.physical.end()
                                                     ? std::max<std::int64_t>(1, std::int64_t(groups->second.size()))
                                                     : 1);
      }
      out += "$Elements\n";
      if (how.version == 22) {
        out += std::to_string(count) + "\n";
      } else {
        s(std::int64_t(mesh.blocks.size()));
        s(count);
        if (how.version == 41) {
          s(1);
          s(count);
        }
        line();
      }
      for (Block const& b : mesh.blocks) {
        auto const found = mesh.physical.find({b.dimension, b.entity});
        auto groups = found == mesh.physical.end() ? std::vector<int>() : found->second;
        if (how.version != 22) {
          i(how.version == 41 ? b.dimension : b.entity);
          i(how.version == 41 ? b.entity : b.dimension);
          i(b.type);
          s(std::int64_t(b.nodes.size()));
          line();
          groups.clear();
        }
        if (groups.empty()) groups.push_back(0);
        for (auto const& nodes : b.nodes)
          for (int const g : groups) {
            ++number;
            if (how.version == 22 && how.binary) {
              for (int const head : {b.type, 1, 2, int(number), g, b.entity}) i(head);
            } else if (how.version == 22) {
              for (int const head : {int(number), b.type, 2, g, b.entity}) i(head);
            } else {
              s(number);
            }
            for (std::int64_t const n : nodes) s(n);
            line();
          }
      }
      out += "\n$EndElements\n";
    }

    void periodic() {
      out += "$Periodic\n";
      bool const raw_numbers = how.version == 41;
      auto const small = [&](std::int64_t v) { raw_numbers ? i(v) : word(v); };
      auto const large = [&](std::int64_t v) { raw_numbers ? s(v) : word(v); };
      auto const newline = [&] { raw_numbers ? line() : void(out += "\n"); };
      large(1);
      newline();
      for (int const v : {mesh.periodic_dimension, 2, 1}) small(v);
      newline();
      if (!raw_numbers && !mesh.affine.empty()) out += "Affine " + mesh.affine + "\n";
      if (raw_numbers) {
        large(mesh.affine.empty() ? 0 : 16);
        std::istringstream words(mesh.affine);
        for (double v = 0; words >> v;) d(v);
        newline();
      }
      large(std::int64_t(mesh.periodic.size()));
      newline();
      for (auto const& [image, master] : mesh.periodic) {
        large(image);
        large(master);
        newline();
      }
      out += "\n$EndPeriodic\n";
    }
  };
};

int msh_type(ElementType type) {
  switch (type) {
    case ElementType::triangle: return 2;
    case ElementType::quadrilateral: return 3;
    case ElementType::tetrahedron: return 4;
    case ElementType::hexahedron: return 5;
    case ElementType::prism: return 6;
    default: return 7;
  }
}

/// The elements of a mesh, its patches as surfaces 1, 2, ... of physical groups 11, 12, ...; node numbers far apart and
/// in no order.
MshMesh msh_of(Mesh const& mesh) {
  MshMesh out;
  auto const tag = [&](Index n) {
    return std::int64_t(100 + 13 * ((7 * n) % (mesh.n_nodes() + (mesh.n_nodes() % 7 == 0 ? 1 : 0))));
  };
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    out.tags.push_back(tag(n));
    out.places.push_back(mesh.coordinates[n]);
  }
  auto const row = [&](std::span<Index32 const> nodes) {
    std::vector<std::int64_t> tags;
    for (Index32 const n : nodes) tags.push_back(tag(n));
    return tags;
  };
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    int const type = msh_type(mesh.elements.type[e]);
    if (out.blocks.empty() || out.blocks.back().type != type) out.blocks.push_back({mesh.dimension, 1, type, {}});
    out.blocks.back().nodes.push_back(row(mesh.elements.corners(e)));
  }
  out.physical[{mesh.dimension, 1}] = {5};
  int surface = 0;
  for (Patch const& patch : mesh.patches) {
    ++surface;
    for (Index f = 0; f < patch.faces.size(); ++f) {
      int const type = int(patch.faces[f].size()) - 1;
      if (f == 0 || out.blocks.back().type != type) out.blocks.push_back({mesh.dimension - 1, surface, type, {}});
      out.blocks.back().nodes.push_back(row(patch.faces[f]));
    }
    out.physical[{mesh.dimension - 1, surface}] = {10 + surface};
    out.names[{mesh.dimension - 1, 10 + surface}] = patch.name;
  }
  return out;
}

Mesh box() { return to_prisms_and_tetrahedra(unit_box({2, 3, 3}), 1); }

class Gmsh : public testing::TestWithParam<Storage> {
 protected:
  Mesh read(MshMesh const& mesh) {
    write_bytes(path_, mesh.text(GetParam()));
    return read_mesh(path_);
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.msh");
};
INSTANTIATE_TEST_SUITE_P(As, Gmsh,
                         testing::Values(Storage{22, false}, Storage{22, true}, Storage{40, false}, Storage{41, false},
                                         Storage{41, true}, Storage{22, true, true}, Storage{41, true, true}),
                         [](auto const& info) {
                           return std::to_string(info.param.version) + (info.param.binary ? "binary" : "text") +
                                  (info.param.swapped ? "swapped" : "");
                         });

TEST_P(Gmsh, MeshesAreReadAsTheyAre) {
  for (Mesh const& want : {box(), to_hexahedra(unit_box({2, 2, 3})), flat_box(4, 3, 1)}) {
    Mesh const mesh = read(msh_of(want));
    EXPECT_EQ(mesh_kind(path_), MeshKind::unstructured);
    EXPECT_EQ(look_at_mesh(path_).format, MeshFormat::gmsh);
    EXPECT_EQ(mesh.dimension, want.dimension);
    EXPECT_EQ(mesh.elements.type, want.elements.type);
    EXPECT_EQ(mesh.elements.nodes.item, want.elements.nodes.item);
    ASSERT_EQ(mesh.n_nodes(), want.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(mesh.coordinates[n], want.coordinates[n]);
    ASSERT_EQ(mesh.patches.size(), want.patches.size());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      EXPECT_EQ(mesh.patches[p].name, want.patches[p].name);
      EXPECT_EQ(mesh.patches[p].faces.item, want.patches[p].faces.item);
    }
    EXPECT_TRUE(negative_elements(mesh).empty());
  }
}

TEST_P(Gmsh, OnlyCoordinatesThatMoveChange) {
  for (bool const parametric : {false, true}) {
    MshMesh msh = msh_of(box());
    msh.parametric = parametric;
    read(msh);
    expect_coordinates_replaced(path_, folder_.file("out.msh"), false);
  }
}

TEST_P(Gmsh, ElementsOfSeveralGroupsAreOnePatchOfAllOfThem) {
  MshMesh msh = msh_of(box());
  msh.physical[{2, 1}] = {11, 30};
  msh.physical[{2, 2}] = {12, 30};
  msh.physical[{2, 3}] = {};
  msh.physical[{2, 4}] = {44};
  msh.physical[{3, 1}] = {5, 6};
  msh.names[{2, 30}] = "both";
  Mesh const mesh = read(msh), want = box();
  EXPECT_EQ(mesh.n_elements(), want.n_elements());
  ASSERT_EQ(mesh.patches.size(), want.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(mesh.patches[p].faces.item, want.patches[p].faces.item);
  std::string const first = want.patches[0].name;
  EXPECT_EQ(mesh.patches[0].name, first + " + both");
  EXPECT_EQ(mesh.patches[0].families, (std::vector<std::string>{first, "both"}));
  EXPECT_EQ(mesh.patches[2].name, "surface 3");
  EXPECT_EQ(mesh.patches[3].name, "physical surface 44");
}

/// The elements of each piece of geometry in two parts, and the faces where the parts of the volume meet, which are of
/// its physical group.
MshMesh in_parts(MshMesh whole) {
  MshMesh out = whole;
  out.blocks.clear();
  std::map<std::pair<int, int>, std::vector<int>> const groups = whole.physical;
  auto const part = [&](Block const& of, int entity, std::size_t begin, std::size_t end, std::array<int, 2> cut_from) {
    out.blocks.push_back({of.dimension,
                          entity,
                          of.type,
                          {of.nodes.begin() + std::ptrdiff_t(begin), of.nodes.begin() + std::ptrdiff_t(end)}});
    out.cut_from[{of.dimension, entity}] = cut_from;
    out.physical[{of.dimension, entity}] = groups.at({cut_from[0], cut_from[1]});
  };
  for (Block const& b : whole.blocks) {
    std::size_t const half = b.nodes.size() / 2;
    part(b, 100 + 2 * b.entity, 0, half, {b.dimension, b.entity});
    part(b, 101 + 2 * b.entity, half, b.nodes.size(), {b.dimension, b.entity});
  }
  // Any corners of a tetrahedron will do.
  auto const tetrahedra =
      std::find_if(whole.blocks.begin(), whole.blocks.end(), [](auto const& b) { return b.type == 4; });
  auto face = tetrahedra->nodes.front();
  face.pop_back();
  part({2, 0, 2, {face}}, 300, 0, 1, {3, 1});
  return out;
}

TEST(GmshInParts, IsTheMeshThatItWasCutFrom) {
  for (bool const binary : {false, true}) {
    TemporaryFolder folder;
    MshMesh whole = msh_of(box());
    whole.physical[{2, 3}] = {};  // of no group: by its piece of geometry
    for (Index n = 0; n < box().n_nodes(); ++n)
      if (n % 3 == 2) whole.periodic.push_back({whole.tags[n], whole.tags[std::size_t(n) - 2]});
    write_bytes(folder.file("whole.msh"), whole.text({41, binary}));
    write_bytes(folder.file("parts.msh"), in_parts(whole).text({41, binary}));
    Mesh const want = read_mesh(folder.file("whole.msh")), mesh = read_mesh(folder.file("parts.msh"));
    EXPECT_EQ(mesh.elements.nodes.item, want.elements.nodes.item);
    ASSERT_EQ(mesh.patches.size(), want.patches.size());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      EXPECT_EQ(mesh.patches[p].name, want.patches[p].name);
      EXPECT_EQ(mesh.patches[p].faces.item, want.patches[p].faces.item);
    }
    EXPECT_EQ(mesh.connections.size(), 1U);
    expect_coordinates_replaced(folder.file("parts.msh"), folder.file("out.msh"), false);
  }
}

TEST_P(Gmsh, NodesOfNoElementAreLeftWhereTheyAre) {
  MshMesh msh = msh_of(box());
  msh.tags.insert(msh.tags.begin() + 3, 7);  // the centre of a circle
  msh.places.insert(msh.places.begin() + 3, {70, 71, 72});
  msh.blocks.push_back({0, 9, 15, {{7}}});
  Mesh const mesh = read(msh);
  EXPECT_EQ(mesh.n_nodes(), box().n_nodes());
  EXPECT_TRUE(std::any_of(mesh.notes.begin(), mesh.notes.end(),
                          [](auto const& n) { return n.find("1 nodes belong to no element") != std::string::npos; }));
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.1, 0.2, 0.3});
  write_morphed(path_, path_, mesh, moved);
  Mesh const back = read_mesh(path_);
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], moved[n]);
}

TEST_P(Gmsh, FacesInNoGroupThatWereNotSavedAreAPatch) {
  MshMesh msh = msh_of(box());
  auto const is_first = [](Block const& b) { return b.dimension == 2 && b.entity == 1; };
  std::erase_if(msh.blocks, is_first);
  Mesh const mesh = read(msh), want = box();
  ASSERT_EQ(mesh.patches.size(), want.patches.size());
  EXPECT_EQ(mesh.patches.back().name, "boundary");
  EXPECT_EQ(patch_nodes(mesh.patches.back()), patch_nodes(want.patches[0]));
  EXPECT_EQ(mesh.patches.back().faces.size(), want.patches[0].faces.size());
  // Volumes that were not saved leave a shell behind.
  std::erase_if(msh.blocks, [](Block const& b) { return b.dimension == 3; });
  Mesh const shell = read(msh);
  EXPECT_TRUE(std::any_of(shell.notes.begin(), shell.notes.end(),
                          [](auto const& n) { return n.find("no volumes") != std::string::npos; }));
}

/// A sector between two planes through the x axis, with the file's transform and with none.
TEST_P(Gmsh, PeriodicLinksAreConnections) {
  double const angle = 0.3;
  Mesh sector = box();
  for (Index n = 0; n < sector.n_nodes(); ++n) {
    Vec3 const p = sector.coordinates[n];
    double const a = angle * p.x / 2, r = 3 + p.y;
    sector.coordinates.set(n, {p.z, r * std::cos(a), r * std::sin(a)});
  }
  for (bool const declared : {false, true})
    for (bool const turned : {false, true}) {
      Mesh const source = turned ? sector : box();
      MshMesh msh = msh_of(source);
      for (Index n = 0; n < source.n_nodes(); ++n)
        if (n % 3 == 2) msh.periodic.push_back({msh.tags[n], msh.tags[std::size_t(n) - 2]});
      std::array<char, 400> text{};
      std::snprintf(text.data(), text.size(), "1 0 0 0 0 %.17g %.17g 0 0 %.17g %.17g 0 0 0 0 1", std::cos(angle),
                    -std::sin(angle), std::sin(angle), std::cos(angle));
      if (declared) msh.affine = turned ? text.data() : "1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1";
      Mesh const mesh = read(msh);
      ASSERT_EQ(mesh.connections.size(), 1U);
      Connection const& c = mesh.connections.front();
      ASSERT_TRUE(c.periodic);
      EXPECT_EQ(c.nodes.size(), 16U);
      for (std::size_t n = 0; n < c.nodes.size(); ++n)
        EXPECT_LT(distance(c.periodic->declared(mesh.coordinates[c.nodes[n]]), mesh.coordinates[c.donor_nodes[n]]),
                  1e-14);
      EXPECT_NEAR(norm(c.periodic->rotation_angle_rad), turned ? angle : 0, 1e-14);
    }
}

/// Nodes amid the edges and faces of a curved mesh, in Gmsh's order, come out amid those of the SIDS.
TEST_P(Gmsh, NodesOfSecondOrderElementsComeInTheOrderOfTheStandard) {
  struct Case {
    ElementType type;
    int msh_type;
    std::vector<std::vector<int>> amid;  ///< corners that a further node lies amid, in Gmsh's order
  };
  // Reference manual of Gmsh 4, "Node ordering".
  std::vector<Case> const cases{
      {ElementType::tetrahedron, 11, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}},
      {ElementType::hexahedron,
       12,
       {{0, 1},
        {0, 3},
        {0, 4},
        {1, 2},
        {1, 5},
        {2, 3},
        {2, 6},
        {3, 7},
        {4, 5},
        {4, 7},
        {5, 6},
        {6, 7},
        {0, 1, 2, 3},
        {0, 1, 4, 5},
        {0, 3, 4, 7},
        {1, 2, 5, 6},
        {2, 3, 6, 7},
        {4, 5, 6, 7},
        {0, 1, 2, 3, 4, 5, 6, 7}}},
      {ElementType::prism,
       13,
       {{0, 1},
        {0, 2},
        {0, 3},
        {1, 2},
        {1, 4},
        {2, 5},
        {3, 4},
        {3, 5},
        {4, 5},
        {0, 1, 3, 4},
        {0, 2, 3, 5},
        {1, 2, 4, 5}}},
      {ElementType::pyramid, 14, {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}, {0, 1, 2, 3}}}};
  for (Case const& one : cases) {
    MshMesh msh;
    auto const add = [&](Vec3 const& p) {
      msh.tags.push_back(std::int64_t(msh.tags.size()) + 1);
      msh.places.push_back(p);
    };
    for (Vec3 const& p : places_amid(one.type, one.amid)) add(p);
    msh.blocks.push_back({3, 1, one.msh_type, {msh.tags}});
    Mesh const mesh = read(msh);
    ASSERT_EQ(mesh.n_elements(), 1);
    ASSERT_EQ(mesh.elements.type[0], one.type);
    ASSERT_EQ(mesh.elements.nodes[0].size(), msh.tags.size());
    expect_nodes_amid(mesh);
  }
}

TEST_P(Gmsh, DamagedFilesGiveAMeshOrAnError) {
  MshMesh msh = msh_of(to_prisms_and_tetrahedra(unit_box({1, 1, 2}), 1));
  std::string const plain = msh.text(GetParam()), bad = folder_.file("bad.msh");
  std::size_t const step = GetParam().binary ? 3 : 4;
  // What follows the elements is no loss.
  auto const from = [](std::string const& text, char const* section) { return text.size() - text.find(section) + 1; };
  expect_refused_where_cut(plain, bad, step, from(plain, "$NodeData"));
  for (std::size_t n = 1; n < msh.tags.size(); n += 2) msh.periodic.push_back({msh.tags[n], msh.tags[n - 1]});
  std::string const whole = msh.text(GetParam());
  expect_refused_where_cut(whole, bad, step, from(whole, "$NodeData"), whole.find("$Periodic") + 1);
  expect_no_harm_where_overwritten(whole, bad, 400);
}

class GmshErrors : public testing::Test {
 protected:
  std::string error(std::string const& what, std::string const& by) {
    std::string text = msh_of(flat_box(2, 1, 1)).text({});
    auto const at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    write_bytes(path_, text.replace(at, what.size(), by));
    return message_of<Error>([&] { read_mesh(path_); });
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.msh");
};

TEST_F(GmshErrors, SayWhatComesFirstInTheFile) {
  auto const said = [&](std::string const& nodes) {
    write_bytes(path_, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n" + nodes +
                           "$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n");
    return message_of<Error>([&] { read_mesh(path_); });
  };
  // Numbers so far apart that they are sorted: the largest is repeated first.
  expect_all_in(said("1 0 0 0\n9000000 1 0 0\n3 0 1 0\n9000000 1 1 0\n1 2 0 0\n3 2 2 0\n"),
                {"mesh.msh:9", "node 9000000 is there twice"});
  // Dense ones, then what is no number.
  expect_all_in(said("1 0 0 0\n2 1 0 0\n2 0 1 0\n4 zero 1 0\n1 2 0 0\n3 2 2 0\n"),
                {"mesh.msh:8", "node 2 is there twice"});
  expect_all_in(said("1 0 0 0\n2 1 0 0\n3 0 one 0\n4 0 1 0\n1 2 0 0\n3 2 2 0\n"), {"mesh.msh:8", "'one'"});
}

TEST_F(GmshErrors, SayWhereWhatAndWhatToDo) {
  expect_all_in(error("4.1 0 8", "1.0 0 8"), {"mesh.msh:2", "MSH 1.0", "gmsh -save FILE -format msh41"});
  expect_all_in(error("4.1 0 8", "4.1 0 4"), {"mesh.msh:2", "4 bytes"});
  expect_all_in(error("4.1 0 8", "4.1 2 8"), {"mesh.msh:2", "file type is 2"});
  expect_all_in(error("$Nodes\n2 6 ", "$Nodes\n2 6000000000000 "),
                {"the number of nodes is 6000000000000", "whole copy"});
  expect_all_in(error("$Nodes\n2 6 ", "$Nodes\n2 5 "), {"blocks hold more nodes than the 5"});
  expect_all_in(error("$Nodes\n2 6 ", "$Nodes\n2 7 "), {"blocks hold 6 nodes", "says 7"});
  expect_all_in(error("113 \n", "100 \n"), {"node 100 is there twice"});
  expect_all_in(error("1 100 ", "1 55 "), {"element 1 has node 55", "6 nodes of the file"});
  expect_all_in(error("2 1 3 2 ", "2 1 26 2 "), {"elements of type 26", "-order 1"});
  expect_all_in(error("1 0 0 ", "1 nan 0 "), {"not finite numbers", "node 2"});
  expect_all_in(error("1 0 0 ", "1 zero 0 "), {"expected a coordinate", "'zero'"});
  expect_all_in(error("$EndNodes", "$EndNods"), {"expected $EndNodes", "'$EndNods'"});
  expect_all_in(error("$EndEntities", "$EndEntities\n$PartitionedEntities\n2 0\n0 0 1 0\n7 0 1 "),
                {"mesh.msh:2", "a part of dimension 2 is cut from one of dimension 0"});
  expect_all_in(error("$EndElements", "$EndElements\n17"), {"expected the beginning of a section", "'17'"});
}

}  // namespace
}  // namespace gridmorph::test
