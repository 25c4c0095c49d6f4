/// \file
/// Contacts of a sphere with the surfaces that it may reach in a step.
#pragma once

#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/collision/moving_colliders.h"

namespace ricochet {

/// An interval of simulation time, in s.
struct TimeOfStep {
    double begin = 0.0;
    double end = 0.0;
};

/// Point of the surfaces at which the distance from a sphere's centre has a local minimum.
struct WallContact {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, from the surface to the centre
    double gap = 0.0;  ///< between the surface and the sphere, in m; negative for an overlap
    Vec3 carried{};    ///< mean velocity of the surface at this point in the step, in m/s
};

/// Appends the contacts of a sphere with gaps up to `reach`, in m, in ascending order of the surfaces. An edge of a
/// triangle is no contact if a neighbouring triangle is nearer, so a floor of many triangles has one contact. Returns
/// true if any surface is within reach.
bool find_wall_contacts(const SurfaceGeometry& geometry, const Vec3& center, double radius, double reach,
                        std::vector<WallContact>& found);

/// Appends the contacts with colliders at rest, and with moving colliders that come near in a step. Gaps are those at
/// the start of the step. Normals of rigid colliders are those in the middle of the step. Normals at the start of the
/// step would give a rotating drum a normal velocity. Returns true if any surface may come within reach in the step.
bool find_wall_contacts(const MovingColliders& bodies, const SurfaceGeometry& at_rest, const TimeOfStep& step,
                        const Vec3& center, double radius, double reach, std::vector<WallContact>& found);

}  // namespace ricochet
