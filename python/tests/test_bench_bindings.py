"""The benchmark of the bindings, for a moment: it keeps working, and judges no time."""


def test_the_benchmark_of_the_bindings_runs(script):
    seconds, n_nodes = script("bench/bench_bindings.py").measure(1000, 3)
    assert n_nodes == 1000
    assert {name: len(values) for name, values in seconds.items()} == {"C++": 3, "out": 3, "new": 3}
    assert all(value > 0 for values in seconds.values() for value in values)
