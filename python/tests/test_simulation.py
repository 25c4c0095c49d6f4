import gc
import json
import os
import pickle
import re
import signal
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np
import ricochet
from ricochet import scene as things
from support import ROOT, ball, bouncing


class Simulation(unittest.TestCase):
    def test_a_falling_ball_agrees_with_the_formula(self):
        simulation = ricochet.Simulation(bouncing())
        simulation.run(until=0.25)
        self.assertAlmostEqual(simulation.time, 0.25)
        self.assertEqual(simulation.step_index, 25)
        height = simulation.particles.position[:, 2]
        np.testing.assert_allclose(height, [1 - 0.5 * 9.81 * 0.0625, 2 - 0.5 * 9.81 * 0.0625], rtol=1e-12)
        simulation.run()
        self.assertTrue(simulation.finished)
        self.assertGreater(simulation.statistics["contacts"], 0)

    def test_statistics_have_every_counter_of_the_library_with_a_text(self):
        table = (ROOT / "src/ricochet/simulation/statistics.h").read_text()
        names = re.findall(r'\{"(\w+)", &S::', table)
        self.assertGreater(len(names), 40)
        self.assertEqual(list(ricochet.Simulation(bouncing()).statistics), names)
        lines = ricochet.Simulation.statistics.__doc__.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines[2:]], names)
        self.assertIsNone(ricochet.Simulation(bouncing()).statistics["violations"])
        self.assertEqual(ricochet.Simulation(bouncing(), verify=True).statistics["violations"], 0)
        self.assertIn("unsimulated_time: time lost because a budget was spent, in s, summed over particles", lines)

    def test_counters_count_the_passages_of_a_falling_ball(self):
        self.assertEqual(ricochet.Simulation(bouncing()).counters, [])
        gate = {"name": "gate", "center": [0, 0, 0.9], "normal": [0, 0, -1], "radius": 10}
        simulation = ricochet.Simulation(bouncing(counters=[gate]))
        simulation.run(until=0.2)  # the lower ball falls from 1 m to 0.8 m, the upper one from 2 m to 1.8 m
        (counter,) = simulation.counters
        self.assertEqual((counter["name"], counter["forward"], counter["backward"]), ("gate", 1, 0))
        self.assertEqual(counter["forward_mass"], simulation.particles.mass[0])
        speed = (2 * 9.81 * 0.1) ** 0.5
        self.assertAlmostEqual(counter["forward_statistics"]["speed"]["mean"], speed)
        self.assertAlmostEqual(counter["forward_statistics"]["first_time"], speed / 9.81)
        self.assertIsNone(counter["backward_statistics"]["first_time"])
        self.assertEqual(counter["transmission"]["probability"], 0.5)

    def test_classes_of_counters_have_their_types(self):
        disk = things.Counter(name="a", center=[0, 0, 0], normal=[0, 0, 1], radius=1)
        self.assertNotIn("type", disk)
        cell = things.BoxCounter(name="b", center=[0, 0, 1], size=[2, 2, 1])
        self.assertEqual(cell["type"], "box")
        simulation = ricochet.Simulation(bouncing(counters=[disk, cell]))
        self.assertEqual(simulation.counters[1]["residence"], {"count": 0, "mean": None, "deviation": None})

    def test_steps_and_runs_give_the_same_bits(self):
        one, other = ricochet.Simulation(bouncing()), ricochet.Simulation(bouncing())
        one.advance(100)
        for _ in range(100):
            other.step()
        self.assertEqual(one.state_hash, other.state_hash)

    def test_arrays_keep_their_values_and_memory_when_the_simulation_goes_on(self):
        simulation = ricochet.Simulation(bouncing())
        twin = ricochet.Simulation(bouncing())
        particles = simulation.particles
        kept = particles.position.copy()
        address = particles.position.ctypes.data
        with self.assertRaises(ValueError):
            particles.position[0, 0] = 1.0
        simulation.advance(50)
        later = simulation.particles.position
        np.testing.assert_array_equal(particles.position, kept)
        self.assertEqual(particles.position.ctypes.data, address)
        self.assertFalse(np.array_equal(later, kept))
        simulation.add_particles([[0, 0, 9.0]])
        simulation.advance(10)
        del simulation
        gc.collect()
        np.testing.assert_array_equal(particles.position, kept)
        self.assertEqual(particles.id.tolist(), [0, 1])
        twin.advance(50)
        np.testing.assert_array_equal(twin.particles.position, later)

    def test_the_arrays_are_the_simulations_own_memory(self):
        simulation = ricochet.Simulation(bouncing())
        self.assertEqual(simulation.particles.position.ctypes.data, simulation.particles.position.ctypes.data)

    def test_particles_can_be_added_and_removed(self):
        simulation = ricochet.Simulation(bouncing())
        ids = simulation.add_particles([[0, 0, 5.0], [0, 1, 5.0]], velocity=[[1, 0, 0]] * 2, radius=0.2, mass=[1.0, 2.0])
        self.assertEqual(ids.tolist(), [2, 3])
        self.assertEqual(simulation.particles.mass.tolist(), [1, 1, 1, 2])
        self.assertEqual(simulation.remove_particles([3, 99]), 1)
        self.assertEqual(len(simulation), 3)
        with self.assertRaises(ricochet.InputError):
            simulation.add_particles([[0, 0, 5.0]], mass=-1.0)
        with self.assertRaises(ricochet.InputError):
            simulation.add_particles([[0, 0, 5.0]], velocity=[[1, 0, 0]] * 2)

    def test_contacts_are_a_structured_array(self):
        simulation = ricochet.Simulation(bouncing(), contacts=True)
        simulation.run()
        contacts = simulation.take_contacts()
        self.assertEqual(len(contacts), simulation.statistics["contacts"])
        first = contacts[contacts["particle"] == 1][0]
        self.assertAlmostEqual(first["time"], np.sqrt(4 / 9.81), places=12)
        self.assertAlmostEqual(first["velocity_after"][2], -0.8 * first["velocity_before"][2], places=12)
        self.assertEqual(len(simulation.take_contacts()), 0)
        with self.assertRaises(ricochet.InputError):
            ricochet.Simulation(bouncing()).take_contacts()

    def test_totals_add_up_to_the_contacts(self):
        vertices, faces = ball(2)
        scene = bouncing(colliders=[{"name": "ball", "type": "mesh", "file": ricochet.Mesh(vertices, faces)}])
        simulation = ricochet.Simulation(scene, contacts=True)
        simulation.run()
        totals = simulation.triangle_totals("ball")
        self.assertEqual(totals.hits.shape, (len(faces),))
        contacts = simulation.take_contacts()
        np.testing.assert_array_equal(totals.hits, np.bincount(contacts["triangle"], minlength=len(faces)))
        self.assertEqual(totals.impulse.shape, (len(faces), 3))
        self.assertEqual(simulation.colliders, ["ball"])
        np.testing.assert_array_equal(simulation.collider_mesh(0).vertices, vertices)

    def test_scenes_come_from_files_dictionaries_and_objects(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            file.write_text(json.dumps(bouncing()))
            objects = things.Scene(
                simulation=things.SimulationOptions(time_step=0.01, duration=2.0),
                forces=[things.GravityForce(acceleration=np.array([0, 0, -9.81]))],
                materials={"rubber": things.Material(restitution=0.8)},
                colliders=[things.PlaneCollider(name="floor", point=[0, 0, 0], normal=[0, 0, 1], material="rubber")],
                particles=[things.Particle(position=[0, 0, 1], radius=0.1),
                           things.Particle(position=[1, 0, 2], velocity=(1, 0, 0))],
            )
            hashes = set()
            for scene in (file, str(file), bouncing(), objects):
                simulation = ricochet.Simulation(scene)
                simulation.run()
                hashes.add(simulation.state_hash)
            self.assertEqual(len(hashes), 1)

    def test_a_typo_gives_the_same_message_as_in_the_tool(self):
        with self.assertRaisesRegex(ricochet.InputError, "materials.rubber.*restitutoin.*restitution"):
            ricochet.Simulation(bouncing(materials={"rubber": things.Material(restitutoin=0.8)}))
        with self.assertRaisesRegex(ValueError, "simulation.time_step"):
            ricochet.Simulation(bouncing(), {"simulation.time_step": -1})

    def test_warnings_of_the_tool_are_python_warnings_except_that_nothing_moves(self):
        with self.assertWarnsRegex(UserWarning, "materials.wool: no collider uses this material"):
            simulation = ricochet.Simulation(bouncing(materials={"rubber": {}, "wool": {}}))
        self.assertEqual(len(simulation.warnings), 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            empty = ricochet.Simulation(bouncing(particles=[]))
        self.assertEqual(empty.add_particles([[0, 0, 1.0]]).tolist(), [0])

    def test_overrides_work_like_in_the_tool(self):
        simulation = ricochet.Simulation(bouncing(), {"simulation.duration": 0.5})
        self.assertEqual(simulation.step_count, 50)

    def test_a_pickled_simulation_continues_with_the_same_bits(self):
        for collider in (bouncing()["colliders"][0], {"type": "mesh", "file": ricochet.Mesh(*ball(2))}):
            scene = bouncing(materials={"rubber": {"restitution": 0.5}}, colliders=[collider])
            simulation = ricochet.Simulation(scene, contacts=True)
            simulation.advance(60)
            twin = pickle.loads(pickle.dumps(simulation))
            self.assertEqual(twin.step_index, 60)
            simulation.run()
            twin.run()
            self.assertEqual(twin.state_hash, simulation.state_hash)

    def test_a_damaged_state_is_refused(self):
        simulation = ricochet.Simulation(bouncing())
        state = simulation.save()
        for damaged in (b"", state[:-9], b"x" * len(state)):
            with self.assertRaises(ricochet.InputError):
                ricochet.Simulation(bouncing()).restore(damaged)

    def test_two_python_threads_both_advance(self):
        simulation = ricochet.Simulation(bouncing(), {"simulation.duration": 1e6})
        stop = threading.Event()
        looks = []

        def look():
            looks.append(time.monotonic())
            if stop.is_set():
                raise StopIteration

        def run():
            with self.assertRaises(StopIteration):
                simulation._advance(10**12, look)

        thread = threading.Thread(target=run)
        thread.start()
        # While the other thread steps in C++, this thread runs another simulation to its end.
        other = ricochet.Simulation(bouncing())
        other.run()
        while len(looks) < 2 and thread.is_alive():
            time.sleep(0.01)
        stop.set()
        thread.join()
        self.assertTrue(other.finished)
        self.assertGreater(simulation.step_index, 1000)

    def test_a_stepping_simulation_refuses_other_threads(self):
        simulation = ricochet.Simulation(bouncing(), {"simulation.duration": 1e6})
        refused = []

        def look():
            # Another Python thread reads the simulation during the run, and this callback of the run waits for that
            # thread.
            def ask():
                try:
                    simulation.particles
                except ricochet.RunError as error:
                    refused.append(str(error))

            thread = threading.Thread(target=ask)
            thread.start()
            thread.join()
            raise StopIteration

        with self.assertRaises(StopIteration):
            simulation._advance(10**12, look)
        self.assertEqual(len(refused), 1)
        self.assertGreater(len(simulation.particles.id), 0)

    def test_control_c_ends_a_run_cleanly(self):
        simulation = ricochet.Simulation(bouncing(), {"simulation.duration": 1e6})
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            simulation.advance(10**12)
        timer.join()
        before = simulation.step_index
        simulation.step()
        self.assertEqual(simulation.step_index, before + 1)

    # One step of the larger scene would take minutes.
    def test_control_c_ends_a_step_that_takes_long(self):
        for count in (1, 3000):
            with self.subTest(count=count):
                scene = {
                    "ricochet": 1,
                    "simulation": {"duration": 1e6, "time_step": 0.01, "integrator": "dormand_prince"},
                    "forces": [{"type": "point_gravity", "attractors": [{"position": [0, 0, 0], "strength": 1e3}]}],
                    "particles": [
                        {"position": [1e-4 * (1 + 1e-3 * k), 0, 0], "velocity": [0, 3e3, 0]} for k in range(count)
                    ],
                }
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    simulation = ricochet.Simulation(scene)
                timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    while True:
                        simulation.step()
                timer.join()
                self.assertEqual(len(simulation.particles.id), count)
                self.assertEqual(simulation.statistics["steps"], simulation.step_index)
                self.assertTrue(np.isfinite(simulation.particles.position).all())

    def test_progress_needs_no_tqdm(self):
        simulation = ricochet.Simulation(bouncing())
        simulation.run(until=0.1, progress=True)
        self.assertEqual(simulation.step_index, 10)

    def test_a_picture_is_an_array(self):
        simulation = ricochet.Simulation(ROOT / "scenes" / "bouncing_ball.json")
        simulation.run(until=0.5)
        picture = simulation.render(64, 36, samples=1)
        self.assertEqual((picture.shape, picture.dtype), ((36, 64, 3), np.uint8))
        self.assertGreater(picture.std(), 5)
        np.testing.assert_array_equal(picture, simulation.render(64, 36, samples=1))
        elsewhere = simulation.render(64, 36, 1, position=[0, -20, 3], target=[0, 0, 0], field_of_view=50)
        self.assertFalse(np.array_equal(picture, elsewhere))
        for wrong in ({"width": 0}, {"height": 10**6}, {"samples": 0}, {"position": [0, np.nan, 0]}, {"target": 3},
                      {"field_of_view": 180}):
            with self.assertRaises(ricochet.InputError):
                simulation.render(**wrong)

    def test_the_scenes_of_the_project_run(self):
        simulation = ricochet.Simulation(ROOT / "scenes" / "bouncing_ball.json")
        simulation.step()
        self.assertEqual(simulation.step_index, 1)


if __name__ == "__main__":
    unittest.main()
