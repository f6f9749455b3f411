"""The coupling example at a small size."""
import numpy as np
import pytest


@pytest.fixture(scope="module")
def wing_beam(script):
    return script("examples/python/wing_beam.py")


def test_the_beam_has_the_frequencies_and_deflections_of_a_uniform_one(wing_beam):
    beam = wing_beam.Beam(10.0, 1.0, 1.0, 24)
    wide, high, wall = 0.4, 0.1, 0.004
    EI = beam.E * 2 * wall * (wide * (high / 2) ** 2 + high**3 / 12)
    q = np.zeros_like(beam.q)
    q[3:] = np.linalg.solve(beam.K[3:, 3:], beam.load(100.0, 0.0)[3:])
    assert q[-3] == pytest.approx(100.0 * 10**4 / (8 * EI), rel=1e-9)
    mass = 1.5 * beam.DENSITY * 2 * wall * (wide + high)

    class Uncoupled(wing_beam.Beam):
        MASS_OFFSET = 0.0

    assert Uncoupled(10.0, 1.0, 1.0, 24).frequencies[0] == pytest.approx(1.875104**2 / (2 * np.pi) * np.sqrt(EI / (mass * 10**4)), rel=1e-4)


def test_newmark_keeps_energy_without_damping(wing_beam):
    class Undamped(wing_beam.Beam):
        DAMPING = 0.0

    beam = Undamped(10.0, 2.0, 1.0, 8)
    beam.v[3:] = np.random.default_rng(0).standard_normal(len(beam.v) - 3)
    beam.a[3:] = np.linalg.solve(beam.M[3:, 3:], -(beam.K @ beam.q)[3:])
    start = beam.energy()
    for _ in range(50):
        beam.step(0.01, np.zeros_like(beam.q))
    assert beam.energy() == pytest.approx(start, rel=1e-9)


def test_swept_volumes_are_the_change_of_volume(wing_beam):
    random = np.random.default_rng(1)
    box = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1)
    X0, X1 = (box + 0.2 * random.standard_normal(box.shape) for _ in range(2))
    net, _ = wing_beam.out_of_cells([wing_beam.swept(X0, X1, a) for a in range(3)])
    np.testing.assert_allclose(wing_beam.volumes(X1) - wing_beam.volumes(X0), net, atol=1e-13)
    np.testing.assert_allclose(wing_beam.volumes(box), 1, atol=1e-14)


def test_a_gust_bends_the_wing_and_volumes_are_conserved(wing_beam, meshes):
    results = {steps: wing_beam.run(meshes / "717_wl_L2.cgns", steps=steps, periods=0.5) for steps in (4, 8)}
    for rows, seen in results.values():
        assert max(r["tip deflection [m]"] for r in rows) > 0.01 * seen["span"]
        assert all(r["inverted cells"] == 0 for r in rows)
        assert max(r["conservation, swept"] for r in rows) < 1e-10
    # What fluxes of the velocity leave is of the time step.
    errors = [max(r["conservation, velocity"] for r in results[steps][0]) for steps in (4, 8)]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] > 1e-9
