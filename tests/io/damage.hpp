// Files that are cut short or overwritten: a mesh or one clear error, no crash, no hang.
#pragma once

#include "support/temporary_folder.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

namespace gridmorph::test {

/// Reads a file and derives what follows from it, whatever it holds. Returns whether it is a mesh.
inline bool is_mesh_or_error(std::string const& path) {
  try {
    if (mesh_kind(path) != MeshKind::unstructured) return false;
    auto const mesh = read_mesh(path);
    find_face_patches(mesh, make_topology(mesh));
    return true;
  } catch (Error const& e) {
    EXPECT_NE(std::string(e.what()).find("bad"), std::string::npos) << e.what();
    return false;
  }
}

/// Cuts a file everywhere behind `begin` (every step-th byte): what lacks more than its last `harmless` bytes is
/// refused.
inline void expect_refused_where_cut(std::string const& bytes, std::string const& path, std::size_t step,
                                     std::size_t harmless, std::size_t begin = 0) {
  for (std::size_t length = begin; length < bytes.size(); length += step) {
    SCOPED_TRACE(length);
    write_bytes(path, bytes.substr(0, length));
    EXPECT_TRUE(!is_mesh_or_error(path) || length + harmless >= bytes.size());
  }
}

/// Overwrites up to six bytes, by what stands in texts or by anything, and numbers in memory by others that mean much.
inline void expect_no_harm_where_overwritten(std::string const& bytes, std::string const& path, unsigned tries) {
  std::string const alphabet = "0123456789-+.eEna$<>\"=/ \n\t";
  std::array<std::int32_t, 6> const numbers{-1, 0, 1, 1 << 20, 0x7fffffff, -0x7fffffff - 1};
  for (unsigned seed = 0; seed < tries; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = bytes;
    for (unsigned n = 0; n <= seed % 6; ++n) {
      std::size_t const at = random() % damaged.size();
      if (seed % 3 == 2 && at + 4 < damaged.size())
        std::memcpy(damaged.data() + at, &numbers[random() % numbers.size()], 4);
      else
        damaged[at] = seed % 3 == 1 ? char(random()) : alphabet[random() % alphabet.size()];
    }
    write_bytes(path, damaged);
    is_mesh_or_error(path);
  }
}

/// Moves some nodes and none: what a writer keeps and what it replaces. `same_bytes`: of zero motion.
inline void expect_coordinates_replaced(std::string const& input, std::string const& output, bool single,
                                        bool same_bytes = true) {
  Mesh const mesh = read_mesh(input);
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    moved.set(n, mesh.coordinates[n] + (n % 3 == 0 ? Vec3{1.0 / 3, -2.0 / 7, mesh.dimension == 3 ? 1e-9 : 0} : Vec3{}));
  write_morphed(input, output, mesh, mesh.coordinates);
  if (same_bytes) {
    EXPECT_EQ(bytes_of(output), bytes_of(input));
  }
  write_morphed(input, output, mesh, moved);
  Mesh const back = read_mesh(output);
  ASSERT_EQ(back.n_nodes(), mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const want = single ? Vec3{float(moved.x(n)), float(moved.y(n)), float(moved.z(n))} : moved[n];
    EXPECT_EQ(back.coordinates[n], want) << n;
  }
  EXPECT_EQ(back.elements.nodes.item, mesh.elements.nodes.item);
  // And back again, onto itself.
  write_morphed(output, output, back, mesh.coordinates);
  for (Mesh const again = read_mesh(output); Index n : {Index(0), mesh.n_nodes() - 1})
    EXPECT_EQ(again.coordinates[n], mesh.coordinates[n]);
}

}  // namespace gridmorph::test
