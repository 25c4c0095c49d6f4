/// \file
/// Cheap proof that a path stays away from all surfaces, so that it needs no contact query.
#pragma once

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Returns a lower bound, in m, on the distance from a ball's surface to the triangles of the world, less the distance
/// within which a contact query tests triangles. Infinite without triangles; at most 0 near them. The centre must be
/// finite. The cost is that of one look-up in the distance field.
[[nodiscard]] double room_beside_triangles(const CollisionWorld& world, const Vec3& center, double radius);

/// Returns true if a contact query along the path of a ball certainly finds no surface, for any degree of the path. May
/// return false for a free path. room: room_beside_triangles() at the start of the path.
/// Reason: a path lies in the convex hull of its control points, so it stays within their largest distance from its
/// start.
[[nodiscard]] bool is_path_clear(const CollisionWorld& world, const Path& path, double radius, double room);

}  // namespace ricochet
