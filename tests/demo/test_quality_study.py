"""scripts/quality-study: its walls against turns that are known."""
import importlib.machinery
import importlib.util
import os
import sys
import types
import unittest

import numpy as np

sys.dont_write_bytecode = True
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "quality-study")
loader = importlib.machinery.SourceFileLoader("quality_study", SCRIPT)
study = importlib.util.module_from_spec(importlib.util.spec_from_loader("quality_study", loader))
loader.exec_module(study)


def ring(begin, end, turn=0.0, lines=0.0, stretch=1.0):
    """A part of an O-grid round a cylinder along z whose lines lean: X[c, k, j, i], i round it, j away from it.

    turn: the wall turns about z; lines: so do the lines from the wall on; stretch: of the first heights."""
    angle, away, z = np.meshgrid(np.linspace(begin, end, 9), [0.0, 0.1, 0.3], np.linspace(0, 2, 6), indexing="ij")
    along = np.stack([np.cos(angle + 0.3), np.sin(angle + 0.3), 0.2 + 0 * z])
    c, s = np.cos(lines), np.sin(lines)
    along = np.stack([c * along[0] - s * along[1], s * along[0] + c * along[1], along[2]])
    wall = np.stack([np.cos(angle + turn), np.sin(angle + turn), z])
    return np.moveaxis(wall + stretch * away * along, (1, 2, 3), (3, 2, 1))


def zones(**moved):
    """The whole ring in three zones, the second with i and k backwards."""
    bounds = np.linspace(0, 2 * np.pi, 4)
    for n in range(3):
        X = ring(bounds[n], bounds[n + 1], **moved)
        if n == 1:
            X = X[:, ::-1, :, ::-1]
        begin, end = np.array([0, 0, 0]), np.array([8, 0, 5])
        yield types.SimpleNamespace(name=str(n), X=X, patches=[("Body", "BCWall", begin, end)], rotation=None)


class WallsOfAStudy(unittest.TestCase):
    def setUp(self):
        self.files = {"baseline": {}}
        study.cgns_blocks.zones_of = lambda path: zones(**self.files[path])
        case = study.Wing("ring", "", "", ["body"], "", "", pivot=0)
        self.change = study.WallChange(case, "baseline")

    def test_every_inner_node_has_centred_differences(self):
        walls = self.change.walls
        self.assertEqual(len(walls.first), 24 * 6)
        centred = (walls.stencil >= 0).all(axis=1)
        self.assertTrue(centred.all())
        z = walls.nodes("baseline")[0][2][walls.first]
        inner = (z > 0.1) & (z < 1.9)
        around = np.arange(len(z))
        self.assertTrue((walls.stencil[inner] != around[inner, None]).all())
        self.assertTrue((walls.stencil[~inner] == around[~inner, None]).any(axis=1).all())

    def test_a_rigid_turn_changes_no_angle(self):
        self.files["turned"] = {"turn": 0.6, "lines": 0.6}
        angle, height, _ = self.change("turned")
        self.assertLess(max(angle), 1e-5)
        self.assertLess(height, 1e-9)

    def test_lines_that_stay_behind_lean_by_the_turn(self):
        # Lines lean by 0.3 about z to begin with, and by atan(0.2) along z.
        self.files["sheared"] = {"turn": 0.2}
        angle, _, _ = self.change("sheared")
        lean = [np.degrees(np.arccos(np.cos(a) / np.hypot(1, 0.2))) for a in (0.3, 0.1)]
        self.assertAlmostEqual(angle[0], lean[0] - lean[1], places=6)
        self.assertAlmostEqual(angle[1], angle[0], places=6)

    def test_first_heights_are_along_the_normal(self):
        self.files["higher"] = {"stretch": 1.25}
        _, height, _ = self.change("higher")
        self.assertAlmostEqual(height, 25, places=9)

    def test_a_case_file_names_what_it_is_of(self):
        case = next(c for c in study.CASES if c.name == "passage")
        motions = case.motions(0.1)
        text = case.text("m.cgns", motions["rotate"], "blend", -2, guard=True)
        for line in ('input = "m.cgns"', "twist_deg = 10", "chord = -0.05", "amplitude = -2", 'mode = "blend"', "smooth = true"):
            self.assertIn(line, text.splitlines())


if __name__ == "__main__":
    unittest.main()
