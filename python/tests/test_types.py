"""What editors and type checkers see of the package."""
import ast
import pathlib
import subprocess
import sys

import pytest

import gridmorph

PACKAGE = pathlib.Path(gridmorph.__file__).parent
STUB = PACKAGE / "_core.pyi"


def members(tree, name):
    """Names and docstrings of a class in a stub."""
    found = next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == name)
    return {node.name: ast.get_docstring(node) for node in found.body if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize("name", ["Mesh", "Motion", "Plan"])
def test_stubs_have_all_that_classes_have(name):
    listed = members(ast.parse(STUB.read_text()), name)
    public = {attribute for attribute in vars(getattr(gridmorph, name)) if not attribute.startswith("_")}
    assert public <= set(listed)
    # What takes or gives arrays says of which shape.
    for attribute in public & {"positions", "displacements", "velocities", "transpose", "boundary_nodes", "coordinates", "nodes_of",
                               "from_elements", "from_blocks", "field", "function", "elements", "to_pyvista"}:
        assert "(" in listed[attribute], attribute


def test_every_public_method_is_described():
    for owner in (gridmorph.Mesh, gridmorph.Motion, gridmorph.Plan):
        for name in vars(owner):
            if not name.startswith("_") and callable(getattr(owner, name)):
                assert getattr(owner, name).__doc__, f"{owner.__name__}.{name}"


def test_scripts_pass_a_type_checker(tmp_path):
    pytest.importorskip("mypy")
    assert (PACKAGE / "py.typed").exists()
    script = tmp_path / "script.py"
    script.write_text('''
import numpy as np
import gridmorph
from gridmorph.idwarp import USMesh

mesh = gridmorph.Mesh.read("wing.cgns")
motion = gridmorph.Motion({"motion": []}).prescribed("wing").function(["tail"], lambda p: 0 * p)
plan = gridmorph.Plan(mesh, motion, freeze_guard=True)
moved: np.ndarray = plan.positions()
mesh.write("moved.cgns", moved)
count: int = mesh.n_nodes
x: np.ndarray = USMesh({"gridFile": mesh}).getSurfaceCoordinates()
''')
    wrong = tmp_path / "wrong.py"
    wrong.write_text('import gridmorph\ngridmorph.Mesh.read(3)\n')
    check = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", str(tmp_path / "cache")]
    environment = {"MYPYPATH": str(PACKAGE.parent), "PATH": ""}
    good = subprocess.run([*check, str(script)], capture_output=True, text=True, env=environment)
    assert good.returncode == 0, good.stdout
    bad = subprocess.run([*check, str(wrong)], capture_output=True, text=True, env=environment)
    assert bad.returncode == 1 and "arg-type" in bad.stdout
