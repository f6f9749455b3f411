#!/usr/bin/python3
"""What VTK's readers, which ParaView and pyvista use, show of meshes that gridmorph wrote: our fields beside the solver's; and what gridmorph reads of
files that VTK's writer stores in all its ways.

  test_vtk.py GRIDMORPH FOLDER-OF-MESHES
"""
import itertools
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_POLYHEDRON, vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
from vtkmodules.vtkIOXML import (vtkXMLMultiBlockDataReader, vtkXMLMultiBlockDataWriter, vtkXMLPUnstructuredGridReader,
                                 vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter)

try:
    from vtkmodules.vtkFiltersCore import vtkExtractCells
except ImportError:  # before VTK 9.3
    from vtkmodules.vtkFiltersExtraction import vtkExtractCells

GRIDMORPH, MESHES = os.path.realpath(sys.argv.pop(1)), os.path.realpath(sys.argv.pop(1))


def zones(path):
    """Zones as VTK reads them, everything switched on."""
    reader = vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllPointArrays()
    reader.EnableAllCellArrays()
    reader.Update()
    blocks = reader.GetOutput().NewIterator()
    out = []
    while not blocks.IsDoneWithTraversal():
        out.append(blocks.GetCurrentDataObject())
        blocks.GoToNextItem()
    return out


def grid_of(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())


def volumes(grid):
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


def arrays(data):
    return {data.GetArrayName(n): vtk_to_numpy(data.GetArray(n)) for n in range(data.GetNumberOfArrays())}


class Vtk(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_gridmorph(self, *arguments):
        done = subprocess.run([GRIDMORPH, "--quiet", *arguments], cwd=self.folder.name, capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 1), done.stderr)

    def morph(self, mesh, rules):
        with open(os.path.join(self.folder.name, "case.toml"), "w") as case:
            case.write(f'[mesh]\ninput = "{mesh}"\noutput = "out.cgns"\n{rules}'
                       "[output]\ndisplacement = true\nquality = true\n")
        self.run_gridmorph("morph", "case.toml")
        return os.path.join(self.folder.name, "out.cgns")

    def expect_fields(self, before, after, kept):
        self.assertEqual(len(before), len(after))
        for old, new in zip(before, after):
            points, cells = arrays(new.GetPointData()), arrays(new.GetCellData())
            moved = vtk_to_numpy(new.GetPoints().GetData()) - vtk_to_numpy(old.GetPoints().GetData())
            self.assertIn("Displacement", points)
            size = abs(vtk_to_numpy(old.GetPoints().GetData())).max()
            self.assertLess(abs(points["Displacement"] - moved).max(), 1e-6 * size)
            for name in ("AspectRatio", "Determinant3x3x3", "MinimumAngleDeg", "EquiangleSkewness"):
                self.assertIn(name, cells)
                self.assertEqual(len(cells[name]), new.GetNumberOfCells())
            self.assertGreater(cells["AspectRatio"].min(), 0.999)
            for name in kept:
                self.assertTrue((cells[name] == arrays(old.GetCellData())[name]).all(), name)

    def test_fields_come_up_beside_the_solution_of_a_solver(self):
        mesh = os.path.join(MESHES, "mdo_tutorial_000_vol.cgns")
        if not os.path.exists(mesh):
            self.skipTest("no " + mesh)
        rules = ('[[motion]]\npatches = ["wall"]\nrule = "formula"\ndy = "0.001 * z * z"\n'
                 '[[motion]]\npatches = ["sym"]\nrule = "slip"\nsurface = "plane"\n')
        out = self.morph(mesh, rules)
        self.expect_fields(zones(mesh), zones(out), ["Density", "Pressure"])

    def test_fields_come_up_in_a_mesh_without_a_solution(self):
        self.run_gridmorph("demo", "passage", "-n", "10000", "-m", "rotation", "-d", ".")
        out = self.morph("passage.cgns", '[[motion]]\npatches = ["hub"]\nrule = "formula"\ndx = "0"\n')
        self.expect_fields(zones(os.path.join(self.folder.name, "passage.cgns")), zones(out), [])

    def test_fields_come_up_in_an_unstructured_mesh(self):
        self.run_gridmorph("demo", "ball", "-e", "60000", "-d", ".")
        old, new = (zones(os.path.join(self.folder.name, name)) for name in ("ball.cgns", "ball_swing.cgns"))
        self.expect_fields(old[:1], new[:1], [])

    def vtk_output(self, mesh, rules):
        with open(os.path.join(self.folder.name, "case.toml"), "w") as case:
            case.write(f'[mesh]\ninput = "{mesh}"\noutput = "out{os.path.splitext(mesh)[1]}"\n{rules}'
                       '[output]\nvtk = "out.vtu"\ndisplacement = true\nquality = true\n')
        self.run_gridmorph("morph", "case.toml")
        return grid_of(os.path.join(self.folder.name, "out.vtu"))

    def expect_vtk(self, grid, size_before):
        cells, points = arrays(grid.GetCellData()), arrays(grid.GetPointData())
        inside = cells["CellEntityIds"] == 0
        volume = volumes(grid)
        self.assertGreater(volume[inside].min(), 0)
        self.assertAlmostEqual(volume.sum(), size_before, delta=0.2 * size_before)
        self.assertGreater(abs(points["Displacement"]).max(), 0)
        self.assertTrue(numpy.isfinite(cells["AspectRatio"][inside]).all())
        self.assertTrue(numpy.isnan(cells["AspectRatio"][~inside]).all())
        names = grid.GetFieldData().GetAbstractArray("PatchNames")
        self.assertEqual(names.GetNumberOfValues(), cells["CellEntityIds"].max())
        return [names.GetValue(n) for n in range(names.GetNumberOfValues())]

    def test_meshes_of_blocks_are_written_for_viewers(self):
        self.run_gridmorph("demo", "passage", "-n", "10000", "-m", "rotation", "-d", ".")
        grid = self.vtk_output("passage.cgns", '[[motion]]\npatches = ["*"]\nrule = "formula"\ndx = "0.001"\n')
        before = numpy.copy(points_of(grid)) - arrays(grid.GetPointData())["Displacement"]
        still = grid.NewInstance()
        still.DeepCopy(grid)
        still.GetPoints().SetData(numpy_to_vtk(before, deep=True))
        self.assertIn("hub_lower", self.expect_vtk(grid, volumes(still).sum()))

    def test_meshes_of_elements_are_written_for_viewers_and_read_again(self):
        self.run_gridmorph("demo", "ball", "-e", "60000", "-d", ".")
        rope = '[[motion]]\npatches = ["rope"]\nrule = "free"\n'
        grid = self.vtk_output("ball.cgns", '[[motion]]\npatches = ["ball"]\nrule = "rigid"\ntranslation = [0.02, 0, 0]\n' + rope)
        self.assertIn("ball", self.expect_vtk(grid, volumes(grid).sum()))
        done = subprocess.run([GRIDMORPH, "quality", "out.vtu", "--json", "--quiet"], cwd=self.folder.name, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["baseline"]["far_field"]["cells"], int((arrays(grid.GetCellData())["CellEntityIds"] == 0).sum()))
        # Every way in which VTK stores a grid: the same mesh, morphed alike, all else as it was.
        moved = None
        for mode, packed, wide, single, base64, big in itertools.product(("Ascii", "Binary", "Appended"), (False, True), (False, True), (False, True),
                                                                         (False, True), (False, True)):
            if (mode == "Ascii" and (packed or wide or base64 or big)) or (mode == "Binary" and (base64 or big)):
                continue
            if (single and wide) or (mode == "Appended" and wide != big):
                continue
            way = f"{mode} packed {packed} wide {wide} single {single} base64 {base64} big {big}"
            with self.subTest(way):
                source = grid.NewInstance()
                source.DeepCopy(grid)
                if single:
                    points = vtkPoints()
                    points.SetData(numpy_to_vtk(points_of(grid).astype(numpy.float32), deep=True))
                    source.SetPoints(points)
                writer = vtkXMLUnstructuredGridWriter()
                writer.SetInputData(source)
                writer.SetFileName(os.path.join(self.folder.name, "in.vtu"))
                getattr(writer, "SetDataModeTo" + mode)()
                writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
                writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
                writer.SetEncodeAppendedData(base64)
                writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
                writer.Write()
                with open(os.path.join(self.folder.name, "case.toml"), "w") as case:
                    case.write('[mesh]\ninput = "in.vtu"\noutput = "again.vtu"\n[[motion]]\npatches = ["ball"]\nrule = "rigid"\n'
                               "translation = [0, 0.02, 0]\n" + rope + "[output]\ndisplacement = true\n")
                self.run_gridmorph("morph", "case.toml")
                after = grid_of(os.path.join(self.folder.name, "again.vtu"))
                shift = points_of(after).astype(float) - points_of(source)
                if moved is None:
                    moved = shift
                    self.assertAlmostEqual(abs(shift).max(), 0.02, delta=1e-9)
                self.assertLess(abs(shift - moved).max(), 1e-5 if single else 1e-13)
                self.assertLess(abs(arrays(after.GetPointData())["MorphDisplacement"] - moved).max(), 1e-5 if single else 1e-13)
                for name, values in arrays(source.GetCellData()).items():
                    numpy.testing.assert_array_equal(arrays(after.GetCellData())[name], values)
                numpy.testing.assert_array_equal(vtk_to_numpy(after.GetCells().GetConnectivityArray()),
                                                 vtk_to_numpy(source.GetCells().GetConnectivityArray()))

    def test_meshes_in_several_files_are_morphed_together(self):
        self.run_gridmorph("demo", "passage", "-n", "10000", "-m", "rotation", "-d", ".")
        grid = self.vtk_output("passage.cgns", '[[motion]]\npatches = ["*"]\nrule = "formula"\ndx = "0.001"\n')
        ids = arrays(grid.GetCellData())["CellEntityIds"]
        names = ["volume"] + [grid.GetFieldData().GetAbstractArray("PatchNames").GetValue(n) for n in range(ids.max())]
        blocks = vtkMultiBlockDataSet()
        for number, name in enumerate(names):
            cells = vtkThreshold()
            cells.SetInputData(grid)
            cells.SetInputArrayToProcess(0, 0, 0, 1, "CellEntityIds")
            cells.SetLowerThreshold(number)
            cells.SetUpperThreshold(number)
            cells.Update()
            part = cells.GetOutput()
            if number % 2 == 1:  # as polygons, others as grids
                surface = vtkGeometryFilter()
                surface.SetInputData(part)
                surface.Update()
                part = surface.GetOutput()
            blocks.SetBlock(number, part)
            blocks.GetMetaData(number).Set(blocks.NAME(), name)
        writer = vtkXMLMultiBlockDataWriter()
        writer.SetInputData(blocks)
        writer.SetFileName(os.path.join(self.folder.name, "in.vtm"))
        writer.Write()
        with open(os.path.join(self.folder.name, "case.toml"), "w") as case:
            case.write('[mesh]\ninput = "in.vtm"\n[sequence]\ntimes = [0, 1]\noutput = "moved_{step}.vtm"\n[[motion]]\npatches = ["*"]\nrule = "formula"\n'
                       'dx = "t * 0.002"\ndy = "t * 0.001"\n[output]\ndisplacement = true\n')
        self.run_gridmorph("morph", "case.toml")
        reader = vtkXMLMultiBlockDataReader()
        reader.SetFileName(os.path.join(self.folder.name, "moved_2.vtm"))
        reader.Update()
        moved = reader.GetOutput()
        self.assertEqual(moved.GetNumberOfBlocks(), len(names))
        for number, name in enumerate(names):
            self.assertEqual(moved.GetMetaData(number).Get(moved.NAME()), name)
            shift = points_of(moved.GetBlock(number)) - points_of(blocks.GetBlock(number))
            self.assertLess(abs(shift - [0.002, 0.001, 0]).max(), 1e-6)
        self.assertLess(abs(arrays(moved.GetBlock(0).GetPointData())["MorphDisplacement"] - [0.002, 0.001, 0]).max(), 1e-12)
        self.assertAlmostEqual(volumes(moved.GetBlock(0)).sum(), volumes(blocks.GetBlock(0)).sum(), delta=1e-12)

    def made_grid(self, polyhedra):
        """Hexahedra, every other one by its faces where wanted."""
        grid, points = vtkUnstructuredGrid(), vtkPoints()
        points.SetDataTypeToDouble()
        n = 5
        for k, j, i in itertools.product(range(n), repeat=3):
            points.InsertNextPoint(i / 3, j / 3, k / 3 + 0.01 * i)
        grid.SetPoints(points)
        corner = lambda i, j, k: i + n * (j + n * k)
        for k, j, i in itertools.product(range(n - 1), repeat=3):
            nodes = [corner(i + a, j + b, k + c) for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
            if polyhedra and (i + j + k) % 2 == 0:
                faces = vtkIdList()
                faces.InsertNextId(6)
                for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
                    faces.InsertNextId(4)
                    for c in face:
                        faces.InsertNextId(nodes[c])
                grid.InsertNextCell(VTK_POLYHEDRON, faces)
            else:
                grid.InsertNextCell(VTK_HEXAHEDRON, 8, nodes)
        return grid

    def morph_made(self, name, output):
        with open(os.path.join(self.folder.name, "case.toml"), "w") as case:
            case.write(f'[mesh]\ninput = "{name}"\noutput = "{output}"\n[[motion]]\npatches = "boundary"\nrule = "formula"\ndx = "0.1 * z"\n'
                       "[output]\ndisplacement = true\n")
        self.run_gridmorph("morph", "case.toml")

    def test_polyhedra_as_this_vtk_writes_them(self):
        before = self.made_grid(True)
        for mode in ("Ascii", "Binary", "Appended"):
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetInputData(before)
            writer.SetFileName(os.path.join(self.folder.name, "in.vtu"))
            getattr(writer, "SetDataModeTo" + mode)()
            writer.Write()
            self.morph_made("in.vtu", "out.vtu")
            after = grid_of(os.path.join(self.folder.name, "out.vtu"))
            self.assertLess(abs(points_of(after)[:, 0] - points_of(before)[:, 0] - 0.1 * points_of(before)[:, 2]).max(), 2e-2)
            for c in range(before.GetNumberOfCells()):
                old, new = before.GetCell(c), after.GetCell(c)
                self.assertEqual([old.GetPointId(n) for n in range(old.GetNumberOfPoints())], [new.GetPointId(n) for n in range(new.GetNumberOfPoints())])
                self.assertEqual([[old.GetFace(f).GetPointId(n) for n in range(4)] for f in range(6)], [[new.GetFace(f).GetPointId(n) for n in range(4)] for f in range(6)])
            # Faces are warped now, which VTK takes apart as it likes.
            self.assertAlmostEqual(volumes(after).sum(), volumes(before).sum(), delta=1e-2)

    def test_pieces_in_one_file_and_in_several(self):
        whole = self.made_grid(False)
        pieces = []
        for part in range(2):
            cells = vtkIdList()
            for c in range(whole.GetNumberOfCells()):
                if (c % 4 >= 2) == (part == 1):
                    cells.InsertNextId(c)
            extract = vtkExtractCells()
            extract.SetInputData(whole)
            extract.SetCellList(cells)
            extract.Update()
            pieces.append(extract.GetOutput())
        for part, grid in enumerate(pieces):
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetInputData(grid)
            writer.SetFileName(os.path.join(self.folder.name, f"in_{part}.vtu"))
            writer.Write()
        with open(os.path.join(self.folder.name, "in.pvtu"), "w") as top:
            top.write('<VTKFile type="PUnstructuredGrid" version="1.0"><PUnstructuredGrid GhostLevel="0"><PPoints><PDataArray type="Float64" Name="Points" '
                      'NumberOfComponents="3"/></PPoints><Piece Source="in_0.vtu"/><Piece Source="in_1.vtu"/></PUnstructuredGrid></VTKFile>')
        self.morph_made("in.pvtu", "out.pvtu")
        reader = vtkXMLPUnstructuredGridReader()
        reader.SetFileName(os.path.join(self.folder.name, "out.pvtu"))
        reader.Update()
        after = reader.GetOutput()
        self.assertEqual(after.GetNumberOfCells(), whole.GetNumberOfCells())
        self.assertIn("Displacement", arrays(after.GetPointData()))
        before = numpy.concatenate([points_of(p) for p in pieces])
        self.assertLess(abs(arrays(after.GetPointData())["Displacement"] - (points_of(after) - before)).max(), 1e-12)
        self.assertAlmostEqual(volumes(after).sum(), volumes(whole).sum(), delta=1e-2)
        # Points that pieces have in common went to one place.
        places = {}
        for old, new in zip(map(tuple, before), points_of(after)):
            self.assertEqual(tuple(places.setdefault(old, tuple(new))), tuple(new))
        self.assertLess(len(places), len(before))


if __name__ == "__main__":
    unittest.main()
