"""Ctrl-C ends queries and pictures."""

import os
import subprocess
import sys
import unittest

# Program that makes a query of several seconds and sends itself SIGINT after 0.1 s.
ASKS = """
import _thread, os, signal, sys, threading, time
import numpy as np
import ricochet
sys.path.insert(0, sys.argv[1])
from support import ball, bouncing
what = sys.argv[2]
vertices, faces = ball(5)
mesh = ricochet.Mesh(vertices, faces)
open_mesh = ricochet.Mesh(vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)[::2])
count = 3_000_000
ricochet.set_threads(2)
points = np.broadcast_to([[0.1, 0.2, 0.3]], (count, 3)).copy()
middle = np.zeros((200_000, 3))
ways = np.broadcast_to([[5.0, 5.0, 5.0]], (count, 3))
around = np.zeros((4000, 3))
questions = {
    "first_hits": lambda: mesh.first_hits(points, [1, 2, 3]),
    "all_hits": lambda: mesh.all_hits(points, [1, 2, 3]),
    "count_hits": lambda: mesh.count_hits(points, [1, 2, 3]),
    "occluded": lambda: mesh.occluded(points, [1, 2, 3]),
    "inside": lambda: mesh.inside(points),
    "winding_numbers": lambda: open_mesh.winding_numbers(points[:200_000]),
    "closest_points": lambda: mesh.closest_points(middle),
    "signed_distances": lambda: mesh.signed_distances(middle),
    "sweep": lambda: mesh.sweep(points, ways, 0.01),
    "sweep_moving": lambda: mesh.sweep(around, around, 0.5, vertices * 0.4),
    "render": lambda: ricochet.Simulation(bouncing()).render(800, 800, 4096),
    "trimesh": lambda: ricochet.trimesh.RayMeshIntersector(mesh).intersects_id(points, np.ones((count, 3))),
}
sent = []
def interrupt():
    time.sleep(0.1)
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
try:
    questions[what]()
    print("was not interrupted")
except KeyboardInterrupt:
    print(f"interrupted {time.monotonic() - sent[0]:.3f}")
print(mesh.inside([[0.1, 0.2, 0.3]])[0])
"""

QUESTIONS = ("first_hits", "all_hits", "count_hits", "occluded", "inside", "winding_numbers", "closest_points",
             "signed_distances", "sweep", "sweep_moving", "render", "trimesh")


class CtrlC(unittest.TestCase):
    def test_ctrl_c_ends_every_query_and_keeps_the_mesh_intact(self):
        for what in QUESTIONS:
            with self.subTest(what):
                asked = subprocess.run([sys.executable, "-W", "ignore", "-c", ASKS, os.path.dirname(__file__), what],
                                       capture_output=True, text=True, timeout=250)
                self.assertEqual(asked.returncode, 0, asked.stderr)
                said = asked.stdout.split()
                self.assertEqual((said[0], said[2]), ("interrupted", "True"), asked.stdout)
                if os.environ.get("RICOCHET_SHOW_TIMES"):
                    print(what, said[1])


if __name__ == "__main__":
    unittest.main()
