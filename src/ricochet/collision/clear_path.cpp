#include "ricochet/collision/clear_path.h"

#include <algorithm>
#include <limits>

#include "ricochet/collision/narrow_phase.h"

namespace ricochet {

double room_beside_triangles(const CollisionWorld& world, const Vec3& center, double radius) {
    if (world.triangles().empty()) return std::numeric_limits<double>::infinity();
    return world.distance_field().lower_bound(center) - radius - query_slack(max_abs(center), radius);
}

bool is_path_clear(const CollisionWorld& world, const Path& path, double radius, double room) {
    const Vec3& start = path.c[0];
    double reach = length(path.end - start);
    for (const Vec3& control : path.control_points()) reach = std::max(reach, length(control - start));
    // The slack grows with the coordinates, at most by as much as the path is long.
    const double slack = query_slack(max_abs(start) + reach, radius);
    if (!(reach + slack < room)) return false;
    const double margin = radius + slack;
    return std::all_of(world.planes().begin(), world.planes().end(),
                       [&](const auto& plane) { return stays_on_one_side(path, plane.plane, margin); }) &&
           std::all_of(world.shapes().begin(), world.shapes().end(),
                       [&](const auto& shape) { return shape.shape.can_cull(path, margin); });
}

}  // namespace ricochet
