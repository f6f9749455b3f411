"""Blocks of CGNS files for studies: nodes, patches and span fractions. HDF5 files are read directly, ADF files through the cgnsconvert of
CGNS, which is looked for in the PATH and where scripts/install-dependencies keeps it."""
import functools
import glob
import os
import shutil
import subprocess
import tempfile

import h5py
import numpy as np


class Unusable(Exception):
    """Input that nothing can be made of; the text says what to do."""


def children(group, label):
    for name in group:
        item = group[name]
        if isinstance(item, h5py.Group) and "label" in item.attrs and item.attrs["label"].decode() == label:
            yield name, item


def value(group):
    return group[" data"][...]


def text(group):
    return value(group).astype(np.int8).tobytes().decode("latin1").strip("\0 ")


class Zone:
    """Nodes X[c, k, j, i], wall patches as (family, 0-based node range [begin, end] per i, j, k)."""

    def __init__(self, name, group, family_types):
        self.name = name
        grid = next(g for _, g in children(group, "GridCoordinates_t"))
        coordinates = dict(children(grid, "DataArray_t"))
        arrays = [np.asarray(value(coordinates[c]), float) for c in ("CoordinateX", "CoordinateY", "CoordinateZ") if c in coordinates]
        while len(arrays) < 3:
            arrays.append(np.zeros_like(arrays[0]))
        self.X = np.stack(arrays)
        if self.X.ndim == 3:  # a 2-D zone: two copies of its plane
            self.X = np.repeat(self.X[:, None], 2, axis=1)
            self.X[2, 1] += 1e-3 * np.ptp(self.X[0])
        self.patches = []
        for _, boundary in children(group, "ZoneBC_t"):
            for bc_name, bc in children(boundary, "BC_t"):
                family = next((text(f) for _, f in children(bc, "FamilyName_t")), bc_name)
                kind = text(bc)
                kind = family_types.get(family, kind) if kind == "FamilySpecified" else kind
                if "PointRange" in bc:
                    begin, end = np.sort(value(bc["PointRange"]).reshape(2, -1), axis=0) - 1
                    if len(begin) == 2:
                        begin, end = np.append(begin, 0), np.append(end, 1)
                    self.patches.append((family, kind, begin, end))


def cgnsconvert():
    """The program, or None."""
    cache = os.environ.get("GRIDMORPH_DEPS_DIR") or os.path.join(
        os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "gridmorph")
    kept = (shutil.which(p) for p in sorted(glob.glob(os.path.join(glob.escape(cache), "cgns-*", "bin", "cgnsconvert"))))
    return shutil.which("cgnsconvert") or next(filter(None, kept), None)


@functools.lru_cache(maxsize=None)
def as_hdf5(path):
    """The folder with a copy of an ADF file as HDF5, which is gone when the script ends."""
    program = cgnsconvert()
    if program is None:
        raise Unusable(f"{path}: an ADF file; install cgnsconvert (Debian: cgns-convert), which makes HDF5 of it")
    folder = tempfile.TemporaryDirectory()
    run = subprocess.run([program, "-h", "-f", path, os.path.join(folder.name, "hdf5.cgns")], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Unusable(f"{path}: cannot be converted to HDF5: {' '.join((run.stderr or run.stdout).split())}")
    return folder


def zones_of(path):
    """One zone at a time, so that memory stays below one zone's worth."""
    if not os.path.isfile(path):
        raise Unusable(f"{path}: no such file")
    if not h5py.is_hdf5(path):
        yield from zones_of(os.path.join(as_hdf5(path).name, "hdf5.cgns"))
        return
    with h5py.File(path, "r") as file:
        for _, base in children(file, "CGNSBase_t"):
            types = {n: text(bc) for n, f in children(base, "Family_t") for _, bc in children(f, "FamilyBC_t")}
            for name, group in children(base, "Zone_t"):
                kind = next((text(t) for _, t in children(group, "ZoneType_t")), "Structured")
                if kind == "Structured" and any(True for _ in children(group, "GridCoordinates_t")):
                    yield Zone(name, group, types)


def patch_nodes(X, begin, end):
    i, j, k = (slice(b, e + 1) for b, e in zip(begin, end))
    return X[:, k, j, i]


class Spans:
    """Span fractions between hub and case about an axis."""

    def __init__(self, path, direction):
        walls, envelope = {"hub": [], "case": []}, []
        for zone in zones_of(path):
            envelope.append(zone.X[:, ::2, ::2, ::2].reshape(3, -1))
            for family, _, begin, end in zone.patches:
                for wall, words in (("hub", ("hub",)), ("case", ("case", "casing", "shroud"))):
                    if any(w in family.lower() for w in words):
                        walls[wall].append(patch_nodes(zone.X, begin, end).reshape(3, -1))
        self.direction = direction
        self.across = np.roll(self.direction, 1) - self.direction * (np.roll(self.direction, 1) @ self.direction)
        self.across /= np.linalg.norm(self.across)
        self.third = np.cross(self.direction, self.across)
        cloud = np.concatenate(envelope, axis=1)
        self.hub = self.profile(np.concatenate(walls["hub"], axis=1) if walls["hub"] else cloud, np.minimum)
        self.case = self.profile(np.concatenate(walls["case"], axis=1) if walls["case"] else cloud, np.maximum)

    def meridional(self, X):
        a, b = np.tensordot(self.across, X, 1), np.tensordot(self.third, X, 1)
        return np.tensordot(self.direction, X, 1), np.hypot(a, b)

    def profile(self, X, pick):
        x, r = self.meridional(X)
        edges = np.linspace(x.min(), x.max(), 201)
        box = np.clip(np.searchsorted(edges, x) - 1, 0, 199)
        start = -np.inf if pick is np.maximum else np.inf
        best, where = np.full(200, start), np.zeros(200)
        pick.at(best, box, r)
        np.add.at(where, box, x / np.bincount(box, minlength=200)[box])
        full = np.isfinite(best)
        return where[full], best[full]

    def field(self, X):
        x, r = self.meridional(X)
        hub, case = np.interp(x, *self.hub), np.interp(x, *self.case)
        return (r - hub) / (case - hub)
