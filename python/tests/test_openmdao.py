"""The component of OpenMDAO, and the optimisation that uses it."""
import numpy as np
import pytest

import gridmorph

om = pytest.importorskip("openmdao.api")
from gridmorph.openmdao import MorphComponent  # noqa: E402


def problem(**options):
    p = om.Problem(reports=None)
    p.model.add_subsystem("mesh", MorphComponent(**options), promotes=["*"])
    p.setup(force_alloc_complex=False)
    return p


def small_box():
    t = np.linspace(0, 1, 5)
    box = np.stack(np.meshgrid(t, t, t, indexing="ij"), axis=-1)
    faces = {"i_min": "sides", "i_max": "sides", "j_min": "sides", "j_max": "sides", "k_min": "floor", "k_max": "roof"}
    return gridmorph.Mesh.from_blocks({"box": box}, {"patch": [{"name": n, "zone": "box", "face": f, "kind": "wall"} for f, n in faces.items()]})


def wing(meshes):
    return {"mesh": meshes / "717_wl_L2.cgns", "motion": {"boundary_layer": [{"walls": ["wall"], "extent": {"layers": 4}}]}}


def lift(p, share=0.02):
    x = p.model.mesh.mesh.coordinates[p.model.mesh.surface_nodes]
    u = np.zeros_like(x)
    s = (x[:, 2] - x[:, 2].min()) / np.ptp(x[:, 2])
    u[:, 1] = share * np.ptp(x[:, 2]) * s**2
    return u


@pytest.mark.parametrize("kind", ["displacement", "coordinates"])
def test_partials_are_those_of_differences(kind):
    p = problem(mesh=small_box(), patches="floor", input=kind)
    name = "u" if kind == "displacement" else "x_surface"
    u = np.zeros((25, 3))
    u[:, 2] = 0.1 * np.sin(np.arange(25.0)) ** 2
    p.set_val(name, p.get_val(name) + u)
    p.run_model()
    found = p.check_partials(out_stream=None, method="fd", form="central", step=1e-4)["mesh"]["x_volume", name]
    np.testing.assert_allclose(found["J_fwd"], found["J_fd"], atol=1e-8)
    np.testing.assert_allclose(found["J_fwd"], found["J_rev"], atol=1e-13)
    assert np.abs(found["J_fwd"]).max() == pytest.approx(1)


def test_partials_along_directions_of_a_wing(meshes):
    p = problem(**wing(meshes))
    p.set_val("u", lift(p))
    p.run_model()
    component = p.model.mesh
    assert component.mesh.quality(p.get_val("x_volume"), fast=True)["inverted"] == 0
    np.testing.assert_allclose(p.get_val("x_volume")[component.surface_nodes], component.mesh.coordinates[component.surface_nodes] + lift(p),
                               atol=1e-12)
    # A small step: near walls whose cells are small, random displacements of the nodes turn the mesh.
    p.model.mesh.set_check_partial_options("u", directional=True, form="central", step=1e-6)
    found = p.check_partials(out_stream=None)["mesh"]["x_volume", "u"]
    size = np.abs(found["J_fd"]).max()
    np.testing.assert_allclose(found["J_fwd"], found["J_fd"], atol=1e-5 * size)
    assert found["abs error"][2] < 1e-11 * np.linalg.norm(found["J_fd"]) ** 2  # forwards against reverse


def test_totals_in_reverse_are_those_forwards(meshes):
    totals = {}
    for mode in ("fwd", "rev"):
        p = om.Problem(reports=None)
        p.model.add_subsystem("p", om.IndepVarComp("amplitude", 0.3), promotes=["*"])
        component = MorphComponent(**wing(meshes))
        component.options["units"] = "m"
        n = gridmorph.Mesh.read(meshes / "717_wl_L2.cgns").n_nodes
        weight = np.random.default_rng(0).standard_normal((n, 3))
        p.model.add_subsystem("mesh", component, promotes=["*"])

        class Shape(om.ExplicitComponent):
            def setup(self):
                self.add_input("amplitude", 0.3)
                self.add_output("u", shape_by_conn=True, units="m")
                self.declare_partials("u", "amplitude", method="fd", form="central", step=0.01)

            def compute(self, inputs, outputs):
                outputs["u"] = 0
                outputs["u"][:, 1] = inputs["amplitude"] * np.linspace(0, 0.5, len(outputs["u"]))[:, None].ravel() * 0.01

        class Functional(om.ExplicitComponent):
            def setup(self):
                self.add_input("x_volume", np.zeros((n, 3)), units="m")
                self.add_output("J")
                self.declare_partials("J", "x_volume", val=weight.reshape(1, -1))

            def compute(self, inputs, outputs):
                outputs["J"] = np.vdot(weight, inputs["x_volume"])

        p.model.add_subsystem("shape", Shape(), promotes=["*"])
        p.model.add_subsystem("functional", Functional(), promotes=["*"])
        p.model.set_order(["p", "shape", "mesh", "functional"])
        p.setup(mode=mode)
        p.run_model()
        totals[mode] = p.compute_totals(["J"], ["amplitude"])["J", "amplitude"].item()
    assert totals["fwd"] == pytest.approx(totals["rev"], rel=1e-10)
    assert totals["fwd"] != 0


def test_patches_that_nothing_names_are_refused():
    with pytest.raises(gridmorph.MotionError, match="flor"):
        problem(mesh=small_box(), patches="flor")


@pytest.fixture(scope="module")
def torsion(script):
    pytest.importorskip("scipy")
    return script("examples/python/torsion_optimum.py")


def test_partials_of_the_torsion_example(torsion):
    p = torsion.problem(3)
    p.set_val("p", [0.02, 0.03, -0.04, 0.01, 0.02])
    p.run_model()
    found = p.check_partials(out_stream=None, method="fd", form="central", step=1e-5)
    for component in found.values():
        for partial in component.values():
            np.testing.assert_allclose(partial["J_fwd"], partial["J_fd"], atol=1e-7 * np.abs(partial["J_fd"]).max())


def test_the_stiffest_bar_is_round(torsion):
    coarse, fine = torsion.optimum(6), torsion.optimum(12)
    for found, bound in ((coarse, 2e-2), (fine, 5e-3)):
        assert found["area"] == pytest.approx(np.pi, abs=1e-6)
        assert abs(found["stiffness"] / found["analytic"] - 1) < bound
        assert found["radius"][1] - found["radius"][0] < bound
        assert found["start"]["stiffness"] / found["start"]["area"] ** 2 < 0.95 / (2 * np.pi)
        assert found["inverted"] == 0
    # Linear elements: the error falls by four where the cells are half as large.
    ratio = (coarse["stiffness"] / coarse["analytic"] - 1) / (fine["stiffness"] / fine["analytic"] - 1)
    assert 3 < ratio < 5
