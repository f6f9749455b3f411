"""Meshes and examples of the project."""
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def meshes():
    return ROOT / "examples" / "meshes"


@pytest.fixture(scope="session")
def examples():
    return ROOT / "examples" / "python"
