"""Objects whose __init__ has not run, error messages about arguments, and endless nesting."""

import os
import pickle
import subprocess
import sys
import unittest

import numpy as np
import ricochet
import ricochet.trimesh
from support import BOX_FACES, BOX_VERTICES, bouncing

POINTS = np.array([[0.5, 0.5, 0.5]])

# Program that uses every method and property of an object whose __init__ has not run.
ASKS_ALL = """
import sys
import ricochet
kind = getattr(ricochet, sys.argv[1])
made = kind.__new__(kind)
points = [[0.5, 0.5, 0.5]]
asked = 0
for name in sorted(set(dir(ricochet._core.__dict__[sys.argv[1]])) - set(dir(object)) | {"__repr__", "__reduce__"}):
    if name in ("__init__", "__new__", "__class__", "__setstate__", "__module__", "__dict__", "read"):
        continue
    if name.startswith("_pybind11"):  # pybind11's own, which other modules call
        continue
    for arguments in ((), (points,), (points, points), (b"",), (1,), (1, None)):
        try:
            value = getattr(made, name)
            value(*arguments)
        except TypeError as error:
            if "has not been made" in str(error):
                asked += 1
                break
    else:
        raise SystemExit(f"{name} says nothing")
print(asked)
"""


class NotMade(unittest.TestCase):
    def test_objects_without_init_refuse_every_call(self):
        for kind, least in (("Mesh", 15), ("Simulation", 20)):
            asked = subprocess.run([sys.executable, "-c", ASKS_ALL, kind], capture_output=True, text=True)
            self.assertEqual(asked.returncode, 0, f"{kind}: {asked.stdout} {asked.stderr}")
            self.assertGreaterEqual(int(asked.stdout), least)

    def test_objects_without_init_are_refused_as_arguments(self):
        mesh = ricochet.Mesh.__new__(ricochet.Mesh)
        for call in (lambda: mesh.inside(POINTS), lambda: len(mesh), lambda: ricochet.as_mesh(mesh).vertices,
                     lambda: ricochet.Simulation(bouncing(colliders=[{"type": "mesh", "file": mesh}])),
                     lambda: ricochet.trimesh.RayMeshIntersector(mesh).contains_points(POINTS),
                     lambda: pickle.dumps(mesh),
                     lambda: ricochet.Simulation(
                         bouncing(), forces=[ricochet.CompiledForce.__new__(ricochet.CompiledForce)]),
                     lambda: pickle.dumps(ricochet.Simulation.__new__(ricochet.Simulation))):
            with self.assertRaisesRegex(TypeError, "has not been made"):
                call()

    def test_the_common_base_class_makes_no_objects(self):
        root = ricochet.Mesh.__base__

        class Own(root):
            pass

        for make in (root, lambda: root.__new__(root), Own, lambda: Own.__new__(Own)):
            with self.assertRaisesRegex(TypeError, "cannot be made"):
                make()

    def test_every_protocol_of_pickle_copies_meshes(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            twin = pickle.loads(pickle.dumps(mesh, protocol))
            np.testing.assert_array_equal(twin.vertices, mesh.vertices)
            simulation = pickle.loads(pickle.dumps(ricochet.Simulation(bouncing()), protocol))
            simulation.step()

    def test_derived_classes_may_not_use_an_object_before_init(self):
        test = self

        class Early(ricochet.Mesh):
            def __init__(self):
                with test.assertRaisesRegex(TypeError, "Early: this object has not been made"):
                    self.inside(POINTS)
                super().__init__(BOX_VERTICES, BOX_FACES)

        self.assertTrue(Early().inside(POINTS)[0])

        class Failed(ricochet.Simulation):
            def __init__(self):
                try:
                    super().__init__({"ricochet": 1, "nothing": 1})
                except ricochet.InputError:
                    pass
                with test.assertRaisesRegex(TypeError, "Failed: this object has not been made"):
                    self.step()
                super().__init__(bouncing())

        made = Failed()
        made.step()
        with self.assertRaisesRegex(ricochet.InputError, "has been made already"):
            ricochet.Simulation.__init__(made, bouncing(particles=[]))
        self.assertEqual(len(pickle.loads(pickle.dumps(made)).particles.id), 2)


# Program with a daemon thread that runs C++ code or a Python force while the interpreter ends.
ENDS = """
import sys, threading, time
import ricochet
sys.path.insert(0, sys.argv[1])
from support import ball, bouncing
what = sys.argv[2]
options = {"time_step": 1e-6, "duration": 1e5, "integrator": "rk4"}
began = threading.Event()
def force(particles):
    began.set()
    return -particles.position
if what == "mesh":
    mesh = ricochet.Mesh(*ball(4))
    points = mesh.vertices.repeat(20, axis=0)
    def run():
        while True:
            began.set()
            mesh.closest_points(points)
else:
    forces = [force] if what == "force" else []
    simulation = ricochet.Simulation(bouncing(simulation=options), forces=forces)
    def run():
        if what == "steps":
            began.set()
        simulation.advance(10**10)
threading.Thread(target=run, daemon=True).start()
began.wait()
time.sleep(0.15)
print("ends")
"""


class Ends(unittest.TestCase):
    def test_the_interpreter_ends_quietly_while_a_daemon_thread_runs(self):
        for what in ("steps", "force", "mesh"):
            ended = subprocess.run([sys.executable, "-c", ENDS, os.path.dirname(__file__), what], capture_output=True,
                                   text=True, timeout=60)
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "ends\n", ""), what)


class Messages(unittest.TestCase):
    def refused(self, said, call, *arguments, **keys):
        with self.assertRaisesRegex(ricochet.InputError, said) as caught:
            call(*arguments, **keys)
        self.assertNotIn("\n", str(caught.exception))

    def test_messages_name_entries_that_are_not_numbers(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        self.refused(r"points: found NoneType", mesh.inside, [[None, 0, 0]])
        self.refused(r"points: found dict", mesh.inside, [[{}, 0, 0]])
        self.refused(r"points: found str|points: found <U1", mesh.inside, [["a", "b", "c"]])
        self.refused(r"points: found whole numbers of more than 64 bits", mesh.inside, [[2**70, 0, 0]])
        self.refused(r"points: found a whole number beyond the range of doubles", mesh.inside, [[10**400, 0, 0]])
        self.refused(r"points: found list \(.+\), expected numbers", mesh.inside, [[1, 2], [3]])
        self.refused(r"points: a copy of shape \(100000000000000, 3\) as doubles: asks for about 2.4 PB", mesh.inside,
                     np.broadcast_to(np.zeros(3), (10**14, 3)))

    def test_messages_name_files_whose_names_are_not_text(self):
        name = os.fsdecode(b"/not-there-\xff.obj")
        self.refused(r"^/not-there-\\xff.obj: no such file", ricochet.Mesh.read, name)

        class Cells:
            points = BOX_VERTICES
            cells_dict = 5

        self.refused("^mesh: found Cells, expected", ricochet.as_mesh, Cells())

    def test_messages_name_masked_entries_and_none(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        points = np.ma.masked_array(np.full((2, 3), 0.5), mask=[[True, False, False], [False] * 3])
        self.refused("points: found masked entries", mesh.inside, points)
        self.assertTrue(mesh.inside(np.ma.masked_array(points.data)).all())
        self.refused("mass: found None", ricochet.Simulation(bouncing()).add_particles, [[0, 0, 1.0]], mass=None)
        self.refused("scene: found nan or inf in an array", ricochet.Simulation,
                     bouncing(particles=[{"position": np.array([0.0, np.nan, 0.0])}]))

    def test_messages_name_scenes_with_endless_nesting(self):
        endless = []
        endless.append(endless)
        self.refused("nested deeper than 64 levels", ricochet.Simulation, bouncing(particles=endless))
        deep = 1
        for _ in range(100000):
            deep = [deep]
        self.refused("nested deeper than 64 levels", ricochet.Simulation, bouncing(particles=deep))
        self.refused("overrides: 'particles': cannot be written as JSON", ricochet.Simulation, bouncing(),
                     {"particles": endless})
        self.refused("overrides: 'particles': cannot be written as JSON", ricochet.Simulation, bouncing(),
                     {"particles": deep})
        odd = np.empty(1, dtype=object)
        odd[0] = odd
        self.refused("scene: cannot be written as JSON", ricochet.Simulation, bouncing(particles=odd))

    def test_messages_name_wrong_times(self):
        simulation = ricochet.Simulation(bouncing())
        for until in ("x", "1.0", b"1", [], {}, 10**400, np.nan, -1.0, 1j, object()):
            self.refused("^until: found .*, expected a time", simulation.run, until)
        simulation.run(np.float32(0.5))
        self.assertEqual(simulation.step_index, 50)


if __name__ == "__main__":
    unittest.main()
