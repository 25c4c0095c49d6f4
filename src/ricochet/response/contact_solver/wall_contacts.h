/// \file
/// Private to the responses: the surfaces that a sphere may come to in a step, each where it is nearest.
#pragma once

#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/collision/moving_colliders.h"

namespace ricochet {

/// An interval of simulation time, s.
struct TimeOfStep {
    double begin = 0.0;
    double end = 0.0;
};

/// A place at which the distance from a sphere's centre to all surfaces together is smallest among its neighbours.
struct WallContact {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, from the surface to the centre
    double gap = 0.0;  ///< m, between the surface and the sphere; < 0: they overlap
    Vec3 carried{};    ///< m/s, of the surface there where its collider moves: its way in the step over the step
};

/// Appends the contacts of a sphere with gaps up to `reach` (m), in ascending order of the surfaces. The edge of a
/// triangle is none where a neighbour that it belongs to is nearer: a floor of many triangles has one contact with a
/// sphere, not one for each edge beside it. Returns whether any surface is so near.
bool find_wall_contacts(const SurfaceGeometry& geometry, const Vec3& center, double radius, double reach,
                        std::vector<WallContact>& found);

/// The same among colliders that move, of those at rest and of all that come near in a step [begin, end], s, as they
/// stand at its begin. Normals are those of the middle of the step: what is fixed to a surface that turns neither nears
/// nor leaves it then. Returns whether any surface may come so near in the step.
bool find_wall_contacts(const MovingColliders& bodies, const TimeOfStep& step, const Vec3& center, double radius,
                        double reach, std::vector<WallContact>& found);

/// m, from a surface at a time, s, to a position, with the unit normal towards it.
[[nodiscard]] CollisionWorld::Nearest nearest_at(const MovingColliders& bodies, SurfaceId surface, const Vec3& p,
                                                 double time);

}  // namespace ricochet
