"""Forces that are Python functions or compiled functions."""

import gc
import importlib.util
import pickle
import unittest
import warnings
import weakref

import numpy as np
import ricochet
from support import bouncing


def oscillators(integrator="rk4", **keys):
    """Returns a scene of two masses, each on a spring to the origin with k = 4 N/m."""
    options = {"time_step": 0.001, "duration": 10.0}
    if integrator is not None:
        options["integrator"] = integrator
    scene = bouncing(forces=[], materials={}, colliders=[], simulation=options,
                     particles=[{"position": [1, 0, 0]}, {"position": [0, 2, 0], "mass": 4.0}])
    return ricochet.Simulation(scene, **keys)


def pull(particles):
    return -4.0 * particles.position


class Forces(unittest.TestCase):
    def test_python_forces_act_on_all_particles_at_once(self):
        seen = []

        def spring(particles):
            seen.append(particles)
            return -4.0 * particles.position

        simulation = oscillators(forces=[spring])
        simulation.run(until=1.0)
        expected = [[np.cos(2.0), 0, 0], [0, 2 * np.cos(1.0), 0]]
        np.testing.assert_allclose(simulation.particles.position, expected, atol=1e-9)
        np.testing.assert_array_equal(seen[0].position, [[1, 0, 0], [0, 2, 0]])  # the force has kept copies of its
                                                                                 # input
        np.testing.assert_array_equal(seen[0].mass, [1, 4])

    def test_a_step_passes_on_the_exception_of_a_force(self):
        def breaks(particles):
            raise KeyError("broken")

        with self.assertRaisesRegex(KeyError, "broken"):
            oscillators(forces=[breaks]).step()
        for wrong in (lambda p: None, lambda p: p.position[:1], lambda p: p.position * np.nan, lambda p: "text",
                      lambda p: p.mass):
            with self.assertRaises(ricochet.InputError):
                oscillators(forces=[wrong]).step()
        with self.assertRaises(ricochet.InputError):
            oscillators(forces=[7])

    def test_error_messages_name_the_force(self):
        def whirl(particles):
            return particles.position * np.nan

        with self.assertRaisesRegex(ricochet.InputError, r"forces\[1\] \(whirl\).*nan.* on particle 0 "):
            oscillators(forces=[pull, whirl]).step()
        with self.assertRaisesRegex(ricochet.InputError, r"forces\[0\] \(<lambda>\).*shape"):
            oscillators(forces=[lambda p: p.mass]).step()
        with self.assertRaisesRegex(ricochet.InputError, r"forces\[0\] \(pull\): integrator: found implicit_euler"):
            oscillators("implicit_euler", forces=[pull])
        for wrong in (7, pull, "pull", [7], ["pull"]):
            with self.assertRaisesRegex(ricochet.InputError, "^forces.*expected a (list of )?function"):
                oscillators(forces=wrong)

    def test_an_acceleration_beyond_doubles_is_refused_with_the_particle(self):
        def huge(particles):
            return np.where(particles.id[:, None] == 1, 1e308, 0.0) * np.ones(3)

        scene = bouncing(forces=[], materials={}, colliders=[],
                         particles=[{"position": [1, 0, 0]}, {"position": [2, 0, 0], "mass": 1e-3}])
        with self.assertRaisesRegex(ricochet.InputError, r"forces\[0\] \(huge\).* on particle 1 of 0.001 kg"):
            ricochet.Simulation(scene, {"simulation.integrator": "rk4"}, forces=[huge]).step()

    def test_the_input_of_a_force_is_read_only(self):
        for name in ("id", "position", "velocity", "mass", "radius"):
            def writes(particles, name=name):
                getattr(particles, name)[0] = 7
                return pull(particles)

            with self.assertRaisesRegex(ValueError, "read-only"):
                oscillators(forces=[writes]).step()

    def test_ballistic_with_forces_warns_that_it_is_velocity_verlet(self):
        with self.assertWarnsRegex(UserWarning, "ballistic moves all particles like velocity_verlet"):
            silent = oscillators(None, forces=[pull])
        self.assertIn("velocity_verlet", silent.warnings[0])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            said = oscillators("velocity_verlet", forces=[pull])
            oscillators("ballistic")
        self.assertEqual(said.warnings, [])
        said.advance(100)
        silent.advance(100)
        self.assertEqual(said.state_hash, silent.state_hash)

    def test_a_simulation_reports_that_an_earlier_step_failed(self):
        def breaks(particles):
            raise KeyError("broken")

        simulation = oscillators(forces=[breaks])
        with self.assertRaises(KeyError):
            simulation.step()
        for call in (simulation.step, simulation.save, lambda: simulation.add_particles([[0, 0, 1.0]]),
                     lambda: simulation.remove_particles([0])):
            with self.assertRaisesRegex(ricochet.RunError, "has ended with an error"):
                call()


    def test_forces_that_refer_to_their_simulation_are_collected_with_it(self):
        class Study:
            def __init__(self):
                self.simulation = oscillators(forces=[self.force])

            def force(self, particles):
                return -4.0 * particles.position

        study = Study()
        study.simulation.step()
        ends = weakref.ref(study)
        particles = study.simulation.particles
        del study
        gc.collect()
        self.assertIsNone(ends())
        self.assertEqual(particles.id.tolist(), [0, 1])
        for _ in range(3):
            unmade = ricochet.Simulation.__new__(ricochet.Simulation)
            gc.collect()
            del unmade


@unittest.skipUnless(importlib.util.find_spec("numba"), "numba is not installed")
class CompiledForces(unittest.TestCase):
    def spring(self):
        def spring(time, position, velocity, mass, radius, force):
            for i in range(len(mass)):
                for k in range(3):
                    force[i, k] = -4.0 * position[i, k]

        return spring

    def test_compiled_forces_give_the_same_bits(self):
        plain = oscillators(forces=[pull])
        plain.run(until=1.0)
        for checked in (True, False):
            compiled = oscillators(forces=[ricochet.compiled_force(self.spring(), check_indices=checked)])
            compiled.run(until=1.0)
            self.assertEqual(compiled.state_hash, plain.state_hash)

    def test_compiled_forces_may_have_more_arguments_with_defaults(self):
        def spring(time, position, velocity, mass, radius, force, stiffness=4.0):
            force[:] = -stiffness * position

        compiled, plain = (oscillators(forces=[f]) for f in (ricochet.compiled_force(spring), pull))
        compiled.step()
        plain.step()
        self.assertEqual(compiled.state_hash, plain.state_hash)

    def test_the_user_may_have_compiled_a_force(self):
        import numba

        compiled = oscillators(forces=[ricochet.compiled_force(numba.njit(self.spring()))])
        compiled.step()

    def test_a_step_passes_on_the_exception_of_a_compiled_force(self):
        def divides(time, position, velocity, mass, radius, force):
            force[0, 0] = 1.0 / (position[0, 1] - position[0, 2])

        def raises(time, position, velocity, mass, radius, force):
            if time > 0.0005:
                raise ValueError("no force today")

        def beyond(time, position, velocity, mass, radius, force):
            force[len(mass), 0] = 1.0

        def astray(time, position, velocity, mass, radius, force):
            force[0, 0] = mass[1000000000]

        for function, error, text in ((divides, ZeroDivisionError, "zero"), (raises, ValueError, "no force today"),
                                      (beyond, IndexError, "bounds"), (astray, IndexError, "bounds")):
            simulation = oscillators(forces=[ricochet.compiled_force(function)])
            with self.assertRaisesRegex(error, text):
                simulation.advance(2)
            with self.assertRaises(ricochet.RunError):
                simulation.step()

    def test_compiled_forces_that_are_not_finite_are_refused(self):
        def nan(time, position, velocity, mass, radius, force):
            force[1, 2] = np.nan

        with self.assertRaisesRegex(ricochet.InputError, r"forces\[0\] \(nan\).* on particle 1 "):
            oscillators(forces=[ricochet.compiled_force(nan)]).step()

    def test_forces_that_do_not_compile_are_refused_with_one_line(self):
        def writes(time, position, velocity, mass, radius, force):
            position[0, 0] = 5.0

        def names(time, position, velocity, mass, radius, force):
            force[0, 0] = not_there  # noqa: F821

        def text(time, position, velocity, mass, radius, force):
            force[0, 0] = "a"

        def answers(time, position, velocity, mass, radius, force):
            return -position

        def few(time, position):
            pass

        for function, said in ((writes, "Cannot modify readonly array"), (names, "not_there"), (text, "setitem"),
                               (answers, "it returns array"), (few, r"found the arguments \(time, position\)"),
                               (7, "found int"), (len, "found builtin_function_or_method"), (None, "found NoneType")):
            with self.assertRaisesRegex(ricochet.InputError, said) as caught:
                ricochet.compiled_force(function)
            self.assertNotIn("\n", str(caught.exception))
            self.assertNotIn("\x1b", str(caught.exception))
            self.assertTrue(str(caught.exception).startswith("compiled_force: "))


class States(unittest.TestCase):
    def test_simulations_with_other_forces_refuse_a_state(self):
        def drag(particles):
            return -0.1 * particles.velocity

        plain = bouncing()
        lighter = bouncing(forces=[{"type": "gravity", "acceleration": [0, 0, -1.62]}])
        numbers = bouncing(forces=[{"acceleration": np.array([0.0, 0.0, -9.81]), "type": "gravity"}])
        cases = {"plain": (plain, []), "lighter": (lighter, []), "pull": (plain, [pull]), "drag": (plain, [drag]),
                 "both": (plain, [pull, drag])}
        made = {name: ricochet.Simulation(scene, {"simulation.integrator": "rk4"}, forces=forces)
                for name, (scene, forces) in cases.items()}
        for name, simulation in made.items():
            simulation.advance(3)
            state = simulation.save()
            for other, target in made.items():
                if other == name:
                    target.restore(state)
                    continue
                before = target.state_hash
                with self.assertRaisesRegex(ricochet.InputError, "^restore: found a state made under") as caught:
                    target.restore(state)
                self.assertNotIn("\n", str(caught.exception))
                target.step()  # the failed restore() has not changed the simulation
                self.assertNotEqual(before, target.state_hash)
        simulation = ricochet.Simulation(numbers, {"simulation.integrator": "rk4", "simulation.duration": 3.0})
        simulation.restore(made["plain"].save())

    def test_bytes_that_are_not_a_state_leave_a_simulation_unchanged(self):
        simulation = ricochet.Simulation(bouncing())
        simulation.advance(5)
        state = simulation.save()
        middle = len(state) // 2
        damaged = state[:middle] + bytes([state[middle] ^ 1]) + state[middle + 1:]
        for wrong, said in ((state + b"x", "1 bytes behind the end"), (state + state, "bytes behind the end"),
                            (state[:-1], "ends too early"), (damaged, "checksum"), (b"", "expected the result"),
                            (b"x" * 500, "expected the result")):
            with self.assertRaisesRegex(ricochet.InputError, said):
                simulation.restore(wrong)
            simulation.step()
        for kind in (bytes, bytearray, memoryview):
            simulation.step()
            simulation.restore(kind(state))
            self.assertEqual(simulation.step_index, 5)


class Pickles(unittest.TestCase):
    def test_pickles_keep_the_forces(self):
        simulation = oscillators(forces=[pull])
        simulation.advance(5)
        twin = pickle.loads(pickle.dumps(simulation))
        twin.step()
        simulation.step()
        self.assertEqual(twin.state_hash, simulation.state_hash)


if __name__ == "__main__":
    unittest.main()
