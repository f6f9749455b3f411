#include <warp.hpp>

#include <Kokkos_Core.hpp>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  gridmorph::Mesh const mesh = collapsed_box({2, 3, 4});
  return mesh.n_nodes() == 24 && mesh.size() == 0.0 ? 0 : 1;
}
