/// \file
/// Geometric queries of colliders: the first hit of a ray, the nearest surface, and whether a point is inside.
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

/// First hit of a ray on a surface.
struct RayHit {
    double distance = 0.0;  ///< distance from the origin, in m, >= 0
    Vec3 point;             ///< in m
    Vec3 normal;            ///< unit normal on the side from which the ray comes
    SurfaceName surface;
};

/// The point on all surfaces that is nearest to a point p.
struct ClosestPoint {
    double distance = 0.0;  ///< in m, >= 0
    Vec3 point;             ///< in m
    Vec3 direction;         ///< unit vector from the surface to p, or the surface's normal if p lies on the surface
    SurfaceName surface;    ///< surface of the point; the first one if several are equally near
};

/// Colliders in world coordinates, for queries. Copies share their data. Results have the same bits for any number of
/// threads and on every system. Any number of threads may query at the same time. Infinite planes are included in ray
/// and distance queries.
class CollisionQueries {
public:
    /// Throws InputError if a collider is invalid. The message contains the name of the collider and the invalid value.
    explicit CollisionQueries(std::vector<ColliderDescription> colliders);
    // There are no move operations. A move copies, so a moved-from object remains valid for queries.
    CollisionQueries(const CollisionQueries&) = default;
    CollisionQueries& operator=(const CollisionQueries&) = default;
    ~CollisionQueries() = default;

    /// Returns the first hit on the ray from `origin` along `direction` (of any length above 0), within most_distance
    /// (in m, >= 0). If several surfaces are hit at the same distance, the first one in the order (collider, triangle)
    /// is returned.
    ///
    /// Hits of triangles and planes are decided exactly for the straight segment from the origin to the rounded end of
    /// the ray. The distance has an error of a few ulp of the segment's length. Balls and cylinders are found from
    /// distances of up to about 1e12 times their size.
    ///
    /// A ray that begins on a surface hits this surface at distance 0. Surfaces are hit from both sides. Hits with
    /// coordinates beyond 1e75 are not found. Throws InputError for arguments that are not finite or out of range.
    [[nodiscard]] std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                                  double most_distance = std::numeric_limits<double>::infinity()) const;

    /// Returns the nearest point of all surfaces, or nothing if there is no surface up to the distance `within` (in m,
    /// >= 0). The distance has a relative error of about 2^-50. Throws InputError for arguments that are not finite or
    /// out of range.
    [[nodiscard]] std::optional<ClosestPoint> closest_point(
        const Vec3& point, double within = std::numeric_limits<double>::infinity()) const;

    /// Returns true if the point is inside a ball, a cylinder, a box or a closed mesh. The decision is exact for boxes
    /// and meshes. For balls and cylinders the decision is exact to about 2^-96 of the distances. A point on a surface
    /// is not inside. A point within an even number of nested shells of one mesh is not inside. A mesh is closed if
    /// every edge belongs to an even number of triangles. Open meshes and planes have no inside. Throws InputError for
    /// a point that is not finite.
    [[nodiscard]] bool is_inside(const Vec3& point) const;

    /// Returns the colliders. SurfaceName refers to them by index.
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const;

private:
    friend class Simulation;
    struct Impl;
    explicit CollisionQueries(std::shared_ptr<const CollisionWorld> world);

    std::shared_ptr<const Impl> impl_;
};

}  // namespace ricochet
