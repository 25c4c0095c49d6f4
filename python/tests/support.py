"""Small meshes, and the folder of the project, for all tests."""

import os
from pathlib import Path

import numpy as np

ROOT = Path(os.environ.get("RICOCHET_SOURCE_DIR", Path(__file__).resolve().parents[2]))

BOX_VERTICES = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
BOX_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)


def ball(levels=3):
    """Returns a mesh of the unit sphere: an octahedron with subdivided triangles, whose vertices are moved onto the
    sphere."""
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(levels):
        corners = vertices[faces]
        middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
        a, b, c = (corners[:, k] for k in range(3))
        ab, bc, ca = (middles[:, k] for k in range(3))
        soup = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        soup /= np.linalg.norm(soup, axis=2, keepdims=True)
        vertices, inverse = np.unique(soup.reshape(-1, 3).round(15), axis=0, return_inverse=True)
        faces = inverse.reshape(-1, 3)
    return vertices, faces


def bouncing(**changes):
    """Returns a scene with balls above a floor."""
    scene = {
        "ricochet": 1,
        "simulation": {"time_step": 0.01, "duration": 2.0},
        "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
        "materials": {"rubber": {"restitution": 0.8}},
        "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
                       "material": "rubber"}],
        "particles": [{"position": [0, 0, 1], "radius": 0.1}, {"position": [1, 0, 2], "velocity": [1, 0, 0]}],
    }
    scene.update(changes)
    return scene
