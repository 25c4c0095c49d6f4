"""Exact drop-in replacement for trimesh's ray interface: ``mesh.ray = ricochet.trimesh.RayMeshIntersector(mesh)``.

Hits and misses are exact for coordinates in double precision. A ray through a shared edge or vertex has one hit there.
Containment is decided by exact parity in a closed mesh, and by winding number in an open mesh.
"""

from __future__ import annotations

import contextlib
from typing import Any, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._mesh import Mesh, as_mesh
from ._results import AllHits, Hits

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

# A ray counts as parallel to a triangle up to this dot product of the triangle's scaled normal and the ray's scaled
# direction. The edges, the cross product and the sum have rounding errors of about 2^-50 in total.
_PARALLEL = 2.0**-44


class RayMeshIntersector:
    """Exact replacement for trimesh.ray.ray_triangle.RayMeshIntersector, for one mesh with vertices and faces.

    Every query uses the current vertices and faces of the mesh.
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True) -> None:
        """scale_to_box has no effect. It is accepted for compatibility with trimesh."""
        self.mesh = geometry
        self._followed: Optional[_Followed] = None
        # trimesh creates intersectors before its meshes have vertices. The class is therefore checked too.
        if not hasattr(type(geometry), "vertices") and not hasattr(geometry, "vertices"):
            as_mesh(geometry)

    def intersects_location(
        self, ray_origins: Any, ray_directions: Any, multiple_hits: bool = True
    ) -> Tuple[Floats, Integers, Integers]:
        """Returns points, rays and triangles of all hits, or of the first hit of each ray."""
        ray, triangle, point = self._hits(ray_origins, ray_directions, multiple_hits)
        return point, ray, triangle

    def intersects_id(
        self,
        ray_origins: Any,
        ray_directions: Any,
        return_locations: bool = False,
        multiple_hits: bool = True,
    ) -> Any:
        """Returns triangles and rays of all hits, or of the first hit of each ray. With return_locations, also the
        points."""
        ray, triangle, point = self._hits(ray_origins, ray_directions, multiple_hits)
        return (triangle, ray, point) if return_locations else (triangle, ray)

    def intersects_first(self, ray_origins: Any, ray_directions: Any) -> Integers:
        """Returns the first triangle that each ray hits, or -1 if the ray hits none."""
        return self._current().first_hits(ray_origins, ray_directions).triangle

    def intersects_any(self, ray_origins: Any, ray_directions: Any) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits the mesh."""
        return self.intersects_first(ray_origins, ray_directions) >= 0

    def contains_points(self, points: Any) -> npt.NDArray[np.bool_]:
        """Returns True for each point inside the mesh. Points on the surface of a closed mesh are outside.

        In an open mesh, a point is inside if the magnitude of its winding number is above 1/2. This means that the
        surface covers more than half of all directions from the point. Triangles that repeat an earlier one in the same
        winding count once.
        """
        return self._current().contains(points)

    def __copy__(self) -> "RayMeshIntersector":
        return RayMeshIntersector(self.mesh)

    def __deepcopy__(self, _: Any) -> "RayMeshIntersector":
        # trimesh deep-copies its meshes together with their intersectors. The copied intersector still uses the
        # original mesh.
        return RayMeshIntersector(self.mesh)

    def __getstate__(self) -> Any:
        return {"mesh": self.mesh, "_followed": None}

    def _current(self) -> "_Followed":
        self._followed = _followed(self.mesh, self._followed)
        return self._followed

    def _hits(self, origins: Any, directions: Any, multiple_hits: bool) -> Tuple[Integers, Integers, Floats]:
        if not multiple_hits:
            first = self._current().first_hits(origins, directions)
            ray = np.flatnonzero(first.triangle >= 0)
            return ray, first.triangle[ray], first.point[ray]
        every, counted = self._current().all_hits(origins, directions)
        return every.ray[counted], every.triangle[counted], every.point[counted]


class _Followed:
    """State of a mesh at one time. Its queries follow trimesh: a ray in the plane of a triangle does not hit this
    triangle."""

    def __init__(self, queries: Mesh, state: Any = None, arrays: Any = None) -> None:
        self.queries = queries
        self.state = state
        self.arrays = arrays
        self._normals: Optional[Floats] = None
        self._distinct: Optional[Mesh] = None

    def is_of(self, vertices: Any, faces: Any, state: Any) -> bool:
        if state is not None or self.arrays is None:
            return bool(state == self.state)
        return np.array_equal(self.arrays[0], vertices) and np.array_equal(self.arrays[1], faces)

    def first_hits(self, origins: Any, directions: Any) -> Hits:
        first = self.queries.first_hits(origins, directions)
        hit = np.flatnonzero(first.triangle >= 0)
        doubtful = hit[self._is_parallel(first.triangle[hit], _rows(directions, hit))]
        if len(doubtful) == 0:
            return first
        every, counted = self.all_hits(_rows(origins, doubtful), _rows(directions, doubtful))
        first.triangle[doubtful], first.distance[doubtful], first.point[doubtful] = -1, np.inf, np.nan
        ray, place = np.unique(every.ray[counted], return_index=True)
        first.triangle[doubtful[ray]] = every.triangle[counted][place]
        first.distance[doubtful[ray]] = every.distance[counted][place]
        first.point[doubtful[ray]] = every.point[counted][place]
        return first

    def all_hits(self, origins: Any, directions: Any) -> Tuple[AllHits, Integers]:
        """Returns all hits, and the indices of the hits that count in trimesh."""
        every, in_plane = self.queries._all_hits_and_planes(origins, directions)
        return every, np.flatnonzero(~in_plane)

    def contains(self, points: Any) -> npt.NDArray[np.bool_]:
        """Returns True for each point inside the mesh."""
        if self.queries.is_closed:
            return self.queries.inside(points)
        if self._distinct is None:
            self._distinct = _without_copies(self.queries)
        inside: npt.NDArray[np.bool_] = np.abs(self._distinct.winding_numbers(points)) > 0.5
        return inside

    def _is_parallel(self, triangle: Integers, directions: Floats) -> npt.NDArray[np.bool_]:
        """Returns True for each direction that is parallel to the plane of its triangle within rounding errors."""
        if self._normals is None:
            self._normals = _normals(self.queries)
        along = directions / np.abs(directions).max(axis=1, initial=0.0, keepdims=True)
        parallel: npt.NDArray[np.bool_] = np.abs((self._normals[triangle] * along).sum(axis=1)) <= _PARALLEL
        return parallel


def _without_copies(mesh: Mesh) -> Mesh:
    """Returns the mesh without triangles that repeat an earlier one: equal corner positions in the same winding."""
    positions = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)[1].reshape(-1)  # -0 becomes 0
    corners = positions[mesh.faces]
    first = corners.argmin(axis=1)
    rotated = np.take_along_axis(corners, (first[:, np.newaxis] + [0, 1, 2]) % 3, axis=1)
    kept = np.sort(np.unique(rotated, axis=0, return_index=True)[1])
    return mesh if len(kept) == len(mesh) else Mesh(mesh.vertices, mesh.faces[kept])


class _Empty(_Followed):
    """A mesh without triangles. No ray hits it, and no point is inside it."""

    def __init__(self, state: Any, arrays: Any) -> None:
        super().__init__(Mesh(np.zeros((3, 3)), [[0, 1, 2]]), state, arrays)

    def first_hits(self, origins: Any, directions: Any) -> Hits:
        count = len(self.queries.first_hits(origins, directions).triangle)
        return Hits(np.full(count, -1), np.full(count, np.inf), np.full((count, 3), np.nan))

    def all_hits(self, origins: Any, directions: Any) -> Tuple[AllHits, Integers]:
        return self.queries.all_hits(origins, directions), np.empty(0, dtype=np.int64)


def _followed(mesh: Any, before: Optional[_Followed]) -> _Followed:
    """Returns the current state of a mesh. This is `before` if the mesh has not changed since."""
    vertices, faces = getattr(mesh, "vertices", None), getattr(mesh, "faces", None)
    if vertices is None or faces is None:
        return before or _Followed(as_mesh(mesh))
    state = _state_of(vertices, faces)
    if before is not None and before.is_of(vertices, faces, state):
        return before
    arrays = None if state is not None else (np.array(vertices), np.array(faces))
    if len(faces) == 0:
        return _Empty(state, arrays)
    return _Followed(_moved(before, vertices, faces) or Mesh(vertices, faces), state, arrays)


def _moved(before: Optional[_Followed], vertices: Any, faces: Any) -> Optional[Mesh]:
    """Returns the mesh of `before` with moved vertices, which is cheaper than a new mesh. Returns None if the triangles
    have changed."""
    if before is None or isinstance(before, _Empty) or not np.array_equal(before.queries.faces, faces):
        return None
    if np.shape(vertices) != before.queries.vertices.shape:
        return None
    before.queries.set_vertices(vertices)
    return before.queries


def _state_of(vertices: Any, faces: Any) -> Any:
    """Returns the content hashes of trimesh's arrays. Returns None for other arrays, which are compared entry by
    entry."""
    if isinstance(vertices, np.ndarray) and isinstance(faces, np.ndarray):
        with contextlib.suppress(TypeError):  # NumPy's own arrays have no hash
            return hash(vertices), hash(faces)
    return None


def _normals(mesh: Mesh) -> Floats:
    """Returns scaled normals of the triangles, shorter than 1. The edges are scaled first, so that no product
    overflows."""
    corners = mesh.vertices[mesh.faces]
    edges = corners[:, 1:] - corners[:, :1]
    size = np.abs(edges).max(axis=2, keepdims=True)
    edges = edges / np.where(size > 0.0, size, 1.0)
    crossed: Any = np.cross(edges[:, 0], edges[:, 1])
    normals: Floats = crossed / 3.0
    return normals


def _rows(array: Any, rows: Integers) -> Floats:
    """Returns the given rows of an array. If the array has a single row, this row is repeated."""
    whole = np.atleast_2d(np.asarray(array, dtype=float))
    chosen: Floats = whole[rows] if len(whole) != 1 else np.broadcast_to(whole, (len(rows), 3))
    return chosen
