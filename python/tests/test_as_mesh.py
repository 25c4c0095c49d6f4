"""Meshes of other packages, names of triangles, and arguments of queries."""

import pickle
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
import ricochet
from ricochet import _simulation
from support import BOX_FACES, BOX_VERTICES, ROOT, bouncing


def cells(points, **blocks):
    """Returns a mesh in the form of meshio, with the blocks of cells in the given order."""
    blocks = [types.SimpleNamespace(type=kind, data=data) for kind, data in blocks.items()]
    return types.SimpleNamespace(points=np.array(points, dtype=float), cells=blocks)


def grid(order):
    """Returns points on a unit square in order + 1 rows of order + 1 points."""
    steps = np.arange(order + 1) / order
    return np.array([[x, y, 0.0] for y in steps for x in steps])


def quad_nodes(order):
    """Returns the nodes of one quad in meshio's order: corners, nodes on the edges, inner nodes."""
    n = order + 1
    at = lambda x, y: y * n + x  # noqa: E731
    inner = range(1, order)
    nodes = [at(0, 0), at(order, 0), at(order, order), at(0, order)]
    nodes += [at(x, 0) for x in inner] + [at(order, y) for y in inner]
    nodes += [at(x, order) for x in reversed(inner)] + [at(0, y) for y in reversed(inner)]
    return nodes + [at(x, y) for y in inner for x in inner]


def triangle_nodes(order):
    n = order + 1
    at = lambda x, y: y * n + x  # noqa: E731
    inner = range(1, order)
    nodes = [at(0, 0), at(order, 0), at(0, order)]
    nodes += [at(x, 0) for x in inner] + [at(order - k, k) for k in inner] + [at(0, y) for y in reversed(inner)]
    return nodes + [at(x, y) for y in inner for x in inner if x + y < order]


class Meshio(unittest.TestCase):
    def test_concave_quads_are_cut_inside(self):
        dart = [[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]]
        for turn in range(4):
            mesh = ricochet.as_mesh(cells(dart, quad=[np.roll([3, 0, 1, 2], turn)]))
            self.assertEqual((len(mesh), mesh.area), (2, 1.0))

    def test_polygons_may_have_any_number_of_corners(self):
        star = np.array([[np.cos(a) * r, np.sin(a) * r, 0] for a, r in
                         zip(np.arange(10) * np.pi / 5, [2, 0.7] * 5)])
        area = 0.5 * np.abs(np.cross(star, np.roll(star, -1, axis=0)).sum(axis=0)[2])
        for kind in ("polygon", "polygon10"):
            mesh = ricochet.as_mesh(cells(star, **{kind: [list(range(10))]}))
            self.assertEqual(len(mesh), 8)
            self.assertAlmostEqual(mesh.area, area)
        ragged = [np.array([0, 1, 2]), np.array([3, 4, 5, 6, 7])]
        self.assertEqual(len(ricochet.as_mesh(cells(star, polygon=ragged))), 4)

    def test_a_surface_of_several_kinds_is_closed(self):
        prism = [[np.cos(k * np.pi / 3), np.sin(k * np.pi / 3), z] for z in (0.0, 1.0) for k in range(6)]
        sides = [[k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k] for k in range(6)]
        mesh = ricochet.as_mesh(cells(prism, polygon=[[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]], quad=sides))
        self.assertEqual((len(mesh), mesh.is_closed), (20, True))
        self.assertAlmostEqual(mesh.volume, 1.5 * 3**0.5)

    def test_cells_of_higher_orders_fill_their_outline(self):
        for order in range(1, 6):
            points = grid(order)
            kinds = {f"quad{(order + 1) ** 2}": quad_nodes(order)}
            if order == 1:
                kinds = {"quad": quad_nodes(1)}
            if order == 2:
                kinds["quad8"] = quad_nodes(2)[:8]
            count = (order + 1) * (order + 2) // 2
            kinds["triangle" if order == 1 else f"triangle{count}"] = triangle_nodes(order)
            for kind, nodes in kinds.items():
                mesh = ricochet.as_mesh(cells(points, **{kind: [nodes]}))
                self.assertAlmostEqual(mesh.area, 1.0 if kind.startswith("quad") else 0.5, msg=kind)
                corners = mesh.vertices[mesh.faces]
                normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
                self.assertTrue((normals[:, 2] > 0).all(), kind)
                on_edges = set(nodes[: (4 if kind.startswith("quad") else 3) * order])
                self.assertLessEqual(on_edges, set(mesh.faces.ravel().tolist()), kind)

    def test_a_node_in_the_middle_is_a_corner_of_the_surface(self):
        for kind, nodes in (("quad9", quad_nodes(2)), ("triangle10", triangle_nodes(3))):
            points = grid(2 if kind == "quad9" else 3)
            points[nodes[-1], 2] = 0.25
            mesh = ricochet.as_mesh(cells(points, **{kind: [nodes]}))
            self.assertEqual(mesh.bounds[1, 2], 0.25)
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0.3, 0.3, 0.2]])
        mesh = ricochet.as_mesh(cells(points, triangle7=[[0, 1, 2, 3, 4, 5, 6]]))
        self.assertEqual((len(mesh), mesh.bounds[1, 2]), (6, 0.2))

    def test_quads_of_vtk_may_list_their_edges_in_another_order(self):
        nodes = quad_nodes(3)
        nodes[8:12] = nodes[8:10][::-1] + nodes[10:12][::-1]
        mesh = ricochet.as_mesh(cells(grid(3), VTK_LAGRANGE_QUADRILATERAL=[nodes]))
        self.assertAlmostEqual(mesh.area, 1.0)

    def test_other_cells_are_refused_by_name_or_ignored_by_name(self):
        triangle = [[0, 1, 2]]
        points = np.eye(4, 3)
        for kind, data in (("line", [[0, 1]]), ("vertex", [[0]]), ("tetra", [[0, 1, 2, 3]]), ("hexahedron27", [[0] * 27]),
                           ("triangles", triangle)):
            with self.assertRaisesRegex(ricochet.InputError, rf"^mesh: found cells {kind}, .*ignore=\['{kind}'\]"):
                ricochet.as_mesh(cells(points, **{kind: data, "triangle": triangle}))
            self.assertEqual(len(ricochet.as_mesh(cells(points, **{kind: data, "triangle": triangle}), ignore=[kind])), 1)
        self.assertEqual(len(ricochet.as_mesh(cells(points, line=[[0, 1]], triangle=triangle), ignore="line")), 1)
        with self.assertRaisesRegex(ricochet.InputError, "found cells line, expected triangles"):
            ricochet.as_mesh(cells(points, line=[[0, 1]]), ignore="line")
        with self.assertRaisesRegex(ricochet.InputError, "triangle5 with 5 nodes"):
            ricochet.as_mesh(cells(points, triangle5=[[0, 1, 2, 3, 3]]))
        with self.assertRaisesRegex(ricochet.InputError, "cells"):
            ricochet.as_mesh(cells(points, quad=[[0, 1, 2, 9]]))

    def test_meshes_of_the_meshio_package_are_read(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        mesh = ricochet.as_mesh(meshio.Mesh(BOX_VERTICES, [("triangle", BOX_FACES[:4]), ("quad", [[0, 4, 5, 1]]),
                                                           ("triangle", BOX_FACES[6:])]))
        self.assertEqual((len(mesh), mesh.is_closed), (12, True))
        from meshio._mesh import topological_dimension

        for kind, dimension in topological_dimension.items():
            refused = ricochet._mesh._SURFACE_CELLS.fullmatch(kind) is None
            self.assertEqual(refused, dimension != 2, kind)


class Names(unittest.TestCase):
    def scene(self, mesh, **collider):
        materials = {"soft": {"restitution": 0.0}, "hard": {"restitution": 1.0}, "7": {"restitution": 0.5}}
        return bouncing(
            materials=materials, colliders=[{"name": "plate", "type": "mesh", "file": mesh, "material": "soft", **collider}],
            particles=[{"position": [x, 0.1, 1.0]} for x in (-0.5, 0.5)])

    def rebounds(self, scene):
        """Returns for each of the two particles whether it leaves the plate upward."""
        simulation = ricochet.Simulation(scene, contacts=True)
        simulation.run(until=0.6)
        contacts = simulation.take_contacts()
        return [bool(contacts[contacts["particle"] == k]["velocity_after"][0, 2] > 0.1) for k in range(2)]

    def plate(self):
        return ricochet.Mesh([[-1, -1, 0], [0, -1, 0], [0, 1, 0], [-1, 1, 0], [1, -1, 0], [1, 1, 0]],
                             [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])

    def test_materials_name_materials_of_the_scene(self):
        mesh = self.plate()
        self.assertIsNone(mesh.materials)
        self.assertEqual(self.rebounds(self.scene(mesh)), [False, False])
        mesh.materials = np.array(["soft", "soft", "hard", "hard"])
        self.assertEqual(self.rebounds(self.scene(mesh)), [False, True])
        mesh.materials = ["hard", "hard", "", ""]
        self.assertEqual(self.rebounds(self.scene(mesh)), [True, False])
        mesh.materials = [7, 7, 7, 7]
        self.assertEqual(self.rebounds(self.scene(mesh)), [True, True])
        self.assertEqual(self.rebounds(self.scene(mesh, group_materials={"7": "soft"})), [False, False])
        mesh.materials = None
        self.assertEqual(self.rebounds(self.scene(mesh)), [False, False])

    def test_an_unknown_material_of_a_mesh_is_refused_by_the_name_of_the_array(self):
        mesh = self.plate()
        mesh.materials = ["soft", "nomat", "hard", "hard"]
        with self.assertRaisesRegex(ricochet.InputError, r"colliders\[0\]\.file: the mesh's `materials` have .*'nomat'"):
            ricochet.Simulation(self.scene(mesh))
        self.assertEqual(self.rebounds(self.scene(mesh, group_materials={"nomat": "hard"})), [True, True])

    def test_groups_get_their_group_materials(self):
        mesh = self.plate()
        mesh.groups = np.array([1, 1, 2, 2])
        np.testing.assert_array_equal(mesh.groups, ["1", "1", "2", "2"])
        self.assertEqual(self.rebounds(self.scene(mesh, group_materials={"2": "hard"})), [False, True])
        mesh.groups = ["left part", "left part", "right", "right"]
        self.assertEqual(self.rebounds(self.scene(mesh, group_materials={"left part": "hard"})), [True, False])
        mesh.materials = ["soft", "", "", ""]
        mesh.groups = ["right"] * 4
        self.assertEqual(self.rebounds(self.scene(mesh, group_materials={"right": "hard"})), [True, True])

    def test_triangles_keep_their_order(self):
        mesh = self.plate()
        mesh.materials = ["hard", "soft", "hard", "soft"]
        simulation = ricochet.Simulation(self.scene(mesh))
        np.testing.assert_array_equal(simulation.collider_mesh("plate").faces, mesh.faces)
        np.testing.assert_array_equal(simulation.collider_mesh("plate").vertices, mesh.vertices)

    def test_names_stay_with_the_mesh(self):
        mesh = self.plate()
        mesh.materials, mesh.groups = ["soft", "soft", "hard", "hard"], [1, 2, 3, 4]
        mesh.set_vertices(mesh.vertices + [0, 0, 0.25])
        twin = pickle.loads(pickle.dumps(mesh))
        for name in ("groups", "materials"):
            np.testing.assert_array_equal(getattr(twin, name), getattr(mesh, name))
        self.assertEqual(self.rebounds(self.scene(twin)), [False, True])
        simulation = pickle.loads(pickle.dumps(ricochet.Simulation(self.scene(mesh), contacts=True)))
        simulation.run(until=0.6)
        self.assertEqual(simulation.statistics["contacts"] > 0, True)
        with self.assertRaises(ValueError):
            mesh.materials[0] = "hard"

    def test_every_name_that_an_obj_line_gives_back_is_usable(self):
        for name in ("steel#1", "left  right", "a\tb", "m\u00fcll\u0007", "no\u00a0break", "a\\b", "\udcff"):
            with self.subTest(name=name), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "named.obj"
                mesh = self.plate()
                mesh.groups = [name, name, "", ""]
                _simulation._write(mesh, file)
                read = ricochet.Mesh.read(file)
                np.testing.assert_array_equal(read.groups, mesh.groups)
                read.groups = read.groups  # names that were read can be assigned
                if name.isprintable():
                    scene = self.scene(read, group_materials={name: "hard"})
                    self.assertEqual(self.rebounds(scene), [True, False])
                    scene = self.scene(str(file), group_materials={name: "hard"})
                    self.assertEqual(self.rebounds(scene), [True, False])

    PARTS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no slab\ng left side\nusemtl soft\nf 1 2 3\ng right\nusemtl a#b\nf 1 3 4\n"

    def test_names_of_a_file_are_read(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "parts.obj"
            file.write_text(self.PARTS)
            mesh = ricochet.Mesh.read(file, scale=2)
            bare = Path(folder) / "bare.off"
            bare.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
            self.assertIsNone(ricochet.Mesh.read(bare).groups)
        np.testing.assert_array_equal(mesh.objects, ["slab", "slab"])
        np.testing.assert_array_equal(mesh.groups, ["left side", "right"])
        np.testing.assert_array_equal(mesh.materials, ["soft", "a#b"])
        simulation = ricochet.Simulation(self.scene(mesh))  # a file's name "a#b" need not be a material
        np.testing.assert_array_equal(simulation.collider_mesh("plate").faces, mesh.faces)

    def test_a_mesh_with_names_of_a_file_acts_like_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "plate.obj"
            file.write_text(
                "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n"
                "usemtl hard\ng west\nf 1 2 3 4\nusemtl other\ng east\nf 2 5 6 3\n"
            )
            mesh = ricochet.Mesh.read(file)
            for named in ({}, {"hard": "hard"}, {"east": "hard"}, {"other": "hard", "west": "hard"}):
                of_file = self.rebounds(self.scene(str(file), group_materials=named))
                self.assertEqual(self.rebounds(self.scene(mesh, group_materials=named)), of_file)
                self.assertEqual(any(of_file), bool(named))
        mesh.materials = ["hard", "hard", "soft", "soft"]
        self.assertEqual(self.rebounds(self.scene(mesh)), [True, False])

    def test_names_that_fit_into_no_file_are_refused(self):
        mesh = self.plate()
        for names, said in (
            (["a"], r"materials: found shape \(1,\), expected one name for each of 4 triangles"),
            ([["a"] * 4], "materials: found shape"),
            ([1.5] * 4, "materials: found float64, expected texts or whole numbers"),
            ([None] * 4, "materials: found object, expected texts"),
            (["a", "b", "c", " d"], "materials: found ' d', expected text in one line"),
            (["a", "b", "c", "d #e"], "materials: found 'd #e'"),
            (["a", "b", "c", "d\ne"], "materials: found 'd.ne'"),
            (["a", "b", "c", "d\\"], "materials: found"),
        ):
            with self.assertRaisesRegex(ricochet.InputError, said):
                mesh.materials = names
        self.assertIsNone(mesh.materials)
        mesh.materials = ["hard", "hard", "hrad", "hard"]
        with self.assertRaisesRegex(ricochet.InputError, "hrad"):
            ricochet.Simulation(self.scene(mesh))


class Arguments(unittest.TestCase):
    def test_one_origin_or_direction_applies_to_all(self):
        mesh = ricochet.as_mesh(ROOT / "meshes" / "bowl.obj")
        random = np.random.default_rng(5)
        many = random.uniform(-1, 1, (700, 3))
        one = [0.1, 0.2, 5.0]
        repeated = np.tile(one, (700, 1))
        for name in ("first_hits", "all_hits", "count_hits", "occluded"):
            ask = getattr(mesh, name)
            for single in (one, [one], np.array(one)):
                np.testing.assert_equal(ask(single, many), ask(repeated, many))
                np.testing.assert_equal(ask(many, single), ask(many, repeated))
            np.testing.assert_equal(ask(one, many[0]), ask([one], many[:1]))
        np.testing.assert_equal(mesh.sweep(one, many, 0.01), mesh.sweep(repeated, many, 0.01))
        np.testing.assert_equal(mesh.sweep(many, one), mesh.sweep(many, repeated))
        self.assertEqual(len(mesh.first_hits(one, np.zeros((0, 3))).triangle), 0)
        ray = ricochet.trimesh.RayMeshIntersector(mesh)
        np.testing.assert_equal(ray.intersects_location([one], many), ray.intersects_location(repeated, many))
        np.testing.assert_equal(ray.intersects_location([one], many, multiple_hits=False),
                                ray.intersects_location(repeated, many, multiple_hits=False))

    def test_other_numbers_of_rows_are_refused(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        with self.assertRaisesRegex(ricochet.InputError, "directions"):
            mesh.first_hits(np.zeros((2, 3)), np.ones((3, 3)))
        for shape in ((4,), (2, 2), (1, 1, 3), ()):
            with self.assertRaisesRegex(ricochet.InputError, r"expected numbers of shape \(n, 3\) or \(3,\)"):
                mesh.first_hits(np.zeros(shape), np.ones((1, 3)))

    def test_messages_name_arrays_of_objects(self):
        mesh = ricochet.Mesh(BOX_VERTICES, BOX_FACES)
        for entries in ([[0.5, 0.5, 0.5]], [[1, 2, 3]], [[np.float32(1), 2, 3.0]], [[2**63, -(2**63), 0]]):
            with self.assertRaisesRegex(ricochet.InputError, r"numbers as Python objects, dtype=object .*dtype=float"):
                mesh.inside(np.array(entries, dtype=object))
        with self.assertRaisesRegex(ricochet.InputError, "whole numbers of more than 64 bits"):
            mesh.inside(np.array([[2**64, 0.5, 0.5]], dtype=object))
        with self.assertRaisesRegex(ricochet.InputError, "found Fraction|found str"):
            mesh.inside(np.array([["1", 0.5, 0.5]], dtype=object))
        with self.assertRaisesRegex(ricochet.InputError, r"faces: .*dtype=object .*dtype=int"):
            ricochet.Mesh(BOX_VERTICES, BOX_FACES.astype(object))

    def test_more_threads_than_any_machine_has_are_refused(self):
        before = ricochet.thread_count()
        for threads in (1025, 10**6, -1):
            with self.assertRaisesRegex(ricochet.InputError, "^threads: found"):
                ricochet.set_threads(threads)
            self.assertEqual(ricochet.thread_count(), before)


class Contacts(unittest.TestCase):
    def contacts(self):
        simulation = ricochet.Simulation(bouncing(), contacts=True)
        simulation.run()
        return simulation.take_contacts()

    def test_contacts_are_a_structured_array(self):
        contacts = self.contacts()
        self.assertIsInstance(contacts, np.ndarray)
        self.assertIsInstance(contacts, ricochet.Contacts)
        self.assertEqual(contacts["position"].shape, (len(contacts), 3))
        self.assertIs(type(contacts["position"]), np.ndarray)
        self.assertIs(type(contacts["time"]), np.ndarray)
        late = contacts[contacts["time"] > 1]
        self.assertIsInstance(late, ricochet.Contacts)
        self.assertEqual(late[0]["velocity_after"].shape, (3,))
        twin = pickle.loads(pickle.dumps(contacts))
        np.testing.assert_array_equal(twin, contacts)

    def test_contacts_have_a_table_with_a_number_in_each_column(self):
        contacts = self.contacts()
        table = contacts.table()
        self.assertEqual(table.dtype.names[:7], ("time", "particle", "collider", "triangle", "position_x", "position_y",
                                                 "position_z"))
        self.assertEqual(len(table.dtype.names), 18)
        for name in ("position", "normal", "velocity_before", "velocity_after"):
            for k, axis in enumerate("xyz"):
                np.testing.assert_array_equal(table[f"{name}_{axis}"], contacts[name][:, k])
        self.assertTrue(np.shares_memory(table, contacts))

    def test_pandas_accepts_contacts_directly(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        contacts = self.contacts()
        for part in (contacts, contacts[::2], contacts[:0]):
            frame = pandas.DataFrame(part)
            self.assertEqual(list(frame.columns), list(contacts.table().dtype.names))
            self.assertEqual(len(frame), len(part))
            np.testing.assert_array_equal(frame["velocity_after_z"], part["velocity_after"][:, 2])
        self.assertEqual(frame["particle"].dtype, np.uint64)


if __name__ == "__main__":
    unittest.main()
