"""Meshes from arrays, files and the objects of other packages."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._core import InputError, Mesh

__all__ = ["Mesh", "as_mesh"]


def as_mesh(source: Any) -> Mesh:
    """A :class:`Mesh` from a mesh, a file's name, or anything with `vertices` and `faces` (trimesh) or `points` and
    `cells_dict` (meshio)."""
    if isinstance(source, Mesh):
        return source
    if isinstance(source, (str, os.PathLike)):
        return Mesh.read(source)
    vertices = getattr(source, "vertices", None)
    faces = getattr(source, "faces", None)
    if vertices is not None and faces is not None:
        return Mesh(vertices, faces)
    cells = getattr(source, "cells_dict", None)
    if isinstance(cells, Mapping) and hasattr(source, "points"):
        return _from_cells(source.points, cells)
    raise InputError(
        f"mesh: found {type(source).__name__}, expected a file's name, a ricochet.Mesh, or an object with "
        "vertices and faces, or with points and cells_dict"
    )


def _from_cells(points: Any, cells: Any) -> Mesh:
    parts = []
    if "triangle" in cells:
        parts.append(np.asarray(cells["triangle"]))
    if "quad" in cells:
        quads = np.asarray(cells["quad"])
        parts.append(np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3))
    if not parts:
        raise InputError(f"mesh: found cells {sorted(cells)}, expected triangles or quads among them")
    return Mesh(np.asarray(points)[:, :3], np.concatenate(parts))
