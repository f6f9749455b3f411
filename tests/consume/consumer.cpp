// A program outside gridmorph: builds a small mesh of its own and asks the library about it.
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <iostream>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);

  gridmorph::Mesh mesh;
  int const zone = mesh.add_zone("box", {3, 4, 5});
  mesh.coordinates = gridmorph::Coordinates(mesh.n_nodes());
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 3; ++i)
        mesh.coordinates.set(mesh.zones[zone].node({i, j, k}), gridmorph::Vec3{1.0 * i, 1.0 * j, 1.0 * k});

  double const expected = std::sqrt(2.0 * 2.0 + 3.0 * 3.0 + 4.0 * 4.0);
  bool const good = mesh.n_nodes() == 60 && mesh.n_cells() == 24 && mesh.size() == expected;
  std::cout << gridmorph::describe_node(mesh, 59) << ", size " << mesh.size() << '\n';
  return good ? 0 : 1;
}
