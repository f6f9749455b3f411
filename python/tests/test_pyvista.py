"""Meshes as objects of PyVista: volumes by VTK against ours, arrays where they belong."""
import numpy as np
import pytest

import gridmorph

pyvista = pytest.importorskip("pyvista", exc_type=ImportError)


def moved_of(mesh):
    return mesh.coordinates + 0.01 * np.ptp(mesh.coordinates, axis=0).max() * np.sin(np.arange(mesh.n_nodes))[:, None] * [0, 0, 1]


def test_blocks_are_structured_grids(meshes):
    mesh = gridmorph.Mesh.read(meshes / "717_wl_L2.cgns")
    moved = moved_of(mesh)
    values = np.arange(mesh.n_cells, dtype=float)
    blocks = mesh.to_pyvista(moved, number=values)
    assert list(blocks.keys()) == [z["name"] for z in mesh.zones]
    n = 0
    for zone, grid in zip(mesh.zones, blocks):
        assert grid.dimensions == zone["shape"]
        np.testing.assert_array_equal(grid.points, moved[grid.point_data["node"]])
        np.testing.assert_allclose(grid.points - grid.point_data["displacement"], mesh.coordinates[grid.point_data["node"]], atol=1e-12)
        np.testing.assert_array_equal(grid.cell_data["number"], values[n:n + grid.n_cells])
        n += grid.n_cells
    assert n == mesh.n_cells
    # Cells of VTK and of gridmorph are in one order: i fastest.
    first, grid = mesh.zones[0], mesh.to_pyvista()[0]
    corners = mesh.coordinates[[first["first_node"], first["first_node"] + 1]]
    cell = grid.get_cell(0).points
    assert all((np.abs(cell - c).max(axis=1) < 1e-12).any() for c in corners)


def sample(kind):
    """One element of each kind in a row, so that VTK's volumes say whether their nodes are in its order."""
    rim = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    up = np.array([0, 0, 1.0])
    hexa = np.concatenate([rim, rim + up])
    if kind == "HEXA_8":
        return hexa, 1.0
    if kind == "HEXA_20":
        ends = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
        return np.concatenate([hexa, [0.5 * (hexa[a] + hexa[b]) for a, b in ends]]), 1.0
    if kind == "PENTA_6":
        return np.concatenate([rim[:3], rim[:3] + up]), 0.5
    if kind == "PYRA_5":
        return np.concatenate([rim, [[0.5, 0.5, 1]]]), 1 / 3
    if kind == "TETRA_4":
        return np.concatenate([rim[:3], [[1, 0, 1.0]]]), 1 / 6
    assert kind == "TETRA_10"
    tet = np.concatenate([rim[:3], [[1, 0, 1.0]]])
    ends = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    return np.concatenate([tet, [0.5 * (tet[a] + tet[b]) for a, b in ends]]), 1 / 6


@pytest.mark.parametrize("kind", ["TETRA_4", "TETRA_10", "PYRA_5", "PENTA_6", "HEXA_8", "HEXA_20"])
def test_elements_have_the_volume_that_vtk_sees(kind):
    points, volume = sample(kind)
    grid = gridmorph.Mesh.from_elements(points, [(kind, [range(len(points))])]).to_pyvista()
    assert grid.n_cells == 1
    # Which sign a wedge has changed between versions of VTK, though not which of its triangles looks outwards.
    np.testing.assert_allclose(np.abs(grid.compute_cell_sizes()["Volume"]), volume, rtol=1e-12)


def test_polyhedra_are_polyhedra(pentagonal_prism):
    points, faces = pentagonal_prism
    offsets = np.cumsum([0] + [len(f) for f in faces])
    mesh = gridmorph.Mesh.from_elements(np.concatenate([points, [[0, 0, 2.0]]]), [("TETRA_4", [[5, 6, 7, 10]])], {"walls": faces},
                                        faces=(offsets, np.concatenate(faces), np.zeros(7, int), -np.ones(7, int)))
    grid = mesh.to_pyvista()
    assert grid.celltypes.tolist() == [10, 42]
    assert grid.get_cell(1).n_faces == 7
    volumes = grid.compute_cell_sizes()["Volume"]
    np.testing.assert_allclose(volumes[1], 2.5 * np.sin(2 * np.pi / 5), rtol=1e-12)
    assert mesh.patches_to_pyvista("walls").area == pytest.approx(5 * np.sin(2 * np.pi / 5) + 10 * np.sin(np.pi / 5))


def test_surfaces_of_two_dimensions(meshes):
    mesh = gridmorph.Mesh.read(meshes / "mesh_vki_turbine.su2")
    grid = mesh.to_pyvista(moved_of(mesh), aspect=mesh.quality(cells=True)["cell_values"]["aspect_ratio"])
    assert grid.n_cells == mesh.n_cells and set(grid.celltypes) == {9}
    assert "displacement" in grid.point_data and len(grid.cell_data["aspect"]) == mesh.n_cells
    assert mesh.patches_to_pyvista(["type:wall"]).n_lines > 0


def test_patches_are_surfaces(meshes):
    mesh = gridmorph.Mesh.read(meshes / "mdo_tutorial_000_vol.cgns")
    moved = moved_of(mesh)
    wall = mesh.patches_to_pyvista("wall", moved)
    assert wall.n_cells == len(mesh.facets(["wall"])[0]) - 1
    np.testing.assert_array_equal(wall.points, moved[wall.point_data["node"]])
    assert np.abs(wall.point_data["displacement"]).max() > 0


def test_arrays_of_other_lengths_are_refused(meshes):
    mesh = gridmorph.Mesh.read(meshes / "717_wl_L2.cgns")
    with pytest.raises(gridmorph.ConfigError, match="rows"):
        mesh.to_pyvista(number=np.zeros(3))
    with pytest.raises(gridmorph.ConfigError, match="coordinates"):
        mesh.to_pyvista(np.zeros((3, 3)))
