/// \file
/// Whether a sphere at rest overlaps a surface: the question at its birth.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/collision/moving_colliders.h"

namespace ricochet {

/// A surface that a sphere overlaps.
struct Overlap {
    SurfaceId surface = 0;
    double distance = 0.0;  ///< m, of the centre from it: the sphere reaches its radius less this behind it
};

/// The nearest of the surfaces that are nearer to the centre than the radius by more than sphere_tolerance(), of
/// several at one distance the smallest number; nothing for a sphere that touches at most, for a point (radius 0), and
/// for a centre that is not finite. What lies wholly inside a solid overlaps nothing. The broad phase proposes the
/// triangles: one query of a point. Safe from any number of threads.
[[nodiscard]] std::optional<Overlap> deepest_overlap(const CollisionWorld& world, const Vec3& center, double radius);

/// The bodies with a frame that a sphere, or a point (radius 0), may touch or overlap at a time, s, and maybe some
/// more; in their order.
[[nodiscard]] std::vector<BodyId> bodies_near(const MovingColliders& bodies, const Vec3& center, double radius,
                                              double time);

/// The same among colliders of all frames, as they stand at a time, s. bodies: null where none moves.
[[nodiscard]] std::optional<Overlap> deepest_overlap(const CollisionWorld& at_rest, const MovingColliders* bodies,
                                                     const Vec3& center, double radius, double time);

/// A position beside `center`, off the surfaces of bodies that it lies on exactly at a time, s: a few contact offsets
/// to where their normals point. Nothing where it lies on none.
[[nodiscard]] std::optional<Vec3> off_bodies(const MovingColliders& bodies, const Vec3& center, double time);

/// The surfaces that a sphere, or a point (radius 0), touches: those from whose distance its radius differs by at most
/// `reach`, m, by number. Not one that a point lies exactly on. One query of a point.
[[nodiscard]] std::vector<SurfaceId> surfaces_touched(const CollisionWorld& world, const Vec3& center, double radius,
                                                      double reach);

/// Radius, m, of the largest ball about the centre that a sphere in overlap can collide with as if it overlapped
/// nothing: one contact offset less than the distance. 0 for a point, where rounding of positions would be felt.
[[nodiscard]] double core_radius(const Overlap& overlap, const Vec3& center, double radius);

}  // namespace ricochet
