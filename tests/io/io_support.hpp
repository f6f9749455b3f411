// Shared by the tests of files: a folder of their own, and a way to look at a file without the code under test.
#pragma once

#include "support/expect_error.hpp"
#include "support/shared_mesh.hpp"
#include "support/temporary_folder.hpp"

#include <gridmorph/mesh/mesh.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace gridmorph::test {

/// Every node of a file: path -> "label|type|dimensions|bytes".
std::map<std::string, std::string> dump_tree(std::string const& path);
/// The bytes at the end of a dump.
inline std::string payload(std::string const& dumped) { return dumped.substr(dumped.find('\n') + 1); }

/// Bit-identical coordinates.
inline void expect_same_coordinates(Coordinates const& a, Coordinates const& b) {
  ASSERT_EQ(a.size(), b.size());
  auto const bytes = std::size_t(a.size()) * sizeof(double);
  EXPECT_EQ(std::memcmp(a.x.data(), b.x.data(), bytes), 0);
  EXPECT_EQ(std::memcmp(a.y.data(), b.y.data(), bytes), 0);
  EXPECT_EQ(std::memcmp(a.z.data(), b.z.data(), bytes), 0);
}

/// Largest distance between nodes that the interfaces of a mesh declare coincident (periodic ones after `declared`).
inline double largest_mismatch(Mesh const& mesh, bool periodic) {
  double worst = 0;
  for (auto const& face : mesh.interfaces) {
    if (face.periodic.has_value() != periodic) continue;
    for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
      for (int j = face.range.begin[1]; j < face.range.end[1]; ++j)
        for (int i = face.range.begin[0]; i < face.range.end[0]; ++i) {
          Index3 const own{i, j, k};
          Vec3 p = mesh.coordinates[mesh.zones[face.zone].node(own)];
          if (face.periodic) p = face.periodic->declared(p);
          worst = std::max(worst, distance(p, mesh.coordinates[mesh.zones[face.donor_zone].node(face.to_donor(own))]));
        }
  }
  return worst;
}

}  // namespace gridmorph::test
