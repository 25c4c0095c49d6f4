/// \file
/// Cheap proof that a path stays away from all surfaces, so that it needs no contact query.
#pragma once

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A ball that contains no triangle, known from an earlier search.
struct ClearBall {
    Vec3 center;          ///< in m
    double radius = 0.0;  ///< in m; 0: no ball is known

    /// Returns a lower bound, in m, on the distance of the triangles from p; at most 0 outside of the ball.
    [[nodiscard]] double bound_at(const Vec3& p) const { return radius - length(p - center); }
};

/// Returns a ball of free space around a particle of the given radius, in m. It contains no triangle. The gap between
/// its radius and the particle's is at least four fifths of the smaller of `within`, in m, and the distance between the
/// particle and the nearest triangle. The centre must be finite.
[[nodiscard]] ClearBall find_clear_ball(const CollisionWorld& world, const Vec3& center, double radius, double within);

/// Returns a lower bound, in m, on the distance from a ball's surface to the triangles of the world, less the distance
/// within which a contact query tests triangles. Infinite without triangles; at most 0 near them. The centre must be
/// finite. The bound follows from the distance field and from a ball that contains no triangle.
[[nodiscard]] double room_beside_triangles(const CollisionWorld& world, const Vec3& center, double radius,
                                           const ClearBall& clear = {});

/// Returns true if a contact query along the path of a ball certainly finds no surface, for any degree of the path. May
/// return false for a free path. room: room_beside_triangles() at the start of the path.
/// Reason: a path lies in the convex hull of its control points, so it stays within their largest distance from its
/// start.
[[nodiscard]] bool is_path_clear(const CollisionWorld& world, const Path& path, double radius, double room);

}  // namespace ricochet
