/// \file
/// Displacement that gives a particle a clearance from the surfaces near it.
#pragma once

#include <optional>

#include "ricochet/collision/collision_world.h"

namespace ricochet {

/// Returns the shortest displacement, in m, that moves a ball to a distance of at least `clearance`, in m, from all
/// surfaces near it. Each surface is replaced by the plane through its nearest point. Returns nothing if no surface is
/// nearer than `clearance`, or if surfaces face each other and no displacement was found. The displacement is only a
/// proposal: it may lead through surfaces, so a certificate has to check it. Can be called from any number of threads.
[[nodiscard]] std::optional<Vec3> displacement_to_clear(const CollisionWorld& world, const Vec3& center, double radius,
                                                        double clearance);

}  // namespace ricochet
