#!/usr/bin/python3
"""Tests of `gridmorph view`: its pictures, decoded here, against meshes that are known.

  test_view.py EXECUTABLE SOURCE_FOLDER
"""
import html.parser
import itertools
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

EXECUTABLE, SOURCE = (os.path.realpath(argument) for argument in sys.argv[1:3])
WALLS = ["boundary_layer.png", "leading_edge.png", "trailing_edge.png"]
BAND = 12  # pixels between two meshes


def run(*words, **options):
    return subprocess.run([EXECUTABLE, *words], capture_output=True, text=True, check=False, **options)


class Picture:
    """Pixels of a PNG of 8 bits, (red, green, blue)."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        assert data[:8] == b"\x89PNG\r\n\x1a\n"
        at, packed, palette = 8, b"", None
        while at < len(data):
            size, name = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            if name == b"IHDR":
                self.width, self.height, depth, kind = struct.unpack(">IIBB", body[:10])
                assert depth == 8
            elif name == b"PLTE":
                palette = [tuple(body[n:n + 3]) for n in range(0, size, 3)]
            elif name == b"IDAT":
                packed += body
            at += 12 + size
        step = {2: 3, 3: 1, 6: 4}[kind]
        raw, length = zlib.decompress(packed), self.width * step
        before = bytearray(length)
        self.rows = []
        for y in range(self.height):
            rule, line = raw[y * (length + 1)], bytearray(raw[y * (length + 1) + 1:(y + 1) * (length + 1)])
            for x in range(length):
                a, b, c = line[x - step] if x >= step else 0, before[x], before[x - step] if x >= step else 0
                p = a + b - c
                paeth = min((a, b, c), key=lambda v, p=p: abs(p - v))
                line[x] = (line[x] + (0, a, b, (a + b) // 2, paeth)[rule]) & 255
            before = line
            self.rows.append([palette[v] for v in line] if palette else [tuple(line[n:n + 3]) for n in range(0, length, step)])

    def at(self, x, y):
        return self.rows[y][x]

    def panel(self, n):
        """One of two meshes side by side, as rows."""
        size = (self.width - BAND) // 2
        left = n * (size + BAND)
        return [row[left:left + size] for row in self.rows]


def place(x, y, size, margin=0.03):
    """Pixel of a point of the unit square in a section of it, `size` pixels wide."""
    return int((x + margin) / (1 + 2 * margin) * size), int((1 + margin - y) / (1 + 2 * margin) * size)


def is_red(pixel):
    return pixel[0] > 110 and pixel[1] < 60 and pixel[2] < 60


def plane_su2(path, n=4, move=lambda x, y: (x, y)):
    """The unit square as squares, in SU2's format; `move` takes nodes elsewhere."""
    points = [move(i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
    cells = [(i + (n + 1) * j, i + 1 + (n + 1) * j, i + 1 + (n + 1) * (j + 1), i + (n + 1) * (j + 1)) for j in range(n) for i in range(n)]
    sides = [(i, i + 1) for i in range(n)]
    rest = ([(i + 1 + (n + 1) * n, i + (n + 1) * n) for i in range(n)] + [((n + 1) * (j + 1), (n + 1) * j) for j in range(n)]
            + [(n + (n + 1) * j, n + (n + 1) * (j + 1)) for j in range(n)])
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"NDIME= 2\nNELEM= {len(cells)}\n" + "".join(f"9 {' '.join(map(str, c))} {n}\n" for n, c in enumerate(cells)))
        file.write(f"NPOIN= {len(points)}\n" + "".join(f"{x!r} {y!r} {n}\n" for n, (x, y) in enumerate(points)))
        file.write("NMARK= 2\n")
        for name, edges in (("wall", sides), ("farfield", rest)):
            file.write(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(edges)}\n" + "".join(f"3 {a} {b}\n" for a, b in edges))


class Box:
    """The unit cube of n x n x n hexahedra, whose nodes lean so that every cell has a section of its own."""

    n = 3

    def __init__(self):
        m = self.n + 1
        self.points = [((i + 0.2 * (j % 2)) / self.n if 0 < i < self.n else i / self.n, j / self.n, k / self.n)
                       for k in range(m) for j in range(m) for i in range(m)]
        node = lambda i, j, k: i + m * (j + m * k)
        self.cells = [tuple(node(i + a, j + b, k + c) for a, b, c in
                            ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)))
                      for k in range(self.n) for j in range(self.n) for i in range(self.n)]
        owners = {}
        for number, c in enumerate(self.cells):
            for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
                nodes = tuple(c[n] for n in face)
                owners.setdefault(frozenset(nodes), []).append((number, nodes))
        self.inner = sorted((f[0][0], f[1][0], f[0][1]) for f in owners.values() if len(f) == 2)
        self.outer = sorted(f[0] for f in owners.values() if len(f) == 1)

    def su2(self, path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"NDIME= 3\nNELEM= {len(self.cells)}\n" + "".join(f"12 {' '.join(map(str, c))}\n" for c in self.cells))
            file.write(f"NPOIN= {len(self.points)}\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in self.points))
            file.write(f"NMARK= 1\nMARKER_TAG= sides\nMARKER_ELEMS= {len(self.outer)}\n"
                       + "".join(f"9 {' '.join(map(str, f))}\n" for _, f in self.outer))

    def gmsh(self, path):
        elements = [(3, 1, f) for _, f in self.outer] + [(5, 2, c) for c in self.cells]
        with open(path, "w", encoding="utf-8") as file:
            file.write('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 "sides"\n3 2 "fluid"\n$EndPhysicalNames\n')
            file.write(f"$Nodes\n{len(self.points)}\n" + "".join(f"{n + 1} {x!r} {y!r} {z!r}\n" for n, (x, y, z) in enumerate(self.points)))
            file.write(f"$EndNodes\n$Elements\n{len(elements)}\n" + "".join(
                f"{n + 1} {kind} 2 {tag} {tag} {' '.join(str(v + 1) for v in nodes)}\n" for n, (kind, tag, nodes) in enumerate(elements)))
            file.write("$EndElements\n")

    def openfoam(self, path):
        folder = os.path.join(path, "constant", "polyMesh")
        os.makedirs(folder)
        os.makedirs(os.path.join(path, "system"))
        with open(os.path.join(path, "system", "controlDict"), "w", encoding="utf-8") as file:
            file.write("FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }\n")
        faces = [f for _, _, f in self.inner] + [f for _, f in self.outer]
        lists = {"points": ("vectorField", [f"({x!r} {y!r} {z!r})" for x, y, z in self.points]),
                 "faces": ("faceList", [f"4({' '.join(map(str, f))})" for f in faces]),
                 "owner": ("labelList", [a for a, _, _ in self.inner] + [a for a, _ in self.outer]),
                 "neighbour": ("labelList", [b for _, b, _ in self.inner]),
                 "boundary": ("polyBoundaryMesh", [f"sides {{ type patch; nFaces {len(self.outer)}; startFace {len(self.inner)}; }}"])}
        for name, (kind, items) in lists.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n{len(items)}\n(\n")
                file.write("".join(f"{item}\n" for item in items) + ")\n")

    def plot3d(self, path):
        m = self.n + 1
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"1\n{m} {m} {m}\n" + "".join(f"{p[c]!r}\n" for c in range(3) for p in self.points))


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.images, self.text = [], ""
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        if tag == "img":
            self.images.append(dict(attrs))

    def handle_data(self, data):
        self.text += data


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.meshes = tempfile.TemporaryDirectory()
        made = run("demo", "passage", "-n", "10000", "-m", "chord", "-d", cls.meshes.name)
        assert made.returncode == 0, made.stderr
        cls.base, cls.morphed = (os.path.join(cls.meshes.name, name) for name in ("passage.cgns", "passage_chord.cgns"))
        cls.elements = os.path.join(cls.meshes.name, "elements.cgns")
        assert run("hexahedra", cls.base, "-o", cls.elements).returncode == 0

    @classmethod
    def tearDownClass(cls):
        cls.meshes.cleanup()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = os.path.join(self.folder.name, "pictures")

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def view(self, *words):
        return run("view", *words, "--out", self.out, "--dpi", "40")

    def drawn(self, *words, name="section.png"):
        done = self.view(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return Picture(os.path.join(self.out, name))

    def refused(self, *words, says):
        done = self.view(*words)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertFalse(os.path.exists(self.out))

    def test_draws_blocks_and_names_what_it_drew(self):
        done = self.view(self.base, self.morphed, "--span", "0.9", "--box", "-0.01", "0.02", "-0.01", "0.01")
        self.assertEqual(done.returncode, 0, done.stderr)
        drawn = sorted([*WALLS, "box.png", "model.png", "near.png", "section.png", "view.html"])
        self.assertEqual(sorted(os.listdir(self.out)), drawn)
        self.assertEqual(sorted(done.stdout.splitlines()), [os.path.join(self.out, name) for name in drawn])

    def test_the_page_has_every_picture_and_says_where_it_is_cut(self):
        self.drawn(self.base, self.morphed)
        page = Page(os.path.join(self.out, "view.html"))
        self.assertEqual(len(page.images), len(os.listdir(self.out)) - 1)
        for image in page.images:
            self.assertTrue(image["src"].startswith("data:image/png;base64,"))
        for text in ("Span 50 %", "passage_chord.cgns", "section.png", "radius x angle up from", "leading edge of 'blade'", "determinant"):
            self.assertIn(text, page.text)

    def test_as_json_it_lists_the_pictures_and_quiet_it_says_nothing(self):
        document = json.loads(self.view(self.base, self.morphed, "--json").stdout)
        self.assertEqual((document["baseline"], document["morphed"]), (self.base, self.morphed))
        self.assertEqual(sorted(map(os.path.basename, document["pictures"])), sorted([*WALLS, "model.png", "near.png", "section.png"]))
        self.assertTrue(all(map(os.path.isfile, [*document["pictures"], document["page"]])))
        done = self.view(self.base, "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_inverted_cells_are_red_where_they_are_and_others_are_not(self):
        def fold(x, y):
            return (0.9, y) if (x, y) == (0.5, 0.5) else (x, y)

        plane_su2(self.path("a.su2"))
        plane_su2(self.path("b.su2"), move=fold)
        both = self.drawn(self.path("a.su2"), self.path("b.su2"), "--color", "determinant")
        size = (both.width - BAND) // 2
        self.assertEqual((size, both.height), (256, 256))
        red = [[(x, y) for y, row in enumerate(both.panel(n)) for x, pixel in enumerate(row) if is_red(pixel)] for n in range(2)]
        self.assertEqual(red[0], [])
        self.assertGreater(len(red[1]), 300)
        # The two cells right of the node that has moved across them, and nothing left of it or above and below its neighbours.
        low, high = place(0.5, 0.75, size), place(0.9, 0.25, size)
        for x, y in red[1]:
            self.assertTrue(low[0] - 2 <= x <= high[0] + 2 and low[1] - 2 <= y <= high[1] + 2, (x, y))

    def test_cells_lie_where_their_nodes_are(self):
        plane_su2(self.path("a.su2"), n=2, move=lambda x, y: (x * x, y))  # 0, 0.25 and 1
        picture = self.drawn(self.path("a.su2"), "--color", "none")
        line = place(0.25, 0.3, 256)
        self.assertLess(min(sum(picture.at(line[0] + d, line[1])) for d in (-1, 0, 1)), 700)
        for x, y in ((0.12, 0.3), (0.6, 0.3), (0.12, 0.8), (0.6, 0.8)):
            self.assertEqual(picture.at(*place(x, y, 256)), (255, 255, 255))

    def test_the_wall_that_moves_is_blue_and_near_shows_it(self):
        plane_su2(self.path("a.su2"))
        plane_su2(self.path("b.su2"), move=lambda x, y: (x, y + 0.1 * (1 - y)))
        both = self.drawn(self.path("a.su2"), self.path("b.su2"), "--color", "none", name="section.png")
        size = (both.width - BAND) // 2
        for n, y in ((0, 0.0), (1, 0.1)):
            x, row = place(0.4, y, size)
            blue = [p for d in range(-2, 3) for p in [both.panel(n)[row + d][x]] if p[2] > p[0] + 60]
            self.assertTrue(blue, n)
        self.assertIn("near.png", os.listdir(self.out))
        shutil.rmtree(self.out)
        self.drawn(self.path("a.su2"), self.path("a.su2"))
        self.assertNotIn("near.png", os.listdir(self.out))
        self.assertIn("no wall moves", Page(os.path.join(self.out, "view.html")).text)

    def test_cells_that_move_are_outlined(self):
        plane_su2(self.path("a.su2"))
        plane_su2(self.path("b.su2"), move=lambda x, y: (x + 0.1 * x * y, y))
        words = (self.path("a.su2"), self.path("b.su2"), "--color", "none")
        rows = []
        for more in ((), ("--moved", "0.05")):
            shutil.rmtree(self.out, ignore_errors=True)
            rows.append(self.drawn(*words, *more).panel(0))
        size = len(rows[0][0])
        changed = [(x, y) for y, (a, b) in enumerate(zip(*rows)) for x in range(size) if a[x] != b[x]]
        self.assertGreater(len(changed), 100)
        # In the one cell whose four nodes move by 0.05 or more; both meshes together are 1.1 by 1.
        left, bottom = ((0.75 + 0.033) / 1.166 * size, (1.033 - 0.75) / 1.166 * size)
        self.assertTrue(all(x >= left - 3 and y <= bottom + 3 for x, y in changed))

    def test_displacement_colours_what_moves(self):
        plane_su2(self.path("a.su2"))
        plane_su2(self.path("b.su2"), move=lambda x, y: (x + 0.1 * x * y, y))
        both = self.drawn(self.path("a.su2"), self.path("b.su2"), "--color", "displacement", "--moved", "0.06")
        at = place(0.87, 0.87, (both.width - BAND) // 2)
        self.assertTrue(is_red(both.panel(0)[at[1]][at[0]]))
        at = place(0.1, 0.1, (both.width - BAND) // 2)
        self.assertFalse(is_red(both.panel(0)[at[1]][at[0]]))

    def test_blocks_and_elements_give_the_same_section(self):
        for words in (("--plane", "x=0.002"), ("--span", "0.5")):
            pictures = []
            for mesh in (self.base, self.elements):
                shutil.rmtree(self.out, ignore_errors=True)
                pictures.append(self.drawn(mesh, *words, "--color", "determinant").rows)
            different = sum(a != b for a, b in zip(*(itertools.chain(*rows) for rows in pictures)))
            self.assertLess(different, 0.002 * len(pictures[0]) * len(pictures[0][0]))

    def test_every_format_gives_the_same_section(self):
        box = Box()
        for name in ("su2", "gmsh", "openfoam", "plot3d"):
            getattr(box, name)(self.path({"su2": "box.su2", "gmsh": "box.msh", "openfoam": "case", "plot3d": "box.xyz"}[name]))
        rows = {}
        for name in ("box.su2", "box.msh", "case", "box.xyz"):
            shutil.rmtree(self.out, ignore_errors=True)
            picture = self.drawn(self.path(name), "--plane", "z=0.4", "--color", "none")
            rows[name] = [row[12:-12] for row in picture.rows[12:-12]]
            self.assertGreater(sum(sum(p) < 720 for row in rows[name] for p in row), 400, name)
        for name in rows:
            self.assertEqual(rows[name], rows["box.su2"], name)

    def test_an_index_plane_is_that_of_the_blocks(self):
        Box().plot3d(self.path("box.xyz"))
        by_index = self.drawn(self.path("box.xyz"), "--k", "2", "--color", "none").rows
        shutil.rmtree(self.out)
        self.assertEqual(by_index, self.drawn(self.path("box.xyz"), "--plane", "z=0.4", "--color", "none").rows)

    def test_another_mesh_is_drawn_beside_the_first_one(self):
        plane_su2(self.path("a.su2"))
        plane_su2(self.path("b.su2"), n=8)
        both = self.drawn(self.path("a.su2"), self.path("b.su2"), "--color", "none")
        dark = [sum(sum(p) < 720 for row in both.panel(n) for p in row) for n in range(2)]
        self.assertGreater(dark[1], 1.5 * dark[0])
        shutil.rmtree(self.out)
        done = self.view(self.path("a.su2"), self.path("b.su2"), "--color", "displacement")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("error: --color displacement", done.stderr)
        self.assertIn("warning: '" + self.path("b.su2") + "' is not the mesh of", done.stderr)

    def test_a_variable_of_the_solution_colours_the_cells_of_files_that_have_it(self):
        self.stages()
        picture = self.drawn(self.base, os.path.join(self.meshes.name, "stages", "stage_00_boundary.cgns"), "--plane", "x=0.002",
                             "--color", "Stage")
        tints = [{p for row in picture.panel(n)[60:-60] for p in row[60:-60] if p[0] > p[2] + 60} for n in range(2)]
        self.assertEqual(tints[0], set())
        self.assertGreater(len(tints[1]), 1)
        self.assertIn("white: ", Page(os.path.join(self.out, "view.html")).text)
        shutil.rmtree(self.out)
        self.refused(self.base, "--color", "Presure", says=("--color Presure", "determinant, displacement"))

    def stages(self):
        if os.path.isdir(os.path.join(self.meshes.name, "stages")):
            return
        with open(os.path.join(self.meshes.name, "chord.toml"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn("[mesh]", text)
        case = os.path.join(self.meshes.name, "staged.toml")
        with open(case, "w", encoding="utf-8") as file:
            file.write(text + '\n[output]\nstages = "stages"\n' if "[output]" not in text else text.replace("[output]\n", '[output]\nstages = "stages"\n'))
        done = run("morph", case, "-o", self.path("staged.cgns"))
        self.assertIn(done.returncode, (0, 1), done.stderr)

    def test_stages_of_blocks(self):
        self.stages()
        stages = os.path.join(self.meshes.name, "stages")
        done = self.view(self.base, self.morphed, "--stages", stages)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(stages, "stages.json"), encoding="utf-8") as file:
            expected = {os.path.splitext(stage["file"])[0] + ".png" for stage in json.load(file)["stages"]}
        self.assertLessEqual(expected, set(os.listdir(self.out)))
        colours = [len({p for row in Picture(os.path.join(self.out, name)).rows for p in row}) for name in sorted(expected)]
        self.assertGreater(colours[-1], colours[0])

    def test_stages_of_elements(self):
        ball = self.path("ball")
        made = run("demo", "ball", "--elements", "50000", "-d", ball)
        self.assertIn(made.returncode, (0, 1), made.stderr)
        done = self.view(*(os.path.join(ball, name) for name in ("ball.cgns", "ball_swing.cgns")), "--stages", os.path.join(ball, "stages"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("y = ", Page(os.path.join(self.out, "view.html")).text)  # the plane in which the ball swings
        for name in ("regions", "layers", "wrap", "background", "background_motion", "near"):
            rows = Picture(os.path.join(self.out, name + ".png")).rows
            self.assertGreater(len({p for row in rows for p in row}), 3, name)
        near, far = (0xe4, 0x88), (0xbf, 0xe3)
        colours = [p for row in Picture(os.path.join(self.out, "regions.png")).rows for p in row]
        for red, green in (near, far):
            self.assertGreater(sum(abs(p[0] - red) < 8 and abs(p[1] - green) < 8 for p in colours), 20)

    def test_meshes_without_walls_and_planes_beside_volumes(self):
        Box().su2(self.path("box.su2"))
        plane_su2(self.path("a.su2"))
        done = self.view(self.path("box.su2"))
        self.assertEqual((done.returncode, sorted(os.listdir(self.out))), (0, ["section.png", "view.html"]), done.stderr)
        done = self.view(self.path("a.su2"), self.path("box.su2"))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("no plane mesh", done.stderr)

    def test_options_that_cannot_be_are_one_error_and_leave_nothing(self):
        plane_su2(self.path("a.su2"))
        for words, says in (((self.base, "--plane", "q=1"), ("--plane q=1", "x=0.5")),
                            ((self.base, "--plane", "x=99"), ("x = 99", "meets no cell")),
                            ((self.base, "--wall", "wing"), ("--wall wing", "blade")),
                            ((self.base, "--i", "999"), ("--i 999", "no block")),
                            ((self.elements, "--k", "2"), ("--k 2", "elements", "--plane")),
                            ((self.base, "--span", "0.5", "--plane", "x=0"), ("--span",)),
                            ((self.base, "--span", "2"), ("--span",)),
                            ((self.base, "--box", "1", "0", "0", "1"), ("--box 1 0 0 1", "X0 below X1")),
                            ((self.base, "--box", "0", "inf", "0", "1"), ("--box 0 inf 0 1",)),
                            ((self.base, "--moved", "0.1"), ("--moved",)),
                            ((self.base, "--color", "displacement"), ("--color displacement",)),
                            ((self.base, "--stages", self.folder.name), ("--stages", self.folder.name)),
                            ((self.base, "--axis", "w"), ("--axis",)),
                            ((self.path("a.su2"), "--plane", "x=0.5"), ("2-D",)),
                            ((self.path("a.su2"), "--span", "0.5"), ("--span", "2-D"))):
            with self.subTest(words=words):
                self.refused(*words, says=says)

    def test_a_list_of_stages_that_is_none_is_bad_input(self):
        for text in ("", "[]", '{"stages": 3}', '{"stages": [3]}', '{"stages": [{"number": "x", "name": 7}]}', '{"stages": [{"file": "../a"}]}'):
            with open(self.path("stages.json"), "w", encoding="utf-8") as file:
                file.write(text)
            with self.subTest(text=text):
                self.refused(self.base, "--stages", self.folder.name, says=())

    def test_files_that_nothing_can_be_drawn_of_are_bad_input(self):
        with open(self.path("noise.vtu"), "w", encoding="utf-8") as file:
            file.write('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid"></VTKFile>\n')
        for mesh in ("gone.cgns", "noise.vtu"):
            self.refused(self.path(mesh), says=(mesh,))
        self.assertEqual(run("view", self.base).returncode, 2)
        self.assertEqual(run("view", "--out", self.out).returncode, 2)

    def test_inputs_are_not_written_over(self):
        os.makedirs(self.out)
        mesh = os.path.join(self.out, "section.png")
        plane_su2(self.path("a.su2"))
        shutil.copy(self.path("a.su2"), mesh)
        os.link(self.path("a.su2"), os.path.join(self.out, "view.html"))
        with open(mesh, "rb") as file:
            before = file.read()
        for given in (mesh, self.path("a.su2")):
            done = self.view(given)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        with open(mesh, "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(sorted(os.listdir(self.out)), ["section.png", "view.html"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
