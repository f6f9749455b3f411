#!/usr/bin/env python3
"""Tests of scripts/convert-mesh: to VTK, through gridmorph where its executable is given, and back; skipped where meshio is not installed.

  test_convert_mesh.py [GRIDMORPH]
"""
import os
import subprocess
import sys
import tempfile
import unittest

GRIDMORPH = os.path.realpath(sys.argv.pop(1)) if len(sys.argv) > 1 and os.path.exists(sys.argv[1]) else None
CONVERT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "convert-mesh")

try:
    import meshio
    import numpy
except ImportError:
    meshio = None


def box(n):
    """Tetrahedra (six for each cell) and triangles of a box, sets of triangles "floor" and "rest"."""
    points = numpy.array([[i, j, k] for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)], dtype=float) / n
    node = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)
    tetrahedra = []
    for k in range(n):
        for j in range(n):
            for i in range(n):
                for a, b in (((1, 0, 0), (1, 1, 0)), ((1, 1, 0), (0, 1, 0)), ((0, 1, 0), (0, 1, 1)), ((0, 1, 1), (0, 0, 1)), ((0, 0, 1), (1, 0, 1)), ((1, 0, 1), (1, 0, 0))):
                    tetrahedra.append([node(i, j, k), node(i + a[0], j + a[1], k + a[2]), node(i + b[0], j + b[1], k + b[2]), node(i + 1, j + 1, k + 1)])
    sides = {}
    for t in tetrahedra:
        for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
            nodes = [t[c] for c in face]
            key = tuple(sorted(nodes))
            if sides.pop(key, None) is None:
                sides[key] = nodes
    triangles = list(sides.values())
    floor = [t for t, nodes in enumerate(triangles) if (points[nodes][:, 2] == 0).all()]
    rest = sorted(set(range(len(triangles))) - set(floor))
    return points, tetrahedra, triangles, floor, rest


@unittest.skipIf(meshio is None, "meshio is not installed for " + sys.executable)
class ConvertMesh(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.points, self.tetrahedra, self.triangles, self.floor, self.rest = box(3)
        cells = [("tetra", self.tetrahedra), ("triangle", self.triangles)]
        none = numpy.array([], dtype=int)
        sets = {"floor": [none, numpy.array(self.floor)], "rest": [none, numpy.array(self.rest)]}
        meshio.write(self.path("box.inp"), meshio.Mesh(self.points, cells, cell_sets=sets))
        numbers = numpy.where(numpy.isin(numpy.arange(len(self.triangles)), self.floor), 7, 11)
        meshio.write(self.path("box.bdf"), meshio.Mesh(self.points, cells, cell_data={"nastran:ref": [numpy.full(len(self.tetrahedra), 1), numbers]}))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def convert(self, *arguments, status=0):
        done = subprocess.run([sys.executable, "-B", CONVERT, *arguments], cwd=self.folder.name, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def morph(self, patch):
        with open(self.path("case.toml"), "w") as case:
            case.write('[mesh]\ninput = "box.vtu"\noutput = "moved.vtu"\n[[motion]]\npatches = "' + patch + '"\nrule = "formula"\ndz = "0.1 * sin(pi * x) * sin(pi * y)"\n')
        done = subprocess.run([GRIDMORPH, "--quiet", "morph", "case.toml"], cwd=self.folder.name, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_sets_become_patches_and_points_come_back(self):
        said = self.convert("box.inp", "box.vtu")
        self.assertIn("floor, rest", said)
        with open(self.path("box.vtu"), "rb") as file:
            self.assertIn(b"PatchNames", file.read())
        moved = self.points + [0, 0, 0]
        if GRIDMORPH is None:
            return
        inspect = subprocess.run([GRIDMORPH, "inspect", "--quiet", "box.vtu"], cwd=self.folder.name, capture_output=True, text=True)
        for name, n in (("floor", len(self.floor)), ("rest", len(self.rest))):
            self.assertRegex(inspect.stdout, rf"{name} +BC +\w+ +{n} ")
        self.morph("floor")
        self.convert("--back", "moved.vtu", "box.inp", "out.inp")
        before, after = meshio.read(self.path("box.inp")), meshio.read(self.path("out.inp"))
        on_floor = self.points[:, 2] == 0
        moved[on_floor, 2] += 0.1 * numpy.sin(numpy.pi * moved[on_floor, 0]) * numpy.sin(numpy.pi * moved[on_floor, 1])
        self.assertLess(abs(after.points - moved)[on_floor].max(), 1e-12)
        self.assertLess(abs(after.points - moved)[self.points[:, 2] == 1].max(), 1e-12)
        for old, new in zip(before.cells, after.cells):
            self.assertEqual(old.type, new.type)
            numpy.testing.assert_array_equal(old.data, new.data)
        self.assertEqual(sorted(before.cell_sets), sorted(after.cell_sets))

    def test_numbers_become_patches(self):
        said = self.convert("box.bdf", "box.vtu")
        self.assertRegex(said, r"patches: \S+ 7, \S+ 11")
        mesh = meshio.read(self.path("box.bdf"))
        self.assertEqual(len(mesh.points), len(self.points))

    def test_what_cannot_be_done_is_said(self):
        self.assertIn("has to end in .vtu", self.convert("box.inp", "box.cgns", status=2))
        self.assertIn("absent.inp", self.convert("absent.inp", "box.vtu", status=2))
        with open(self.path("bad.inp"), "w") as file:
            file.write("*NODE\n1, zero, 0, 0\n")
        self.assertIn("bad.inp: cannot be read by meshio", self.convert("bad.inp", "box.vtu", status=2))
        self.convert("box.inp", "box.vtu")
        points, tetrahedra, *_ = box(2)
        meshio.write(self.path("other.inp"), meshio.Mesh(points, [("tetra", tetrahedra)]))
        self.assertIn("give the mesh that the first one was made from", self.convert("--back", "box.vtu", "other.inp", "out.inp", status=2))
        self.assertFalse(os.path.exists(self.path("out.inp")))


class WithoutMeshio(unittest.TestCase):
    def test_the_script_says_what_is_missing(self):
        # A folder of that name that is no package hides what is installed.
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "meshio.py"), "w") as file:
                file.write("raise ImportError('hidden', name='meshio')\n")
            done = subprocess.run([sys.executable, "-B", CONVERT, "a.inp", "b.vtu"], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": folder})
            self.assertEqual(done.returncode, 2)
            self.assertIn("pip install meshio", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
