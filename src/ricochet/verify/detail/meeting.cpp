#include "ricochet/verify/detail/meeting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/verify/detail/signs.h"

namespace ricochet::verify {
namespace {

/// Segment and triangle in one plane, seen along an axis along which the triangle has an area. Two convex figures are
/// apart when the line of a side of one of them has them strictly on different sides.
bool meets_in_plane(const Vec3& p, const Vec3& q, const Corners& t) {
    constexpr std::array<std::array<int, 2>, 3> kViews{{{0, 1}, {1, 2}, {2, 0}}};
    for (const auto& [u, v] : kViews) {
        const int area = planar_sign(u, v, t.a, t.b, t.c);
        if (area == 0) continue;
        const auto is_beyond = [&, u = u, v = v](const Vec3& from, const Vec3& to) {
            return planar_sign(u, v, from, to, p) * area < 0 && planar_sign(u, v, from, to, q) * area < 0;
        };
        if (is_beyond(t.a, t.b) || is_beyond(t.b, t.c) || is_beyond(t.c, t.a)) return false;
        const int of_a = planar_sign(u, v, p, q, t.a);
        const bool is_beside =
            of_a != 0 && planar_sign(u, v, p, q, t.b) == of_a && planar_sign(u, v, p, q, t.c) == of_a;
        return !is_beside;
    }
    return false;  // no area at all
}

/// The line through p and q, which crosses the triangle's plane in one point, passes the three sides alike.
bool passes_through(const Vec3& p, const Vec3& q, const Corners& t) {
    const int ab = spatial_sign(p, q, t.a, t.b);
    const int bc = spatial_sign(p, q, t.b, t.c);
    if (ab * bc < 0) return false;
    const int ca = spatial_sign(p, q, t.c, t.a);
    return ab * ca >= 0 && bc * ca >= 0;
}

}  // namespace

bool meets(const Vec3& p, const Vec3& q, const Corners& t) {
    const int of_p = spatial_sign(t.a, t.b, t.c, p);
    const int of_q = spatial_sign(t.a, t.b, t.c, q);
    if (of_p * of_q > 0) return false;
    return of_p == 0 && of_q == 0 ? meets_in_plane(p, q, t) : passes_through(p, q, t);
}

bool meets_after_start(const Vec3& p, const Vec3& q, const Corners& t) {
    const bool leaves_plane = spatial_sign(t.a, t.b, t.c, p) == 0 && spatial_sign(t.a, t.b, t.c, q) != 0;
    return !leaves_plane && meets(p, q, t);
}

Vec3 place_of_meeting(const Vec3& p, const Vec3& q, const Corners& t) {
    const Vec3 normal = cross(t.b - t.a, t.c - t.a);
    const double from = std::fabs(dot(normal, p - t.a));
    const double to = std::fabs(dot(normal, q - t.a));
    const double part = from / (from + to);
    return std::isfinite(part) ? p + std::clamp(part, 0.0, 1.0) * (q - p) : p;
}

}  // namespace ricochet::verify
