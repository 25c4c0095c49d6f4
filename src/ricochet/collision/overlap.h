/// \file
/// Tests whether a sphere at rest overlaps a surface, for newly spawned particles.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/collision/moving_colliders.h"

namespace ricochet {

/// A surface that a sphere overlaps.
struct Overlap {
    SurfaceId surface = 0;
    /// Distance of the surface from the centre, in m, which is less than the radius.
    double distance = 0.0;
};

/// Returns the nearest surface that a sphere overlaps: the centre's distance is smaller than the radius by more than
/// sphere_tolerance(). Of several at the same distance, it is the one with the smallest number. Returns nothing for a
/// sphere that at most touches or is wholly inside a solid, for a point (radius 0), and for a centre that is not
/// finite. Needs one point query. Can be called from any number of threads.
[[nodiscard]] std::optional<Overlap> deepest_overlap(const CollisionWorld& world, const Vec3& center, double radius);

/// Returns, in order, the bodies with a frame that a sphere or point may touch at a time, in s, and perhaps more.
[[nodiscard]] std::vector<BodyId> bodies_near(const MovingColliders& bodies, const Vec3& center, double radius,
                                              double time);

/// Returns the nearest overlapped surface among colliders of all frames, in their positions at a time, in s.
[[nodiscard]] std::optional<Overlap> deepest_overlap(const MovingColliders& bodies, const Vec3& center, double radius,
                                                     double time);

/// Returns a position for a particle that lies exactly on surfaces of bodies at a time, in s: a few contact offsets
/// away, along the normals of these surfaces. Returns nothing if the particle lies on none.
[[nodiscard]] std::optional<Vec3> off_bodies(const MovingColliders& bodies, const Vec3& center, double time);

/// Returns the surfaces that a sphere, or a point (radius 0), touches, in the order of their numbers. A surface is
/// touched if its distance differs from the radius by at most `reach`, in m. Surfaces on which a point lies exactly are
/// left out. Needs one point query.
[[nodiscard]] std::vector<SurfaceId> surfaces_touched(const CollisionWorld& world, const Vec3& center, double radius,
                                                      double reach);

/// Returns the radius, in m, of the core of an overlapping sphere. The core is a concentric ball that overlaps nothing
/// and collides in place of the sphere. Its radius is one contact offset less than the distance of the overlapped
/// surface. The result is 0, for a point, if the core is so small that rounding of positions would matter.
[[nodiscard]] double core_radius(const Overlap& overlap, const Vec3& center, double radius);

}  // namespace ricochet
