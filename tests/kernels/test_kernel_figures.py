#!/usr/bin/env python3
"""Tests of scripts/lib/kernel-figures and keep-ptxas, on what ptxas says of three kernels; no compiler is asked."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import stat
import subprocess
import tempfile
import types
import unittest

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "lib")
LOADER = importlib.machinery.SourceFileLoader("kernel_figures", os.path.join(SCRIPTS, "kernel-figures"))
kernel_figures = importlib.util.module_from_spec(importlib.util.spec_from_loader(LOADER.name, LOADER))
LOADER.exec_module(kernel_figures)

LAUNCH = "_ZN6Kokkos4Impl33cuda_parallel_launch_local_memoryINS0_11ParallelForI%sNS_11RangePolicyIJNS_4CudaENS_9IndexTypeIlEEEEES9_EEEEvT_"
SLIP = LAUNCH % "N9gridmorph7kernels16SlipEndBaselinesINS_9CudaSpaceEEE"
PARAMETERS = LAUNCH % "N9gridmorph7kernels14LineParametersINS_9CudaSpaceELi1EEE"
OF_KOKKOS = ("_ZN6Kokkos4Impl33cuda_parallel_launch_local_memoryINS0_11ParallelForINS0_16ViewValueFunctorINS_6DeviceINS_4CudaENS_9CudaSpaceEEE"
             "N9gridmorph7kernels15SlipEndBaselineEEENS_11RangePolicyIJS5_NS_9IndexTypeIlEENSB_10DestroyTagEEEES5_EEEEvT_")


def said_of(kernel, registers, stack=0, spilled=0, also=""):
    """What ptxas -v says of one kernel; `also`: of a function that it calls."""
    calls = f", {stack} bytes cumulative stack size" if stack else ""
    return (f"ptxas info    : Compiling entry function '{kernel}' for 'sm_90'\n"
            f"ptxas info    : Function properties for {kernel}\n"
            f"    {stack} bytes stack frame, {spilled} bytes spill stores, 0 bytes spill loads\n{also}"
            f"ptxas info    : Used {registers} registers, used 0 barriers{calls}\n"
            "ptxas info    : Compile time = 7.1 ms\n")


class KernelFigures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.list = os.path.join(self.folder.name, "list.txt")

    def tearDown(self):
        self.folder.cleanup()

    def figures(self, *said, options=()):
        """A run on what was said of the kernels of each object."""
        for number, text in enumerate(said):
            objects = os.path.join(self.folder.name, f"objects{number}")
            os.makedirs(objects, exist_ok=True)
            with open(os.path.join(objects, "a.cpp.o.ptxas"), "w", encoding="utf-8") as file:
                file.write("ptxas info    : 0 bytes gmem\n" + text)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            status = kernel_figures.main([self.folder.name, "--list", self.list, *options])
        return types.SimpleNamespace(returncode=status, stdout=out.getvalue())

    def test_tells_kernels_by_names_that_people_read_the_worst_first(self):
        run = self.figures(said_of(PARAMETERS, 60), said_of(SLIP, 40) + said_of(OF_KOKKOS, 200))
        self.assertEqual(run.returncode, 0, run.stdout)
        rows = [line.split() for line in run.stdout.splitlines()]
        self.assertEqual(rows[1:3], [["60", "0", "0", "LineParameters<1>"], ["40", "0", "0", "SlipEndBaselines"]])
        self.assertIn("0 of 2 kernels are above", run.stdout)

    def test_tells_a_lambda_by_its_function(self):
        of = "gridmorph::kernels::ChunkPerTeam<Kokkos::Cuda, gridmorph::detail::Sums, gridmorph::(anonymous namespace)::"
        function = "add<gridmorph::(anonymous namespace)::Row<(gridmorph::detail::Part)1, Kokkos::CudaSpace> >(Kokkos::Cuda const&, int (*)(int))"
        functor = of + function + "::{lambda(gridmorph::kernels::RowOfCells const&, gridmorph::detail::Sums&)#2}>"
        self.assertEqual(kernel_figures.readable(f"void Kokkos::Impl::f<Kokkos::Impl::ParallelFor<{functor}, Kokkos::RangePolicy<Kokkos::Cuda> > >()"),
                         "ChunkPerTeam<Sums, add<Row<(Part)1>>'s lambda 2>")

    def test_refuses_a_kernel_above_the_target_that_is_not_listed(self):
        for said in (said_of(SLIP, 65), said_of(SLIP, 20, stack=8), said_of(SLIP, 20, spilled=4)):
            run = self.figures(said)
            self.assertEqual(run.returncode, 1, run.stdout)
            self.assertIn("SlipEndBaselines is above the target", run.stdout)

    def test_takes_what_is_listed_and_refuses_what_got_worse(self):
        self.assertEqual(self.figures(said_of(SLIP, 250, stack=1392), options=("--write", "--release", "13.0")).returncode, 0)
        same = self.figures(said_of(SLIP, 250, stack=1392))
        self.assertEqual(same.returncode, 0, same.stdout)
        for worse in (said_of(SLIP, 251, stack=1392), said_of(SLIP, 100, stack=1400), said_of(SLIP, 100, stack=8, spilled=4)):
            run = self.figures(worse)
            self.assertEqual(run.returncode, 1, run.stdout)
            self.assertIn("SlipEndBaselines got worse", run.stdout)
            self.assertIn("the list has 250 registers, 1392 bytes of stack, 0 spilled", run.stdout)

    def test_says_what_got_better_and_what_is_gone(self):
        self.figures(said_of(SLIP, 250, stack=1392) + said_of(PARAMETERS, 80), options=("--write",))
        run = self.figures(said_of(SLIP, 96))
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn("better than the list: SlipEndBaselines: 96 registers", run.stdout)
        self.assertIn("better than the list: LineParameters<1> is gone", run.stdout)

    def test_blames_nobody_for_another_release_of_the_compiler(self):
        self.figures(said_of(SLIP, 250), options=("--write", "--release", "13.0"))
        self.assertEqual(self.figures(said_of(SLIP, 251), options=("--release", "13.0")).returncode, 1)
        other = self.figures(said_of(SLIP, 251), options=("--release", "13.5"))
        self.assertEqual(other.returncode, 0, other.stdout)
        self.assertIn("SlipEndBaselines got worse", other.stdout)

    def test_takes_a_kernels_own_stack_and_the_worst_of_its_launches(self):
        called = ("ptxas info    : Function properties for called\n"
                  "    400 bytes stack frame, 16 bytes spill stores, 16 bytes spill loads\n")
        run = self.figures(said_of(SLIP, 30, also=called), said_of(SLIP, 50))
        self.assertEqual(run.stdout.splitlines()[1].split(), ["50", "0", "0", "SlipEndBaselines"])
        self.assertEqual(run.returncode, 0, run.stdout)

    def test_says_that_there_is_nothing_to_read(self):
        with self.assertRaisesRegex(kernel_figures.Unusable, "no figures of kernels"):
            self.figures()
        with self.assertRaisesRegex(kernel_figures.Unusable, "none of them is gridmorph's"):
            self.figures(said_of(OF_KOKKOS, 20))

    def test_the_list_of_the_project_has_only_kernels_above_the_target(self):
        release, listed = kernel_figures.read_list(kernel_figures.LIST)
        self.assertRegex(release, r"^\d+\.\d+$")
        for name, figures in listed.items():
            self.assertTrue(kernel_figures.is_above(name, figures), name)


class KeepPtxas(unittest.TestCase):
    def test_leaves_figures_beside_the_object_and_passes_the_rest_on(self):
        with tempfile.TemporaryDirectory() as folder:
            compiler, thing = os.path.join(folder, "compiler"), os.path.join(folder, "a.o")
            with open(compiler, "w", encoding="utf-8") as file:
                file.write("#!/bin/sh\ncat >&2 <<'EOF'\na.cpp: warning: something\n" + said_of(SLIP, 12) + "EOF\nexit 3\n")
            os.chmod(compiler, stat.S_IRWXU)
            run = subprocess.run([os.path.join(SCRIPTS, "keep-ptxas"), compiler, "-c", "a.cpp", "-o", thing],
                                 capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stdout, run.stderr), (3, "", "a.cpp: warning: something\n"))
            with open(thing + ".ptxas", encoding="utf-8") as file:
                self.assertEqual(file.read(), said_of(SLIP, 12))


if __name__ == "__main__":
    unittest.main()
