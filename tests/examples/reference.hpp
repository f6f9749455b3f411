// Where nodes of morphed examples and demos were when the files in reference/ were written: a change of results shows,
// with the node that moved and by how much. GRIDMORPH_WRITE_REFERENCE=1 writes the files anew; docs/notes/changes.md
// then says why results changed.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <string>
#include <vector>

namespace gridmorph::test {

/// Some nodes of all zones, the same ones for meshes of as many nodes.
inline std::vector<Index> sampled_nodes(Mesh const& mesh) {
  constexpr Index most = 24;
  std::vector<Index> out;
  for (Index k = 0; k < most; ++k) out.push_back(k * (mesh.n_nodes() - 1) / (most - 1));
  return out;
}

inline void write_reference(std::filesystem::path const& file, Mesh const& mesh) {
  std::ofstream to(file);
  to << mesh.n_nodes() << '\n' << std::setprecision(12);
  for (Index const n : sampled_nodes(mesh)) {
    Vec3 const x = mesh.coordinates[n];
    to << x.x << ' ' << x.y << ' ' << x.z << '\n';
  }
}

/// Nodes where they were, to 1e-9 of the size of the mesh.
inline void expect_as_before(std::string const& name, Mesh const& mesh) {
  auto const file = std::filesystem::path(GRIDMORPH_REFERENCE) / (name + ".txt");
  if (std::getenv("GRIDMORPH_WRITE_REFERENCE") != nullptr) write_reference(file, mesh);
  std::ifstream from(file);
  Index n_nodes = 0;
  ASSERT_TRUE(from >> n_nodes) << file;
  ASSERT_EQ(mesh.n_nodes(), n_nodes) << name;
  double const size = mesh.size();
  for (Index const n : sampled_nodes(mesh)) {
    Vec3 was;
    ASSERT_TRUE(from >> was.x >> was.y >> was.z) << file;
    EXPECT_LE(distance(mesh.coordinates[n], was), 1e-9 * size)
        << name << ": " << describe_node(mesh, n) << " is elsewhere, by " << distance(mesh.coordinates[n], was) / size
        << " of the size of the mesh";
  }
}

}  // namespace gridmorph::test
