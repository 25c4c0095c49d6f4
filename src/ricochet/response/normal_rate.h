/// \file
/// Private to the responses: how the normal of a surface turns while a particle moves along it.
#pragma once

#include "ricochet/collision/contact_scratch.h"

namespace ricochet {

/// The part of a surface that is nearest to a position: 0 the inside of a triangle or a surface without parts; else bit
/// k stands for corner k of its edge or vertex.
[[nodiscard]] int touched_feature(const SurfaceGeometry& geometry, SurfaceId surface, const Vec3& position);

/// Derivative of a surface's normal by time, 1/s, while a point or sphere that touches it moves with this velocity.
/// nearest: what of the surface it touches.
[[nodiscard]] Vec3 normal_rate(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                               const CollisionWorld::Nearest& nearest, const Vec3& position, const Vec3& velocity);

}  // namespace ricochet
