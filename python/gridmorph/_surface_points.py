"""Points on the moving patches of a plan, and what their displacement means for its boundary nodes."""
import numpy

from ._core import ConfigError


def coincident(points, tolerance):
    """(n,) int: equal for points closer than about the tolerance to one another, numbered from 0. Cost: O(n log n)."""
    number = numpy.arange(len(points))
    if not len(points):
        return number
    # Sorted along one axis, then along the next among those that are close: neighbours in all three become one.
    group = numpy.zeros(len(points), numpy.int64)
    for c in (0, 1, 2, 0, 1, 2):
        order = numpy.lexsort((points[:, c], group))
        apart = numpy.ones(len(points), bool)
        apart[1:] = (numpy.diff(group[order]) != 0) | (numpy.diff(points[order, c]) > tolerance)
        group[order] = numpy.cumsum(apart) - 1
    return group


class SurfacePoints:
    """Displacements d (k, 3) of points -> displacements u (m, 3) of a plan's boundary nodes, and the transpose of that.

    Several points may lie on one node (copies at the edges of blocks): the node takes their mean, and a gradient goes to them in equal
    shares, so that what moves all copies alike gets the whole. A point on a periodic copy of a node moves it by the rotated displacement.
    Boundary nodes without a point stay where they are.
    """

    def __init__(self, plan, patches, places, points, tolerance, what):
        """places: (n_nodes, 3) of the mesh; patches: numbers of those that the points are on. Throws ConfigError for a point that is no
        node of them, and for nodes of them without a point."""
        row, node, patch, rotation = plan.boundary_places
        chosen = numpy.isin(patch, patches)
        row, node, rotation = row[chosen], node[chosen], rotation[chosen]
        self.n_points, self.n_rows = len(points), len(plan.boundary_nodes)
        group = coincident(numpy.concatenate([places[node], points]), tolerance)
        of_place, of_point = group[:len(node)], group[len(node):]
        n_groups = int(group.max()) + 1 if len(group) else 0
        has_node = numpy.zeros(n_groups, bool)
        has_node[of_place] = True
        per_group = numpy.bincount(of_point, minlength=n_groups)
        lost = numpy.flatnonzero(~has_node[of_point])
        if len(lost):
            raise ConfigError(f"{what}: {len(lost)} of {len(points)} points are no nodes of the moving surfaces (within {tolerance:.3g}), the "
                              f"first number {lost[0]} at {points[lost[0]].tolist()}; give nodes of the mesh, and name their patches")
        bare = numpy.flatnonzero(per_group[of_place] == 0)
        if len(bare):
            raise ConfigError(f"{what}: {len(bare)} nodes of the moving surfaces have no point, the first is node {node[bare[0]]} at "
                              f"{places[node[bare[0]]].tolist()}; give a point for each, or leave its patch out of the surfaces")
        # One entry per boundary node and group: places of several patches there say the same.
        turned = numpy.abs(rotation - numpy.eye(3)).max(axis=(1, 2)) > 0
        _, first = numpy.unique(numpy.stack([row, of_place]), axis=1, return_index=True)
        self._row, self._group, self._turned = row[first], of_place[first], turned[first]
        self._rotation = rotation[first][self._turned]
        self._share = 1.0 / numpy.bincount(self._row, minlength=self.n_rows)[self._row]
        self._of_point, self._n_groups, self._per_group = of_point, n_groups, numpy.maximum(per_group, 1)

    def to_boundary(self, d):
        """(n_points, 3) -> (m, 3)."""
        group = _sums(d, self._of_point, self._n_groups) / self._per_group[:, None]
        value = group[self._group] * self._share[:, None]
        if len(self._rotation):
            value[self._turned] = numpy.einsum("nji,nj->ni", self._rotation, value[self._turned])
        return _sums(value, self._row, self.n_rows)

    def to_points(self, gradient):
        """(m, 3) -> (n_points, 3), the transpose."""
        value = gradient[self._row] * self._share[:, None]
        if len(self._rotation):
            value[self._turned] = numpy.einsum("nij,nj->ni", self._rotation, value[self._turned])
        group = _sums(value, self._group, self._n_groups) / self._per_group[:, None]
        return group[self._of_point]


class SlipPlanes:
    """Boundary nodes that a plan keeps on planes: edges of what moves on a symmetry plane, say.

    A displacement off the plane is put back by the morph, but for as much as the mesh's own nodes scatter about it: finite differences with
    steps smaller than that differ from the derivative. Here it is taken away beforehand, so that they agree with any step. Which nodes these
    are is asked of the plan: one morph for each plane.
    """

    def __init__(self, mesh, plan, patches):
        """patches: numbers of those that move."""
        row, node, patch, _ = plan.boundary_places
        moving = numpy.isin(patch, patches)
        row, node = row[moving], node[moving]
        places, self._planes = mesh.coordinates, []
        if not len(row):
            return
        size = float(numpy.linalg.norm(numpy.ptp(places, axis=0)))
        touched = []
        for p, facts in enumerate(mesh.patches):
            if p in patches:
                continue
            nodes = mesh.nodes_of([f"{mesh.zones[facts['zone']]['name']}/{facts['name']}"])
            rows = numpy.unique(row[numpy.isin(node, nodes)])
            normal = _normal(places[nodes]) if len(rows) else None
            if normal is not None:
                touched.append((rows, normal, float(places[nodes].mean(axis=0) @ normal)))
        while touched:
            _, normal, offset = touched[0]
            same = [abs(n @ normal) > 1 - 1e-8 and abs(o * numpy.sign(n @ normal) - offset) < 1e-6 * size for _, n, o in touched]
            rows = numpy.unique(numpy.concatenate([t[0] for t, s in zip(touched, same) if s]))
            touched = [t for t, s in zip(touched, same) if not s]
            off = numpy.zeros((len(plan.boundary_nodes), 3))
            off[rows] = 1e-3 * size * normal
            left = plan.displacements(off)[plan.boundary_nodes[rows]] @ normal
            held = rows[left < 0.5e-3 * size]
            if len(held):
                self._planes.append((held, normal))

    def project(self, u, transpose=False):
        """u (m, 3) of all boundary nodes, in place, without what leads off the planes; a gradient with transpose. Returns u."""
        for rows, normal in reversed(self._planes) if transpose else self._planes:
            u[rows] -= (u[rows] @ normal)[:, None] * normal
        return u


def _normal(points):
    """Of the plane that points are in; None where they are in none, or on a line."""
    if len(points) < 3:
        return None
    _, stretch, axes = numpy.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return axes[2] if stretch[2] < 1e-6 * stretch[0] and stretch[1] > 1e-6 * stretch[0] else None


def _sums(values, where, n):
    return numpy.stack([numpy.bincount(where, weights=values[:, c], minlength=n) for c in range(3)], axis=1)
