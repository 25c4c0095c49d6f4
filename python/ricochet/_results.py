"""Results of queries and simulations: named tuples of NumPy arrays."""

from __future__ import annotations

import inspect
import re
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class Hits(NamedTuple):
    """Results of queries, with one entry for each query. Without a hit, triangle is -1, distance is infinite and point
    is NaN.

    triangle: Index of the triangle; the smallest index if several triangles share the point. Shape (n,).
    distance: Metres from a ray's origin or from a point; for sweeps the fraction of the path, from 0 to 1. Shape (n,).
    point: Position on the triangle, in metres. Shape (n, 3).
    """

    triangle: Integers
    distance: Floats
    point: Floats


class AllHits(NamedTuple):
    """All m hits of all rays. They are sorted by ray, and along each ray by distance.

    ray: Index of the ray. Shape (m,).
    triangle: Index of the triangle; the smallest index if several triangles share the point. Shape (m,).
    distance: Metres from the ray's origin. Shape (m,).
    point: Position on the triangle, in metres. Shape (m, 3).
    crossing: 1 if the ray leaves through the surface (along its normal), -1 if it enters, 0 if it touches. Shape (m,).
    first: Hits of ray i are first[i] to first[i + 1]. Shape (rays + 1,).
    """

    ray: Integers
    triangle: Integers
    distance: Floats
    point: Floats
    crossing: npt.NDArray[np.int8]
    first: npt.NDArray[np.uint64]


class Particles(NamedTuple):
    """The particles at the time of access. Arrays are read-only and keep their values when the simulation continues.

    id: Number of the particle, which never changes. Shape (n,), like all fields except vectors.
    position: Metres. Shape (n, 3).
    velocity: Metres per second. Shape (n, 3).
    spin: Angular velocity, in radians per second. Shape (n, 3).
    mass: Kilograms.
    radius: Metres; 0 for points.
    birth_time: Seconds.
    lifetime: Seconds from birth to removal; infinite for particles that are not removed.
    contacts: Number of impacts so far.
    resting: True if the particle rests on surfaces.
    frozen: True if the particle no longer moves, because its state left the range of the arithmetic.
    """

    id: npt.NDArray[np.uint64]
    position: Floats
    velocity: Floats
    spin: Floats
    mass: Floats
    radius: Floats
    birth_time: Floats
    lifetime: Floats
    contacts: npt.NDArray[np.uint32]
    resting: npt.NDArray[np.bool_]
    frozen: npt.NDArray[np.bool_]


class ForceInput(NamedTuple):
    """Input of a force that is a Python function: the particles, in the order of the returned forces. Arrays are
    read-only copies, so the function may store them.

    time: Seconds.
    id: Number of the particle, which never changes. Shape (n,).
    position: Metres. Shape (n, 3).
    velocity: Metres per second. Shape (n, 3).
    mass: Kilograms. Shape (n,).
    radius: Metres. Shape (n,).
    """

    time: float
    id: npt.NDArray[np.uint64]
    position: Floats
    velocity: Floats
    mass: Floats
    radius: Floats


class TriangleTotals(NamedTuple):
    """Totals for each triangle of a collider since the start.

    hits: Number of impacts. Shape (n,).
    impulse: Impulse that particles have given to the triangle, in newton seconds. Shape (n, 3).
    """

    hits: npt.NDArray[np.uint64]
    impulse: Floats


def _explain_fields(kind: Any) -> None:
    """Sets the docstrings of a named tuple's fields from the docstring of the tuple, for help()."""
    for name, text in re.findall(r"^(\w+): (.+)$", inspect.cleandoc(kind.__doc__), re.MULTILINE):
        getattr(kind, name).__doc__ = text


for _kind in (Hits, AllHits, Particles, ForceInput, TriangleTotals):
    _explain_fields(_kind)


class Contacts(npt.NDArray[Any]):
    """Contacts as a structured array with the fields `time`, `particle`, `collider`, `triangle`, `position`, `normal`,
    `velocity_before`, `velocity_after`, `mass` and `radius`. pandas accepts it directly: ``pandas.DataFrame(contacts)``
    has a column for each component of a vector, such as `position_x`."""

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        # A single field is returned as an ordinary array.
        return found.view(np.ndarray) if isinstance(found, Contacts) and found.dtype.names is None else found

    def table(self) -> npt.NDArray[np.void]:
        """Returns a structured array over the same memory, in which each column contains one number."""
        columns: Any = {"names": [], "formats": [], "offsets": [], "itemsize": self.dtype.itemsize}
        fields: Any = self.dtype.fields
        for name in self.dtype.names or ():
            kind, offset = fields[name][:2]
            parts = [f"{name}_{axis}" for axis in "xyz"] if kind.shape else [name]
            columns["names"] += parts
            columns["formats"] += [kind.base] * len(parts)
            columns["offsets"] += [offset + k * kind.base.itemsize for k in range(len(parts))]
        return self.view(np.ndarray).view(np.dtype(columns))

    @property
    def _data(self) -> npt.NDArray[np.void]:
        # pandas reads structured arrays through numpy.ma.getdata(), which uses this property. pandas accepts no columns
        # of vectors.
        return self.table()
