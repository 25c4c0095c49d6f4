"""Checks the package and its stubs with a type checker."""

import ast
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import ricochet
from ricochet import _core
from support import ROOT

USE = """
import numpy as np
import ricochet
from ricochet import scene
from ricochet.trimesh import RayMeshIntersector

mesh = ricochet.Mesh(np.zeros((3, 3)), [[0, 1, 2]])
hits = mesh.first_hits([[0, 0, 1]], [[0, 0, -1]])
distance: float = float(hits.distance[0])
simulation = ricochet.Simulation(scene.Scene(simulation=scene.SimulationOptions(time_step=0.01)))
simulation.run(until=1.0)
total: float = float(simulation.particles.position.sum())
ray = RayMeshIntersector(mesh)
"""

WRONG = """
from ricochet import scene
scene.Material(restitutoin=0.5)
"""


class Stub(unittest.TestCase):
    def test_the_stub_of_the_compiled_module_is_complete(self):
        stub = ast.parse((Path(ricochet.__file__).parent / "_core.pyi").read_text(encoding="utf-8"))
        for entry in stub.body:
            if isinstance(entry, ast.ClassDef) and entry.name in ("Mesh", "Simulation"):
                named = {method.name for method in entry.body if isinstance(method, ast.FunctionDef)}
                names = vars(getattr(_core, entry.name))
                there = {name for name in names if not name.startswith(("__", "_pybind11"))}
                self.assertEqual({name for name in named if not name.startswith("__")}, there)
        named = {entry.name for entry in stub.body if isinstance(entry, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual({name for name in named if not name.startswith("_")},
                         {name for name in vars(_core) if not name.startswith("_")})


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Types(unittest.TestCase):
    def check(self, *arguments):
        environment = dict(os.environ, MYPYPATH=str(Path(ricochet.__file__).parents[1]))
        with tempfile.TemporaryDirectory() as cache:
            return subprocess.run(
                [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), "--cache-dir", cache,
                 *arguments],
                env=environment, capture_output=True, text=True,
            )

    def test_the_package_and_its_stubs_are_sound(self):
        checked = self.check("-p", "ricochet")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_right_uses_pass_and_typos_do_not(self):
        checked = self.check("-c", USE)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        checked = self.check("-c", WRONG)
        self.assertIn("restitutoin", checked.stdout)


if __name__ == "__main__":
    unittest.main()
