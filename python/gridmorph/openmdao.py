"""A mesh that follows its surface, as a component of OpenMDAO.

    import openmdao.api as om
    from gridmorph.openmdao import MorphComponent
    problem.model.add_subsystem("mesh", MorphComponent(mesh="wing.cgns", patches=["wing"]), promotes=["*"])

Input "u": displacement of the nodes of the patches (k, 3); or, with input="coordinates", "x_surface": where they are. Output "x_volume":
where all nodes are (n, 3). Derivatives are gridmorph's own, forwards (velocities) and in reverse (the transpose), without a matrix.
"""
import numpy
import openmdao.api as om

from . import ConfigError, Mesh, Motion, Plan
from ._surface_points import SlipPlanes

__all__ = ["MorphComponent"]


class MorphComponent(om.ExplicitComponent):
    """x_volume = x + displacements(u): the nodes of a mesh as a function of the nodes of its moving patches.

    Options: mesh (a path or a gridmorph.Mesh); patches (selectors of what moves, default all walls); motion (a gridmorph.Motion, or the
    tables of one as a dict: rules of the other patches, which keep their displacement, and how the volume is morphed); input
    ("displacement" or "coordinates"); freeze_guard (as in gridmorph.Plan); units (of lengths, as OpenMDAO names them).

    After setup: mesh, plan, surface_nodes (k,) int: numbers of the nodes that the rows of the input belong to, in ascending order of the
    plan's boundary nodes; nodes that coincide in several zones are one row. Rows on a symmetry plane stay on it: what of the input leads off
    has no effect, and no derivative. Cost of compute and of each product: about one morph.
    """

    def initialize(self):
        self.options.declare("mesh", desc="path or gridmorph.Mesh")
        self.options.declare("patches", default=("type:wall",), types=(str, list, tuple), desc="selectors of what moves")
        self.options.declare("motion", default=None, desc="gridmorph.Motion or dict of tables, for the other patches and the volume")
        self.options.declare("input", default="displacement", values=("displacement", "coordinates"))
        self.options.declare("freeze_guard", default=False, types=bool)
        self.options.declare("units", default=None, allow_none=True)

    def setup(self):
        mesh, patches, motion = self.options["mesh"], self.options["patches"], self.options["motion"]
        self.mesh = mesh if isinstance(mesh, Mesh) else Mesh.read(mesh)
        patches = [patches] if isinstance(patches, str) else list(patches)
        # A motion of the caller stays as it is: the rule for what moves comes on a copy.
        motion = motion.copy() if isinstance(motion, Motion) else Motion(motion)
        self.plan = Plan(self.mesh, motion.prescribed(patches), freeze_guard=self.options["freeze_guard"])
        row, _, patch, _ = self.plan.boundary_places
        numbers = self.mesh.patch_numbers(patches)
        self._rows = numpy.unique(row[numpy.isin(patch, numbers)])
        if not len(self._rows):
            raise ConfigError(f"MorphComponent: no nodes of the mesh follow {patches}; name patches that move")
        self.surface_nodes = self.plan.boundary_nodes[self._rows]
        self._planes = SlipPlanes(self.mesh, self.plan, numbers)
        self._rest = numpy.array(self.plan.boundary_displacement)
        baseline = self.mesh.coordinates
        self._from_coordinates = self.options["input"] == "coordinates"
        self._name = "x_surface" if self._from_coordinates else "u"
        start = baseline[self.surface_nodes]
        self._start = start if self._from_coordinates else 0.0
        units = self.options["units"]
        self.add_input(self._name, val=start if self._from_coordinates else numpy.zeros_like(start), units=units)
        self.add_output("x_volume", val=baseline, units=units)

    def setup_partials(self):
        pass  # by compute_jacvec_product alone

    def _boundary(self, inputs):
        return self._rest + self._spread(inputs[self._name] - self._start)

    def _spread(self, of_rows):
        u = numpy.zeros_like(self._rest)
        u[self._rows] = of_rows
        return self._planes.project(u)

    def compute(self, inputs, outputs):
        outputs["x_volume"] = self.plan.positions(self._boundary(inputs))

    def compute_jacvec_product(self, inputs, d_inputs, d_outputs, mode):
        if self._name not in d_inputs or "x_volume" not in d_outputs:
            return
        u = self._boundary(inputs)
        if mode == "fwd":
            d_outputs["x_volume"] += self.plan.velocities(self._spread(d_inputs[self._name]), u)
        else:
            gradient = numpy.ascontiguousarray(d_outputs["x_volume"])
            d_inputs[self._name] += self._planes.project(self.plan.transpose(gradient, u), transpose=True)[self._rows]

