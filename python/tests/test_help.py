"""Texts of the compiled classes for help() and editors."""

import inspect
import pydoc
import unittest

import ricochet


class Signatures(unittest.TestCase):
    def test_python_reads_the_signatures(self):
        for function, signature in (
            (ricochet.Mesh.first_hits, "(self, origins, directions, most=None, transform=None)"),
            (ricochet.Mesh.closest_points, "(self, points, within=inf, transform=None)"),
            (ricochet.Mesh.sweep, "(self, from_points, to_points, radius=0.0, vertices_after=None, transform=None)"),
            (ricochet.Simulation.remove_particles, "(self, ids)"),
            (ricochet.set_threads, "(threads)"),
            (ricochet.Mesh.inside, "(self, points, rule='parity', transform=None)"),
            (ricochet.Mesh.read, "(file, up=None, scale=1.0, merge=None)"),
            (ricochet.Mesh, "(vertices, faces)"),
        ):
            self.assertEqual(str(inspect.signature(function)), signature, function)

    def test_every_method_has_a_signature(self):
        for kind in (ricochet.Mesh, ricochet._core.Simulation):
            for name, member in inspect.getmembers(kind, inspect.isroutine):
                if not name.startswith("_"):
                    self.assertIsNotNone(inspect.signature(member), name)


class Texts(unittest.TestCase):
    def test_texts_name_the_result_and_its_fields(self):
        shown = pydoc.render_doc(ricochet.Mesh, renderer=pydoc.plaintext)
        self.assertIn("first_hits(self, origins, directions, most=None, transform=None)", shown)
        for function, result in (
            (ricochet.Mesh.first_hits, "Returns ricochet.Hits: triangle, distance, point."),
            (ricochet.Mesh.all_hits, "Returns ricochet.AllHits: ray, triangle, distance, point, crossing, first."),
            (ricochet.Mesh.inside, "Returns numpy.ndarray."),
            (ricochet.Mesh.read, "Returns ricochet.Mesh."),
            (ricochet.Simulation.take_contacts, "Returns ricochet.Contacts."),
            (ricochet.Simulation.triangle_totals, "Returns ricochet.TriangleTotals: hits, impulse."),
        ):
            self.assertTrue(function.__doc__.endswith(result), function.__doc__)

    def test_every_field_has_a_text(self):
        for kind in (ricochet.Hits, ricochet.AllHits, ricochet.Particles, ricochet.ForceInput, ricochet.TriangleTotals):
            for field in kind._fields:
                self.assertNotIn("Alias for field", getattr(kind, field).__doc__, f"{kind.__name__}.{field}")

    def test_every_property_has_a_text(self):
        for kind in (ricochet.Mesh, ricochet._core.Simulation):
            for name, member in vars(kind).items():
                if isinstance(member, property):
                    self.assertTrue(member.__doc__, f"{kind.__name__}.{name}")


class Package(unittest.TestCase):
    def test_the_package_imports_its_modules(self):
        self.assertEqual(ricochet.scene.Scene()["ricochet"], 1)
        self.assertTrue(ricochet.trimesh.RayMeshIntersector)


if __name__ == "__main__":
    unittest.main()
