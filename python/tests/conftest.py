"""Meshes and examples of the project, and elements that several tests take."""
import importlib.util
import os
import pathlib

import numpy as np
import pytest

# Tests run side by side with others: threads that wait let them. Before anything starts threads.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
os.environ.setdefault("OMP_NUM_THREADS", "2")

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def meshes():
    return ROOT / "examples" / "meshes"


@pytest.fixture(scope="session")
def script():
    """script(path): a script of the project as a module, by its path from the root."""
    def load(path):
        spec = importlib.util.spec_from_file_location(pathlib.Path(path).stem, ROOT / path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


@pytest.fixture(scope="session")
def pentagonal_prism():
    """Points of a prism of five sides and radius and height 1, and its faces, which look outwards."""
    angle = 2 * np.pi * np.arange(5) / 5
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.c_[ring, np.zeros(5)], np.c_[ring, np.ones(5)]])
    return points, [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9]] + [[i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i] for i in range(5)]
