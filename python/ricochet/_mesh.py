"""Meshes from arrays, files and the objects of other packages."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from ._core import InputError, Mesh, _triangulate

__all__ = ["Mesh", "as_mesh"]

Integers = npt.NDArray[np.int64]

# Names of meshio's surface cells. "polygon" cells have any number of corners. Older versions append this number, as in
# "polygon7".
_SURFACE_CELLS = re.compile(r"(triangle|quad|polygon|VTK_LAGRANGE_TRIANGLE|VTK_LAGRANGE_QUADRILATERAL)\d*")


def as_mesh(source: Any, ignore: Sequence[str] = ()) -> Mesh:
    """Returns a :class:`Mesh` from a mesh, a file's name, or anything with `vertices` and `faces` (trimesh) or `points`
    and `cells` (meshio).

    The result contains all surface cells of meshio. Polygons are cut into triangles inside their outline. A cell with
    nodes on its edges is a polygon through these nodes. A node in the middle of a cell is a corner of all triangles of
    the cell. Other cells, such as "line" and "tetra", raise :class:`InputError`. Types of cells that `ignore` names are
    left out instead.
    """
    if isinstance(source, Mesh):
        return source
    if isinstance(source, (str, os.PathLike)):
        return Mesh.read(source)
    vertices = getattr(source, "vertices", None)
    faces = getattr(source, "faces", None)
    if vertices is not None and faces is not None:
        return Mesh(vertices, faces)
    blocks = _blocks(source)
    if blocks is not None and hasattr(source, "points"):
        return _from_cells(source.points, blocks, ignore)
    raise InputError(
        f"mesh: found {type(source).__name__}, expected a file's name, a ricochet.Mesh, or an object with "
        "vertices and faces, or with points and cells"
    )


Blocks = List[Tuple[str, Any]]


def _blocks(source: Any) -> Optional[Blocks]:
    """Returns the blocks of cells of a meshio object in their order. The blocks can also be a dictionary by type.
    Returns None for other objects."""
    cells = getattr(source, "cells", None)
    if isinstance(cells, (list, tuple)) and all(hasattr(block, "type") and hasattr(block, "data") for block in cells):
        return [(str(block.type), block.data) for block in cells]
    by_type = getattr(source, "cells_dict", None)
    return [(str(kind), data) for kind, data in by_type.items()] if isinstance(by_type, Mapping) else None


def _from_cells(points: Any, blocks: Blocks, ignore: Sequence[str]) -> Mesh:
    ignored = {ignore} if isinstance(ignore, str) else set(ignore)
    kept = [(kind, data) for kind, data in blocks if kind not in ignored]
    others = sorted({kind for kind, _ in kept if not _SURFACE_CELLS.fullmatch(kind)})
    if others:
        raise InputError(
            f"mesh: found cells {', '.join(others)}, expected cells of surfaces (triangle, quad, polygon and the like); "
            f"as_mesh(mesh, ignore={others}) leaves them out"
        )
    if not kept:
        found = ", ".join(sorted({kind for kind, _ in blocks})) or "none"
        raise InputError(f"mesh: found cells {found}, expected triangles, quads or polygons among them")
    corners = np.asarray(points)[:, :3]
    return Mesh(corners, np.concatenate([_triangles(corners, kind, data) for kind, data in kept]))


def _triangles(points: Any, kind: str, cells: Any) -> Any:
    """Returns the triangles of one block of cells, in the order of the cells."""
    if kind.startswith("polygon"):
        rows = [np.asarray(cell) for cell in cells]
        return _cut(points, np.cumsum([0] + [len(row) for row in rows]), np.concatenate(rows) if rows else [])
    nodes = np.asarray(cells)
    if nodes.ndim != 2 or nodes.dtype.kind not in "iu":
        raise InputError(f"mesh: found cells {kind} of shape {nodes.shape}, expected whole numbers of shape (n, nodes)")
    outline, middle = _outline(kind, nodes.shape[1])
    if middle is not None:
        ring = nodes[:, outline]
        fan = np.stack([ring, np.roll(ring, -1, axis=1), np.broadcast_to(nodes[:, [middle]], ring.shape)], axis=2)
        return fan.reshape(-1, 3)
    if len(outline) == 3:
        return nodes[:, outline]
    return _cut(points, len(outline) * np.arange(len(nodes) + 1), nodes[:, outline].reshape(-1))


def _cut(points: Any, offsets: Any, corners: Any) -> Any:
    return _triangulate(points, np.asarray(offsets), np.asarray(corners))


def _outline(kind: str, count: int) -> Tuple[List[int], Optional[int]]:
    """Returns the nodes around a cell in order, and its middle node if there is exactly one. Cells of second order and
    triangles of third order have one middle node. Cells of higher orders have several inner nodes, which are left out.

    meshio lists corners first, then the nodes on each edge, then inner nodes. VTK lists the nodes on the third and
    fourth edge of a quad in reverse order.
    """
    sides = 3 if "triangle" in kind.lower() else 4
    on_edge = _nodes_on_edge(sides, count)
    if on_edge is None:
        raise InputError(f"mesh: found cells {kind} with {count} nodes, expected a number of nodes that such cells have")
    outline = []
    for side in range(sides):
        first = sides + side * on_edge
        inner = list(range(first, first + on_edge))
        is_reversed = kind.startswith("VTK_LAGRANGE_QUAD") and side >= 2
        outline += [side] + (inner[::-1] if is_reversed else inner)
    middle = sides * (1 + on_edge)
    return outline, middle if count == middle + 1 else None


def _nodes_on_edge(sides: int, count: int) -> Optional[int]:
    """Returns the number of nodes on each edge between its ends. Returns None if no type of cell has `count` nodes."""
    if sides == 3 and count == 7:  # second order, with a node in the middle
        return 1
    if sides == 4 and count == 8:  # second order, without a node in the middle
        return 1
    for order in range(1, count):
        if count == ((order + 1) * (order + 2) // 2 if sides == 3 else (order + 1) ** 2):
            return order - 1
    return None


# Key in a mesh's `__dict__`. The value is the set of the kinds of names that come from a file.
_OF_FILE = "_names_of_file"


def _set_names(mesh: Mesh, count: int, kind: str, names: Any) -> None:
    """Sets the names of one kind for all triangles, from user input."""
    array = _names(names, count, kind)
    mesh.__dict__[kind] = array
    mesh.__dict__[_OF_FILE] = mesh.__dict__.get(_OF_FILE, frozenset()) - {kind}


def _take_names(mesh: Mesh, numbers: Any, materials: List[str], groups: List[str], objects: List[str]) -> None:
    """Sets the names of each triangle. numbers[t] selects the combination of names for triangle t. Names from a file
    are not checked."""
    taken = set()
    for kind, names in (("materials", materials), ("groups", groups), ("objects", objects)):
        if any(names):
            array = np.array(names)[numbers]
            array.flags.writeable = False
            mesh.__dict__[kind] = array
            taken.add(kind)
    mesh.__dict__[_OF_FILE] = frozenset(taken)


# Matches characters that an OBJ reader would not return as part of a name: line breaks, outer blanks, comment marks and
# a final backslash.
_NOT_IN_A_LINE = re.compile(r"[\n\r\0]|^[ \t]|[ \t]$|(^|[ \t])#|\\$")


def _is_writable(name: str) -> bool:
    """Returns True if a name that is written to a line of an OBJ file is read back unchanged."""
    return _NOT_IN_A_LINE.search(name) is None


def _names(names: Any, count: int, kind: str) -> Optional[npt.NDArray[np.str_]]:
    """Returns names of triangles as a read-only array of texts. Raises InputError for a name that _is_writable()
    rejects."""
    if names is None:
        return None
    array = np.asarray(names)
    if array.shape != (count,):
        raise InputError(f"{kind}: found shape {array.shape}, expected one name for each of {count} triangles")
    if array.dtype.kind in "iu":
        array = array.astype(str)
    if array.dtype.kind == "O" and all(isinstance(name, str) for name in array):
        array = array.astype(str)
    if array.dtype.kind != "U":
        raise InputError(f"{kind}: found {array.dtype}, expected texts or whole numbers")
    for name in np.unique(array).tolist():
        if not _is_writable(name):
            raise InputError(
                f"{kind}: found {name[:80]!r}, expected text in one line without blanks at its ends, a # at its start or "
                "behind a blank, or a \\ at its end"
            )
    array = array.copy()
    array.flags.writeable = False
    return array
