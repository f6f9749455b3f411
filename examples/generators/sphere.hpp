// A viscous sphere in a large sphere or cube: layers of prisms (or hexahedra) off a cubed sphere, tetrahedra outside. A
// small mesh of the kind that external flows are computed on; for tests, benchmarks and first steps.
#pragma once

#include <generators/hybrid_mesh.hpp>

namespace gridmorph {

struct SphereOptions {
  enum class Outer { sphere, cube };

  Index elements = 170'000;  ///< wanted; met within a few percent (10,000 to 50 million)
  double radius = 0.5;       ///< of the sphere, whose centre is the origin
  double distance = 4;       ///< from the sphere to the outer boundary, in diameters
  Outer outer = Outer::sphere;
  double first_cell = 1e-3;  ///< height of the first cell, in radii
  double growth = 1.2;       ///< of a layer over the one below
  int layers = 0;            ///< 0: until they are 0.4 times as high as the sphere's faces are long
  LayerElements layer_elements = LayerElements::prisms;
  double jitter = 0.12;  ///< of tetrahedra's nodes, in shortest edges at the node; 0 to 0.3
  bool shuffle = true;   ///< numbers nodes and elements at random
};

/// The mesh: one zone, patches "sphere" (BCWallViscous) and "outer" (BCFarfield). Sphere nodes lie on it to round-off.
/// Throws ConfigError when the options make no such mesh, naming every option that is wrong. Linear in the elements.
Mesh make_sphere(SphereOptions const& options);

}  // namespace gridmorph
