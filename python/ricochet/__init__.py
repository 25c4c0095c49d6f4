"""Ricochet: exact collisions of particles with triangle meshes.

:class:`Mesh` has exact queries on meshes. :class:`Simulation` runs simulations from a scene file, a dictionary, or the
objects of :mod:`ricochet.scene`. :mod:`ricochet.trimesh` is a drop-in replacement for trimesh's ray interface.
"""

from __future__ import annotations

from . import scene, trimesh
from ._core import DivergedError, InputError, RunError, __version__, set_threads, thread_count
from ._forces import CompiledForce, compiled_force
from ._mesh import Mesh, as_mesh
from ._results import AllHits, Contacts, ForceInput, Hits, Particles, TriangleTotals
from ._simulation import Simulation

__all__ = [
    "AllHits",
    "CompiledForce",
    "Contacts",
    "DivergedError",
    "ForceInput",
    "Hits",
    "InputError",
    "Mesh",
    "Particles",
    "RunError",
    "Simulation",
    "TriangleTotals",
    "__version__",
    "as_mesh",
    "compiled_force",
    "scene",
    "set_threads",
    "thread_count",
    "trimesh",
]
