/// \file
/// The first contact of a path with the world: planes and shapes, then triangles by broad and narrow phase, and in the
/// same query how long the path remains free beyond its end.
#pragma once

#include <optional>

#include "ricochet/collision/look_ahead.h"
#include "ricochet/collision/near_surfaces.h"

namespace ricochet {

/// A path, and what is already known about it.
struct ContactQuery {
    const Path& path;     ///< of the centre; finite
    double radius = 0.0;  ///< m, 0 for a point; prepared (CollisionWorld::prepare_radius)
    /// Where the particle goes after the path, with which it begins; null: do not look ahead. The contact is the same.
    const LookAhead* look_ahead = nullptr;
    /// All triangles near this path, where an earlier query has found them (LookAheadResult::candidates).
    ContactCandidates candidates = {};
};

/// The first contact, and what else the query has found on the way to it.
struct ContactQueryResult {
    std::optional<Contact> contact;  ///< the first under the order (time, collider, triangle)
    NearSurfaces near;               ///< for certificates of segments along the path, up to the contact
    LookAheadResult ahead;           ///< only without a contact
};

/// The first contact of a point or a sphere. geometry and scratch: of one thread; what `near` says is valid until the
/// next query with them.
[[nodiscard]] ContactQueryResult find_first_contact(const SurfaceGeometry& geometry, const ContactQuery& query,
                                                    ContactScratch& scratch);

}  // namespace ricochet
