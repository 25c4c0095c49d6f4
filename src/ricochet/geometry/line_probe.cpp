#include "ricochet/geometry/line_probe.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ricochet {

// The tube can touch the triangle only while the line is within the margin of its plane. It does not when over all of
// that stretch the line stays beyond one edge: heights over the edge are linear, so both ends of the stretch tell.
// Everything is compared without dividing by the normal's length, so slivers only make the bound larger.
LineProbe::Stretch LineProbe::near(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 ab = b - a;
    const Vec3 ca = a - c;
    const Vec3 normal = cross(ab, -ca);
    const double product = std::sqrt(length_squared(ab) * length_squared(ca));
    const double bound = margin_ * length(normal) + rounding_ * product;
    const double height = dot(normal, from_ - a);
    const double slope = dot(normal, along_);
    double enter = 0.0;
    double leave = 1.0;
    if (slope != 0.0) {
        const double first = (-bound - height) / slope;
        const double second = (bound - height) / slope;
        enter = std::max(enter, std::min(first, second));
        leave = std::min(leave, std::max(first, second));
        if (enter > leave) return {};
    } else if (std::fabs(height) > bound) {
        return {};
    }
    const Vec3 p = from_ + enter * along_;
    const Vec3 q = from_ + leave * along_;
    const auto is_beyond = [&](const Vec3& corner, const Vec3& edge) {
        const Vec3 outward = cross(edge, normal);
        const double nearest = std::min(dot(outward, p - corner), dot(outward, q - corner));
        return nearest > 0.0 && nearest * nearest > length_squared(edge) * bound * bound;
    };
    if (is_beyond(a, ab) || is_beyond(b, c - b) || is_beyond(c, ca)) return {};
    return {enter, leave};
}

}  // namespace ricochet
