"""A drop-in for trimesh's ray interface, exact: ``mesh.ray = ricochet.trimesh.RayMeshIntersector(mesh)``.

Every hit and every miss is certain, in double precision; what triangles share is hit once; and containment is decided by
exact parity, not by a vote.
"""

from __future__ import annotations

from typing import Any, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._mesh import Mesh, as_mesh

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class RayMeshIntersector:
    """The methods of trimesh.ray.ray_triangle.RayMeshIntersector, for one mesh with vertices and faces."""

    def __init__(self, geometry: Any, scale_to_box: bool = True) -> None:
        """scale_to_box is taken for trimesh's sake; double precision does not need it."""
        self.mesh = geometry
        self._queries: Mesh = as_mesh(geometry)

    def intersects_location(
        self, ray_origins: Any, ray_directions: Any, multiple_hits: bool = True
    ) -> Tuple[Floats, Integers, Integers]:
        """Points of all hits (or of the first of each ray), the ray of each and its triangle."""
        ray, triangle, point = self._hits(ray_origins, ray_directions, multiple_hits)
        return point, ray, triangle

    def intersects_id(
        self,
        ray_origins: Any,
        ray_directions: Any,
        return_locations: bool = False,
        multiple_hits: bool = True,
    ) -> Any:
        """Triangle and ray of all hits (or of the first of each ray), and the points where return_locations."""
        ray, triangle, point = self._hits(ray_origins, ray_directions, multiple_hits)
        return (triangle, ray, point) if return_locations else (triangle, ray)

    def intersects_first(self, ray_origins: Any, ray_directions: Any) -> Integers:
        """The first triangle that each ray hits, -1 for none."""
        return self._queries.first_hits(ray_origins, ray_directions).triangle

    def intersects_any(self, ray_origins: Any, ray_directions: Any) -> npt.NDArray[np.bool_]:
        """Whether each ray hits anything."""
        return self._queries.occluded(ray_origins, ray_directions)

    def contains_points(self, points: Any) -> npt.NDArray[np.bool_]:
        """Whether each point is inside the mesh, which must be closed. Points on the surface are not."""
        return self._queries.inside(points)

    def _hits(self, origins: Any, directions: Any, multiple_hits: bool) -> Tuple[Integers, Integers, Floats]:
        if multiple_hits:
            every = self._queries.all_hits(origins, directions)
            return every.ray, every.triangle, every.point
        first = self._queries.first_hits(origins, directions)
        ray = np.flatnonzero(first.triangle >= 0)
        return ray, first.triangle[ray], first.point[ray]
