/// \file
/// The rate at which a surface's normal turns while a particle moves along it.
#pragma once

#include <span>

#include "ricochet/collision/contact_scratch.h"

namespace ricochet {

/// Returns a code for the feature of a surface that is nearest to a position. The code is 0 away from edges, vertices
/// and rims. For an edge or vertex of a triangle, bit k is set for each of its corners k. For the rim of a cylinder it
/// is CollisionWorld::rim_of().
[[nodiscard]] int touched_feature(const SurfaceGeometry& geometry, SurfaceId surface, const Vec3& position);

/// Returns the time derivative of a surface's normal, in 1/s, while a touching point or sphere moves with a velocity,
/// in m/s. nearest: the surface's nearest point to the position.
[[nodiscard]] Vec3 normal_rate(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                               const CollisionWorld::Nearest& nearest, const Vec3& position, const Vec3& velocity);

/// Returns the largest length of normal_rate(), in 1/m, for a unit velocity along all surfaces with the given normals.
/// Returns 0 without normals. Method: largest singular value of the linear map.
[[nodiscard]] double largest_curvature(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                                       const CollisionWorld::Nearest& nearest, const Vec3& position,
                                       std::span<const Vec3> normals);

}  // namespace ricochet
