import gc
import os
import pickle
import tempfile
import threading
import unittest

import numpy as np
import ricochet
from support import BOX_FACES, BOX_VERTICES, ROOT, ball


def box():
    return ricochet.Mesh(BOX_VERTICES, BOX_FACES)


def rays(count, seed=1):
    random = np.random.default_rng(seed)
    origins = random.uniform(-3, 3, (count, 3))
    return origins, random.uniform(-1, 1, (count, 3)) - origins


class Mesh(unittest.TestCase):
    def test_a_ray_through_a_box_enters_and_leaves(self):
        hits = box().all_hits([[-1, 0.25, 0.5]], [[2, 0, 0]])
        np.testing.assert_array_equal(hits.distance, [1, 2])
        np.testing.assert_array_equal(hits.crossing, [-1, 1])
        np.testing.assert_array_equal(hits.ray, [0, 0])
        np.testing.assert_array_equal(hits.point, [[0, 0.25, 0.5], [1, 0.25, 0.5]])

    def test_a_shared_edge_or_vertex_is_hit_once(self):
        origins = [[-1, 0.5, 0.5], [-1, -1, -1], [-1, 0, 0]]
        directions = [[1, 0, 0], [1, 1, 1], [1, 0, 0]]
        np.testing.assert_array_equal(box().count_hits(origins, directions), [2, 2, 1])

    def test_inside_uses_parity_or_winding_number(self):
        cubes = ricochet.Mesh(
            np.concatenate([BOX_VERTICES, np.array(BOX_VERTICES) + [0.5, 0.25, 0.125]]),
            np.concatenate([BOX_FACES, np.array(BOX_FACES) + len(BOX_VERTICES)]),
        )
        points = np.array([[0.75, 0.6, 0.5], [0.25, 0.6, 0.5], [1.25, 0.6, 0.5], [3, 3, 3]])
        np.testing.assert_array_equal(cubes.inside(points), [False, True, True, False])
        np.testing.assert_array_equal(cubes.inside(points, rule="winding"), [True, True, True, False])
        np.testing.assert_array_equal(cubes.signed_distances(points, "winding") < 0, [True, True, True, False])
        with self.assertRaisesRegex(ricochet.InputError, 'rule: found "nearest", expected "parity" or "winding"'):
            cubes.inside(points, rule="nearest")

    def test_seams_leave_a_mesh_closed(self):
        soup = np.array(BOX_VERTICES)[np.array(BOX_FACES)].reshape(-1, 3)
        mesh = ricochet.Mesh(soup, np.arange(len(soup)).reshape(-1, 3))
        self.assertTrue(mesh.is_closed)
        self.assertEqual(len(mesh.vertices), len(soup))
        np.testing.assert_array_equal(mesh.inside([[0.5, 0.25, 0.5], [2, 2, 2]]), [True, False])

    def test_reading_rotates_scales_and_merges(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "t.obj")
            with open(file, "w") as out:
                out.write("v 0 0 0\nv 100 0 0\nv 0 200 0\nv 0 0 300\nv 0 0 0.001\n")
                out.write("f 1 3 2\nf 5 2 4\nf 2 3 4\nf 1 4 3\n")
            plain = ricochet.Mesh.read(file)
            np.testing.assert_array_equal(plain.bounds[1], [100, 200, 300])
            self.assertFalse(plain.is_closed)
            turned = ricochet.Mesh.read(file, up="y", scale=0.5)
            np.testing.assert_array_equal(turned.bounds, [[0, -150, 0], [50, 0, 100]])
            np.testing.assert_array_equal(ricochet.Mesh.read(file, up="z").vertices, plain.vertices)
            merged = ricochet.Mesh.read(file, scale=0.001, merge=1e-5)
            self.assertTrue(merged.is_closed)
            self.assertEqual(len(merged.vertices), 4)
            self.assertAlmostEqual(merged.volume, 0.001, places=12)
            mirrored = ricochet.Mesh.read(file, scale=[-0.001, 0.002, 0.001], merge=1e-5)
            np.testing.assert_allclose(mirrored.bounds, [[-0.1, 0, 0], [0, 0.4, 0.3]])
            self.assertAlmostEqual(mirrored.volume, 0.002, places=12)  # mirroring keeps the outward winding
            for scale in (0, float("nan"), [1, 2], [1, 0, 1], "mm", "0.5", None, [[1, 2], [3]], True, [[1, 2, 3]], ["1", 1, 1], 1 + 0j):
                with self.assertRaisesRegex(ricochet.InputError, "scale: found .*expected a finite number other than 0"):
                    ricochet.Mesh.read(file, scale=scale)
            for wrong in ({"up": "x"}, {"merge": -1.0}, {"merge": 1e-20}, {"merge": True}, {"scale": [True, 1, 1]}):
                with self.assertRaises(ricochet.InputError):
                    ricochet.Mesh.read(file, **wrong)

    def test_the_volume_counts_repeated_triangles_once_and_adds_nested_shells(self):
        vertices, faces = np.array(BOX_VERTICES, dtype=float), np.array(BOX_FACES)
        one = ricochet.Mesh(vertices, faces).volume
        self.assertEqual(ricochet.Mesh(vertices, np.vstack([faces, faces])).volume, one)
        center = vertices.mean(axis=0)
        both = np.vstack([vertices, center + 0.5 * (vertices - center)])
        nested = ricochet.Mesh(both, np.vstack([faces, faces + len(vertices)]))
        self.assertAlmostEqual(nested.volume, 1.125 * one)
        wall = ricochet.Mesh(both, np.vstack([faces, faces[:, ::-1] + len(vertices)]))
        self.assertAlmostEqual(wall.volume, 0.875 * one)

    def test_a_transform_places_the_mesh_for_one_query(self):
        transform = np.array([[0, -2, 0, 5], [2, 0, 0, -1], [0, 0, 2, 3], [0, 0, 0, 1]], dtype=float)
        corners = np.array(BOX_VERTICES) @ transform[:3, :3].T + transform[:3, 3]
        moved = ricochet.Mesh(corners, BOX_FACES)
        origins, directions = rays(500)
        origins += [4, 0, 4]
        points = origins + 0.3 * directions
        for ask in ("first_hits", "all_hits"):
            found = getattr(box(), ask)(origins, directions, transform=transform)
            known = getattr(moved, ask)(origins, directions)
            np.testing.assert_array_equal(found.triangle, known.triangle)
            np.testing.assert_allclose(found.distance, known.distance, rtol=1e-12)
            np.testing.assert_allclose(found.point, known.point, rtol=1e-12)
        for ask in ("count_hits", "occluded"):
            found = getattr(box(), ask)(origins, directions, transform=transform)
            np.testing.assert_array_equal(found, getattr(moved, ask)(origins, directions))
        np.testing.assert_array_equal(box().inside(points, transform=transform), moved.inside(points))
        np.testing.assert_array_equal(box().winding_numbers(points, transform=transform), moved.winding_numbers(points))
        mirror = np.diag([-1.0, 1, 1, 1])
        self.assertEqual(box().winding_numbers([[-0.5, 0.25, 0.5]], transform=mirror)[0], -1.0)
        distances = box().signed_distances(points, transform=transform)
        np.testing.assert_allclose(distances, moved.signed_distances(points), rtol=1e-12)
        near = box().closest_points(points, within=1.0, transform=transform)
        np.testing.assert_array_equal(near.triangle, moved.closest_points(points, within=1.0).triangle)
        met = box().sweep(origins, points, 0.125, transform=transform)
        np.testing.assert_array_equal(met.triangle, moved.sweep(origins, points, 0.125).triangle)
        met = box().sweep(origins, points, 0.125, vertices_after=corners + 0.5, transform=transform)
        np.testing.assert_array_equal(met.triangle, moved.sweep(origins, points, 0.125, corners + 0.5).triangle)
        for wrong in (np.eye(3), np.diag([1.0, 2, 1, 1]), np.zeros((4, 4)), np.full((4, 4), np.nan), "up"):
            with self.assertRaises((ricochet.InputError, TypeError)):
                box().inside(points, transform=wrong)

    def test_a_miss_has_triangle_minus_one(self):
        hits = box().first_hits([[5, 5, 5]], [[1, 0, 0]])
        self.assertEqual(hits.triangle[0], -1)
        self.assertEqual(hits.distance[0], np.inf)
        self.assertTrue(np.isnan(hits.point).all())

    def test_distances_of_a_ball_agree_with_the_formula(self):
        mesh = ricochet.Mesh(*ball(5))
        self.assertTrue(mesh.is_closed)
        points = np.random.default_rng(2).uniform(-2, 2, (2000, 3))
        height = np.linalg.norm(points, axis=1) - 1
        np.testing.assert_allclose(mesh.signed_distances(points), height, atol=2e-3)
        np.testing.assert_array_equal(mesh.inside(points), mesh.signed_distances(points) < 0)
        nearest = mesh.closest_points(points)
        np.testing.assert_allclose(np.linalg.norm(points - nearest.point, axis=1), nearest.distance, atol=1e-14)
        self.assertTrue((mesh.closest_points(points, within=0.1).triangle < 0).any())

    def test_sweeps_stop_a_radius_before(self):
        hits = box().sweep([[-3, 0.5, 0.4]] * 2, [[1, 0.5, 0.4]] * 2, [0.0, 0.5])
        np.testing.assert_array_equal(hits.distance, [0.75, 0.625])
        moved = box().sweep([[-3, 0.5, 0.4]], [[-3, 0.5, 0.4]], 0.5, BOX_VERTICES - [4, 0, 0])
        np.testing.assert_allclose(moved.distance, [0.625])

    def test_queries_use_moved_vertices_and_arrays_keep_the_old_ones(self):
        mesh = box()
        old = mesh.vertices
        mesh.set_vertices(BOX_VERTICES + [10, 0, 0])
        self.assertFalse(mesh.inside([[0.5, 0.5, 0.5]])[0])
        self.assertTrue(mesh.inside([[10.5, 0.5, 0.5]])[0])
        np.testing.assert_array_equal(old, BOX_VERTICES)
        with self.assertRaises(ValueError):
            old[0, 0] = 1.0
        with self.assertRaises(ricochet.InputError):
            mesh.set_vertices(BOX_VERTICES[:-1])
        self.assertTrue(mesh.inside([[10.5, 0.5, 0.5]])[0])

    def test_arrays_outlive_the_mesh(self):
        mesh = box()
        vertices, faces = mesh.vertices, mesh.faces
        hits = mesh.first_hits(*rays(100))
        kept = hits.distance.copy()
        del mesh
        gc.collect()
        np.testing.assert_array_equal(vertices, BOX_VERTICES)
        np.testing.assert_array_equal(faces, BOX_FACES)
        np.testing.assert_array_equal(hits.distance, kept)

    def test_a_pickled_mesh_gives_results_with_the_same_bits(self):
        mesh = ricochet.Mesh(*ball(3))
        twin = pickle.loads(pickle.dumps(mesh))
        np.testing.assert_array_equal(mesh.first_hits(*rays(1000)).distance, twin.first_hits(*rays(1000)).distance)

    def test_results_do_not_depend_on_threads_or_order(self):
        mesh = ricochet.Mesh(*ball(4))
        origins, directions = rays(5000)
        hits = mesh.first_hits(origins, directions)
        try:
            ricochet.set_threads(1)
            self.assertEqual(ricochet.thread_count(), 1)
            alone = mesh.first_hits(origins[::-1], directions[::-1])
        finally:
            ricochet.set_threads(0)
        for a, b in zip(hits, alone):
            np.testing.assert_array_equal(a, b[::-1])

    def test_any_layout_and_kind_of_number_is_accepted(self):
        mesh = box()
        expected = mesh.first_hits([[-1, 0.25, 0.5]] * 2, [[1, 0, 0]] * 2).distance
        wide = np.zeros((2, 6))
        wide[:, ::2] = [[-1, 0.25, 0.5]] * 2
        read_only = np.array([[1, 0, 0]] * 2, dtype=np.int8)
        read_only.flags.writeable = False
        for origins in (wide[:, ::2], np.asfortranarray(wide[:, ::2]), wide[:, ::2].astype(np.float32),
                        wide[:, ::2].astype(">f8"), wide[::-1, ::2]):
            np.testing.assert_array_equal(mesh.first_hits(origins, read_only).distance, expected)
        for nothing in ([], np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int32)):
            self.assertEqual(len(mesh.first_hits(nothing, nothing).triangle), 0)
            self.assertEqual(len(mesh.all_hits(nothing, nothing).triangle), 0)
            self.assertEqual(len(mesh.inside(nothing)), 0)

    def test_meshes_come_from_files_and_other_packages(self):
        class Trimesh:
            vertices = BOX_VERTICES
            faces = BOX_FACES

        class Meshio:
            points = BOX_VERTICES
            cells_dict = {"triangle": BOX_FACES[:4], "quad": [[0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]}

        for source in (Trimesh(), Meshio(), box()):
            mesh = ricochet.as_mesh(source)
            self.assertTrue(mesh.is_closed)
            self.assertAlmostEqual(mesh.volume, 1.0)
            self.assertAlmostEqual(mesh.area, 6.0)
        self.assertGreater(len(ricochet.as_mesh(ROOT / "meshes" / "bowl.obj")), 100)
        with self.assertRaises(ricochet.InputError):
            ricochet.as_mesh(7)
        with self.assertRaises(ricochet.InputError):
            ricochet.as_mesh(ROOT / "no_such_mesh.obj")

    def test_thousands_of_meshes_live_side_by_side(self):
        meshes = [ricochet.Mesh(BOX_VERTICES + [2.0 * k, 0, 0], BOX_FACES) for k in range(2000)]
        for k in (0, 999, 1999):
            self.assertEqual(meshes[k].first_hits([[-1, 0.25, 0.5]], [[1, 0, 0]]).distance[0], 2.0 * k + 1)

    def test_two_threads_may_query_at_once(self):
        mesh = ricochet.Mesh(*ball(4))
        origins, directions = rays(20000)
        expected = mesh.first_hits(origins, directions).distance
        answers = [None, None]

        def ask(k):
            answers[k] = mesh.first_hits(origins, directions).distance

        threads = [threading.Thread(target=ask, args=(k,)) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for answer in answers:
            np.testing.assert_array_equal(answer, expected)


if __name__ == "__main__":
    unittest.main()
