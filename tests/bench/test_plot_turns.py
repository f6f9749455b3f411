#!/usr/bin/python3
"""Tests of scripts/plot-turns on figures written here."""
import os
import subprocess
import sys
import tempfile
import unittest

PLOT_TURNS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "plot-turns")

FIGURES = """case,amount,method,smallest,inverted
airfoil,30,gridmorph,0.9321,0
airfoil,30,thin plate,0.9012,0
airfoil,150,gridmorph,0.7004,0
airfoil,150,thin plate,-0.5,1234
"""


class PlotTurns(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def run_on(self, text, *options):
        path = os.path.join(self.folder.name, "turns.csv")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return subprocess.run([sys.executable, "-B", PLOT_TURNS, path, *options], capture_output=True, text=True, check=False)

    def test_tells_shapes_and_where_elements_are_inverted(self):
        run = self.run_on(FIGURES, "--table")
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = [[c.strip() for c in line.strip("|").split("|")] for line in run.stdout.splitlines()]
        self.assertIn(["turned by", "30", "60", "90", "120", "150", "180"], rows)
        self.assertIn(["airfoil, C mesh: gridmorph", "0.932", "-", "-", "-", "0.700", "-"], rows)
        self.assertIn(["thin plate", "0.901", "-", "-", "-", "1,234 inverted", "-"], rows)

    def test_tells_what_designs_keep(self):
        run = self.run_on(FIGURES + "flap,5,gridmorph,0.97,0\nflap,5,thin plate,0.98,0\n", "--table")
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = [[c.strip() for c in line.strip("|").split("|")] for line in run.stdout.splitlines()]
        self.assertIn(["airfoil, flap, degrees", "5", "0.970", "0.980"], rows)

    def test_has_a_column_for_each_method(self):
        run = self.run_on(FIGURES + "flap,5,gridmorph,0.97,0\nflap,5,lattice,0.99,0\nflap,5,thin plate,0.98,0\n", "--table")
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = [[c.strip() for c in line.strip("|").split("|")] for line in run.stdout.splitlines()]
        self.assertIn(["changed by", "amount", "gridmorph", "lattice", "thin plate"], rows)
        self.assertIn(["airfoil, flap, degrees", "5", "0.970", "0.990", "0.980"], rows)
        self.assertIn(["lattice", "-", "-", "-", "-", "-", "-"], rows)

    def test_draws(self):
        out = os.path.join(self.folder.name, "turns.png")
        run = self.run_on(FIGURES, "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(out, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")

    def test_refuses_what_it_cannot_use(self):
        for text in ("", "case,amount\nairfoil,3\n", "case,amount,method,smallest,inverted\n"):
            run = self.run_on(text, "--table")
            self.assertEqual(run.returncode, 2, text)
            self.assertIn("bench_turns", run.stderr)


if __name__ == "__main__":
    unittest.main()
