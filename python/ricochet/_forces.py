"""Compiled forces, which compute the force on all particles in one call."""

from __future__ import annotations

import importlib
import inspect
import os
import re
from typing import Any, Callable

import numpy as np

from ._core import InputError

# Arguments of a compiled force.
_ARGUMENTS = ("time", "position", "velocity", "mass", "radius", "force")


class CompiledForce:
    """A force that runs without Python, made by :func:`compiled_force`."""

    def __init__(self, function: Callable[..., None], check_indices: bool = True) -> None:
        self.function = function
        self.check_indices = bool(check_indices)
        self._compiled, self._callback = _compile(function, self.check_indices)

    @property
    def address(self) -> int:
        return int(self._callback.address)

    def _call(self, time: float, position: Any, velocity: Any, mass: Any, radius: Any) -> None:
        """Calls the force from Python, so that exceptions of the function reach the caller."""
        self._compiled(time, position, velocity, mass, radius, np.zeros_like(position))

    def __reduce__(self) -> Any:
        return CompiledForce, (self.function, self.check_indices)


def compiled_force(function: Callable[..., None], check_indices: bool = True) -> CompiledForce:
    """Compiles a force with Numba. Simulations call the result without the interpreter's lock.

    The function gets ``(time, position, velocity, mass, radius, force)`` and writes newtons into the rows of ``force``,
    which are zero. The other arrays are read-only. The function must be pure: equal input gives equal forces. An
    exception ends the step, as with a function that is not compiled. An index out of bounds raises IndexError. With
    check_indices=False, the function may be faster, but an index out of bounds reads or writes memory outside the
    array.

    Raises :class:`ricochet.InputError` if Numba cannot compile it.
    """
    return CompiledForce(function, check_indices)


def _compile(function: Callable[..., None], check_indices: bool) -> Any:
    try:
        numba = importlib.import_module("numba")
    except ImportError as error:
        raise InputError(f"compiled_force: Numba cannot be imported ({error}); install python3-numba") from None
    function = getattr(function, "py_func", function)  # the Python function, if the argument is a result of numba.njit
    name = getattr(function, "__name__", type(function).__name__)
    _require_arguments(function, name)
    try:
        return _compiled(numba, function, check_indices)
    except (numba.core.errors.NumbaError, TypeError, ValueError, NotImplementedError, AssertionError) as error:
        raise InputError(
            f"compiled_force: {name}: Numba cannot compile it: {_reason(str(error), function)}; expected a function of "
            f"({', '.join(_ARGUMENTS)}) that writes newtons into the rows of force and returns nothing"
        ) from None


def _compiled(numba: Any, function: Callable[..., None], check_indices: bool) -> Any:
    """Returns two compiled functions: one for calls from Python and one for calls from C++. The second function returns
    0 after an exception. All arrays except the last are read-only."""
    types = numba.types

    def array(axes: int, readonly: bool = True) -> Any:
        return types.Array(types.float64, axes, "C", readonly=readonly)

    users = numba.njit(boundscheck=check_indices)(function)

    def pass_on(time, position, velocity, mass, radius, force):  # type: ignore[no-untyped-def]
        users(time, position, velocity, mass, radius, force)

    arrays = [array(2), array(2), array(1), array(1), array(2, readonly=False)]
    inner = numba.njit(types.void(types.float64, *arrays))(pass_on)
    returned = users.nopython_signatures[0].return_type
    if returned != types.none:
        raise ValueError(f"it returns {returned}")
    carray = numba.carray

    def call(time, count, position, velocity, mass, radius, force):  # type: ignore[no-untyped-def]
        try:
            inner(
                time,
                carray(position, (count, 3)),
                carray(velocity, (count, 3)),
                carray(mass, (count,)),
                carray(radius, (count,)),
                carray(force, (count, 3)),
            )
        except Exception:
            return 0
        return 1

    numbers = types.CPointer(types.float64)
    signature = types.int32(types.float64, types.int64, numbers, numbers, numbers, numbers, numbers)
    return inner, numba.cfunc(signature)(call)


def _require_arguments(function: Any, name: str) -> None:
    if not inspect.isfunction(function):
        raise InputError(f"compiled_force: found {type(function).__name__}, expected a function written in Python")
    try:
        inspect.signature(function).bind(*_ARGUMENTS)
    except TypeError:
        raise InputError(
            f"compiled_force: {name}: found the arguments {inspect.signature(function)}, expected "
            f"({', '.join(_ARGUMENTS)})"
        ) from None


def _reason(text: str, function: Any) -> str:
    """Returns Numba's message on one line, with the error and the line of the source."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", text)
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    cause = next((line for line in lines if not line.startswith("Failed in")), "it does not say why")
    deepest = re.findall(r"^\s*(?:Numba)?TypeError: (.*)$", text, re.MULTILINE)
    if deepest:
        cause = deepest[-1]
    own = os.path.basename(function.__code__.co_filename)
    for path, line in re.findall(r'^File "([^"]*)", line (\d+)', text, re.MULTILINE):
        if os.path.basename(path) == own:
            return f"{cause[:300]} ({own}, line {line})"
    return cause[:300]
