#!/usr/bin/python3
"""Tests of scripts/picture on a small annulus with a wavy wall, written here straight through HDF5."""
import json
import os
import runpy
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

PICTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "picture")


def describe(group, name, label, kind):
    """What every node of a CGNS file carries, in the lengths that the CGNS library asks for."""
    for key, text, length in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
        group.attrs[key] = np.array(text.encode(), f"S{length}")
    group.attrs["flags"] = np.array([1], np.int32)


def node(parent, name, label, data=None):
    group = parent.create_group(name)
    if isinstance(data, str):
        data = np.frombuffer(data.encode(), np.int8)
    if data is not None:
        group[" data"] = data
    describe(group, name, label, "MT" if data is None else {"int8": "C1", "int64": "I8", "float64": "R8"}[data.dtype.name])
    return group


def write_annulus(path, shift=0.0, n=(17, 9, 13)):
    """One zone: i axial, j radial from 1 to 2, k around over 0.5 rad; the wall on k = 1 waves by `shift`."""
    ni, nj, nk = n
    x, r, t = np.meshgrid(np.linspace(0, 1, ni), np.linspace(1, 2, nj), np.linspace(0, 1, nk), indexing="ij")
    theta = 0.5 * t + shift * (1 - t) * np.sin(np.pi * x)
    with h5py.File(path, "w") as file:
        describe(file, "HDF5 MotherNode", "Root Node of HDF5 File", "MT")
        base = node(file, "Base", "CGNSBase_t")
        for family in ("blade", "hub", "case"):
            node(node(base, family, "Family_t"), "FamBC", "FamilyBC_t", "BCWall")
        zone = node(base, "Zone 1", "Zone_t", np.array([[ni, nj, nk]]))
        node(zone, "ZoneType", "ZoneType_t", "Structured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        for letter, values in zip("XYZ", (x, r * np.cos(theta), r * np.sin(theta))):
            node(grid, "Coordinate" + letter, "DataArray_t", values.T)
        boundary = node(zone, "ZoneBC", "ZoneBC_t")
        for family, begin, end in (("blade", [1, 1, 1], [ni, nj, 1]), ("hub", [1, 1, 1], [ni, 1, nk]), ("case", [1, nj, 1], [ni, nj, nk])):
            bc = node(boundary, family, "BC_t", "FamilySpecified")
            node(bc, "FamilyName", "FamilyName_t", family)
            node(bc, "PointRange", "IndexRange_t", np.array([begin, end]))


def add_stages(path, stages):
    """Fields of the cells: stage 1 up to the middle of i, 2 beyond it, in chains 1 and 2 along k."""
    with h5py.File(path, "a") as file:
        zone = file["Base/Zone 1"]
        ni, nj, nk = zone[" data"][0]
        solution = node(zone, "MorphCells", "FlowSolution_t")
        node(solution, "GridLocation", "GridLocation_t", "CellCenter")
        values = np.ones((nk - 1, nj - 1, ni - 1))
        values[:, :, (ni - 1) // 2:] = stages
        chains = np.ones_like(values)
        chains[(nk - 1) // 2:] = 2
        node(solution, "Stage", "DataArray_t", values)
        node(solution, "Chain", "DataArray_t", chains)


def add_pressure(path, kind):
    """The axial position as a variable, at the nodes or as the mean of every cell."""
    with h5py.File(path, "a") as file:
        zone = file["Base/Zone 1"]
        values = zone["GridCoordinates/CoordinateX/ data"][()]
        solution = node(zone, "Flow", "FlowSolution_t")
        node(solution, "GridLocation", "GridLocation_t", "Vertex" if kind == "Vertex" else "CellCenter")
        if kind != "Vertex":
            values = np.broadcast_to(0.5 * (values[:-1, :-1, :-1] + values[:-1, :-1, 1:]), np.array(values.shape) - 1).copy()
        if kind == "rind":
            node(solution, "Rind", "Rind_t", np.array([1, 1, 1, 1, 1, 1]))
            values = np.pad(values, 1, constant_values=99)
        node(solution, "Pressure", "DataArray_t", values)


def image_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", head[16:24])


class Picture(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.base, self.morphed = self.path("base.cgns"), self.path("morphed.cgns")
        write_annulus(self.base)
        write_annulus(self.morphed, 0.1)

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
            self.assertGreater(width, 300)
            self.assertGreater(height, 100)

    walls = ("section", "leading_edge", "trailing_edge", "boundary_layer")

    def test_span_sections_show_the_wall_in_large_scale(self):
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--span", "0.4"), self.walls)

    def test_sections_at_the_end_walls_are_whole(self):
        for span in ("0", "1"):
            self.expect_pictures(self.run_picture(self.base, self.morphed, "--span", span), self.walls)

    def test_planes_and_index_planes_work_for_one_mesh_or_two(self):
        self.expect_pictures(self.run_picture(self.base, "--k", "3", "--color", "none", "--box", "0", "1", "0", "1"),
                             (*self.walls, "box"))
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--plane", "x=0.5", "--color", "displacement"),
                             (*self.walls, "box"))

    def test_a_plane_across_the_grid_lines_is_drawn(self):
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--plane", "z=0.1"), ("section",))

    def test_a_variable_of_a_solution_fills_the_cells_that_a_plane_meets(self):
        """At nodes, in cells, and in cells with a layer around the zone: the same values, on polygons that make up the section."""
        for kind in ("Vertex", "CellCenter", "rind"):
            for path in (self.base, self.morphed):
                write_annulus(path, 0.1 if path == self.morphed else 0)
                add_pressure(path, kind)
            module = runpy.run_path(PICTURE)
            cut = module["PlaneCut"]("x=0.53")
            (part,) = module["sections"](cut, self.base, self.morphed, "Pressure", 0.05)
            self.assertEqual(len(part.polygons), 8 * 12)
            np.testing.assert_allclose(part.value, 8.5 / 16)
            area = sum(0.5 * abs(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1))) for p in part.polygons)
            self.assertAlmostEqual(area, 1.5 * 12 * np.sin(0.5 / 12))
            # The wave is highest on k = 1 at large radii, and does not reach the other side.
            self.assertTrue(0 < part.outlined.sum() < len(part.polygons))
            self.expect_pictures(self.run_picture(self.base, self.morphed, "--plane", "x=0.53", "--color", "Pressure", "--moved", "0.05"),
                                 ("section",))
            shutil.rmtree(self.path("out"))
        for wrong, said in ((("--plane", "x=0.53", "--color", "Density"), "no 'Density'"), (("--span", "0.4", "--color", "Pressure"), "--plane"),
                            (("--plane", "x=0.53", "--moved", "1"), "--color")):
            run = self.run_picture(self.base, self.morphed, *wrong)
            self.assertEqual(run.returncode, 2)
            self.assertIn(said, run.stderr)

    def write_stages(self):
        os.mkdir(self.path("stages"))
        listed = []
        for number, (name, shift) in enumerate((("boundary", 0), ("near field", 0.05), ("iteration 1", 0.1))):
            file = f"stage_{number:02}_{name.replace(' ', '_')}.cgns"
            write_annulus(self.path("stages/" + file), shift)
            add_stages(self.path("stages/" + file), 2)
            listed.append({"number": number, "name": name, "file": file, "chains": ["a", "b"] if number else []})
        with open(self.path("stages/stages.json"), "w", encoding="utf-8") as file:
            json.dump({"stages": listed}, file)

    def test_stages_are_drawn_one_by_one_and_in_motion(self):
        self.write_stages()
        for where, names in ((("--span", "0.4"), self.walls), (("--plane", "z=0.1"), ("section",))):
            run = self.run_picture(self.base, self.morphed, *where, "--stages", self.path("stages"))
            self.assertEqual(run.returncode, 0, run.stderr)
            stages = ("stage_00_boundary", "stage_01_near_field", "stage_02_iteration_1")
            self.assertEqual(sorted(os.listdir(self.path("out"))), sorted([n + ".png" for n in (*names, *stages)] + ["stages.gif"]))
            self.assertEqual(len({image_size(self.path(f"out/{n}.png")) for n in stages}), 1, "pictures of an animation are of one size")
            with open(self.path("out/stages.gif"), "rb") as file:
                self.assertEqual(file.read(6), b"GIF89a")
            shutil.rmtree(self.path("out"))

    def test_a_stage_shows_cells_that_were_reached(self):
        """Inked pixels of the colour of the second iteration appear with it and not before."""
        self.write_stages()
        self.assertEqual(self.run_picture(self.base, "--k", "3", "--color", "none", "--stages", self.path("stages")).returncode, 0)
        from PIL import Image

        inked = []
        for name in ("stage_01_near_field", "stage_02_iteration_1"):
            pixels = np.asarray(Image.open(self.path(f"out/{name}.png")).convert("RGB"), int)
            module = runpy.run_path(PICTURE)
            pale = 255 - module["STAGE_TINT"] * (255 - np.array([0x4c, 0x9f, 0x70]))
            green = np.abs(pixels - pale).max(2) < 12
            inked.append(green.sum())
        self.assertGreater(inked[1], 4 * max(inked[0], 1), "the legend has the colour too")

    def test_walls_of_adf_files_are_drawn(self):
        program = runpy.run_path(PICTURE)["cgnsconvert"]()
        if program is None:
            self.skipTest("cgnsconvert is not installed")
        for path in (self.base, self.morphed):
            os.rename(path, path + ".hdf5")
            subprocess.run([program, "-a", "-f", path + ".hdf5", path], check=True, stdout=subprocess.DEVNULL)
        self.expect_pictures(self.run_picture(self.base, self.morphed, "--span", "0.4"), self.walls)

    def test_bad_input_is_one_line_and_exit_status_two(self):
        write_annulus(self.path("other.cgns"), n=(5, 5, 5))
        with open(self.path("noise.cgns"), "wb") as file:
            file.write(b"no mesh at all")
        for arguments, words in (((self.path("gone.cgns"),), "no such file"), ((self.path("noise.cgns"),), "neither an HDF5 nor an ADF"),
                                 ((self.base, self.path("other.cgns")), "differs in size"), ((self.base, "--plane", "q=1"), "x=0.5"),
                                 ((self.base, "--plane", "x=7"), "meets no zone"), ((self.base, "--span", "2"), "within 0 and 1"),
                                 ((self.base, "--wall", "wing"), "blade"),
                                 ((self.base, "--stages", self.path("none")), "stages.json")):
            run = self.run_picture(*arguments)
            self.assertEqual(run.returncode, 2, arguments)
            self.assertIn(words, run.stderr)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


if __name__ == "__main__":
    unittest.main()
