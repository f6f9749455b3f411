#!/usr/bin/env python3
"""What a call from Python costs beside the same call in C++: displacements() of one plan, on the same threads, one after the other.

    PYTHONPATH=build/ci/python OMP_NUM_THREADS=2 python3 bench/bench_bindings.py [--nodes 1000000] [--repeats 60]

The mesh is a box of blocks whose floor is prescribed. "C++": the call and a fence, timed inside the module on arrays of its own. "out":
plan.displacements(u, out=d), timed around it in Python. "new": without `out`, so with a new array each time, whose pages the system has
to provide. Both kinds of call take turns, so that they see the same machine; on a busy one the smallest time says more than the median.
"""
import argparse
import statistics
import time

import numpy as np

import gridmorph


def box(n_nodes):
    n = max(round(n_nodes ** (1 / 3)), 3)
    t = np.linspace(0.0, 1.0, n)
    faces = {"k_min": "floor", **{face: "rest" for face in ("i_min", "i_max", "j_min", "j_max", "k_max")}}
    return gridmorph.Mesh.from_blocks({"box": np.stack(np.meshgrid(t, t, t, indexing="ij"), axis=-1)},
                                      {"patch": [{"name": p, "zone": "box", "face": f, "kind": "wall"} for f, p in faces.items()]})


def measure(n_nodes, repeats):
    """Seconds of each call: {"C++": [...], "out": [...], "new": [...]}, and the number of nodes."""
    mesh = box(n_nodes)
    plan = gridmorph.Plan(mesh, gridmorph.Motion().prescribed("floor"))
    u = np.zeros((len(plan.boundary_nodes), 3))
    d = np.zeros((mesh.n_nodes, 3))

    def timed(call):
        start = time.perf_counter()
        call()
        return time.perf_counter() - start

    seconds = {"C++": [], "out": [], "new": []}
    for _ in range(repeats):
        seconds["C++"].extend(plan._native_times(2)[1:])  # the first one touches new memory
        timed(lambda: plan.displacements(u, out=d))
        seconds["out"].append(timed(lambda: plan.displacements(u, out=d)))
        seconds["new"].append(timed(lambda: plan.displacements(u)))
    return seconds, mesh.n_nodes


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--nodes", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=60)
    options = parser.parse_args()
    seconds, n_nodes = measure(options.nodes, options.repeats)
    small, _ = measure(1000, options.repeats)
    print(f"{n_nodes} nodes, {options.repeats} repeats        smallest      median")
    for name, values in seconds.items():
        print(f"  {name:4s} {1e3 * min(values):26.3f} ms {1e3 * statistics.median(values):8.3f} ms   "
              f"{100 * (min(values) / min(seconds['C++']) - 1):+.1f} % {100 * (statistics.median(values) / statistics.median(seconds['C++']) - 1):+.1f} %")
    print(f"  a call by itself (1000 nodes, out): {1e6 * (min(small['out']) - min(small['C++'])):.1f} microseconds more than in C++")


if __name__ == "__main__":
    main()
