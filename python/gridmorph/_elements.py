"""Meshes of elements from NumPy arrays, and their elements as arrays."""
from __future__ import annotations

import typing

import numpy
import numpy.typing

from ._core import Mesh, MeshError

# Name and ElementType_t of the CGNS standard (SIDS), number of the type in the library, nodes.
_TYPES = [("TRI_3", 5, 0, 3), ("TRI_6", 6, 0, 6), ("QUAD_4", 7, 1, 4), ("QUAD_8", 8, 1, 8), ("QUAD_9", 9, 1, 9), ("TETRA_4", 10, 2, 4),
          ("TETRA_10", 11, 2, 10), ("PYRA_5", 12, 3, 5), ("PYRA_13", 21, 3, 13), ("PYRA_14", 13, 3, 14), ("PENTA_6", 14, 4, 6),
          ("PENTA_15", 15, 4, 15), ("PENTA_18", 16, 4, 18), ("HEXA_8", 17, 5, 8), ("HEXA_20", 18, 5, 20), ("HEXA_27", 19, 5, 27)]
_BY_NAME = {name: (kind, nodes) for name, _, kind, nodes in _TYPES}
_POLYHEDRON, _NFACE = 6, 23
_KIND_WORDS = {"inflow": ("inflow", "inlet"), "outflow": ("outflow", "outlet"), "farfield": ("farfield", "far_field", "freestream"),
               "symmetry": ("symmetry", "sym_", "sym-"), "wall": ("wall", "airfoil", "aerofoil", "blade", "wing", "hub", "shroud")}


def _numbers(values, what):
    """A flat int64 array, refused where the values are no whole numbers."""
    array = numpy.asarray(values)
    if array.size and array.dtype.kind not in "iu":
        raise MeshError(f"{what}: must be whole numbers, found an array of {array.dtype}")
    return numpy.ascontiguousarray(array, dtype=numpy.int64)


def _rows(faces, what):
    """(offsets, nodes) of an array (k, n), of a pair (offsets, nodes) already, or of a list of such arrays and of lists of nodes."""
    if isinstance(faces, tuple) and len(faces) == 2:
        return _numbers(faces[0], what).ravel(), _numbers(faces[1], what).ravel()
    if isinstance(faces, numpy.ndarray) and faces.ndim == 2:
        nodes = _numbers(faces, what)
        return numpy.arange(len(nodes) + 1, dtype=numpy.int64) * nodes.shape[1], nodes.ravel()
    rows = []
    for face in faces:
        face = _numbers(face, what)
        rows.extend([face] if face.ndim == 1 else list(face))
    offsets = numpy.concatenate([[0], numpy.cumsum([len(row) for row in rows], dtype=numpy.int64)]).astype(numpy.int64)
    return offsets, numpy.concatenate(rows) if rows else numpy.zeros(0, numpy.int64)


def _kind_of(name):
    """What a patch is by its name, as readers of files without types take it."""
    lower = name.lower()
    return next((kind for kind, words in _KIND_WORDS.items() if any(word in lower for word in words)), "other")


def _patch(name, given):
    if not isinstance(given, dict):
        given = {"faces": given}
    unknown = set(given) - {"faces", "nodes", "kind", "family"}
    if unknown:
        raise MeshError(f"patch '{name}': unknown key '{sorted(unknown)[0]}'; known are faces, nodes, kind, family")
    families = given.get("family", [])
    offsets, nodes = _rows(given.get("faces", ()), f"patch '{name}'")
    return (name, given.get("kind") or _kind_of(name), [families] if isinstance(families, str) else list(families), offsets, nodes,
            _numbers(given.get("nodes", ()), f"patch '{name}'").ravel())


def from_elements(points: numpy.typing.ArrayLike,
                  elements: typing.Mapping[str, numpy.typing.ArrayLike] | typing.Sequence[tuple[str, numpy.typing.ArrayLike]] = (),
                  patches: typing.Mapping[str, typing.Any] | None = None, *,
                  faces: tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike, numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = None,
                  boundaries: dict[str, typing.Any] | None = None, zone: str = "zone") -> Mesh:
    """A mesh of elements from arrays, with no file. Everything is copied; nodes and elements count from 0.

    points: (n, 3) float64 or float32 [length]; (n, 2) for a 2-D mesh, at z = 0.
    elements: [(type, nodes), ...], or a dict: type by its CGNS name (TETRA_4, PYRA_5, PENTA_6, HEXA_8, of second order TETRA_10 ... HEXA_27; in a
      2-D mesh TRI_3, QUAD_4, TRI_6, QUAD_8, QUAD_9), nodes (k, nodes of the type), whole numbers, in the order of the CGNS standard.
    patches: {name: faces}, faces the corner nodes of each: (k, 3), (k, 4), in 2-D (k, 2), a pair (offsets, nodes), or a list of those
      arrays. Or {name: {"faces": ..., "kind": "wall", "family": ...}}, with "nodes" instead of faces where nodes alone are known. kind
      without one: by words of the name (wall, blade, inlet, outlet, farfield, symmetry, ...), else "other".
    faces: (offsets, nodes, owner, neighbour), elements by their faces as OpenFOAM has them: normals, right-handed around the nodes, look
      out of the owner; neighbour is -1 on the boundary. They follow `elements` in the numbering; those with the faces of a tetrahedron,
      pyramid, prism or hexahedron become one.
    boundaries: tables of a side file (docs/formats.md): which patches are periodic.

    Raises MeshError, ConfigError. Cost: linear.
    """
    points = numpy.asarray(points)
    flat = points.ndim == 2 and points.shape[1] == 2
    if flat:
        points = numpy.concatenate([points, numpy.zeros((len(points), 1), points.dtype)], axis=1)
    sections = []
    for kind, nodes in elements.items() if isinstance(elements, dict) else elements:
        if kind not in _BY_NAME:
            raise MeshError(f"elements: '{kind}' is no type of elements; known are {', '.join(_BY_NAME)}, and polyhedra by faces")
        number, wide = _BY_NAME[kind]
        nodes = _numbers(nodes, kind)
        if nodes.ndim != 2 or nodes.shape[1] != wide:
            raise MeshError(f"elements: {kind} must be an array of (k, {wide}), found {nodes.shape}")
        sections.append((number, nodes))
    surfaces = {number < 2 for number, _ in sections} | ({False} if faces is not None else set())
    if len(surfaces) > 1:
        raise MeshError("elements: surfaces (TRI, QUAD) and volumes in one mesh; surfaces of a 3-D mesh are patches")
    dimension = 2 if surfaces == {True} or (flat and not surfaces) else 3
    if faces is not None:
        faces = tuple(_numbers(part, "faces").ravel() for part in faces)
    mesh = Mesh._from_elements(points, dimension, sections, faces, [_patch(str(name), given) for name, given in (patches or {}).items()],
                               str(zone))
    if boundaries:
        import tomli_w

        from . import _plain

        mesh._add_side_text(tomli_w.dumps(_plain(boundaries)), "boundaries")
    return mesh


def elements(self) -> dict[str, numpy.typing.NDArray[typing.Any]] | None:
    """The elements of the mesh as arrays, copies; None for a mesh of blocks alone. Its blocks beside elements have their cells here too.

    "types": (n_cells,) uint8, ElementType_t of the CGNS standard (TETRA_4 10, PYRA_5 12, PENTA_6 14, HEXA_8 17, ..., polyhedra NFACE_n 23);
    "offsets" (n_cells + 1,), "nodes" int64: element e has nodes[offsets[e]:offsets[e + 1]], in the order of the standard (of a polyhedron
    all, ascending); "polyhedra": (k,) int64, which elements are polyhedra; "first_face" (k + 1,): their faces are first_face[p] to
    first_face[p + 1] of "face_offsets" and "face_nodes", normals outwards.
    """
    if self.is_structured:
        return None
    kinds, offsets, nodes, polyhedra, first_face, face_offsets, face_nodes = self._elements()
    wide = numpy.diff(offsets)
    types = numpy.full(len(kinds), _NFACE, numpy.uint8)
    for _, number, kind, n in _TYPES:
        types[(kinds == kind) & (wide == n)] = number
    return {"types": types, "offsets": offsets, "nodes": nodes, "polyhedra": polyhedra, "first_face": first_face,
            "face_offsets": face_offsets, "face_nodes": face_nodes}


def groups(mesh):
    """For each type and number of nodes: (type of the library, nodes of an element, elements (k,), their nodes (k, nodes)). No polyhedra."""
    kinds, offsets, nodes = mesh._elements()[:3]
    wide = numpy.diff(offsets)
    for kind, n in sorted(set(zip(kinds.tolist(), wide.tolist()))):
        if kind == _POLYHEDRON:
            continue
        which = numpy.flatnonzero((kinds == kind) & (wide == n))
        yield kind, n, which, nodes[offsets[which][:, None] + numpy.arange(n)]
