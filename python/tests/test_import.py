"""Importing the package loads few modules. Other tests measure the time of the import."""

import subprocess
import sys
import unittest

HEAVY = ["tqdm", "scipy", "numba", "trimesh", "matplotlib", "pandas", "IPython"]


class Import(unittest.TestCase):
    def test_importing_loads_numpy_and_no_other_large_module(self):
        code = f"import ricochet, sys; print([name for name in {HEAVY!r} if name in sys.modules])"
        loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(loaded.stdout.strip(), "[]")


if __name__ == "__main__":
    unittest.main()
