"""Tests in a clean virtual environment: installation, the README's example, and the time of the import."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT


class Package(unittest.TestCase):
    def test_package_installs_into_a_clean_environment_and_runs_the_readme(self):
        environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "LD_PRELOAD")}
        with tempfile.TemporaryDirectory() as folder:
            python = str(Path(folder) / "environment" / "bin" / "python")

            def call(*command):
                done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                return done.stdout

            call(sys.executable, "-m", "venv", "--system-site-packages", str(Path(folder) / "environment"))
            call(python, "-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation", ".")
            where = call(python, "-c", "import ricochet; print(ricochet.__file__, ricochet.__version__)")
            self.assertIn(folder, where)
            self.assertIn("0.", where)
            readme = (ROOT / "README.md").read_text(encoding="utf-8")
            for example in re.findall(r"```python\n(.*?)```", readme, re.DOTALL):
                self.assertTrue(call(python, "-c", example))


if __name__ == "__main__":
    unittest.main()
