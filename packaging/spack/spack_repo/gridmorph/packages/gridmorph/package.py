# Part of the gridmorph project, under the Apache License v2.0 with LLVM Exceptions.
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#
#   spack repo add packaging/spack/spack_repo/gridmorph && spack install gridmorph
import os

from spack_repo.builtin.build_systems.cmake import CMakePackage
from spack_repo.builtin.build_systems.cuda import CudaPackage
from spack_repo.builtin.build_systems.python import PythonExtension
from spack_repo.builtin.build_systems.rocm import ROCmPackage

from spack.package import *

# The sources are the clone that this recipe lies in, unless GRIDMORPH_GIT names another one.
HERE = os.path.dirname(os.path.realpath(__file__))
CLONE = os.path.abspath(os.path.join(HERE, *[os.pardir] * 6))


class Gridmorph(CMakePackage, CudaPackage, ROCmPackage, PythonExtension):
    """Explicit, interpolation-based morphing of CFD meshes: moves an existing volume mesh to a new boundary shape and keeps what
    made it good. A library for solvers, and a command for CGNS, PLOT3D, SU2, OpenFOAM, Gmsh, VTK and UGRID files."""

    git = os.environ.get("GRIDMORPH_GIT", "file://" + CLONE)
    test_requires_compiler = True

    license("Apache-2.0 WITH LLVM-exception")

    version("main", branch="main")
    version("0.2.0", branch="main", preferred=True)

    variant("openmp", default=True, description="Use all cores of a node: Kokkos with OpenMP")
    variant("cli", default=True, description="Build the gridmorph command and the readers and writers of files that it needs")
    variant("io", default=True, description="Build gridmorph::io, which reads and writes mesh files")
    variant("python", default=False, when="+cli", description="Build the Python package")
    variant("shared", default=False, description="Build shared libraries")
    variant("examples", default=False, description="Build the C++ examples")
    variant("benchmarks", default=False, description="Build the benchmarks")

    conflicts("~io", when="+cli", msg="the gridmorph command reads and writes files: +io")
    conflicts("+cuda", when="cuda_arch=none", msg="name the GPU: cuda_arch=90")
    conflicts("+rocm", when="amdgpu_target=none", msg="name the GPU: amdgpu_target=gfx90a")
    conflicts("+cuda", when="+rocm")
    conflicts("%gcc@:11", msg="gridmorph needs C++20 as g++ 12 has it")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")

    # Kokkos 5 has no other standard than C++20; before it is asked for.
    depends_on("kokkos@3.4.00:+serial+pic")
    depends_on("kokkos@3.4.00:+openmp", when="+openmp")
    for arch in CudaPackage.cuda_arch_values:
        depends_on(f"kokkos+cuda+wrapper cuda_arch={arch}", when=f"+cuda cuda_arch={arch}")
    for arch in ROCmPackage.amdgpu_targets:
        depends_on(f"kokkos+rocm amdgpu_target={arch}", when=f"+rocm amdgpu_target={arch}")

    with when("+io"):
        depends_on("cgns@4:+hdf5~mpi")
        depends_on("hdf5@1.10:~mpi")
        depends_on("zlib-api")
    with when("+cli"):
        depends_on("fmt@9:")
        depends_on("cli11@2.1:")
        depends_on("toml11@3.7:")
        depends_on("nlohmann-json@3.11:")
        depends_on("muparser@2.3:")
        depends_on("nanoflann@1.4:")
    with when("+python"):
        extends("python@3.9:")
        depends_on("py-nanobind@2.4:", type="build")
        depends_on("py-numpy@1.22:", type=("build", "run"))
        depends_on("py-tomli-w@1.0:", type="run")
    depends_on("googletest@1.12:", type="test")
    depends_on("benchmark@1.7:", when="+benchmarks")

    def cmake_args(self):
        spec = self.spec
        args = [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("GRIDMORPH_ENABLE_IO", "io"),
            self.define_from_variant("GRIDMORPH_ENABLE_CLI", "cli"),
            self.define("GRIDMORPH_ENABLE_PYTHON", spec.satisfies("+python")),
            self.define_from_variant("GRIDMORPH_ENABLE_EXAMPLES", "examples"),
            self.define_from_variant("GRIDMORPH_ENABLE_BENCHMARKS", "benchmarks"),
            self.define("GRIDMORPH_ENABLE_TESTS", self.run_tests),
            self.define("GRIDMORPH_UNITY_BUILD", True),
            self.define("Kokkos_ROOT", spec["kokkos"].prefix),
        ]
        if spec.satisfies("+io"):
            args.append(self.define("CGNS_ROOT", spec["cgns"].prefix))
            args.append(self.define("HDF5_ROOT", spec["hdf5"].prefix))
        if spec.satisfies("+cuda"):
            args.append(self.define("CMAKE_CXX_COMPILER", self["kokkos"].kokkos_cxx))
        if spec.satisfies("+rocm"):
            args.append(self.define("CMAKE_CXX_COMPILER", spec["hip"].hipcc))
        return args

    def install(self, spec, prefix):
        # The Python package lies below the folder that it is given: that of Python's packages, not the prefix.
        cmake = which("cmake", required=True)
        for component in ("runtime", "development", "documentation"):
            cmake("--install", self.build_directory, "--component", component)
        if spec.satisfies("+python"):
            cmake("--install", self.build_directory, "--component", "python", "--prefix", python_platlib)

    def test_demo(self):
        """run the built-in demo"""
        if self.spec.satisfies("~cli"):
            raise SkipTest("built without the command")
        gridmorph = which(self.prefix.bin.gridmorph, required=True)
        gridmorph("demo", "passage", "--nodes", "20000")
