"""The verbs of IDWarp on meshes of blocks and of elements."""
import multiprocessing

import numpy as np
import pytest

import gridmorph
from gridmorph.idwarp import USMesh

WINGS = ["mdo_tutorial_000_vol.cgns", "717_wl_L2.cgns"]
ALL = WINGS + ["mesh_vki_turbine.su2"]


def bent(x):
    """A displacement that grows along the longest extent of the surface."""
    span = np.ptp(x, axis=0)
    along, across = int(np.argmax(span)), int(np.argmin(span[:2])) if span.argmax() == 2 else 1
    s = (x[:, along] - x[:, along].min()) / span[along]
    d = np.zeros_like(x)
    d[:, across] = 0.03 * span[along] * s**2
    return d


@pytest.fixture(scope="module", params=ALL)
def moved(request, meshes):
    """A mesh whose surface was moved, the baseline of the surface, and its displacement."""
    mesh = USMesh({"gridFile": str(meshes / request.param)})
    x = mesh.getSurfaceCoordinates()
    d = bent(x)
    mesh.setSurfaceCoordinates(x + d)
    mesh.warpMesh()
    return mesh, x, d


def test_surface_arrives_and_comes_back(moved):
    mesh, x, d = moved
    np.testing.assert_array_equal(mesh.getSurfaceCoordinates(), x + d)
    wall = mesh.mesh.nodes_of(["type:wall"])
    grid = mesh.getSolverGrid().reshape(-1, 3)
    # Every node of the walls is where one of the surface's points is, and nothing else moves that lies as far as the far field.
    lookup = {tuple(p): q for p, q in zip(np.round(x, 9).tolist(), x + d)}
    expected = np.array([lookup[tuple(p)] for p in np.round(mesh.mesh.coordinates[wall], 9).tolist()])
    np.testing.assert_allclose(grid[wall], expected, atol=1e-9 * np.ptp(x))
    assert mesh.mesh.quality(grid, fast=True)["inverted"] <= mesh.mesh.quality(fast=True)["inverted"]
    mesh.setSurfaceCoordinates(x)
    mesh.warpMesh()
    np.testing.assert_array_equal(mesh.getCommonGrid(), mesh.mesh.coordinates.ravel())
    mesh.setSurfaceCoordinates(x + d)
    mesh.warpMesh()


def test_connectivity_numbers_the_points(moved):
    mesh, x, _ = moved
    conn, sizes = mesh.getSurfaceConnectivity()
    assert sizes.sum() == len(conn) and conn.min() == 0 and conn.max() == len(x) - 1
    assert len(np.unique(conn)) == len(x)
    # Faces are small: their corners are near one another.
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    size = [np.ptp(x[conn[a:b]], axis=0).max() for a, b in zip(offsets, offsets[1:])]
    assert max(size) < 0.5 * np.ptp(x, axis=0).max()


@pytest.mark.parametrize("displaced", [False, True])
def test_transpose_is_that_of_the_forward_derivative(moved, displaced):
    mesh, x, d = moved
    random = np.random.default_rng(3)
    mesh.setSurfaceCoordinates(x + d if displaced else x)
    indices = random.permutation(3 * mesh.mesh.n_nodes)[: 2 * mesh.mesh.n_nodes]
    mesh.setExternalMeshIndices(indices)
    seed, weight = random.standard_normal(x.shape), random.standard_normal(len(indices))
    forwards = mesh.warpDerivFwd(seed)
    mesh.warpDeriv(weight)
    assert mesh.getdXs().shape == x.shape
    scale = np.abs(weight).sum() * np.abs(forwards).max()
    assert abs(forwards @ weight - np.vdot(mesh.getdXs(), seed)) < 1e-13 * scale
    mesh._indices = None
    mesh.setSurfaceCoordinates(x + d)


def test_derivatives_are_those_of_centred_differences(moved, capsys):
    mesh, x, d = moved
    assert mesh.verifyWarpDeriv(dofStart=3, dofEnd=6, h=1e-6) < 1e-6
    assert "dof 3" in capsys.readouterr().out
    random = np.random.default_rng(5)
    # So small that no node of the tip goes over a kink: edges of walls keep the height above that face which needs it most.
    seed = random.standard_normal(x.shape) * np.ptp(x, axis=0).max() * 1e-7
    grids = []
    for sign in (1, -1):
        mesh.setSurfaceCoordinates(x + d + sign * seed)
        mesh.warpMesh()
        grids.append(mesh.getSolverGrid())
    mesh.setSurfaceCoordinates(x + d)
    mesh.warpMesh()
    exact = mesh.warpDerivFwd(seed)
    np.testing.assert_allclose((grids[0] - grids[1]) / 2, exact, atol=2e-5 * np.abs(exact).max())


@pytest.mark.parametrize("name", WINGS)
def test_surfaces_of_a_solver_with_copies_at_block_edges(name, meshes):
    plain = USMesh({"gridFile": str(meshes / name)})
    grid = plain.mesh
    # As a solver has them: every face of every patch with points of its own.
    offsets, nodes = grid.facets(["type:wall"])
    points = grid.coordinates[nodes]
    order = np.random.default_rng(1).permutation(len(points))
    mesh = USMesh({"GridFile": grid, "LdefFact": 50.0})
    mesh.setSurfaceDefinition(points[order], np.argsort(order), np.diff(offsets))
    np.testing.assert_array_equal(mesh.getSurfaceCoordinates(), points[order])
    d = bent(points[order])
    mesh.setSurfaceCoordinates(points[order] + d)
    mesh.warpMesh()
    x = plain.getSurfaceCoordinates()
    plain.setSurfaceCoordinates(x + bent(x))
    plain.warpMesh()
    np.testing.assert_allclose(mesh.getSolverGrid(), plain.getSolverGrid(), atol=1e-12 * np.ptp(x))
    # Gradients: what all copies of a place get adds up to that of the place.
    weight = np.random.default_rng(2).standard_normal(3 * grid.n_nodes)
    mesh.warpDeriv(weight)
    plain.warpDeriv(weight)
    assert np.vdot(mesh.getdXs(), d) == pytest.approx(np.vdot(plain.getdXs(), bent(x)), rel=1e-9)
    seed = np.random.default_rng(4).standard_normal(points.shape)
    assert mesh.warpDerivFwd(seed) @ weight == pytest.approx(np.vdot(mesh.getdXs(), seed), rel=1e-9, abs=1e-9)


def test_periodic_copies_of_a_surface_turn_along(meshes):
    grid = gridmorph.Mesh.read(meshes / "axial_turbine_stage_H.cgns")

    def turned(x):
        """About the axis, by an angle that depends on the axial position: the same for every passage."""
        angle = 0.02 * np.sin(7 * x[:, 0]) * (1 + x[:, 0])
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([x[:, 0], c * x[:, 1] - s * x[:, 2], s * x[:, 1] + c * x[:, 2]], axis=1)

    mesh = USMesh({"gridFile": grid})
    x = mesh.getSurfaceCoordinates()
    assert (np.abs(mesh.plan.boundary_places[3] - np.eye(3)) > 1e-3).any()
    mesh.setSurfaceCoordinates(turned(x))
    mesh.warpMesh()
    wall = grid.nodes_of(["type:wall"])
    np.testing.assert_allclose(mesh.getSolverGrid().reshape(-1, 3)[wall], turned(grid.coordinates[wall]), atol=1e-14)
    # Faces are in one passage, and gradients come back to the copies.
    conn, sizes = mesh.getSurfaceConnectivity()
    assert set(sizes) == {4} and np.ptp(x[conn].reshape(-1, 4, 3), axis=1).max() < 0.02
    random = np.random.default_rng(6)
    seed, weight = random.standard_normal(x.shape), random.standard_normal(3 * grid.n_nodes)
    mesh.warpDeriv(weight)
    assert mesh.warpDerivFwd(seed) @ weight == pytest.approx(np.vdot(mesh.getdXs(), seed), rel=1e-10, abs=1e-9)


def test_solver_order_and_the_sum_of_its_copies(meshes):
    mesh = USMesh({"gridFile": str(meshes / WINGS[1])})
    indices = np.array([5, 3, 3, 0])
    mesh.setExternalMeshIndices(indices)
    np.testing.assert_array_equal(mesh.getSolverGrid(), mesh.getCommonGrid()[indices])
    mesh.warpDeriv(np.array([1.0, 2.0, 4.0, 8.0]))
    in_solver = mesh.getdXs()
    common = np.zeros(3 * mesh.mesh.n_nodes)
    common[[5, 3, 0]] = 1, 6, 8
    mesh.warpDeriv(common, solverVec=False)
    np.testing.assert_array_equal(mesh.getdXs(), in_solver)
    sizes = mesh.warp.griddata
    assert (sizes.solvermeshdof, sizes.warpmeshdof) == (4, 3 * mesh.mesh.n_nodes)


def test_grids_are_written_in_the_format_they_were_read(meshes, tmp_path, moved):
    mesh = moved[0]
    path = tmp_path / ("moved" + mesh.mesh.source[mesh.mesh.source.rindex("."):])
    mesh.writeGrid(str(path))
    np.testing.assert_allclose(gridmorph.Mesh.read(path).coordinates.ravel(), mesh.getCommonGrid(), atol=1e-14)


def test_named_surfaces_move_alone_and_symmetry_planes_hold(meshes):
    mesh = USMesh({"gridFile": str(meshes / WINGS[0]), "specifiedSurfaces": ["WALL"], "symmetryPlanes": [[[0, 0, 0], [0, 0, 1.0]]]})
    x = mesh.getSurfaceCoordinates()
    mesh.setSurfaceCoordinates(x + [0.0, 0.1, 0.2])
    mesh.warpMesh()
    grid = mesh.getSolverGrid().reshape(-1, 3)
    symmetry = mesh.mesh.nodes_of(["type:symmetry"])
    np.testing.assert_allclose(grid[symmetry, 2], 0, atol=1e-12)
    assert np.abs(grid[symmetry] - mesh.mesh.coordinates[symmetry]).max() > 0


def test_surfaces_of_plot3d_files(meshes, tmp_path):
    n = 7
    t = np.linspace(0, 1, n)
    box = np.stack(np.meshgrid(t, t, t, indexing="ij"), axis=-1)
    boundaries = {"patch": [{"name": "floor", "zone": "box", "face": "k_min", "kind": "wall"}]
                  + [{"name": "rest", "zone": "box", "face": f, "kind": "farfield"} for f in ("i_min", "i_max", "j_min", "j_max", "k_max")]}
    mesh = USMesh({"gridFile": gridmorph.Mesh.from_blocks({"box": box}, boundaries)})

    def write(name, lift):
        floor = box[:, :, 0] + lift[..., None] * [0, 0, 1]
        values = [floor[..., c].ravel(order="F") for c in range(3)]
        (tmp_path / name).write_text(f"1\n{n} {n} 1\n" + "\n".join(" ".join(repr(float(v)) for v in part) for part in values))
        return floor

    write("surface.xyz", np.zeros((n, n)))
    mesh.setSurfaceDefinitionFromFile(tmp_path / "surface.xyz")
    bump = 0.1 * np.outer(np.sin(np.pi * t), np.sin(np.pi * t))
    bump[[0, -1]] = bump[:, [0, -1]] = 0
    floor = write("moved.xyz", bump)
    mesh.setSurfaceFromFile(tmp_path / "moved.xyz")
    mesh.warpMesh()
    np.testing.assert_allclose(mesh.getSolverGrid().reshape(n, n, n, 3)[0], floor.transpose(1, 0, 2), atol=1e-15)


@pytest.mark.parametrize("call, found", [
    (lambda m, x: m.setSurfaceDefinition(x + 0.1, [], []), "no nodes of the moving surfaces"),
    (lambda m, x: m.setSurfaceCoordinates(x[:-1]), "coordinates: must be an array of"),
    (lambda m, x: m.setExternalMeshIndices([10**9]), "entry 0 is 1000000000"),
    (lambda m, x: m.warpDeriv(np.zeros(5)), "found 5"),
    (lambda m, x: m.getdXs(), "no warpDeriv"),
    (lambda m, x: m.setOption("LdefFacto", 1), "unknown option 'LdefFacto'"),
    (lambda m, x: m.writeGrid(), "fileName is missing"),
])
def test_what_cannot_be_done_is_said(meshes, call, found):
    mesh = USMesh({"gridFile": str(meshes / WINGS[1])})
    x = mesh.getSurfaceCoordinates()
    with pytest.raises(gridmorph.ConfigError, match=found):
        call(mesh, x)


class Part:
    """One of two processes, which hand one another what they have."""
    size = 2

    def __init__(self, rank, pipe):
        self.rank, self._pipe = rank, pipe

    def allgather(self, value):
        if self.rank == 0:
            self._pipe.send(value)
            return [value, self._pipe.recv()]
        other = self._pipe.recv()  # first: a pipe holds little
        self._pipe.send(value)
        return [other, value]

    def allreduce(self, value):
        return sum(self.allgather(value))


def half_of(rank, pipe, name, points, moved, indices, weight):
    """What one process does; sends its part of the grid and of the gradient."""
    mesh = USMesh({"gridFile": name}, comm=Part(rank, pipe))
    mesh.setSurfaceDefinition(points, [], [])
    mesh.setExternalMeshIndices(indices)
    mesh.setSurfaceCoordinates(moved)
    mesh.warpMesh()
    mesh.warpDeriv(weight)
    return mesh.getSolverGrid(), mesh.getdXs(), mesh.getCommonGrid()


def other_process(pipe, results, *arguments):
    results.send(half_of(1, pipe, *arguments))


def test_processes_share_surface_and_nodes(meshes):
    name = str(meshes / WINGS[1])
    alone = USMesh({"gridFile": name})
    x = alone.getSurfaceCoordinates()
    moved = x + bent(x)
    alone.setSurfaceCoordinates(moved)
    alone.warpMesh()
    dof = 3 * alone.mesh.n_nodes
    weight = np.random.default_rng(8).standard_normal(dof)
    alone.warpDeriv(weight)
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    results, sent = context.Pipe(duplex=False)
    points, nodes = [slice(0, len(x) // 3), slice(len(x) // 3, None)], [slice(0, dof // 2), slice(dof // 2, None)]
    parts = [(name, x[p], moved[p], np.arange(dof)[n], weight[n]) for p, n in zip(points, nodes)]
    other = context.Process(target=other_process, args=(there, sent, *parts[1]), daemon=True)
    other.start()
    there.close()
    sent.close()
    out = [half_of(0, here, *parts[0]), results.recv()]
    other.join()
    np.testing.assert_allclose(np.concatenate([o[0] for o in out]), alone.getSolverGrid(), atol=1e-12)
    np.testing.assert_allclose(np.concatenate([o[2] for o in out]), alone.getCommonGrid(), atol=1e-12)
    np.testing.assert_allclose(np.concatenate([o[1] for o in out]), alone.getdXs(), atol=1e-11 * np.abs(alone.getdXs()).max())
