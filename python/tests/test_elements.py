"""Meshes of elements from arrays."""
import numpy as np
import pytest

import gridmorph

N = 6
TETS = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def lattice(n=N):
    """Points of a unit cube, i fastest, and the corners (k, 8) of its cells, bit by bit: i + 2 j + 4 k."""
    x = np.linspace(0.0, 1.0, n)
    k, j, i = np.meshgrid(x, x, x, indexing="ij")
    points = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)
    first = (np.arange(n - 1)[:, None, None] * n * n + np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    return points, first[:, None] + np.array([i + n * (j + n * k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])


def sides(points, corners):
    """Quadrilaterals on the faces of the cube, by name."""
    of = {"x0": (0, 0.0), "x1": (0, 1.0), "y0": (1, 0.0), "y1": (1, 1.0), "floor": (2, 0.0), "roof": (2, 1.0)}
    around = {0: [0, 2, 6, 4], 1: [0, 1, 5, 4], 2: [0, 1, 3, 2]}
    out = {}
    for name, (axis, at) in of.items():
        quads = corners[:, np.array(around[axis]) + (0 if at == 0 else 1 << axis)]
        out[name] = quads[(points[quads][:, :, axis] == at).all(axis=1)]
    return out


def halves(quads):
    """Triangles on the diagonals that TETS have: from the corner with the smallest number to the one with the largest."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def cube(kind):
    points, corners = lattice()
    if kind == "TETRA_4":
        cells = np.concatenate([corners[:, t] for t in TETS])
        patches = {name: halves(quads) for name, quads in sides(points, corners).items()}
    else:
        cells = corners[:, [0, 1, 3, 2, 4, 5, 7, 6]]
        patches = sides(points, corners)
    return gridmorph.Mesh.from_elements(points, [(kind, cells)], patches)


def bump(points):
    u = np.zeros_like(points)
    u[:, 2] = 0.1 * np.sin(np.pi * points[:, 0]) ** 2 * np.sin(np.pi * points[:, 1]) ** 2
    return u


@pytest.mark.parametrize("kind", ["TETRA_4", "HEXA_8"])
def test_elements_of_arrays_morph_as_those_of_a_file(kind, tmp_path):
    mesh = cube(kind)
    mesh.write(tmp_path / "cube.cgns")
    read = gridmorph.Mesh.read(tmp_path / "cube.cgns")
    assert read.n_cells == mesh.n_cells == len(TETS if kind == "TETRA_4" else [0]) * (N - 1) ** 3
    np.testing.assert_array_equal(read.elements["types"], mesh.elements["types"])
    np.testing.assert_array_equal(read.elements["nodes"], mesh.elements["nodes"])
    here, there = (gridmorph.Plan(m, gridmorph.Motion().function("floor", bump)).positions() for m in (mesh, read))
    np.testing.assert_array_equal(here, there)
    assert mesh.quality(here)["inverted"] == 0
    assert np.abs(here - mesh.coordinates).max() == pytest.approx(bump(mesh.coordinates)[:, 2].max())


def test_polyhedra_by_their_faces_are_the_elements_they_are():
    points, corners = lattice(3)
    shapes = {}
    for e, c in enumerate(corners):
        for face in ([0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]):
            shapes.setdefault(tuple(sorted(c[face])), []).append((e, c[face]))
    rows = [found[0][1] for found in shapes.values()]
    owner = [found[0][0] for found in shapes.values()]
    neighbour = [found[1][0] if len(found) > 1 else -1 for found in shapes.values()]
    offsets = 4 * np.arange(len(rows) + 1)
    mesh = gridmorph.Mesh.from_elements(points, faces=(offsets, np.concatenate(rows), owner, neighbour),
                                        patches={"wall": np.array([r for r, n in zip(rows, neighbour) if n < 0])})
    assert (mesh.elements["types"] == 17).all() and mesh.n_cells == 8
    assert mesh.quality()["inverted"] == 0


def test_a_prism_of_five_sides_stays_a_polyhedron(pentagonal_prism):
    points, faces = pentagonal_prism
    offsets = np.cumsum([0] + [len(f) for f in faces])
    mesh = gridmorph.Mesh.from_elements(points, faces=(offsets, np.concatenate(faces), np.zeros(7, int), -np.ones(7, int)),
                                        patches={"walls": faces})
    found = mesh.elements
    assert found["types"].tolist() == [23] and found["polyhedra"].tolist() == [0]
    np.testing.assert_array_equal(found["face_offsets"], offsets)
    np.testing.assert_array_equal(found["face_nodes"], np.concatenate(faces))
    assert mesh.quality()["inverted"] == 0


def test_two_dimensional_points_make_a_mesh_of_surfaces():
    square = gridmorph.Mesh.from_elements(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), {"QUAD_4": [[0, 1, 2, 3]]},
                                          {"blade": [[0, 1]], "rest": {"faces": [[1, 2], [2, 3], [3, 0]], "kind": "farfield"}})
    assert square.dimension == 2 and square.elements["types"].tolist() == [7]
    assert [p["kind"] for p in square.patches] == ["wall", "farfield"]


@pytest.mark.parametrize("elements, patches, found", [
    ([("TETRA_5", [[0, 1, 2, 3]])], {}, "TETRA_5"),
    ([("TETRA_4", [[0, 1, 2]])], {}, r"\(k, 4\)"),
    ([("TETRA_4", [[0, 1, 2, 9]])], {}, "node 9"),
    ([("TETRA_4", [[0, 1, 2, 3.5]])], {}, "whole numbers"),
    ([("TETRA_4", [[0, 1, 2, 3]])], {"w": {"faces": [[0, 1, 2]], "kind": "brick"}}, "brick"),
    ([("TETRA_4", [[0, 1, 2, 3]])], {"w": [[0, 1, 7]]}, "'w'.*node 7"),
    ([("TETRA_4", [[0, 1, 2, 3]]), ("TRI_3", [[0, 1, 2]])], {}, "surfaces"),
])
def test_arrays_that_make_no_mesh_are_refused(elements, patches, found):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    with pytest.raises(gridmorph.MeshError, match=found):
        gridmorph.Mesh.from_elements(points, elements, patches)


def test_blocks_have_no_elements():
    box = np.stack(np.meshgrid(*[np.linspace(0, 1, 3)] * 3, indexing="ij"), axis=-1)
    assert gridmorph.Mesh.from_blocks({"box": box}).elements is None


def test_blocks_found_in_hexahedra_move_as_blocks_and_lead_back():
    mesh = cube("HEXA_8")
    blocks, nodes, cells = mesh.find_blocks()
    assert blocks.is_structured and blocks.n_cells == mesh.n_cells == len(cells)
    assert sorted(cells) == list(range(mesh.n_cells))
    assert (blocks.coordinates[nodes] == mesh.coordinates).all()
    motion = gridmorph.Motion({"motion": [{"patches": ["x0", "x1", "y0", "y1", "roof"], "rule": "fixed"}]})
    motion.function(["floor"], bump)
    moved = gridmorph.Plan(blocks, motion).positions()[nodes]
    floor = mesh.coordinates[:, 2] == 0
    assert np.abs(moved - mesh.coordinates - bump(mesh.coordinates))[floor].max() < 1e-15
    assert mesh.quality(moved)["inverted"] == 0
    with pytest.raises(gridmorph.MeshError, match="is no hexahedron"):
        cube("TETRA_4").find_blocks()
    with pytest.raises(gridmorph.MeshError, match="blocks already"):
        blocks.find_blocks()
