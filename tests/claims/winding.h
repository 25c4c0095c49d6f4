/// \file Winding number of a closed mesh about a point, from the solid angles of the triangles. This computation is
/// independent of the library.
#pragma once

#include <cmath>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// Returns the solid angle of a triangle, divided by 2 pi.
/// Source: A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical
/// Engineering 30, 1983.
[[nodiscard]] inline long double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    struct Arm {
        long double x, y, z, length;
    };
    const auto arm = [&](const Vec3& q) {
        const long double x = static_cast<long double>(q.x) - p.x;
        const long double y = static_cast<long double>(q.y) - p.y;
        const long double z = static_cast<long double>(q.z) - p.z;
        return Arm{x, y, z, std::sqrt(x * x + y * y + z * z)};
    };
    const auto dot = [](const Arm& u, const Arm& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
    const Arm u = arm(a);
    const Arm v = arm(b);
    const Arm w = arm(c);
    const long double volume =
        u.x * (v.y * w.z - v.z * w.y) - u.y * (v.x * w.z - v.z * w.x) + u.z * (v.x * w.y - v.y * w.x);
    const long double base =
        u.length * v.length * w.length + dot(u, v) * w.length + dot(v, w) * u.length + dot(w, u) * v.length;
    return std::atan2(volume, base) / 3.14159265358979323846L;
}

/// Returns the winding number of a closed mesh about a point: 1 inside a mesh wound outward, 0 outside.
[[nodiscard]] inline long winding_number(const TriangleMesh& mesh, const Vec3& p) {
    long double sum = 0.0L;
    for (const Triangle& t : mesh.triangles) {
        sum += solid_angle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], p);
    }
    return std::lround(sum / 2.0L);
}

}  // namespace ricochet::testing
