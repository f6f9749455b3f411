#!/usr/bin/env python3
"""The section of a bar that is stiffest in torsion: a gradient-based optimisation whose answer is known.

Of all simply connected sections of one area A the disc is the stiffest (Saint-Venant; proved by Polya): J = A^2 / (2 pi), with
J = 2 int psi, -laplace(psi) = 2 inside, psi = 0 on the rim. The bar begins as a rounded triangle, and the heights of waves on its rim
are sought:

    heights p -> displacement u of the rim -> all nodes x, by gridmorph -> J and the area, by linear finite elements

OpenMDAO drives SLSQP by gradients in reverse: dJ/dx, exact at fixed psi since psi makes J largest, goes through the mesh to the rim by one
transpose, whatever the number of heights.

    examples/python/torsion_optimum.py [--rings 12]

Prints what comes out beside the answer. Needs gridmorph, NumPy, SciPy and OpenMDAO.
"""
import argparse

import numpy as np
import openmdao.api as om

import gridmorph
from gridmorph.openmdao import MorphComponent

START = {2: 0.12, 3: 0.2}  # waves around the rim of the section that the bar begins with, which is not stiffest
WAVES = (0, 2, 3, 4, 5)    # sought; wave 1 would move the section as a whole


def section(n_rings, n_around):
    """Triangles in a rounded section of mean radius 1: rings around a node in the middle."""
    theta = 2 * np.pi * np.arange(n_around) / n_around
    rim = 1 + sum(height * np.cos(wave * theta) for wave, height in START.items())
    rings = [(k / n_rings) * rim for k in range(1, n_rings + 1)]
    points = np.concatenate([[[0, 0]]] + [np.stack([r * np.cos(theta), r * np.sin(theta)], axis=1) for r in rings])
    here, following = np.arange(n_around), (np.arange(n_around) + 1) % n_around
    triangles = [np.stack([np.zeros_like(here), 1 + here, 1 + following], axis=1)]
    for k in range(n_rings - 1):
        inner, outer = 1 + k * n_around, 1 + (k + 1) * n_around
        triangles += [np.stack([inner + here, outer + here, outer + following], axis=1),
                      np.stack([inner + here, outer + following, inner + following], axis=1)]
    last = 1 + (n_rings - 1) * n_around
    edges = np.stack([last + here, last + following], axis=1)
    return gridmorph.Mesh.from_elements(points, [("TRI_3", np.concatenate(triangles))], {"rim": {"faces": edges, "kind": "wall"}})


class Rim(om.ExplicitComponent):
    """u = sum of p_m cos(m theta), along the radius."""

    def initialize(self):
        self.options.declare("points")

    def setup(self):
        x, y = self.options["points"][:, :2].T
        r, theta = np.hypot(x, y), np.arctan2(y, x)
        waves = np.stack([np.cos(m * theta) for m in WAVES], axis=1)
        outwards = np.stack([x / r, y / r, 0 * r], axis=1)
        self.B = (outwards[:, :, None] * waves[:, None, :]).reshape(-1, len(WAVES))
        self.add_input("p", np.zeros(len(WAVES)))
        self.add_output("u", np.zeros((len(r), 3)))
        self.declare_partials("u", "p", val=self.B)

    def compute(self, inputs, outputs):
        outputs["u"] = (self.B @ inputs["p"]).reshape(-1, 3)


class Torsion(om.ExplicitComponent):
    """Area and torsional stiffness of a section of triangles, and their gradients at every node."""

    def initialize(self):
        self.options.declare("triangles")
        self.options.declare("rim", desc="numbers of the nodes where psi is zero")
        self.options.declare("n_nodes")

    def setup(self):
        n = self.options["n_nodes"]
        self.inside = np.setdiff1d(np.arange(n), self.options["rim"])
        self.add_input("x_volume", np.zeros((n, 3)))
        self.add_output("area")
        self.add_output("stiffness")
        self.declare_partials("*", "x_volume")

    def _solve(self, x):
        """Per triangle: edges opposite to its corners (3, k, 2), area (k,), psi at its corners (3, k)."""
        t = self.options["triangles"]
        corner = x[t.T, :2]
        edge = np.stack([corner[(i + 2) % 3] - corner[(i + 1) % 3] for i in range(3)])
        area = 0.5 * (edge[0, :, 0] * edge[1, :, 1] - edge[0, :, 1] * edge[1, :, 0])
        K, f = np.zeros((len(x), len(x))), np.zeros(len(x))
        for i in range(3):
            np.add.at(f, t[:, i], 2 * area / 3)
            for j in range(3):
                np.add.at(K, (t[:, i], t[:, j]), np.einsum("kc,kc->k", edge[i], edge[j]) / (4 * area))
        psi = np.zeros(len(x))
        psi[self.inside] = np.linalg.solve(K[np.ix_(self.inside, self.inside)], f[self.inside])
        return edge, area, psi[t.T]

    def compute(self, inputs, outputs):
        _, area, psi = self._solve(inputs["x_volume"])
        outputs["area"] = area.sum()
        outputs["stiffness"] = 2 * (area * psi.mean(axis=0)).sum()

    def compute_partials(self, inputs, partials):
        x, t = inputs["x_volume"], self.options["triangles"]
        edge, area, psi = self._solve(x)
        # J is the largest value of 4 int psi - int |grad psi|^2, so that psi may be held; grad psi is |s| / (2 area).
        s = np.einsum("ik,ikc->kc", psi, edge)
        of_area, of_stiffness = np.zeros_like(x), np.zeros_like(x)
        for m in range(3):
            d_area = 0.5 * np.stack([-edge[m, :, 1], edge[m, :, 0]], axis=1)
            d_energy = (psi[(m + 1) % 3] - psi[(m + 2) % 3])[:, None] * s / (2 * area)[:, None] \
                - ((s**2).sum(axis=1) / (4 * area**2))[:, None] * d_area
            np.add.at(of_area[:, :2], t[:, m], d_area)
            np.add.at(of_stiffness[:, :2], t[:, m], 4 * psi.mean(axis=0)[:, None] * d_area - d_energy)
        partials["area", "x_volume"] = of_area.reshape(1, -1)
        partials["stiffness", "x_volume"] = of_stiffness.reshape(1, -1)


def problem(n_rings=12):
    """The problem, set up; its mesh is problem.model.mesh.mesh."""
    mesh = section(n_rings, 4 * n_rings)
    triangles = mesh.elements["nodes"].reshape(-1, 3)
    p = om.Problem(reports=None)
    morph = MorphComponent(mesh=mesh, patches=["rim"])
    rim_nodes = mesh.nodes_of(["rim"])
    # The rows of u are in the order of the component, which is the plan's.
    order = gridmorph.Plan(mesh, gridmorph.Motion().prescribed("rim")).boundary_nodes
    p.model.add_subsystem("rim", Rim(points=mesh.coordinates[order]), promotes=["*"])
    p.model.add_subsystem("mesh", morph, promotes=["*"])
    p.model.add_subsystem("torsion", Torsion(triangles=triangles, rim=rim_nodes, n_nodes=mesh.n_nodes), promotes=["*"])
    p.model.add_design_var("p", lower=-0.5, upper=0.5)
    p.model.add_objective("stiffness", scaler=-1.0)
    p.model.add_constraint("area", equals=np.pi)
    p.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-10, maxiter=60)
    p.driver.options["disp"] = False
    p.setup(mode="rev")
    return p


def optimum(n_rings=12):
    """Runs it; a dict of what comes out and what the answer is."""
    p = problem(n_rings)
    p.run_model()
    start = {"area": p.get_val("area").item(), "stiffness": p.get_val("stiffness").item()}
    p.run_driver()
    rim = p.get_val("x_volume")[p.model.mesh.surface_nodes]
    radius = np.hypot(rim[:, 0], rim[:, 1])
    area = p.get_val("area").item()
    return {"start": start, "area": area, "stiffness": p.get_val("stiffness").item(), "analytic": area**2 / (2 * np.pi),
            "radius": (float(radius.min()), float(radius.max())), "heights": p.get_val("p").copy(), "runs": p.driver.iter_count,
            "inverted": p.model.mesh.mesh.quality(p.get_val("x_volume"), fast=True)["inverted"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rings", type=int, default=12)
    found = optimum(parser.parse_args().rings)
    a, b = found["start"]["area"], found["start"]["stiffness"]
    print(f"start:    area {a:.5f}, stiffness {b:.5f}, {b / (a**2 / (2 * np.pi)):.4f} of a disc's")
    print(f"optimum:  area {found['area']:.5f}, stiffness {found['stiffness']:.5f} after {found['runs']} runs")
    print(f"analytic: area {np.pi:.5f}, stiffness {found['analytic']:.5f}; error {found['stiffness'] / found['analytic'] - 1:+.2e}")
    print(f"radius from {found['radius'][0]:.5f} to {found['radius'][1]:.5f} (a disc: 1); waves "
          + ", ".join(f"{m}: {h:+.4f}" for m, h in zip(WAVES, found["heights"])) + f"; took away {START}")


if __name__ == "__main__":
    main()
