"""Simulations: scenes as input, steps, and arrays as output."""

from __future__ import annotations

import importlib
import json
import math
import os
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Callable, List, Optional, Tuple, Union

import numpy as np

from . import _core
from ._core import InputError, Mesh
from ._forces import CompiledForce
from ._mesh import _OF_FILE, _is_writable, as_mesh
from ._results import ForceInput

Force = Union[CompiledForce, Callable[[ForceInput], Any]]
SceneLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]

# Name in messages about a scene that was not read from a file.
_NAME = "scene"
# Placeholder for the temporary folder of mesh files. It is replaced when the scene is read.
_MESHES = "/ricochet-meshes"
# Largest number of nested lists and dictionaries, equal to the limit of the tool.
_DEEPEST = 64


class Simulation(_core.Simulation):
    """A running simulation.

    scene
        Name of a scene file, dictionary with the keys of a scene file, or :class:`ricochet.scene.Scene`. Paths in a
        dictionary are relative to the working folder. The name of a mesh file can be replaced by a
        :class:`ricochet.Mesh`, or by any object with vertices and faces.
    overrides
        Changes like the tool's --set, such as ``{"simulation.time_step": 0.01}``.
    contacts
        Keep every contact for :meth:`take_contacts`.
    verify
        Check every step with independent code, like the tool's --verify.

    forces
        Forces in addition to the scene's. Each is a function or the result of :func:`ricochet.compiled_force`. A
        function gets a :class:`ricochet.ForceInput` of all particles and returns forces in newtons, shape (n, 3).
        Forces must be pure: equal input gives equal forces. With such forces, the integrator "ballistic", which is the
        default of scenes, moves all particles like "velocity_verlet".

    Warnings of the tool become Python warnings (UserWarning), and are listed in :attr:`warnings`.

    Raises :class:`ricochet.InputError` with all errors of the scene, one per line, like the tool.
    """

    def __init__(
        self,
        scene: SceneLike,
        overrides: Optional[Mapping[str, Any]] = None,
        *,
        contacts: bool = False,
        verify: bool = False,
        forces: Sequence[Force] = (),
    ) -> None:
        changes = _changes(overrides)
        meshes: List[Mesh] = []
        text, file = _text_of(scene, meshes)
        self._begin(text, file, meshes, changes, bool(contacts), bool(verify), _force_list(forces))
        for warning in self.warnings:
            warnings.warn(warning, UserWarning, stacklevel=2)

    def _begin(
        self,
        text: str,
        file: str,
        meshes: List[Mesh],
        changes: List[str],
        contacts: bool,
        verify: bool,
        forces: List[Force],
    ) -> None:
        if "_made_from" in vars(self):
            raise InputError("Simulation: this object has been made already; make another one")
        if not meshes:
            super().__init__(text, file, changes, contacts, verify, forces)
        else:
            with tempfile.TemporaryDirectory(prefix="ricochet-") as folder:
                for number, mesh in enumerate(meshes):
                    _write(mesh, Path(folder) / f"{number}.obj")
                super().__init__(text.replace(_MESHES, folder), file, changes, contacts, verify, forces)
        self._made_from = (text, file, meshes, changes, contacts, verify, forces)

    def step(self) -> None:
        """Makes one step."""
        self.advance(1)

    def advance(self, steps: int, progress: bool = False) -> None:
        """Makes a number of steps, or all remaining steps if fewer remain. Other Python threads run meanwhile. Ctrl-C
        ends the call after the current step, or within the step if the step takes long. progress: shows a progress bar
        if tqdm is installed."""
        steps = _count(steps)
        if not progress:
            self._advance(steps, None)
            return
        with _bar(min(steps, self.step_count - self.step_index)) as bar:
            start = self.step_index
            self._advance(steps, bar.refresh)
            bar.update(self.step_index - start)

    def run(self, until: Optional[float] = None, progress: bool = False) -> None:
        """Makes steps up to a time in seconds, or up to the end of the run."""
        steps = self.step_count - self.step_index if until is None else self._steps_to(_time(until))
        self.advance(steps, progress)

    def __reduce__(self) -> Any:
        state = self.save()  # raises an exception if __init__ has not run
        return _restored, (*self._made_from, state)


def _changes(overrides: Any) -> List[str]:
    if overrides is None:
        return []
    if not isinstance(overrides, Mapping):
        raise InputError(f"overrides: found {type(overrides).__name__}, expected a dictionary")
    return [
        f"{key}={value if isinstance(value, str) else _json(value, f'overrides: {_short(key)}')}"
        for key, value in overrides.items()
    ]


def _force_list(forces: Any) -> List[Force]:
    try:
        return list(forces)
    except TypeError:
        raise InputError(f"forces: found {type(forces).__name__}, expected a list of functions") from None


def _short(value: Any) -> str:
    """Returns a shortened text of a value for messages."""
    try:
        text = repr(value)
    except Exception:
        text = type(value).__name__
    return text if len(text) <= 80 else text[:77] + "..."


def _restored(*state: Any) -> Simulation:
    simulation = Simulation.__new__(Simulation)
    simulation._begin(*state[:-1])
    simulation.restore(state[-1])
    return simulation


def _count(steps: Any) -> int:
    if isinstance(steps, (int, np.integer)) and not isinstance(steps, bool) and 0 <= steps < 2**64:
        return int(steps)
    raise InputError(f"steps: found {_short(steps)}, expected a whole number of at least 0")


def _time(until: Any) -> float:
    if not isinstance(until, (str, bytes)):
        try:
            return float(until)
        except (TypeError, ValueError, OverflowError):
            pass
    raise InputError(f"until: found {_short(until)}, expected a time in seconds, or None for the end")


class _NoBar:
    def __enter__(self) -> "_NoBar":
        return self

    def __exit__(self, *_: Any) -> None:
        pass

    def refresh(self) -> None:
        pass

    def update(self, steps: int) -> None:
        pass


def _bar(total: int) -> Any:
    try:
        return importlib.import_module("tqdm.auto").tqdm(total=total, unit=" steps")
    except ImportError:
        return _NoBar()


def _text_of(scene: Any, meshes: List[Mesh]) -> Tuple[str, str]:
    if isinstance(scene, Mapping):
        _require_known_materials(scene)
        return _json(_with_mesh_files(scene, meshes), _NAME, indent=1), _NAME
    if isinstance(scene, (str, os.PathLike)):
        file = os.fspath(scene)
        try:
            return Path(file).read_text(encoding="utf-8"), file
        except (OSError, UnicodeDecodeError, ValueError) as error:
            raise InputError(f"{file}: cannot be read ({error})") from None
    raise InputError(f"scene: found {type(scene).__name__}, expected a file's name or a dictionary")


def _json(value: Any, where: str, indent: Optional[int] = None) -> str:
    try:
        return json.dumps(value, indent=indent, default=_plain)
    except InputError:
        raise
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"{where}: cannot be written as JSON ({error})") from None


def _plain(value: Any) -> Any:
    """Converts a value that the json module cannot write to one that it can."""
    if isinstance(value, (np.ndarray, np.generic)):
        if value.dtype.kind in "fc" and not np.isfinite(value).all():
            raise InputError("scene: found nan or inf in an array, expected finite numbers")
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise InputError(f"scene: found {type(value).__name__}, expected numbers, texts, lists and dictionaries")


def _with_mesh_files(value: Any, meshes: List[Mesh], depth: int = 0) -> Any:
    """Returns a copy in which names of files replace meshes. Appends the meshes to the list. The files are written when
    the scene is read."""
    if depth > _DEEPEST:
        raise InputError(
            f"scene: found lists and dictionaries nested deeper than {_DEEPEST} levels, expected fewer: one may contain "
            "itself"
        )
    if isinstance(value, Mapping):
        plain = {_key(key): _with_mesh_files(entry, meshes, depth + 1) for key, entry in value.items()}
        return _with_own_materials(plain, value)
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        return [_with_mesh_files(entry, meshes, depth + 1) for entry in value]
    if isinstance(value, Mesh) or hasattr(value, "faces") or hasattr(value, "cells_dict"):
        # The mesh is copied, so that later changes of its vertices have no effect.
        mesh = as_mesh(value)
        meshes.append(_copy_of(mesh) if mesh is value else mesh)
        return f"{_MESHES}/{len(meshes) - 1}.obj"
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"scene: found {value}, expected finite numbers")
    return value


def _own_materials(mesh: Any) -> List[str]:
    """Returns the material names that the user has set on a mesh. Names read from a file do not count."""
    if not isinstance(mesh, Mesh) or mesh.materials is None or "materials" in mesh.__dict__.get(_OF_FILE, ()):
        return []
    names: Any = np.unique(mesh.materials).tolist()
    return [name for name in names if name]


def _with_own_materials(plain: Any, collider: Any) -> Any:
    """Adds the material names that the user has set on a collider's mesh to its `group_materials`. Existing entries
    take precedence."""
    own = _own_materials(collider.get("file"))
    if not own or not isinstance(plain.get("group_materials", {}), Mapping):
        return plain
    return {**plain, "group_materials": {**{name: name for name in own}, **plain.get("group_materials", {})}}


def _require_known_materials(scene: Any) -> None:
    """Raises InputError if a material name that the user has set on a mesh is unknown to the scene and to the
    collider."""
    known, colliders = scene.get("materials", {}), scene.get("colliders", [])
    if not isinstance(known, Mapping) or not isinstance(colliders, Sequence):
        return
    for number, collider in enumerate(colliders):
        listed = collider.get("group_materials", {}) if isinstance(collider, Mapping) else {}
        if not isinstance(collider, Mapping) or not isinstance(listed, Mapping):
            continue
        for name in _own_materials(collider.get("file")):
            if name not in known and name not in listed:
                raise InputError(
                    f"scene: colliders[{number}].file: the mesh's `materials` have the name {name!r}, expected names of "
                    f"the scene's materials ({', '.join(known) or 'none'}) or of the collider's `group_materials`"
                )


def _copy_of(mesh: Mesh) -> Mesh:
    copy = Mesh(mesh.vertices, mesh.faces)
    copy.__dict__.update(mesh.__dict__)
    return copy


def _statements(mesh: Mesh) -> Iterator[List[str]]:
    """Yields the OBJ statements that set the names of each triangle. A name that _is_writable() rejects is omitted."""
    columns: List[Tuple[str, List[str]]] = []
    for statement, array in (("o", mesh.objects), ("g", mesh.groups), ("usemtl", mesh.materials)):
        if array is not None:
            names: Any = array.tolist()
            columns.append((statement, [name if _is_writable(name) else "" for name in names]))
    last = [""] * len(columns)
    for number in range(len(mesh)):
        changed = []
        for column, (statement, names) in enumerate(columns):
            if names[number] != last[column]:
                last[column] = names[number]
                changed.append(f"{statement} {names[number]}\n")
        yield changed


def _write(mesh: Mesh, file: Path) -> None:
    """Writes a mesh as an OBJ file, with all digits of every double. The triangles have their names and keep their
    order."""
    vertices: Any = mesh.vertices.tolist()
    faces: Any = mesh.faces.tolist()
    with open(file, "w", encoding="utf-8", errors="surrogateescape") as stream:
        stream.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
        for (a, b, c), statements in zip(faces, _statements(mesh)):
            stream.writelines(statements)
            stream.write(f"f {a + 1} {b + 1} {c + 1}\n")


def _key(key: Any) -> str:
    if isinstance(key, str):
        return key
    raise InputError(f"scene: found the key {_short(key)}, expected texts as keys")
