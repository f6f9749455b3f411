"""The command that comes with the package: python -m gridmorph, each in a process of its own as in a terminal."""
import ctypes.util
import os
import subprocess
import sys

import pytest

import gridmorph


def run(*arguments, **options):
    return subprocess.run([sys.executable, "-m", "gridmorph", *map(str, arguments)], capture_output=True, text=True, check=False, **options)


def test_version_is_that_of_the_module():
    done = run("--version")
    assert done.returncode == 0 and gridmorph._core.__version__ in done.stdout


def test_errors_have_the_texts_and_statuses_of_the_command(tmp_path):
    done = run("morph", tmp_path / "nothing.toml")
    assert done.returncode == 2 and "nothing.toml" in done.stderr and "Traceback" not in done.stderr
    done = run("view")
    assert done.returncode == 2 and "mesh is required" in done.stderr


def test_demo_morphs_and_draws(tmp_path):
    done = run("demo", "--nodes", "10000", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "inverted" in done.stdout
    pictures = sorted(p.relative_to(tmp_path / "demo_passage").as_posix() for p in tmp_path.glob("demo_passage/*/section.png"))
    assert pictures == ["passage_chord_pictures/section.png", "passage_rotation_pictures/section.png"]
    again = run("view", "demo_passage/passage.cgns", "--out", "alone", cwd=tmp_path)
    assert again.returncode == 0 and (tmp_path / "alone" / "section.png").stat().st_size > 1000
    assert again.stdout.splitlines()[0] == os.path.join("alone", "section.png")


def test_threads_of_others_keep_their_number():
    """A program's own OpenMP regions have as many threads after gridmorph started Kokkos, and after it ended it, as before."""
    if ctypes.util.find_library("gomp") is None:
        pytest.skip("no libgomp to ask")
    program = """
import ctypes, ctypes.util
gomp = ctypes.CDLL(ctypes.util.find_library("gomp"))
gomp.omp_set_num_threads(5)
import gridmorph
gridmorph.set_threads(2)
assert gomp.omp_get_max_threads() == 5, gomp.omp_get_max_threads()
gridmorph.Motion()
assert gomp.omp_get_max_threads() == 5, gomp.omp_get_max_threads()
"""
    subprocess.run([sys.executable, "-c", program], check=True)
