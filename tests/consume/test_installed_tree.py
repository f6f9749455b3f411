#!/usr/bin/env python3
"""Tests of what `cmake --install` puts under a prefix.

  test_installed_tree.py PREFIX BUILD_FOLDER CMAKE
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PREFIX, BUILD = (os.path.realpath(argument) for argument in sys.argv[1:3])
CMAKE = sys.argv[3]
SHARE = os.path.join(PREFIX, "share")
DOC = os.path.join(SHARE, "doc", "gridmorph")
COMMAND = os.path.join(PREFIX, "bin", "gridmorph")
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def files_below(folder):
    """Paths from `folder` of all files below it, links followed."""
    return {os.path.relpath(os.path.join(place, name), folder)
            for place, _, names in os.walk(folder, followlinks=True) for name in names}


def run(*command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, check=False, **options)


def relative_links(page):
    """Targets of the Markdown links of `page`, code left out."""
    with open(page, encoding="utf-8") as file:
        text = re.sub(r"```.*?```|`[^`\n]*`", "", file.read(), flags=re.DOTALL)
    return [target for target in re.findall(r"\]\(([^)\s]+)\)", text) if not re.match("[a-z]+:", target)]


def anchors(page):
    """What a link can name of `page`: its headings as web pages of Markdown write them, and places with an id."""
    with open(page, encoding="utf-8") as file:
        text = re.sub(r"```.*?```", "", file.read(), flags=re.DOTALL)
    headings = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading) for heading in re.findall(r"^#+ +(.*)$", text, flags=re.MULTILINE)]
    names = {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}
    return names | set(re.findall(r'<a id="([^"]*)">', text))


class InstalledTree(unittest.TestCase):
    def test_has_a_part_for_everyone(self):
        for path in ("bin/gridmorph", "include/gridmorph/gridmorph.hpp", "include/gridmorph/version.hpp", "share/man/man1/gridmorph.1",
                     "share/bash-completion/completions/gridmorph", "share/gridmorph/examples/run", "share/gridmorph/scripts/convert-mesh"):
            self.assertTrue(os.path.isfile(os.path.join(PREFIX, path)), path)
        for name in ("README.md", "LICENSE", "CHANGELOG.md", "docs/dependencies.md", "docs/case_file.md"):
            self.assertTrue(os.path.isfile(os.path.join(DOC, name)), name)
        packages = [path for path in files_below(PREFIX) if path.endswith("cmake/gridmorph/gridmorphConfig.cmake")]
        self.assertEqual(len(packages), 1, packages)

    def test_has_all_pages_and_images_and_case_files_of_the_source_tree(self):
        for source, installed, endings in (("docs", os.path.join(DOC, "docs"), (".md", ".png", ".svg")),
                                           ("examples", os.path.join(SHARE, "gridmorph", "examples"), (".toml", ".csv", ".cgns", ".su2", ".txt"))):
            expected = {path for path in files_below(os.path.join(SOURCE, source)) if path.endswith(endings) and "generators" not in path}
            self.assertTrue(expected)
            self.assertEqual(expected - files_below(installed), set())

    def test_links_of_pages_resolve(self):
        pages = [path for path in files_below(DOC) if path.endswith(".md")]
        self.assertGreater(len(pages), 10)
        broken, seen = [], 0
        for page in pages:
            place = os.path.join(DOC, page)
            for link in relative_links(place):
                seen += 1
                path, _, anchor = link.partition("#")
                target = os.path.join(os.path.dirname(place), path) if path else place
                if not os.path.exists(target):
                    broken.append(page + ": " + link)
                elif anchor and target.endswith(".md") and anchor not in anchors(target):
                    broken.append(page + ": " + link + " (no such heading)")
        self.assertGreater(seen, 100)
        self.assertEqual(broken, [])

    def test_scripts_can_be_run(self):
        for folder in ("scripts", "examples"):
            for path in files_below(os.path.join(SHARE, "gridmorph", folder)):
                path = os.path.join(SHARE, "gridmorph", folder, path)
                with open(path, "rb") as file:
                    if file.read(2) == b"#!":
                        self.assertTrue(os.access(path, os.X_OK), path)

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_manual_page_is_formatted_without_warnings(self):
        page = os.path.join(SHARE, "man", "man1", "gridmorph.1")
        result = subprocess.run(["man", "--warnings", "-l", page], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                universal_newlines=True, check=False,
                                env=dict(os.environ, LC_ALL="C.UTF-8", MANROFFSEQ="", MANWIDTH="80"))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("gridmorph", result.stdout)

    def test_help_names_the_installed_pages(self):
        result = run(COMMAND, "wheel", "--help")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn(os.path.join(DOC, "docs"), result.stdout)

    def test_the_installed_command_draws_pictures(self):
        meshes = os.path.join(SHARE, "gridmorph", "examples", "meshes")
        before = files_below(PREFIX)
        with tempfile.TemporaryDirectory() as folder:
            for mesh, *options in (("717_wl_L2.cgns", "--plane", "x=8.8"), ("mesh_vki_turbine.su2",)):
                out = os.path.join(folder, mesh)
                result = run(COMMAND, "view", os.path.join(meshes, mesh), "--out", out, *options)
                self.assertEqual(result.returncode, 0, result.stdout)
                self.assertIn("section.png", os.listdir(out))
        self.assertEqual(files_below(PREFIX), before)

    def test_an_example_runs_in_a_folder_of_the_user(self):
        with tempfile.TemporaryDirectory() as folder:
            before = files_below(SHARE)
            environment = {name: value for name, value in os.environ.items() if name not in ("GRIDMORPH", "GRIDMORPH_MESHES")}
            result = run(os.path.join(DOC, "examples", "run"), "winglet", cwd=folder, env=environment)
            self.assertEqual(result.returncode, 0, result.stdout)
            made = files_below(os.path.join(folder, "out", "examples", "winglet"))
            self.assertIn("winglet.json", made)
            self.assertTrue([path for path in made if path.endswith("_morphed.cgns")], made)
            self.assertEqual(files_below(SHARE), before)


class Components(unittest.TestCase):
    """`cmake --install --component` one by one."""

    def installed(self, *components):
        with tempfile.TemporaryDirectory() as prefix:
            for component in components:
                result = run(CMAKE, "--install", BUILD, "--prefix", prefix, "--component", component)
                self.assertEqual(result.returncode, 0, result.stdout)
            return files_below(prefix)

    def test_are_together_everything(self):
        self.assertEqual(self.installed("runtime", "development", "documentation"), files_below(PREFIX))

    def test_runtime_has_the_command_with_licence_and_notices_and_nothing_to_compile(self):
        files = self.installed("runtime")
        for path in ("bin/gridmorph", "share/doc/gridmorph/LICENSE", "share/doc/gridmorph/docs/dependencies.md"):
            self.assertIn(path, files)
        self.assertEqual([path for path in files if path.endswith((".hpp", ".a", ".cmake"))], [])

    def test_development_has_no_program(self):
        files = self.installed("development")
        self.assertIn("share/doc/gridmorph/LICENSE", files)
        self.assertEqual([path for path in files if path.startswith("bin/")], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
