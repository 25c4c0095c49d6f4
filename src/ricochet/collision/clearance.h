/// \file
/// How far a particle has to move for a clearance from the surfaces near it.
#pragma once

#include <optional>

#include "ricochet/collision/collision_world.h"

namespace ricochet {

/// Returns the shortest displacement, m, that takes a ball off all surfaces near it by `clearance`, m. The surfaces
/// count as the planes through their nearest points. Returns nothing where no surface is nearer than that, and where
/// surfaces face each other so that no displacement was found. The displacement is a proposal: it may lead through
/// surfaces, which a certificate has to rule out. Safe from any number of threads.
[[nodiscard]] std::optional<Vec3> displacement_to_clear(const CollisionWorld& world, const Vec3& center, double radius,
                                                        double clearance);

}  // namespace ricochet
