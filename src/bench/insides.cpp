#include "bench/insides.h"

#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet::bench {

Insides::Insides(const TriangleMesh& mesh, const Vec3& heart)
    : mesh_(mesh), heart_(heart), bvh_(mesh.vertices, mesh.triangles, 0.0) {}

bool Insides::contains(const Vec3& p) const {
    bool is_seen = true;
    bvh_.visit(heart_, p, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        if (!segment_meets_triangle(heart_, p, v[t[0]], v[t[1]], v[t[2]])) return 1.0;
        is_seen = false;
        return 0.0;
    });
    return is_seen;
}

bool Insides::contains_ball(const Vec3& middle, double radius) const {
    if (!contains(middle)) return false;
    if (radius == 0.0) return true;
    bool is_clear = true;
    bvh_.visit_near(middle, radius, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        const auto nearest = closest_point_on_triangle(middle, v[t[0]], v[t[1]], v[t[2]]);
        if (nearest.distance_squared >= radius * radius) return radius;
        is_clear = false;
        return 0.0;
    });
    return is_clear;
}

}  // namespace ricochet::bench
