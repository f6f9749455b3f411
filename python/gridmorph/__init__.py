"""Explicit, interpolation-based morphing of CFD meshes.

    import gridmorph
    mesh = gridmorph.Mesh.read("passage.cgns")
    motion = gridmorph.Motion({
        "mesh": {"axis": "x"},
        "motion": [
            {"patches": ["blade"], "rule": "rigid", "rotation": {"angle_deg": 0.5}},
            {"patches": ["hub", "case"], "rule": "slip", "surface": "revolution"},
        ],
    })
    plan = gridmorph.Plan(mesh, motion)
    moved = plan.positions()             # (n, 3), every node
    print(mesh.quality(moved)["certificate"])
    mesh.write("moved.cgns", moved)      # refused where cells are inverted

Arrays are NumPy's: (n, 3), float64 or float32, any positive strides, lengths in units of the mesh. Nodes count from 0. Calls let other
threads of Python run, and wait for one another. docs/python.md of the project has the rest.
"""
from __future__ import annotations

import json
import os
import typing

import numpy
import numpy.typing

from . import _elements, _pyvista
from ._core import (ConfigError, Error, IoError, MachineError, Mesh, MeshError, Motion, MotionError, Plan, PlanError,
                    __version__, kokkos_version, set_threads)

__all__ = ["ConfigError", "Error", "IoError", "MachineError", "Mesh", "MeshError", "Motion", "MotionError", "Plan", "PlanError",
           "kokkos_version", "set_threads"]

def _attach(owner, **members):
    """Makes functions of Python methods of a compiled class, which help() and type stubs then show like its own."""
    for name, member in members.items():
        for part in (member.fget,) if isinstance(member, property) else {member, getattr(member, "__func__", member)}:
            part.__module__, part.__name__, part.__qualname__ = owner.__module__, name, f"{owner.__name__}.{name}"
        setattr(owner, name, member)


def _selectors(patches):
    return [patches] if isinstance(patches, str) else [str(p) for p in patches]


def _plain(value):
    """Numbers and paths of others as what TOML has."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items() if item is not None}
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return os.fspath(value) if isinstance(value, os.PathLike) else value


# ---------------------------------------------------------------------------------------------------------------- meshes


def _read(path: str | os.PathLike[str], side_file: str | os.PathLike[str] | None = None, leave_out: str | typing.Sequence[str] = ()) -> Mesh:
    """Reads a mesh: CGNS (HDF5, ADF), PLOT3D, SU2, OpenFOAM, Gmsh, VTK, UGRID, with the side file beside it or the one given.

    leave_out: bases and zones that are no part of the mesh, by name or glob. Raises IoError, MeshError, ConfigError.
    """
    return Mesh._read(os.fspath(path), None if side_file is None else os.fspath(side_file), _selectors(leave_out))


def _from_blocks(blocks: typing.Mapping[str, numpy.typing.ArrayLike], boundaries: dict[str, typing.Any] | None = None, match: bool = True) -> Mesh:
    """A structured mesh from arrays, with no file.

    blocks: {name: (ni, nj, nk, 3) array}, copied; indices i, j, k in the order of the array's axes.
    boundaries: a dict as a side file has it (docs/formats.md): {"patch": [{"name": ..., "zone": ..., "face": "k_min", "kind": "wall"}], ...}.
    match: find the interfaces, periodic ones too, that coincident nodes say (Mesh.match). Raises MeshError, ConfigError.
    """
    import tomli_w

    mesh = Mesh._from_blocks([(name, numpy.asarray(array, dtype=float)) for name, array in blocks.items()])
    if boundaries:
        mesh._add_side_text(tomli_w.dumps(_plain(boundaries)), "boundaries")
    if match:
        mesh.match()
    return mesh


def _coordinates(self) -> numpy.typing.NDArray[numpy.float64]:
    """(n_nodes, 3) [length], a copy; x, y and z are the mesh's own."""
    return numpy.stack([self.x, self.y, self.z], axis=1)


def _refuse_inverted(mesh, path, coordinates):
    """Raises MeshError where coordinates have cells inverted that the mesh has not."""
    inverted = mesh._newly_inverted(coordinates)
    if inverted:
        raise MeshError(f"'{path}' is not written, because cells are inverted that were not in the mesh: {inverted} of {mesh.n_cells}; "
                        "move the boundary less, give a rule to patches that have none (plan.notes), or pass allow_inverted=True")


def _write(self, path: str | os.PathLike[str], coordinates: numpy.typing.ArrayLike | None = None, *, overwrite: bool = False,
           allow_inverted: bool = False) -> None:
    """Writes the mesh, with other coordinates (n_nodes, 3) where they are given.

    A mesh that was read comes out as its file, everything but the coordinates unchanged; others as a new CGNS file. The file appears whole or
    not at all, and never in place of one that the mesh was read from. overwrite: where there is another file already. allow_inverted: even
    where cells are inverted that were not in the mesh; otherwise that is a MeshError. Cost: that of measuring the cells, where coordinates
    are given. Raises ConfigError, IoError, MeshError, MachineError.
    """
    path = os.fspath(path)
    self._check_output(path, overwrite, self._format())
    if coordinates is not None and not allow_inverted:
        _refuse_inverted(self, path, coordinates)
    self._write(path, coordinates)


def _write_vtk(self, path: str | os.PathLike[str], coordinates: numpy.typing.ArrayLike | None = None, *, overwrite: bool = False) -> None:
    """Writes a .vtu file for viewers, with the displacement where coordinates are given, inverted cells or not.

    overwrite: where there is a file already; one that the mesh was read from is never written. Raises ConfigError, MachineError.
    """
    path = os.fspath(path)
    self._check_output(path, overwrite, "VTK")
    self._write_vtk(path, coordinates)


def _quality(self, coordinates: numpy.typing.ArrayLike | None = None, *, fast: bool = False, cells: bool = False) -> dict[str, typing.Any]:
    """Quality of the mesh, or of other coordinates (n_nodes, 3) against it, as the dict that JSON reports have.

    "inverted": cells that are inside out; "near_field" / "far_field" (everything is in the far field here), "walls"; with coordinates
    "certificate": whether every cell is valid between its corners too. fast: a verdict only. cells: also "cell_values", a dict of (n_cells,)
    arrays (aspect ratio, 3x3x3 determinant, smallest angle, skewness).
    """
    text, arrays = self._quality(coordinates, fast, cells)
    report = json.loads(text)
    if cells:
        report["cell_values"] = arrays
    return report


_attach(Mesh, read=staticmethod(_read), from_blocks=staticmethod(_from_blocks), from_elements=staticmethod(_elements.from_elements),
        elements=property(_elements.elements), coordinates=property(_coordinates), write=_write, write_vtk=_write_vtk, quality=_quality,
        to_pyvista=_pyvista.to_pyvista, patches_to_pyvista=_pyvista.patches_to_pyvista)

# --------------------------------------------------------------------------------------------------------------- motions


def _read_motion(path: str | os.PathLike[str], parameters: typing.Mapping[str, float] | None = None) -> Motion:
    """The rules and options of a case file, with these values of its [parameters]. Raises one ConfigError that lists every problem of it."""
    return Motion._read(os.fspath(path), {name: float(value) for name, value in (parameters or {}).items()})


def _motion_text(tables, more):
    """Tables of a Motion as the text of a case file."""
    import tomli_w

    tables = {**_plain(tables or {}), **_plain(more)}
    tables.setdefault("motion", [])
    mesh = tables.pop("mesh", {})
    tables["mesh"] = {"input": "mesh", **mesh}
    # Single values first: what stands behind a table is part of it.
    ordered = dict(sorted(tables.items(), key=lambda item: isinstance(item[1], dict) or item[0] in ("motion", "region", "clearance")))
    return tomli_w.dumps(ordered)


def _function(self, patches: str | typing.Sequence[str],
              function: typing.Callable[[numpy.typing.NDArray[numpy.float64]], numpy.typing.ArrayLike], rank: int = 0) -> Motion:
    """Adds a rule: function(points (k, 3)) -> displacement (k, 3), of baseline positions, equal for equal points. Returns the motion."""
    self._function(_selectors(patches), function, rank)
    return self


def _field(self, patches: str | typing.Sequence[str], points: numpy.typing.ArrayLike, displacement: numpy.typing.ArrayLike, rank: int = 0,
           max_distance: float = 0.0) -> Motion:
    """Adds a rule: displacements (k, 3) at points (k, 3), exact there and interpolated between. Returns the motion.

    max_distance: a node farther than that from every point is a MotionError; 0: no limit.
    """
    self._field(_selectors(patches), numpy.asarray(points), numpy.asarray(displacement), rank, max_distance)
    return self


def _rigid(self, patches: str | typing.Sequence[str], matrix: numpy.typing.ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
           translation: numpy.typing.ArrayLike = (0, 0, 0),
           rank: int = 0) -> Motion:
    """Adds a rule: x' = matrix x + translation. Returns the motion."""
    self._rigid(_selectors(patches), numpy.ravel(matrix).astype(float).tolist(), numpy.ravel(translation).astype(float).tolist(), rank)
    return self


def _prescribed(self, patches: str | typing.Sequence[str], rank: int = 0) -> Motion:
    """Adds a rule: whatever u of a plan's calls gives these nodes. Returns the motion."""
    self._prescribed(_selectors(patches), rank)
    return self


_attach(Motion, read=staticmethod(_read_motion), function=_function, field=_field, rigid=_rigid, prescribed=_prescribed)


# ----------------------------------------------------------------------------------------------------------------- plans


def _parameter_gradient(self, motion: typing.Callable[[numpy.typing.NDArray[numpy.float64]], Motion], parameters: numpy.typing.ArrayLike,
                        steps: numpy.typing.ArrayLike, gradient: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """(k,): dJ/dp of the parameters (k,) of rules, from gradient = dJ/du (m, 3) as transpose() returns it.

    motion(p): the rules with these parameters, always for the same patches. dJ/dp_k = sum of gradient . (b(p + h_k) - b(p - h_k)) / (2 h_k),
    b what the rules give boundary nodes, h_k of steps (k,) or one for all, about 1e-5 of what p_k is of. Cost: two evaluations of the rules
    per parameter; no mesh is morphed. Raises ConfigError, MotionError.
    """
    p = numpy.array(parameters, dtype=float)
    if p.ndim != 1:
        raise ConfigError(f"parameters: must be an array of (k,), found {p.shape}")
    try:
        h = numpy.broadcast_to(numpy.asarray(steps, dtype=float), p.shape)
    except ValueError:
        raise ConfigError(f"steps: must be one number or an array of {p.shape}, found {numpy.shape(steps)}") from None
    if not (h > 0).all():
        raise ConfigError(f"steps: must be positive, found {h.min()}")
    gradient = numpy.asarray(gradient, dtype=float)
    if gradient.shape != (len(self.boundary_nodes), 3):
        raise ConfigError(f"gradient: must be an array of ({len(self.boundary_nodes)}, 3), found {gradient.shape}")
    out = numpy.empty(len(p))
    for k in range(len(p)):
        ahead, behind = p.copy(), p.copy()
        ahead[k] += h[k]
        behind[k] -= h[k]
        change = self.boundary_displacement_of(motion(ahead)) - self.boundary_displacement_of(motion(behind))
        out[k] = numpy.vdot(gradient, change) / (ahead[k] - behind[k])
    return out


_attach(Plan, parameter_gradient=_parameter_gradient)
