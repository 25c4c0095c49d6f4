"""What questions and simulations answer with: named tuples of NumPy arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class Hits(NamedTuple):
    """One entry a question; where nothing is hit: triangle -1, distance infinite, point NaN."""

    triangle: Integers
    """Index of the triangle; of several at the same point the smallest."""
    distance: Floats
    """Metres from a ray's origin or from a point; of a sweep the fraction of the way, from 0 to 1."""
    point: Floats
    """Shape (n, 3), on the triangle."""


class AllHits(NamedTuple):
    """All hits of all rays, ray by ray, in the order along each."""

    ray: Integers
    """Number of the ray."""
    triangle: Integers
    distance: Floats
    point: Floats
    crossing: npt.NDArray[np.int8]
    """1 where the ray leaves through the surface (along its normal), -1 where it enters, 0 where it only touches."""
    first: npt.NDArray[np.uint64]
    """Hits of ray i are first[i] to first[i + 1]."""


class Particles(NamedTuple):
    """The particles as they were when asked for. Arrays are read-only and keep their values when the simulation goes on."""

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
    """What a force of Python is given: the particles, in the order in which it is to return their forces. Arrays are
    read-only copies, which may be kept."""

    time: float
    id: npt.NDArray[np.uint64]
    position: Floats
    velocity: Floats
    mass: Floats
    radius: Floats


class TriangleTotals(NamedTuple):
    """What particles have done to each triangle of a collider since the start."""

    hits: npt.NDArray[np.uint64]
    impulse: Floats
    """N s, shape (n, 3)."""
