#!/usr/bin/python3
"""What VTK's CGNS reader, which ParaView and pyvista use, shows of meshes that gridmorph wrote: our fields beside the solver's.

  test_vtk.py GRIDMORPH FOLDER-OF-MESHES
"""
import os
import subprocess
import sys
import tempfile
import unittest

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOCGNSReader import vtkCGNSReader

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


if __name__ == "__main__":
    unittest.main()
