"""The package on meshes made here, without files, and on one that it writes itself."""
import threading
import warnings

import numpy as np
import pytest

import gridmorph

N = 9
FACES = {"i_min": "sides", "i_max": "sides", "j_min": "sides", "j_max": "sides"}


def box(z0):
    """(N, N, N, 3): a unit box from z0 up."""
    x = np.linspace(0.0, 1.0, N)
    return np.stack(np.meshgrid(x, x, z0 + x, indexing="ij"), axis=-1)


def two_boxes():
    patches = [{"name": name, "zone": zone, "face": face, "kind": "wall"}
               for zone in ("lower", "upper") for face, name in FACES.items()]
    patches += [{"name": "floor", "zone": "lower", "face": "k_min", "kind": "wall"},
                {"name": "roof", "zone": "upper", "face": "k_max", "kind": "wall"}]
    return gridmorph.Mesh.from_blocks({"lower": box(0.0), "upper": box(1.0)}, {"patch": patches})


def bump(points):
    u = np.zeros_like(points)
    u[:, 2] = 0.1 * np.sin(np.pi * points[:, 0]) ** 2 * np.sin(np.pi * points[:, 1]) ** 2
    return u


@pytest.fixture(scope="module")
def mesh():
    return two_boxes()


@pytest.fixture(scope="module")
def plan(mesh):
    return gridmorph.Plan(mesh, gridmorph.Motion().function("floor", bump))


def test_blocks_keep_the_indices_of_arrays(mesh):
    assert mesh.n_nodes == 2 * N**3 and mesh.is_structured
    for zone, z0 in enumerate((0.0, 1.0)):
        for component, values in enumerate(mesh.zone_coordinates(zone)):
            np.testing.assert_array_equal(values, box(z0)[..., component])


def test_coordinates_are_views_that_outlive_the_mesh():
    mesh = two_boxes()
    x = mesh.x
    mesh.zone_coordinates(0)[0][2, 3, 4] = 7.0
    assert x[2 + N * (3 + N * 4)] == 7.0
    del mesh
    assert x.sum() > 0


def test_known_nodes_take_their_displacement_and_others_follow(mesh, plan):
    u = plan.displacements()
    floor = mesh.nodes_of(["floor"])
    np.testing.assert_allclose(u[floor], bump(mesh.coordinates[floor]), atol=1e-15)
    assert not u[mesh.nodes_of(["roof"])].any()
    np.testing.assert_allclose(plan.positions(), mesh.coordinates + u, atol=1e-15)
    assert mesh.quality(plan.positions())["certificate"]["holds"]


def test_transpose_is_that_of_velocities(plan):
    random = np.random.default_rng(7)
    rate = random.standard_normal((len(plan.boundary_nodes), 3))
    gradient = random.standard_normal((plan.n_nodes, 3))
    forwards = np.vdot(gradient, plan.velocities(rate))
    backwards = np.vdot(plan.transpose(gradient), rate)
    assert abs(forwards - backwards) < 1e-12 * np.abs(gradient).sum()


LATTICE = {"patches": ["floor"], "rule": "ffd", "counts": [3, 3, 2], "rank": 1,
           "continuity": 0, "box": {"from": [-0.1, -0.1, -0.5], "to": [1.1, 1.1, 0.5]}}


def test_gradient_of_control_points_is_what_they_move(mesh):
    shape = (2, 3, 3, 3)  # k, j, i, component
    d = np.random.default_rng(3).normal(scale=0.02, size=shape)
    points = [{"at": [i + 1, j + 1, k + 1], "d": d[k, j, i].tolist()} for k in range(2) for j in range(3) for i in range(3)]
    plan = gridmorph.Plan(mesh, gridmorph.Motion({"motion": [dict(LATTICE, points=points)]}))
    u = np.asarray(plan.boundary_displacement)
    gradient = np.random.default_rng(4).normal(size=u.shape)
    slopes = plan.ffd_gradient(0, gradient)
    assert slopes.shape == (18, 3) and np.abs(u).max() > 0
    np.testing.assert_allclose(np.vdot(slopes.reshape(shape), d), np.vdot(gradient, u), rtol=1e-12)
    with pytest.raises(gridmorph.ConfigError, match="gradient"):
        plan.ffd_gradient(0, gradient[1:])


def test_a_rule_that_is_no_lattice_has_no_control_points(plan):
    with pytest.raises(gridmorph.ConfigError, match="ffd"):
        plan.ffd_gradient(0, np.zeros((len(plan.boundary_nodes), 3)))


def test_gradients_of_parameters_are_those_of_whole_morphs(mesh):
    def motion(p):
        return gridmorph.Motion({"motion": [{"patches": ["floor"], "rule": "formula", "dz": f"({p[0]}*x + {p[1]}*{p[1]}*y) * sin(pi*x)^2 * sin(pi*y)^2"}]})

    p = np.array([0.1, 0.2])
    plan = gridmorph.Plan(mesh, motion(p))
    weights = np.random.default_rng(5).normal(size=(mesh.n_nodes, 3))
    slopes = plan.parameter_gradient(motion, p, 1e-5, plan.transpose(weights))
    for k in range(2):
        h = np.eye(2)[k] * 1e-4
        J = [np.vdot(weights, plan.displacements(plan.boundary_displacement_of(motion(q)))) for q in (p - h, p + h)]
        assert slopes[k] == pytest.approx((J[1] - J[0]) / 2e-4, rel=1e-6)
    with pytest.raises(gridmorph.ConfigError, match="steps"):
        plan.parameter_gradient(motion, p, [1e-5, 0], np.zeros((len(plan.boundary_nodes), 3)))
    with pytest.raises(gridmorph.ConfigError, match="gradient"):
        plan.parameter_gradient(motion, p, 1e-5, weights)


def test_parameters_of_a_case_file(meshes, tmp_path):
    case = tmp_path / "case.toml"
    case.write_text("""
[mesh]
input = "wing.cgns"
[parameters]
lean = { value = 0.1, range = [-1, 1] }
lift = 0.5
[[motion]]
patches = "wall"
rule = "formula"
dx = "lean * z"
dy = "lift * lean * z^2"
[boundary_layer]
walls = "wall"
mode = "translate"
""")
    assert gridmorph.Motion.read(case).parameters == {"lean": 0.1, "lift": 0.5}
    mesh = gridmorph.Mesh.read(meshes / "mdo_tutorial_000_vol.cgns")

    def design(p):
        return gridmorph.Motion.read(case, {"lean": p[0], "lift": p[1]})

    plan = gridmorph.Plan(mesh, design([0.1, 0.5]))
    p = np.array([-0.2, 0.25])
    u = np.asarray(plan.boundary_displacement_of(design(p)))
    z = mesh.coordinates[plan.boundary_nodes][:, 2]
    on_wing = np.abs(u).max(axis=1) > 0
    assert on_wing.sum() > 100
    np.testing.assert_allclose(u[on_wing], np.c_[p[0] * z, p[1] * p[0] * z**2, 0 * z][on_wing], atol=1e-14)
    weights = np.random.default_rng(3).normal(size=u.shape)
    slopes = plan.parameter_gradient(design, p, 1e-5, weights)
    expected = (weights[:, 0] * z + weights[:, 1] * p[1] * z**2)[on_wing].sum(), (weights[:, 1] * p[0] * z**2)[on_wing].sum()
    np.testing.assert_allclose(slopes, expected, rtol=1e-7)
    box = plan.certify(design, [-0.1, 0.4], [0.1, 0.4], limit=0.5)
    assert box["cells"] == 24192 and 0 <= box["certified"] <= 0.5 and not box["holds"]
    with pytest.raises(gridmorph.ConfigError, match="not linear in all parameters together"):
        plan.certify(design, [-0.1, 0.3], [0.1, 0.5])
    with pytest.raises(gridmorph.ConfigError, match="lean is 2, outside its range"):
        design([2, 0])
    with pytest.raises(gridmorph.ConfigError, match="'leen' is given a value"):
        gridmorph.Motion.read(case, {"leen": 1})


def test_strides_single_precision_and_out(plan):
    u = plan.boundary_displacement
    expected = plan.displacements(u)
    np.testing.assert_array_equal(plan.displacements(np.asfortranarray(u)), expected)
    np.testing.assert_array_equal(plan.displacements(u.astype(np.float32)), plan.displacements(u.astype(np.float32).astype(float)))
    out = np.full((plan.n_nodes, 6), np.nan)[:, ::2]
    plan.displacements(u, out=out)
    np.testing.assert_array_equal(out, expected)


@pytest.mark.parametrize("wrong, found", [(np.zeros((4, 3)), r"found \(4, 3\)"), (np.zeros((5, 2)), r"found \(5, 2\)"),
                                          (np.zeros((4, 3), dtype=int), "found")])
def test_wrong_arrays_are_named(plan, wrong, found):
    with pytest.raises(gridmorph.ConfigError, match=found):
        plan.displacements(wrong)


def test_rules_of_a_dict_are_read_as_case_files_are(mesh):
    motion = gridmorph.Motion({"motion": [{"patches": ["floor"], "rule": "formula", "dz": "0.1 * sin(pi * x)^2 * sin(pi * y)^2"}]})
    np.testing.assert_allclose(gridmorph.Plan(mesh, motion).boundary_displacement.max(), 0.1)
    with pytest.raises(gridmorph.ConfigError, match="dq"):
        gridmorph.Motion({"motion": [{"patches": ["floor"], "rule": "formula", "dq": "1"}]})
    with pytest.raises(gridmorph.MotionError, match="flor"):
        gridmorph.Plan(mesh, gridmorph.Motion().prescribed("flor"))


def test_fields_of_points_are_exact_on_them(mesh, plan):
    points = mesh.coordinates[mesh.nodes_of(["floor"])]
    by_points = gridmorph.Plan(mesh, gridmorph.Motion().field("floor", points, bump(points)))
    np.testing.assert_array_equal(by_points.displacements(), plan.displacements())


def test_errors_of_functions_come_through(mesh):
    def fails(points):
        raise ValueError("not today")

    with pytest.raises(ValueError, match="not today"):
        gridmorph.Plan(mesh, gridmorph.Motion().function("floor", fails))


def test_files_come_back(tmp_path, mesh, plan):
    path = tmp_path / "boxes.cgns"
    mesh.write(path, plan.positions())
    again = gridmorph.Mesh.read(path)
    np.testing.assert_array_equal(again.coordinates, plan.positions())
    again.write(tmp_path / "copy.cgns", mesh.coordinates)
    np.testing.assert_array_equal(gridmorph.Mesh.read(tmp_path / "copy.cgns").coordinates, mesh.coordinates)
    with pytest.raises(gridmorph.IoError, match="nothing.cgns"):
        gridmorph.Mesh.read(tmp_path / "nothing.cgns")


def test_other_threads_get_the_same_or_are_refused_clearly(plan):
    expected, got = plan.displacements(), []

    def work():
        try:
            got.append(plan.displacements())
        except gridmorph.ConfigError as error:
            got.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(4)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    for result in got:
        if isinstance(result, str):
            assert "takes calls from the thread alone" in result
        else:
            np.testing.assert_array_equal(result, expected)


def test_a_mesh_is_not_written_over_what_is_there(tmp_path, mesh, plan):
    path = tmp_path / "boxes.cgns"
    mesh.write(path)
    read = gridmorph.Mesh.read(path)
    before = path.read_bytes()
    link = tmp_path / "link.cgns"
    link.symlink_to(path)
    for onto in (path, link):
        for overwrite in (False, True):
            with pytest.raises(gridmorph.ConfigError, match="never overwritten"):
                read.write(onto, plan.positions(), overwrite=overwrite)
    assert path.read_bytes() == before
    other = tmp_path / "other.cgns"
    other.write_text("mine")
    with pytest.raises(gridmorph.ConfigError, match="exists already"):
        read.write(other, plan.positions())
    assert other.read_text() == "mine"
    read.write(other, plan.positions(), overwrite=True)
    np.testing.assert_array_equal(gridmorph.Mesh.read(other).coordinates, plan.positions())


@pytest.mark.parametrize("name, word", [("moved.su2", "SU2"), ("moved.vtu", "VTK"), ("moved.stl", "STL")])
def test_endings_that_stand_for_another_format_are_refused(tmp_path, mesh, name, word):
    with pytest.raises(gridmorph.ConfigError, match=word):
        mesh.write(tmp_path / name)
    if word != "VTK":
        with pytest.raises(gridmorph.ConfigError, match=word):
            mesh.write_vtk(tmp_path / name)
    assert not (tmp_path / name).exists()


def test_cells_that_were_flat_may_turn_by_little(tmp_path):
    points = box(0.0)
    points[:, :, -1] = points[:, :, -2] + [0.5 / (N - 1), 0.0, 0.0]  # the last plane lies in the one before it
    faces = {**FACES, "k_min": "sides", "k_max": "tip"}
    mesh = gridmorph.Mesh.from_blocks({"wing": points}, {"patch": [{"name": name, "zone": "wing", "face": face, "kind": "wall"}
                                                                   for face, name in faces.items()]})

    def pitched(by):
        moved = points.copy()
        moved[:, :, -1, 2] -= by * (moved[:, :, -1, 0] - 0.5)
        return np.stack([moved[..., c].ravel(order="F") for c in range(3)], axis=-1)

    little = pitched(1e-5)
    assert mesh.quality(little)["inverted"] == 0
    mesh.write(tmp_path / "little.cgns", little)
    with pytest.raises(gridmorph.MeshError, match="inverted"):
        mesh.write(tmp_path / "much.cgns", pitched(1e-2))


def test_inverted_cells_are_written_where_that_is_asked_for_alone(tmp_path, mesh):
    torn = mesh.coordinates
    torn[N // 2 + N * (N // 2 + N * (N // 2))] += 0.5
    path = tmp_path / "torn.cgns"
    with pytest.raises(gridmorph.MeshError, match=r"inverted .*: \d+ of"):
        mesh.write(path, torn)
    assert not path.exists()
    mesh.write(path, torn, allow_inverted=True)
    np.testing.assert_array_equal(gridmorph.Mesh.read(path).coordinates, torn)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(tmp_path, mesh, plan, bad):
    def spoilt(array):
        out = np.array(array)
        out[3, 1] = bad
        return out

    u, x = spoilt(plan.boundary_displacement), spoilt(mesh.coordinates)
    for call in (lambda: plan.positions(u), lambda: plan.displacements(u), lambda: plan.velocities(u), lambda: plan.transpose(x),
                 lambda: mesh.quality(x), lambda: mesh.write(tmp_path / "x.cgns", x), lambda: mesh.write_vtk(tmp_path / "x.vtu", x),
                 lambda: gridmorph.Motion().field("floor", x, x)):
        with pytest.raises(gridmorph.ConfigError, match=r"row 3 is .*finite"):
            call()
    block = box(0.0)
    block[1, 2, 3, 0] = bad
    with pytest.raises(gridmorph.MeshError, match=r"\[1, 2, 3\]"):
        gridmorph.Mesh.from_blocks({"lower": block})


def test_patches_without_a_rule_beside_prescribed_ones_are_warned_of(mesh):
    with pytest.warns(UserWarning, match="no rule names 'sides'"):
        gridmorph.Plan(mesh, gridmorph.Motion().prescribed("floor"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gridmorph.Plan(mesh, gridmorph.Motion({"motion": [{"patches": ["sides"], "rule": "fixed"}]}).prescribed("floor"))
