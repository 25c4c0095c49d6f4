/// \file
/// Private to the simulation: tests whether a surface lies between a particle and the position of its birth.
#pragma once

#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/box3.h"

namespace ricochet {

/// Returns true if no surface intersects the closed segment. Exact.
[[nodiscard]] inline bool is_clear(const CollisionWorld& world, ContactScratch& scratch, const Vec3& from,
                                   const Vec3& to) {
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    const Path path = line_path(from, to - from, 1.0);
    const ContactQueryResult found = find_first_contact(geometry, {path, 0.0}, scratch);
    return !found.contact && found.near.is_free(from, to);
}

/// Also tests the colliders in moving frames, with their poses at a time, in s. bodies: null if there are none.
[[nodiscard]] inline bool is_clear_at(const CollisionWorld& world, const MovingColliders* bodies, double time,
                                      const Vec3& from, const Vec3& to) {
    ContactScratch scratch;
    if (!is_clear(world, scratch, from, to)) return false;
    if (bodies == nullptr) return true;
    Box3 box;
    box.include(from);
    box.include(to);
    std::vector<BodyId> near;
    bodies->near_at(box, time, near);
    for (const BodyId body : near) {
        ContactScratch own;
        if (!is_clear(bodies->world(body), own, bodies->local_position(body, from, time),
                      bodies->local_position(body, to, time))) {
            return false;
        }
    }
    return true;
}

}  // namespace ricochet
