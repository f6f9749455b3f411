"""Morphs on the processes of an mpi4py communicator: one plans, each moves its own nodes.

    plan = gridmorph.Plan(mesh, motion) if comm.Get_rank() == 0 else None
    share = gridmorph.mpi.share_out(comm, plan, boxes)    # boxes of nodes that this process has
    x = share.positions(u)                                # of its nodes, the same bits as by the plan
"""


def share_out(comm, plan, boxes):
    """The Share of each process in a plan that rank 0 has.

    comm: an mpi4py communicator. plan: on rank 0, elsewhere None. boxes: of this process, each (zone, i0, j0, k0, i1, j1, k1) with i0 <= i < i1,
    from 0; layers of ghost nodes too, or none. Collective: what is raised for the boxes of any process is raised on all.
    """
    asked = comm.gather([tuple(int(n) for n in box) for box in boxes], root=0)
    shares, error = None, None
    if comm.Get_rank() == 0:
        try:
            shares = [plan.share(of_rank) for of_rank in asked]
        except Exception as raised:  # the others wait: they are told first
            error = raised
    error = comm.bcast(error, root=0)
    if error is not None:
        raise error
    return comm.scatter(shares, root=0)
