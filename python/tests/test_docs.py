"""Python that README, pages and docstrings show: every block runs, on small meshes, as a reader would type it.

What a block takes for granted stands above it in a comment that no reader sees: <!-- python: statements -->. Blocks of a page run one after
another and share what they define. Each page runs in a folder with passage.cgns (blade, hub, case) and wing.cgns (wall, Sym, Far).
"""
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys
import textwrap

import numpy
import pytest

import gridmorph
from gridmorph.__main__ import executable

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"(?:<!-- python: (?P<before>[^\n]*) -->\n)?^```(?:python|py)\n(?P<code>.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks_of(page):
    """(line, what goes before, code) of each block."""
    text = page.read_text(encoding="utf-8")
    return [(text.count("\n", 0, found.start("code")) + 1, found["before"] or "", found["code"]) for found in BLOCK.finditer(text)]


PAGES = [page for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))] if blocks_of(page)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, meshes):
    made = tmp_path_factory.mktemp("pages")
    command = [executable(), "demo", "passage", "--nodes", "10000", "--motion", "rotation", "--directory", str(made)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (made / "passage.cgns").exists(), done.stderr
    shutil.copy(meshes / "717_wl_L2.cgns", made / "wing.cgns")
    return made


def elements_of_a_wedge():
    """Points, a tetrahedron on top of a prism, the triangle on top and one quadrilateral."""
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [0.3, 0.3, 2]], dtype=float)
    return points, [[3, 4, 5, 6]], [[0, 1, 2, 3, 4, 5]], [[3, 4, 6], [4, 5, 6], [5, 3, 6]], [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]


def names_for(folder, monkeypatch):
    def one_process():
        return type("MPI", (), {"COMM_WORLD": None})

    def one_rank():
        alone = {"Get_rank": lambda _: 0, "gather": lambda _, own, root: [own], "bcast": lambda _, value, root: value,
                 "scatter": lambda _, values, root: values[root]}
        return type("Communicator", (), alone)()

    def off_screen():
        import pyvista

        pyvista.OFF_SCREEN = True
        for kind in (pyvista.MultiBlock, pyvista.PolyData, pyvista.UnstructuredGrid):
            monkeypatch.setattr(kind, "plot", lambda self, **_: None)

    def in_the_project():
        if not (folder / "examples").exists():
            (folder / "examples").symlink_to(ROOT / "examples")

    return {"elements_of_a_wedge": elements_of_a_wedge, "one_process": one_process, "one_rank": one_rank, "off_screen": off_screen,
            "in_the_project": in_the_project, "mesh_of_wing": lambda: gridmorph.Mesh.read(folder / "wing.cgns"),
            "instead_of": lambda name, module: monkeypatch.setitem(sys.modules, name, module), "numpy": numpy, "pytest": pytest}


def run(code, line, where, names):
    exec(compile("\n" * (line - 1) + code, str(where), "exec"), names)


def test_pages_have_blocks():
    assert ROOT / "docs/python.md" in PAGES


@pytest.mark.filterwarnings("error::UserWarning")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_block_of_a_page_runs(page, folder, monkeypatch):
    monkeypatch.chdir(folder)
    names = names_for(folder, monkeypatch)
    skipped = []
    for line, before, code in blocks_of(page):
        for name in ("moved.cgns", "wing_idwarp.cgns"):
            (folder / name).unlink(missing_ok=True)
        try:
            run(before, line, page, names)
        except pytest.skip.Exception as reason:  # a package that this machine has not
            skipped.append(str(reason))
            continue
        run(code, line, page, names)
    if skipped and len(skipped) == len(blocks_of(page)):
        pytest.skip(skipped[0])


def test_the_example_that_help_shows_runs(folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "moved.cgns").unlink(missing_ok=True)
    shown = [paragraph for paragraph in inspect.getdoc(gridmorph).split("\n\n") if paragraph.startswith("    ")]
    assert len(shown) == 1 and "Mesh.read" in shown[0]
    run(textwrap.dedent(shown[0]), 1, "help(gridmorph)", {})
    assert os.path.exists("moved.cgns")
