/// \file
/// Private: where one ray meets a mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/geometry/sweep/ray_triangle.h"

namespace ricochet {

class MeshIndex;

/// A ray that reaches so far.
struct RayQuestion {
    Ray ray;
    double most = 0.0;  ///< m, may be infinite

    /// True for places that it reaches.
    [[nodiscard]] bool reaches(const DoubleDouble& t) const {
        return most == std::numeric_limits<double>::infinity() || ray.distance(t) <= most;
    }
};

/// A place of the surface on a ray.
struct RayPlace {
    DoubleDouble t;              ///< of the ray
    std::uint32_t triangle = 0;  ///< the smallest of those that are first there
    std::int8_t crossing = 0;    ///< see AllMeshHits
    bool is_in_plane = false;    ///< the ray runs in the planes of all triangles there
};

/// The first one.
[[nodiscard]] std::optional<RayPlace> first_place(const MeshIndex& mesh, const RayQuestion& question);
/// Sign of the determinant of p and q, both as seen from the ray's origin, and its direction: +1 where the edge from p
/// to q turns to the left about the ray. Never 0 for an edge across the ray: the origin counts as moved by an
/// infinitesimal amount, as for crossings.
[[nodiscard]] int moved_side(const Ray& ray, const Vec3& p, const Vec3& q);
/// True when there is one.
[[nodiscard]] bool hits_anything(const MeshIndex& mesh, const RayQuestion& question);
/// All of them in the order along the ray: MeshQueries::all_hits().
void all_places(const MeshIndex& mesh, const RayQuestion& question, std::vector<RayPlace>& places);

}  // namespace ricochet
