"""Runs the notebooks cell by cell, and the examples in the documents."""

import contextlib
import io
import json
import os
import re
import unittest

from support import ROOT


def run(sources, name):
    space = {"__name__": "__main__"}
    for number, source in enumerate(sources):
        exec(compile(source, f"{name}, cell {number}", "exec"), space)


class Notebooks(unittest.TestCase):
    def setUp(self):
        self.folder = os.getcwd()
        os.chdir(ROOT)

    def tearDown(self):
        os.chdir(self.folder)

    def notebook(self, name):
        text = json.loads((ROOT / "python" / "notebooks" / name).read_text(encoding="utf-8"))
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            run(("".join(cell["source"]) for cell in text["cells"] if cell["cell_type"] == "code"), name)
        return printed.getvalue()

    def test_the_first_scene_runs(self):
        self.assertIn("500 balls", self.notebook("first_scene.ipynb"))

    def test_the_bouncing_ball_runs(self):
        self.assertIn("order of symplectic Euler", self.notebook("bouncing_ball.ipynb"))

    def test_molecules_in_a_tube_run(self):
        self.assertIn("Clausing 0.6720", self.notebook("clausing.ipynb"))

    def test_the_examples_of_the_documents_run(self):
        for document in ("README.md", "docs/python.md", "docs/python-queries.md"):
            examples = re.findall(r"```python\n(.*?)```", (ROOT / document).read_text(encoding="utf-8"), re.DOTALL)
            self.assertTrue(examples, document)
            for example in examples:
                with contextlib.redirect_stdout(io.StringIO()) as printed:
                    run([example], document)
                self.assertTrue(printed.getvalue())


if __name__ == "__main__":
    unittest.main()
