#!/usr/bin/python3
"""Tests of `gridmorph view`, which runs the scripts that draw.

  test_view.py EXECUTABLE SOURCE_FOLDER
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

EXECUTABLE, SOURCE = (os.path.realpath(argument) for argument in sys.argv[1:3])
SCRIPTS = ("picture", "picture-unstructured")
WALLS = ["boundary_layer.png", "leading_edge.png", "section.png", "trailing_edge.png"]


def run(*words, executable=EXECUTABLE, **environment):
    return subprocess.run([executable, *words], capture_output=True, text=True, check=False,
                          env={**os.environ, "GRIDMORPH_PYTHON": sys.executable, **environment})


def options_in(text):
    return set(re.findall(r"--[a-z]+", text))


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.meshes = tempfile.TemporaryDirectory()
        made = run("demo", "passage", "-n", "10000", "-m", "chord", "-d", cls.meshes.name)
        assert made.returncode == 0, made.stderr
        cls.base, cls.morphed = (os.path.join(cls.meshes.name, name) for name in ("passage.cgns", "passage_chord.cgns"))
        cls.elements = os.path.join(cls.meshes.name, "elements.cgns")
        assert run("hexahedra", cls.base, "-o", cls.elements).returncode == 0

    @classmethod
    def tearDownClass(cls):
        cls.meshes.cleanup()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = os.path.join(self.folder.name, "pictures")

    def tearDown(self):
        self.folder.cleanup()

    def view(self, *words, **environment):
        return run("view", *words, "--out", self.out, "--dpi", "40", **environment)

    def test_draws_blocks_and_names_what_it_drew(self):
        done = self.view(self.base, self.morphed, "--span", "0.9", "--box", "-0.01", "0.02", "-0.01", "0.01")
        self.assertEqual(done.returncode, 0, done.stderr)
        drawn = sorted([*WALLS, "box.png"])
        self.assertEqual(sorted(os.listdir(self.out)), drawn)
        self.assertEqual(sorted(done.stdout.splitlines()), [os.path.join(self.out, name) for name in drawn])

    def test_draws_elements_of_cgns_and_su2_files(self):
        for mesh, *words in ((self.elements, "--plane", "x=0"), (os.path.join(SOURCE, "examples", "meshes", "mesh_vki_turbine.su2"),)):
            done = self.view(mesh, *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("section.png", os.listdir(self.out))
            shutil.rmtree(self.out)

    def test_as_json_it_lists_the_pictures_and_quiet_it_says_nothing(self):
        document = json.loads(self.view(self.base, self.morphed, "--json").stdout)
        self.assertEqual((document["baseline"], document["morphed"]), (self.base, self.morphed))
        self.assertEqual(sorted(map(os.path.basename, document["pictures"])), WALLS)
        self.assertTrue(all(map(os.path.isfile, document["pictures"])))
        done = self.view(self.base, "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_has_the_options_of_both_scripts_and_says_which_kind_of_mesh_they_are_for(self):
        both = [options_in(subprocess.run([sys.executable, "-B", os.path.join(SOURCE, "scripts", name), "--help"], capture_output=True,
                                          text=True, check=True).stdout.partition("options:")[2]) - {"--help"} for name in SCRIPTS]
        text = run("view", "--help").stdout.partition("Options:")[2].partition("Exit status")[0]
        self.assertEqual(options_in(text) - {"--help", "--quiet", "--json", "--threads"}, both[0] | both[1])
        for mesh, own, others in ((self.base, *both), (self.elements, *both[::-1])):
            for option in sorted(others - own):
                done = self.view(mesh, option, "1")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(option + " is for meshes of", done.stderr)
        self.assertNotEqual(both[0], both[1])

    def test_what_the_script_refuses_is_bad_input(self):
        for words, text in (((self.base, "--plane", "q=1"), "x=0.5"), ((self.base, "--wall", "wing"), "blade"),
                            ((self.elements, "--plane", "9"), "--plane 9")):
            done = self.view(*words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_files_that_nothing_can_be_drawn_of_are_bad_input(self):
        noise = os.path.join(self.folder.name, "noise.vtu")
        with open(noise, "w", encoding="utf-8") as file:
            file.write('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid"></VTKFile>\n')
        for mesh, text in ((os.path.join(self.folder.name, "gone.cgns"), "gone.cgns"), (noise, "VTK; pictures are drawn of CGNS and SU2")):
            done = self.view(mesh)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn(text, done.stderr)
        self.assertEqual(run("view", self.base).returncode, 2)
        self.assertEqual(run("view", "--out", self.out).returncode, 2)

    def test_without_python_or_its_packages_one_error_says_what_to_install(self):
        bare = os.path.join(self.folder.name, "bare")
        with open(bare, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\nunset PYTHONPATH\nexec {sys.executable} -S "$@"\n')
        os.chmod(bare, 0o755)
        for python, text in ((bare, "has no numpy, h5py, matplotlib"), (bare + "_not", "is not there")):
            done = self.view(self.base, GRIDMORPH_PYTHON=python)
            self.assertEqual((done.returncode, done.stdout), (3, ""), done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            for word in (python, text, "apt install python3-h5py python3-matplotlib", "GRIDMORPH_PYTHON"):
                self.assertIn(word, done.stderr)

    def test_without_the_scripts_one_error_says_where_they_belong(self):
        alone = os.path.join(self.folder.name, "gridmorph")
        shutil.copy(EXECUTABLE, alone)
        words = ("view", self.base, "--out", self.out)
        done = run(*words, executable=alone)
        self.assertEqual((done.returncode, done.stdout), (3, ""), done.stderr)
        self.assertIn("GRIDMORPH_SCRIPTS", done.stderr)
        done = run(*words, executable=alone, GRIDMORPH_SCRIPTS=os.path.join(SOURCE, "scripts"))
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run(*words, GRIDMORPH_SCRIPTS=self.folder.name)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(self.folder.name, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
