#include <generators/ball.hpp>

#include <generators/ball_lattice.hpp>

namespace gridmorph {

double rope_end(BallOptions const& options) { return options.radius * (1 + options.rope_length); }

Mesh make_ball(BallOptions const& options) {
  using namespace demo;
  BallCounts const counts = ball_counts(options);
  BallTube const tube(options, counts);
  auto nodes = tube.nodes();
  BallLattice const lattice(options, counts, tube, Index32(nodes.size()));
  auto const outer = lattice.nodes();
  nodes.insert(nodes.end(), outer.begin(), outer.end());
  for (Vec3& x : nodes) x = options.radius * x;

  BallPatches const patches{0, 1, 2};
  WallShell const shell =
      tube.shell(patches, options.layer_elements, [&](int ix, int iy, int iz) { return lattice.at_tube(ix, iy, iz); });
  auto ranks = shell.ranks(nodes.size());
  HybridMesh mesh(std::move(nodes), std::move(ranks));
  for (auto const* name : {"ball", "rope", "crane"}) mesh.add_patch(name, PatchKind::wall, "BCWallViscous");
  shell.add_to(mesh);
  lattice.add_to(mesh, patches);
  if (options.jitter > 0) mesh.jitter(options.jitter);
  if (options.shuffle) mesh.shuffle();
  return mesh.finish("Ball", "ball demo");
}

}  // namespace gridmorph
