#!/usr/bin/python3
"""Tests of scripts/picture-unstructured on a small box of all types of elements, written here straight through HDF5."""
import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
PICTURE = os.path.join(HERE, "..", "..", "scripts", "picture-unstructured")
sys.dont_write_bytecode = True
sys.path.insert(0, HERE)
from test_picture import describe, image_size, node, write_annulus  # noqa: E402


def script():
    loader = importlib.machinery.SourceFileLoader("picture_unstructured", PICTURE)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("picture_unstructured", loader))
    loader.exec_module(module)
    return module


def box_elements(n=4):
    """Nodes of an n x n x n box [0, 1]^3 and its elements by type: hexahedra below, prisms, pyramids, tetrahedra on top."""
    line = np.linspace(0, 1, n + 1)
    X = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    index = np.arange(len(X)).reshape(n + 1, n + 1, n + 1)
    lists = {"hexahedron": [], "prism": [], "pyramid": [], "tetrahedron": []}
    for i in range(n):
        for j in range(n):
            for k in range(n):
                h = [index[i + a, j + b, k + c] for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                if k == 0:
                    lists["hexahedron"].append(h)
                elif k == 1:
                    lists["prism"] += [[h[0], h[1], h[2], h[4], h[5], h[6]], [h[0], h[2], h[3], h[4], h[6], h[7]]]
                elif k == 2:  # six pyramids around the middle
                    X = np.vstack([X, X[h].mean(0)])
                    for face in ((0, 1, 2, 3), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (0, 3, 7, 4), (4, 7, 6, 5)):
                        lists["pyramid"].append([h[f] for f in face] + [len(X) - 1])
                else:
                    for a, b in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)):
                        lists["tetrahedron"].append([h[0], h[a], h[b], h[6]])
    bottom = [[index[i, j, 0], index[i, j + 1, 0], index[i + 1, j + 1, 0], index[i + 1, j, 0]] for i in range(n) for j in range(n)]
    return X, {k: np.array(v) for k, v in lists.items()}, np.array(bottom)


NUMBERS = {"tetrahedron": 10, "pyramid": 12, "prism": 14, "hexahedron": 17}


def write_box(path, bump=0.0, mixed=False, fields=False):
    """The bottom (z = 0) is a wall, moved up in its middle by `bump`; displacements fade to the top."""
    X, lists, bottom = box_elements()
    X = X.copy()
    X[:, 2] += bump * (1 - X[:, 2]) * np.sin(np.pi * X[:, 0]) * np.sin(np.pi * X[:, 1])
    count = sum(len(v) for v in lists.values())
    with h5py.File(path, "w") as file:
        describe(file, "HDF5 MotherNode", "Root Node of HDF5 File", "MT")
        base = node(file, "Base", "CGNSBase_t")
        zone = node(base, "Zone 1", "Zone_t", np.array([[len(X)], [count], [0]]))
        node(zone, "ZoneType", "ZoneType_t", "Unstructured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        for c, letter in enumerate("XYZ"):
            node(grid, "Coordinate" + letter, "DataArray_t", X[:, c])
        first = 1
        if mixed:
            parts = [np.concatenate([[NUMBERS[k]], e + 1]) for k, v in lists.items() for e in v]
            section = node(zone, "Elements", "Elements_t", np.array([20, 0]))
            node(section, "ElementRange", "IndexRange_t", np.array([1, count]))
            node(section, "ElementConnectivity", "DataArray_t", np.concatenate(parts))
            node(section, "ElementStartOffset", "DataArray_t", np.cumsum([0] + [len(p) for p in parts]))
            first = count + 1
        else:
            for name, list_ in lists.items():
                section = node(zone, name, "Elements_t", np.array([NUMBERS[name], 0]))
                node(section, "ElementRange", "IndexRange_t", np.array([first, first + len(list_) - 1]))
                node(section, "ElementConnectivity", "DataArray_t", (list_ + 1).ravel())
                first += len(list_)
        section = node(zone, "wall", "Elements_t", np.array([7, 0]))
        node(section, "ElementRange", "IndexRange_t", np.array([first, first + len(bottom) - 1]))
        node(section, "ElementConnectivity", "DataArray_t", (bottom + 1).ravel())
        bc = node(node(zone, "ZoneBC", "ZoneBC_t"), "wall", "BC_t", "BCWallViscous")
        node(bc, "GridLocation", "GridLocation_t", "FaceCenter")
        node(bc, "PointRange", "IndexRange_t", np.array([[first, first + len(bottom) - 1]]))
        if fields:
            cells = node(zone, "Cells", "FlowSolution_t")
            node(cells, "GridLocation", "GridLocation_t", "CellCenter")
            node(cells, "Region", "DataArray_t", np.arange(count, dtype=float) % 3)
            nodes = node(zone, "Nodes", "FlowSolution_t")
            node(nodes, "Layer", "DataArray_t", np.round(4 * X[:, 2]))


def area(polygon):
    x, y = polygon[:, 0], polygon[:, 1]
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


class Sections(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = script()
        cls.folder = tempfile.TemporaryDirectory()
        cls.plain, cls.mixed = (os.path.join(cls.folder.name, n) for n in ("plain.cgns", "mixed.cgns"))
        write_box(cls.plain)
        write_box(cls.mixed, mixed=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_polygons_of_a_section_cover_it_once(self):
        for path in (self.plain, self.mixed):
            for where in ("x=0.3", "y=0.5", "z=0.1", "z=0.4", "z=0.61", "z=0.9"):  # y = 0.5 is a plane of nodes
                section = self.script.cut(path, self.script.Plane(where))
                self.assertAlmostEqual(sum(area(p) for p in section.polygons), 1.0, places=5, msg=where)

    def test_walls_are_cut_where_they_are(self):
        section = self.script.cut(self.plain, self.script.Plane("x=0.3"))
        lines = np.array(section.walls)
        self.assertAlmostEqual(np.linalg.norm(lines[:, 0] - lines[:, 1], axis=1).sum(), 1.0, places=6)
        self.assertAlmostEqual(np.abs(lines[:, :, 1]).max(), 0.0)

    def test_pieces_give_the_same_section_as_the_whole(self):
        whole = self.script.cut(self.mixed, self.script.Plane("y=0.3"))
        kept, self.script.PIECE = self.script.PIECE, 40
        try:
            parts = self.script.cut(self.mixed, self.script.Plane("y=0.3"))
        finally:
            self.script.PIECE = kept
        self.assertEqual(len(whole.polygons), len(parts.polygons))
        self.assertEqual(sorted(np.concatenate(whole.numbers)), sorted(np.concatenate(parts.numbers)))

    def test_fields_belong_to_the_elements_that_are_cut(self):
        path = os.path.join(self.folder.name, "fields.cgns")
        write_box(path, mixed=True, fields=True)
        section = self.script.cut(path, self.script.Plane("y=0.3"), ("Region", "Layer"))
        numbers = np.concatenate(section.numbers)
        np.testing.assert_array_equal(section.values["Region"], (numbers - 1) % 3)
        middles = np.array([p[:, 1].mean() for p in section.polygons])
        self.assertTrue((section.values["Layer"] <= 4 * middles + 0.5).all())


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.base, self.morphed = self.path("base.cgns"), self.path("morphed.cgns")
        write_box(self.base)
        write_box(self.morphed, 0.1, mixed=True)

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_picture(self, *arguments):
        return subprocess.run([sys.executable, PICTURE, *arguments, "--out", self.path("out"), "--dpi", "50"],
                              capture_output=True, text=True, check=False)

    def expect_pictures(self, run, names):
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(sorted(os.listdir(self.path("out"))), sorted(n + ".png" for n in names))
        for name in names:
            width, height = image_size(self.path(f"out/{name}.png"))
            self.assertGreater(min(width, height), 100)

    def test_one_mesh_gives_walls_and_section(self):
        self.expect_pictures(self.run_picture(self.base, "--plane", "x=0.4", "--color", "none"), ("model", "section"))

    def test_two_meshes_give_close_ups_of_what_moves(self):
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--plane", "y=0.5", "--box", "0", "1", "0", "0.5"),
                             ("model", "section", "near", "boundary_layer", "box"))

    def test_every_stage_that_is_there_is_drawn(self):
        os.mkdir(self.path("stages"))
        write_box(self.path("stages/regions.cgns"), 0.1, fields=True)
        write_box(self.path("stages/wrap.cgns"))
        write_annulus(self.path("stages/background.cgns"))
        write_annulus(self.path("stages/background_morphed.cgns"), 0.1)
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--plane", "y=0.98", "--stages", self.path("stages")),
                             ("model", "section", "near", "boundary_layer", "regions", "layers", "wrap", "background", "background_motion"))

    def test_bad_input_is_one_line_and_exit_status_two(self):
        write_annulus(self.path("structured.cgns"))
        for arguments, words in (((self.path("gone.cgns"),), "no such file"), ((self.path("structured.cgns"),), "no unstructured zone"),
                                 ((self.base, "--plane", "q=1"), "x=1.5"), ((self.base, "--plane", "x=7"), "meets no element"),
                                 ((self.base, "--color", "Speed"), "no solution")):
            run = self.run_picture(*arguments)
            self.assertEqual(run.returncode, 2, (arguments, run.stderr))
            self.assertIn(words, run.stderr)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


if __name__ == "__main__":
    unittest.main()
