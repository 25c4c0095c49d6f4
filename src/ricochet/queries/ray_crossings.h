/// \file
/// Private: hits of one ray on a mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/geometry/sweep/ray_triangle.h"

namespace ricochet {

class MeshIndex;

/// Ray with a range.
struct RayQuery {
    Ray ray;
    double most = 0.0;  ///< range in m, may be infinite

    /// Returns true if the point of parameter t is within the range.
    [[nodiscard]] bool reaches(const DoubleDouble& t) const {
        return most == std::numeric_limits<double>::infinity() || ray.distance(t) <= most;
    }
};

/// Hit of a ray on the surface.
struct RayCrossing {
    DoubleDouble t;              ///< parameter of the ray
    std::uint32_t triangle = 0;  ///< the first triangle along the ray; of several, the smallest index
    std::int8_t crossing = 0;    ///< see AllMeshHits
    bool is_in_plane = false;    ///< the ray lies in the planes of all triangles of this hit
};

/// Returns the first hit, or nullopt if there is none.
[[nodiscard]] std::optional<RayCrossing> first_crossing_on(const MeshIndex& mesh, const RayQuery& query);
/// Returns the sign of the determinant of p - origin, q - origin and the ray's direction. The sign is +1 if the edge
/// from p to q turns to the left about the ray. It is never 0 for an edge that is not parallel to the ray. The origin
/// is treated as moved by an infinitesimal amount, as for crossings.
[[nodiscard]] int moved_side(const Ray& ray, const Vec3& p, const Vec3& q);
/// Returns true if there is a hit.
[[nodiscard]] bool hits_anything(const MeshIndex& mesh, const RayQuery& query);
/// Finds all hits in the order along the ray, for MeshQueries::all_hits().
void all_crossings(const MeshIndex& mesh, const RayQuery& query, std::vector<RayCrossing>& crossings);

}  // namespace ricochet
