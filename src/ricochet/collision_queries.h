/// \file
/// Questions about colliders, without any particle: what a ray hits first, where the nearest surface is, and whether a
/// point is inside.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/collision/surface.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

class CollisionWorld;

/// Where a ray first hits a surface.
struct RayHit {
    double distance = 0.0;  ///< m from the origin, >= 0
    Vec3 point;             ///< m
    Vec3 normal;            ///< unit, facing the side that the ray comes from
    SurfaceName surface;
};

/// The point of all surfaces that is nearest to a point p.
struct ClosestPoint {
    double distance = 0.0;  ///< m, >= 0
    Vec3 point;             ///< m
    Vec3 direction;         ///< unit, from the surface to p; the surface's own normal where p lies on it
    SurfaceName surface;    ///< of several that are as near: the first
};

/// Colliders in world coordinates to ask about. Copies share what they ask. Answers are the same bits for any number of
/// threads and on every system, and may be asked for from any number of threads at once. Infinite planes take part in
/// rays and distances.
class CollisionQueries {
public:
    /// Throws InputError that names the collider and the value when one cannot be.
    explicit CollisionQueries(std::vector<ColliderDescription> colliders);
    // Moves are copies, so that there is none that cannot be asked.
    CollisionQueries(const CollisionQueries&) = default;
    CollisionQueries& operator=(const CollisionQueries&) = default;
    ~CollisionQueries() = default;

    /// The first surface on the ray from `origin` along `direction` (of any length above 0), at most most_distance
    /// (m, >= 0) away; of surfaces that are hit at the same distance the first under (collider, triangle). Which
    /// triangles and planes the ray hits is decided exactly, for the straight segment from the origin to the ray's
    /// end, rounded; the distance has an error of a few ulp of the segment's length. Balls and cylinders are found from
    /// up to some 1e12 times their size away. A ray that begins on a surface
    /// hits it at distance 0. Surfaces are hit from both sides. Hits with coordinates beyond 1e75 are not found. Throws
    /// InputError for arguments that are not finite or out of range.
    [[nodiscard]] std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                                  double most_distance = std::numeric_limits<double>::infinity()) const;

    /// The nearest point of all surfaces; nothing when there is none within `within` (m, >= 0). The distance has an
    /// error of some 2^-50 of itself. Throws InputError for arguments that are not finite or out of range.
    [[nodiscard]] std::optional<ClosestPoint> closest_point(
        const Vec3& point, double within = std::numeric_limits<double>::infinity()) const;

    /// True when the point is inside a ball, a cylinder, a box or a closed mesh; decided exactly for boxes and meshes,
    /// to some 2^-96 of the distances for balls and cylinders. A point on a surface is not inside; one within an even
    /// number of nested shells of one mesh neither. A mesh is closed when every edge has an even number of triangles;
    /// others, and planes, have no inside. Throws InputError for a point that is not finite.
    [[nodiscard]] bool is_inside(const Vec3& point) const;

    /// The colliders' names are those that SurfaceName counts.
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const;

private:
    friend class Simulation;
    struct Impl;
    explicit CollisionQueries(std::shared_ptr<const CollisionWorld> world);

    std::shared_ptr<const Impl> impl_;
};

}  // namespace ricochet
