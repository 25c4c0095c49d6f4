#include "ricochet/geometry/sweep/separation.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

/// Rounding of a projection, relative to the vector that is projected: three products, two sums, the differences of the
/// coordinates, the direction's length and a division make some ten times 2^-53.
constexpr double kProjectionError = 0x1p-49;

/// Directions shorter than this, m, lose digits when they are squared.
constexpr double kShortest = 0x1p-400;

/// What is lost where a product leaves the range, m.
constexpr double kUnderflow = 0x1p-600;

}  // namespace

// The regions of the triangle's plane by the signs of dot products and of barycentric coordinates (Ericson, section
// 5.1.5).
Vec3 direction_away(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 pa = p - a;
    const double along_ab_a = dot(ab, pa);
    const double along_ac_a = dot(ac, pa);
    if (along_ab_a <= 0.0 && along_ac_a <= 0.0) return pa;
    const Vec3 pb = p - b;
    const double along_ab_b = dot(ab, pb);
    const double along_ac_b = dot(ac, pb);
    if (along_ab_b >= 0.0 && along_ac_b <= along_ab_b) return pb;
    const Vec3 pc = p - c;
    const double along_ab_c = dot(ab, pc);
    const double along_ac_c = dot(ac, pc);
    if (along_ac_c >= 0.0 && along_ab_c <= along_ac_c) return pc;
    const double weight_c = along_ab_a * along_ac_b - along_ab_b * along_ac_a;
    if (weight_c <= 0.0 && along_ab_a >= 0.0 && along_ab_b <= 0.0) {
        return pa - along_ab_a / (along_ab_a - along_ab_b) * ab;
    }
    const double weight_b = along_ab_c * along_ac_a - along_ab_a * along_ac_c;
    if (weight_b <= 0.0 && along_ac_a >= 0.0 && along_ac_c <= 0.0) {
        return pa - along_ac_a / (along_ac_a - along_ac_c) * ac;
    }
    const double weight_a = along_ab_b * along_ac_c - along_ab_c * along_ac_b;
    const double from_b = along_ac_b - along_ab_b;
    const double from_c = along_ab_c - along_ac_c;
    if (weight_a <= 0.0 && from_b >= 0.0 && from_c >= 0.0) return pb - from_b / (from_b + from_c) * (c - b);
    const Vec3 normal = cross(ab, ac);
    return dot(normal, pa) < 0.0 ? -normal : normal;
}

double distance_along(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double length_of_direction = length(direction);
    if (!(length_of_direction > kShortest)) return -1.0;
    const Vec3 pa = p - a;
    const Vec3 pb = p - b;
    const Vec3 pc = p - c;
    const double least = std::min({dot(direction, pa), dot(direction, pb), dot(direction, pc)});
    const Vec3 furthest = max(abs(pa), max(abs(pb), abs(pc)));
    return least / length_of_direction - kProjectionError * (furthest.x + furthest.y + furthest.z) - kUnderflow;
}

}  // namespace ricochet
