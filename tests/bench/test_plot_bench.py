#!/usr/bin/python3
"""Tests of scripts/plot-bench on reports written here, whose figures are known."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

PLOT_BENCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "plot-bench")


def benchmark(name, nodes, milliseconds, **counters):
    """What Google Benchmark writes for a run. Names carry a nominal size; the counter has the nodes there are."""
    return {"name": f"{name}/nodes:{nodes}/manual_time", "run_name": f"{name}/nodes:{nodes}/manual_time", "run_type": "iteration",
            "iterations": 7, "real_time": milliseconds, "cpu_time": milliseconds, "time_unit": "ms", "nodes": nodes,
            "nodes/s": nodes / milliseconds * 1e3, "bytes/s": 48 * nodes / milliseconds * 1e3, "bytes/node": 48.0, **counters}


def kernel(name, nodes, milliseconds, share):
    return benchmark("kernels/" + name, nodes, milliseconds, share=share, **{"triad share": 0.9 * share, "updates": 1 / share})


def image_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", head[16:24])


class PlotBench(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def report(self, name, runs, threads=2):
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump({"context": {"date": "2026-01-02T03:04:05+00:00", "host threads": str(threads), "processor": "Abacus 3000",
                                   "commit": "abc1234", "load_avg": [0.5, 0, 0]}, "benchmarks": runs}, file)
        return self.path(name)

    def plot(self, *files):
        run = subprocess.run([sys.executable, PLOT_BENCH, *files, "--out", self.path("out")], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.path("out/tables.md"), encoding="utf-8") as file:
            return sorted(os.listdir(self.path("out"))), file.read()

    def rows(self, text, first_cell):
        cells = ([c.strip() for c in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|"))
        return [row for row in cells if row[0] == first_cell]

    def expect_image(self, name):
        width, height = image_size(self.path(f"out/{name}"))
        self.assertGreater(width, 500)
        self.assertGreater(height, 200)

    def test_kernels_stand_by_direction_and_threads_at_their_largest_mesh(self):
        files, text = self.plot(
            self.report("one.json", [kernel("volume/i/c1/no_side/Serial", 8000, 1, 0.11), kernel("volume/i/c1/no_side/Serial", 64000, 8, 0.71),
                                     kernel("volume/k/c1/no_side/Serial", 64000, 9, 0.62)]),
            self.report("all.json", [kernel("volume/k/c1/no_side/OpenMP", 64000, 5, 0.53)], threads=4))
        self.assertEqual(files, ["kernels.png", "tables.md"])
        self.expect_image("kernels.png")
        self.assertEqual(self.rows(text, "kernel")[0], ["kernel", "million nodes", "bytes per node", "i, 1 thread", "j, 1 thread",
                                                        "k, 1 thread", "i, 4 threads", "j, 4 threads", "k, 4 threads"])
        self.assertEqual(self.rows(text, "volume c1 no side"), [["volume c1 no side", "0.0640", "48.0", "0.71", "–", "0.62", "–", "–", "0.53"]])

    def test_stages_of_unstructured_morphs_stand_by_elements(self):
        runs = [benchmark("unstructured/apply/OpenMP", nodes, ms, elements=elements)
                for nodes, ms, elements in ((30_588, 7, 101_100), (129_670, 14, 499_102), (1_064_120, 106.412, 5_003_960))]
        planning = benchmark("unstructured/prepare/host", 1_064_120, 5000, elements=5_003_960)
        del planning["bytes/s"]
        files, text = self.plot(self.report("unstructured.json", [*runs, planning]))
        self.assertEqual(files, ["tables.md"])
        self.assertEqual(self.rows(text, ""), [["", "0.1", "0.5", "5", "ns per node", "GB/s"]])
        self.assertEqual(self.rows(text, "apply, 2 threads"), [["apply, 2 threads", "7.00", "14.0", "106", "100", "0.480"]])
        self.assertEqual(self.rows(text, "prepare, 2 threads"), [["prepare, 2 threads", "–", "–", "5,000", "4,700", "–"]])

    def test_the_line_through_the_passage_is_that_of_its_times(self):
        # 2 ms and 40 ns per node
        runs = [benchmark("passage/workflow/Serial", n, 2 + 40e-6 * n, share=0.5, updates=3) for n in (100_000, 1_000_000, 25_000_000)]
        files, text = self.plot(self.report("passage.json", runs))
        self.assertEqual(files, ["passage.png", "tables.md"])
        self.expect_image("passage.png")
        self.assertEqual(self.rows(text, "passage workflow, 1 thread")[-1], ["passage workflow, 1 thread", "25.0", "1,000", "40.1", "3.00", "0.50"])
        self.assertEqual(self.rows(text, "passage workflow, 1 thread: straight line")[0][2:4], ["+2.00 at 0", "40.0"])

    def test_repetitions_count_with_their_median_and_aggregates_not_at_all(self):
        runs = [benchmark("copy/Serial", 1000, ms) for ms in (3, 1, 200)]
        runs.append({**benchmark("copy/Serial", 1000, 500), "name": "copy/Serial/nodes:1000/manual_time_mean", "run_type": "aggregate"})
        _, text = self.plot(self.report("copy.json", runs))
        self.assertEqual(self.rows(text, "copy, 1 thread")[0][2], "3.00")

    def test_the_machine_and_the_commit_are_named(self):
        _, text = self.plot(self.report("copy.json", [benchmark("copy/Serial", 1000, 1)]))
        for words in ("Abacus 3000", "abc1234", "2026-01-02", "load before a program: 0.5"):
            self.assertIn(words, text)

    def test_benchmarks_without_a_space_are_those_of_the_host(self):
        _, text = self.plot(self.report("plan.json", [benchmark("prepare", 1000, 1), benchmark("read_mesh/hdf5/double", 1000, 2)], threads=3))
        self.assertEqual(len(self.rows(text, "prepare, 3 threads")), 1)
        self.assertEqual(len(self.rows(text, "read mesh hdf5 double, 3 threads")), 1)

    def test_bad_input_is_one_line_and_exit_status_two(self):
        with open(self.path("noise.json"), "w", encoding="utf-8") as file:
            file.write("no report at all")
        with open(self.path("other.json"), "w", encoding="utf-8") as file:
            json.dump([1, 2], file)
        for path, words in (("gone.json", "No such file"), ("noise.json", "not a JSON report"), ("other.json", "not a JSON report"),
                            (os.path.basename(self.report("empty.json", [])), "no benchmark")):
            run = subprocess.run([sys.executable, PLOT_BENCH, self.path(path), "--out", self.path("out")], capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 2, path)
            self.assertIn(words, run.stderr)
            self.assertIn(path, run.stderr)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


if __name__ == "__main__":
    unittest.main()
