"""Ricochet: particles against triangle meshes, exactly.

Exact questions about meshes: :class:`Mesh`. Simulations: :class:`Simulation`, from a scene file, a dictionary, or the
objects of :mod:`ricochet.scene`. A drop-in for trimesh's ray interface: :mod:`ricochet.trimesh`.
"""

from __future__ import annotations

from ._core import DivergedError, InputError, RunError, __version__, set_threads, thread_count
from ._mesh import Mesh, as_mesh
from ._results import AllHits, Hits, Particles, TriangleTotals
from ._simulation import Simulation

__all__ = [
    "AllHits",
    "DivergedError",
    "Hits",
    "InputError",
    "Mesh",
    "Particles",
    "RunError",
    "Simulation",
    "TriangleTotals",
    "__version__",
    "as_mesh",
    "set_threads",
    "thread_count",
]
