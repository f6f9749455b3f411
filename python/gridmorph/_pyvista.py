"""Meshes and their patches as objects of PyVista, which is imported when it is asked for."""
from __future__ import annotations

import typing

import numpy
import numpy.typing

from . import _elements
from ._core import ConfigError, Mesh


def _pyvista():
    try:
        import pyvista
    except ImportError as error:
        raise ImportError(f"to_pyvista() needs PyVista ({error}): 'pip install pyvista', or write_vtk() for viewers that read files") from error
    return pyvista


def _places(mesh, coordinates):
    if coordinates is None:
        return mesh.coordinates
    places = numpy.asarray(coordinates, dtype=float)
    if places.shape != (mesh.n_nodes, 3):
        raise ConfigError(f"coordinates: must be an array of ({mesh.n_nodes}, 3), found {places.shape}")
    return places


def _add_points(grid, mesh, nodes, places, moved):
    """Point data: numbers of the nodes in the mesh, and where they came from."""
    grid.point_data["node"] = nodes
    if moved:
        grid.point_data["displacement"] = places[nodes] - mesh.coordinates[nodes]


def _cells(mesh):
    """VTK's cells of all elements, each as its length and nodes, and their types; polyhedra as streams of faces."""
    kinds, offsets, _, polyhedra, first_face, face_offsets, face_nodes = mesh._elements()
    types = numpy.empty(len(kinds), numpy.uint8)
    wide = numpy.diff(offsets)
    stream = {}
    for p, element in enumerate(polyhedra):
        faces = range(first_face[p], first_face[p + 1])
        parts = [numpy.concatenate([[face_offsets[f + 1] - face_offsets[f]], face_nodes[face_offsets[f]:face_offsets[f + 1]]]) for f in faces]
        stream[int(element)] = numpy.concatenate([[len(parts)], *parts])
        wide[element] = len(stream[int(element)])
    begin = numpy.concatenate([[0], numpy.cumsum(wide + 1)])
    cells = numpy.empty(begin[-1], numpy.int64)
    cells[begin[:-1]] = wide
    for kind, n, which, nodes in _elements.groups(mesh):
        types[which], order = Mesh._vtk_order(kind, n)
        if not types[which[0]]:
            raise ConfigError(f"elements of {n} nodes of type {kind} have no type of cells in VTK")
        cells[begin[which][:, None] + 1 + numpy.arange(n)] = nodes[:, order]
    for element, row in stream.items():
        cells[begin[element] + 1:begin[element + 1]] = row
        types[element] = 42
    return cells, types


def to_pyvista(self, coordinates: numpy.typing.ArrayLike | None = None, **cell_arrays: numpy.typing.ArrayLike) -> typing.Any:
    """The mesh as PyVista has meshes: a MultiBlock with a StructuredGrid for each block; a mesh of elements is one UnstructuredGrid.

    coordinates: (n_nodes, 3) [length], where the nodes are; the point array "displacement" then says how they came there. "node" has the
    number of each point in the mesh. cell_arrays: (n_cells,) or (n_cells, m) each, as mesh.quality(x, cells=True)["cell_values"] has
    them. Elements in several zones have the cell array "zone". Raises ImportError without PyVista, ConfigError for arrays of other
    shapes. Copies: the mesh may go.
    """
    pyvista = _pyvista()
    places = _places(self, coordinates)
    arrays = {name: numpy.asarray(values) for name, values in cell_arrays.items()}
    for name, values in arrays.items():
        if len(values) != self.n_cells:
            raise ConfigError(f"cell array '{name}': must have {self.n_cells} rows, found {values.shape}")
    zones = self.zones
    if not self.is_structured:
        cells, types = _cells(self)
        grid = pyvista.UnstructuredGrid(cells, types, places.copy())
        _add_points(grid, self, numpy.arange(self.n_nodes), places, coordinates is not None)
        for name, values in arrays.items():
            grid.cell_data[name] = values
        if len(zones) > 1:
            grid.cell_data["zone"] = numpy.repeat(numpy.arange(len(zones)), [zone["n_cells"] for zone in zones])
        return grid
    out = pyvista.MultiBlock()
    for zone in zones:
        nodes = numpy.arange(zone["first_node"], zone["first_node"] + zone["n_nodes"])
        grid = pyvista.StructuredGrid(*(places[nodes, c].reshape(zone["shape"], order="F") for c in range(3)))
        _add_points(grid, self, nodes, places, coordinates is not None)
        for name, values in arrays.items():
            grid.cell_data[name] = values[zone["first_cell"]:zone["first_cell"] + zone["n_cells"]]
        out.append(grid, zone["name"])
    return out


def patches_to_pyvista(self, patches: str | typing.Sequence[str], coordinates: numpy.typing.ArrayLike | None = None) -> typing.Any:
    """The faces of patches as PolyData, of a 2-D mesh of elements as lines; its points are the nodes of these faces.

    patches: a selector or several. Point arrays "node", and "displacement" where coordinates (n_nodes, 3) are given. Raises MotionError
    where a selector names nothing, ImportError without PyVista.
    """
    pyvista = _pyvista()
    places = _places(self, coordinates)
    offsets, nodes = self.facets([patches] if isinstance(patches, str) else [str(p) for p in patches])
    used, local = numpy.unique(nodes, return_inverse=True)
    wide = numpy.diff(offsets)
    begin = numpy.concatenate([[0], numpy.cumsum(wide + 1)])
    cells = numpy.empty(begin[-1], numpy.int64)
    cells[begin[:-1]] = wide
    cells[numpy.arange(len(nodes)) + numpy.repeat(numpy.arange(len(wide)), wide) + 1] = local.ravel()
    lines = len(wide) > 0 and wide.max() == 2
    surface = pyvista.PolyData(places[used], **({"lines": cells} if lines else {"faces": cells}))
    _add_points(surface, self, used, places, coordinates is not None)
    return surface
