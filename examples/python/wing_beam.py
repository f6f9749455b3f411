#!/usr/bin/env python3
"""A wing that bends and twists in a gust: a beam in time, and the mesh that follows it.

The beam (Euler-Bernoulli bending and St. Venant torsion, coupled by the offset of its mass, Newmark's method in time) is small and stands
for a structural solver. Each step: structural step -> displacement of the wing's surface -> positions and velocities of all nodes by one
plan -> volumes of all cells, checked against the geometric conservation law

    V(n+1) - V(n) = sum over the faces of a cell of the volume that each face sweeps between the two meshes,

which holds to round-off where both sides are exact: volumes of trilinear hexahedra, and swept volumes of bilinear faces whose corners go
straight. What fluxes of the grid velocity at mid-step leave of it instead is a matter of the time step, and is printed beside.

    examples/python/wing_beam.py [--mesh examples/meshes/717_wl_L2.cgns] [--steps 48] [--out out/wing_beam]

Leaves table.csv and, with Matplotlib, three pictures. Needs gridmorph and NumPy.
"""
import argparse
import csv
import pathlib

import numpy as np

import gridmorph

HERE = pathlib.Path(__file__).resolve().parent


class Beam:
    """Clamped at z = 0; unknowns of each node: deflection w along y [m], its slope w' along z, twist about the elastic axis [rad]."""

    E, G, DENSITY = 70e9, 26e9, 2700.0  # aluminium, Pa and kg / m^3
    MASS_OFFSET = 0.05  # of the chord, centre of mass behind the elastic axis
    DAMPING = 0.02      # of the first mode, proportional to the stiffness

    def __init__(self, span, root_chord, tip_chord, n_elements=16):
        self.z = np.linspace(0.0, span, n_elements + 1)
        n = 3 * len(self.z)
        self.M, self.K = np.zeros((n, n)), np.zeros((n, n))
        for e in range(n_elements):
            chord = root_chord + (tip_chord - root_chord) * 0.5 * (self.z[e] + self.z[e + 1]) / span
            at = slice(3 * e, 3 * e + 6)
            M, K = self._element(self.z[e + 1] - self.z[e], chord)
            self.M[at, at] += M
            self.K[at, at] += K
        self.free = slice(3, None)
        squares = np.linalg.eigvals(np.linalg.solve(self.M[3:, 3:], self.K[3:, 3:])).real
        self.frequencies = np.sqrt(np.sort(squares)) / (2 * np.pi)
        self.C = self.DAMPING / (np.pi * self.frequencies[0]) * self.K
        self.q, self.v, self.a = np.zeros(n), np.zeros(n), np.zeros(n)

    def _element(self, length, chord):
        """Consistent mass and stiffness of a closed box, 0.4 by 0.1 chords, its walls 0.004 chords; half as much mass again is no structure."""
        wide, high, wall = 0.4 * chord, 0.1 * chord, 0.004 * chord
        inertia = 2 * wall * (wide * (high / 2) ** 2 + high**3 / 12)
        torsion = 4 * (wide * high) ** 2 * wall / (2 * (wide + high))
        mass = 1.5 * self.DENSITY * 2 * wall * (wide + high)
        polar = mass * (0.25 * chord) ** 2
        K, M = np.zeros((6, 6)), np.zeros((6, 6))
        bend, twist = np.array([0, 1, 3, 4]), np.array([2, 5])
        L = length
        K[np.ix_(bend, bend)] = self.E * inertia / L**3 * np.array(
            [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2], [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]])
        K[np.ix_(twist, twist)] = self.G * torsion / L * np.array([[1, -1], [-1, 1]])
        M[np.ix_(bend, bend)] = mass * L / 420 * np.array(
            [[156, 22 * L, 54, -13 * L], [22 * L, 4 * L**2, 13 * L, -3 * L**2], [54, 13 * L, 156, -22 * L], [-13 * L, -3 * L**2, -22 * L, 4 * L**2]])
        M[np.ix_(twist, twist)] = polar * L / 6 * np.array([[2, 1], [1, 2]])
        # Nose up is positive, so that mass behind the axis goes down: integrals of the cubic and the linear shape functions.
        couple = -mass * self.MASS_OFFSET * chord * L / 60 * np.array([[21, 9], [3 * L, 2 * L], [9, 21], [-2 * L, -3 * L]])
        M[np.ix_(bend, twist)] = couple
        M[np.ix_(twist, bend)] = couple.T
        return M, K

    def load(self, lift, moment):
        """Nodal forces of a constant lift [N / m] and nose-up moment [N m / m] along the span."""
        f, L = np.zeros(len(self.q)), np.diff(self.z)
        for e, length in enumerate(L):
            f[3 * e:3 * e + 6] += length * np.array([lift / 2, lift * length / 12, moment / 2, lift / 2, -lift * length / 12, moment / 2])
        return f

    def step(self, dt, force):
        """Newmark's method with constant mean acceleration: no damping of its own, second order."""
        s = self.free
        q = self.q + dt * self.v + 0.25 * dt**2 * self.a
        v = self.v + 0.5 * dt * self.a
        A = self.M + 0.5 * dt * self.C + 0.25 * dt**2 * self.K
        a = np.zeros_like(self.a)
        a[s] = np.linalg.solve(A[s, s], (force - self.C @ v - self.K @ q)[s])
        self.q, self.v, self.a = q + 0.25 * dt**2 * a, v + 0.5 * dt * a, a

    def energy(self):
        return 0.5 * (self.v @ self.M @ self.v + self.q @ self.K @ self.q)

    def at(self, z, values):
        """w, w' and twist at spanwise positions, of `values` of the nodes (their displacements, or their rates)."""
        values = values.reshape(-1, 3)
        e = np.clip(np.searchsorted(self.z, z) - 1, 0, len(self.z) - 2)
        L = self.z[e + 1] - self.z[e]
        s = np.clip((z - self.z[e]) / L, 0, 1)
        (w0, d0, t0), (w1, d1, t1) = values[e].T, values[e + 1].T
        w = w0 * (1 - 3 * s**2 + 2 * s**3) + d0 * L * (s - 2 * s**2 + s**3) + w1 * (3 * s**2 - 2 * s**3) + d1 * L * (s**3 - s**2)
        slope = (w1 - w0) / L * 6 * (s - s**2) + d0 * (1 - 4 * s + 3 * s**2) + d1 * (3 * s**2 - 2 * s)
        w += np.maximum(z - self.z[-1], 0) * slope  # beyond the last node, straight on
        return w, slope, t0 + (t1 - t0) * s


class Wing:
    """Nodes of the wing's surface on the beam: sections turn about the elastic axis, go up with it and stay across it."""

    def __init__(self, points, beam, axis_of):
        self.points, self.beam = points, beam
        self.x, self.y = points[:, 0] - axis_of(points[:, 2]), points[:, 1]

    def displacement(self, q):
        w, slope, twist = self.beam.at(self.points[:, 2], q)
        c, s = np.cos(twist), np.sin(twist)
        return np.stack([self.x * (c - 1) + self.y * s, -self.x * s + self.y * (c - 1) + w, -self.y * slope], axis=1)

    def velocity(self, q, v):
        twist = self.beam.at(self.points[:, 2], q)[2]
        w_t, slope_t, twist_t = self.beam.at(self.points[:, 2], v)
        c, s = np.cos(twist), np.sin(twist)
        return np.stack([(-self.x * s + self.y * c) * twist_t, (-self.x * c - self.y * s) * twist_t + w_t, -self.y * slope_t], axis=1)


# ---------------------------------------------------------------------------------------- volumes, swept volumes, fluxes of a block

GAUSS = (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3))  # weights 1/2: exact for cubics


def volumes(X):
    """(ni-1, nj-1, nk-1): of trilinear hexahedra between nodes X (ni, nj, nk, 3). Their Jacobian is quadratic along each axis."""
    def edge(axis, u, v):
        d = np.diff(X, axis=axis)
        for other, s in zip([a for a in range(3) if a != axis], (u, v)):
            d = (1 - s) * np.take(d, range(d.shape[other] - 1), other) + s * np.take(d, range(1, d.shape[other]), other)
        return d

    out = 0
    for i in GAUSS:
        for j in GAUSS:
            for k in GAUSS:
                out = out + np.einsum("...c,...c", np.cross(edge(0, j, k), edge(1, i, k)), edge(2, i, j)) / 8
    return out


def faces(X, axis):
    """Corners (4, ..., 3) of the faces across an index direction, around it."""
    a, b = (axis + 1) % 3, (axis + 2) % 3
    def corner(da, db):
        at = [slice(None)] * 3
        at[a], at[b] = (slice(da, X.shape[a] - 1 + da), slice(db, X.shape[b] - 1 + db))
        return X[tuple(at)]
    return np.stack([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)])


def flux(quads, motion):
    """Integral of `motion` over bilinear faces: both (4, ..., 3) at the corners."""
    out = 0
    for s in GAUSS:
        for t in GAUSS:
            along = (1 - t) * (quads[1] - quads[0]) + t * (quads[2] - quads[3])
            across = (1 - s) * (quads[3] - quads[0]) + s * (quads[2] - quads[1])
            m = (1 - s) * (1 - t) * motion[0] + s * (1 - t) * motion[1] + s * t * motion[2] + (1 - s) * t * motion[3]
            out = out + np.einsum("...c,...c", m, np.cross(along, across)) / 4
    return out


def swept(X0, X1, axis):
    """Volume that each face sweeps while its corners go straight from X0 to X1: exact, since the integrand is quadratic in time."""
    Q0, Q1 = faces(X0, axis), faces(X1, axis)
    return sum(flux((1 - t) * Q0 + t * Q1, Q1 - Q0) / 2 for t in GAUSS)


def out_of_cells(of_faces):
    """Sum over the faces of each cell, outwards; of_faces: one array for each index direction. And the sum of what goes through, unsigned."""
    return (sum(np.diff(f, axis=a) for a, f in enumerate(of_faces)),
            sum(np.take(abs(f), range(f.shape[a] - 1), a) + np.take(abs(f), range(1, f.shape[a]), a) for a, f in enumerate(of_faces)))


class Blocks:
    """Arrays (n, 3) of all nodes, block by block."""

    def __init__(self, mesh):
        self.zones = [(slice(z["first_node"], z["first_node"] + z["n_nodes"]), z["shape"]) for z in mesh.zones]

    def __call__(self, x):
        for where, shape in self.zones:
            yield np.stack([x[where, c].reshape(shape, order="F") for c in range(3)], axis=-1)


def conservation(blocks, x0, x1, x_middle, v_middle, dt):
    """Of all cells: the largest error of the law with swept volumes, of the volumes that go through a cell's faces; the same with fluxes of
    the velocity at mid-step; the smallest ratio of volumes."""
    exact = by_velocity = 0.0
    ratio = np.inf
    for X0, X1, Xm, Vm in zip(blocks(x0), blocks(x1), blocks(x_middle), blocks(v_middle)):
        before, after = volumes(X0), volumes(X1)
        net, gross = out_of_cells([swept(X0, X1, a) for a in range(3)])
        by_flux, _ = out_of_cells([dt * flux(faces(Xm, a), faces(Vm, a)) for a in range(3)])
        scale = gross + abs(before)
        exact = max(exact, float((abs(after - before - net) / scale).max()))
        by_velocity = max(by_velocity, float((abs(after - before - by_flux) / scale).max()))
        ratio = min(ratio, float((after / before).min()))
    return exact, by_velocity, ratio


# -------------------------------------------------------------------------------------------------------------------- the coupling


def run(mesh_path, steps=48, periods=1.5, lift=30e3, moment=-6e3, layers=10):
    """Rows of the table as dicts, and what the pictures show."""
    mesh = gridmorph.Mesh.read(mesh_path)
    motion = gridmorph.Motion({"boundary_layer": [{"walls": ["wall"], "extent": {"layers": layers}}]}).prescribed("wall")
    plan = gridmorph.Plan(mesh, motion)

    # The rows of u that are the wing's, and the edges of its faces between them.
    row, node, patch, _ = plan.boundary_places
    on_wall = np.isin(patch, mesh.patch_numbers(["wall"]))
    wall = np.unique(row[on_wall])
    row_of = np.full(mesh.n_nodes, -1)
    row_of[node[on_wall]] = np.searchsorted(wall, row[on_wall])
    quads = row_of[mesh.facets(["wall"])[1]].reshape(-1, 4)
    points = mesh.coordinates[plan.boundary_nodes[wall]]

    # The beam runs through the middle of the wing, 0.4 chords behind its leading edge.
    root, tip = points[:, 2].min(), points[:, 2].max()
    stations = np.linspace(root, tip, 30)
    bands = [points[abs(points[:, 2] - z) <= 0.6 * (stations[1] - stations[0]), 0] for z in stations]
    leading, trailing = (np.interp(stations, [z for z, b in zip(stations, bands) if len(b)], [f(b) for b in bands if len(b)]) for f in (min, max))
    chord = trailing - leading
    beam = Beam(tip - root, chord[1], chord[-2])
    wing = Wing(points, beam, lambda z: np.interp(z, stations, leading + 0.4 * chord))

    def boundary(values):
        u = np.zeros((len(plan.boundary_nodes), 3))
        u[wall] = values
        return u

    period = 1 / beam.frequencies[0]
    dt = periods * period / steps
    blocks, x = Blocks(mesh), plan.positions(boundary(np.zeros_like(points)))
    rows, shapes = [], [wing.displacement(beam.q)]
    for n in range(1, steps + 1):
        t, q0, v0 = n * dt, beam.q, beam.v
        gust = np.sin(np.pi * t / period) ** 2 if t < period else 0.0
        beam.step(dt, gust * beam.load(lift, moment))
        # Half way between both states: where the velocity is wanted.
        q_middle, v_middle = 0.5 * (q0 + beam.q), 0.5 * (v0 + beam.v)
        u_middle = boundary(wing.displacement(q_middle))
        moved = plan.positions(boundary(wing.displacement(beam.q)))
        exact, by_velocity, ratio = conservation(blocks, x, moved, plan.positions(u_middle),
                                                 plan.velocities(boundary(wing.velocity(q_middle, v_middle)), u_middle), dt)
        w, _, twist = beam.at(np.array([beam.z[-1]]), beam.q)
        rows.append({"step": n, "time [s]": t, "tip deflection [m]": float(w[0]), "tip twist [deg]": float(np.degrees(twist[0])),
                     "energy [J]": float(beam.energy()), "inverted cells": mesh.quality(moved, fast=True)["inverted"],
                     "smallest volume ratio in the step": ratio, "conservation, swept": exact, "conservation, velocity": by_velocity})
        shapes.append(wing.displacement(beam.q))
        x = moved
    edges = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    return rows, {"points": points, "edges": np.unique(np.sort(edges, axis=1), axis=0), "shapes": shapes, "dt": dt, "frequencies": beam.frequencies[:3], "span": tip - root}


def draw(rows, seen, out):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection

    time = [r["time [s]"] for r in rows]
    figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(7, 5))
    upper.plot(time, [r["tip deflection [m]"] for r in rows])
    upper.set_ylabel("deflection of the tip [m]")
    lower.plot(time, [r["tip twist [deg]"] for r in rows])
    lower.set(ylabel="twist of the tip [deg]", xlabel="time [s]")
    figure.savefig(out / "tip.png", dpi=120)

    figure, ax = plt.subplots(figsize=(9, 3.2))
    for number, n in enumerate(np.linspace(0, len(seen["shapes"]) - 1, 5).astype(int)):
        moved = (seen["points"] + seen["shapes"][n])[:, [2, 1]]
        ax.add_collection(LineCollection(moved[seen["edges"]], linewidths=0.3, colors=f"C{number}"))
        ax.plot([], [], color=f"C{number}", label=f"{n * seen['dt']:.2f} s")
    ax.autoscale_view()
    ax.set(xlabel="along the span [m]", ylabel="up [m]", aspect="equal", title="the wing from the front")
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(out / "front.png", dpi=120, bbox_inches="tight")

    figure, ax = plt.subplots(figsize=(7, 4))
    ax.semilogy(time, [r["conservation, swept"] for r in rows], label="swept volumes")
    ax.semilogy(time, [r["conservation, velocity"] for r in rows], label="velocity at mid-step")
    ax.set(xlabel="time [s]", ylabel="largest error of a cell's volume,\nof what its faces sweep")
    ax.legend()
    figure.savefig(out / "conservation.png", dpi=120, bbox_inches="tight")
    plt.close("all")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mesh", default=HERE.parent / "meshes" / "mdo_tutorial_000_vol.cgns")
    parser.add_argument("--steps", type=int, default=48)
    parser.add_argument("--out", type=pathlib.Path, default=HERE.parents[1] / "out" / "wing_beam")
    options = parser.parse_args()
    rows, seen = run(options.mesh, options.steps)
    options.out.mkdir(parents=True, exist_ok=True)
    with open(options.out / "table.csv", "w", newline="") as file:
        table = csv.DictWriter(file, rows[0].keys())
        table.writeheader()
        table.writerows(rows)
    try:
        draw(rows, seen, options.out)
    except ImportError as error:
        print(f"no pictures: {error}")
    print("frequencies [Hz]: " + ", ".join(f"{f:.2f}" for f in seen["frequencies"]))
    print("step   time [s]  deflection [m]  twist [deg]  inverted  conservation: swept, velocity")
    for r in rows[:: max(1, len(rows) // 12)]:
        print(f"{r['step']:4d} {r['time [s]']:10.3f} {r['tip deflection [m]']:15.4f} {r['tip twist [deg]']:12.3f} {r['inverted cells']:9d}  "
              f"{r['conservation, swept']:.1e}, {r['conservation, velocity']:.1e}")
    print(f"largest deflection {max(abs(r['tip deflection [m]']) for r in rows):.3f} m of {seen['span']:.2f} m span; conservation to "
          f"{max(r['conservation, swept'] for r in rows):.1e} by swept volumes, {max(r['conservation, velocity'] for r in rows):.1e} by "
          f"velocities at mid-step; {options.out}/table.csv")


if __name__ == "__main__":
    main()
