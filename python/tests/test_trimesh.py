import copy
import pickle
import types
import unittest

import numpy as np
import ricochet.trimesh
from support import BOX_FACES, BOX_VERTICES, ball


class Box:
    vertices = BOX_VERTICES
    faces = BOX_FACES


class Tracked(np.ndarray):
    """An array with a hash of its content, like trimesh's arrays."""

    def __hash__(self):
        return hash(self.tobytes())


def own(vertices=BOX_VERTICES, faces=BOX_FACES):
    return types.SimpleNamespace(vertices=np.array(vertices), faces=np.array(faces))


class RayMeshIntersector(unittest.TestCase):
    def setUp(self):
        self.ray = ricochet.trimesh.RayMeshIntersector(Box())
        self.origins = [[-1, 0.25, 0.5], [5, 5, 5]]
        self.directions = [[1, 0, 0], [1, 0, 0]]

    def test_locations_are_returned_for_all_hits(self):
        locations, ray, triangle = self.ray.intersects_location(self.origins, self.directions)
        np.testing.assert_array_equal(locations, [[0, 0.25, 0.5], [1, 0.25, 0.5]])
        np.testing.assert_array_equal(ray, [0, 0])
        self.assertEqual(len(triangle), 2)
        locations, ray, triangle = self.ray.intersects_location(self.origins, self.directions, multiple_hits=False)
        np.testing.assert_array_equal(locations, [[0, 0.25, 0.5]])

    def test_the_other_methods_agree_with_the_locations(self):
        triangle, ray = self.ray.intersects_id(self.origins, self.directions)
        self.assertEqual(len(triangle), 2)
        triangle, ray, locations = self.ray.intersects_id(
            self.origins, self.directions, return_locations=True, multiple_hits=False
        )
        np.testing.assert_array_equal(self.ray.intersects_first(self.origins, self.directions), [triangle[0], -1])
        np.testing.assert_array_equal(self.ray.intersects_any(self.origins, self.directions), [True, False])
        np.testing.assert_array_equal(self.ray.contains_points([[0.5, 0.5, 0.5], [2, 0, 0]]), [True, False])

    def test_unknown_keywords_are_refused_by_name(self):
        for ask in (self.ray.intersects_id, self.ray.intersects_any, self.ray.intersects_location,
                    self.ray.intersects_first):
            with self.assertRaisesRegex(TypeError, "max_hits"):
                ask(self.origins, self.directions, max_hits=1)

    def test_an_object_that_is_not_a_mesh_is_refused_at_once(self):
        for nothing in (7, None, [], object()):
            with self.assertRaisesRegex(ricochet.InputError, "^mesh: found"):
                ricochet.trimesh.RayMeshIntersector(nothing)

    def test_an_installed_trimesh_can_use_it(self):
        try:
            import trimesh
        except ImportError:
            self.skipTest("trimesh is not installed")
        mesh = trimesh.creation.icosphere(2)
        mesh.ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(len(mesh.ray.intersects_location([[0, 0, 5]], [[0, 0, -1]])[0]), 2)
        mesh.apply_translation([10, 0, 0])
        self.assertEqual(len(mesh.ray.intersects_location([[0, 0, 5]], [[0, 0, -1]])[0]), 0)
        self.assertEqual(list(mesh.contains([[0, 0, 0], [10, 0, 0]])), [False, True])

    def test_copies_of_triangles_do_not_change_what_an_open_mesh_contains(self):
        cup = own()
        cup.faces = cup.faces[2:]
        points = np.random.default_rng(5).uniform(-1, 2, (500, 3))
        inside = ricochet.trimesh.RayMeshIntersector(cup).contains_points(points)
        self.assertTrue(0 < inside.sum() < len(points))
        copies = np.roll(cup.faces, 1, axis=1) + len(cup.vertices)
        twice = own(np.vstack([cup.vertices, cup.vertices]), np.vstack([cup.faces, copies]))
        self.assertEqual(list(ricochet.trimesh.RayMeshIntersector(twice).contains_points(points)), list(inside))



class Following(unittest.TestCase):
    def both(self, ray):
        return list(ray.intersects_any([[0.25, 0.5, 5], [10.25, 0.5, 5]], [[0, 0, -1]] * 2))

    def test_replaced_vertices_are_followed(self):
        mesh = own()
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(self.both(ray), [True, False])
        mesh.vertices = mesh.vertices + [10, 0, 0]
        self.assertEqual(self.both(ray), [False, True])
        self.assertEqual(list(ray.contains_points([[0.5, 0.5, 0.5], [10.5, 0.5, 0.5]])), [False, True])

    def test_vertices_and_faces_changed_in_place_are_followed(self):
        for kind in (np.ndarray, Tracked):
            mesh = own()
            mesh.vertices, mesh.faces = mesh.vertices.view(kind), mesh.faces.view(kind)
            ray = ricochet.trimesh.RayMeshIntersector(mesh)
            self.assertEqual(self.both(ray), [True, False])
            mesh.vertices[:, 0] += 10
            self.assertEqual(self.both(ray), [False, True])
            mesh.faces[:] = mesh.faces[0]
            self.assertEqual(self.both(ray), [False, False])
            self.assertFalse(ray.contains_points([[10.5, 0.5, 0.5]])[0])

    def test_a_mesh_may_get_its_faces_later(self):
        mesh = own(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(self.both(ray), [False, False])
        self.assertEqual(list(ray.intersects_first([[0, 0, 5]], [[0, 0, -1]])), [-1])
        self.assertEqual([len(a) for a in ray.intersects_location([[0, 0, 5]], [[0, 0, -1]])], [0, 0, 0])
        self.assertFalse(ray.contains_points([[0.5, 0.5, 0.5]])[0])
        mesh.vertices, mesh.faces = BOX_VERTICES, BOX_FACES
        self.assertEqual(self.both(ray), [True, False])
        mesh.faces = BOX_FACES[:0]
        self.assertEqual(self.both(ray), [False, False])

    def test_the_constructor_of_a_mesh_may_make_the_intersector(self):
        class Mesh:
            def __init__(self):
                self.ray = ricochet.trimesh.RayMeshIntersector(self)
                self._vertices = BOX_VERTICES

            vertices = property(lambda self: self._vertices)
            faces = BOX_FACES

        self.assertEqual(self.both(Mesh().ray), [True, False])

    def test_results_after_many_changes_equal_a_new_mesh(self):
        random = np.random.default_rng(7)
        vertices, faces = ball(2)
        mesh = own(vertices, faces)
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        origins, directions = random.uniform(-2, 2, (300, 3)), random.uniform(-1, 1, (300, 3))
        for turn in range(20):
            mesh.vertices = vertices * random.uniform(0.3, 2, 3) + random.uniform(-1, 1, 3)
            if turn % 5 == 4:
                mesh.faces = random.permutation(faces)[:400]
            new = ricochet.trimesh.RayMeshIntersector(own(mesh.vertices, mesh.faces))
            for a, b in zip(ray.intersects_location(origins, directions), new.intersects_location(origins, directions)):
                np.testing.assert_array_equal(a, b)
            np.testing.assert_array_equal(ray.contains_points(origins), new.contains_points(origins))

    def test_copies_and_pickles_follow_too(self):
        mesh = own()
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.both(ray)
        for twin in (copy.copy(ray), copy.deepcopy(ray)):
            self.assertIs(twin.mesh, mesh)
            self.assertEqual(self.both(twin), [True, False])
        twin = pickle.loads(pickle.dumps(ray))
        twin.mesh.vertices += [10, 0, 0]
        self.assertEqual(self.both(twin), [False, True])


class Containment(unittest.TestCase):
    def test_containment_in_an_open_mesh_uses_winding_numbers(self):
        vertices, faces = ball(3)
        middles = vertices[faces].mean(axis=1)
        open_faces = faces[middles[:, 2] < 0.8]
        points = np.random.default_rng(3).uniform(-1.2, 1.2, (3000, 3))
        closed = ricochet.trimesh.RayMeshIntersector(own(vertices, faces)).contains_points(points)
        for turned in (open_faces, open_faces[:, ::-1]):
            found = ricochet.trimesh.RayMeshIntersector(own(vertices, turned)).contains_points(points)
            below = points[:, 2] < 0.3  # away from the hole
            np.testing.assert_array_equal(found[below], closed[below])
            self.assertFalse(found[points[:, 2] > 1.0].any())

    def test_triangles_without_shared_vertices_contain_like_the_closed_mesh(self):
        vertices, faces = ball(3)
        soup = own(vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3))
        points = np.random.default_rng(4).uniform(-1.2, 1.2, (3000, 3))
        np.testing.assert_array_equal(ricochet.trimesh.RayMeshIntersector(soup).contains_points(points),
                                      ricochet.Mesh(vertices, faces).inside(points))

    def test_a_cavity_is_outside(self):
        inner = 0.25 + 0.5 * BOX_VERTICES
        mesh = own(np.concatenate([BOX_VERTICES, inner]), np.concatenate([BOX_FACES, BOX_FACES[:, ::-1] + 8]))
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(list(ray.contains_points([[0.5, 0.5, 0.5], [0.1, 0.5, 0.5]])), [False, True])


class InThePlane(unittest.TestCase):
    """trimesh ignores triangles that are parallel to a ray."""

    def hits(self, mesh, origin, direction):
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        counts = {len(ray.intersects_id([origin], [direction])[0])}
        first = ray.intersects_first([origin], [direction])[0] >= 0
        self.assertEqual(ray.intersects_any([origin], [direction])[0], first)
        self.assertEqual(len(ray.intersects_location([origin], [direction], multiple_hits=False)[0]), int(first))
        self.assertEqual(counts.pop() > 0, first)
        return bool(first)

    def test_a_ray_along_a_plate_hits_nothing(self):
        plate = own([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
        self.assertFalse(self.hits(plate, [-1, 0.25, 0], [1, 0, 0]))
        self.assertFalse(self.hits(plate, [0.5, 0.25, 0], [1, 3, 0]))
        self.assertTrue(self.hits(plate, [0.5, 0.25, 0], [0, 0, 1]))
        self.assertTrue(self.hits(plate, [-1, 0.25, 1e-9], [1, 0, -1e-9]))
        askew = np.array([[3, 1, -2], [-7, 5, 1], [2, 2, 9]])
        plate.vertices = plate.vertices @ askew
        self.assertFalse(self.hits(plate, [-1, 0.25, 0] @ askew, askew[0]))

    def test_a_ray_along_a_side_of_a_box_hits_the_box(self):
        self.assertTrue(self.hits(Box(), [0, 0.5, 5], [0, 0, -1]))
        self.assertTrue(self.hits(Box(), [0, 0, 5], [0, 0, -1]))

    def test_a_surface_behind_the_plate_is_hit_first(self):
        mesh = own([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, -1, -1], [3, 1, -1], [3, 0, 1]], [[0, 1, 2], [3, 4, 5]])
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        self.assertEqual(list(ray.intersects_first([[-1, 0.25, 0], [0.2, 0.2, 1]], [[1, 0, 0], [0, 0, -1]])), [1, 0])
        point, index, triangle = ray.intersects_location([[-1, 0, 0]], [[1, 0, 0]], multiple_hits=False)
        np.testing.assert_array_equal(point, [[3, 0, 0]])


if __name__ == "__main__":
    unittest.main()
