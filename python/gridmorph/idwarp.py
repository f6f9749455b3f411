"""The verbs of IDWarp (mdolab/idwarp) on a gridmorph mesh: scripts of MACH-Aero change one import.

    from gridmorph.idwarp import USMesh        # from idwarp import USMesh
    mesh = USMesh({"gridFile": "wing.cgns"})
    x = mesh.getSurfaceCoordinates()           # (N, 3)
    mesh.setSurfaceCoordinates(x + d)
    mesh.warpMesh()
    mesh.writeGrid("moved.cgns")
    mesh.warpDeriv(dJ_dx)                      # of every node, in the solver's order
    dJ_dsurface = mesh.getdXs()                # (N, 3)

Names, shapes and orders are IDWarp's. What differs:

- Nodes move as gridmorph moves them. Options that tune IDWarp's own interpolation (LdefFact, aExp, ...) are taken and have no effect.
- Walls that are not among the surfaces stay where they are, and so does the far field; symmetry planes slip.
- Without setSurfaceDefinition() the surface is the nodes of the moving patches, each place once (IDWarp: each patch with all its nodes),
  in the order of their numbers in the mesh; at the edges of blocks the copy with the smallest number stands for all, and takes the sum
  of their gradients. Where setSurfaceDefinition() gives several points at one place, the mesh takes the mean of their displacements, and
  each gets an equal share of the gradient.
- Points on a symmetry plane stay on it: what leads off is taken away, from displacements and from gradients.
- Derivatives are exact at the current surface coordinates, whether warpMesh() was called or not.
- Every process of `comm` holds the whole mesh; surface points and the solver's nodes are shared out as IDWarp has them.
- Files: whatever gridmorph reads (docs/formats.md), by its content; "fileType" is not needed.
"""
from __future__ import annotations

import os
import types
import typing

import numpy
import numpy.typing

from . import ConfigError, Mesh, Motion, Plan, _refuse_inverted
from ._surface_points import SlipPlanes, SurfacePoints, coincident

__all__ = ["USMesh"]

_OPTIONS = {"gridFile": None, "fileType": "CGNS", "specifiedSurfaces": None, "symmetrySurfaces": None, "symmetryPlanes": None}
_OF_ITS_METHOD = {"aExp": 3.0, "bExp": 5.0, "LdefFact": 1.0, "alpha": 0.25, "errTol": 0.0005, "evalMode": "fast", "symmTol": 1e-6,
                  "useRotations": True, "zeroCornerRotations": True, "cornerAngle": 30.0, "restartFile": None, "bucketSize": 8}
_TOLERANCE = 1e-10  # of the size of the mesh, within which two points are one


class _Alone:
    """The communicator of a program of one process."""
    rank, size = 0, 1

    def allgather(self, value):
        return [value]

    def allreduce(self, value):
        return value


class USMesh:
    """A mesh that follows its surface, with the methods of IDWarp's class of this name.

    options: IDWarp's, upper or lower case: gridFile (a path, or a gridmorph.Mesh), specifiedSurfaces (families or names of boundary
      conditions that move; None: all walls), symmetrySurfaces (names of those that slip on their plane), symmetryPlanes
      ([[point, normal], ...]: patches in one of these slip on it, other symmetry planes are free; []: all are free), and those of its
      method, which have no effect.
    comm: an MPI communicator of mpi4py; None: this process alone. debug: taken, without effect.
    tables: tables of a case file (docs/case_file.md) as a dict, for rules of other patches and how the volume is morphed.
    freeze_guard: as in gridmorph.Plan, for the rules of the tables.

    Raises ConfigError, IoError, MeshError, MotionError, PlanError. The plan is made at the first call that needs it.
    """

    def __init__(self, options: typing.Mapping[str, typing.Any] | None = None, comm: typing.Any = None, debug: bool = False, *,
                 tables: typing.Mapping[str, typing.Any] | None = None, freeze_guard: bool = False) -> None:
        if options is None:
            raise ConfigError("USMesh: options is no option; give a dict with gridFile")
        self.options = {**_OPTIONS, **_OF_ITS_METHOD}
        for name, value in options.items():
            self.setOption(name, value)
        if self.options["gridFile"] is None:
            raise ConfigError("USMesh: option gridFile is missing; it names the mesh")
        self.comm = comm if comm is not None else _Alone()
        self.tables, self.freeze_guard = dict(tables or {}), freeze_guard
        grid = self.options["gridFile"]
        self.mesh = grid if isinstance(grid, Mesh) else Mesh.read(grid)
        self.plan = None
        self._baseline = self.mesh.coordinates
        self._grid = self._baseline
        self._indices = None
        self._dXs = None
        self._connectivity = None

    # -------------------------------------------------------------------------------------------------------------- options

    def getOption(self, name: str) -> typing.Any:
        """The value of an option."""
        return self.options[self._option(name)]

    def setOption(self, name: str, value: typing.Any) -> None:
        """Sets an option, before the first call that needs the surface."""
        self.options[self._option(name)] = value

    def _option(self, name):
        known = {key.lower(): key for key in (*_OPTIONS, *_OF_ITS_METHOD)}
        if str(name).lower() not in known:
            raise ConfigError(f"USMesh: unknown option '{name}'; known are {', '.join(sorted(known.values()))}")
        return known[str(name).lower()]

    # ------------------------------------------------------------------------------------------------------- surface and plan

    def _named(self, names):
        """Selectors of IDWarp's family names, which it compares without regard to case."""
        known = {}
        for patch in reversed(self.mesh.patches):
            known[patch["name"].lower()] = patch["name"]
        for patch in reversed(self.mesh.patches):
            known.update({family.lower(): family for family in patch["families"]})
        return [known.get(str(name).lower(), str(name)) for name in names]

    def _surfaces(self):
        """Selectors of what moves."""
        names = self.getOption("specifiedSurfaces")
        if names is not None:
            return self._named(names)
        if not any(patch["kind"] == "wall" for patch in self.mesh.patches):
            raise ConfigError(f"USMesh: '{self.mesh.source}' has no patch of the kind wall; name what moves in specifiedSurfaces, of "
                              f"{sorted({patch['name'] for patch in self.mesh.patches})}")
        return ["type:wall"]

    def _symmetry_rules(self):
        """Rules of the options about symmetry; none: what gridmorph does by itself."""
        planes, names = self.getOption("symmetryPlanes"), self.getOption("symmetrySurfaces")
        if planes is None:
            return [] if names is None else [{"patches": self._named(names), "rule": "slip", "surface": "plane"}] if names else []
        rules, size = [], float(numpy.linalg.norm(numpy.ptp(self._baseline, axis=0)))
        moving = set(self.mesh.patch_numbers(self._surfaces()).tolist())
        for p, patch in enumerate(self.mesh.patches):
            if p in moving:
                continue
            selector = f"{self.mesh.zones[patch['zone']]['name']}/{patch['name']}"
            nodes = self._baseline[self.mesh.nodes_of([selector])]
            on = [plane for plane in planes if numpy.abs((nodes - plane[0]) @ numpy.asarray(plane[1], float)).max() < 1e-6 * size]
            if on:
                normal = numpy.asarray(on[0][1], float)
                rules.append({"patches": [selector], "rule": "slip", "surface": "plane", "plane": {"point": on[0][0], "normal": normal}})
            elif patch["kind"] == "symmetry":
                rules.append({"patches": [selector], "rule": "free"})
        return rules

    def _make_plan(self, covered=None):
        """covered(nodes) -> bool: whether a patch with these nodes moves."""
        surfaces = self._surfaces()
        numbers = self.mesh.patch_numbers(surfaces)
        if covered is not None:
            patches, zones = self.mesh.patches, self.mesh.zones
            names = {int(p): f"{zones[patches[p]['zone']]['name']}/{patches[p]['name']}" for p in numbers}
            numbers = numpy.array([p for p, name in names.items() if covered(self.mesh.nodes_of([name]))], numpy.int64)
            surfaces = [names[int(p)] for p in numbers]
            numbers = self.mesh.patch_numbers(surfaces) if surfaces else numbers
        tables = dict(self.tables)
        tables["motion"] = [*tables.get("motion", []), *self._symmetry_rules()]
        motion = Motion(tables)
        if surfaces:
            motion.prescribed(surfaces)
        self.plan = Plan(self.mesh, motion, freeze_guard=self.freeze_guard)
        return numbers

    def _tolerance(self):
        return _TOLERANCE * float(numpy.linalg.norm(numpy.ptp(self._baseline, axis=0)))

    def _ensure_surface(self):
        """The surface of the options, where none was defined. Of several processes the first one has it."""
        if self.plan is not None:
            return
        numbers = self._make_plan()
        row, node, patch, rotation = self.plan.boundary_places
        chosen = numpy.isin(patch, numbers)
        row, node, rotation = row[chosen], node[chosen], rotation[chosen]
        # One point per place: copies of a node are one, those that a rotation takes elsewhere are not.
        here = numpy.abs(self._baseline[node] - self._baseline[self.plan.boundary_nodes[row]]).max(axis=1, initial=0) <= self._tolerance()
        order = numpy.lexsort((node,))
        key = numpy.stack([row, numpy.where(here, -1, node)])[:, order]
        _, first, which = numpy.unique(key, axis=1, return_index=True, return_inverse=True)
        by_number = numpy.argsort(node[order][first])
        exposed = node[order][first][by_number]
        place = numpy.empty(len(first), numpy.int64)
        place[by_number] = numpy.arange(len(first))
        point_of = dict(zip(node[order].tolist(), place[which.ravel()].tolist()))
        offsets, corners = self.mesh.facets(self._surfaces())
        conn = numpy.array([point_of[n] for n in corners.tolist()], numpy.int64)
        mine = self.comm.rank == 0
        points = self._baseline[exposed] if mine else numpy.zeros((0, 3))
        self._set_points(points, conn if mine else conn[:0], numpy.diff(offsets) if mine else offsets[:0], numbers, "surface of USMesh")

    def _set_points(self, points, conn, face_sizes, numbers, what):
        shares = self.comm.allgather(points)
        begin = sum(len(share) for share in shares[:self.comm.rank])
        self._mine = slice(begin, begin + len(points))
        self._map = SurfacePoints(self.plan, numbers, self._baseline, numpy.concatenate(shares), self._tolerance(), what)
        self._planes = SlipPlanes(self.mesh, self.plan, numbers)
        self.nSurf = len(points)
        self._points = numpy.array(points, dtype=float)
        self._current = self._points.copy()
        self._connectivity = (numpy.asarray(conn).ravel(), numpy.asarray(face_sizes).ravel())
        self._grid = self._baseline

    def setSurfaceDefinition(self, pts: numpy.typing.ArrayLike, conn: numpy.typing.ArrayLike, faceSizes: numpy.typing.ArrayLike,
                             cgnsBlockID: object = None) -> None:
        """The surface as a solver has it: pts (M, 3) of this process [length], each a node of the mesh; conn, faceSizes: nodes of its faces.

        Patches (of the surfaces in the options) move of which all nodes are among the points. cgnsBlockID: taken, without effect. Raises
        ConfigError for a point that is no node of such a patch.
        """
        points = numpy.asarray(pts, dtype=float).reshape(-1, 3)
        everywhere = numpy.concatenate(self.comm.allgather(points))
        nodes = self.mesh.nodes_of(self._surfaces())
        group = _groups(self._baseline[nodes], everywhere, self._tolerance())
        has_point = numpy.zeros(self.mesh.n_nodes, bool)
        has_point[nodes] = group
        numbers = self._make_plan(lambda of_patch: bool(has_point[of_patch].all()))
        self._set_points(points, conn, faceSizes, numbers, "setSurfaceDefinition")

    def setSurfaceDefinitionFromFile(self, surfFile: str | os.PathLike[str]) -> None:
        """setSurfaceDefinition() with the points of a multi-block PLOT3D surface file (text)."""
        points, conn = _plot3d_surface(surfFile) if self.comm.rank == 0 else (numpy.zeros((0, 3)), numpy.zeros((0, 4), int))
        self.setSurfaceDefinition(points, conn, numpy.full(len(conn), 4))

    def setSurfaceFromFile(self, surfFile: str | os.PathLike[str]) -> None:
        """setSurfaceCoordinates() with the points of such a file, of the blocks of setSurfaceDefinitionFromFile()."""
        self.setSurfaceCoordinates(_plot3d_surface(surfFile)[0] if self.comm.rank == 0 else numpy.zeros((0, 3)))

    def getSurfaceCoordinates(self) -> numpy.typing.NDArray[numpy.float64]:
        """(N, 3) [length]: the surface as it is now. Of several processes each has its own points, (0, 3) where it has none."""
        self._ensure_surface()
        return self._current.copy()

    def getSurfaceConnectivity(self) -> tuple[numpy.typing.NDArray[numpy.int64], numpy.typing.NDArray[numpy.int64]]:
        """(conn, faceSizes): the faces of the surface, conn (sum of faceSizes,) numbering the rows of getSurfaceCoordinates() from 0."""
        self._ensure_surface()
        return tuple(part.copy() for part in self._connectivity)

    def setSurfaceCoordinates(self, coordinates: numpy.typing.ArrayLike) -> None:
        """Where the surface shall be, (N, 3) [length], in the order of getSurfaceCoordinates(). warpMesh() moves the mesh."""
        self._ensure_surface()
        self._current = self._rows(coordinates, "coordinates").copy()

    def _rows(self, values, name):
        values = numpy.asarray(values, dtype=float)
        if values.size != 3 * self.nSurf:
            raise ConfigError(f"{name}: must be an array of ({self.nSurf}, 3), found {values.shape}")
        return values.reshape(-1, 3)

    def _boundary(self, values):
        """Of the points of all processes -> of the plan's boundary nodes."""
        return self._planes.project(self._map.to_boundary(numpy.concatenate(self.comm.allgather(values))))

    # ----------------------------------------------------------------------------------------------------------------- volume

    def warpMesh(self) -> None:
        """Moves all nodes along with the surface."""
        self._ensure_surface()
        self._grid = self.plan.positions(self._boundary(self._current - self._points))

    def setExternalMeshIndices(self, ind: numpy.typing.ArrayLike) -> None:
        """Which numbers of the mesh this process's solver has, in its order: (ndof,) int, 3 n + component (0, 1, 2) for node n, from 0.

        That is what getSolverMeshIndices() of ADflow gives. Nodes count through the zones of the file, i fastest.
        """
        ind = numpy.asarray(ind).ravel().astype(numpy.int64)
        if len(ind) and (ind.min() < 0 or ind.max() >= 3 * self.mesh.n_nodes):
            bad = numpy.flatnonzero((ind < 0) | (ind >= 3 * self.mesh.n_nodes))[0]
            raise ConfigError(f"setExternalMeshIndices: entry {bad} is {ind[bad]}; the mesh has {self.mesh.n_nodes} nodes, so 0 to "
                              f"{3 * self.mesh.n_nodes - 1} are coordinates of it")
        self._indices = ind

    def getSolverGrid(self) -> numpy.typing.NDArray[numpy.float64]:
        """(ndof,) [length]: the mesh as it is now, in the order of setExternalMeshIndices(); without that, of getCommonGrid()."""
        return self._to_solver(self._grid)

    def getCommonGrid(self) -> numpy.typing.NDArray[numpy.float64]:
        """(3 n,) [length]: the mesh as it is now, x y z of each node, in the order of the file.

        Of several processes the first has it, the others (0,).
        """
        return self._of_file(self._grid)

    def getWarpGrid(self) -> numpy.typing.NDArray[numpy.float64]:
        """The same as getCommonGrid(): no other order is kept."""
        return self.getCommonGrid()

    @property
    def warp(self) -> types.SimpleNamespace:
        """Sizes that scripts ask of IDWarp's compiled part: warp.griddata.warpmeshdof, commonmeshdof, solvermeshdof of this process."""
        dof = 3 * self.mesh.n_nodes if self.comm.rank == 0 else 0
        solver = dof if self._indices is None else len(self._indices)
        return types.SimpleNamespace(griddata=types.SimpleNamespace(warpmeshdof=dof, commonmeshdof=dof, solvermeshdof=solver))

    def _of_file(self, values):
        return values.reshape(-1).copy() if self.comm.rank == 0 else numpy.zeros(0)

    def _to_solver(self, values):
        return self._of_file(values) if self._indices is None else values.reshape(-1)[self._indices]

    def _from_solver(self, values, solver):
        """(n, 3) of the mesh: entries of one node add up, those of all processes too."""
        values = numpy.asarray(values, dtype=float).ravel()
        n = 3 * self.mesh.n_nodes
        known = solver and self._indices is not None
        expected = len(self._indices) if known else n if self.comm.rank == 0 else 0
        if len(values) != expected:
            raise ConfigError(f"dXv: must have {expected} entries, {'those of setExternalMeshIndices()' if known else '3 for each node'}, "
                              f"found {len(values)}")
        if known:
            full = numpy.bincount(self._indices, weights=values, minlength=n)
        else:
            full = values if self.comm.rank == 0 else numpy.zeros(n)
        return numpy.asarray(self.comm.allreduce(full)).reshape(-1, 3)

    # ------------------------------------------------------------------------------------------------------------- derivatives

    def warpDeriv(self, dXv: numpy.typing.ArrayLike, solverVec: bool = True) -> None:
        """dJ/dXs of the surface from dXv = dJ/dx (ndof,) of the solver's mesh; getdXs() has it.

        solverVec False: dXv (3 n,) or (n, 3) is in the order of the file, on the first process alone. Exact, at the current surface
        coordinates. Cost: about one warpMesh().
        """
        self._ensure_surface()
        u = self._boundary(self._current - self._points)
        gradient = self.plan.transpose(self._from_solver(dXv, solverVec), u)
        self._dXs = self._map.to_points(self._planes.project(gradient, transpose=True))[self._mine]

    def getdXs(self) -> numpy.typing.NDArray[numpy.float64]:
        """(N, 3): what the last warpDeriv() found, in the order of getSurfaceCoordinates()."""
        if self._dXs is None:
            raise ConfigError("getdXs: no warpDeriv() yet; call it first")
        return self._dXs.copy()

    def warpDerivFwd(self, dXs: numpy.typing.ArrayLike, solverVec: bool = True) -> numpy.typing.NDArray[numpy.float64]:
        """(ndof,): how the mesh moves where the surface coordinates move by dXs (N, 3), to first order; exact, at the current ones.

        solverVec False: (3 n,), in the order of the file, on the first process alone.
        """
        self._ensure_surface()
        u = self._boundary(self._current - self._points)
        moved = self.plan.velocities(self._boundary(self._rows(dXs, "dXs")), u)
        return self._to_solver(moved) if solverVec else self._of_file(moved)

    def verifyWarpDeriv(self, dXv: numpy.typing.ArrayLike | None = None, solverVec: bool = True, dofStart: int = 0, dofEnd: int = 10,
                        h: float = 1e-6, randomSeed: int = 314) -> float:
        """Compares warpDeriv() with centred differences for numbers dofStart to dofEnd - 1 of the surface coordinates; prints both.

        dXv: as there; None: random, of `randomSeed`. h: step, of the size of the surface. Returns the largest difference, of the largest
        entry of dXs. On one process.
        """
        self._ensure_surface()
        if dXv is None:
            dXv = numpy.random.default_rng(randomSeed).random(3 * self.mesh.n_nodes)
            solverVec = False
        self.warpDeriv(dXv, solverVec)
        gradient, weight = self._from_solver(dXv, solverVec), self._current - self._points
        step = h * float(numpy.linalg.norm(numpy.ptp(self._points, axis=0)))
        worst, scale = 0.0, float(numpy.abs(self._dXs).max())
        for dof in range(dofStart, min(dofEnd, 3 * self.nSurf)):
            moved = []
            for sign in (1, -1):
                d = weight.copy()
                d.ravel()[dof] += sign * step
                moved.append(self.plan.displacements(self._boundary(d)))
            difference = float(numpy.vdot(gradient, moved[0] - moved[1])) / (2 * step)
            exact = float(self._dXs.ravel()[dof])
            worst = max(worst, abs(difference - exact) / scale)
            print(f"dof {dof}: warpDeriv {exact: .12e}, differences {difference: .12e}")
        return worst

    # ------------------------------------------------------------------------------------------------------------------ output

    def writeGrid(self, fileName: str | os.PathLike[str] | None = None, *, allow_inverted: bool = False) -> None:
        """Writes the mesh as it is now, in the format of gridFile (docs/formats.md). Without a name: back into an OpenFOAM case alone.

        A file that is there is replaced, as IDWarp does, but never gridFile itself. allow_inverted: as in Mesh.write.
        """
        if fileName is None:
            if str(self.getOption("fileType")).lower() != "openfoam":
                raise ConfigError("writeGrid: fileName is missing; only OpenFOAM cases are written where they were read")
            if self.comm.rank == 0:  # where it was read: asked for by leaving the name out
                if not allow_inverted:
                    _refuse_inverted(self.mesh, self.mesh.source, self._grid)
                self.mesh._write(self.mesh.source, self._grid)
        elif self.comm.rank == 0:
            self.mesh.write(fileName, self._grid, overwrite=True, allow_inverted=allow_inverted)


def _groups(nodes, points, tolerance):
    """For each node whether a point lies on it."""
    group = coincident(numpy.concatenate([nodes, points]), tolerance)
    there = numpy.zeros(int(group.max()) + 1 if len(group) else 0, bool)
    there[group[len(nodes):]] = True
    return there[group[:len(nodes)]]


def _plot3d_surface(path):
    """Points (n, 3) and quadrilaterals (m, 4) of a multi-block PLOT3D surface in text: blocks, ni nj 1 of each, x, y and z of each."""
    with open(path) as file:
        words = numpy.array(file.read().split(), dtype=float)
    n_blocks = int(words[0])
    sizes = words[1:1 + 3 * n_blocks].astype(int).reshape(n_blocks, 3)
    at, points, conn, first = 1 + 3 * n_blocks, [], [], 0
    for ni, nj, nk in sizes:
        n = ni * nj * nk
        points.append(words[at:at + 3 * n].reshape(3, n).T)
        number = first + numpy.arange(n).reshape(nj * nk, ni)
        conn.append(numpy.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4))
        at, first = at + 3 * n, first + n
    return numpy.concatenate(points), numpy.concatenate(conn)
