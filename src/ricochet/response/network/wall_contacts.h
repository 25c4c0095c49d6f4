/// \file
/// Private to the responses: the surfaces that a sphere may come to in a step, each where it is nearest.
#pragma once

#include <vector>

#include "ricochet/collision/contact_scratch.h"

namespace ricochet {

/// A place at which the distance from a sphere's centre to all surfaces together is smallest among its neighbours.
struct WallContact {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, from the surface to the centre
    double gap = 0.0;  ///< m, between the surface and the sphere; < 0: they overlap
};

/// Appends the contacts of a sphere with gaps up to `reach` (m), in ascending order of the surfaces. The edge of a
/// triangle is none where a neighbour that it belongs to is nearer: a floor of many triangles has one contact with a
/// sphere, not one for each edge beside it.
void find_wall_contacts(const SurfaceGeometry& geometry, const Vec3& center, double radius, double reach,
                        std::vector<WallContact>& found);

}  // namespace ricochet
