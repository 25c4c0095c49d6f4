"""Forces on all particles at once."""

from __future__ import annotations

import importlib
from typing import Any, Callable


class CompiledForce:
    """A force that runs without Python: what :func:`compiled_force` makes."""

    def __init__(self, function: Callable[..., None]) -> None:
        self.function = function
        self._callback = _compile(function)

    @property
    def address(self) -> int:
        return int(self._callback.address)

    def __reduce__(self) -> Any:
        return CompiledForce, (self.function,)


def compiled_force(function: Callable[..., None]) -> CompiledForce:
    """Compiles a force with Numba, to be called without the interpreter's lock.

    The function is given ``(time, position, velocity, mass, radius, force)`` and writes newtons into the rows of
    ``force``, which are zero. It must be pure: the same input, the same forces.
    """
    return CompiledForce(function)


def _compile(function: Callable[..., None]) -> Any:
    numba = importlib.import_module("numba")
    types = numba.types
    inner = numba.njit(function)
    carray = numba.carray
    numbers = types.CPointer(types.float64)

    def call(time, count, position, velocity, mass, radius, force):  # type: ignore[no-untyped-def]
        inner(
            time,
            carray(position, (count, 3)),
            carray(velocity, (count, 3)),
            carray(mass, (count,)),
            carray(radius, (count,)),
            carray(force, (count, 3)),
        )

    signature = types.void(types.float64, types.int64, numbers, numbers, numbers, numbers, numbers)
    return numba.cfunc(signature)(call)
