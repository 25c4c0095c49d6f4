import unittest

import numpy as np
import ricochet.trimesh
from support import BOX_FACES, BOX_VERTICES


class Box:
    vertices = BOX_VERTICES
    faces = BOX_FACES


class RayMeshIntersector(unittest.TestCase):
    def setUp(self):
        self.ray = ricochet.trimesh.RayMeshIntersector(Box())
        self.origins = [[-1, 0.25, 0.5], [5, 5, 5]]
        self.directions = [[1, 0, 0], [1, 0, 0]]

    def test_locations_are_those_of_all_hits(self):
        locations, ray, triangle = self.ray.intersects_location(self.origins, self.directions)
        np.testing.assert_array_equal(locations, [[0, 0.25, 0.5], [1, 0.25, 0.5]])
        np.testing.assert_array_equal(ray, [0, 0])
        self.assertEqual(len(triangle), 2)
        locations, ray, triangle = self.ray.intersects_location(self.origins, self.directions, multiple_hits=False)
        np.testing.assert_array_equal(locations, [[0, 0.25, 0.5]])

    def test_the_other_answers_agree(self):
        triangle, ray = self.ray.intersects_id(self.origins, self.directions)
        self.assertEqual(len(triangle), 2)
        triangle, ray, locations = self.ray.intersects_id(
            self.origins, self.directions, return_locations=True, multiple_hits=False
        )
        np.testing.assert_array_equal(self.ray.intersects_first(self.origins, self.directions), [triangle[0], -1])
        np.testing.assert_array_equal(self.ray.intersects_any(self.origins, self.directions), [True, False])
        np.testing.assert_array_equal(self.ray.contains_points([[0.5, 0.5, 0.5], [2, 0, 0]]), [True, False])

    def test_keywords_that_it_does_not_know_are_refused_by_name(self):
        for ask in (self.ray.intersects_id, self.ray.intersects_any, self.ray.intersects_location,
                    self.ray.intersects_first):
            with self.assertRaisesRegex(TypeError, "max_hits"):
                ask(self.origins, self.directions, max_hits=1)

    def test_a_package_that_is_installed_can_use_it(self):
        try:
            import trimesh
        except ImportError:
            self.skipTest("trimesh is not installed")
        mesh = trimesh.creation.icosphere(2)
        mesh.ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(len(mesh.ray.intersects_location([[0, 0, 5]], [[0, 0, -1]])[0]), 2)


if __name__ == "__main__":
    unittest.main()
