"""Shares of plans, as processes of MPI get them: pickled, each with its own nodes."""
import pickle

import numpy as np
import pytest

import gridmorph
import gridmorph.mpi
from test_package import N, bump, two_boxes

BOXES = [[(0, 0, 0, 0, N, N, 4)], [(0, 0, 0, 3, N, N, N), (1, 0, 0, 0, N, N, 2)], [], [(1, 0, 0, 1, N, N, N)]]


@pytest.fixture(scope="module")
def plan():
    return gridmorph.Plan(two_boxes(), gridmorph.Motion().function("floor", bump))


def nodes_of(boxes):
    number = np.arange(2 * N**3).reshape(2, N, N, N)  # zone, k, j, i
    parts = [number[z, k0:k1, j0:j1, i0:i1].ravel() for z, i0, j0, k0, i1, j1, k1 in boxes]
    return np.concatenate(parts) if parts else np.zeros(0, int)


class Communicator:
    """One rank of several, one after another: what mpi4py's does with what is told here to be said by the others."""

    def __init__(self, rank, asked, memory):
        self.rank, self.asked, self.memory = rank, asked, memory

    def Get_rank(self):
        return self.rank

    def gather(self, own, root):
        assert own == self.asked[self.rank]
        return pickle.loads(pickle.dumps(self.asked)) if self.rank == root else None

    def bcast(self, value, root):
        return pickle.loads(self.memory.setdefault("error", pickle.dumps(value)))

    def scatter(self, values, root):
        if self.rank == root:
            self.memory["shares"] = [pickle.dumps(value) for value in values]
        return pickle.loads(self.memory["shares"][self.rank])


def test_shares_move_their_nodes_to_the_bits_of_the_plan_and_add_up_to_its_gradients(plan):
    memory, gradient, counted = {}, np.random.default_rng(1).normal(size=(plan.n_nodes, 3)), np.zeros(plan.n_nodes, bool)
    u = 1.5 * plan.boundary_displacement
    total = np.zeros_like(u)
    for rank in range(len(BOXES)):
        share = gridmorph.mpi.share_out(Communicator(rank, BOXES, memory), plan if rank == 0 else None, BOXES[rank])
        nodes = nodes_of(BOXES[rank])
        assert share.n_nodes == len(nodes)
        np.testing.assert_array_equal(share.boundary_nodes, plan.boundary_nodes)
        np.testing.assert_array_equal(share.positions(), plan.positions()[nodes])
        np.testing.assert_array_equal(share.displacements(u), plan.displacements(u)[nodes])
        np.testing.assert_array_equal(share.velocities(u), plan.velocities(u)[nodes])
        own = np.where(counted[nodes, None], 0, gradient[nodes])
        counted[nodes] = True
        total += share.transpose(own, u)
    assert counted.all()
    np.testing.assert_allclose(total, plan.transpose(gradient, u), rtol=0, atol=1e-12 * abs(gradient).max() * N)


def test_boxes_that_cannot_be_are_refused_on_all_processes(plan):
    asked = [[(0, 0, 0, 0, N, N, N + 1)], []]
    memory = {}
    for rank in range(2):
        with pytest.raises(gridmorph.ConfigError, match="lower"):
            gridmorph.mpi.share_out(Communicator(rank, asked, memory), plan if rank == 0 else None, asked[rank])
    with pytest.raises(gridmorph.ConfigError, match="zone 2"):
        plan.share([(2, 0, 0, 0, 1, 1, 1)])
