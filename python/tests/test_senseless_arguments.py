"""Calls every function with every kind of invalid argument. A call must raise an exception or return, and must not end
the interpreter."""

import itertools
import unittest

import numpy as np
import ricochet
import ricochet.trimesh
from support import BOX_FACES, BOX_VERTICES, bouncing

NONSENSE = [
    None,
    True,
    -1,
    0,
    7,
    2**70,
    1.5,
    np.nan,
    np.inf,
    -np.inf,
    1e308,
    "text",
    b"bytes",
    [],
    [[]],
    [1, 2, 3],
    [[1, 2, 3]],
    [[1, 2], [3]],
    [[np.nan, 0, 0]],
    [[np.inf, 0, 0]],
    [[1e300, 0, 0]],
    [[0, 0, 0]],
    [["a", "b", "c"]],
    [[None, 0, 0]],
    [[1j, 0, 0]],
    {},
    {"a": 1},
    object(),
    lambda: None,
    np.zeros((0, 3)),
    np.zeros((3, 0)),
    np.zeros((2, 3, 4)),
    np.zeros((2, 3), dtype=np.float16),
    np.zeros((2, 3), dtype=complex),
    np.zeros((2, 3), dtype="datetime64[s]"),
    np.zeros((2, 3), dtype=object),
    np.zeros(2, dtype=[("x", "f8")]),
    np.broadcast_to(np.zeros(3), (5, 3)),
    np.zeros((6, 6))[::2, ::2],
    np.full((1, 3), 2**63, dtype=np.uint64),
    np.full((1, 3), -1),
    range(3),
]

ALLOWED = (ValueError, TypeError, RuntimeError, OverflowError, OSError, AttributeError)


class SenselessArguments(unittest.TestCase):
    def tried(self, function, *arguments, **keys):
        try:
            function(*arguments, **keys)
        except ALLOWED as error:
            self.assertTrue(str(error))

    def test_meshes_survive_invalid_arguments(self):
        for vertices, faces in itertools.product(NONSENSE, NONSENSE):
            self.tried(ricochet.Mesh, vertices, faces)
        for value in NONSENSE:
            self.tried(ricochet.Mesh, value, BOX_FACES)
            self.tried(ricochet.Mesh, BOX_VERTICES, value)
            self.tried(ricochet.Mesh.read, value)
            self.tried(ricochet.as_mesh, value)
            self.tried(ricochet.trimesh.RayMeshIntersector, value)

    def test_queries_survive_invalid_arguments(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        points = [[0.5, 0.5, 0.5], [2.0, 0.5, 0.5]]
        for a in NONSENSE:
            for question in (mesh.first_hits, mesh.all_hits, mesh.count_hits, mesh.occluded, mesh.sweep):
                self.tried(question, a, points)
                self.tried(question, points, a)
                self.tried(question, points, points, a)
                self.tried(question, a, a)
            self.tried(mesh.sweep, points, points, 0.5, a)
            self.tried(mesh.closest_points, points, a)
            for question in (mesh.inside, mesh.closest_points, mesh.signed_distances, mesh.set_vertices):
                self.tried(question, a)
        for a, b in itertools.product(NONSENSE, NONSENSE):
            self.tried(mesh.first_hits, a, b)
            self.tried(mesh.sweep, a, b)
        mesh.set_vertices(BOX_VERTICES)
        self.assertTrue(mesh.inside([[0.5, 0.5, 0.5]])[0])

    def test_simulations_survive_invalid_arguments(self):
        simulation = ricochet.Simulation(bouncing(), contacts=True)
        for a in NONSENSE:
            self.tried(ricochet.Simulation, a)
            self.tried(ricochet.Simulation, bouncing(), a)
            self.tried(ricochet.Simulation, bouncing(), forces=a)
            self.tried(ricochet.Simulation(bouncing(), forces=[lambda particles, a=a: a]).step)
            self.tried(simulation.render, 8, 8, 1, a, a)
            self.tried(ricochet.Simulation, bouncing(particles=a))
            self.tried(ricochet.Simulation, bouncing(simulation={"time_step": a}))
            self.tried(simulation.run, a)
            for call in (simulation.add_particles, simulation.remove_particles, simulation.triangle_totals,
                         simulation.collider_mesh, simulation.restore, ricochet.set_threads):
                self.tried(call, a)
            for name in ("velocity", "mass", "radius", "spin", "lifetime"):
                self.tried(simulation.add_particles, [[0, 0, 5.0]], **{name: a})
        for steps in (None, -1, 1.5, "x", np.nan, 2**70, [], True):
            with self.assertRaises(ricochet.InputError):
                simulation.advance(steps)
        ricochet.set_threads(0)


if __name__ == "__main__":
    unittest.main()
